// docs/schemes.md lists the schemes that there are.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "generator/schemes/all_schemes.hpp"

namespace hamgen {
namespace {

// The row of a table that names the scheme in its first cell; empty if there is none.
std::string row_of_scheme(const std::string& name) {
  std::ifstream page(HAMGEN_SOURCE_DIR "/docs/schemes.md");
  for (std::string line; std::getline(page, line);) {
    const auto at = line.find("`" + name + "`");
    if (line.starts_with("| ") && at < line.find(" | ")) return line;
  }
  return "";
}

// The cell of a row, from 0.
std::string cell_of(const std::string& row, int number) {
  std::size_t begin = 2;
  for (; number > 0; --number) begin = row.find(" | ", begin) + 3;
  return row.substr(begin, row.find(" |", begin) - begin);
}

TEST(SchemesPage, HasEverySchemeWithItsOrder) {
  for (const Scheme& scheme : all_schemes()) {
    const std::string& name = scheme.name;
    if (std::holds_alternative<RungeKutta>(scheme.method)) continue;  // in sentences
    const bool has_suffix = name.ends_with("-verlet") && name.find('-') != name.rfind('-');
    const std::string row = row_of_scheme(has_suffix ? name.substr(0, name.rfind('-')) : name);
    ASSERT_NE(row, "") << name;
    const std::string order = cell_of(row, scheme.is_member() ? 2 : 1);
    EXPECT_EQ(std::to_string(scheme.order), order.substr(0, order.find(','))) << row;
    const auto* splitting = std::get_if<Splitting>(&scheme.method);
    if (splitting != nullptr && !has_suffix) {
      EXPECT_EQ(cell_of(row, 2), splitting->kick_first ? "kick" : "drift") << row;
    }
    if (const auto* composition = std::get_if<Composition>(&scheme.method)) {
      EXPECT_EQ(cell_of(row, 2), std::to_string(composition->substeps.size())) << row;
    }
    // The author and the year, which the list and the page write alike.
    const std::string source = scheme.source.substr(0, scheme.source.find_first_of(",;"));
    EXPECT_NE(row.find(source.starts_with("Jimenez") ? "the paper" : source), std::string::npos)
        << row << ": " << scheme.source;
  }
}

}  // namespace
}  // namespace hamgen
