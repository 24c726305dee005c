// ToolError: something outside this program failed: a compiler, a loader, a file system.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace hamgen::runtime {

// What failed.
struct ToolFailure {
  std::string message;             // one sentence: what failed, on what
  std::string command;             // as one could type it in a shell; empty if no program was run
  std::optional<int> exit_status;  // of the program; empty if it did not exit by itself
  std::string output_tail;         // the end of what the program printed
};

// what() is the message, then the command and the output tail on lines of their own.
class ToolError : public std::runtime_error {
 public:
  // From all that is known of it.
  explicit ToolError(ToolFailure failure);

  // Piece by piece.
  [[nodiscard]] const ToolFailure& failure() const { return failure_; }

 private:
  ToolFailure failure_;
};

// "cannot ACTION 'PATH': REASON", the reason from an errno value.
[[nodiscard]] ToolError file_error(std::string_view action, const std::filesystem::path& path,
                                   int error_number);

// The words with shell quoting where needed, for messages only.
[[nodiscard]] std::string command_text(std::span<const std::string> command);

// The last lines of a text, at most `max_lines` and about `max_bytes`, cut at a line start.
[[nodiscard]] std::string tail_of(std::string_view text, std::size_t max_lines = 20,
                                  std::size_t max_bytes = 4000);

}  // namespace hamgen::runtime
