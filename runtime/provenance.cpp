#include "runtime/provenance.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "runtime/compile.hpp"

namespace hamgen::runtime {
namespace {

std::string processor_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

}  // namespace

Provenance provenance_of(const Compiler& compiler, const std::atomic<bool>* stop,
                         const CompileOptions& options) {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::vector<std::string> flags(compiler.command.begin() + 1, compiler.command.end());
  const std::vector<std::string> always = compile_flags({}, compiler, options);
  flags.insert(flags.end(), always.begin(), always.end());
  return {.machine =
              fmt::format("{}, {} threads", processor_name(), std::thread::hardware_concurrency()),
          .compiler = compiler_version(compiler, stop),
          .flags = fmt::format("{}", fmt::join(flags, " ")),
          .date = fmt::format("{:%Y-%m-%d}", fmt::gmtime(now))};
}

}  // namespace hamgen::runtime
