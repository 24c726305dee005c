#include "tests/schemes/emitted_program.hpp"

#include <fstream>
#include <stdexcept>

#include "generator/base/source_text.hpp"
#include "runtime/process.hpp"
#include "runtime/temporary_directory.hpp"

namespace hamgen::schemes_test {

namespace {

runtime::ProcessResult run(std::vector<std::string> command) {
  return runtime::run_process({.command = std::move(command),
                               .time_limit = std::chrono::minutes(20),
                               .output_limit = 1 << 20});
}

}  // namespace

std::string header(const std::string& model, Request request, const std::string& name_space) {
  request.name_space = name_space;
  std::string text = emit(make_source("model.ham", model), request).at(0).text;
  const std::string pragma = "#pragma once\n";
  text.erase(text.find(pragma), pragma.size());
  return text;
}

std::string output_of(const std::string& text) {
  const runtime::TemporaryDirectory directory = runtime::private_directory();
  const std::filesystem::path source = directory.path() / "program.cpp";
  const std::filesystem::path program = directory.path() / "program";
  std::ofstream(source) << text;
  const auto compiled =
      run({"g++", "-std=gnu++17", "-O0", source.string(), "-o", program.string(), "-lquadmath"});
  if (!compiled.succeeded()) throw std::runtime_error("does not compile:\n" + compiled.output);
  const auto ran = run({program.string()});
  if (!ran.succeeded()) throw std::runtime_error("does not run:\n" + ran.output);
  return ran.output;
}

std::string warnings_of(const std::string& compiler, const std::string& text) {
  const runtime::TemporaryDirectory directory = runtime::private_directory();
  const std::filesystem::path source = directory.path() / "unit.cpp";
  std::ofstream(source) << text;
  const auto result = run({compiler, "-fsyntax-only", "-std=c++17", "-Wall", "-Wextra",
                           "-Wpedantic", "-Wconversion", "-Wsign-conversion", "-Wshadow",
                           "-Wold-style-cast", "-Wdouble-promotion", "-Werror", source.string()});
  return result.succeeded() && result.output.empty() ? "" : "failed:\n" + result.output;
}

}  // namespace hamgen::schemes_test
