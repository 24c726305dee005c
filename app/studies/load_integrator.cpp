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

namespace {

runtime::PluginSource to_compile(const PluginSource& plugin) {
  runtime::PluginSource source;
  source.text = plugin.text;
  source.uses_eigen = plugin.needs_eigen;
  source.uses_quadmath = plugin.needs_quadmath;
  return source;
}

}  // namespace

runtime::LoadedPlugin load_integrator(const PluginSource& plugin, const std::string& compiler,
                                      StopFlag stop) {
  runtime::CompileOptions options;
  options.stop = stop;
  return runtime::load_plugin(to_compile(plugin), chosen_compiler(compiler), options,
                              runtime::open_cache());
}

std::string digest_of_code(const PluginSource& plugin, const std::string& compiler) {
  runtime::PluginSource source = to_compile(plugin);
  // The first lines say where the model is and how it was asked for.
  while (source.text.starts_with("//")) source.text.erase(0, source.text.find('\n') + 1);
  return runtime::cache_key(source, chosen_compiler(compiler), {});
}

}  // namespace hamgen::app
