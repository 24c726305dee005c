#include "generator/mechanics/energy_terms.hpp"

namespace hamgen {

namespace {

void split(const Model& model, const NodePtr& node, bool negative,
           std::vector<WrittenTerm>& terms) {
  if (const auto* binary = std::get_if<BinaryNode>(&node->value)) {
    const bool subtracts = binary->operation == BinaryOperator::subtract;
    if (subtracts || binary->operation == BinaryOperator::add) {
      split(model, binary->left, negative, terms);
      split(model, binary->right, negative != subtracts, terms);
      return;
    }
  }
  terms.push_back({node,
                   {.text = (negative ? "-" : "") + to_text(node),
                    .line = static_cast<int>(position(model.source, node->span.begin).line)}});
}

}  // namespace

std::vector<WrittenTerm> written_terms(const Model& model) {
  std::vector<WrittenTerm> terms;
  split(model, model.hamiltonian, false, terms);
  return terms;
}

std::set<int> terms_around(const std::vector<WrittenTerm>& terms, const Span& span) {
  std::set<int> all;
  for (int i = 0; i < static_cast<int>(terms.size()); ++i) {
    const Span& own = terms[static_cast<std::size_t>(i)].node->span;
    if (own.begin <= span.begin && span.end <= own.end) return {i};
    all.insert(i);
  }
  return all;
}

}  // namespace hamgen
