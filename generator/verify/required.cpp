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
                                                    to_text(finding->verdict), finding->plain()));
}

void require_order(const Proof& proof, const Requirement& required) {
  for (const Finding& finding : proof) {
    if (!finding.property.starts_with("order ")) continue;
    const bool known = finding.verdict == Verdict::proved || finding.verdict == Verdict::tested;
    if (known && std::stoi(finding.property.substr(6)) >= required.order) return;
    throw ProofError(fmt::format("--require {}: {} is {}", required.word, finding.property,
                                 to_text(finding.verdict)));
  }
  fail(required.word, nullptr);
}

void require_one(const Proof& proof, const Requirement& required) {
  if (required.property.empty()) return require_order(proof, required);
  const std::string& name = required.invariant;
  if (!name.empty() && find(proof, name + " invariant") == nullptr) {
    throw UsageError(
        fmt::format("--require {}: the model has no invariant '{}'", required.word, name));
  }
  const Finding* finding = find(proof, required.property);
  if (finding != nullptr && finding->verdict == Verdict::proved) return;
  const bool tested = finding != nullptr && finding->verdict == Verdict::tested;
  if (!tested || !required.may_be_tested) fail(required.word, finding);
}

int order_of(const std::string& word, const std::string& digits) {
  int order = 0;
  const char* last = digits.data() + digits.size();
  const auto [end, error] = std::from_chars(digits.data(), last, order);
  if (error != std::errc{} || end != last)
    throw UsageError(fmt::format("--require {}: the order must be an integer", word));
  return order;
}

Requirement read_word(const std::string& word) {
  const std::string argument = word.substr(word.find(':') + 1);
  if (word.starts_with("order:"))
    return {.word = word, .property = "", .order = order_of(word, argument)};
  if (word.starts_with("conserves:"))
    return {.word = word, .property = argument + std::string(kConserved), .invariant = argument};
  if (word == "emitted-code")
    return {.word = word, .property = kEmittedCode, .may_be_tested = true};
  if (word == kProgram) return {.word = word, .property = kProgram, .may_be_tested = true};
  if (word == "symplectic" || word == "symmetric") return {.word = word, .property = word};
  throw UsageError(fmt::format("--require {}: there are {}", word, kWords));
}

}  // namespace

Requirements Requirements::read(const std::string& text) {
  Requirements required;
  for (std::size_t begin = 0; begin <= text.size() && !text.empty();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    required.list.push_back(read_word(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return required;
}

void require(const Proof& proof, const Requirements& required) {
  for (const Requirement& each : required.list) require_one(proof, each);
}

void require_emitted(const Proof& proof) {
  for (const char* property : {kProgram, kEmittedCode, kModelRead, "specialised"}) {
    const Finding* finding = find(proof, property);
    if (finding == nullptr || finding->verdict != Verdict::refuted) continue;
    throw ProofError("the emitted code is not the step of this model, a fault of hamgen: " +
                     finding->plain());
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
