#include "generator/verify/model_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "generator/base/diagnostic.hpp"
#include "generator/language/model.hpp"
#include "generator/verify/text_value.hpp"

namespace hamgen {

namespace {

constexpr int kPointsOfReading = 20;
// Of a large system, where each of them has thousands of terms.
constexpr int kPointsOfLargeReading = 3;
constexpr int kLargeReading = 32;  // degrees of freedom
constexpr int kGradientsOfReading = 4;
constexpr int kAttemptsOfReading = 8;

// What is compared at one point.
class Reading {
 public:
  Reading(const Model& model, const Mechanics& mechanics, const DerivedFormulas& derived)
      : model_(model), mechanics_(mechanics), derived_(derived) {}

  // False where something is not defined at the point.
  bool at(SamplePoint draw, bool with_gradient) {
    point_.clear();
    for (const Quantity& variable : mechanics_.variables)
      point_[variable.name] = draw(variable.name);
    for (const Quantity& parameter : mechanics_.parameters)
      point_[parameter.name] = draw(parameter.name);
    for (const Quantity& constant : mechanics_.constants)
      point_[constant.name] = precise(constant.value);
    // Elements that a scene has made one number are still those of the text.
    for (const std::string& name : element_names(model_.parameters)) {
      if (!point_.contains(name)) point_[name] = draw(name);
    }
    try {
      return look(with_gradient);
    } catch (const std::domain_error&) {
      return false;
    }
  }
  [[nodiscard]] const std::string& witness() const { return witness_; }
  // A point at which the text has no value and H as derived has one; empty where none was met.
  [[nodiscard]] const std::string& beyond() const { return beyond_; }

 private:
  // The derived expression at the point against what the text says.
  bool compare(const std::string& what, const Expression& e, const ScaledValue& read,
               const Precise& tolerance) {
    PreciseValues values(point_, none_);
    const std::optional<ScaledValue> found = values.scaled(e);
    if (!found) return false;
    const Precise size = found->scale + read.scale;
    const bool same = cln::abs(found->value - read.value) <= tolerance * size;
    if (same || !witness_.empty()) return true;
    witness_ = fmt::format("{} is {:.6g} by the text of the file and {:.6g} as derived, at {}",
                           what, to_double(read.value), to_double(found->value), place());
    return true;
  }

  [[nodiscard]] std::string place() const {
    std::string text;
    for (const auto& [name, value] : point_) {
      if (text.size() > 80) return text + ", ...";
      text += fmt::format("{}{} = {:.4g}", text.empty() ? "" : ", ", name, to_double(value));
    }
    return text;
  }

  [[nodiscard]] ScaledValue hamiltonian() const {
    ScaledValue found = evaluate_text(model_, model_.hamiltonian_text, point_);
    if (!mechanics_.has_time) return found;
    const Precise momentum = point_.at(mechanics_.variables.back().name);
    return {found.value + momentum, found.scale + cln::abs(momentum)};
  }

  // H of the text; where that has no value, whether the derived one has.
  [[nodiscard]] ScaledValue read_hamiltonian() {
    try {
      return hamiltonian();
    } catch (const std::domain_error&) {
      PreciseValues values(point_, none_);
      if (beyond_.empty() && values.scaled(derived_.hamiltonian)) beyond_ = place();
      throw;
    }
  }

  bool look(bool with_gradient) {
    const Precise tolerance = precise(Rational(Integer(1), mpz_class("1" + std::string(40, '0'))));
    if (!compare("H", derived_.hamiltonian, read_hamiltonian(), tolerance)) return false;
    for (const NamedExpression& invariant : derived_.invariants) {
      const auto written = std::ranges::find(model_.invariants, invariant.name, &Invariant::name);
      if (written == model_.invariants.end()) continue;
      if (!compare(invariant.name, invariant.value, evaluate_text(model_, written->text, point_),
                   tolerance))
        return false;
    }
    return !with_gradient || derived_.gradient.empty() || look_at_gradient();
  }

  // Differences over 1e-16 of H in 60 digits are right to 1e-30, where H bends by its own size.
  bool look_at_gradient() {
    const Precise tolerance = precise(Rational(Integer(1), mpz_class("1" + std::string(20, '0'))));
    const Precise small = precise(Rational(Integer(1), mpz_class("1" + std::string(16, '0'))));
    for (std::size_t i = 0; i < derived_.gradient.size(); ++i) {
      const std::string& name = mechanics_.variables.name(i);
      const Precise middle = point_.at(name);
      const Precise size = cln::abs(middle) + small;
      const Precise distance = small * size;
      point_[name] = middle + distance;
      const ScaledValue above = hamiltonian();
      point_[name] = middle - distance;
      const ScaledValue below = hamiltonian();
      point_[name] = middle;
      // Rounding, 1e-60 of the terms of H, counts as much as 1e-20 of the slope's.
      const Precise slope = (above.value - below.value) / (distance + distance);
      const Precise scale =
          cln::abs(slope) + small * small * (above.scale + below.scale) / distance;
      if (!compare("dH/d" + name, derived_.gradient[i], {slope, scale}, tolerance)) return false;
    }
    return true;
  }

  const Model& model_;
  const Mechanics& mechanics_;
  const DerivedFormulas& derived_;
  PointValues point_;
  Substitution none_;
  std::string witness_, beyond_;
};

}  // namespace

Finding prove_model_read(const Model& model, const Mechanics& mechanics,
                         const DerivedFormulas& derived, const Surroundings& around) {
  Reading reading(model, mechanics, derived);
  const bool large = mechanics.degrees_of_freedom > kLargeReading;
  const int wanted = large ? kPointsOfLargeReading : kPointsOfReading;
  int points = 0;
  for (int number = 0; number < wanted; ++number) {
    bool defined = false;
    for (int attempt = 0; attempt < kAttemptsOfReading && !defined; ++attempt)
      defined = reading.at(SamplePoint(around, number, attempt), number < kGradientsOfReading);
    if (!reading.witness().empty()) return {kModelRead, Verdict::refuted, reading.witness()};
    points += defined ? 1 : 0;
  }
  if (points == 0) {
    return {kModelRead, Verdict::not_decided,
            "no point was found where the text of the file has a value"};
  }
  const std::string gradient = derived.gradient.empty() ? "" : ", its gradient";
  const std::string invariants = derived.invariants.empty() ? "" : ", the invariants";
  const std::string beyond =
      reading.beyond().empty()
          ? ""
          : "; where the text has no value H as derived may have one, at " + reading.beyond();
  return {kModelRead, Verdict::tested,
          fmt::format("H{}{} evaluated from the text of the file at {} points, without the front "
                      "end: what was derived{}",
                      gradient, invariants, points, beyond)};
}

std::string point_beyond_text(const Model& model, const Mechanics& mechanics) {
  if (mechanics.keeps_sums() || mechanics.degrees_of_freedom > kLargeReading) return {};
  const Surroundings around = surroundings_of(model);
  const DerivedFormulas derived{.hamiltonian = mechanics.energy};
  Reading reading(model, mechanics, derived);
  for (int number = 0; number < kPointsOfReading && reading.beyond().empty(); ++number)
    (void)reading.at(SamplePoint(around, number, 0), false);
  return reading.beyond();
}

}  // namespace hamgen
