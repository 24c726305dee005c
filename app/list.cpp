// hamgen list: the names that models and options can use.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/command_line.hpp"
#include "app/output/json_document.hpp"
#include "app/output/terminal.hpp"
#include "app/studies/scheme_spec.hpp"
#include "generator/algebra/functions.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/formats/all_formats.hpp"
#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
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

constexpr std::size_t kListWidth = 100;

// Words on lines of so many columns.
std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const bool fits = lines.back().empty() || lines.back().size() + 1 + word.size() <= width;
    if (!fits) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

constexpr std::size_t kCellWidth = 16;  // at most, of a column between the first and the last

// A table in so many columns of text: what is longer than its cell goes on below.
std::string columns(const Json& rows, const std::vector<std::string>& keys) {
  std::vector<std::vector<std::string>> table = {keys};
  for (const Json& row : rows) {
    table.emplace_back();
    for (const std::string& key : keys) table.back().push_back(cell(row.at(key)));
  }
  std::vector<std::size_t> widths(keys.size(), 0);
  std::size_t used = 0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    for (const auto& row : table) widths[i] = std::max(widths[i], row[i].size());
    if (i > 0) widths[i] = std::min(widths[i], kCellWidth);
    if (i + 1 == keys.size()) widths[i] = kListWidth - used;
    used += widths[i] + 2;
  }
  std::string text;
  for (const auto& row : table) {
    std::vector<std::vector<std::string>> cells;
    std::size_t height = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
      cells.push_back(wrapped(row[i], widths[i]));
      height = std::max(height, cells.back().size());
    }
    for (std::size_t k = 0; k < height; ++k) {
      std::string line;
      for (std::size_t i = 0; i < cells.size(); ++i)
        line += fmt::format("{:<{}}  ", k < cells[i].size() ? cells[i][k] : "", widths[i]);
      text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
  }
  return text;
}

struct ListOptions {
  std::string what;
  std::string model;  // of --for
  bool sources = false;
  bool json = false;
};

// The schemes that the model can be integrated by.
Json suitable(const Json& rows, const std::string& path) {
  const Mechanics mechanics = derive(read_model(read_source(path)));
  Json result = Json::array();
  for (const Json& row : rows) {
    const Scheme* scheme = find_scheme(row.at("name").get<std::string>());
    if (scheme == nullptr || suits(scheme->name, mechanics)) result.push_back(row);
  }
  return result;
}

Json rows_of(const Table& table, const ListOptions& options) {
  const Json rows = table.rows();
  return table.name == "schemes" && !options.model.empty() ? suitable(rows, options.model) : rows;
}

// The source of a scheme has a table of its own.
std::string table_text(const Table& table, const ListOptions& options) {
  const Json rows = rows_of(table, options);
  std::vector<std::string> keys;
  for (const auto& [key, value] : rows.front().items()) {
    if (key != "source") keys.push_back(key);
  }
  if (options.sources && table.name == "schemes") keys = {"name", "source"};
  return columns(rows, keys);
}

int list(const ListOptions& options) {
  const bool of_schemes = options.what.empty() || options.what == "schemes";
  if (!of_schemes && (options.sources || !options.model.empty()))
    throw UsageError(fmt::format("list {}: --for and --sources are about schemes", options.what));
  if (options.what.empty()) {
    Json all;
    std::string text;
    for (const Table& table : tables) {
      all[std::string(table.name)] = rows_of(table, options);
      text += fmt::format("{}{}:\n{}", text.empty() ? "" : "\n", table.name,
                          table_text(table, options));
    }
    print(options.json ? json_document(all) : text);
    return done;
  }
  const auto table = std::ranges::find(tables, options.what, &Table::name);
  if (table == tables.end())
    throw UsageError(
        fmt::format("list {}: no such list\nhelp: the lists are functions, schemes, solvers and "
                    "formats",
                    options.what));
  print(options.json ? json_document(rows_of(*table, options)) : table_text(*table, options));
  return done;
}

}  // namespace

Command add_list(CLI::App& app) {
  const auto options = std::make_shared<ListOptions>();
  CLI::App* parser =
      app.add_subcommand("list", "lists the functions, schemes, solvers and formats there are");
  parser->add_option("WHAT", options->what,
                     "functions, schemes, solvers or formats; default: all of them");
  parser->add_option("--for", options->model, "only schemes for this model")->type_name("MODEL");
  parser->add_flag("--sources", options->sources, "where the schemes are from");
  parser->add_flag("--json", options->json, "as JSON, all of it");
  return {parser, [options] { return list(*options); }};
}

}  // namespace hamgen::app
