// Emitted texts, and faults that are planted in them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "generator/base/diagnostic.hpp"
#include "generator/pipeline.hpp"
#include "generator/readback/tokens.hpp"
#include "generator/stages.hpp"

namespace hamgen::readback_test {

inline const std::string kRational =
    "coordinate q\nmomentum p\nparameter a = 3\n"
    "H = p^2/2 + q^2/((1 + q^2)*(a + p^2*q))\n";
inline const std::string kNonseparable =
    "coordinate q, r\nmomentum p, s\nH = (p^2 + s^2)*(1 + q^2 + r^2)/2 + q*r*p/5\n";

inline const std::string kWithEvents =
    "coordinate q\nmomentum p\nparameter line = 1/2\nH = p^2/2 - cos(q)\n"
    "event right = q - line rising\nevent top = p\n";

inline SourceText source_of(const std::string& model) {
  if (model.find('\n') != std::string::npos) return make_source("system.ham", model);
  return read_source(HAMGEN_SOURCE_DIR "/hamiltonians/" + model + ".ham");
}

struct Emitted {
  Stages stages;
  std::string scalar;
  std::string text;
  Rational watched_step;
  int lanes = 0;

  [[nodiscard]] ReadBack read(const std::string& changed) const {
    return read_back({.text = changed,
                      .scalar = scalar,
                      .beside = {},
                      .watched_step = watched_step,
                      .lanes = lanes},
                     stages.program);
  }
};

inline Emitted emitted(const std::string& model, const Request& request) {
  const SourceText source = source_of(model);
  const bool in_c = request.format == "c-header" || request.format == "opencl-header";
  const bool alone = !in_c && !request.events && request.batch == 0;
  std::string text;
  if (alone) {
    const PluginSource plugin = generate_plugin(source, request, HeaderText::without_proof);
    text = request.format == "cpp-plugin" ? plugin.text : plugin.header.text;
  } else {
    text = generate(source, request).at(0).text;
  }
  return {run_stages(source, request), request.scalar.text(), std::move(text), request.step,
          request.batch};
}

inline int line_of(const std::string& text, std::size_t at) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(at), '\n'));
}

struct Fault {
  std::string name;
  std::string model;
  Request request;
  std::string from, to;
};

inline void expect_found(const Fault& fault) {
  const Emitted file = emitted(fault.model, fault.request);
  const ReadBack before = file.read(file.text);
  ASSERT_EQ(before.outcome, ReadBack::Outcome::same)
      << fault.name << ": " << before.line << ": " << before.what;
  const std::size_t at = file.text.find(fault.from);
  ASSERT_NE(at, std::string::npos) << fault.name << " is not in\n" << file.text;
  std::string changed = file.text;
  changed.replace(at, fault.from.size(), fault.to);
  const ReadBack found = file.read(changed);
  EXPECT_EQ(found.outcome, ReadBack::Outcome::different)
      << fault.name << ": " << found.line << ": " << found.what;
  const int first = line_of(file.text, at);
  const int last = first + static_cast<int>(std::ranges::count(fault.to, '\n'));
  EXPECT_TRUE(first <= found.line && found.line <= last)
      << fault.name << ": planted in line " << first << ", found in " << found.line << ": "
      << found.what;
}

// Every word of the text, or some of them, counts: left out, the text is another or none.
inline void expect_every_word_counts(const Emitted& file, std::size_t every) {
  const std::vector<CppToken> tokens = tokens_of(file.text);
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < file.text.size();) {
    const std::size_t end = std::min(file.text.find('\n', begin), file.text.size());
    lines.push_back(file.text.substr(begin, end - begin));
    begin = end + 1;
  }
  int looked_at = 0;
  for (std::size_t i = 0; i + 1 < tokens.size(); i += every) {
    const CppToken& token = tokens[i];
    // What is free: const, and directives that go on over two lines are found by their beginning.
    if (token.is("const") || token.kind == CppToken::Kind::directive) continue;
    std::vector<std::string> changed = lines;
    std::string& line = changed[static_cast<std::size_t>(token.line - 1)];
    // The first of its kind in the line that stands before a comment.
    const std::size_t at = line.find(token.text);
    if (at == std::string::npos || at > line.find("//")) continue;
    line.replace(at, token.text.size(), " ");
    std::string text;
    for (const std::string& each : changed) text += each + '\n';
    EXPECT_NE(file.read(text).outcome, ReadBack::Outcome::same)
        << token.line << ": " << lines[static_cast<std::size_t>(token.line - 1)] << "  without "
        << token.text;
    ++looked_at;
  }
  EXPECT_GT(looked_at, 100);
}

}  // namespace hamgen::readback_test
