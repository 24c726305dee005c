// Who may include what.  The stages of the pipeline depend backwards only, GiNaC stays where it
// derives, and neither the runtime nor an emitted file needs the generator.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Include {
  std::string name;  // as between the quotes or brackets
  bool angled = false;
  bool operator==(const Include&) const = default;
};

enum class External { standard, system, fmt, gmp, ginac, eigen, quadmath, arb, other };

struct Rule {
  std::string_view folder;           // of the including file; the longest that fits counts
  std::vector<std::string> project;  // folders (with a slash at the end) and files it may include
  std::vector<External> external;    // angled includes besides the C++ standard library
};

// The stages as one, and the values that go in and come out.
std::vector<std::string> with_generator_values(std::vector<std::string> folders) {
  folders.insert(
      folders.end(),
      {"generator/pipeline.hpp", "generator/base/", "generator/algebra/", "generator/language/",
       "generator/mechanics/", "generator/schemes/", "generator/specialise/", "generator/verify/",
       "generator/formats/scalar.hpp", "generator/readback/read_back.hpp", "runtime/"});
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
      // Expressions are what a LoweredStep's instructions hold; functions know their C++ names.
      {"generator/formats/",
       {"generator/formats/", "generator/program/", "generator/algebra/expression.hpp",
        "generator/algebra/exact.hpp", "generator/algebra/functions.hpp", "generator/base/"},
       {fmt}},
      {"generator/verify/",
       {"generator/specialise/", "generator/verify/", "generator/program/", "generator/equations/",
        "generator/schemes/", "generator/mechanics/", "generator/language/", "generator/algebra/",
        "generator/base/"},
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

// The files of algebra that may name GiNaC.
bool ginac_border(std::string_view file) {
  return file == "generator/algebra/evaluate_function.cpp" ||
         file.starts_with("generator/algebra/exact.") ||
         file.find("ginac") != std::string_view::npos;
}

// Folders that may not see GiNaC even through a header they include.
bool free_of_ginac(std::string_view file) {
  const std::vector<std::string_view> folders = {"generator/base/",    "generator/language/",
                                                 "generator/solvers/", "generator/program/",
                                                 "generator/formats/", "runtime/"};
  return std::ranges::any_of(folders, [&](auto folder) { return file.starts_with(folder); });
}

// What is wrong with the include, or nothing.  Paths are relative to the root of the tree.
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

std::vector<Include> includes_of(const std::string& text) {
  static const std::regex line(R"re((?:^|\n)[ \t]*#[ \t]*include[ \t]*([<"])([^>"\n]*)[>"])re");
  std::vector<Include> found;
  for (std::sregex_iterator match(text.begin(), text.end(), line), end; match != end; ++match) {
    found.push_back({.name = (*match)[2], .angled = (*match)[1] == "<"});
  }
  return found;
}

// Relative path -> text, for every C or C++ file of the folders with rules.
std::map<std::string, std::string> read_texts() {
  const fs::path root = HAMGEN_SOURCE_DIR;
  std::map<std::string, std::string> texts;
  for (const char* folder : {"generator", "runtime", "app", "benchmarks", "generated"}) {
    if (!fs::exists(root / folder)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string name = entry.path().filename().string();
      static const std::regex source(R"(.*\.(h|hpp|cpp|h\.in|hpp\.in|cpp\.in))");
      if (!entry.is_regular_file() || !std::regex_match(name, source)) continue;
      std::ifstream in(entry.path());
      texts[entry.path().lexically_relative(root).generic_string()] =
          std::string(std::istreambuf_iterator<char>(in), {});
    }
  }
  return texts;
}

std::map<std::string, std::vector<Include>> read_tree() {
  std::map<std::string, std::vector<Include>> tree;
  for (const auto& [file, text] : read_texts()) tree[file] = includes_of(text);
  return tree;
}

// The types a header defines at namespace scope, with their namespace: "hamgen::Model".  A
// specialisation of a template is no type of its own.
std::vector<std::string> types_of(const std::string& text) {
  static const std::regex line(R"((?:^|\n)(?:namespace ([\w:]+) \{|)"
                               R"((?:struct|class|enum class|enum) (\w+)\b(?!<|::)[^;\n]*\{))");
  std::vector<std::string> found;
  std::string space;
  for (std::sregex_iterator match(text.begin(), text.end(), line), end; match != end; ++match) {
    if ((*match)[1].matched) {
      space = (*match)[1];
    } else {
      found.push_back(space + "::" + (*match)[2].str());
    }
  }
  return found;
}

// The chain of files from `file` to GiNaC, empty if there is none.
std::string path_to_ginac(const std::map<std::string, std::vector<Include>>& tree,
                          const std::string& file, std::set<std::string>& seen) {
  const auto found = tree.find(file);
  if (found == tree.end() || !seen.insert(file).second) return {};
  for (const Include& include : found->second) {
    if (include.angled && classify(include.name) == External::ginac) {
      return file + " -> " + include.name;
    }
    if (include.angled) continue;
    const std::string rest = path_to_ginac(tree, include.name, seen);
    if (!rest.empty()) return file + " -> " + rest;
  }
  return {};
}

TEST(Architecture, EveryIncludeIsAllowed) {
  const auto tree = read_tree();
  EXPECT_GT(tree.size(), 50U) << "the tree was not found";
  for (const auto& [file, includes] : tree) {
    for (const Include& include : includes) {
      const auto fault = violation(file, include);
      EXPECT_FALSE(fault) << *fault;
    }
  }
}

TEST(Architecture, GinacIsNotReachedThroughAHeaderEither) {
  const auto tree = read_tree();
  for (const auto& [file, includes] : tree) {
    if (!free_of_ginac(file)) continue;
    std::set<std::string> seen;
    EXPECT_EQ(path_to_ginac(tree, file, seen), "");
  }
}

// The negative control: each of these breaks the table in its own way.
TEST(Architecture, AForbiddenIncludeIsFound) {
  const std::vector<std::pair<std::string, Include>> forbidden = {
      {"generator/base/text.cpp", {"generator/algebra/exact.hpp", false}},
      {"generator/base/text.cpp", {"gmpxx.h", true}},
      {"generator/base/text.cpp", {"unistd.h", true}},
      {"generator/algebra/expression.cpp", {"ginac/ginac.h", true}},
      {"generator/algebra/expression.cpp", {"generator/language/model.hpp", false}},
      {"generator/language/lexer.cpp", {"generator/algebra/expression.hpp", false}},
      {"generator/language/lexer.cpp", {"ginac/ginac.h", true}},
      {"generator/mechanics/derive.cpp", {"generator/schemes/scheme.hpp", false}},
      {"generator/schemes/family.cpp", {"generator/equations/step_equations.hpp", false}},
      {"generator/equations/discretise.cpp", {"generator/solvers/solve_plan.hpp", false}},
      {"generator/solvers/blocks.cpp", {"generator/algebra/from_ginac.hpp", false}},
      {"generator/solvers/blocks.cpp", {"generator/program/program.hpp", false}},
      {"generator/solvers/blocks.cpp", {"ginac/ginac.h", true}},
      {"generator/program/names.cpp", {"generator/formats/all_formats.hpp", false}},
      {"generator/numerics/history.hpp", {"generator/numerics/two_sum.hpp", false}},
      {"generator/numerics/history.hpp", {"fmt/format.h", true}},
      {"generator/formats/cpp_header.cpp", {"generator/mechanics/mechanics.hpp", false}},
      {"generator/formats/cpp_header.cpp", {"generator/numerics/history.hpp", false}},
      {"generator/formats/cpp_header.cpp", {"cln/cln.h", true}},
      {"generator/formats/cpp_header.cpp", {"runtime/plugin.h", false}},
      {"generator/verify/order.cpp", {"generator/formats/cpp_header.hpp", false}},
      {"generator/pipeline.cpp", {"runtime/compiler.hpp", false}},
      {"generator/pipeline.cpp", {"app/command_line.hpp", false}},
      {"runtime/compiler.cpp", {"generator/base/text.hpp", false}},
      {"runtime/compiler.cpp", {"ginac/ginac.h", true}},
      {"runtime/compiler.cpp", {"Eigen/Dense", true}},
      {"app/run.cpp", {"tests/helper.hpp", false}},
      {"app/studies/reference.cpp", {"app/output/plot.hpp", false}},
      {"app/studies/reference.cpp", {"app/command_line.hpp", false}},
      {"app/studies/reference.cpp", {"app/interrupt.hpp", false}},
      {"app/studies/reference.cpp", {"generator/program/program.hpp", false}},
      {"app/studies/reference.cpp", {"generator/formats/all_formats.hpp", false}},
      {"app/output/plot.cpp", {"app/command_line.hpp", false}},
      {"benchmarks/peers/peer.cpp", {"app/output/plot.hpp", false}},
      {"generated/pendulum.hpp", {"fmt/format.h", true}},
      {"generated/pendulum.hpp", {"runtime/plugin.h", false}},
      {"generated/pendulum.hpp", {"generator/base/text.hpp", false}},
      {"elsewhere/file.cpp", {"vector", true}},
  };
  for (const auto& [file, include] : forbidden) {
    EXPECT_TRUE(violation(file, include)) << file << " includes " << include.name;
  }
}

TEST(Architecture, AnAllowedIncludeIsNotFound) {
  const std::vector<std::pair<std::string, Include>> allowed = {
      {"generator/base/text.cpp", {"vector", true}},
      {"generator/base/text.cpp", {"fmt/format.h", true}},
      {"generator/algebra/from_ginac.hpp", {"ginac/ginac.h", true}},
      {"generator/language/model.hpp", {"generator/algebra/functions.hpp", false}},
      {"generator/mechanics/derive.cpp", {"ginac/ginac.h", true}},
      {"generator/solvers/blocks.cpp", {"generator/equations/step_equations.hpp", false}},
      {"generator/formats/cpp_header.cpp", {"generator/program/program.hpp", false}},
      {"generator/pipeline.cpp", {"generator/formats/all_formats.hpp", false}},
      {"runtime/library.cpp", {"dlfcn.h", true}},
      {"runtime/library.cpp", {"sys/stat.h", true}},
      {"app/run.cpp", {"CLI/CLI.hpp", true}},
      {"app/run.cpp", {"app/studies/reference.hpp", false}},
      {"app/run.cpp", {"app/output/plot.hpp", false}},
      {"app/studies/reference.cpp", {"generator/pipeline.hpp", false}},
      {"app/output/bench_output.cpp", {"app/studies/bench_choice.hpp", false}},
      {"benchmarks/peers/peer.cpp", {"app/studies/bench_measure.hpp", false}},
      {"generated/pendulum.hpp", {"cmath", true}},
      {"generated/pendulum.plugin.cpp", {"plugin.h", false}},
  };
  for (const auto& [file, include] : allowed) {
    EXPECT_FALSE(violation(file, include)) << *violation(file, include);
  }
}

TEST(Architecture, IncludeLinesAreReadHoweverTheyAreSpaced) {
  const std::string text =
      "#include <cmath>\n  #  include\t\"a/b.hpp\"\n// #include <vector>\n"
      "const char* s = \"#include <map>\";\n#include<ginac/ginac.h>  // why\n";
  const std::vector<Include> expected = {
      {"cmath", true}, {"a/b.hpp", false}, {"ginac/ginac.h", true}};
  EXPECT_EQ(includes_of(text), expected);
}

TEST(Architecture, AChainToGinacIsNamed) {
  const std::map<std::string, std::vector<Include>> tree = {
      {"generator/solvers/a.cpp", {{"vector", true}, {"generator/mechanics/b.hpp", false}}},
      {"generator/mechanics/b.hpp", {{"generator/mechanics/c.hpp", false}}},
      {"generator/mechanics/c.hpp", {{"ginac/ginac.h", true}}}};
  std::set<std::string> seen;
  EXPECT_EQ(path_to_ginac(tree, "generator/solvers/a.cpp", seen),
            "generator/solvers/a.cpp -> generator/mechanics/b.hpp -> generator/mechanics/c.hpp -> "
            "ginac/ginac.h");
}

// Two headers that never meet may each define a type of one name; the linker then merges their
// inline functions, and the program does what it likes.  No compiler warns of it.
TEST(Architecture, ATypeHasOneDefinition) {
  std::map<std::string, std::string> defined_in;
  for (const auto& [file, text] : read_texts()) {
    if (!file.ends_with(".hpp") || file.starts_with("generated/")) continue;
    // Blocks stand in no namespace: where Real is a pack, emitted ones are in another.
    const bool in_lanes = file.starts_with("generator/numerics/lane_");
    for (const std::string& name : types_of(text)) {
      const std::string type = in_lanes ? "lanes" + name : name;
      const auto [first, added] = defined_in.emplace(type, file);
      EXPECT_TRUE(added) << type << " is defined in " << first->second << " and in " << file;
    }
  }
  EXPECT_TRUE(defined_in.contains("hamgen::Model")) << "no types were found";
}

TEST(Architecture, TypesAreReadWithTheirNamespace) {
  const std::string text =
      "namespace hamgen {\nstruct Model;\nstruct Model {  // one\n  struct Inner {};\n};\n"
      "enum class Kind : int { a };\ntemplate <>\nstruct Many<Kind> {\n};\nstruct Model::Later "
      "{\n};\n}\n"
      "namespace hamgen::app {\nclass Command : public X {\n};\n";
  const std::vector<std::string> expected = {"hamgen::Model", "hamgen::Kind",
                                             "hamgen::app::Command"};
  EXPECT_EQ(types_of(text), expected);
}

}  // namespace
