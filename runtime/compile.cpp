#include "runtime/compile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>

#include "runtime/arithmetic.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/object_file.hpp"
#include "runtime/plugin_header.hpp"
#include "runtime/process.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::runtime {
namespace {

constexpr const char* kObject = "plugin.so";
constexpr const char* kExports = "exports.map";

// Contraction to fused multiply-adds is off so that every machine takes the same steps; errno is
// never read.  Nothing else may touch the meaning of the arithmetic: compensated sums need it.
constexpr std::array<const char*, 6> kFlags = {"-w",
                                               "-fPIC",
                                               "-shared",
                                               "-ffp-contract=off",
                                               "-fno-math-errno",
                                               "-fno-semantic-interposition"};

// Note [libraries of a plugin]
// Functions of the mathematical library, and of C's malloc, free, memcpy and memset, which are in
// every process: the linker takes 10 ms for them and 30 for what it is told of C++ by default.
// Eigen is C++, and flags that have code watched bring a library of their own.
constexpr std::array<const char*, 3> kLibraries = {"-nodefaultlibs", "-lm", "-lgcc"};

bool wants_all_libraries(const PluginSource& source, const Compiler& compiler) {
  return source.uses_eigen || std::ranges::any_of(compiler.command, [](const std::string& word) {
           return word.starts_with("-fsanitize") || word.starts_with("-fprofile") ||
                  word == "--coverage" || word == "-pg";
         });
}

// Note [one exported symbol]
// Two plugins of one model define the same inline functions.  Were they visible, the dynamic linker
// would let the first definition, or one in the host, stand in for the others.
constexpr const char* kExportsText = "{ global: hamgen_plugin_entry; local: *; };\n";

void check_name(const std::string& name) {
  if (name.empty() || name.front() == '.' || name.front() == '-' ||
      name.find_first_of("/\n") != std::string::npos || name == "plugin.h" || name == kObject ||
      name == kExports) {
    throw std::invalid_argument(fmt::format("'{}' cannot be the name of a plugin's file", name));
  }
}

void refuse_flags(std::span<const std::string> flags) {
  if (const std::optional<std::string> reason = refused_flag(flags))
    throw ToolError({.message = *reason});
}

const std::string* own_optimisation(const Compiler& compiler) {
  const auto asks = [](const std::string& word) {
    return word.starts_with("-O") || word.starts_with("--optimize");
  };
  const auto last = std::find_if(compiler.command.rbegin(), compiler.command.rend(), asks);
  return last == compiler.command.rend() ? nullptr : &*last;
}

void write_file(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.publish();
}

}  // namespace

std::string optimisation_of(const Compiler& compiler, const CompileOptions& options) {
  const std::string* own = own_optimisation(compiler);
  return own != nullptr ? *own : options.optimisation;
}

std::vector<std::string> compile_flags(const PluginSource& source, const Compiler& compiler,
                                       const CompileOptions& options) {
  std::vector<std::string> flags = {"-std=c++20"};
  if (own_optimisation(compiler) == nullptr) flags.push_back(options.optimisation);
  flags.insert(flags.end(), kFlags.begin(), kFlags.end());
  refuse_flags(options.extra_flags);
  flags.insert(flags.end(), options.extra_flags.begin(), options.extra_flags.end());
  if (source.uses_eigen) {
    flags.push_back("-isystem");
    flags.push_back(std::filesystem::absolute(options.eigen_include).string());
  }
  if (source.uses_quadmath) flags.push_back("-lquadmath");
  return flags;
}

void write_sources(const PluginSource& source, const std::filesystem::path& directory) {
  check_name(source.name);
  for (const SourceFile& header : source.headers) check_name(header.name);
  write_file(directory / "plugin.h", plugin_header_text());
  write_file(directory / kExports, kExportsText);
  for (const SourceFile& header : source.headers) write_file(directory / header.name, header.text);
  write_file(directory / source.name, source.text);
}

std::filesystem::path compile_sources(const PluginSource& source, const Compiler& compiler,
                                      const CompileOptions& options,
                                      const std::filesystem::path& directory) {
  refuse_flags(std::span(compiler.command).subspan(1));
  ProcessRequest request{.command = compiler.command,
                         .working_directory = directory,
                         .time_limit = options.time_limit,
                         .memory_limit = options.memory_limit,
                         .stop = options.stop};
  // Libraries count only after the files that need them.
  for (const std::string& word : {std::string("-o"), std::string(kObject), source.name,
                                  fmt::format("-Wl,--version-script={}", kExports)}) {
    request.command.push_back(word);
  }
  for (const std::string& flag : compile_flags(source, compiler, options))
    request.command.push_back(flag);
  if (!wants_all_libraries(source, compiler))
    request.command.insert(request.command.end(), kLibraries.begin(), kLibraries.end());

  const ProcessResult result = run_process(request);
  const std::filesystem::path object = directory / kObject;
  const auto end_of = [&]() -> std::string {
    if (!result.succeeded()) return end_text(result, request);
    std::error_code missing;
    if (!std::filesystem::is_regular_file(object, missing))
      return "exit status 0, but no object file";
    // Not every linker says that the disk was full.
    const std::string problem = object_problem(object);
    return problem.empty() ? "" : "exit status 0, but of the object file: " + problem;
  };
  const std::string end = end_of();
  if (end.empty()) return object;
  const char* const help = result.end == ProcessEnd::timed_out
                               ? "\nhelp: `hamgen run --flags=-O0` takes less time, `hamgen run "
                                 "--interpret` none"
                               : "";
  throw ToolError(
      {.message = fmt::format("the compiler did not make the integrator: {}{}", end, help),
       .command = command_text(request.command),
       .exit_status = result.end == ProcessEnd::exited ? std::optional(result.code) : std::nullopt,
       .output_tail = tail_of(result.output)});
}

}  // namespace hamgen::runtime
