// hamgen new: a model to begin with.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/command_line.hpp"
#include "app/output/terminal.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/quoted_text.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {
namespace {

constexpr const char* kModel =
    R"(# {0}: a particle in two wells with a weak force across.  Change whatever you like:
#   hamgen check {1}       mistakes, each where it is
#   hamgen run {1}         integrates the scene
#   hamgen verify {1}      what is proved of the step
#   hamgen bench {1}       which method reaches which error soonest
system {0}

coordinate x, y [m]      # one momentum for each, in the same order
momentum px, py

parameter m = 1 [kg]     # changed for a run by --set m=2, without compiling again
parameter k = 0.5        # of the force across

let r2 = x^2 + y^2       # a name for what occurs often
let wells = (x^2 - 1)^2/4

# + - * / ^, sin, exp, sqrt, ...: hamgen list functions
H = (px^2 + py^2)/(2*m) + wells + k*y^2/2 + r2^2/20

# invariant L = x*py - y*px    is watched along a run, and verify says whether H conserves it

scene slow {{             # where a run begins, its step and its length
  x = 1.3                # what is not given is 0
  py = 0.2
  h = 0.05
  steps = 2000
}}
)";

// The name of a system: letters, digits, underscores, a letter first.
void require_name(const std::string& name) {
  constexpr std::size_t longest = 64;
  bool good =
      !name.empty() && name.size() <= longest && name[0] != '_' && (name[0] < '0' || name[0] > '9');
  for (const char c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    good = good && (letter || (c >= '0' && c <= '9') || c == '_');
  }
  if (!good) {
    throw UsageError(
        fmt::format("new {}: no name of a system\nhelp: letters, digits and underscores, "
                    "a letter first, at most 64: hamgen new my_system",
                    visible_text(name)));
  }
}

int make_model(const std::string& name) {
  require_name(name);
  const std::filesystem::path path = name + ".ham";
  if (std::filesystem::exists(path))
    throw UsageError(fmt::format("new {}: {} is there already", name, path.string()));
  if (!runtime::atomic_write(path, fmt::format(fmt::runtime(kModel), name, path.string()))) {
    throw runtime::ToolError({.message = fmt::format("cannot write {}", path.string()),
                              .command = {},
                              .exit_status = {},
                              .output_tail = {}});
  }
  print(path.string() + "\n");
  print_error(fmt::format("help: look into it, then: hamgen run {}\n", path.string()));
  return done;
}

}  // namespace

Command add_new(CLI::App& app) {
  const auto name = std::make_shared<std::string>();
  CLI::App* parser = app.add_subcommand("new", "writes NAME.ham, a model to begin with");
  parser->add_option("NAME", *name, "of the system: letters, digits, underscores")->required();
  return {parser, [name] { return make_model(*name); }};
}

}  // namespace hamgen::app
