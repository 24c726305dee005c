#include "generator/formats/cpp_dialect.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/algebra/functions.hpp"
#include "generator/base/fixed_blocks.hpp"

namespace hamgen {

std::string CppDialect::function(const std::string& name) const {
  const Function* row = find_function(name);
  if (scalar.digits == 113) return row != nullptr ? std::string(row->quad) : name + "q";
  const std::string cpp = row != nullptr ? std::string(row->cpp) : name;
  if (!builtins_) return "std::" + cpp;
  return "__builtin_" + cpp + function_suffix(scalar);
}

std::string CppDialect::lane_function(const std::string& name) const {
  // Those of both are exactly rounded.
  const bool same = name == "sqrt" || name == "abs";
  if (same || (!library_ && has_own_lanes(name))) return "lane_" + name;
  const Function* row = find_function(name);
  return fmt::format("library<std::{}>", row != nullptr ? std::string(row->cpp) : name);
}

bool CppDialect::has_own_lanes(const std::string& name) {
  return is_defined(lane_blocks(), "lane_" + name);
}

std::vector<std::string> CppDialect::taken_names() const {
  std::vector<std::string> names = {"lane_pow", "library"};
  for (const Function& row : all_functions()) names.push_back("lane_" + std::string(row.name));
  return names;
}

std::string CppDialect::argument(const Argument& argument, const std::string& name,
                                 const std::string& sizes) const {
  const std::string constant = argument.changes ? "" : "const ";
  const std::string named = name.empty() ? "" : " " + name;
  if (!argument.count.empty()) return argument.count + named;
  if (argument.sizes.empty() && argument.record.empty()) return "Real" + named;
  if (argument.decays) return constant + "Real*" + named;
  if (argument.sizes.empty())
    return constant + argument.record + "&" + (argument.alone ? " __restrict" : "") + named;
  return fmt::format("{}{} (&{}){}", constant, argument.record.empty() ? "Real" : argument.record,
                     name, sizes);
}

std::string CppDialect::head(const Routine& routine,
                             const std::vector<std::string>& arguments) const {
  const std::string type = routine.result.type.empty() ? "void" : routine.result.type;
  const std::string list = joined_texts(arguments, ", ");
  if (routine.of_run) return fmt::format("{} {}({})", type, routine.name, list);
  const char* attributes = routine.inlined        ? "[[nodiscard, gnu::always_inline]] "
                           : type == "StepReport" ? "[[nodiscard]] "
                                                  : "";
  return fmt::format("{}inline {} {}({})", attributes, type, routine.name, list);
}

std::string CppDialect::call(const std::string&, const std::string& object,
                             const std::string& action, const std::string& arguments) const {
  return fmt::format("{}{}{}({})", object, action.empty() ? "" : ".", action, arguments);
}

std::string CppDialect::kept(const std::string& name) const {
  const std::size_t bracket = std::min(name.find('['), name.size());
  return name.substr(0, bracket) + "_" + name.substr(bracket);
}

}  // namespace hamgen
