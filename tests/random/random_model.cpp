#include "tests/random/random_model.hpp"

#include <fmt/format.h>

#include <vector>

#include "tests/fuzz/random.hpp"

namespace hamgen::random {
namespace {

class Writer {
 public:
  explicit Writer(std::uint64_t seed) : random_(seed) {}

  RandomCase run() {
    RandomCase result{.separable = random_.one_in(2)};
    declare();
    const std::string kinetic = this->kinetic();
    const std::string potential = this->potential();
    text_ += "H = " + kinetic + " + " + potential;
    if (!result.separable) text_ += " + " + coupling();
    text_ += "\n";
    if (random_.one_in(3)) text_ += "invariant A = " + smooth(both(), 2) + "\n";
    scene();
    result.text = text_;
    result.request = request(result.separable);
    return result;
  }

 private:
  void declare() {
    text_ = "system chance\n";
    if (random_.one_in(4)) {
      array();
    } else {
      const int n = random_.between(1, 3);
      for (int i = 1; i <= n; ++i) {
        text_ += fmt::format("coordinate q{0}\nmomentum p{0}\n", i);
        q_.push_back(fmt::format("q{}", i));
        p_.push_back(fmt::format("p{}", i));
      }
    }
    if (random_.one_in(8)) {
      text_ += "time t\n";
      times_ = true;
    }
    for (int i = random_.below(3); i > 0; --i) {
      text_ += fmt::format("parameter w{} = {}\n", i, positive());
      parameters_.push_back(fmt::format("w{}", i));
    }
    if (random_.one_in(3)) {
      definition_ = "u";
      text_ += "let u = " + smooth(q_, 2) + "\n";
    }
  }

  // A chain; its single elements are variables of the other terms too.
  void array() {
    n_ = random_.one_in(4) ? random_.between(20, 40) : random_.between(2, 5);
    text_ += fmt::format("size N = {}\n", n_);
    text_ += fmt::format("coordinate x[1..N] {}\nmomentum y[1..N]\n",
                         random_.one_in(2) ? "periodic" : "with x[0] = 0, x[N+1] = 1/4");
    if (random_.one_in(2)) {
      text_ += "parameter m[1..N] = 3/2\n";
      masses_ = true;
    }
    q_ = {"x[1]", "x[N]"};
    p_ = {"y[1]", "y[N]"};
  }

  std::string positive() {
    return random_.of({"1/3", "0.7", "2", "5/4", "1", "sqrt(2)", "0.1 + 1/7", "pi/4"});
  }
  std::string number() {
    if (!parameters_.empty() && random_.one_in(3)) return parameters_[pick(parameters_)];
    return random_.of({"2", "1/2", "0.3", "1/3", "3", "1.25", "1"});
  }
  std::size_t pick(const std::vector<std::string>& from) {
    return static_cast<std::size_t>(random_.below(static_cast<int>(from.size())));
  }
  std::vector<std::string> both() {
    std::vector<std::string> result = q_;
    result.insert(result.end(), p_.begin(), p_.end());
    return result;
  }

  // T: of every momentum, so that all of them move.
  std::string kinetic() {
    std::string t =
        n_ > 0 ? fmt::format("sum(i = 1..N, y[i]^2/{})", masses_ ? "(2*m[i])" : "2") : "p1^2/2";
    for (std::size_t i = 1; n_ == 0 && i < p_.size(); ++i) t += fmt::format(" + {}^2/2", p_[i]);
    return random_.one_in(4) ? t + " + " + smooth(p_, 2) : t;
  }

  std::string potential() {
    std::string v = fmt::format("{}*{}", number(), smooth(q_, 3));
    if (n_ > 0) {
      v += fmt::format(" + sum(i = {}..N, {})", random_.of({"0", "1"}),
                       random_.of({"(x[i+1] - x[i])^2/2", "(x[i+1] - x[i])^4/8",
                                   "cos(x[i+1] - x[i])", "exp(-(x[i+1] - x[i])^2)*i/4"}));
      if (n_ < 6 && random_.one_in(2)) {
        v += " + sum(i = 1..N, j = i+1..N, 1/(1 + (x[i] - x[j])^2))/4";
      }
    }
    for (std::size_t i = 0; n_ == 0 && i < q_.size(); ++i) {
      v += fmt::format(" + {}*{}^2/2", number(), q_[i]);
    }
    if (!definition_.empty()) v += " - " + definition_ + "^2/8";
    if (times_) v += fmt::format(" + sin(2*t)*{}/5", q_.front());
    return v;
  }

  std::string coupling() { return number() + "*" + smooth(both(), 3) + "/2"; }

  // Bounded in size and slope for arguments of order 1, and defined for all.
  std::string smooth(const std::vector<std::string>& of, int depth) {
    if (depth <= 0) return of[pick(of)];
    const std::string u = smooth(of, depth - 1);
    const std::string v = of[pick(of)];
    switch (random_.below(26)) {
      case 24:
        return fmt::format("expm1(sin({}))", u);
      case 25:
        return fmt::format("log1p(({})^2)", u);
      case 0:
        return fmt::format("sin({})", u);
      case 1:
        return fmt::format("cos({} + {})", u, number());
      case 2:
        return fmt::format("exp(-({})^2/4)", u);
      case 3:
        return fmt::format("tanh({})", u);
      case 4:
        return fmt::format("atan({})", u);
      case 5:
        return fmt::format("asinh({}*{})", number(), u);
      case 6:
        return fmt::format("sqrt(1 + ({})^2)", u);
      case 7:
        return fmt::format("log(2 + ({})^2)", u);
      case 8:
        return fmt::format("1/(1 + ({})^2)", u);
      case 9:
        return fmt::format("({})/(3 + {}^2)", u, v);
      case 10:
        return fmt::format("asin(sin({})/2)", u);
      case 11:
        return fmt::format("acos(cos({})/3)", u);
      case 12:
        return fmt::format("atanh(tanh({})/2)", u);
      case 13:
        return fmt::format("acosh(2 + sin({}))", u);
      case 14:
        return fmt::format("tan(sin({})/2)", u);
      case 15:
        return fmt::format("sinh(cos({}))", u);
      case 16:
        return fmt::format("cosh(sin({}))", u);
      case 17:
        return fmt::format("atan2({}, 2 + {}^2)", u, v);
      case 18:
        return fmt::format("(2 + sin({}))^({})", u, random_.of({"3/2", "-1/2", "-3", "1/3", "2"}));
      case 19:
        return fmt::format("(2 + cos({}))^sin({})", u, v);
      case 20:
        return fmt::format("abs(2 + sin({}))", u);
      case 21:
        return fmt::format("sin({})*{}", v, "(" + u + ")");
      case 22:
        return fmt::format("(sin({})^3 - cos({})/{})", u, v, "3");
      default:
        return fmt::format("sum(k{0} = 1..3, cos(k{0}*({1}))/k{0}^2)", depth, u);
    }
  }

  void scene() {
    text_ += "scene start {\n";
    if (n_ > 0) {
      text_ += "  x[i] = sin(i)/3\n  y[i] = cos(2*i)/4\n";
    } else {
      for (const auto* variables : {&q_, &p_}) {
        for (const std::string& each : *variables) {
          text_ += fmt::format("  {} = {}\n", each,
                               random_.of({"1/3", "-0.45", "0.8", "sqrt(2)/3", "-0.2", "0.61"}));
        }
      }
    }
    if (!parameters_.empty() && random_.one_in(2)) {
      text_ += fmt::format("  {} = {}\n", parameters_.front(), positive());
    }
    text_ += fmt::format("  h = {}\n  steps = 20\n}}\n", random_.of({"1/64", "0.02", "-0.01"}));
  }

  Request request(bool separable) {
    if (separable && random_.one_in(3)) {
      return {.scheme = random_.of({"stormer-verlet", "position-verlet", "saba-2", "ruth-3",
                                    "forest-ruth-4", "blanes-moan-4"})};
    }
    switch (random_.below(8)) {
      case 0:
        return {.solver = "fixed-point"};
      case 1:
        return {.alpha = random_.of({"1/3", "0.3", "3/4"}),
                .beta = random_.of({"0", "1/5", "0.1"}),
                .gamma = random_.of({"0", "-1/10", "0.2"})};
      case 2:
        return {.scheme = random_.of({"symplectic-euler-a", "symplectic-euler-b"})};
      case 3:
        return {.scheme = random_.of({"gauss-4", "gauss-6"})};
      case 4:
        return {.scheme = random_.of({"rk4", "explicit-euler"})};
      case 5:
        return {.scheme = random_.of({"yoshida-4", "suzuki-4"})};
      default:
        return {};
    }
  }

  fuzz::Random random_;
  std::string text_, definition_;
  std::vector<std::string> q_, p_, parameters_;
  int n_ = 0;
  bool times_ = false, masses_ = false;
};

}  // namespace

RandomCase random_case(std::uint64_t seed) { return Writer(seed).run(); }

}  // namespace hamgen::random
