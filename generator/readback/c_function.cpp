#include "generator/readback/c_function.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/program/arithmetic.hpp"
#include "generator/readback/c_names.hpp"
#include "generator/readback/findings.hpp"

namespace hamgen {

namespace {

using NodeKind = CppExpression::Kind;

constexpr std::string_view kOfRun = "Propagator_";

// "solve" of "@solve"; empty for any other name.
std::string of_header(const std::string& name) {
  return name.starts_with(kOfHeader) ? name.substr(1) : std::string();
}

[[noreturn]] void differ(int line, const std::string& what) { throw TextDifference(line, what); }

// Are all its fields zero in a record that begins with what C++ gives it?
bool begins_with_zeros(const Record& record) {
  return std::ranges::all_of(record.fields, [](const Field& field) {
    return !field.type.starts_with("NewtonRule") &&
           std::ranges::all_of(field.values, [](const Rational& value) { return value == 0; });
  });
}

class AddressReader {
 public:
  AddressReader(const CppFunction& written, const Program& code, const Propagator* run)
      : function_(written), code_(code), run_(run) {}

  CppFunction run() {
    function_.name = of_header(function_.name);
    if (function_.name.empty()) differ(function_.line, "a function without its prefix");
    function_.type = type(function_.type, function_.line);
    for (CppArgument& argument : function_.arguments) read(argument);
    read(function_.body);
    if (run_ != nullptr) leave_out_run();
    return std::move(function_);
  }

 private:
  [[nodiscard]] std::string type(const std::string& name, int line) const {
    const std::string ours = of_header(name);
    if (!ours.empty()) return ours;
    if (name != "void" && name != "int" && name != "bool" && name != "long long")
      differ(line, fmt::format("'{}' is no type of this header", name));
    return name;
  }

  // Propagator_step(Propagator* self, ...)
  void leave_out_run() {
    std::vector<CppArgument>& arguments = function_.arguments;
    const bool given = function_.name.starts_with(kOfRun) && !arguments.empty() &&
                       arguments[0].type == "Propagator" && arguments[0].name == "self" &&
                       arguments[0].pass == CppArgument::Pass::reference && !arguments[0].constant;
    if (!given) differ(function_.line, function_.name + " is not given the run");
    function_.name = function_.name.substr(kOfRun.size());
    arguments.erase(arguments.begin());
  }

  void read(CppArgument& argument) {
    using Pass = CppArgument::Pass;
    argument.type = type(argument.type, function_.line);
    if (argument.name.empty()) differ(function_.line, "an argument without a name");
    const bool address = argument.pass == Pass::pointer;
    if (argument.pass != Pass::value && !address)
      differ(function_.line, "an argument that C has not");
    const bool number = argument.type == "Real";
    if (address && !argument.sizes.empty()) differ(function_.line, "an array of addresses");
    if (number && !argument.sizes.empty()) {
      argument.pass = Pass::array;
      arrays_.insert(argument.name);
    } else if (number && address) {
      arrays_.insert(argument.name);
    } else if (address) {
      argument.pass = Pass::reference;
      records_.insert(argument.name);
    }
  }

  void read(std::vector<CppStatement>& statements) {
    for (CppStatement& statement : statements) read(statement);
  }

  void read(CppStatement& statement) {
    read(statement.first);
    if (statement.kind == CppStatement::Kind::declaration) {
      declaration(statement);
    } else if (statement.value) {
      *statement.value = value(*statement.value);
    }
    if (statement.advance) *statement.advance = value(*statement.advance);
    read(statement.body);
  }

  void declaration(CppStatement& found) {
    found.type = type(found.type, found.line);
    if (records_.contains(found.name) || arrays_.contains(found.name) ||
        !of_header(found.name).empty())
      differ(found.line, fmt::format("'{}' is declared twice", found.name));
    if (!found.value) return;
    const CppExpression& given = *found.value;
    const bool zeros = given.kind == NodeKind::list && given.parts.size() == 1 &&
                       given.parts[0].kind == NodeKind::number && given.parts[0].text == "0";
    if (zeros && found.type != "Real") {
      require_zeros(found.type, found.line);
      found.value.reset();
    } else {
      found.value = value(given);
    }
  }

  // What C++ calls Start().
  [[nodiscard]] static bool is_start(const CppExpression& e) {
    return e.kind == NodeKind::call && e.parts.size() == 1 && of_header(e.parts[0].text) == "start";
  }

  // T x = {0} and (T){0} are T x and T() for records that begin with zeros.
  void require_zeros(const std::string& record, int line) const {
    if (record == "StepReport") return;
    const Record* found = code_.record(record);
    if (found == nullptr || !begins_with_zeros(*found))
      differ(line, fmt::format("{} does not begin with zeros", record));
  }

  CppExpression value(const CppExpression& e) {
    switch (e.kind) {
      case NodeKind::name:
        return name(e);
      case NodeKind::member:
      case NodeKind::index:
        return object(e);
      case NodeKind::call:
        return call(e);
      case NodeKind::prefix:
        if (e.text == "*") return pointed(e);
        if (e.text == "&") differ(e.line, "an address where a value belongs");
        break;
      default:
        break;
    }
    CppExpression result = e;
    for (CppExpression& part : result.parts) part = value(part);
    return result;
  }

  [[nodiscard]] CppExpression name(const CppExpression& e) const {
    if (records_.contains(e.text) || arrays_.contains(e.text))
      differ(e.line, fmt::format("the address of {} where a value belongs", e.text));
    const std::string ours = of_header(e.text);
    if (ours.empty()) return e;
    constexpr std::string_view kValues[] = {"pi", "largest", "epsilon", "go_on", "done", "failed"};
    if (std::ranges::find(kValues, ours) == std::end(kValues))
      differ(e.line, fmt::format("{} is no value", ours));
    CppExpression result = e;
    result.text = ours;
    return result;
  }

  // *z
  [[nodiscard]] CppExpression pointed(const CppExpression& e) const {
    const CppExpression& record = e.parts[0];
    if (record.kind != NodeKind::name || !records_.contains(record.text))
      differ(e.line, "* before what is no address");
    return record;
  }

  // z->q, values[i], start->value[0]
  CppExpression object(const CppExpression& e) {
    if (e.kind == NodeKind::name) {
      if (!of_header(e.text).empty()) differ(e.line, fmt::format("{} is no object", e.text));
      return e;
    }
    if (e.kind != NodeKind::member && e.kind != NodeKind::index)
      differ(e.line, "what is no object");
    const CppExpression& base = e.parts[0];
    const bool address = base.kind == NodeKind::name && records_.contains(base.text);
    const bool array = base.kind == NodeKind::name && arrays_.contains(base.text);
    const bool right = e.kind == NodeKind::member ? e.arrow == address && !array : !address;
    if (!right) differ(e.line, "a value where an address belongs, or the other way round");
    CppExpression result = e;
    result.arrow = false;
    result.parts[0] = object(base);
    if (e.kind == NodeKind::index) result.parts[1] = value(e.parts[1]);
    return result;
  }

  // &dz, &start->rule_0, &dz->q: an object that is no address itself.
  CppExpression address(const CppExpression& e) {
    const bool right = e.kind == NodeKind::prefix && e.text == "&";
    if (!right) differ(e.line, "a value where an address belongs");
    const CppExpression& of = e.parts[0];
    if (of.kind == NodeKind::call && of.parts.size() == 1) return call(of);  // (T){0}
    if (of.kind == NodeKind::name && (records_.contains(of.text) || arrays_.contains(of.text)))
      differ(e.line, fmt::format("the address of an address, &{}", of.text));
    return object(of);
  }

  CppExpression record_argument(const CppExpression& e) {
    const bool known = e.kind == NodeKind::name && records_.contains(e.text);
    return known ? e : address(e);
  }

  // An array of numbers: one that is given, a local, or a field.
  CppExpression array_argument(const CppExpression& e) {
    if (e.kind == NodeKind::name && records_.contains(e.text))
      differ(e.line, "a record where an array belongs");
    return object(e);
  }

  CppExpression call(const CppExpression& e) {
    const CppExpression& callee = e.parts[0];
    if (callee.kind != NodeKind::name) differ(e.line, "what is called here");
    const std::string ours = of_header(callee.text);
    if (ours.empty()) {
      if (!callee.text.starts_with("std::"))
        differ(e.line, fmt::format("'{}' is nothing that this header has", callee.text));
      return with_values(e, callee.text);
    }
    if (ours == "Real" || ours == "magnitude" || is_rounding_error(ours))
      return with_values(e, ours);
    if (ours == "collect" || ours == "two_sum" || ours == "two_sum_with_rest") return sum(e, ours);
    for (const std::string type : {"NewtonRule_", "History_"}) {
      if (ours.starts_with(type)) return of_object(e, ours.substr(type.size()));
    }
    if (is_start(e)) return with_values(e, "Start");
    if (const Routine* routine = code_.routine(ours)) return of_routine(e, *routine);
    if (ours.starts_with(kOfRun)) return of_run(e, ours.substr(kOfRun.size()));
    if (e.parts.size() > 1) differ(e.line, fmt::format("{} is no routine", ours));
    require_zeros(ours, e.line);
    return with_values(e, ours);
  }

  static CppExpression with_name(const CppExpression& e, const std::string& name) {
    CppExpression result = e;
    result.parts[0].text = name;
    return result;
  }
  CppExpression with_values(const CppExpression& e, const std::string& name) {
    CppExpression result = with_name(e, name);
    for (std::size_t i = 1; i < e.parts.size(); ++i) result.parts[i] = value(e.parts[i]);
    return result;
  }

  // collect(&dz->q, &rest->q, x)
  CppExpression sum(const CppExpression& e, const std::string& name) {
    if (e.parts.size() < 4) differ(e.line, "not a collected sum");
    CppExpression result = with_name(e, name);
    for (std::size_t i = 1; i < e.parts.size(); ++i)
      result.parts[i] = i < 3 ? address(e.parts[i]) : value(e.parts[i]);
    return result;
  }

  // NewtonRule_begin(&start->rule_0, known) is start.rule_0.begin(known), NewtonRule_check the rule
  // itself, and History_watch(&history, &rule, ...) rule.watch(history, ...).
  CppExpression of_object(const CppExpression& e, const std::string& action) {
    const std::size_t addresses = action == "watch" ? 2 : 1;
    if (e.parts.size() <= addresses) differ(e.line, action + " of nothing");
    CppExpression object = address(e.parts[addresses]);
    CppExpression result{NodeKind::call, "", {}, e.line};
    if (action != "check") object = {NodeKind::member, action, {std::move(object)}, e.line};
    result.parts.push_back(std::move(object));
    if (addresses == 2) result.parts.push_back(address(e.parts[1]));
    for (std::size_t i = addresses + 1; i < e.parts.size(); ++i)
      result.parts.push_back(value(e.parts[i]));
    return result;
  }

  CppExpression of_run(const CppExpression& e, const std::string& name) {
    const bool given = run_ != nullptr && e.parts.size() > 1 && e.parts[1].is_name("self");
    if (!given) differ(e.line, name + " is not given the run");
    for (const Routine& routine : run_->routines) {
      if (routine.name != name) continue;
      CppExpression call = e;
      call.parts.erase(call.parts.begin() + 1);
      return of_routine(call, routine);
    }
    differ(e.line, name + " is no routine of the run");
  }

  CppExpression of_routine(const CppExpression& e, const Routine& routine) {
    if (e.parts.size() != routine.arguments.size() + 1)
      differ(e.line, fmt::format("{} has {} arguments, not {}", routine.name,
                                 routine.arguments.size(), e.parts.size() - 1));
    CppExpression result = e;
    result.parts[0].text = routine.name;
    for (std::size_t i = 0; i < routine.arguments.size(); ++i) {
      const Argument& argument = routine.arguments[i];
      CppExpression& given = result.parts[i + 1];
      given = !argument.record.empty()                     ? record_argument(given)
              : !argument.sizes.empty() || argument.decays ? array_argument(given)
                                                           : value(given);
    }
    return result;
  }

  CppFunction function_;
  const Program& code_;
  const Propagator* run_;
  std::set<std::string> records_, arrays_;  // arguments that are addresses
};

}  // namespace

CppFunction without_addresses(const CppFunction& written, const Program& code,
                              const Propagator* run) {
  return AddressReader(written, code, run).run();
}

}  // namespace hamgen
