#include "tests/emitted/compiled.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "runtime/temporary_directory.hpp"

namespace hamgen::emitted_test {
namespace {

runtime::ProcessResult run(std::vector<std::string> command) {
  return runtime::run_process({.command = std::move(command),
                               .time_limit = std::chrono::minutes(20),
                               .output_limit = 1 << 20});
}

}  // namespace

std::vector<std::string> strict_flags() {
  return {"-std=c++17",        "-Wall",    "-Wextra",          "-Wpedantic",         "-Wconversion",
          "-Wsign-conversion", "-Wshadow", "-Wold-style-cast", "-Wdouble-promotion", "-Werror"};
}

std::vector<std::string> compilers() {
  std::vector<std::string> found;
  for (const char* name : {"g++", "clang++"}) {
    try {
      if (run({name, "--version"}).succeeded()) found.emplace_back(name);
    } catch (const std::runtime_error&) {  // not there
    }
  }
  return found;
}

std::string messages(const std::string& compiler, const std::string& text,
                     const std::vector<std::string>& flags, const std::string& action) {
  const runtime::TemporaryDirectory directory = runtime::private_directory();
  const std::filesystem::path source = directory.path() / "unit.cpp";
  std::ofstream(source) << text;
  std::vector<std::string> command{compiler, action, "-O0", "-isystem", "/usr/include/eigen3"};
  if (action == "-S") command.insert(command.end(), {"-o", (directory.path() / "unit.s").string()});
  command.insert(command.end(), flags.begin(), flags.end());
  command.push_back(source.string());
  const runtime::ProcessResult result = run(command);
  return result.succeeded() && result.output.empty() ? "" : "failed:\n" + result.output;
}

std::string run_program(const std::string& text, const std::vector<std::string>& flags) {
  const runtime::TemporaryDirectory directory = runtime::private_directory();
  const std::filesystem::path source = directory.path() / "program.cpp";
  const std::filesystem::path program = directory.path() / "program";
  std::ofstream(source) << text;
  std::vector<std::string> command = {"g++", "-std=gnu++17", "-O0", "-isystem",
                                      "/usr/include/eigen3"};
  command.insert(command.end(), flags.begin(), flags.end());
  command.insert(command.end(), {source.string(), "-o", program.string(), "-lquadmath"});
  const runtime::ProcessResult compiled = run(command);
  if (!compiled.succeeded()) throw std::runtime_error("does not compile:\n" + compiled.output);
  const runtime::ProcessResult ran = run({program.string()});
  if (!ran.succeeded()) throw std::runtime_error("does not run:\n" + ran.output);
  return ran.output;
}

std::string output_of(const std::vector<std::string>& command) {
  const runtime::ProcessResult result = runtime::run_process(
      {.command = command, .time_limit = std::chrono::minutes(20), .output_limit = 1 << 20});
  return result.succeeded() ? result.output : "failed:\n" + result.output;
}

SourceText shipped(const std::string& model) {
  return read_source(std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/" + model + ".ham");
}

std::vector<std::filesystem::path> shipped_models() {
  std::vector<std::filesystem::path> models;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(HAMGEN_SOURCE_DIR) / "hamiltonians")) {
    if (entry.path().extension() == ".ham") models.push_back(entry.path());
  }
  std::ranges::sort(models);
  return models;
}

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string without_pragma(std::string header) {
  const std::string pragma = "#pragma once\n";
  if (const auto at = header.find(pragma); at != std::string::npos) header.erase(at, pragma.size());
  return header;
}

int count(std::string_view text, std::string_view part) {
  int n = 0;
  for (auto at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

}  // namespace hamgen::emitted_test
