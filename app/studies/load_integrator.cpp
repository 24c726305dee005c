#include "app/studies/load_integrator.hpp"

#include <optional>

namespace hamgen::app {

runtime::LoadedPlugin load_integrator(const PluginSource& plugin, const std::string& compiler,
                                      StopFlag stop) {
  runtime::PluginSource source;
  source.text = plugin.text;
  source.uses_eigen = plugin.needs_eigen;
  source.uses_quadmath = plugin.needs_quadmath;
  runtime::CompileOptions options;
  options.stop = stop;
  const std::optional<std::string> choice =
      compiler.empty() ? std::nullopt : std::optional(compiler);
  return runtime::load_plugin(source, runtime::find_compiler(choice), options,
                              runtime::open_cache());
}

}  // namespace hamgen::app
