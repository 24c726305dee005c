#include "benchmarks/paper/page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <cmath>

namespace hamgen::paper {
namespace {

std::string_view verdict_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::reproduces:
      return "yes";
    case Verdict::partly:
      return "partly";
    case Verdict::does_not:
      return "**no**";
  }
  return {};
}

// The anchor of a heading, as hosts of Markdown make it.
std::string anchor(const std::string& title) {
  std::string text;
  for (const char c : title) {
    if (std::isalnum(static_cast<unsigned char>(c)))
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (c == ' ' || c == '-') text += '-';
  }
  return text;
}

std::string section_text(const Section& section) {
  std::string text = fmt::format("\n## {}\n", section.title);
  if (!section.claims.empty()) {
    Table table{.header = {"the paper", "says", "measured here", "reproduces"}};
    for (const Claim& claim : section.claims) {
      table.rows.push_back(
          {claim.source, claim.claim, claim.measured, std::string(verdict_text(claim.verdict))});
    }
    text += "\n" + to_markdown(table);
  }
  if (!section.picture.empty())
    text +=
        fmt::format("\n![{0}]({1})\n\n*{2}*\n", section.title, section.picture, section.caption);
  for (const std::string& part : section.body)
    text += "\n" + part + (part.back() == '\n' ? "" : "\n");
  return text;
}

}  // namespace

Verdict verdict(bool holds, bool in_part) {
  if (holds) return Verdict::reproduces;
  return in_part ? Verdict::partly : Verdict::does_not;
}

std::string to_markdown(const Table& table) {
  std::string text = fmt::format("| {} |\n|", fmt::join(table.header, " | "));
  for (std::size_t i = 0; i < table.header.size(); ++i) text += " --- |";
  text += "\n";
  for (const std::vector<std::string>& row : table.rows)
    text += fmt::format("| {} |\n", fmt::join(row, " | "));
  return text;
}

std::string number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}e}", value, digits) : "-";
}

std::string number(long double value, int digits) {
  return number(static_cast<double>(value), digits);
}

std::string order_text(const std::vector<double>& steps, const std::vector<double>& errors,
                       double floor) {
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    if (errors[i] > floor && std::isfinite(errors[i + 1]))
      return fmt::format("{:.2f}",
                         std::log(errors[i + 1] / errors[i]) / std::log(steps[i + 1] / steps[i]));
  }
  return "-";
}

std::string page_text(const std::vector<Section>& sections, const std::string& provenance) {
  std::string text =
      "# The paper, figure by figure\n\n"
      "H. Jimenez-Perez, J.-P. Vilotte, B. Romanowicz: *New insights on numerical error in "
      "symplectic\n"
      "integration* (2015), repeated with the integrators hamgen emits. This page and its pictures "
      "are\n"
      "written by `scripts/reproduce-paper`; the left two columns of the tables of claims are the\n"
      "paper's, everything else was measured in that run.\n\n";
  text += provenance;
  text += "\n## In short\n\n";
  Table table{.header = {"", "claim", "reproduces"}};
  for (const Section& section : sections) {
    for (const Claim& claim : section.claims) {
      table.rows.push_back({fmt::format("[{}](#{})", claim.source, anchor(section.title)),
                            claim.claim, std::string(verdict_text(claim.verdict))});
    }
  }
  text += to_markdown(table);
  for (const Section& section : sections) text += section_text(section);
  return text;
}

std::string numbers_text(const std::vector<Section>& sections) {
  std::vector<std::string> entries;
  for (const Section& section : sections) {
    for (const auto& [name, value] : section.numbers)
      entries.push_back(fmt::format("  \"{}\": {:.17g}", name, value));
  }
  return fmt::format("{{\n{}\n}}\n", fmt::join(entries, ",\n"));
}

}  // namespace hamgen::paper
