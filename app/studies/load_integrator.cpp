#include "app/studies/load_integrator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <sstream>

#include "generator/base/diagnostic.hpp"
#include "generator/language/model.hpp"
#include "generator/language/scene.hpp"
#include "runtime/arithmetic.hpp"

namespace hamgen::app {

namespace {

// Has somebody said which machine it is for?
bool names_processor(const runtime::Compiler& compiler) {
  return std::ranges::any_of(compiler.command, [](const std::string& word) {
    return word.starts_with("-march=") || word.starts_with("-mcpu=");
  });
}

std::vector<std::string> words_of_flags(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

}  // namespace

runtime::Compiler chosen_compiler(const CompilerChoice& choice) {
  const bool names_program = !choice.program.empty();
  runtime::Compiler compiler =
      runtime::find_compiler(names_program ? std::optional(choice.program) : std::nullopt);
  const std::vector<std::string> flags = words_of_flags(choice.flags);
  if (!names_program && !flags.empty()) compiler.chosen_by = "--flags";
  compiler.command.insert(compiler.command.end(), flags.begin(), flags.end());
#if defined(__x86_64__) || defined(__i386__)
  // A plugin does not leave the machine; the cache knows which one it is for.
  if (!choice.portable && !names_processor(compiler))
    compiler.command.emplace_back("-march=native");
#endif
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
  source.model = plugin.model.name;
  source.scheme = plugin.scheme_name;
  return source;
}

// What is written out has few equal operations side by side: long registers cost it more than they
// give (Henon-Heiles 36 ns a step with them, 31 without).  Where it is longer g++ 12 mixes numbers
// up that it packs into 512 bits, as in steps of chains of 16 to 24.  Stages are packed as they are
// emitted, and what is packed besides costs time (double pendulum, gauss-16: 2.2 us a step, 1.6
// without).
//
// Note [products that are summed unrounded]
// Of two sums side by side, x y - z and u v + w, g++ 12.2 makes one instruction that does not round
// the products, also with -ffp-contract=off: what a product loses is then another number than the
// one that is summed.  So it has no such instruction.
runtime::Compiler compiler_for(const PluginSource& plugin, const CompilerChoice& choice) {
  runtime::Compiler compiler = chosen_compiler(choice);
#if defined(__x86_64__) || defined(__i386__)
  const bool has_width = std::ranges::any_of(compiler.command, [](const std::string& word) {
    return word.starts_with("-mprefer-vector-width=");
  });
  if (names_processor(compiler) && !plugin.in_loops && !has_width) {
    compiler.command.emplace_back(plugin.has_stages ? "-fno-tree-slp-vectorize"
                                                    : "-mprefer-vector-width=128");
  }
  compiler.command.emplace_back("-mno-fma");
  if (!plugin.has_stages) compiler.command.emplace_back("-mno-avx512vl");
  // With registers of 512 bits Eigen 3.4 has its products made by that instruction, and is no text
  // without it.
  if (plugin.needs_eigen) compiler.command.emplace_back("-mno-avx512f");
#endif
  return compiler;
}

}  // namespace

// Note [what the compiler is asked for]
// With g++ 12 the code of a small model takes 0.10 s at -O1 and 0.18 s at -O3, that of Gauss'
// methods 0.2 s, 0.3 s and up to 1 s at -O1, -O2, -O3, the linker included.  A step of -O1
// takes 1.1 to 3 times as long as one of -O3; at -O2 those of Gauss' methods are within a tenth of
// it, loops over arrays are not.  An operation of operations_per_step takes some 0.4 ns at -O3.
// At -O0, which takes half to three quarters of the time of -O1, a step is 4 to 30 times as long:
// some 10 ms where that is asked for.  An operation of quad numbers is a call that takes 30 ns at
// any level.  What a step computes is the same: no flag lets the optimiser change the arithmetic.
// A long text, of a large system written out, takes the optimiser long: 600 kB of 56 unknowns 7, 39
// and 83 s at -O0, -O1, -O3, so that -O1 costs 50 us a byte and -O3 as much again.  Of operations
// that take some 5 ns at -O0 and half a nanosecond more at -O1 than at -O3 1e4 and 1e5 repay a
// byte; of loops, of which 100 kB take 0.4, 0.7 and 1.3 s, 3e2 and 1e4.  In a long text an
// elimination by Eigen takes 4 ms at -O0, in a step of 2e4 operations: 1e7 make 2 s.
std::string optimisation_for(const PluginSource& plugin, double steps) {
  const double operations = steps * plugin.operations_per_step;
  const auto bytes = static_cast<double>(plugin.text.size());
  const bool is_long = bytes > 1e5 && !plugin.in_loops;
  // Eigen's eliminations are not counted.
  const double without_eigen = plugin.in_loops ? 3e2 * bytes : is_long ? 1e4 * bytes : 1e6;
  const double with_eigen = is_long ? 1e7 : 0;
  if (operations < (plugin.needs_eigen ? with_eigen : without_eigen)) return "-O0";
  const double repaid = plugin.in_loops ? 1e4 * bytes : is_long ? 1e5 * bytes : 1e8;
  if (operations < repaid || plugin.needs_quadmath) return "-O1";
  if (plugin.has_stages && operations < 5e9) return "-O2";
  return "-O3";
}

double steps_of_all(const Model& model, const SceneRequest& request, const SceneValues& scene,
                    const std::vector<std::string>& varied, double orbits) {
  if (names_computed_from(model, request, varied).contains("steps"))
    return std::numeric_limits<double>::infinity();
  return orbits * static_cast<double>(*scene.steps);
}

runtime::LoadedPlugin load_integrator(const PluginSource& plugin, const CompilerChoice& compiler,
                                      StopFlag stop, double steps) {
  runtime::CompileOptions options;
  options.optimisation = optimisation_for(plugin, steps);
  options.stop = stop;
  return runtime::load_plugin(to_compile(plugin), compiler_for(plugin, compiler), options,
                              runtime::open_cache());
}

std::string digest_of_code(const PluginSource& plugin, const CompilerChoice& compiler) {
  runtime::PluginSource source = to_compile(plugin);
  // The first lines say where the model is and how it was asked for.
  while (source.text.starts_with("//")) source.text.erase(0, source.text.find('\n') + 1);
  return runtime::cache_key(source, compiler_for(plugin, compiler), {});
}

}  // namespace hamgen::app
