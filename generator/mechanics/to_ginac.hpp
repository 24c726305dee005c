// The user's checked tree as a GiNaC expression, sums written out.
#pragma once

#include <ginac/ginac.h>

#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "generator/algebra/from_ginac.hpp"
#include "generator/language/constant.hpp"
#include "generator/language/model.hpp"

namespace hamgen {

// What GiNaC says, "division by zero", without the name of its function, "power::eval(): ".
[[nodiscard]] std::string_view reason_of(const std::exception& error);

class TreeConverter {
 public:
  TreeConverter(const Model& model, SymbolTable& table);
  // Throws ModelError with the place of what is undefined, 1/(q - q), log(-1), and of what passes
  // the limits of budget.hpp.
  [[nodiscard]] GiNaC::ex convert(const NodePtr& node);

  using Indices = std::map<std::string, long>;
  [[nodiscard]] GiNaC::ex convert_at(const NodePtr& node, const Indices& indices) {
    return convert(node, indices);
  }
  // For loops that stay loops: what a name stands for there, and indices that stay symbols.
  using Element = std::function<std::optional<GiNaC::ex>(const NameNode&)>;
  void set_element(Element element) { element_ = std::move(element); }
  // What an indexed sum stands for, where it stays a loop.
  using Sum = std::function<std::optional<GiNaC::ex>(const SumNode&)>;
  void set_sum(Sum sum) { sum_ = std::move(sum); }
  void set_symbolic_index(const std::string& index) { symbolic_indices_.insert(index); }

 private:
  [[nodiscard]] GiNaC::ex convert(const NodePtr& node, const Indices& indices);
  [[nodiscard]] GiNaC::ex convert_name(const NameNode& name, const Span& span,
                                       const Indices& indices);
  [[nodiscard]] GiNaC::ex convert_binary(const Node& place, const BinaryNode& node,
                                         const Indices& indices);
  using ConstantFunction = std::function<Constant(std::span<const Rational>)>;
  void require_real(const Node& node, const GiNaC::exvector& operands,
                    const ConstantFunction& function) const;
  [[nodiscard]] GiNaC::ex convert_sum(const SumNode& node, std::size_t depth, Indices indices);
  [[nodiscard]] GiNaC::ex add_up(const SumNode& node, std::size_t depth, Indices& indices,
                                 long first, long last);
  [[nodiscard]] GiNaC::ex moderate(const Span& span, const GiNaC::ex& value) const;
  void require_moderate_power(const Node& place, const GiNaC::ex& base,
                              const GiNaC::ex& exponent) const;
  [[nodiscard]] GiNaC::ex element(const Variable& variable, long index, const Span& span);
  [[nodiscard]] long integer(const NodePtr& node, const Indices& indices) const;
  [[noreturn]] void fail(const Span& span, std::string message, std::string help = {}) const;

  const Model& model_;
  SymbolTable& table_;
  std::map<std::string, GiNaC::ex> definitions_;
  std::map<std::string, std::pair<const Variable*, int>> variables_;  // first rank
  std::map<std::string, std::pair<const Parameter*, int>> parameters_;
  std::map<std::string, Rational> folded_;
  Element element_;
  Sum sum_;
  std::set<std::string> symbolic_indices_;
};

// "q[3]" for an element of an array, "q" for a scalar.
[[nodiscard]] std::string element_name(const std::string& name, long index);

}  // namespace hamgen
