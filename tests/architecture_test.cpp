// Who may include what.  The stages of the pipeline depend backwards only, GiNaC stays where it
// derives, and neither the runtime nor an emitted file needs the generator.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/architecture_rules.hpp"

namespace {

namespace fs = std::filesystem;
using architecture::classify;
using architecture::External;
using architecture::free_of_ginac;
using architecture::Include;
using architecture::violation;

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    lines.push_back(text.substr(0, text.find('\n')));
    text.remove_prefix(std::min(lines.back().size() + 1, text.size()));
  }
  return lines;
}

// Takes a word from the start of the line.
bool take(std::string_view& line, std::string_view word) {
  if (!line.starts_with(word)) return false;
  line.remove_prefix(word.size());
  return true;
}

void skip_blanks(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
}

std::vector<Include> includes_of(std::string_view text) {
  std::vector<Include> found;
  for (std::string_view line : lines_of(text)) {
    skip_blanks(line);
    if (!take(line, "#")) continue;
    skip_blanks(line);
    if (!take(line, "include")) continue;
    skip_blanks(line);
    const bool angled = line.starts_with("<");
    if (!take(line, "<") && !take(line, "\"")) continue;
    const std::size_t end = line.find_first_of("\">");
    if (end == line.npos) continue;
    found.push_back({.name = std::string(line.substr(0, end)), .angled = angled});
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
      const std::string_view stem =
          name.ends_with(".in") ? std::string_view(name).substr(0, name.size() - 3) : name;
      if (!entry.is_regular_file() ||
          !(stem.ends_with(".h") || stem.ends_with(".hpp") || stem.ends_with(".cpp"))) {
        continue;
      }
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
std::vector<std::string> types_of(std::string_view text) {
  std::vector<std::string> found;
  std::string space;
  for (std::string_view line : lines_of(text)) {
    if (take(line, "namespace ")) {
      const std::string_view name = line.substr(0, line.find(' '));
      if (line.substr(name.size()).starts_with(" {")) space = name;
      continue;
    }
    if (!take(line, "struct ") && !take(line, "class ") && !take(line, "enum class ") &&
        !take(line, "enum ")) {
      continue;
    }
    const auto ends = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_';
    };
    const std::string_view name(line.begin(), std::ranges::find_if(line, ends));
    line.remove_prefix(name.size());
    if (name.empty() || line.starts_with("<") || line.starts_with("::")) continue;
    const std::size_t open = line.find('{');
    if (open < line.find(';')) found.push_back(space + "::" + std::string(name));
  }
  return found;
}

// The chain of files from `file` to an include that is looked for, empty if there is none.
std::string path_to(const std::map<std::string, std::vector<Include>>& tree,
                    const std::string& file, const std::function<bool(const Include&)>& is_wanted,
                    std::set<std::string>& seen) {
  const auto found = tree.find(file);
  if (found == tree.end() || !seen.insert(file).second) return {};
  for (const Include& include : found->second) {
    if (is_wanted(include)) return file + " -> " + include.name;
    if (include.angled) continue;
    const std::string rest = path_to(tree, include.name, is_wanted, seen);
    if (!rest.empty()) return file + " -> " + rest;
  }
  return {};
}

bool is_of_ginac(const Include& include) {
  return include.angled && classify(include.name) == External::ginac;
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
    EXPECT_EQ(path_to(tree, file, is_of_ginac, seen), "");
  }
}

// What is printed, run or read back is the Program: the plan and the method do not get that far.
TEST(Architecture, FormatsAndTheReaderSeeNeitherPlanNorMethod) {
  const auto tree = read_tree();
  const auto is_earlier = [](const Include& include) {
    return include.name == "generator/solvers/solve_plan.hpp" ||
           include.name == "generator/program/lowered_step.hpp" ||
           include.name.starts_with("generator/schemes/") ||
           include.name.starts_with("generator/equations/");
  };
  int files = 0;
  for (const auto& [file, includes] : tree) {
    const bool is_late = file.starts_with("generator/formats/") ||
                         file.starts_with("generator/readback/") ||
                         file.starts_with("generator/interpreter/");
    if (!is_late) continue;
    ++files;
    std::set<std::string> seen;
    EXPECT_EQ(path_to(tree, file, is_earlier, seen), "");
  }
  EXPECT_GT(files, 50);
  // The control: who builds the Program does see them.
  std::set<std::string> seen;
  EXPECT_NE(path_to(tree, "generator/program/build_program.cpp", is_earlier, seen), "");
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
  EXPECT_EQ(path_to(tree, "generator/solvers/a.cpp", is_of_ginac, seen),
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
    const bool in_lanes = file.starts_with("generator/numerics/lane_") ||
                          file.starts_with("generator/numerics/ends/lane_");
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
