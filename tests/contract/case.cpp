#include "tests/contract/case.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "generator/base/source_text.hpp"
#include "generator/interpreter/compiled_expression.hpp"
#include "generator/language/scene.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "tests/contract/models.hpp"

namespace hamgen::contract {

namespace {

// The value of an expression in h and parameters.
class Evaluator {
 public:
  Evaluator(const Start& start, Quad h) {
    names_.emplace_back("h");
    values_.push_back(h);
    for (const auto& [name, value] : start.parameters) {
      names_.push_back(name);
      values_.push_back(value);
    }
  }
  Quad operator()(const Expression& e) {
    Frame<Quad> frame{.objects = {values_.data()}, .indices = {}};
    return CompiledExpression<Quad>(e, [this](const std::string& symbol) -> Address {
      return {.offset = std::ranges::find(names_, symbol) - names_.begin()};
    })(frame);
  }

 private:
  std::vector<std::string> names_;
  std::vector<Quad> values_;
};

Equations equations_of(const Member& of, int n, Evaluator& value) {
  const auto size = 2 * static_cast<std::size_t>(n);
  Matrix c(size, Vector(size));
  for (std::size_t k = 0; k < size; ++k) c[k][k] = Quad(0.5);
  for (const auto& [place, entry] : of_all(of, n).c) {
    c[static_cast<std::size_t>(place.first)][static_cast<std::size_t>(place.second)] +=
        value(entry);
  }
  return member(std::move(c));
}

Equations equations_of(const RungeKutta& method, Evaluator& value) {
  if (method.is_explicit()) return {};
  Matrix a;
  Vector b;
  for (const auto& row : method.a) {
    Vector& numbers = a.emplace_back();
    for (const Expression& e : row) numbers.push_back(value(e));
  }
  for (const Expression& e : method.b) b.push_back(value(e));
  return runge_kutta(std::move(a), std::move(b));
}

}  // namespace

Start start_of(const Case& c) {
  const Model model = read_request(c.model, c.request);
  const SceneValues scene = scene_values(model, {.scene = c.scene});
  Start start{.h = to_double(scene.h.value_or(Rational(1, 100))),
              .steps = c.steps > 0 ? c.steps : scene.steps.value_or(100)};
  const std::vector<std::string> names = element_names(model.parameters);
  for (std::size_t i = 0; i < names.size(); ++i) {
    start.parameters.emplace_back(names[i], to_double(scene.parameters[i]));
  }
  for (const Rational& value : scene.q) start.state.push_back(to_double(value));
  for (const Rational& value : scene.p) start.state.push_back(to_double(value));
  return start;
}

Equations equations_of(const Scheme& scheme, int degrees_of_freedom, const Start& start, Quad h) {
  Evaluator value(start, h);
  if (scheme.has_member()) return equations_of(scheme.member(), degrees_of_freedom, value);
  if (const auto* method = std::get_if<RungeKutta>(&scheme.method)) {
    return equations_of(*method, value);
  }
  return {};
}

std::vector<Method> all_methods() {
  std::vector<Method> methods = {
      {"newton", {.solver = "newton"}},
      {"fixed-point", {.solver = "fixed-point"}},
      {"member", {.alpha = "3/10", .beta = "1/5", .gamma = "-1/10"}},
      {"member-fixed", {.alpha = "3/10", .beta = "1/5", .gamma = "-1/10", .solver = "fixed-point"}},
      {"order-4", {.order = 4}},
      {"order-6", {.order = 6}},
      {"gauss-4-fixed", {.scheme = "gauss-4", .solver = "fixed-point"}},
      {"gauss-4-newton", {.scheme = "gauss-4", .solver = "newton"}}};
  for (const Scheme& scheme : all_schemes())
    methods.push_back({scheme.name, {.scheme = scheme.name}});
  return methods;
}

std::vector<Case> scenes_of(const Model& model, const SourceText& source, const Method& method,
                            long most_steps) {
  std::vector<Case> result;
  for (const Scene& scene : model.scenes) {
    const SceneValues values = scene_values(model, {.scene = scene.name});
    if (!values.h || !values.steps) continue;
    result.push_back({.name = model.name + " " + scene.name + " " + method.name,
                      .model = source,
                      .scene = scene.name,
                      .request = method.request,
                      .steps = most_steps > 0 ? std::min(most_steps, *values.steps) : 0});
  }
  return result;
}

namespace {

std::string path_of(const SteepModel& steep) { return std::string(steep.name) + ".ham"; }

}  // namespace

SourceText model(const std::string& name) {
  for (const SteepModel& steep : kSteepModels) {
    if (name == steep.name) {
      return make_source(path_of(steep), "system " + name + "\n" + steep.text);
    }
  }
  return read_source(std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/" + name + ".ham");
}

bool has_cancelling_forces(const SourceText& model) {
  return std::ranges::any_of(kSteepModels, [&](const SteepModel& steep) {
    return steep.cancels && model.path == path_of(steep);
  });
}

std::vector<std::string> all_models() {
  std::vector<std::string> models;
  for (const SteepModel& steep : kSteepModels) models.emplace_back(steep.name);
  for (const auto& entry : std::filesystem::directory_iterator(HAMGEN_SOURCE_DIR "/hamiltonians")) {
    models.push_back(entry.path().stem().string());
  }
  std::ranges::sort(models);
  if (std::ranges::adjacent_find(models) != models.end())
    throw std::logic_error("two models of one name: one of them would not be measured");
  return models;
}

}  // namespace hamgen::contract
