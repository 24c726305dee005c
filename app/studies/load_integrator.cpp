#include "app/studies/load_integrator.hpp"

#include <fmt/format.h>

#include <optional>
#include <span>

#include "generator/base/diagnostic.hpp"
#include "runtime/arithmetic.hpp"

namespace hamgen::app {

runtime::Compiler chosen_compiler(const std::string& choice) {
  runtime::Compiler compiler =
      runtime::find_compiler(choice.empty() ? std::nullopt : std::optional(choice));
  const auto arguments = std::span(compiler.command).subspan(1);
  if (const std::optional<std::string> reason = runtime::refused_flag(arguments))
    throw UsageError(fmt::format("{}: {}", compiler.chosen_by, *reason));
  return compiler;
}

runtime::LoadedPlugin load_integrator(const PluginSource& plugin, const std::string& compiler,
                                      StopFlag stop) {
  runtime::PluginSource source;
  source.text = plugin.text;
  source.uses_eigen = plugin.needs_eigen;
  source.uses_quadmath = plugin.needs_quadmath;
  runtime::CompileOptions options;
  options.stop = stop;
  return runtime::load_plugin(source, chosen_compiler(compiler), options, runtime::open_cache());
}

}  // namespace hamgen::app
