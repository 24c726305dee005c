#include "generator/verify/text_value.hpp"

#include <cln/integer.h>
#include <cln/rational.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

bool is_name_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

Rational power_of_ten(long exponent) {
  Rational value(1);
  for (long i = 0; i < std::abs(exponent); ++i) value *= 10;
  return exponent < 0 ? Rational(1 / value) : value;
}

// Is it an integer that may be an exponent by repeated multiplication?
bool is_small_integer(const Precise& x) {
  static const Precise largest = precise(1000);
  return cln::abs(x) <= largest && cln::zerop(x - cln::ffloor(x));
}

long to_long(const Precise& x) { return cln::cl_I_to_long(cln::round1(x)); }

// Values as they are read, from the left to the right.
class TextValue {
 public:
  TextValue(const Model& model, const std::string& text, const PointValues& point,
            std::map<std::string, long> indices = {})
      : model_(model), text_(text), point_(point), indices_(std::move(indices)) {}

  // With the largest term that it comes from.
  ScaledValue run() {
    const Precise result = sum();
    if (next() != '\0') internal_error("a formula with something behind its end: " + text_);
    return {result, largest_};
  }

 private:
  char next() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool accept(char c) {
    if (next() != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!accept(c)) internal_error(fmt::format("'{}' is missing in {}", c, text_));
  }

  Precise sum() {
    Precise value = seen(product());
    for (;;) {
      if (accept('+')) {
        value = value + seen(product());
      } else if (accept('-')) {
        value = value - seen(product());
      } else {
        return value;
      }
    }
  }

  Precise seen(const Precise& term) {
    if (cln::abs(term) > largest_) largest_ = cln::abs(term);
    return term;
  }

  Precise product() {
    Precise value = signed_power();
    for (;;) {
      if (accept('*')) {
        value = value * signed_power();
      } else if (accept('/')) {
        const Precise divisor = signed_power();
        if (cln::zerop(divisor)) throw std::domain_error("division by zero");
        value = value / divisor;
      } else {
        return value;
      }
    }
  }

  // The sign is looser than the power.
  Precise signed_power() {
    if (accept('-')) return -signed_power();
    if (accept('+')) return signed_power();
    const Precise base = primary();
    if (!accept('^')) return base;
    return raised(base, signed_power());
  }

  static Precise raised(const Precise& base, const Precise& exponent) {
    if (is_small_integer(exponent)) {
      const long count = to_long(exponent);
      Precise result = precise(1);
      for (long i = 0; i < std::abs(count); ++i) result = result * base;
      if (count >= 0) return result;
      if (cln::zerop(base)) throw std::domain_error("a negative power of zero");
      return precise(1) / result;
    }
    if (!cln::plusp(base)) throw std::domain_error("a root of what is not positive");
    return cln::exp(exponent * cln::ln(base));
  }

  Precise primary() {
    const char c = next();
    if (accept('(')) {
      const Precise value = sum();
      expect(')');
      return value;
    }
    return (c >= '0' && c <= '9') || c == '.' ? number() : named();
  }

  Precise number() {
    const auto [known, is_new] = numbers_.try_emplace(at_);
    if (is_new) known->second = read_number();
    at_ = known->second.end;
    return known->second.value;
  }

  // A number of the text, and where it ends.
  struct Number {
    Precise value;
    std::size_t end = 0;
  };

  Number read_number() {
    Integer digits = 0;
    long behind_point = 0;
    bool point = false;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      const bool range = c == '.' && at_ + 1 < text_.size() && text_[at_ + 1] == '.';
      if (c == '.' && !point && !range) {
        point = true;
      } else if (c >= '0' && c <= '9') {
        digits = digits * 10 + (c - '0');
        if (point) ++behind_point;
      } else {
        break;
      }
    }
    long exponent = 0;
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      ++at_;
      const bool negative = text_[at_] == '-';
      if (negative || text_[at_] == '+') ++at_;
      // Of a number that is not 0 the language has no exponents of more digits.
      for (; at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9'; ++at_)
        exponent = std::min(10 * exponent + (text_[at_] - '0'), 1000000L);
      if (negative) exponent = -exponent;
    }
    if (digits == 0) return {precise(0), at_};
    return {precise(digits * power_of_ten(exponent - behind_point)), at_};
  }

  std::string word() {
    next();
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_name_letter(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  Precise named() {
    const std::string name = word();
    if (name.empty()) internal_error("a formula with an operand missing: " + text_);
    if (name == "sum" && next() == '(') return indexed_sum();
    if (next() == '(') return function(name);
    // A subscript stands directly after the name.
    if (at_ < text_.size() && text_[at_] == '[') {
      ++at_;
      const long subscript = integer();
      expect(']');
      return element(name, subscript);
    }
    return scalar(name);
  }

  Precise function(const std::string& name) {
    std::vector<Precise> arguments;
    expect('(');
    do {
      arguments.push_back(sum());
    } while (accept(','));
    expect(')');
    return precise_function(name, arguments);
  }

  Precise scalar(const std::string& name) {
    if (name == "pi") return precise_function("pi", {});
    if (const auto index = indices_.find(name); index != indices_.end())
      return precise(index->second);
    for (const Size& size : model_.sizes) {
      if (size.name == name) return precise(counts_ ? size.value : size.number);
    }
    for (const Definition& definition : model_.definitions) {
      if (definition.name == name) return TextValue(model_, definition.text, point_).run().value;
    }
    return at_point(name);
  }

  Precise at_point(const std::string& name) const {
    const auto found = point_.find(name);
    if (found == point_.end()) internal_error("no value of " + name);
    return found->second;
  }

  // Beyond the ends of an array as its declaration says.
  Precise element(const std::string& name, long subscript) const {
    for (const auto* variables : {&model_.coordinates, &model_.momenta}) {
      for (const Variable& variable : *variables) {
        if (variable.name != name || !variable.range) continue;
        const auto beyond = variable.beyond.find(subscript);
        if (beyond != variable.beyond.end())
          return TextValue(model_, to_text(beyond->second), point_).run().value;
        const long size = variable.range->size();
        if (variable.periodic) {
          const long place = ((subscript - variable.range->first) % size + size) % size;
          subscript = variable.range->first + place;
        }
      }
    }
    return at_point(name + '[' + std::to_string(subscript) + ']');
  }

  // Of a subscript or an end of a range.
  long integer() {
    const std::size_t begin = at_;
    if (const std::optional<long> value = sum_of_integers()) return *value;
    at_ = begin;
    counts_ = true;
    const long value = to_long(sum());
    counts_ = false;
    return value;
  }

  // Indices, sizes and digits with signs between them, up to what ends an integer: nearly all are
  // so.
  std::optional<long> sum_of_integers() {
    long value = 0;
    for (bool minus = accept('-');; minus = accept('-')) {
      const std::optional<long> term = simple_integer();
      if (!term) return std::nullopt;
      value += minus ? -*term : *term;
      const char c = next();
      if (c == ']' || c == ',' || text_.compare(at_, 2, "..") == 0) return value;
      if (c != '-' && !accept('+')) return std::nullopt;
      if (c == '+' && next() == '-') return std::nullopt;
    }
  }

  std::optional<long> simple_integer() {
    const std::string text = word();
    if (text.empty() || text.size() > 9) return std::nullopt;
    if (std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; }))
      return std::stol(text);
    if (const auto index = indices_.find(text); index != indices_.end()) return index->second;
    for (const Size& size : model_.sizes) {
      if (size.name == text) return size.value;
    }
    return std::nullopt;
  }

  // sum(i = 1..N, j = i+1..N, body)
  Precise indexed_sum() {
    expect('(');
    const std::size_t begin = at_;
    Precise total = precise(0);
    add_range(total);
    // What an empty range has skipped.
    at_ = begin;
    for (int depth = 1; depth > 0; ++at_) {
      if (at_ >= text_.size()) internal_error("a sum without an end: " + text_);
      if (text_[at_] == '(') ++depth;
      if (text_[at_] == ')') --depth;
    }
    return total;
  }

  // The next range and what is inside it, or the body.
  void add_range(Precise& total) {
    const std::size_t begin = at_;
    const std::string index = word();
    if (index.empty() || next() != '=') {
      at_ = begin;
      total = total + seen(sum());
      return;
    }
    expect('=');
    const long first = integer();
    expect('.');
    expect('.');
    const long last = integer();
    expect(',');
    const std::size_t inside = at_;
    for (long i = first; i <= last; ++i) {
      indices_[index] = i;
      at_ = inside;
      add_range(total);
    }
    indices_.erase(index);
  }

  const Model& model_;
  const std::string& text_;
  const PointValues& point_;
  std::map<std::string, long> indices_;
  bool counts_ = false;  // inside a subscript or an end of a range
  std::size_t at_ = 0;
  std::map<std::size_t, Number> numbers_;  // by where they begin
  Precise largest_ = precise(0);
};

}  // namespace

ScaledValue evaluate_text(const Model& model, const std::string& text, const PointValues& point) {
  return TextValue(model, text, point).run();
}

}  // namespace hamgen
