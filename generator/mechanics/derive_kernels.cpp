#include "generator/mechanics/derive_kernels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <list>
#include <set>

#include "generator/algebra/ginac_derivatives.hpp"
#include "generator/language/scene.hpp"
#include "generator/mechanics/collective_sums.hpp"
#include "generator/mechanics/energy_terms.hpp"
#include "generator/mechanics/mechanics.hpp"
#include "generator/mechanics/split_sums.hpp"
#include "generator/mechanics/to_ginac.hpp"

namespace hamgen {

namespace {

// At most this many instances at the boundaries of a sum are written out one by one, together where
// they have no more elements than this.
constexpr std::size_t kMostPeeled = 64;
constexpr std::size_t kMostTogether = 8;

using Indices = std::map<std::string, long>;

// Single instances that are written out together: of the same elements, or of none in common.
// Where they have some in common algebra would add what each of them has of these, and
// differences of neighbours would become sums that cancel.
struct Boundary {
  Boundary(const Model& model, const Touch& what) : converter(model, table), touch(what) {}
  SymbolTable table;
  TreeConverter converter;
  Touch touch;
  std::optional<std::size_t> sum = {};
  std::set<std::string> elements;
  std::set<std::set<std::string>> instances;
  std::set<int> terms;
  GiNaC::ex value;

  // An instance of these elements?
  [[nodiscard]] bool takes(const std::set<std::string>& used) const {
    if (instances.contains(used)) return true;
    const bool apart =
        std::ranges::none_of(used, [&](const auto& name) { return elements.contains(name); });
    return apart && elements.size() + used.size() <= kMostTogether;
  }
};

class KernelBuilder {
 public:
  explicit KernelBuilder(const Model& model) : model_(model), terms_(written_terms(model)) {
    long position = 0;
    for (const auto* group : {&model.coordinates, &model.momenta}) {
      for (const Variable& variable : *group) {
        variables_[variable.name] = {&variable, position};
        position += variable.range ? variable.range->size() : 1;
      }
    }
  }

  std::optional<KernelForm> build() {
    const std::optional<SplitSums> split = split_into_sums(model_, model_.hamiltonian);
    if (!split || !add_all(split->terms)) return std::nullopt;
    KernelForm form;
    if (!split->functions.empty()) {
      std::optional<CollectiveSums> collective = collective_sums(model_, split->functions);
      if (!collective) return std::nullopt;
      for (std::size_t k = 0; k < collective->terms.size(); ++k) {
        sum_ = k;
        if (!add_all(collective->terms[k])) return std::nullopt;
      }
      form.sums = std::move(collective->sums);
      form.of_sums = std::move(collective->value);
    }
    add_momentum_of_time();
    for (Boundary& boundary : boundaries_) {
      sum_ = boundary.sum;
      finish(boundary);
    }
    form.kernels = std::move(kernels_);
    return form;
  }

 private:
  bool add_all(const std::vector<SumTerm>& terms) {
    for (const SumTerm& term : terms) {
      if (add(term)) continue;
      // Together their boundaries may be too many.
      for (const Summand& summand : term.summands) {
        if (!add({term.ranges, term.touch, {summand}})) return false;
      }
    }
    return true;
  }

  static long value_at(const AffineIndex& a, const Indices& indices) {
    long value = a.constant;
    for (const auto& [index, factor] : a.factors) value += factor * indices.at(index);
    return value;
  }

  // H stands beside p_t, see hamiltonian() in derive.cpp.
  void add_momentum_of_time() {
    for (const Variable& momentum : model_.momenta) {
      if (!momentum.is_time) continue;
      boundaries_.emplace_back(model_, Touch{.momenta = true});
      boundaries_.back().value = boundaries_.back().table.symbol(momentum.name, kRankOfVariable);
    }
  }

  // Names of a term in a loop, with their subscripts as affine functions: 0 of scalars.
  struct Reference {
    const NameNode* name;
    AffineIndex subscript;
    const Variable* variable;  // null for a parameter
    const Parameter* parameter;

    [[nodiscard]] std::optional<IndexRange> range() const {
      if (!variable) return parameter->range;
      return variable->range ? variable->range : IndexRange{.first = 0, .last = 0};
    }
    [[nodiscard]] bool is_scalar() const { return !name->subscript; }
  };

  bool collect(const NodePtr& node, const std::vector<std::string>& indices,
               std::vector<Reference>& references, std::set<std::string>& lets) const {
    if (const auto* name = std::get_if<NameNode>(&node->value)) {
      if (!name->subscript) {
        const auto scalar = variables_.find(name->name);
        const bool is_index = std::ranges::find(indices, name->name) != indices.end();
        if (scalar != variables_.end() && !is_index)
          references.push_back({name, {}, scalar->second.first, nullptr});
        for (const Definition& definition : model_.definitions) {
          if (definition.name == name->name && lets.insert(name->name).second &&
              !collect(definition.value, indices, references, lets)) {
            return false;
          }
        }
        return true;
      }
      const auto subscript = affine(model_, name->subscript, indices);
      if (!subscript) return false;
      const auto it = variables_.find(name->name);
      const Variable* variable = it == variables_.end() ? nullptr : it->second.first;
      const auto parameter = std::ranges::find(model_.parameters, name->name, &Parameter::name);
      if (!variable && parameter != model_.parameters.end() && parameter->folded) return false;
      references.push_back(
          {name, *subscript, variable,
           variable || parameter == model_.parameters.end() ? nullptr : &*parameter});
      return true;
    }
    bool fine = true;
    for_children(node, [&](const NodePtr& child) {
      fine = fine && collect(child, indices, references, lets);
    });
    return fine;
  }

  [[nodiscard]] bool is_regular(const std::vector<Reference>& references,
                                const Indices& indices) const {
    return std::ranges::all_of(references, [&](const Reference& r) {
      const std::optional<IndexRange> range = r.range();
      const long i = value_at(r.subscript, indices);
      return range && i >= range->first && i <= range->last;
    });
  }

  bool add(const SumTerm& term) {
    std::vector<std::string> indices;
    for (const KernelRange& range : term.ranges) indices.push_back(range.index);
    std::vector<Reference> references;
    std::set<std::string> lets;
    for (const Summand& summand : term.summands) {
      if (!collect(summand.body, indices, references, lets)) return false;
      for (const auto& [factor, divides] : summand.factors) {
        if (!collect(factor, indices, references, lets)) return false;
      }
    }
    if (term.ranges.empty()) {
      instance(term, {});
      return true;
    }
    if (term.ranges.size() == 1) return add_single(term, term.ranges[0], references);
    // Several indices: boundaries are not peeled, every instance must be regular.
    if (!all_regular(term.ranges, 0, {}, references)) return false;
    regular(term, term.ranges, references);
    return true;
  }

  bool all_regular(const std::vector<KernelRange>& ranges, std::size_t depth, Indices indices,
                   const std::vector<Reference>& references) const {
    if (depth == 0 && stays_inside(ranges, references)) return true;
    if (depth == ranges.size()) return is_regular(references, indices);
    const long last = value_at(ranges[depth].upper, indices);
    for (long i = value_at(ranges[depth].lower, indices); i <= last; ++i) {
      indices[ranges[depth].index] = i;
      if (!all_regular(ranges, depth + 1, indices, references)) return false;
    }
    return true;
  }
  // Known without a look at every instance.
  static bool stays_inside(const std::vector<KernelRange>& ranges,
                           const std::vector<Reference>& references) {
    return std::ranges::all_of(references, [&](const Reference& r) {
      const std::optional<IndexRange> range = r.range();
      return range && least_value(r.subscript, ranges) >= range->first &&
             largest_value(r.subscript, ranges) <= range->last;
    });
  }

  // The longest run of regular instances becomes a loop, the others are written out.
  bool add_single(const SumTerm& term, const KernelRange& range,
                  const std::vector<Reference>& references) {
    const long lower = range.lower.constant;
    const long upper = range.upper.constant;
    long first = lower;
    long last = upper;
    for (const Reference& r : references) {
      const std::optional<IndexRange> inside = r.range();
      if (!inside) last = lower - 1;
      if (!inside) continue;
      const IndexInterval fits =
          indices_between(r.subscript, range.index, inside->first, inside->last);
      first = std::max(first, fits.first);
      last = std::min(last, fits.last);
    }
    if (last < first) last = first - 1;
    if (upper - lower - (last - first) > static_cast<long>(kMostPeeled)) return false;
    for (long i = lower; i <= upper; ++i) {
      if (i == first && first <= last) i = last + 1;
      if (i <= upper) instance(term, {{range.index, i}});
    }
    if (first <= last) {
      KernelRange inner{
          range.index, {.constant = first, .factors = {}}, {.constant = last, .factors = {}}};
      regular(term, {inner}, references);
    }
    return true;
  }
  static GiNaC::ex body(const SumTerm& term, TreeConverter& converter, const Indices& indices) {
    GiNaC::ex sum = 0;
    for (const Summand& summand : term.summands) {
      GiNaC::ex value = converter.convert_at(summand.body, indices);
      for (const auto& [factor, divides] : summand.factors) {
        const GiNaC::ex f = converter.convert_at(factor, indices);
        value = divides ? value / f : value * f;
      }
      sum += summand.negative ? GiNaC::ex(-value) : value;
    }
    return sum;
  }

  // One instance with concrete elements.
  void instance(const SumTerm& term, const Indices& indices) {
    SymbolTable table;
    TreeConverter converter(model_, table);
    const std::set<std::string> used = symbols(from_ginac(body(term, converter, indices), table));
    if (boundaries_.empty() || boundaries_.back().touch != term.touch ||
        boundaries_.back().sum != sum_ || !boundaries_.back().takes(used)) {
      boundaries_.emplace_back(model_, term.touch);
      boundaries_.back().sum = sum_;
    }
    Boundary& boundary = boundaries_.back();
    boundary.value += body(term, boundary.converter, indices);
    boundary.elements.insert(used.begin(), used.end());
    boundary.instances.insert(used);
    boundary.terms.merge(terms_of(term));
  }

  [[nodiscard]] std::set<int> terms_of(const SumTerm& term) const {
    std::set<int> result;
    for (const Summand& summand : term.summands) {
      result.merge(terms_around(terms_, summand.body->span));
    }
    return result;
  }

  // Those of the names that are elements of the variable, in its order, and their places in it.
  static std::vector<std::pair<std::string, long>> elements_among(
      const std::set<std::string>& names, const Variable& variable) {
    std::map<long, std::string> found;
    for (const std::string& name : names) {
      const std::size_t bracket = name.find('[');
      if (name.substr(0, bracket) != variable.name) continue;
      const long first = variable.range ? variable.range->first : 0;
      found[bracket == std::string::npos ? 0 : std::stol(name.substr(bracket + 1)) - first] = name;
    }
    std::vector<std::pair<std::string, long>> result;
    for (const auto& [behind, name] : found) result.emplace_back(name, behind);
    return result;
  }

  void finish(Boundary& boundary) {
    Kernel kernel{.value = from_ginac(boundary.value, boundary.table), .terms = boundary.terms};
    const std::set<std::string> names = symbols(kernel.value);
    for (const auto& [name, entry] : variables_) {
      const auto& [variable, position] = entry;
      for (const auto& [element, behind] : elements_among(names, *variable)) {
        kernel.slots.push_back({element,
                                {.constant = position + behind, .factors = {}},
                                position >= degrees_of_freedom(model_)});
      }
    }
    finish(std::move(kernel), boundary.value, boundary.table);
  }

  // The loop over regular instances.
  void regular(const SumTerm& term, const std::vector<KernelRange>& ranges,
               const std::vector<Reference>& references) {
    SymbolTable table;
    TreeConverter converter(model_, table);
    Kernel kernel{.ranges = ranges, .terms = terms_of(term)};
    int rank = kRankOfVariable;
    std::map<std::pair<std::string, long>, std::string> seen;
    converter.set_element([&](const NameNode& name) -> std::optional<GiNaC::ex> {
      const auto it = std::ranges::find(references, &name, &Reference::name);
      if (it == references.end()) return std::nullopt;
      const std::string symbol =
          it->is_scalar() ? name.name : name.name + "[" + subscript_text(it->subscript) + "]";
      AffineIndex position = it->subscript;
      position.constant -= it->range()->first;
      if (it->variable) position.constant += variables_.at(name.name).second;
      const bool known =
          std::ranges::find(kernel.slots, symbol, &Slot::symbol) != kernel.slots.end() ||
          std::ranges::find(kernel.parameters, symbol, &ParameterSlot::symbol) !=
              kernel.parameters.end();
      if (!known && it->variable) {
        const bool momentum = variables_.at(name.name).second >= degrees_of_freedom(model_);
        kernel.slots.push_back({symbol, position, momentum});
      }
      if (!known && !it->variable) kernel.parameters.push_back({symbol, name.name, position});
      return table.symbol(symbol, it->variable ? ++rank : kRankOfParameter);
    });
    for (const KernelRange& range : ranges) converter.set_symbolic_index(range.index);
    const GiNaC::ex value = body(term, converter, {});
    kernel.value = from_ginac(value, table);
    finish(std::move(kernel), value, table);
  }

  void finish(Kernel kernel, const GiNaC::ex& value, const SymbolTable& table) {
    std::set<std::string> slots;
    for (const Slot& slot : kernel.slots) slots.insert(slot.symbol);
    for (const std::string& symbol : symbols(kernel.value)) {
      const std::string base = symbol.substr(0, symbol.find('['));
      if (variables_.contains(base) && !slots.contains(symbol)) {
        internal_error("a variable of a kernel has no slot: " + symbol);
      }
    }
    Differentiator derivative;
    FromGinac expression(table);
    std::vector<GiNaC::ex> gradient;
    for (const Slot& slot : kernel.slots) {
      gradient.push_back(derivative(value, table.find(slot.symbol)));
      kernel.gradient.push_back(expression(gradient.back()));
    }
    for (std::size_t i = 0; i < kernel.slots.size(); ++i) {
      const std::set<std::string> present = symbols(kernel.gradient[i]);
      for (std::size_t j = i; j < kernel.slots.size(); ++j) {
        if (!present.contains(kernel.slots[j].symbol)) continue;
        const GiNaC::ex entry = derivative(gradient[i], table.find(kernel.slots[j].symbol));
        if (!entry.is_zero()) kernel.hessian.emplace(std::pair(i, j), expression(entry));
      }
    }
    kernel.sum = sum_;
    kernels_.push_back(std::move(kernel));
  }

  const Model& model_;
  std::map<std::string, std::pair<const Variable*, long>> variables_;
  std::vector<WrittenTerm> terms_;
  std::vector<Kernel> kernels_;
  std::list<Boundary> boundaries_;
  std::optional<std::size_t> sum_;  // that is added to
};

}  // namespace

std::optional<KernelForm> derive_kernels(const Model& model) {
  return KernelBuilder(model).build();
}

}  // namespace hamgen
