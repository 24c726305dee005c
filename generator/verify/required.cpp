#include "generator/verify/required.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "generator/base/diagnostic.hpp"
#include "generator/verify/model_text.hpp"

namespace hamgen {

namespace {

constexpr std::string_view kConserved = " conserved by the step";
constexpr std::string_view kWords =
    "symplectic, symmetric, order:P, conserves:NAME, program, emitted-code";

const Finding* find(const Proof& proof, std::string_view property) {
  const auto it = std::ranges::find(proof, property, &Finding::property);
  return it == proof.end() ? nullptr : &*it;
}

[[noreturn]] void fail(const std::string& word, const Finding* finding) {
  throw ProofError(finding == nullptr ? fmt::format("--require {}: not decided", word)
                                      : fmt::format("--require {}: {}: {}", word,
                                                    to_text(finding->verdict), finding->detail));
}

void require_order(const Proof& proof, const std::string& word) {
  const std::string digits = word.substr(word.find(':') + 1);
  int wanted = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), wanted);
  if (error != std::errc{} || end != digits.data() + digits.size()) {
    throw UsageError(fmt::format("--require {}: the order must be an integer", word));
  }
  for (const Finding& finding : proof) {
    if (!finding.property.starts_with("order ")) continue;
    const bool known = finding.verdict == Verdict::proved || finding.verdict == Verdict::tested;
    if (known && std::stoi(finding.property.substr(6)) >= wanted) return;
    throw ProofError(
        fmt::format("--require {}: {} is {}", word, finding.property, to_text(finding.verdict)));
  }
  fail(word, nullptr);
}

void require_one(const Proof& proof, const std::string& word) {
  if (word.starts_with("order:")) return require_order(proof, word);
  std::string property = word;
  if (word == "emitted-code") {
    property = kEmittedCode;
  } else if (word.starts_with("conserves:")) {
    const std::string name = word.substr(word.find(':') + 1);
    property = name + std::string(kConserved);
    if (find(proof, name + " invariant") == nullptr) {
      throw UsageError(fmt::format("--require {}: the model has no invariant '{}'", word, name));
    }
  } else if (word != "symplectic" && word != "symmetric" && word != kProgram) {
    throw UsageError(fmt::format("--require {}: there are {}", word, kWords));
  }
  const Finding* finding = find(proof, property);
  if (finding != nullptr && finding->verdict == Verdict::proved) return;
  const bool tested = finding != nullptr && finding->verdict == Verdict::tested;
  if (tested && (word == "emitted-code" || word == kProgram)) return;
  fail(word, finding);
}

}  // namespace

void require(const Proof& proof, const std::string& list) {
  for (std::size_t begin = 0; begin <= list.size() && !list.empty();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    require_one(proof, list.substr(begin, end - begin));
    begin = end + 1;
  }
}

void require_emitted(const Proof& proof) {
  for (const char* property : {kProgram, kEmittedCode, kModelRead, "specialised"}) {
    const Finding* finding = find(proof, property);
    if (finding == nullptr || finding->verdict != Verdict::refuted) continue;
    throw ProofError("the emitted code is not the step of this model, a fault of hamgen: " +
                     finding->detail);
  }
}

std::string properties_with(const Proof& proof, Verdict verdict) {
  std::string text;
  for (const Finding& finding : proof) {
    // What it rests on is said by `verify`.
    if (finding.verdict != verdict || finding.property == "gauge in sp(2n)" ||
        finding.property.ends_with(" invariant") || finding.property == kModelRead) {
      continue;
    }
    // The text says no less than the program.
    const Finding* text_read = finding.property == kProgram ? find(proof, kEmittedCode) : nullptr;
    if (text_read != nullptr && text_read->verdict == verdict) continue;
    std::string property = finding.property;
    if (property.ends_with(kConserved)) {
      property = "conserves " + property.substr(0, property.size() - kConserved.size());
    }
    text += (text.empty() ? "" : ", ") + property;
  }
  return text;
}

}  // namespace hamgen
