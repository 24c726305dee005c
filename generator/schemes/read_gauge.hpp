// alpha, beta and gamma as a user writes them.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "generator/algebra/evaluate.hpp"
#include "generator/base/asked.hpp"
#include "generator/language/ast.hpp"
#include "generator/language/model.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen {

// "1/2"; "a, b, c" or "[a, b, c]", one per degree of freedom; "[[a, b], [b, c]]", a matrix row by
// row.  Entries are expressions in h, E0 and the model's parameters.
struct GaugeFormula {
  struct Entry {
    std::string text;
    NodePtr node;
  };
  std::string option;  // "alpha", "beta", "gamma" or "gauge"
  bool is_matrix = false;
  std::vector<std::vector<Entry>> rows = {};  // one, of one entry or one each, if it is no matrix

  // `option` is for what is said.  Throws UsageError where the brackets make no matrix, ModelError
  // for an entry that is no expression.
  [[nodiscard]] static GaugeFormula read(const std::string& option, const std::string& text);
  // Is there one value for all degrees of freedom?
  [[nodiscard]] bool is_uniform() const {
    return rows.empty() || (!is_matrix && rows[0].size() == 1);
  }
  // What its entries name.
  [[nodiscard]] std::set<std::string> names() const;
};

struct AlphaFormula : GaugeFormula {
  [[nodiscard]] static AlphaFormula read(const std::string& text);  // "" is 1/2
};
struct BetaFormula : GaugeFormula {
  [[nodiscard]] static BetaFormula read(const std::string& text);  // "" is 0
};
struct GammaFormula : GaugeFormula {
  [[nodiscard]] static GammaFormula read(const std::string& text);  // "" is 0
};

// All of C, 2n x 2n, row by row, "[[a, b], [c, -a]]", or that which a point decides.
struct GaugeWish {
  bool locally_exact = false;
  std::optional<GaugeFormula> matrix = {};
  [[nodiscard]] static GaugeWish read(const std::string& text);
};

// The values of a formula for a model.  Throws UsageError for a wrong number of entries, ModelError
// for names that the model has not.
[[nodiscard]] GaugeBlock gauge_block(const Model& model, const GaugeFormula& formula);
// The member with all of C given.
[[nodiscard]] Scheme gauge_member(const Model& model, const GaugeFormula& matrix);

// The point at which a gauge is taken, by the names of variables and parameters: a variable that is
// not given is 0, a parameter has its default.  Throws as scene_values does.
[[nodiscard]] Values read_reference(const Model& model,
                                    const std::vector<std::pair<std::string, std::string>>& given);

}  // namespace hamgen
