// Derivatives of GiNaC's expressions: what GiNaC's own `diff` gives, with every subexpression
// differentiated once and what does not depend on the symbol passed over.  Counted, see budget.hpp.
#pragma once

#include <ginac/ginac.h>

#include <cstddef>
#include <map>
#include <unordered_map>
#include <vector>

#include "generator/algebra/ginac_parts.hpp"

namespace hamgen {

class Differentiator {
 public:
  // de/ds, the expression that e.diff(s) returns.
  [[nodiscard]] GiNaC::ex operator()(const GiNaC::ex& e, const GiNaC::symbol& s);

 private:
  struct Known {
    std::vector<std::size_t> symbols = {};  // that it depends on, by number
    double depth = 0;
    double steps = 0;  // of work, to make it
    std::unordered_map<std::size_t, GiNaC::ex> derivatives = {};
    std::vector<GiNaC::ex> partials = {};  // of a function, by its arguments
    // Of a sum or a product: the operands that depend on a symbol.
    std::unordered_map<std::size_t, std::vector<std::size_t>> places = {};
  };

  [[nodiscard]] Known& known(const GiNaC::ex& e);
  [[nodiscard]] std::size_t number(const GiNaC::ex& symbol);
  [[nodiscard]] bool depends(const GiNaC::ex& e, const GiNaC::symbol& s);
  [[nodiscard]] std::vector<std::size_t> places(const GiNaC::ex& e, const GiNaC::symbol& s);
  [[nodiscard]] GiNaC::ex partial(const GiNaC::ex& e, std::size_t i);
  [[nodiscard]] GiNaC::ex of_sum(const GiNaC::ex& e, const GiNaC::symbol& s);
  [[nodiscard]] GiNaC::ex of_product(const GiNaC::ex& e, const GiNaC::symbol& s);
  [[nodiscard]] GiNaC::ex of_power(const GiNaC::ex& e, const GiNaC::symbol& s);
  [[nodiscard]] GiNaC::ex of_function(const GiNaC::ex& e, const GiNaC::symbol& s);

  std::map<GiNaC::ex, std::size_t, GiNaC::ex_is_less> numbers_;  // of symbols
  ByIdentity<Known> known_;
};

}  // namespace hamgen
