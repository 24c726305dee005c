#include "generator/schemes/read_gauge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "generator/base/diagnostic.hpp"
#include "generator/base/pieces.hpp"
#include "generator/language/read_model.hpp"
#include "generator/language/scene.hpp"
#include "generator/mechanics/derive.hpp"

namespace hamgen {

namespace {

class GaugeText {
 public:
  GaugeText(const Model& model, const std::string& option) : model_(model), option_(option) {
    names_ = {"h", "E0"};
    for (const std::string& name : element_names(model.parameters)) names_.push_back(name);
  }

  // `size` is the number of rows and of columns of a matrix.
  GaugeBlock read(const std::string& text, std::size_t size) const {
    const std::string_view outer = without_blanks(text);
    GaugeBlock block;
    if (!outer.starts_with('[')) {
      for (const std::string_view piece : outermost_pieces(outer)) add_entry(piece, block);
      return block;
    }
    const std::vector<std::string_view> rows = outermost_pieces(inside(outer));
    block.is_matrix = rows[0].starts_with('[');
    if (block.is_matrix && rows.size() != size) refuse(rows.size(), "rows", size);
    for (const std::string_view row : rows) {
      if (!block.is_matrix) {
        add_entry(row, block);
        continue;
      }
      const std::vector<std::string_view> entries = outermost_pieces(inside(row));
      if (entries.size() != size) refuse(entries.size(), "entries in a row", size);
      for (const std::string_view piece : entries) add_entry(piece, block);
    }
    return block;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    const std::string form =
        option_ == "gauge"
            ? "locally-exact, or the matrix C row by row: --gauge '[[a, b], [c, -a]]'"
            : fmt::format(
                  "a number, a list a,b with one entry per degree of freedom, or a matrix "
                  "row by row: --{} '[[a, b], [b, c]]'",
                  option_);
    throw UsageError(fmt::format("--{}: {}\nhelp: write {}", option_, what, form));
  }

  [[noreturn]] void refuse(std::size_t count, const char* what, std::size_t wanted) const {
    if (option_ == "gauge")
      fail(fmt::format("the matrix has {0} {1}, but C is {2} x {2}", count, what, wanted));
    fail(fmt::format("the matrix has {} {}, but there are {} degrees of freedom", count, what,
                     wanted));
  }

  // What stands between the brackets that enclose the text.
  [[nodiscard]] std::string_view inside(std::string_view text) const {
    if (!text.starts_with('[') || !text.ends_with(']')) {
      fail(fmt::format("'{}' is not a list in brackets", text));
    }
    return text.substr(1, text.size() - 2);
  }

  void add_entry(std::string_view text, GaugeBlock& block) const {
    const NodePtr node = read_expression("--" + option_, std::string(text), names_);
    block.entries.push_back(scheme_parameter(model_, option_, node));
    block.words.push_back(to_text(node));
  }

  const Model& model_;
  const std::string& option_;
  std::vector<std::string> names_;
};

}  // namespace

GaugeBlock read_gauge_block(const Model& model, const std::string& option,
                            const std::string& text) {
  return GaugeText(model, option).read(text, static_cast<std::size_t>(degrees_of_freedom(model)));
}

Scheme read_gauge_matrix(const Model& model, const std::string& text) {
  const auto size = 2 * static_cast<std::size_t>(degrees_of_freedom(model));
  const std::string option = "gauge";
  const GaugeBlock block = GaugeText(model, option).read(text, size);
  if (!block.is_matrix) throw UsageError("--gauge: C has rows\nhelp: write '[[a, b], [c, -a]]'");
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
