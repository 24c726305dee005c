#include "generator/formats/cpp_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "generator/algebra/functions.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/numerics_text.hpp"
#include "generator/base/short_digest.hpp"
#include "generator/formats/cpp_dialect.hpp"
#include "generator/formats/cpp_interface.hpp"
#include "generator/formats/cpp_pieces.hpp"
#include "generator/formats/emit_context.hpp"
#include "generator/formats/lanes_dialect.hpp"
#include "generator/formats/numerics.hpp"
#include "generator/formats/preamble.hpp"
#include "generator/formats/support.hpp"
#include "generator/formats/use_lanes.hpp"

namespace hamgen {

namespace {

// The functions of quad numbers that are used, declared here rather than by <quadmath.h>, which
// clang does not find.
void declare_quad_functions(CodeWriter& out, const std::set<std::string>& functions) {
  std::set<std::string> declared;
  for (const std::string& function : functions) {
    const Function* row = find_function(function);
    const bool two = function == "pow" || (row != nullptr && row->arity == 2);
    const std::string name = row != nullptr ? std::string(row->quad) : function + "q";
    if (function == "fabs" || !declared.insert(name).second) continue;
    if (declared.size() == 1) {
      out.line();
      out.line("extern \"C\" {");
    }
    out.line(fmt::format("__extension__ __float128 {}(__float128{}) noexcept;", name,
                         two ? ", __float128" : ""));
  }
  if (!declared.empty()) out.line("}");
}

// Is there one that lanes have from the library, which no builtin is called by?
bool has_no_lanes(const std::set<std::string>& functions) {
  return !std::ranges::all_of(functions, CppDialect::has_own_lanes);
}

void write_includes(CodeWriter& out, const EmitContext& context, const Support& support) {
  const bool shared = context.options.shared_support;
  if (context.options.lanes > 0) {
    const std::optional<ArrayMatrix>& matrix = context.program.matrix;
    const bool sparse = matrix && matrix->kind == MatrixKind::eigen_sparse;
    if (sparse) out.line("#include <algorithm>");
    if (context.options.library_functions || !context.used.functions.empty())
      out.line("#include <cmath>");
    if (sparse) out.line("#include <vector>");
  } else if (context.quad()) {
    declare_quad_functions(out, context.used.functions);
  } else if ((!context.used.functions.empty() && !context.options.builtins) ||
             support.uses_cmath(shared) || has_no_lanes(context.used.functions)) {
    out.line("#include <cmath>");
  }
  if (support.uses_eigen()) {
    const std::optional<ArrayMatrix>& matrix = context.program.matrix;
    const bool sparse = matrix && matrix->kind == MatrixKind::eigen_sparse;
    if (sparse) out.line("#include <algorithm>");
    if (sparse) out.line("#include <vector>");
    out.line();
    out.line(sparse ? "#include <Eigen/SparseLU>" : "#include <Eigen/LU>");
  }
  if (!shared) return;
  out.line();
  out.line(fmt::format("#include \"{}\"",
                       shared_file_name(context.scalar, !context.program.events.empty())));
}

void write_pi(CodeWriter& out, const EmitContext& context) {
  // 50 digits, rounded by the compiler where the type is standard.
  const Rational pi = *parse_decimal("3.14159265358979323846264338327950288419716939937510");
  out.line(fmt::format("inline constexpr {} pi = {};",
                       context.options.lanes > 0 ? context.scalar.cpp : "Real",
                       literal(pi, context.scalar)));
}

// What is said of the system alone: equal for all of its methods.
std::string system_text(EmitContext& context) {
  CodeWriter pieces;
  write_pieces(pieces, context, context.contents.system);
  CodeWriter out;
  if (context.options.lanes == 0) {
    out.line(context.quad() ? "__extension__ typedef __float128 Real;"
                            : fmt::format("using Real = {};", context.scalar.cpp));
  }
  if (context.used.pi) write_pi(out, context);
  if (context.arrays()) {
    out.line(fmt::format("inline constexpr int n = {};  // degrees of freedom", context.n()));
  }
  if (!out.text().empty()) out.line();
  out.lines(pieces.text());
  return out.text();
}

std::string method_text(EmitContext& context) {
  const bool had_pi = context.used.pi;
  CodeWriter pieces;
  write_pieces(pieces, context, context.contents.method);
  CodeWriter out;
  if (context.used.pi && !had_pi) {
    write_pi(out, context);
    out.line();
  }
  if (const int lanes = context.stage_lanes(); lanes > 0) {
    out.line(fmt::format("using Lanes = Pack<{}>;  // numbers of so many stages", lanes));
    out.line();
  }
  out.lines(pieces.text());
  return out.text();
}

// The text in its namespace, once however many headers have it.  Another text of the same name does
// not mix with it: in one translation unit it is an error, and in two the inline namespace, named
// after the digest, keeps them apart.
void write_section(CodeWriter& out, std::string_view kind, const std::string& name_space,
                   const std::string& digest, const std::string& text, bool in_lanes) {
  std::string macro =
      fmt::format("HAMGEN_{}_{}", kind == "system" ? "SYSTEM" : "METHOD", name_space);
  for (auto at = macro.find("::"); at != std::string::npos; at = macro.find("::")) {
    macro.replace(at, 2, "_");
  }
  std::vector<std::string> spaces = {"namespace " + name_space,
                                     "inline namespace emitted_" + digest};
  if (in_lanes) spaces.push_back(std::string("inline namespace ") + kRegisters);
  CodeWriter section;
  for (const std::string& space : spaces) section.line(space + " {");
  section.line();
  section.lines(text);
  for (; !spaces.empty(); spaces.pop_back()) {
    const std::string& space = spaces.back();
    section.line("}  // namespace " + space.substr(space.rfind(' ') + 1));
  }
  write_once(out, macro, digest, kind, section.text());
}

std::unique_ptr<Dialect> dialect_of(const Program& program, const EmitOptions& options) {
  const ScalarType& scalar = find_scalar(options.scalar);
  const int n = program.environment.arrays ? program.environment.degrees_of_freedom : 0;
  if (options.lanes > 0) {
    return std::make_unique<LanesDialect>(scalar, n, options.library_functions);
  }
  return std::make_unique<CppDialect>(scalar, n, options.builtins, options.library_functions);
}

// The text, and before it what it uses of the fixed blocks.
std::string with_names(const Support& support, const std::string& text) {
  CodeWriter names;
  support.write_names(names, text);
  return names.text() + text;
}

// All but what a plugin has besides.
std::string file_text(EmitContext& context, const std::string& first_lines) {
  const EmitOptions& options = context.options;
  const std::string system = system_text(context);
  const std::string method = method_text(context);
  const bool in_lanes = options.lanes > 0;
  Support support(context.scalar, options.builtins, !context.program.events.empty(), options.lanes);
  support.require_for(in_lanes ? system + method : method);
  CodeWriter out;
  write_preamble(out, context);
  out.lines(first_lines);
  write_includes(out, context, support);
  out.line();
  out.lines(ieee_begin(context.scalar));
  out.line();
  if (in_lanes) {
    out.lines(cpp_numerics("shells/lane_registers"));
    out.line();
    support.write(out, false);
    write_section(out, "system", options.spaces.system, short_digest(system + support.digest()),
                  with_names(support, system), true);
  } else {
    write_section(out, "system", options.spaces.system, short_digest(system), system, false);
    support.write(out, options.shared_support);
  }
  const bool has_packs = context.stage_lanes() > 0;
  Support packs = Support::of_packs(context.scalar);
  if (has_packs) {
    packs.require_for(method);
    out.lines(cpp_numerics("shells/lane_registers"));
    out.line();
    packs.write(out, false);
  }
  const std::string digests = support.digest() + (has_packs ? packs.digest() : "");
  const std::string named = has_packs ? with_names(packs, method) : method;
  write_section(out, "method", options.spaces.of_method(), short_digest(system + method + digests),
                with_names(support, named), in_lanes || has_packs);
  out.lines(cpp_numerics("shells/ieee_end"));
  return out.text();
}

}  // namespace

std::string cpp_header(const Program& program, const EmitOptions& options) {
  if (options.lanes > 0) require_lanes(options);
  const std::unique_ptr<Dialect> dialect = dialect_of(program, options);
  EmitContext context(program, options, *dialect);
  return file_text(context, "#pragma once");
}

std::string cpp_plugin(const Program& program, const EmitOptions& options) {
  EmitOptions with_builtins = options;
  with_builtins.builtins = true;
  const std::unique_ptr<Dialect> dialect = dialect_of(program, with_builtins);
  EmitContext context(program, with_builtins, *dialect);
  CodeWriter out;
  out.lines(
      file_text(context, std::string(plugin_header()) + cpp_numerics("shells/plugin_memory")));
  write_interface(out, context);
  return out.text();
}

OutputFiles cpp_header_files(const Program& program, const EmitOptions& options) {
  OutputFiles files = {{options.file_name + ".hpp", cpp_header(program, options)}};
  if (options.shared_support)
    files.push_back(shared_file(find_scalar(options.scalar), !program.events.empty()));
  return files;
}

OutputFiles cpp_plugin_files(const Program& program, const EmitOptions& options) {
  refuse_lanes(options, "a plugin");
  if (options.shared_support) {
    throw UsageError("--support shared: a plugin is one translation unit\nhelp: drop --support");
  }
  if (!program.events.empty()) {
    throw UsageError(
        "--events with --format cpp-plugin: a plugin's interface has no events\n"
        "help: a cpp-header has them; hamgen run --events FILE finds them");
  }
  return {{options.file_name + ".plugin.cpp", cpp_plugin(program, options)},
          {"plugin.h", std::string(plugin_header()), OutputFile::Role::beside}};
}

}  // namespace hamgen
