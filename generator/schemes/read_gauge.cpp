#include "generator/schemes/read_gauge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "generator/base/diagnostic.hpp"
#include "generator/base/pieces.hpp"
#include "generator/language/check_names.hpp"
#include "generator/language/read_model.hpp"
#include "generator/language/scene.hpp"
#include "generator/mechanics/derive.hpp"

namespace hamgen {

namespace {

[[noreturn]] void fail(const std::string& option, const std::string& what) {
  const std::string form =
      option == "gauge"
          ? "locally-exact, or the matrix C row by row: --gauge '[[a, b], [c, -a]]'"
          : fmt::format(
                "a number, a list a,b with one entry per degree of freedom, or a matrix "
                "row by row: --{} '[[a, b], [b, c]]'",
                option);
  throw UsageError(fmt::format("--{}: {}\nhelp: write {}", option, what, form));
}

// Counts are those of a matrix.
void require_count(const GaugeFormula& formula, std::size_t count, const char* what,
                   std::size_t wanted) {
  if (count == wanted) return;
  if (formula.option == "gauge")
    fail(formula.option,
         fmt::format("the matrix has {0} {1}, but C is {2} x {2}", count, what, wanted));
  fail(formula.option, fmt::format("the matrix has {} {}, but there are {} degrees of freedom",
                                   count, what, wanted));
}

// What stands between the brackets that enclose the text.
std::string_view inside(const std::string& option, std::string_view text) {
  if (!text.starts_with('[') || !text.ends_with(']'))
    fail(option, fmt::format("'{}' is not a list in brackets", text));
  return text.substr(1, text.size() - 2);
}

std::vector<GaugeFormula::Entry> read_entries(const std::string& option, std::string_view list) {
  std::vector<GaugeFormula::Entry> entries;
  for (const std::string_view piece : outermost_pieces(list)) {
    const std::string text(piece);
    entries.push_back({text, read_grammar("--" + option, text)});
  }
  return entries;
}

// `size` is the number of rows and of columns of a matrix.
GaugeBlock read_values(const Model& model, const GaugeFormula& formula, std::size_t size) {
  std::vector<std::string> names = {"h", "E0"};
  for (const std::string& name : element_names(model.parameters)) names.push_back(name);
  GaugeBlock block{.is_matrix = formula.is_matrix};
  if (formula.is_matrix) require_count(formula, formula.rows.size(), "rows", size);
  for (const auto& row : formula.rows) {
    if (formula.is_matrix) require_count(formula, row.size(), "entries in a row", size);
    for (const GaugeFormula::Entry& entry : row) {
      require_names(entry.node, "--" + formula.option, entry.text, names);
      try {
        block.entries.push_back(scheme_parameter(model, formula.option, entry.node));
      } catch (const ModelError& error) {  // its place is in the option's text
        throw ModelError(error.diagnostics(), make_source("--" + formula.option, entry.text));
      }
      block.words.push_back(to_text(entry.node));
    }
  }
  return block;
}

}  // namespace

GaugeFormula GaugeFormula::read(const std::string& option, const std::string& text) {
  GaugeFormula formula{.option = option};
  const std::string_view outer = without_blanks(text);
  if (!outer.starts_with('[')) {
    formula.rows.push_back(read_entries(option, outer));
    return formula;
  }
  const std::string_view list = inside(option, outer);
  const std::vector<std::string_view> rows = outermost_pieces(list);
  formula.is_matrix = rows[0].starts_with('[');
  if (!formula.is_matrix) {
    formula.rows.push_back(read_entries(option, list));
    return formula;
  }
  for (const std::string_view row : rows)
    formula.rows.push_back(read_entries(option, inside(option, row)));
  return formula;
}

std::set<std::string> GaugeFormula::names() const {
  std::set<std::string> names;
  for (const auto& row : rows) {
    for (const Entry& entry : row) names.merge(names_in(entry.node));
  }
  return names;
}

AlphaFormula AlphaFormula::read(const std::string& text) {
  return {GaugeFormula::read("alpha", text.empty() ? "1/2" : text)};
}

BetaFormula BetaFormula::read(const std::string& text) {
  return {GaugeFormula::read("beta", text.empty() ? "0" : text)};
}

GammaFormula GammaFormula::read(const std::string& text) {
  return {GaugeFormula::read("gamma", text.empty() ? "0" : text)};
}

GaugeWish GaugeWish::read(const std::string& text) {
  if (text.empty()) return {};
  if (text == "locally-exact") return {.locally_exact = true};
  if (!text.starts_with('[')) {
    throw UsageError(
        fmt::format("unknown gauge '{}'; there is locally-exact, and a matrix C is written "
                    "'[[a, b], [c, -a]]'",
                    text));
  }
  GaugeWish wish{.matrix = GaugeFormula::read("gauge", text)};
  if (!wish.matrix->is_matrix)
    throw UsageError("--gauge: C has rows\nhelp: write '[[a, b], [c, -a]]'");
  return wish;
}

GaugeBlock gauge_block(const Model& model, const GaugeFormula& formula) {
  return read_values(model, formula, static_cast<std::size_t>(degrees_of_freedom(model)));
}

Scheme gauge_member(const Model& model, const GaugeFormula& matrix) {
  const auto size = 2 * static_cast<std::size_t>(degrees_of_freedom(model));
  const GaugeBlock block = read_values(model, matrix, size);
  SparseMatrix c;
  for (std::size_t k = 0; k < block.entries.size(); ++k)
    c[{static_cast<int>(k / size), static_cast<int>(k % size)}] = block.entries[k];
  Scheme scheme = member_of_matrix(static_cast<int>(degrees_of_freedom(model)), std::move(c));
  scheme.description = "C = " + to_text(block, size);
  return scheme;
}

Values read_reference(const Model& model,
                      const std::vector<std::pair<std::string, std::string>>& given) {
  Model without_scenes = model;
  without_scenes.scenes.clear();
  const SceneValues values = scene_values(without_scenes, {.reference = given});
  Values result;
  const auto add = [&](const std::vector<std::string>& names,
                       const std::vector<Rational>& numbers) {
    for (std::size_t i = 0; i < names.size(); ++i) result[names[i]] = numbers[i];
  };
  add(element_names(model.coordinates), values.q);
  add(element_names(model.momenta), values.p);
  add(element_names(model.parameters), values.parameters);
  return result;
}

}  // namespace hamgen
