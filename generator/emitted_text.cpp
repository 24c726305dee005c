#include "generator/emitted_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace hamgen {

namespace {

void insert_below_program(Finding finding, Proof& proof) {
  const auto program = std::ranges::find(proof, kProgram, &Finding::property);
  if (program == proof.end()) return proof.push_back(std::move(finding));
  if (holds(finding.verdict) && program->verdict != Verdict::proved) {
    const std::string why = "no better known than the program";
    finding = resting_on(program->verdict, why, std::move(finding));
  }
  proof.insert(program + 1, std::move(finding));
}

}  // namespace

void add_emitted_code(const ReadBack& read, const std::string& path, Proof& proof) {
  const std::string where = path.empty() ? "line " : path + ":";
  Finding finding{.property = kEmittedCode, .verdict = Verdict::proved, .detail = {}};
  switch (read.outcome) {
    case ReadBack::Outcome::same:
      finding.detail = fmt::format(
          "{} instructions of {} routines read back from the text: the program's, in the order "
          "in which they round; {} fixed blocks as they are tested",
          read.instructions, read.routines, read.blocks);
      break;
    case ReadBack::Outcome::different:
      finding.verdict = Verdict::refuted;
      finding.detail = fmt::format("{}{}: {}", where, read.line, read.what);
      break;
    case ReadBack::Outcome::not_understood:
      finding.verdict = Verdict::not_decided;
      finding.detail = fmt::format("{}{}: not understood: {}", where, read.line, read.what);
      break;
  }
  insert_below_program(std::move(finding), proof);
}

void add_unread_code(const std::string& format, Proof& proof) {
  insert_below_program(
      {kEmittedCode, Verdict::not_decided, format + " is not read back, only its program is known"},
      proof);
}

}  // namespace hamgen
