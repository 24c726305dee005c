#include "tests/planner/emitted_text.hpp"

#include <cctype>
#include <stdexcept>

#include "generator/base/source_text.hpp"

namespace hamgen::planner_test {

SourceText model(const std::string& text) {
  return make_source("small.ham", "system small\n" + text);
}

Outcome outcome(const std::string& text, const Request& request) {
  const SourceText source = model(text);
  Outcome result;
  result.plan = show_stage(source, request, "plan");
  result.header = emit(source, request).at(0).text;
  // A system in loops has its step in the class Propagator alone.
  if (contains(result.header, "StepReport solve(")) {
    result.solve = function_text(result.header, "StepReport solve(");
  }
  return result;
}

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

int count(std::string_view text, std::string_view part) {
  int n = 0;
  for (auto at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

bool has_name(std::string_view code, std::string_view name) {
  auto in_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  for (auto at = code.find(name); at != std::string_view::npos; at = code.find(name, at + 1)) {
    const auto line = code.rfind('\n', at) + 1;
    const bool comment = code.substr(line, at - line).find("//") != std::string_view::npos;
    const bool starts = at == 0 || !in_name(code[at - 1]);
    const bool ends = at + name.size() == code.size() || !in_name(code[at + name.size()]);
    if (starts && ends && !comment) return true;
  }
  return false;
}

std::string function_text(std::string_view header, std::string_view begin) {
  const auto at = header.find(begin);
  if (at == std::string_view::npos) {
    throw std::runtime_error("no '" + std::string(begin) + "' in the emitted text");
  }
  const auto first = header.rfind('\n', at) + 1;
  const auto end = header.find("\n}", at);
  return std::string(header.substr(first, end - first + 3));
}

}  // namespace hamgen::planner_test
