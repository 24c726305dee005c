// hamgen certify: how far the steps that ran are from the exact map, proved.
#include "app/studies/certify.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/certify_output.hpp"
#include "app/output/json_document.hpp"
#include "app/output/progress_bars.hpp"
#include "app/output/terminal.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/interpreted.hpp"
#include "app/studies/load_integrator.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

struct CertifyOptions {
  MethodOptions method;
  SceneOptions scene;
  std::string every, within;
  CompilerChoice compiler;
  bool interpret = false;
  bool json = false;
  bool quiet = false;
};

double read_within(const CertifyOptions& options) {
  if (options.within.empty()) return HUGE_VAL;
  const double within = to_double(constant_option("--within", options.within));
  if (!(within > 0.0))
    throw UsageError(fmt::format("--within {}: units of rounding are above 0", options.within));
  return within;
}

int status_of(const Certificate& certificate, double within) {
  if (interrupt_flag()) return interrupted;
  return certificate.holds() && certificate.units <= within ? done : numerical_failure;
}

int run_certify(const CertifyOptions& options) {
  const double within = read_within(options);
  Setting setting = read_setting(options.method, options.scene);
  const SceneValues scene = complete_scene(setting.model, setting.scene);
  take_gauge_at(scene, setting.model, setting.request);
  specialise(options.scene, scene, {}, Observing::as_the_scene, setting);
  if (setting.request.scene) setting.request.scene->sees_all = true;
  const Scheme scheme = request_scheme(setting.source, setting.request);
  require_certifiable(setting.request, setting.model, scheme);
  const PluginSource plugin = generate_plugin(setting.source, setting.request);
  const runtime::LoadedPlugin loaded =
      options.interpret ? interpreted_integrator(setting.source, setting.request, plugin)
                        : load_integrator(plugin, options.compiler, &interrupt_flag(),
                                          static_cast<double>(*scene.steps));
  const runtime::InitialValues start = initial_values(plugin, scene, *loaded.library);
  const Certificate certificate = certify(
      {.plugin = &plugin,
       .library = loaded.library,
       .scene = &scene,
       .scheme = &scheme,
       .start = &start,
       .every =
           options.every.empty() ? 0 : integer_value("--every " + options.every, options.every, 1),
       .on_progress = progress_bars(options.quiet),
       .stop = &interrupt_flag()});
  const std::string head = fmt::format("{}{}: {}, h = {}\n", plugin.model.name,
                                       scene.name.empty() ? "" : ", scene " + scene.name,
                                       plugin.scheme_name, shortest_decimal(to_double(*scene.h)));
  print(options.json ? json_document(certificate_json(certificate))
                     : head + certificate_text(certificate));
  if (certificate.units > within)
    print_error(fmt::format("hamgen: step {} is farther than --within {} from the exact map\n",
                            certificate.worst_step, options.within));
  return status_of(certificate, within);
}

}  // namespace

Command add_certify(CLI::App& app) {
  const auto options = std::make_shared<CertifyOptions>();
  CLI::App* parser = app.add_subcommand(
      "certify", "proves how far the steps of a run are from the method's exact map");
  add_scene_options(*parser, options->scene);
  add_step_option(*parser, options->scene);
  parser->add_option("--time", options->scene.time, "")->type_name("T");
  parser->add_option("--steps", options->scene.steps, "their time, or number; default: the scene's")
      ->type_name("N");
  parser
      ->add_option("--every", options->every,
                   "look at every K-th step; default: as many as take seconds")
      ->type_name("K");
  parser->add_option("--within", options->within, "1 if a step is farther, in units of rounding")
      ->type_name("X");
  parser->add_flag("--json", options->json, "the figures as JSON");
  parser->add_flag("--quiet", options->quiet, "no progress");
  add_method_options(*parser, options->method);
  add_compiler_options(*parser, options->compiler);
  parser->add_flag("--interpret", options->interpret, "without one, 20 to 100 times slower");
  return {parser, [options] { return run_certify(*options); }};
}

}  // namespace hamgen::app
