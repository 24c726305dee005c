#include "generator/verify/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace hamgen {

std::string Finding::plain() const {
  std::string text = detail;
  std::erase(text, '`');
  return text;
}

bool holds(Verdict verdict) { return verdict == Verdict::proved || verdict == Verdict::tested; }

Verdict both(Verdict a, Verdict b) {
  if (a == Verdict::refuted || b == Verdict::refuted) return Verdict::refuted;
  if (!holds(a) || !holds(b)) return Verdict::not_decided;
  return std::max(a, b);
}

Verdict resting_on(Verdict premise, Verdict conclusion) {
  // A counterexample needs no premise.
  if (conclusion == Verdict::refuted || conclusion == Verdict::measured) return conclusion;
  return premise == Verdict::refuted ? Verdict::not_decided : both(premise, conclusion);
}

Finding resting_on(Verdict premise, const std::string& why, Finding conclusion) {
  if (premise == Verdict::proved || !holds(conclusion.verdict)) return conclusion;
  conclusion.verdict = resting_on(premise, conclusion.verdict);
  conclusion.detail += "; " + why;
  return conclusion;
}

std::string to_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::proved:
      return "proved";
    case Verdict::tested:
      return "tested";
    case Verdict::refuted:
      return "refuted";
    case Verdict::not_decided:
      return "not decided";
    case Verdict::measured:
      return "measured";
  }
  return "";
}

std::string to_text(const Proof& proof) {
  std::size_t width = 0;
  for (const Finding& finding : proof) width = std::max(width, finding.property.size());
  std::string text;
  for (const Finding& finding : proof) {
    text += fmt::format("{:{}}  {:11}  {}\n", finding.property, width, to_text(finding.verdict),
                        finding.plain());
  }
  return text;
}

}  // namespace hamgen
