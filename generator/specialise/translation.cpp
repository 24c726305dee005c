// Coordinates that H knows by their differences alone.
#include <fmt/format.h>

#include <algorithm>

#include "generator/mechanics/derive.hpp"
#include "generator/specialise/linear_change.hpp"
#include "generator/specialise/new_names.hpp"

namespace hamgen {

namespace {

class ByTranslation {
 public:
  ByTranslation(const Mechanics& mechanics, const std::set<std::string>& observed)
      : mechanics_(mechanics), observed_(observed), n_(mechanics.degrees_of_freedom) {}

  std::optional<LinearChange> run() {
    std::set<int> seen;
    for (int i = 0; i < coordinates(); ++i) {
      if (seen.contains(i) || !mechanics_moves(i)) continue;
      std::set<int> together = moved_together(i);
      if (together.size() < 2 || !is_free(together)) continue;
      if (std::ranges::any_of(together, [&](int k) { return seen.contains(k); })) continue;
      seen.insert(together.begin(), together.end());
      sets_.push_back(std::move(together));
    }
    if (sets_.empty()) return std::nullopt;
    return change();
  }

 private:
  [[nodiscard]] int coordinates() const { return mechanics_.has_time ? n_ - 1 : n_; }
  [[nodiscard]] std::string name(int i) const {
    return mechanics_.variables.name(static_cast<std::size_t>(i));
  }
  // Does H depend on the coordinate?
  [[nodiscard]] bool mechanics_moves(int i) const { return depends_on(mechanics_.energy, name(i)); }

  [[nodiscard]] bool is_changed(const Expression& e, const std::set<int>& coordinates) const {
    static const std::string shift = "(shift)";  // no name of the user's
    Substitution moved;
    for (const int i : coordinates)
      moved.emplace(name(i), mechanics_.variable(i) + Expression::symbol(shift, kRankOfTemporary));
    return depends_on(substitute(e, moved), shift);
  }

  // The coordinates that have to move with q_i for each summand of H to stay what it is: where
  // there is a choice, the first that will do.
  [[nodiscard]] std::set<int> moved_together(int i) const {
    std::set<int> result{i};
    const auto [coefficient, rest] = mechanics_.energy.split_coefficient();
    const bool is_sum = rest.kind() == Kind::sum;
    for (bool more = true; more;) {
      more = false;
      for (std::size_t t = 0; t < (is_sum ? rest.operands().size() : 1); ++t) {
        const Expression& term = is_sum ? rest.operands()[t] : rest;
        if (!is_changed(term, result)) continue;
        const int other = one_more(term, result);
        if (other < 0) return {};
        result.insert(other);
        more = true;
      }
    }
    return result;
  }
  // A coordinate with which the term does not change; -1 if there is none.
  [[nodiscard]] int one_more(const Expression& term, const std::set<int>& known) const {
    for (int j = 0; j < coordinates(); ++j) {
      if (known.contains(j) || !depends_on(term, name(j))) continue;
      std::set<int> more = known;
      more.insert(j);
      if (!is_changed(term, more)) return j;
    }
    return -1;
  }

  // Nobody asks where they are, nor where one of them is.
  [[nodiscard]] bool is_free(const std::set<int>& coordinates) const {
    const auto is_named = [&](int i) {
      return observed_.contains(name(i)) ||
             observed_.contains(name(i).substr(0, name(i).find('[')));
    };
    if (std::ranges::any_of(coordinates, is_named)) return false;
    return !is_changed(mechanics_.energy, coordinates) &&
           std::ranges::none_of(mechanics_.invariants, [&](const NamedExpression& each) {
             return is_changed(each.value, coordinates);
           });
  }

  // q_i = Q_i + Q_last and q_last = Q_last, so that P_i = p_i and P_last is their sum.
  LinearChange change() const {
    LinearChange result{
        .from = n_, .to = n_, .a = {}, .b = {}, .variables = mechanics_.variables.elements()};
    for (int i = 0; i < n_; ++i) {
      result.a[{i, i}] = 1;
      result.b[{i, i}] = 1;
    }
    NewNames names(mechanics_);
    for (const std::set<int>& together : sets_) {
      const int last = *together.rbegin();
      std::string sum;
      for (const int i : together) {
        sum += (sum.empty() ? "" : " + ") + name(n_ + i);
        if (i == last) continue;
        result.a[{i, last}] = 1;
        result.b[{last, i}] = -1;
        Quantity& coordinate = result.variables[static_cast<std::size_t>(i)];
        coordinate.name = names.made_of(name(i), "rel");
        coordinate.comment = fmt::format("{} - {}", name(i), name(last));
        result.left_out.push_back(
            fmt::format("{}: H and what is observed know {} alone", name(i), coordinate.comment));
      }
      Quantity& total = result.variables[static_cast<std::size_t>(n_ + last)];
      total.name = names.made_of(name(n_ + last), "sum");
      total.comment = sum;
    }
    return result;
  }

  const Mechanics& mechanics_;
  const std::set<std::string>& observed_;
  int n_;
  std::vector<std::set<int>> sets_;
};

}  // namespace

std::optional<LinearChange> by_translation(const Mechanics& mechanics,
                                           const std::set<std::string>& observed) {
  if (mechanics.keeps_sums() || mechanics.degrees_of_freedom > kMostWrittenOut) return std::nullopt;
  return ByTranslation(mechanics, observed).run();
}

}  // namespace hamgen
