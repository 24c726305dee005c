#include "generator/language/words.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "generator/algebra/functions.hpp"

namespace hamgen {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 11> meanings = {{
    {"pi", "the number pi"},
    {"sum", "an indexed sum"},
    {"h", "the step size"},
    {"E0", "the initial energy of a run"},
    {"H", "the Hamiltonian"},
    {"energy", "the value of H"},
    {"steps", "the number of steps of a scene"},
    {"every", "the recording interval of a scene"},
    {"observe", "the observed quantities of a scene"},
    {"periodic", "an array that closes on itself"},
    {"with", "values beyond the ends of an array"},
}};

}  // namespace

const std::vector<std::string>& statement_words() {
  static const std::vector<std::string> words = {"system",    "size",      "coordinate", "momentum",
                                                 "time",      "parameter", "let",        "H",
                                                 "invariant", "event",     "scene"};
  return words;
}

bool begins_statement(std::string_view word) {
  return std::ranges::find(statement_words(), word) != statement_words().end();
}

std::string reserved_meaning(std::string_view word) {
  for (const auto& [name, meaning] : meanings) {
    if (name == word) return std::string(meaning);
  }
  if (begins_statement(word)) return "a keyword of the language";
  if (find_function(word) != nullptr) return "a function";
  return {};
}

}  // namespace hamgen
