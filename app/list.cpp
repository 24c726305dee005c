// hamgen list: the names that models and options can use.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/command_line.hpp"
#include "app/output/json_document.hpp"
#include "app/output/terminal.hpp"
#include "generator/algebra/functions.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/formats/all_formats.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "generator/solvers/all_solvers.hpp"

namespace hamgen::app {
namespace {

using Json = nlohmann::ordered_json;

// Each table is an array of objects: printed as it is with --json, otherwise in columns.
Json functions() {
  Json rows = Json::array();
  for (const Function& function : all_functions())
    rows.push_back({{"name", function.name},
                    {"arguments", function.arity},
                    {"domain", function.domain},
                    {"description", function.description}});
  return rows;
}

Json schemes() {
  Json rows = Json::array();
  const auto add = [&rows](const Scheme& scheme) {
    rows.push_back({{"name", scheme.name},
                    {"order", scheme.order},
                    {"symmetric", scheme.symmetric},
                    {"needs", scheme.needs},
                    {"description", scheme.description},
                    {"source", scheme.source}});
  };
  std::ranges::for_each(all_schemes(), add);
  std::ranges::for_each(members_by_option(), add);
  return rows;
}

Json solvers() {
  Json rows = Json::array();
  for (const NamedSolver& solver : all_solvers())
    rows.push_back({{"name", solver.name}, {"description", solver.description}});
  return rows;
}

Json formats() {
  Json rows = Json::array();
  for (const NamedFormat& format : all_formats())
    rows.push_back({{"name", format.name}, {"description", format.description}});
  return rows;
}

struct Table {
  std::string_view name;
  Json (*rows)();
};
constexpr std::array<Table, 4> tables = {{
    {"functions", functions},
    {"schemes", schemes},
    {"solvers", solvers},
    {"formats", formats},
}};

std::string cell(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  return value.dump();
}

std::string columns(const Json& rows) {
  if (rows.empty()) return "";
  std::vector<std::vector<std::string>> lines(1);
  for (const auto& [key, value] : rows.front().items()) lines.front().push_back(key);
  for (const Json& row : rows) {
    lines.emplace_back();
    for (const auto& [key, value] : row.items()) lines.back().push_back(cell(value));
  }
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text;
  for (const auto& line : lines) {
    std::string row;
    for (std::size_t i = 0; i < line.size(); ++i)
      row += fmt::format("{:<{}}  ", line[i], widths[i]);
    text += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

int list(const std::string& what, bool json) {
  if (what.empty()) {
    Json all;
    std::string text;
    for (const Table& table : tables) {
      all[std::string(table.name)] = table.rows();
      text += fmt::format("{}{}:\n{}", text.empty() ? "" : "\n", table.name, columns(table.rows()));
    }
    print(json ? json_document(all) : text);
    return done;
  }
  const auto table = std::ranges::find(tables, what, &Table::name);
  if (table == tables.end())
    throw UsageError(
        fmt::format("list {}: no such list\nhelp: the lists are functions, schemes, solvers and "
                    "formats",
                    what));
  print(json ? json_document(table->rows()) : columns(table->rows()));
  return done;
}

}  // namespace

Command add_list(CLI::App& app) {
  const auto what = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  CLI::App* parser =
      app.add_subcommand("list", "lists the functions, schemes, solvers and formats there are");
  parser->add_option("WHAT", *what, "functions, schemes, solvers or formats; default: all of them");
  parser->add_flag("--json", *json, "as JSON");
  return {parser, [what, json] { return list(*what, *json); }};
}

}  // namespace hamgen::app
