// Runs a program by its argument list: no shell ever sees the words.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hamgen::runtime {

struct ProcessRequest {
  std::vector<std::string> command;         // the program (a path, or a name in PATH), then words
  std::filesystem::path working_directory;  // empty: that of the caller
  std::chrono::milliseconds time_limit = std::chrono::seconds(120);
  std::size_t output_limit = 64 * 1024;  // bytes; the last ones are kept
  // Bytes of address space of each process it starts; 0: no limit.  None of them gets more
  // processor time than the time limit, wherever it hides.
  std::uint64_t memory_limit = 0;
  const std::atomic<bool>* stop = nullptr;  // looked at ten times a second, if given
};

enum class ProcessEnd { exited, signalled, timed_out, stopped };

struct ProcessResult {
  ProcessEnd end = ProcessEnd::exited;
  int code = 0;        // exit status, or the signal's number
  std::string output;  // standard output and standard error, in the order written
  double seconds = 0.0;

  [[nodiscard]] bool succeeded() const { return end == ProcessEnd::exited && code == 0; }
};

// Waits for the program.  At its end, or at the time limit, everything left in its process group is
// killed.  Its standard input is empty.  Throws ToolError if it cannot be started.
[[nodiscard]] ProcessResult run_process(const ProcessRequest& request);

// "exit status 1", "killed by signal 11 (Segmentation fault)", "not finished after 120 s".
[[nodiscard]] std::string end_text(const ProcessResult& result, const ProcessRequest& request);

}  // namespace hamgen::runtime
