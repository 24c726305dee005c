#include "generator/emitted_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

// Rests on the program, and stands below `above`.
void insert(Finding finding, const char* above, Proof& proof) {
  const auto program = std::ranges::find(proof, kProgram, &Finding::property);
  if (program == proof.end()) return proof.push_back(std::move(finding));
  if (holds(finding.verdict) && program->verdict != Verdict::proved) {
    const std::string why = "no better known than the program";
    finding = resting_on(program->verdict, why, std::move(finding));
  }
  const auto place = std::ranges::find(proof, above, &Finding::property);
  proof.insert((place == proof.end() ? program : place) + 1, std::move(finding));
}

std::string kind_text(TextKind kind) {
  switch (kind) {
    case TextKind::header:
      return "text";
    case TextKind::plugin:
      return "text of a plugin";
    case TextKind::c_header:
      return "text in C";
  }
  internal_error("unknown kind of text");
}

// `where` stands before the number of a line.
Finding finding_of(const ReadBack& read, const char* property, const std::string& where) {
  Finding finding{.property = property, .verdict = Verdict::proved, .detail = {}};
  switch (read.outcome) {
    case ReadBack::Outcome::same:
      finding.detail = fmt::format(
          "{} instructions of {} routines read back from the {}: the program's, in the order "
          "in which they round; {} fixed blocks as they are tested",
          read.instructions, read.routines, kind_text(read.kind), read.blocks);
      if (read.kind == TextKind::plugin)
        finding.detail += fmt::format("; {} values where the host has them", read.places);
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
  return finding;
}

}  // namespace

void add_emitted_code(const ReadBack& read, const std::string& path, Proof& proof) {
  const std::string where = path.empty() ? "line " : path + ":";
  insert(finding_of(read, kEmittedCode, where), kProgram, proof);
}

void add_plugin(const ReadBack& read, Proof& proof) {
  insert(finding_of(read, kPlugin, "line "), kEmittedCode, proof);
}

}  // namespace hamgen
