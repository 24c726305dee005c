#include "app/output/math_text.hpp"

#include "app/output/math_notation.hpp"
#include "generator/base/quoted_text.hpp"

namespace hamgen::app {
namespace {

// A line may end in a longer one.
std::string formula_in_prose(std::string_view text) {
  constexpr std::size_t shortest = 30;
  const MathFormula formula = read_notation(text);
  if (text.size() < shortest) return "<math>" + line_markup(formula) + "</math>";
  std::string result;
  for (const std::string& piece : line_pieces(formula))
    result += (result.empty() ? "<math>" : "<wbr><math>") + piece + "</math>";
  return result;
}

}  // namespace

std::string math_prose(std::string_view text) {
  std::string result;
  bool inside = false;
  while (true) {
    const std::size_t end = text.find('`');
    const std::string_view part = text.substr(0, end);
    result += inside ? formula_in_prose(part) : html_text(part);
    if (end == std::string_view::npos) return result;
    text.remove_prefix(end + 1);
    inside = !inside;
  }
}

}  // namespace hamgen::app
