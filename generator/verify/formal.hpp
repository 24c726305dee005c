// The step and the flow of H as power series in h at a random point.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "generator/schemes/scheme.hpp"
#include "generator/verify/derivatives.hpp"
#include "generator/verify/power_series.hpp"
#include "generator/verify/sample_points.hpp"

namespace hamgen {

// z and the free parameters at a point; h is either the series h or one number.
class FormalPoint {
 public:
  // The same for every process; `number` counts points.
  FormalPoint(const Mechanics& mechanics, const Surroundings& around, int number);
  void move(std::size_t i, const Precise& by) { z_[i] = z_[i] + by; }
  // What central differences move a component by: 1e-20 of it, whatever its units.
  [[nodiscard]] Precise spacing(std::size_t i) const;
  void set_step(const PowerSeries& h) { symbols_["h"] = h; }
  [[nodiscard]] const PowerSeries& step() const { return symbols_.at("h"); }
  [[nodiscard]] std::vector<PowerSeries> state() const;
  [[nodiscard]] const Precise& random() const { return random_; }

  // Expressions in z, h and the parameters at a series of states.  Throws std::domain_error.
  [[nodiscard]] std::vector<PowerSeries> values(const std::vector<Expression>& expressions,
                                                const std::vector<PowerSeries>& state,
                                                std::size_t length) const;
  // Matrix C of the member: its entries, or their limits where they have a pole at h = 0 that
  // cancels.
  [[nodiscard]] std::map<std::pair<int, int>, PowerSeries> gauge(const Member& member,
                                                                 std::size_t length) const;

 private:
  const Mechanics& mechanics_;
  std::map<std::string, PowerSeries> symbols_;  // parameters and h
  std::vector<Precise> z_;
  Precise random_;  // one number more, a small step
};

// J g of a gradient.
[[nodiscard]] std::vector<PowerSeries> rotated(const std::vector<PowerSeries>& gradient);

// The flow of H from the point, as far as h^(length - 1).
[[nodiscard]] std::vector<PowerSeries> flow_series(const Derivatives& derivatives,
                                                   const FormalPoint& point, std::size_t length);

}  // namespace hamgen
