// Integrators of other libraries on the same model: what they get, and what they say.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/library.hpp"

namespace hamgen::peers {

// What H is.
enum class Form {
  any,
  separable,  // T(p) + V(q)
  unit_mass,  // |p|^2/2 + V(q)
};

// z' = J grad H(z) through the gradient that hamgen emitted, called through one pointer.
class Flow {
 public:
  Flow(std::shared_ptr<const runtime::Library> library, std::vector<double> parameters)
      : library_(std::move(library)),
        parameters_(std::move(parameters)),
        gradient_(library_->plugin().gradient),
        work_(2 * n()) {}

  [[nodiscard]] std::size_t n() const { return library_->degrees_of_freedom(); }
  [[nodiscard]] double energy(const std::vector<double>& z) const {
    return library_->energy(parameters_, z);
  }
  // grad H(z), H_q first; 2n values.
  void gradient(const double* z, double* values) const { gradient_(parameters_.data(), z, values); }
  // z' = (H_p, -H_q); 2n values.
  void derivative(const double* z, double* values) const {
    gradient(z, work_.data());
    for (std::size_t i = 0; i < n(); ++i) {
      values[i] = work_[n() + i];
      values[n() + i] = -work_[i];
    }
  }
  // As far as the gradient there and at other momenta and positions tells, which is asked once.
  [[nodiscard]] Form form(const std::vector<double>& z) const;

 private:
  std::shared_ptr<const runtime::Library> library_;
  std::vector<double> parameters_;
  void (*gradient_)(const double*, const double*, double*);
  mutable std::vector<double> work_;
  mutable std::optional<Form> form_;
};

// Called with the state after each step a library took.
using Observer = std::function<void(const std::vector<double>&)>;

struct Peer {
  std::string name;
  bool adaptive = true;   // the setting is a tolerance, else a step size
  Form form = Form::any;  // what it takes, and what is more special
  std::size_t most_degrees_of_freedom = 1'000'000;
  // Moves z over `time`.  False if the library gave up.  The observer may be empty.
  std::function<bool(const Flow&, std::vector<double>& z, double time, double setting,
                     const Observer&)>
      integrate;

  [[nodiscard]] bool suits(const Flow& flow, const std::vector<double>& start) const {
    return flow.form(start) >= form;
  }
};

[[nodiscard]] std::vector<Peer> odeint_peers();
[[nodiscard]] std::vector<Peer> gsl_peers();

}  // namespace hamgen::peers
