#include "generator/verify/specialised.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/algebra/from_ginac.hpp"
#include "generator/language/constant.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/verify/identities.hpp"

namespace hamgen {

namespace {

std::size_t position(int i) { return static_cast<std::size_t>(i); }

// H as a thing to differentiate.
class Slopes {
 public:
  explicit Slopes(const Expression& hamiltonian) : value_(to_ginac(hamiltonian, table_)) {}
  Expression by(const std::string& variable) {
    const GiNaC::ex symbol = table_.symbol(variable, kRankOfVariable);
    return from_ginac(value_.diff(GiNaC::ex_to<GiNaC::symbol>(symbol)), table_);
  }

 private:
  SymbolTable table_;
  GiNaC::ex value_;
};

class SpecialisedClaims {
 public:
  SpecialisedClaims(const Model& model, const FoldedModel& folded, const Specialised& system,
                    const SceneFacts& scene)
      : model_(with_free_parameters(model)),
        folded_(folded),
        system_(system),
        scene_(scene),
        n_(system.whole.degrees_of_freedom),
        given_(written_out_hamiltonian(folded.model)),
        start_(system_start()),
        hamiltonian_(in_new_variables(given_)),
        slopes_(hamiltonian_) {
    for (const int i : system.resting) {
      zeros_.emplace(name(i), Expression(0));
      zeros_.emplace(name(n_ + i), Expression(0));
    }
  }

  // A value of the scene that is not what it is taken for.
  [[nodiscard]] std::string wrong_value() const {
    const std::vector<std::string> names = element_names(model_.parameters);
    const auto value = [&](const std::string& of) {
      const auto found = std::ranges::find_if(
          names, [&](const std::string& each) { return each == of || each.starts_with(of + "["); });
      return found == names.end()
                 ? Rational(0)
                 : scene_.values.parameters[position(static_cast<int>(found - names.begin()))];
    };
    for (const FoldedParameter& each : folded_.folding.values) {
      if (value(each.name) != each.value)
        return fmt::format("{} is {} in the scene, not {}", each.name, short_text(value(each.name)),
                           short_text(each.value));
    }
    for (const auto& [each, other] : folded_.folding.same) {
      if (value(each) != value(other))
        return fmt::format("{} and {} are not equal in the scene", each, other);
    }
    for (const LinearChange& change : system_.changes) {
      for (const auto& [each, other] : change.united) {
        if (value(each) != value(other))
          return fmt::format("{} and {} are not equal in the scene", each, other);
      }
    }
    if (const std::string wrong = wrong_change(); !wrong.empty()) return wrong;
    for (const int i : system_.resting) {
      for (const int v : {i, n_ + i}) {
        if (start_[position(v)] != 0) return name(v) + " does not start at 0";
      }
    }
    return "";
  }

  Identities run() {
    claim_values();
    claim_changes();
    claim_motion();
    claim_system();
    if (system_.whole_scheme.has_member()) claim_matrix();
    return std::move(identities_);
  }

 private:
  [[nodiscard]] std::string name(int i) const { return system_.whole.variables.name(position(i)); }
  void claim(std::string what, const Expression& is, const Expression& should_be) {
    identities_.claims.push_back({std::move(what), is, should_be});
  }
  // dH/dz_i where the resting variables are zero.
  Expression slope(int i) { return substitute(slopes_.by(name(i)), zeros_); }
  // (J grad H)_i there.
  Expression flow(int i) { return i < n_ ? slope(i + n_) : -slope(i - n_); }

  // Where the scene begins, in the variables of the whole system.
  [[nodiscard]] std::vector<Rational> system_start() const {
    std::vector<Rational> start = scene_.values.q;
    start.insert(start.end(), scene_.values.p.begin(), scene_.values.p.end());
    for (const LinearChange& change : system_.changes)
      start = times(change.projection(), start, 2 * change.to);
    return start;
  }
  static std::vector<Rational> times(const SparseRationalMatrix& matrix,
                                     const std::vector<Rational>& z, int rows) {
    std::vector<Rational> result(position(rows));
    for (const auto& [place, entry] : matrix)
      result[position(place.first)] += entry * z[position(place.second)];
    return result;
  }

  // A^T B is not 1, or the scene does not begin in the image of L.
  [[nodiscard]] std::string wrong_change() const {
    std::vector<Rational> start = scene_.values.q;
    start.insert(start.end(), scene_.values.p.begin(), scene_.values.p.end());
    const Mechanics* before = &system_.given;
    for (const LinearChange& change : system_.changes) {
      SparseRationalMatrix unit;
      for (int i = 0; i < 2 * change.to; ++i) unit[{i, i}] = 1;
      if (product(change.projection(), change.embedding()) != unit)
        return "the new variables have another symplectic form";
      const std::vector<Rational> there = times(change.projection(), start, 2 * change.to);
      const std::vector<Rational> back = times(change.embedding(), there, 2 * change.from);
      for (std::size_t i = 0; i < back.size() && change.from != change.to; ++i) {
        if (!is_same_number(back[i], start[i]))
          return fmt::format("{} does not begin as the new variables have it",
                             old_name(*before, change, static_cast<int>(i)));
      }
      start = there;
    }
    return "";
  }
  // Of the variables before a change: those of the model, or those of the change before.
  [[nodiscard]] std::string old_name(const Mechanics& given, const LinearChange& change,
                                     int i) const {
    const LinearChange* first = system_.changes.data();
    return &change == first ? given.variables.name(position(i))
                            : (&change - 1)->variables[position(i)].name;
  }

  // z -> L Z, and parameters that are one.
  [[nodiscard]] Substitution substitution(const LinearChange& change,
                                          const Expression& energy) const {
    Substitution result = united_parameters(change.united, energy);
    std::map<int, std::vector<Expression>> sums;
    for (const auto& [place, entry] : change.embedding())
      sums[place.first].push_back(Expression(entry) *
                                  Expression::symbol(change.variables[position(place.second)].name,
                                                     kRankOfVariable + place.second));
    for (int i = 0; i < 2 * change.from; ++i)
      result.emplace(old_name(system_.given, change, i), Expression::sum(sums[i]));
    return result;
  }
  [[nodiscard]] Expression in_new_variables(Expression energy) const {
    for (const LinearChange& change : system_.changes)
      energy = substitute(energy, substitution(change, energy));
    return energy;
  }

  // Note [a step in new variables]: grad H(L Z) = (B, A) grad H'(Z) and C L = L C'.
  void claim_changes() {
    Expression energy = given_;
    std::optional<SparseMatrix> c;
    if (system_.given_scheme.has_member())
      c = full(system_.given_scheme.member(), system_.given.degrees_of_freedom);
    for (const LinearChange& change : system_.changes) {
      const Substitution here = substitution(change, energy);
      const Expression image = substitute(energy, here);
      claim_gradient(change, substitute(energy, united_parameters(change.united, energy)), image,
                     here);
      energy = image;
    }
    if (c && !system_.changes.empty()) claim_changed_matrix(*c);
  }
  void claim_gradient(const LinearChange& change, const Expression& energy, const Expression& image,
                      const Substitution& here) {
    Slopes before(energy);
    Slopes after(image);
    const auto rows = [](const SparseRationalMatrix& matrix, int row) {
      std::vector<std::pair<int, Rational>> entries;
      for (auto it = matrix.lower_bound({row, 0}); it != matrix.end() && it->first.first == row;
           ++it)
        entries.emplace_back(it->first.second, it->second);
      return entries;
    };
    for (int i = 0; i < 2 * change.from; ++i) {
      const bool is_p = i >= change.from;
      Expression sum(0);
      for (const auto& [k, entry] : rows(is_p ? change.a : change.b, is_p ? i - change.from : i))
        sum = sum + Expression(entry) *
                        after.by(change.variables[position(is_p ? k + change.to : k)].name);
      const std::string name = old_name(system_.given, change, i);
      claim("dH/d" + name + " where the scene is", substitute(before.by(name), here), sum);
    }
  }
  static SparseMatrix full(const Member& member, int n) {
    SparseMatrix c;
    for (const auto& [place, entry] : member.c) {
      if (member.degrees_of_freedom == n) c.emplace(place, entry);
      for (int i = 0; i < n && member.degrees_of_freedom < n; ++i)
        c.emplace(std::pair(place.first * n + i, place.second * n + i), entry);
    }
    return c;
  }
  // Over all changes at once.
  void claim_changed_matrix(const SparseMatrix& c) {
    SparseRationalMatrix l;
    for (int i = 0; i < 2 * system_.given.degrees_of_freedom; ++i) l[{i, i}] = 1;
    for (const LinearChange& change : system_.changes) l = product(l, change.embedding());
    std::map<std::pair<int, int>, std::vector<Expression>> difference;
    for (const auto& [place, entry] : c) {
      for (const auto& [other, factor] : l) {
        if (other.first == place.second)
          difference[{place.first, other.second}].push_back(entry * Expression(factor));
      }
    }
    for (const auto& [place, entry] : full(system_.whole_scheme.member(), n_)) {
      for (const auto& [other, factor] : l) {
        if (other.second == place.first)
          difference[{other.first, place.second}].push_back(-(entry * Expression(factor)));
      }
    }
    for (const auto& [place, terms] : difference)
      claim(fmt::format("C moves {} by {}", system_.given.variables.name(position(place.first)),
                        name(place.second)),
            Expression::sum(terms), Expression(0));
  }

  // H with the scene's values is the H that was made of it.
  void claim_values() {
    Substitution values;
    for (const FoldedParameter& each : folded_.folding.values)
      values.emplace(each.name, each.value);
    for (const auto& [each, other] : folded_.folding.same) {
      const auto known = values.find(other);
      values.insert_or_assign(each,
                              known == values.end() ? Expression::symbol(other) : known->second);
    }
    if (values.empty()) return;
    claim("H with the scene's values", given_, substitute(written_out_hamiltonian(model_), values));
  }

  // What rests is not moved, and a cyclic coordinate does not occur.
  void claim_motion() {
    for (const int i : system_.resting) {
      claim("what moves " + name(i), flow(i), Expression(0));
      claim("what moves " + name(n_ + i), flow(n_ + i), Expression(0));
    }
    for (const int i : system_.left.cyclic)
      claim("what moves " + name(n_ + i), flow(n_ + i), Expression(0));
  }

  // What is kept moves as in the whole.  Loops are held against H on their own, here it is what
  // they are held against.
  void claim_system() {
    const bool loops = system_.mechanics.keeps_sums();
    if (loops && system_.left.dropped.empty()) return;
    const Expression left =
        loops ? restrict_to(hamiltonian_, system_.whole, system_.kept, system_.left)
              : system_.mechanics.energy;
    if (system_.left.dropped.empty())
      claim("H of what is left", left, substitute(hamiltonian_, zeros_));
    Slopes slopes(left);
    for (const int i : system_.kept) {
      for (const int v : {i, n_ + i}) claim("dH/d" + name(v), slopes.by(name(v)), slope(v));
    }
  }

  void claim_matrix() {
    const SparseMatrix c = full(system_.whole_scheme.member(), n_);
    const std::set<int> kept(system_.kept.begin(), system_.kept.end());
    const std::set<int> resting(system_.resting.begin(), system_.resting.end());
    const std::set<int> cyclic(system_.left.cyclic.begin(), system_.left.cyclic.end());
    SparseMatrix left;
    for (const auto& [place, entry] : c) {
      const auto& [row, column] = place;
      const int of = row % n_;
      const int by = column % n_;
      const std::string what = fmt::format("C moves {} by {}", name(row), name(column));
      const bool constant_row = cyclic.contains(of) && row >= n_;
      if (resting.contains(of) && !resting.contains(by)) claim(what, entry, Expression(0));
      if ((kept.contains(of) && !kept.contains(by)) || constant_row)
        claim(what, entry * flow(column), Expression(0));
      if (kept.contains(of) && kept.contains(by)) left.emplace(place, entry);
    }
    claim_block(left);
  }

  // The C that is left is the block of the whole one.
  void claim_block(const SparseMatrix& block) {
    const int m = static_cast<int>(system_.kept.size());
    const SparseMatrix c = full(system_.scheme.member(), m);
    const auto entry = [](const SparseMatrix& matrix, int row, int column) {
      const auto it = matrix.find({row, column});
      return it == matrix.end() ? Expression(0) : it->second;
    };
    const auto in_whole = [&](int i) {
      return i < m ? system_.kept[position(i)] : n_ + system_.kept[position(i - m)];
    };
    std::set<std::pair<int, int>> places;
    for (int i = 0; i < 2 * m; ++i) {
      for (int j = 0; j < 2 * m; ++j) {
        const bool somewhere = c.contains({i, j}) || block.contains({in_whole(i), in_whole(j)});
        if (somewhere)
          claim("an entry of C", entry(c, i, j), entry(block, in_whole(i), in_whole(j)));
      }
    }
  }

  Model model_;
  const FoldedModel& folded_;
  const Specialised& system_;
  const SceneFacts& scene_;
  int n_;
  Expression given_;  // H with the values that were put in
  std::vector<Rational> start_;
  Expression hamiltonian_;  // after the changes of variables
  Slopes slopes_;
  Substitution zeros_;
  Identities identities_;
};

}  // namespace

Model with_free_parameters(Model model) {
  for (Parameter& parameter : model.parameters) parameter.folded = false;
  return model;
}

Finding prove_specialised(const Model& model, const FoldedModel& folded, const Specialised& system,
                          const SceneFacts& scene, const Surroundings& around) {
  const std::string property = "specialised";
  SpecialisedClaims claims(model, folded, system, scene);
  if (const std::string wrong = claims.wrong_value(); !wrong.empty())
    return {property, Verdict::refuted, wrong};
  const Decision decision = decide(claims.run(), around);
  if (!holds(decision.verdict)) return {property, decision.verdict, decision.witness};
  const std::string of = scene.values.name.empty() ? "this run" : "scene " + scene.values.name;
  return {property, decision.verdict,
          fmt::format("{}: from {} the whole system moves these variables as this one does",
                      to_text(decision), of)};
}

}  // namespace hamgen
