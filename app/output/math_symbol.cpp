#include "app/output/math_symbol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "generator/base/quoted_text.hpp"

namespace hamgen::app {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 34> kGreek = {{
    {"alpha", "α"},   {"beta", "β"},    {"gamma", "γ"}, {"delta", "δ"}, {"eps", "ε"},
    {"epsilon", "ε"}, {"zeta", "ζ"},    {"eta", "η"},   {"theta", "θ"}, {"iota", "ι"},
    {"kappa", "κ"},   {"lambda", "λ"},  {"mu", "μ"},    {"nu", "ν"},    {"xi", "ξ"},
    {"pi", "π"},      {"rho", "ρ"},     {"sigma", "σ"}, {"tau", "τ"},   {"phi", "φ"},
    {"varphi", "ϕ"},  {"upsilon", "υ"}, {"chi", "χ"},   {"psi", "ψ"},   {"omega", "ω"},
    {"Gamma", "Γ"},   {"Delta", "Δ"},   {"Omega", "Ω"}, {"Phi", "Φ"},   {"Psi", "Ψ"},
    {"Theta", "Θ"},   {"Lambda", "Λ"},  {"Sigma", "Σ"}, {"Xi", "Ξ"},
}};

// The Greek letter, or nothing.
std::string_view greek(std::string_view word) {
  const auto row = std::ranges::find(kGreek, word, [](const auto& each) { return each.first; });
  return row == kGreek.end() ? std::string_view() : row->second;
}

std::string letter_markup(std::string_view word) {
  const std::string_view letter = greek(word);
  return fmt::format("<mi>{}</mi>", html_text(letter.empty() ? word : letter));
}

bool is_small(char c) { return c >= 'a' && c <= 'z'; }
bool is_letter(char c) { return is_small(c) || (c >= 'A' && c <= 'Z'); }

// How many characters of a word without digits and underscores are its letter.
std::size_t letter_length(std::string_view word) {
  if (!greek(word).empty()) return word.size();
  const bool has_index = word.size() == 2 && is_letter(word[0]) && is_small(word[1]);
  const bool is_momentum = word.size() > 2 && word[0] == 'p' && !greek(word.substr(1)).empty();
  return has_index || is_momentum ? 1 : word.size();
}

// "theta1" in a subscript: the letter and its number side by side.
std::string flat(std::string_view name) {
  const SymbolMarkup parts = symbol_markup(name);
  return parts.letter + parts.subscript;
}

}  // namespace

SymbolMarkup symbol_markup(std::string_view name) {
  const std::size_t bar = name.find('_');
  if (bar != std::string_view::npos && bar > 0 && bar + 1 < name.size()) {
    SymbolMarkup head = symbol_markup(name.substr(0, bar));
    head.subscript += (head.subscript.empty() ? "" : "<mo>,</mo>") + flat(name.substr(bar + 1));
    return head;
  }
  const std::size_t end = name.find_last_not_of("0123456789") + 1;
  if (end == 0) return {.letter = fmt::format("<mn>{}</mn>", name), .subscript = ""};
  const std::string_view word = name.substr(0, end);
  const std::size_t length = letter_length(word);
  SymbolMarkup result{.letter = letter_markup(word.substr(0, length)), .subscript = ""};
  if (length < word.size()) result.subscript = letter_markup(word.substr(length));
  if (end < name.size()) result.subscript += fmt::format("<mn>{}</mn>", name.substr(end));
  return result;
}

std::string plain_symbol(std::string_view name) {
  constexpr std::array<std::string_view, 10> digits = {"₀", "₁", "₂", "₃", "₄",
                                                       "₅", "₆", "₇", "₈", "₉"};
  const std::size_t bracket = name.find('[');
  if (bracket != std::string_view::npos)
    return plain_symbol(name.substr(0, bracket)) + std::string(name.substr(bracket));
  const std::size_t end = name.find_last_not_of("0123456789") + 1;
  if (end == 0) return std::string(name);
  const std::string_view word = name.substr(0, end);
  const std::size_t length = letter_length(word);
  std::string text;
  for (const std::string_view part : {word.substr(0, length), word.substr(length)})
    text += greek(part).empty() ? part : greek(part);
  for (const char c : name.substr(end)) text += digits[static_cast<std::size_t>(c - '0')];
  return text;
}

std::string greek_text(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at;
    while (end < text.size() && is_letter(text[end])) ++end;
    const std::string_view word = text.substr(at, std::max<std::size_t>(1, end - at));
    result += greek(word).empty() ? word : greek(word);
    at += word.size();
  }
  for (const auto& [word, letter] : kGreek) {
    const std::string same = std::string(letter) + " = " + std::string(letter);
    if (const std::size_t at = result.find(same); at != std::string::npos)
      result.replace(at, same.size(), std::string(letter) + " varied");
  }
  return result;
}

}  // namespace hamgen::app
