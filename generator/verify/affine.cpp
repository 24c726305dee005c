#include "generator/verify/affine.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace hamgen {

namespace {

// Of an expression as a polynomial in these symbols: 0, 1, or 2 for all that is no such polynomial.
class Degree {
 public:
  explicit Degree(const std::set<std::string>& symbols) : symbols_(symbols) {}

  int of(const Expression& e) {
    if (e.kind() == Kind::number) return 0;
    if (e.kind() == Kind::symbol) return symbols_.contains(e.name()) ? 1 : 0;
    if (const auto it = known_.find(e.identity()); it != known_.end()) return it->second;
    int largest = 0;
    int all = 0;
    for (const Expression& operand : e.operands()) {
      const int degree = of(operand);
      largest = std::max(largest, degree);
      all += degree;
    }
    const int degree = e.kind() == Kind::sum ? largest : e.kind() == Kind::product ? all : 2 * all;
    return known_[e.identity()] = std::min(degree, 2);
  }

 private:
  const std::set<std::string>& symbols_;
  std::map<const void*, int> known_;
};

}  // namespace

std::vector<std::string> affine_symbols(const Expression& e) {
  std::set<std::string> chosen;
  for (const std::string& name : symbols(e)) {
    if (name == "pi") continue;
    chosen.insert(name);
    if (Degree(chosen).of(e) > 1) chosen.erase(name);
  }
  return {chosen.begin(), chosen.end()};
}

std::vector<Expression> at_unit_points(const Expression& e,
                                       const std::vector<std::string>& affine) {
  Substitution point;
  for (const std::string& name : affine) point.emplace(name, Expression(0));
  std::vector<Expression> values{substitute(e, point)};
  for (const std::string& name : affine) {
    point[name] = Expression(1);
    values.push_back(substitute(e, point));
    point[name] = Expression(0);
  }
  return values;
}

}  // namespace hamgen
