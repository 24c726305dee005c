#include "generator/readback/c_names.hpp"

#include <algorithm>

#include "generator/algebra/functions.hpp"
#include "generator/base/fixed_blocks.hpp"
#include "generator/readback/findings.hpp"

namespace hamgen {

namespace {

constexpr std::string_view kOfSystem[] = {"Parameters", "State",      "energy",
                                          "gradient",   "invariants", "default_parameters"};
constexpr std::string_view kFixed = "hamgen_";

template <std::size_t count>
bool is_one_of(const std::string_view (&list)[count], std::string_view word) {
  return std::ranges::find(list, word) != std::end(list);
}

// Words as in the C++ subset, one after the other.
class WordReader {
 public:
  WordReader(std::span<const CppToken> tokens, const CNames& names)
      : tokens_(tokens), names_(names), suffix_(suffix_of(names.precision)) {}

  std::vector<CppToken> run() {
    while (at_ < tokens_.size()) {
      if (skip_unused() || take_type() || take_zeros()) continue;
      result_.push_back(tokens_[at_++]);
      CppToken& token = result_.back();
      if (token.is("::")) throw TextDifference(token.line, "a namespace, which C has not");
      if (token.kind == CppToken::Kind::word) token.text = word(token.text);
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool is(std::size_t ahead, std::string_view text) const {
    return at_ + ahead < tokens_.size() && tokens_[at_ + ahead].is(text);
  }
  [[nodiscard]] bool is_word(std::size_t ahead) const {
    return at_ + ahead < tokens_.size() && tokens_[at_ + ahead].kind == CppToken::Kind::word;
  }
  void add(CppToken::Kind kind, std::string text) {
    result_.push_back({kind, std::move(text), tokens_[at_].line});
  }

  // (void)par;
  bool skip_unused() {
    const bool begins = at_ == 0 || tokens_[at_ - 1].is(";") || tokens_[at_ - 1].is("{");
    if (!begins || !is(0, "(") || !is(1, "void") || !is(2, ")") || !is_word(3) || !is(4, ";"))
      return false;
    at_ += 5;
    return true;
  }

  // double, long double
  bool take_type() {
    const bool extended = names_.precision.type == "long double";
    const bool found = extended ? is(0, "long") && is(1, "double") : is(0, names_.precision.type);
    // "long double" is not the type double.
    const bool longer = !extended && at_ > 0 && tokens_[at_ - 1].is("long");
    if (!found || longer) return false;
    add(CppToken::Kind::word, "@Real");
    at_ += extended ? 2 : 1;
    return true;
  }

  // (pendulum_State){0}
  bool take_zeros() {
    if (!is(0, "(") || !is_word(1) || !is(2, ")") || !is(3, "{") || !is(4, "0") || !is(5, "}"))
      return false;
    add(CppToken::Kind::word, word(tokens_[at_ + 1].text));
    add(CppToken::Kind::sign, "(");
    add(CppToken::Kind::sign, ")");
    at_ += 6;
    return true;
  }

  [[nodiscard]] std::string word(const std::string& text) const {
    const auto behind = [&text](const std::string& prefix) {
      return text.starts_with(prefix + "_") ? std::string_view(text).substr(prefix.size() + 1)
                                            : std::string_view();
    };
    if (is_one_of(kOfSystem, behind(names_.system)))
      return kOfHeader + std::string(behind(names_.system));
    if (text.starts_with(kFixed) && text.ends_with(suffix_)) {
      const std::string name =
          text.substr(kFixed.size(), text.size() - kFixed.size() - suffix_.size());
      if (name == "pi" || is_defined(c_blocks(), name)) return kOfHeader + name;
    }
    const std::string_view of_method = behind(names_.method);
    if (!of_method.empty() && !is_one_of(kOfSystem, of_method))
      return kOfHeader + std::string(of_method);
    if (is(0, "(") && text.ends_with(suffix_)) {
      const std::string name = text.substr(0, text.size() - suffix_.size());
      if (is_library_function(name)) return "std::" + name;
    }
    return text;
  }

  std::span<const CppToken> tokens_;
  const CNames& names_;
  std::string_view suffix_;
  std::size_t at_ = 0;
  std::vector<CppToken> result_;
};

}  // namespace

std::string_view suffix_of(const Precision& precision) {
  return precision.bits == 24 ? "f" : precision.bits == 64 ? "l" : "";
}

bool is_library_function(std::string_view name) {
  return name == "pow" || name == "fabs" ||
         std::ranges::find(all_functions(), name, &Function::cpp) != all_functions().end();
}

std::string CNames::named(std::string_view name) const {
  return (is_one_of(kOfSystem, name) ? system : method) + "_" + std::string(name);
}

std::string CNames::block(std::string_view name) const {
  return std::string(kFixed) + std::string(name) + std::string(suffix_of(precision));
}

std::string CNames::text(std::string_view of) const {
  std::string result;
  const std::vector<CppToken> tokens = tokens_of(of);
  for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
    const CppToken& token = tokens[i];
    const bool qualified = i + 2 < tokens.size() && tokens[i + 1].is("::");
    if (qualified && token.is("N")) {
      result += named(tokens[i += 2].text);
    } else if (qualified && token.is("hamgen")) {
      result += block(tokens[i += 2].text);
    } else {
      result += token.is("Real") ? std::string(precision.type) : token.text;
    }
    result += ' ';
  }
  return result;
}

std::vector<CppToken> cpp_words(std::span<const CppToken> tokens, const CNames& names) {
  return WordReader(tokens, names).run();
}

}  // namespace hamgen
