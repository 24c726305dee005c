#include "app/studies/scheme_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>

#include "generator/base/diagnostic.hpp"
#include "generator/schemes/all_schemes.hpp"

namespace hamgen::app {
namespace {

std::vector<std::string> split_outside_parentheses(std::string_view text, char separator) {
  std::vector<std::string> pieces(1);
  int depth = 0;
  for (const char c : text) {
    if (c == '(' || c == '[') ++depth;
    if (c == ')' || c == ']') --depth;
    if (c == separator && depth == 0) {
      pieces.emplace_back();
    } else {
      pieces.back() += c;
    }
  }
  return pieces;
}

int order_value(std::string_view spec, const std::string& text) {
  int order = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), order);
  if (problem != std::errc() || end != text.data() + text.size() || order < 1)
    throw UsageError(fmt::format("--schemes {}: order={} is not a positive integer", spec, text));
  return order;
}

void require_scheme(const std::string& name) {
  if (find_scheme(name) != nullptr) return;
  const std::string near = scheme_meant_by(name);
  throw UsageError(fmt::format("--schemes: unknown scheme '{}'{}\nhelp: see hamgen list schemes",
                               name, near.empty() ? "" : ", did you mean '" + near + "'?"));
}

}  // namespace

std::string method_text(const PluginSource& plugin) {
  return plugin.scheme_name + (plugin.is_swept ? ", " + plugin.solver : "");
}

bool suits(std::string_view name, const Mechanics& mechanics) {
  const Scheme* scheme = find_scheme(name);
  if (scheme == nullptr) return false;
  try {
    static_cast<void>(for_system(*scheme, mechanics));
    return true;
  } catch (const UsageError&) {
    return false;
  }
}

Request request_of_spec(std::string_view spec, const Request& base) {
  Request request = base;
  const std::map<std::string, std::function<void(const std::string&)>> fields = {
      {"alpha", [&](const std::string& value) { request.alpha = value; }},
      {"beta", [&](const std::string& value) { request.beta = value; }},
      {"gamma", [&](const std::string& value) { request.gamma = value; }},
      {"gauge", [&](const std::string& value) { request.gauge = value; }},
      {"solver", [&](const std::string& value) { request.solver = value; }},
      {"scalar", [&](const std::string& value) { request.scalar = value; }},
      {"scheme", [&](const std::string& value) { request.scheme = value; }}};
  const std::vector<std::string> pieces = split_outside_parentheses(spec, ':');
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::size_t equals = pieces[i].find('=');
    if (equals == std::string::npos && i == 0) {
      require_scheme(pieces[i]);
      request.scheme = pieces[i];
      continue;
    }
    const std::string key = pieces[i].substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : pieces[i].substr(equals + 1);
    if (key == "order") {
      request.order = order_value(spec, value);
      continue;
    }
    const auto field = fields.find(key);
    if (field == fields.end() || value.empty()) {
      std::vector<std::string> keys = {"order"};
      for (const auto& [name, member] : fields) keys.push_back(name);
      throw UsageError(fmt::format("--schemes {}: '{}' is none of {}, each with =VALUE", spec,
                                   pieces[i], fmt::join(keys, ", ")));
    }
    field->second(value);
  }
  // The same member: a gauge is one of alpha = 1/2.
  if (request.scheme == "implicit-midpoint" && !request.gauge.empty()) request.scheme = "";
  return request;
}

std::vector<std::string> split_specs(std::string_view text) {
  return split_outside_parentheses(text, ',');
}

std::vector<std::string> default_specs(const Mechanics& mechanics) {
  // In each row the first that exists and fits.  Generating functions are for few degrees of
  // freedom: their terms multiply.
  struct Row {
    int most_degrees_of_freedom = 1'000'000;
    std::vector<std::string_view> specs;
  };
  const std::vector<Row> preferred = {
      {.specs = {"implicit-midpoint"}},
      {.specs = {"implicit-midpoint:solver=fixed-point"}},
      {.specs = {"stormer-verlet", "symplectic-euler-a"}},
      {.most_degrees_of_freedom = 2, .specs = {"implicit-midpoint:order=4"}},
      {.most_degrees_of_freedom = 2, .specs = {"implicit-midpoint:order=6"}},
      {.most_degrees_of_freedom = 1, .specs = {"implicit-midpoint:order=8"}},
      {.most_degrees_of_freedom = 1, .specs = {"implicit-midpoint:order=10"}},
      {.specs = {"omelyan-4"}},
      {.specs = {"mclachlan-4-sb3a"}},
      {.specs = {"blanes-moan-rkn-6", "blanes-moan-6", "kahan-li-6"}},
      {.specs = {"kahan-li-8-verlet", "kahan-li-8"}},
      {.specs = {"sofroniou-spaletta-10-verlet", "sofroniou-spaletta-10"}},
      {.specs = {"gauss-4"}},
      {.specs = {"gauss-6"}},
      {.specs = {"gauss-8"}},
      {.specs = {"gauss-8:solver=fixed-point"}},
      {.specs = {"gauss-12"}},
      {.specs = {"gauss-12:solver=fixed-point"}},
      {.specs = {"gauss-16"}},
      {.specs = {"gauss-16:solver=fixed-point"}},
      {.specs = {"rk4"}},
  };
  std::vector<std::string> specs;
  for (const Row& row : preferred) {
    if (mechanics.degrees_of_freedom > row.most_degrees_of_freedom) continue;
    const auto fits = [&mechanics](std::string_view spec) {
      return suits(spec.substr(0, spec.find(':')), mechanics);
    };
    const auto first = std::ranges::find_if(row.specs, fits);
    if (first != row.specs.end()) specs.emplace_back(*first);
  }
  return specs;
}

}  // namespace hamgen::app
