#include "generator/verify/sample_points.hpp"

#include <algorithm>
#include <cmath>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

constexpr int kKinds = 5;

// 32 random bits: enough for a number without accidents, and few enough to be read.
constexpr double kUnit = 0x1p-32;

bool is_step(const std::string& name) { return name == "h"; }

}  // namespace

std::map<std::string, Rational> centre_of(const Model& model, const SceneValues& scene) {
  std::map<std::string, Rational> centre;
  const auto add = [&centre](const std::vector<std::string>& names,
                             const std::vector<Rational>& values) {
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i)
      centre[names[i]] = values[i];
  };
  add(element_names(model.parameters), scene.parameters);
  add(element_names(model.coordinates), scene.q);
  add(element_names(model.momenta), scene.p);
  if (scene.h) centre["h"] = *scene.h;
  return centre;
}

Surroundings surroundings_of(const Model& model) {
  Surroundings around;
  std::vector<SceneRequest> wanted;
  for (const Scene& scene : model.scenes) wanted.push_back({.scene = scene.name});
  if (wanted.empty()) wanted.emplace_back();
  for (const SceneRequest& request : wanted) {
    try {
      around.centres.push_back(centre_of(model, scene_values(model, request)));
    } catch (const ModelError&) {  // said by `check`; the others remain
      continue;
    }
  }
  if (model.scenes.empty() && !around.centres.empty()) {
    // All zero is no place to be near to: only the parameters say something.
    std::map<std::string, Rational>& defaults = around.centres.front();
    for (const auto& names : {element_names(model.coordinates), element_names(model.momenta)}) {
      for (const std::string& name : names) defaults.erase(name);
    }
  }
  return around;
}

SamplePoint::SamplePoint(const Surroundings& around, int number, int attempt)
    : kind_(static_cast<Kind>((number + attempt) % kKinds)),
      radius_(0.5 / (1.0 + attempt)),
      source_(static_cast<std::uint64_t>(number) * 1009U + static_cast<std::uint64_t>(attempt) +
              1U) {
  if (around.centres.empty()) return;
  const auto which = static_cast<std::size_t>((number + attempt) / kKinds);
  centre_ = &around.centres[which % around.centres.size()];
  double largest = 0.0;
  for (const auto& [name, value] : *centre_) {
    const double size = std::abs(to_double(value));
    if (!is_step(name)) largest = std::max(largest, size);
  }
  if (largest > 0.0) scale_ = std::min(largest, 1.0);
}

double SamplePoint::uniform(double low, double high) {
  return low + (high - low) * kUnit * static_cast<double>(source_() >> 32);
}

const Rational* SamplePoint::value_at_centre(const std::string& name) const {
  if (centre_ == nullptr) return nullptr;
  if (const auto it = centre_->find(name); it != centre_->end()) return &it->second;
  const std::size_t open = name.find('(');
  const std::size_t close = name.rfind(')');
  if (open == std::string::npos || close == std::string::npos) return nullptr;
  const auto it = centre_->find(name.substr(open + 1, close - open - 1));
  return it == centre_->end() ? nullptr : &it->second;
}

double SamplePoint::signed_size(const std::string& name, double decades) {
  // A step is small, and a parameter seldom turns its sign.
  const double unit = is_step(name) ? 0.1 : 1.0;
  const double size = unit * std::pow(10.0, uniform(-decades, decades));
  return uniform(0.0, 1.0) < 0.4 ? -size : size;
}

double SamplePoint::drawn(const std::string& name) {
  const Rational* value = value_at_centre(name);
  const double centre = value == nullptr ? 0.0 : to_double(*value);
  switch (kind_) {
    case Kind::near:
      if (value == nullptr) break;
      return centre != 0.0 ? centre * (1.0 + uniform(-radius_, radius_))
                           : scale_ * uniform(-radius_, radius_);
    case Kind::around:
      if (value == nullptr) break;
      return (centre != 0.0 ? std::abs(centre) : scale_) * signed_size(name, 0.3) /
             (is_step(name) ? 0.1 : 1.0);
    case Kind::medium:
      return signed_size(name, 1.0);
    case Kind::wide:
      return signed_size(name, is_step(name) ? 2.0 : 3.0);
    case Kind::positive:
      break;
  }
  return uniform(0.25, 1.75) * (is_step(name) ? 0.1 : 1.0);
}

Precise SamplePoint::operator()(const std::string& name) {
  return precise(from_double(drawn(name)));
}

}  // namespace hamgen
