#include "benchmarks/emitted_program.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "generator/base/source_text.hpp"
#include "runtime/compiler.hpp"
#include "runtime/process.hpp"

namespace hamgen {

namespace {

namespace fs = std::filesystem;

// A directory of its own that does not outlive it.
class Directory {
 public:
  Directory() {
    std::string pattern = (fs::temp_directory_path() / "hamgen-benchmark-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary directory");
    path_ = pattern;
  }
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;
  ~Directory() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string checked_run(const runtime::ProcessRequest& request) {
  const runtime::ProcessResult result = runtime::run_process(request);
  if (!result.succeeded()) {
    throw std::runtime_error(runtime::end_text(result, request) + "\n" + result.output);
  }
  return result.output;
}

}  // namespace

std::string emitted_header(const std::string& model, Request request, const std::string& scalar,
                           const std::string& name_space) {
  request.scalar = scalar;
  request.name_space = name_space;
  return emit(make_source("benchmark.ham", model), request).at(0).text;
}

std::string output_of_sources(const std::vector<ProgramFile>& files,
                              const std::vector<std::string>& flags) {
  const Directory directory;
  runtime::ProcessRequest compile{.command = runtime::find_compiler().command,
                                  .working_directory = directory.path(),
                                  .time_limit = std::chrono::minutes(20)};
  for (const char* flag : {"-std=gnu++17", "-O3", "-w", "-ffp-contract=off", "-fno-math-errno",
                           "-isystem", "/usr/include/eigen3"}) {
    compile.command.emplace_back(flag);
  }
  compile.command.insert(compile.command.end(), flags.begin(), flags.end());
  for (const ProgramFile& file : files) {
    std::ofstream(directory.path() / file.name) << file.text;
    if (file.name.ends_with(".cpp")) compile.command.push_back(file.name);
  }
  compile.command.insert(compile.command.end(), {"-o", "program", "-lquadmath"});
  (void)checked_run(compile);
  return checked_run({.command = {(directory.path() / "program").string()},
                      .working_directory = directory.path(),
                      .time_limit = std::chrono::hours(24)});
}

std::string output_of_program(const std::vector<ProgramFile>& headers, const std::string& program,
                              const std::vector<std::string>& flags) {
  std::vector<ProgramFile> files = headers;
  std::string text;
  for (const ProgramFile& header : headers) text += fmt::format("#include \"{}\"\n", header.name);
  files.push_back({"program.cpp", text + program});
  return output_of_sources(files, flags);
}

}  // namespace hamgen
