#include "tests/architecture_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace architecture {

namespace {

struct Rule {
  std::string_view folder;           // of the including file; the longest that fits counts
  std::vector<std::string> project;  // folders (with a slash at the end) and files it may include
  std::vector<External> external;    // angled includes besides the C++ standard library
};

// The stages as one, and the values that go in and come out.
std::vector<std::string> with_generator_values(std::vector<std::string> folders) {
  folders.insert(folders.end(), {"generator/pipeline.hpp", "generator/base/", "generator/algebra/",
                                 "generator/language/", "generator/mechanics/",
                                 "generator/schemes/", "generator/specialise/", "generator/verify/",
                                 "generator/readback/read_back.hpp", "runtime/"});
  return folders;
}

const std::vector<Rule>& rules() {
  using enum External;
  static const std::vector<Rule> table = {
      {"generator/base/", {"generator/base/"}, {fmt}},
      // GiNaC: see ginac_border() for the files that may name it.
      {"generator/algebra/",
       {"generator/algebra/", "generator/base/"},
       {fmt, gmp, ginac, quadmath}},
      {"generator/language/",
       {"generator/language/", "generator/base/", "generator/algebra/functions.hpp",
        "generator/algebra/exact.hpp"},
       {fmt}},
      {"generator/mechanics/",
       {"generator/mechanics/", "generator/language/", "generator/algebra/", "generator/base/"},
       {fmt, ginac}},
      {"generator/schemes/",
       {"generator/schemes/", "generator/mechanics/", "generator/language/", "generator/algebra/",
        "generator/base/"},
       {fmt, ginac}},
      {"generator/schemes/matrix_function.cpp",
       {"generator/schemes/", "generator/mechanics/", "generator/algebra/", "generator/base/"},
       {ginac, eigen, other}},
      // What a scene does not need, left out.
      {"generator/specialise/",
       {"generator/specialise/", "generator/schemes/", "generator/mechanics/",
        "generator/language/", "generator/algebra/", "generator/base/"},
       {fmt, ginac}},
      {"generator/equations/",
       {"generator/equations/", "generator/schemes/", "generator/mechanics/", "generator/language/",
        "generator/algebra/", "generator/base/"},
       {fmt, ginac}},
      {"generator/solvers/",
       {"generator/solvers/", "generator/equations/", "generator/schemes/", "generator/mechanics/",
        "generator/language/model.hpp", "generator/algebra/expression.hpp",
        "generator/algebra/exact.hpp", "generator/base/"},
       {fmt}},
      {"generator/program/",
       {"generator/program/", "generator/solvers/", "generator/equations/", "generator/schemes/",
        "generator/mechanics/", "generator/language/model.hpp", "generator/algebra/expression.hpp",
        "generator/algebra/exact.hpp", "generator/algebra/functions.hpp", "generator/base/"},
       {fmt}},
      // Routines and the numerics they call, run without a compiler.
      {"generator/interpreter/",
       {"generator/interpreter/", "generator/program/", "generator/numerics/",
        "generator/algebra/expression.hpp", "generator/algebra/exact.hpp",
        "generator/algebra/functions.hpp", "generator/base/"},
       {fmt, gmp, quadmath}},
      // Only the names they are given: they are copied into emitted files.
      {"generator/numerics/", {}, {}},
      // Expressions are what a Program's instructions hold; functions know their C++ names.
      {"generator/formats/",
       {"generator/formats/", "generator/program/", "generator/algebra/expression.hpp",
        "generator/algebra/exact.hpp", "generator/algebra/functions.hpp",
        "generator/algebra/scalar.hpp", "generator/base/"},
       {fmt}},
      {"generator/verify/",
       {"generator/specialise/", "generator/verify/", "generator/program/",
        "generator/solvers/solve_plan.hpp", "generator/equations/", "generator/schemes/",
        "generator/mechanics/", "generator/language/", "generator/algebra/", "generator/base/"},
       {fmt, ginac}},
      // Eigenvalues of the linear part.
      {"generator/verify/linear_",
       {"generator/verify/", "generator/schemes/", "generator/mechanics/", "generator/algebra/"},
       {fmt, eigen}},
      // Nothing of what writes the text.
      {"generator/readback/",
       {"generator/readback/", "generator/program/", "generator/algebra/expression.hpp",
        "generator/algebra/functions.hpp", "generator/algebra/exact.hpp", "generator/base/"},
       {fmt}},
      {"generator/", {"generator/"}, {fmt}},
      // Events are found as emitted files find them.
      {"runtime/event.cpp", {"runtime/", "generator/numerics/"}, {fmt, system}},
      {"runtime/", {"runtime/"}, {fmt, system}},
      // What a command measures, without a screen.
      {"app/studies/",
       with_generator_values({"app/studies/", "generator/interpreter/"}),
       {fmt, eigen, other}},
      // Ball arithmetic stays in these: without Arb they are not compiled.
      {"app/studies/ball", with_generator_values({"app/studies/ball"}), {fmt, arb}},
      // How values of studies look.
      {"app/output/", with_generator_values({"app/output/", "app/studies/"}), {fmt, other}},
      {"app/output/wide_text.", {"app/output/", "runtime/"}, {quadmath}},
      {"app/", {"app/", "generator/", "runtime/"}, {fmt, system, other}},
      // They measure with the studies, without the command, and with what tests measure by.
      {"benchmarks/",
       {"benchmarks/", "app/studies/", "generator/", "runtime/", "tests/contract/",
        "tests/numerics_blocks/"},
       {fmt, other}},
      // Time and memory of the command as a process.
      {"benchmarks/cost/",
       {"benchmarks/", "app/studies/", "generator/", "runtime/"},
       {fmt, system, other}},
      {"generated/", {}, {eigen, quadmath}},
  };
  return table;
}

}  // namespace

External classify(std::string_view name) {
  if (name.starts_with("fmt/")) return External::fmt;
  if (name.starts_with("ginac/") || name.starts_with("cln/")) return External::ginac;
  if (name == "gmp.h" || name == "gmpxx.h") return External::gmp;
  if (name.starts_with("Eigen/")) return External::eigen;
  if (name == "arb.h" || name.starts_with("flint/")) return External::arb;
  if (name == "quadmath.h") return External::quadmath;
  if (name == "nlopt.h" || name == "hdf5.h" || name == "mpi.h") return External::other;
  if (name.find_first_of("./") == std::string_view::npos) return External::standard;
  if (name.starts_with("sys/")) return External::system;
  if (name.ends_with(".h") && name.find('/') == std::string_view::npos) return External::system;
  return External::other;
}

namespace {

// The files of algebra that may name GiNaC.
bool ginac_border(std::string_view file) {
  return file == "generator/algebra/evaluate_function.cpp" ||
         file.starts_with("generator/algebra/exact.") ||
         file.find("ginac") != std::string_view::npos;
}

}  // namespace

bool free_of_ginac(std::string_view file) {
  const std::vector<std::string_view> folders = {"generator/base/",    "generator/language/",
                                                 "generator/solvers/", "generator/program/",
                                                 "generator/formats/", "runtime/"};
  return std::ranges::any_of(folders, [&](auto folder) { return file.starts_with(folder); });
}

std::optional<std::string> violation(std::string_view file, const Include& include) {
  const Rule* rule = nullptr;
  for (const Rule& candidate : rules()) {
    const bool longer = !rule || candidate.folder.size() > rule->folder.size();
    if (file.starts_with(candidate.folder) && longer) rule = &candidate;
  }
  if (!rule) return fmt::format("{}: in no folder of the table", file);

  const auto fault = [&](std::string_view why) {
    return fmt::format("{} includes {}: {}", file, include.name, why);
  };
  if (include.angled) {
    const External kind = classify(include.name);
    if (kind == External::standard) return {};
    if (std::ranges::find(rule->external, kind) == rule->external.end()) {
      return fault("not a library for this folder");
    }
    if (kind == External::ginac && file.starts_with("generator/algebra/") && !ginac_border(file)) {
      return fault("GiNaC is named in evaluate_function.cpp, exact and the ginac files only");
    }
    return {};
  }
  if (file.ends_with(".plugin.cpp") && include.name.ends_with("plugin.h")) return {};
  const bool allowed = std::ranges::any_of(rule->project, [&](const std::string& prefix) {
    const bool is_start = prefix.ends_with('/') || !prefix.ends_with("pp");
    return is_start ? include.name.starts_with(prefix) : include.name == prefix;
  });
  if (!allowed) return fault("not below this folder in the pipeline");
  return {};
}

}  // namespace architecture
