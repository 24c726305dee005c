#include "generator/program/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "generator/algebra/functions.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/program/taken_names.hpp"

namespace hamgen {

namespace {

// Keywords of C++20 and C11.
constexpr std::string_view kKeywords =
    " alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t"
    " char32_t char8_t class co_await co_return co_yield compl concept const const_cast"
    " consteval constexpr constinit continue decltype default delete do double dynamic_cast"
    " else enum explicit export extern false float for friend goto if inline int long mutable"
    " namespace new noexcept not not_eq nullptr operator or or_eq private protected public"
    " register reinterpret_cast requires restrict return short signed sizeof static"
    " static_assert static_cast struct switch template this thread_local throw true try"
    " typedef typeid typename union unsigned using virtual void volatile wchar_t while xor"
    " xor_eq"
    " ";

// Names the emitted functions use themselves.
constexpr std::string_view kOurs[] = {"std",
                                      "par",
                                      "k",
                                      "z",
                                      "dz",
                                      "h",
                                      "start",
                                      "report",
                                      "rule",
                                      "Real",
                                      "State",
                                      "Parameters",
                                      "Coefficients",
                                      "StepReport",
                                      "Start",
                                      "Derivatives",
                                      "derivatives",
                                      "Propagator",
                                      "energy",
                                      "step",
                                      "solve",
                                      "pi",
                                      "result",
                                      "prepare",
                                      "main",
                                      "gradient",
                                      "magnitude",
                                      "largest",
                                      "two_sum",
                                      "add",
                                      "collect",
                                      "collect_stages",
                                      "product_error",
                                      "difference_error",
                                      "squares_of",
                                      "Refinement",
                                      "RefinementInLanes",
                                      "Lanes",
                                      "vector_fields",
                                      "forces",
                                      "rest",
                                      "carry",
                                      "invariants",
                                      "modified_energies",
                                      "modified_energy",
                                      "epsilon",
                                      "DenseMatrix",
                                      "SymmetricMatrix",
                                      "EigenDenseMatrix",
                                      "invert",
                                      "Verdict",
                                      "History",
                                      "NewtonRule",
                                      "NewtonRuleOfMany",
                                      "NewtonRuleWithMatrix",
                                      "FixedPointRule",
                                      "ContractionRule",
                                      "WaitingNewtonRule",
                                      "Distance"};

// rule_0, matrix_1: what the emitted functions number themselves.
bool is_numbered(std::string_view name) {
  constexpr std::string_view kStems[] = {"rule_", "vector_", "matrix_", "product_", "inverse_"};
  return std::ranges::any_of(kStems, [&](std::string_view stem) {
    return name.starts_with(stem) && name.size() > stem.size() &&
           std::ranges::all_of(name.substr(stem.size()),
                               [](char c) { return '0' <= c && c <= '9'; });
  });
}

// A name next to a reserved one, itself free.
std::string beside(const std::string& name) { return name + (is_macro(name) ? "_value" : "_"); }

bool is_keyword(std::string_view name) {
  return is_macro(name) || kKeywords.find(fmt::format(" {} ", name)) != std::string_view::npos;
}

// A function that the emitted code calls by this name alone.
bool is_quad_function(std::string_view name) {
  return std::ranges::find(all_functions(), name, &Function::quad) != all_functions().end();
}

// A function by the name that C calls it by: a variable cos_ would become a local that hides it.
bool is_function_of_c(std::string_view name) {
  return name == "fabs" || name == "pow" ||
         std::ranges::find(all_functions(), name, &Function::cpp) != all_functions().end();
}

bool is_reserved(std::string_view name) {
  return is_keyword(name) || is_numbered(name) || is_quad_function(name) ||
         std::ranges::find(kOurs, name) != std::end(kOurs);
}

// Letters, digits and underscores of ASCII, whatever the locale.
bool is_free_name(const std::string& name) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto is_word = [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c) || c == '_';
  };
  return !name.empty() && std::ranges::all_of(name, is_word) && !is_digit(name.front()) &&
         name.find("__") == std::string::npos && namespace_identifier(name) == name;
}

}  // namespace

std::string identifier(const std::string& name) {
  // Two underscores and a leading underscore belong to the implementation.
  std::string text;
  for (const char c : name) {
    if (c == '_' && text.ends_with('_')) continue;
    text += c;
  }
  if (is_reserved(text)) text = beside(text);
  return text;
}

std::string namespace_identifier(const std::string& name) {
  const std::string text = identifier(name);
  return is_global(text) ? beside(text) : text;
}

std::string member_identifier(const std::string& name) {
  const std::string text = identifier(name);
  // A member is always qualified: only keywords and the scalar's name are out of the question.
  return text.ends_with('_') && !is_keyword(text.substr(0, text.size() - 1)) && text != "Real_" &&
                 text.substr(0, text.size() - 1) == name
             ? name
             : text;
}

void require_namespace(const std::string& text) {
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find("::", begin);
    const std::string name = text.substr(begin, end - begin);
    if (!is_free_name(name))
      throw UsageError(
          fmt::format("--namespace {}: '{}' cannot name a namespace\nhelp: write --namespace "
                      "my_models or --namespace my::models",
                      text, name));
    if (end == std::string::npos) return;
    begin = end + 2;
  }
}

ElementName split_element(const std::string& name) {
  const auto bracket = name.find('[');
  if (bracket == std::string::npos) return {name, false, 0};
  return {name.substr(0, bracket), true, std::stol(name.substr(bracket + 1))};
}

std::string Names::unique(const std::string& wanted) {
  const std::string base = is_macro(wanted) ? beside(wanted) : wanted;
  std::string stem = base.ends_with('_') ? base : base + "_";
  if (is_numbered(stem + "2")) stem += "value_";  // else each of them is reserved
  std::string text = base;
  for (int i = 2; taken_.contains(text) || is_reserved(text) || is_function_of_c(text); ++i)
    text = fmt::format("{}{}", stem, i);
  taken_.insert(text);
  return text;
}

void Names::set(const std::string& symbol, const std::string& text) { names_[symbol] = text; }

const std::string& Names::local(const std::string& symbol) {
  if (const auto it = names_.find(symbol); it != names_.end()) return it->second;
  if (symbol.ends_with(kNext)) {
    const std::string before = local(symbol.substr(0, symbol.size() - std::string(kNext).size()));
    return names_.emplace(symbol, unique(before + "_next")).first->second;
  }
  std::string text;
  if (symbol.starts_with('#')) {
    text = fmt::format("t{}", ++temporaries_);
    return names_.emplace(symbol, unique(text)).first->second;
  }
  std::string source = symbol;
  const bool renewed = source.ends_with('*');
  std::string suffix;
  while (source.ends_with('*')) source.pop_back();
  if (source.starts_with("bar(")) {
    source = source.substr(4, source.size() - 5);
    suffix = "_bar";
  }
  if (source.starts_with("1/det")) source = "inverse_det" + source.substr(5);
  if (renewed) suffix += "_new";
  const bool element = source.find('[') != std::string::npos;  // "q[2*i+1]": q_2_times_i_plus_1
  for (const char c : source) {
    if (element && (c == '+' || c == '-' || c == '*')) {
      if (!text.ends_with('_')) text += '_';  // two of them are the language's own
      text += c == '+' ? "plus" : c == '-' ? "minus" : "times";
    }
    const bool letter = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (letter) {
      text += c;
    } else if (!text.empty() && !text.ends_with('_')) {
      text += '_';
    }
  }
  while (text.ends_with('_')) text.pop_back();
  if (!text.empty() && text[0] >= '0' && text[0] <= '9') text = "of_" + text;
  return names_.emplace(symbol, unique(text + suffix)).first->second;
}

void require_distinct_symbols(const Routine& routine) {
  const std::string both = find_in(routine.body, [&](const Instruction& instruction) {
    const auto* let = std::get_if<Let>(&instruction.value);
    return let != nullptr && routine.places.contains(let->symbol) ? let->symbol : std::string();
  });
  if (!both.empty())
    internal_error(fmt::format("{} of {} is a local and a place", both, routine.name));
}

}  // namespace hamgen
