// Symmetries of H by exchanges of degrees of freedom, with signs, that leave the scene's beginning
// where it is.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "generator/algebra/from_ginac.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/specialise/linear_change.hpp"
#include "generator/specialise/new_names.hpp"

namespace hamgen {

namespace {

std::size_t spot(int i) { return static_cast<std::size_t>(i); }

// q_i becomes sign * q_to, and p_i sign * p_to.
struct Image {
  int to = -1;
  int sign = 1;
};
using SignedPermutation = std::vector<Image>;

std::vector<Expression> summands(const Expression& e) {
  const auto [coefficient, rest] = e.split_coefficient();
  if (rest.kind() != Kind::sum) return {e};
  std::vector<Expression> terms;
  for (const Expression& term : rest.operands()) terms.push_back(Expression(coefficient) * term);
  return terms;
}

// Looks for a symmetry that takes one given degree of freedom to another one, term by term of H.
class SymmetrySearch {
 public:
  // `begins_alike(i, j, sign)`: the scene does not forbid i -> sign * j.
  using Alike = std::function<bool(int, int, int)>;
  SymmetrySearch(const Mechanics& mechanics, Expression energy, Alike begins_alike)
      : mechanics_(mechanics),
        n_(mechanics.degrees_of_freedom),
        energy_(std::move(energy)),
        begins_alike_(std::move(begins_alike)),
        terms_of_(spot(n_)) {
    std::map<std::string, int> pair_of;
    for (int i = 0; i < 2 * n_; ++i) pair_of[name(i)] = i % n_;
    for (const Expression& term : summands(energy_)) {
      std::set<int> pairs;
      for (const std::string& symbol : symbols(term)) {
        if (const auto it = pair_of.find(symbol); it != pair_of.end()) pairs.insert(it->second);
      }
      for (const int i : pairs) terms_of_[spot(i)].push_back(terms_.size());
      known_.insert(term);
      terms_.push_back({term, std::move(pairs)});
    }
  }

  std::optional<SignedPermutation> find(int from, int to, int sign) {
    image_.assign(spot(n_), {});
    taken_.assign(spot(n_), false);
    order_ = near_first(from);
    tries_ = 0;
    if (!assign(0, Image{to, sign})) return std::nullopt;
    return image_;
  }

  [[nodiscard]] Substitution as_substitution(const SignedPermutation& image) const {
    Substitution result;
    for (int i = 0; i < n_; ++i) {
      const auto& [to, sign] = image[spot(i)];
      if (to < 0) continue;
      for (const int half : {0, n_})
        result.emplace(name(half + i), Expression(sign) * mechanics_.variable(half + to));
    }
    return result;
  }
  [[nodiscard]] static bool keeps(const Expression& energy, const Substitution& symmetry) {
    const Expression image = substitute(energy, symmetry);
    return image == energy || vanishes(image - energy);
  }

 private:
  struct Term {
    Expression value;
    std::set<int> pairs;
  };
  // A symmetry is found at the first or second try of nearly every degree of freedom.
  [[nodiscard]] int most_tries() const { return 20 * n_; }

  [[nodiscard]] std::string name(int i) const { return mechanics_.variables.name(spot(i)); }

  // Every degree of freedom, those of common terms one after the other.
  [[nodiscard]] std::vector<int> near_first(int from) const {
    std::vector<int> order{from};
    std::set<int> seen{from};
    for (std::size_t k = 0; k < order.size() || static_cast<int>(order.size()) < n_; ++k) {
      if (k == order.size()) {
        for (int i = 0; i < n_; ++i) {
          if (seen.insert(i).second) {
            order.push_back(i);
            break;
          }
        }
      }
      for (const std::size_t t : terms_of_[spot(order[k])]) {
        for (const int i : terms_[t].pairs) {
          if (seen.insert(i).second) order.push_back(i);
        }
      }
    }
    return order;
  }

  bool assign(std::size_t depth, const Image& wanted) {
    const int i = order_[depth];
    const auto& [to, sign] = wanted;
    if (taken_[spot(to)] || ++tries_ > most_tries() || !begins_alike_(i, to, sign)) return false;
    if (terms_of_[spot(i)].size() != terms_of_[spot(to)].size()) return false;
    image_[spot(i)] = wanted;
    taken_[spot(to)] = true;
    if (keeps_terms_of(i) && assign_rest(depth + 1)) return true;
    image_[spot(i)] = {};
    taken_[spot(to)] = false;
    return false;
  }

  bool assign_rest(std::size_t depth) {
    if (depth == order_.size()) return keeps(energy_, as_substitution(image_));
    // Itself first: what is far from the exchange stays.
    const int i = order_[depth];
    if (assign(depth, {i, 1}) || assign(depth, {i, -1})) return true;
    for (int to = 0; to < n_; ++to) {
      if (to != i && (assign(depth, {to, 1}) || assign(depth, {to, -1}))) return true;
    }
    return false;
  }

  // Do the terms whose images are known now become terms of H?
  [[nodiscard]] bool keeps_terms_of(int i) const {
    const Substitution symmetry = as_substitution(image_);
    return std::ranges::all_of(terms_of_[spot(i)], [&](std::size_t t) {
      const bool known = std::ranges::all_of(
          terms_[t].pairs, [this](int pair) { return image_[spot(pair)].to >= 0; });
      return !known || known_.contains(substitute(terms_[t].value, symmetry));
    });
  }

  const Mechanics& mechanics_;
  int n_;
  Expression energy_;
  Alike begins_alike_;
  std::vector<Term> terms_;
  std::vector<std::vector<std::size_t>> terms_of_;  // by degree of freedom
  std::set<Expression> known_;
  SignedPermutation image_;
  std::vector<bool> taken_;
  std::vector<int> order_;
  int tries_ = 0;
};

// Degrees of freedom that move as one, each with its sign; those that are their own negatives rest.
class Orbits {
 public:
  explicit Orbits(int n) : parent_(spot(n)), sign_(spot(n), 1), rests_(spot(n), false) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  // The first of an orbit, and the sign relative to it.
  [[nodiscard]] Image root(int i) const {
    int sign = 1;
    while (parent_[spot(i)] != i) {
      sign *= sign_[spot(i)];
      i = parent_[spot(i)];
    }
    return {i, sign};
  }
  void join(int i, const Image& image) {
    const Image a = root(i);
    const Image b = root(image.to);
    const int sign = a.sign * b.sign * image.sign;  // of root a relative to root b
    if (a.to == b.to) {
      if (sign < 0) rests_[spot(a.to)] = true;
      return;
    }
    const int low = std::min(a.to, b.to);
    const int high = std::max(a.to, b.to);
    parent_[spot(high)] = low;
    sign_[spot(high)] = sign;
    if (rests_[spot(high)]) rests_[spot(low)] = true;
  }
  [[nodiscard]] bool rests(int i) const { return rests_[spot(root(i).to)]; }
  [[nodiscard]] bool is_one(int i, int j) const { return root(i).to == root(j).to; }

 private:
  std::vector<int> parent_, sign_;
  std::vector<bool> rests_;
};

class BySymmetry {
 public:
  BySymmetry(const Mechanics& mechanics, const SceneFacts& scene, const std::vector<int>& resting)
      : mechanics_(mechanics),
        scene_(scene),
        resting_(resting.begin(), resting.end()),
        n_(mechanics.degrees_of_freedom),
        orbits_(n_) {}

  std::optional<LinearChange> run() {
    const std::vector<std::pair<std::string, std::string>> equal = equal_parameters();
    SymmetrySearch search(mechanics_, substitute(mechanics_.energy, united(equal)),
                          [this](int i, int j, int sign) { return begins_alike(i, j, sign); });
    std::vector<Substitution> found;
    for (int i = 0; i < n_; ++i) {
      if (begins_alike(i, i, -1) && !orbits_.rests(i) && !resting_.contains(i))
        try_one(search, i, {i, -1}, found);
      for (int j = 0; j < i; ++j) {
        for (const int sign : {1, -1}) {
          if (!orbits_.is_one(i, j) && !resting_.contains(i) && begins_alike(i, j, sign))
            try_one(search, i, {j, sign}, found);
        }
      }
    }
    if (found.empty()) return std::nullopt;
    change_.united = needed(equal, found);
    if (!fill()) return std::nullopt;
    return change_;
  }

 private:
  void try_one(SymmetrySearch& search, int i, const Image& image,
               std::vector<Substitution>& found) {
    const std::optional<SignedPermutation> symmetry = search.find(i, image.to, image.sign);
    if (!symmetry) return;
    found.push_back(search.as_substitution(*symmetry));
    for (int k = 0; k < n_; ++k) orbits_.join(k, (*symmetry)[spot(k)]);
  }

  [[nodiscard]] bool is_kept(int i) const {
    const auto named = [this](const std::string& name) {
      return scene_.kept.contains(name) || scene_.kept.contains(name.substr(0, name.find('[')));
    };
    return named(mechanics_.variables.name(spot(i))) ||
           named(mechanics_.variables.name(spot(n_ + i)));
  }
  [[nodiscard]] bool begins_alike(int i, int j, int sign) const {
    if (i == j && sign == 1) return true;
    const bool is_time = mechanics_.has_time && (i == n_ - 1 || j == n_ - 1);
    if (is_time || is_kept(i) || is_kept(j)) return false;
    if (resting_.contains(i) != resting_.contains(j)) return false;
    const SceneValues& values = scene_.values;
    return is_same_number(values.q[spot(i)], sign * values.q[spot(j)]) &&
           is_same_number(values.p[spot(i)], sign * values.p[spot(j)]);
  }

  // Run-time parameters of one value, each with the first of them.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> equal_parameters() const {
    std::vector<std::pair<std::string, std::string>> result;
    std::map<Rational, std::string> first;
    for (const auto& [name, value] : scene_.parameters) {
      const bool is_free = std::ranges::find(mechanics_.parameters, name, &Quantity::name) !=
                           mechanics_.parameters.end();
      if (!is_free || scene_.kept.contains(name) ||
          scene_.kept.contains(name.substr(0, name.find('['))))
        continue;
      const auto [it, fresh] = first.emplace(value, name);
      if (!fresh) result.emplace_back(name, it->second);
    }
    return result;
  }
  [[nodiscard]] Substitution united(
      const std::vector<std::pair<std::string, std::string>>& pairs) const {
    return united_parameters(pairs, mechanics_.energy);
  }
  // Of these those without which one of the symmetries is none.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> needed(
      std::vector<std::pair<std::string, std::string>> equal,
      const std::vector<Substitution>& found) const {
    for (std::size_t k = equal.size(); k-- > 0;) {
      auto fewer = equal;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
      const Expression energy = substitute(mechanics_.energy, united(fewer));
      if (std::ranges::all_of(
              found, [&](const auto& each) { return SymmetrySearch::keeps(energy, each); }))
        equal = std::move(fewer);
    }
    return equal;
  }

  [[nodiscard]] std::string name(int i) const { return mechanics_.variables.name(spot(i)); }

  // False if nothing is left.
  bool fill() {
    std::map<int, std::vector<Image>> members;  // by the first of each orbit
    for (int i = 0; i < n_; ++i) {
      if (!orbits_.rests(i)) members[orbits_.root(i).to].push_back({i, orbits_.root(i).sign});
    }
    if (members.empty()) return false;
    change_.from = n_;
    change_.to = static_cast<int>(members.size());
    NewNames names(mechanics_);
    std::vector<Quantity> momenta;
    int column = 0;
    for (const auto& [first, orbit] : members) {
      const auto size = static_cast<long>(orbit.size());
      for (const Image& each : orbit) {
        change_.a[{each.to, column}] = each.sign;
        change_.b[{each.to, column}] = Rational(each.sign, size);
      }
      ++column;
      change_.variables.push_back(mechanics_.variables[spot(first)]);
      momenta.push_back(mechanics_.variables[spot(n_ + first)]);
      if (size == 1) continue;
      momenta.back().comment = sum_text(orbit);
      momenta.back().name = names.made_of(name(n_ + first), "sum");
    }
    std::ranges::move(momenta, std::back_inserter(change_.variables));
    say(members);
    return true;
  }

  [[nodiscard]] std::string sum_text(const std::vector<Image>& orbit) const {
    std::string text;
    for (const Image& each : orbit)
      text += (text.empty() ? "" : each.sign < 0 ? " - " : " + ") + name(n_ + each.to);
    return text;
  }

  void say(const std::map<int, std::vector<Image>>& members) {
    const std::string where =
        scene_.values.name.empty() ? "here" : "in scene " + scene_.values.name;
    for (const auto& [parameter, other] : change_.united)
      change_.left_out.push_back(
          fmt::format("parameter {}: equal to {} {}", parameter, other, where));
    std::vector<std::string> equal;
    for (const auto& [first, orbit] : members) {
      for (const Image& each : orbit) {
        if (each.to != first)
          equal.push_back(
              fmt::format("{} = {}{}", name(each.to), each.sign < 0 ? "-" : "", name(first)));
      }
    }
    std::vector<std::string> zeros;
    for (int i = 0; i < n_; ++i) {
      if (orbits_.rests(i)) zeros.push_back(fmt::format("{} = 0", name(i)));
    }
    equal.insert(equal.end(), zeros.begin(), zeros.end());
    change_.left_out.push_back(
        fmt::format("{}, and so their momenta: H is symmetric, and the scene begins so",
                    fmt::join(equal, ", ")));
  }

  const Mechanics& mechanics_;
  const SceneFacts& scene_;
  std::set<int> resting_;
  int n_;
  Orbits orbits_;
  LinearChange change_;
};

}  // namespace

std::optional<LinearChange> by_symmetry(const Mechanics& mechanics, const SceneFacts& scene,
                                        const std::vector<int>& resting) {
  if (mechanics.keeps_sums() || mechanics.degrees_of_freedom < 2 ||
      mechanics.degrees_of_freedom > kMostWrittenOut)
    return std::nullopt;
  return BySymmetry(mechanics, scene, resting).run();
}

}  // namespace hamgen
