#include "app/scheme_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "generator/base/diagnostic.hpp"
#include "generator/schemes/all_schemes.hpp"

namespace hamgen::app {
namespace {

std::vector<std::string> split_outside_parentheses(std::string_view text, char separator) {
  std::vector<std::string> pieces(1);
  int depth = 0;
  for (const char c : text) {
    if (c == '(') ++depth;
    if (c == ')') --depth;
    if (c == separator && depth == 0) {
      pieces.emplace_back();
    } else {
      pieces.back() += c;
    }
  }
  return pieces;
}

void require_scheme(const std::string& name) {
  if (find_scheme(name) != nullptr) return;
  std::vector<std::string> names;
  for (const Scheme& scheme : all_schemes()) names.emplace_back(scheme.name);
  const std::string near = nearest(name, names);
  throw UsageError(fmt::format("--schemes: unknown scheme '{}'{}\nhelp: see hamgen list schemes",
                               name, near.empty() ? "" : ", did you mean '" + near + "'?"));
}

}  // namespace

Request request_of_spec(std::string_view spec, const Request& base) {
  Request request = base;
  const std::map<std::string, std::string Request::*> fields = {
      {"alpha", &Request::alpha},   {"beta", &Request::beta},     {"gamma", &Request::gamma},
      {"solver", &Request::solver}, {"scalar", &Request::scalar}, {"scheme", &Request::scheme}};
  const std::vector<std::string> pieces = split_outside_parentheses(spec, ':');
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::size_t equals = pieces[i].find('=');
    if (equals == std::string::npos && i == 0) {
      require_scheme(pieces[i]);
      request.scheme = pieces[i];
      continue;
    }
    const std::string key = pieces[i].substr(0, equals);
    const auto field = fields.find(key);
    if (field == fields.end() || equals == std::string::npos || equals + 1 == pieces[i].size()) {
      std::vector<std::string> keys;
      for (const auto& [name, member] : fields) keys.push_back(name);
      throw UsageError(fmt::format("--schemes {}: '{}' is none of {}, each with =VALUE", spec,
                                   pieces[i], fmt::join(keys, ", ")));
    }
    request.*(field->second) = pieces[i].substr(equals + 1);
  }
  return request;
}

std::vector<std::string> split_specs(std::string_view text) {
  return split_outside_parentheses(text, ',');
}

std::vector<std::string> default_specs(bool separable) {
  // In each row the first that exists and fits; a row whose schemes do not exist is left out.
  static constexpr std::array<std::array<std::string_view, 3>, 8> preferred = {{
      {"symplectic-euler-a"},
      {"implicit-midpoint"},
      {"stormer-verlet"},
      {"blanes-moan-4", "suzuki-4", "yoshida-4"},
      {"gauss-4"},
      {"kahan-li-6", "yoshida-6"},
      {"kahan-li-8", "yoshida-8"},
      {"gauss-8", "gauss-6"},
  }};
  std::vector<std::string> specs;
  for (const auto& row : preferred) {
    for (const std::string_view name : row) {
      const Scheme* scheme = name.empty() ? nullptr : find_scheme(name);
      if (scheme == nullptr || (!separable && scheme->needs.find("any") == std::string::npos))
        continue;
      specs.emplace_back(name);
      break;
    }
  }
  return specs;
}

}  // namespace hamgen::app
