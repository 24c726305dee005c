#include "generator/formats/c_dialect.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/algebra/functions.hpp"

namespace hamgen {

namespace {

// What a system has whatever its method.
constexpr std::string_view kOfSystem[] = {"Parameters", "State",      "energy",
                                          "gradient",   "invariants", "default_parameters"};

std::string with_underscores(std::string text) {
  for (auto at = text.find("::"); at != std::string::npos; at = text.find("::")) {
    text.replace(at, 2, "_");
  }
  return text;
}

}  // namespace

CDialect::CDialect(const CFamily& of, const ScalarType& scalar_type, const EmittedSpaces& spaces)
    : Dialect(scalar_type, 0),
      family(of),
      system_(with_underscores(spaces.system)),
      method_(with_underscores(spaces.of_method())) {}

std::string CDialect::function(const std::string& name) const {
  const Function* row = find_function(name);
  const std::string called = row != nullptr ? std::string(row->cpp) : name;
  return family.has_suffixes ? called + function_suffix(scalar) : called;
}

std::string CDialect::block(const std::string& name) const {
  return "hamgen_" + name + function_suffix(scalar);
}

std::string CDialect::type(const std::string& name) const {
  if (name == "Real") return real();
  if (name.starts_with("NewtonRule")) return block("NewtonRule");
  if (name.starts_with("History")) return named("History");
  if (name == "StepReport" || name == "Verdict") return block(name);
  const bool own = name == "bool" || name == "int" || name == "long long" || name == "void";
  return own ? name : named(name);
}

std::string CDialect::argument(const Argument& argument, const std::string& name,
                               const std::string& sizes) const {
  const std::string constant = argument.changes ? "" : "const ";
  if (!argument.count.empty()) return argument.count + " " + name;
  if (argument.sizes.empty() && argument.record.empty()) return real() + " " + name;
  const bool is_row = argument.sizes.size() == 1 && argument.record.empty();
  if (argument.decays || (is_row && !family.has_array_arguments))
    return fmt::format("{}{}* {}", constant, real(), name);
  if (argument.sizes.empty()) {
    return fmt::format("{}{}* {}", constant, type(argument.record), name);
  }
  return fmt::format("{}{} {}{}", constant, real(), name, sizes);
}

std::string CDialect::head(const Routine& routine,
                           const std::vector<std::string>& arguments) const {
  const std::string result = type(routine.result.type.empty() ? "void" : routine.result.type);
  const std::string list = joined_texts(arguments, ", ");
  if (!routine.of_run)
    return fmt::format("static inline {} {}({})", result, named(routine.name), list);
  return fmt::format("static inline {0} {1}_{2}({1}* self{3}{4})", result, named("Propagator"),
                     routine.name, list.empty() ? "" : ", ", list);
}

std::string CDialect::call(const std::string& type, const std::string& object,
                           const std::string& action, const std::string& arguments) const {
  if (action == "watch") {
    const std::size_t comma = arguments.find(',');
    return fmt::format("{}(&{}, &{}{})", named("History_watch"), arguments.substr(0, comma), object,
                       arguments.substr(comma));
  }
  // The type of a History is the method's, and so is what it does.
  const std::string name = type + "_" + (action.empty() ? "check" : action);
  return fmt::format("{}(&{}{}{})", type == "History" ? named(name) : block(name), object,
                     arguments.empty() ? "" : ", ", arguments);
}

std::string CDialect::call_of_run(const std::string& routine_name,
                                  const std::string& arguments) const {
  return fmt::format("{}_{}(self{}{})", named("Propagator"), routine_name,
                     arguments.empty() ? "" : ", ", arguments);
}

std::string CDialect::named(const std::string& name) const {
  const bool of_system = std::ranges::find(kOfSystem, name) != std::end(kOfSystem);
  return (of_system ? system_ : method_) + "_" + name;
}

}  // namespace hamgen
