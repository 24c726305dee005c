#include "generator/emitted_spaces.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/algebra/scalar.hpp"
#include "generator/base/short_digest.hpp"
#include "generator/program/names.hpp"

namespace hamgen {

namespace {

// A formula as part of a name: "-h/9" is minus_h_9; a digest where that is long or not clear.
std::string name_of(const std::string& formula) {
  std::string name;
  const auto add = [&name](std::string_view word) {
    if (!name.empty() && !name.ends_with('_')) name += '_';
    name += word;
  };
  bool clear = true;
  bool begins = true;  // a word
  for (const char c : formula) {
    const bool word = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (word) {
      if (begins) add("");
      name += c;
    } else if (c == '*') {
      add("times");
    } else if (c == '-') {
      add("minus");
    } else if (c != ' ' && c != '/') {
      clear = clear && c == '.';
    }
    begins = !word;
  }
  return clear && !name.empty() && name.size() <= 24 ? name : short_digest(formula);
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : "_") + word;
  return text;
}

std::string system_space(const std::string& system, const Request& request,
                         const std::string& scene) {
  std::vector<std::string> changes;
  const ScalarType& scalar = *request.scalar->type;
  if (scalar.digits != 53) changes.emplace_back(scalar.space);
  for (const auto& [name, value] : request.sizes) {
    changes.push_back(fmt::format("{}_{}", name, value));
  }
  for (const std::string& name : request.fold) changes.push_back("folded_" + name);
  if (!scene.empty()) changes.push_back(scene);
  if (request.batch > 0) changes.push_back(fmt::format("batch_{}", request.batch));
  if (request.math->of_library) changes.emplace_back("libm");
  const std::string space = namespace_identifier(system);
  return changes.empty() ? space : space + "::" + identifier(joined(changes));
}

std::string method_space(const Scheme& scheme, const Request& request) {
  std::string name = scheme.name;
  std::ranges::replace(name, '-', '_');
  std::vector<std::string> words = {name};
  // A name of THE LIST says all of a scheme's coefficients but for those of what it composes.
  if (name.starts_with("member") || std::holds_alternative<Composition>(scheme.method)) {
    const std::pair<const char*, const std::string*> parts[] = {{"alpha", &request.alpha.text()},
                                                                {"beta", &request.beta.text()},
                                                                {"gamma", &request.gamma.text()}};
    for (const auto& [part, formula] : parts) {
      if (!formula->empty()) words.push_back(fmt::format("{}_{}", part, name_of(*formula)));
    }
  }
  if (request.gauge->matrix) words.push_back(name_of(request.gauge.text()));
  std::string reference;
  for (const auto& [place, value] : request.reference) {
    reference += fmt::format("{}={};", place, value);
  }
  if (!reference.empty()) words.push_back("at_" + short_digest(reference));
  if (!request.solver.empty()) {
    std::string solver = request.solver.text();
    std::ranges::replace_if(
        solver, [](char c) { return c == '-' || c == ':'; }, '_');
    words.push_back(solver);
  }
  if (request.plain_sums) words.emplace_back("plain_sums");
  return identifier(joined(words));
}

}  // namespace

EmittedSpaces emitted_spaces(const StepEquations& equations, const Request& request,
                             const std::string& scene) {
  const std::string& wanted = request.name_space;
  if (wanted.empty()) {
    return {system_space(equations.mechanics.name, request, scene),
            method_space(equations.scheme, request)};
  }
  require_namespace(wanted);
  const auto last = wanted.rfind("::");
  if (last == std::string::npos) return {wanted, ""};
  return {wanted.substr(0, last), wanted.substr(last + 2)};
}

}  // namespace hamgen
