// alpha, beta and gamma as a user writes them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "generator/algebra/evaluate.hpp"
#include "generator/language/model.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen {

// "1/2"; "a, b, c" or "[a, b, c]", one per degree of freedom; "[[a, b], [b, c]]", a matrix row by
// row.  Entries are expressions in h, E0 and the model's parameters.  `option` is "alpha", "beta"
// or "gamma".  Throws UsageError where the brackets make no matrix, ModelError for a wrong entry.
[[nodiscard]] GaugeBlock read_gauge_block(const Model& model, const std::string& option,
                                          const std::string& text);

// The member with all of C given, 2n x 2n, row by row, entries as above: "[[a, b], [c, -a]]".
[[nodiscard]] Scheme read_gauge_matrix(const Model& model, const std::string& text);

// The point at which a gauge is taken, by the names of variables and parameters: a variable that is
// not given is 0, a parameter has its default.  Throws as scene_values does.
[[nodiscard]] Values read_reference(const Model& model,
                                    const std::vector<std::pair<std::string, std::string>>& given);

}  // namespace hamgen
