// Runge-Kutta tableaus: symplectic, symmetric, and their order by rooted trees.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "generator/verify/precise.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen {

namespace {

// Coefficients have at least 40 digits.
constexpr double kTableauDigits = 1e-34;

struct Numbers {
  std::vector<std::vector<Precise>> a;
  std::vector<Precise> b, c;
  bool exact = true;  // all entries are rational and short: the comparisons are of exact numbers
};

Precise number_of(const Expression& e) {
  const Substitution none;
  return *PreciseValues({}, none)(e);
}

double size_of_precise(const Precise& x) { return to_double(cln::abs(x)); }

bool is_short(const Expression& e) {
  return e.is_number() && mpz_sizeinbase(e.number().get_den_mpz_t(), 2) <= 40;
}

Numbers numbers_of(const RungeKutta& tableau) {
  Numbers numbers;
  for (std::size_t i = 0; i < tableau.b.size(); ++i) {
    auto& row = numbers.a.emplace_back();
    Precise sum = precise(0);
    for (const Expression& e : tableau.a[i]) {
      row.push_back(number_of(e));
      sum = sum + row.back();
      numbers.exact = numbers.exact && is_short(e);
    }
    numbers.b.push_back(number_of(tableau.b[i]));
    numbers.exact = numbers.exact && is_short(tableau.b[i]);
    numbers.c.push_back(sum);
  }
  return numbers;
}

// A rooted tree by the trees at its root, in their order of making.
struct Tree {
  std::vector<std::size_t> children;  // indices into the list, descending
  int order = 1;
  Rational gamma = 1;  // density: the product of the orders of all subtrees
  std::string text;
};

// All rooted trees up to an order, by order: 1, 1, 2, 4, 9, 20, 48.
std::vector<Tree> trees_up_to(int order) {
  std::vector<Tree> trees{{.text = "f"}};
  for (int now = 2; now <= order; ++now) {
    const std::size_t known = trees.size();
    auto extend = [&](auto&& self, Tree tree, int left, std::size_t most) -> void {
      if (left == 0) {
        tree.order = now;
        tree.gamma = now;
        std::string inside;
        for (const std::size_t child : tree.children) {
          tree.gamma *= trees[child].gamma;
          inside += (inside.empty() ? "" : ",") + trees[child].text;
        }
        tree.text = "f" + std::string(tree.children.size(), '\'') + "(" + inside + ")";
        trees.push_back(std::move(tree));
        return;
      }
      for (std::size_t child = std::min(most + 1, known); child-- > 0;) {
        if (trees[child].order > left) continue;
        Tree next = tree;
        next.children.push_back(child);
        self(self, next, left - trees[child].order, child);
      }
    };
    extend(extend, Tree{}, now - 1, known - 1);
  }
  return trees;
}

// sum_i b_i phi_i(t) gamma(t) - 1 of every tree.
std::vector<Precise> defects(const Numbers& tableau, const std::vector<Tree>& trees) {
  const std::size_t s = tableau.b.size();
  std::vector<std::vector<Precise>> inner;  // phi_i(t) = product over children of (A phi(child))_i
  std::vector<Precise> result;
  for (const Tree& tree : trees) {
    std::vector<Precise> phi(s, precise(1));
    for (const std::size_t child : tree.children) {
      for (std::size_t i = 0; i < s; ++i) {
        Precise sum = precise(0);
        for (std::size_t j = 0; j < s; ++j) sum = sum + tableau.a[i][j] * inner[child][j];
        phi[i] = phi[i] * sum;
      }
    }
    Precise total = precise(0);
    for (std::size_t i = 0; i < s; ++i) total = total + tableau.b[i] * phi[i];
    result.push_back(total * precise(tree.gamma) - precise(1));
    inner.push_back(std::move(phi));
  }
  return result;
}

Precise power_of_node(const Precise& c, int k) {
  Precise result = precise(1);
  for (int i = 0; i < k; ++i) result = result * c;
  return result;
}

// sum_i b_i c_i^(k-1) - 1/k.
Precise quadrature_defect(const Numbers& t, int k) {
  Precise sum = -(precise(1) / precise(k));
  for (std::size_t i = 0; i < t.b.size(); ++i) sum = sum + t.b[i] * power_of_node(t.c[i], k - 1);
  return sum;
}

// The shifted Legendre polynomial: coefficients of 1, x, x^2, ...
std::vector<Rational> legendre_polynomial(int s) {
  std::vector<Rational> p;
  auto binomial = [](int n, int k) {
    Integer value;
    mpz_bin_uiui(value.get_mpz_t(), static_cast<unsigned long>(n), static_cast<unsigned long>(k));
    return Rational(value);
  };
  for (int k = 0; k <= s; ++k) {
    p.push_back(binomial(s, k) * binomial(s + k, k) * ((s + k) % 2 == 0 ? 1 : -1));
  }
  return p;
}

Rational value_of(const std::vector<Rational>& polynomial, const Rational& x) {
  Rational value = 0;
  for (std::size_t k = polynomial.size(); k-- > 0;) value = value * x + polynomial[k];
  return value;
}

// Is the tableau collocation at the zeros of the shifted Legendre polynomial, with 34 digits of its
// irrational coefficients?  In exact rationals: P_s is orthogonal to all lower powers, it changes
// its sign within 1e-34 of each node, and B(s) and C(s) hold up to 1e-34.
bool is_gauss(const RungeKutta& tableau) {
  const int s = static_cast<int>(tableau.b.size());
  const std::vector<Rational> p = legendre_polynomial(s);
  const Rational digits = *parse_decimal("1e-34");
  const auto power = [](const Rational& x, int k) { return *hamgen::integer_power(x, k); };
  for (int k = 0; k < s; ++k) {
    Rational integral = 0;  // of P_s(x) x^k from 0 to 1
    for (int j = 0; j <= s; ++j) integral += p[static_cast<std::size_t>(j)] / (j + k + 1);
    if (integral != 0) return false;
  }
  std::vector<std::vector<Rational>> rows;
  std::vector<Rational> nodes;
  for (const auto& row : tableau.a) {
    auto& numbers = rows.emplace_back();
    for (const Expression& e : row) numbers.push_back(numeric_value(e));
    nodes.push_back(std::accumulate(numbers.begin(), numbers.end(), Rational(0)));
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (value_of(p, nodes[i] - digits) * value_of(p, nodes[i] + digits) >= 0) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (abs(nodes[i] - nodes[j]) < Rational(1, 1000)) return false;
    }
    // C(s): sum_j a_ij c_j^(k-1) = c_i^k / k.
    for (int k = 1; k <= s; ++k) {
      Rational sum = -power(nodes[i], k) / k;
      for (std::size_t j = 0; j < nodes.size(); ++j) sum += rows[i][j] * power(nodes[j], k - 1);
      if (abs(sum) > digits) return false;
    }
  }
  // B(s): sum_i b_i c_i^(k-1) = 1/k.
  for (int k = 1; k <= s; ++k) {
    Rational sum = Rational(-1, k);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      sum += numeric_value(tableau.b[i]) * power(nodes[i], k - 1);
    if (abs(sum) > digits) return false;
  }
  return true;
}

// What `proved` means where coefficients are irrational.
constexpr const char* kDigitsOfNodes =
    "the coefficients give it to 34 digits (signs of `P_s` in exact rationals)";

Finding symplectic_tableau(const Numbers& t, bool gauss) {
  for (std::size_t i = 0; i < t.b.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const Precise witness = t.b[i] * t.a[i][j] + t.b[j] * t.a[j][i] - t.b[i] * t.b[j];
      if (size_of_precise(witness) <= kTableauDigits) continue;
      return {"symplectic", Verdict::refuted,
              fmt::format("`b_i a_ij + b_j a_ji - b_i b_j` is `{:.6g}` for `i = {}`, `j = {}`",
                          to_double(witness), i + 1, j + 1)};
    }
  }
  if (gauss) {
    // m_ij = b_i a_ij + b_j a_ji - b_i b_j: sum_ij c_i^(k-1) m_ij c_j^(l-1) = (1/(k+l)) (1/k + 1/l)
    // - 1/(k l) = 0 for k, l <= s by B(2s) and C(s), and the Vandermonde matrix is regular.
    return {"symplectic", Verdict::proved,
            fmt::format(
                "collocation at the zeros of the shifted Legendre polynomial `P_s`: the "
                "integrals of `P_s x^k` vanish exactly for `k < s`, and `B(2s)` and `C(s)` give "
                "`b_i a_ij + b_j a_ji = b_i b_j`; {}; for exactly solved stages",
                kDigitsOfNodes)};
  }
  return {"symplectic", t.exact ? Verdict::proved : Verdict::tested,
          t.exact ? "`b_i a_ij + b_j a_ji = b_i b_j`; for exactly solved stages"
                  : "`b_i a_ij + b_j a_ji = b_i b_j` to `1e-34`; for exactly solved stages"};
}

Finding symmetric_tableau(const Numbers& t, bool gauss) {
  const std::size_t s = t.b.size();
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < s; ++j) {
      const Precise witness = t.a[s - 1 - i][s - 1 - j] + t.a[i][j] - t.b[j];
      if (size_of_precise(witness) <= kTableauDigits) continue;
      return {"symmetric", Verdict::refuted,
              fmt::format("`a_(s+1-i)(s+1-j) + a_ij - b_j` is `{:.6g}` for `i = {}`, `j = {}`",
                          to_double(witness), i + 1, j + 1)};
    }
  }
  return {"symmetric", t.exact || gauss ? Verdict::proved : Verdict::tested,
          gauss ? "collocation at nodes symmetric about 1/2"
                : "`a_(s+1-i)(s+1-j) + a_ij = b_j`: the step is its own adjoint"};
}

Finding order_of_gauss(const Numbers& t) {
  const int s = static_cast<int>(t.b.size());
  return {
      fmt::format("order {}", 2 * s), Verdict::proved,
      fmt::format(
          "`B({0})`, `C({1})` and `D({1})` of collocation at the zeros of `P_{1}`; {4}; leading "
          "error `h^{2} {3:.4g} f^({0})(f,...,f)/{0}! + ...`, `f = J grad H`",
          2 * s, s, 2 * s + 1, to_double(quadrature_defect(t, 2 * s + 1)), kDigitsOfNodes)};
}

// The trees of an order and their conditions; more than order 7 is never asked for.
Finding order_by_trees(const Numbers& t, int claimed) {
  const std::vector<Tree> trees = trees_up_to(std::min(claimed, 6) + 1);
  const std::vector<Precise> defect = defects(t, trees);
  for (std::size_t k = 0; k < trees.size(); ++k) {
    if (size_of_precise(defect[k]) <= kTableauDigits) continue;
    return {fmt::format("order {}", trees[k].order - 1),
            t.exact ? Verdict::proved : Verdict::tested,
            fmt::format("{} order condition{} before; leading error: the tree `{}` with relative "
                        "error `{:.4g}`, `f = J grad H`",
                        k == 1 ? "the one" : fmt::format("all {}", k), k == 1 ? "" : "s",
                        trees[k].text, to_double(defect[k]))};
  }
  return {fmt::format("order {} at least", trees.back().order),
          t.exact ? Verdict::proved : Verdict::tested,
          fmt::format("all {} order conditions", trees.size())};
}

}  // namespace

Proof prove_tableau(const RungeKutta& tableau, int order) {
  const Numbers numbers = numbers_of(tableau);
  const bool gauss = is_gauss(tableau);
  return {symplectic_tableau(numbers, gauss), symmetric_tableau(numbers, gauss),
          gauss ? order_of_gauss(numbers) : order_by_trees(numbers, order)};
}

}  // namespace hamgen
