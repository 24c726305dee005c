#include "generator/readback/pattern.hpp"

#include <fmt/format.h>

#include "generator/readback/findings.hpp"

namespace hamgen {

namespace {

void expect_constant(TokenCursor& cursor, const Rational& exact, const Precision& precision,
                     const std::string& what) {
  const int line = cursor.line();
  const MachineValue written = TextScope(precision, 0, false).value(read_cpp_expression(cursor));
  const bool number = written.kind == MachineValue::Kind::number;
  const Rational value = written.negative ? Rational(-written.number) : written.number;
  if (!number || !is_rounded(value, exact, precision))
    throw TextDifference(line, fmt::format("a number of {} is not {}", what,
                                           to_text(Expression(exact)).substr(0, 60)));
}

}  // namespace

void expect_pattern(TokenCursor& cursor, const Pattern& pattern, const Precision& precision,
                    const std::string& what) {
  std::size_t next_constant = 0;
  for (const CppToken& token : tokens_of(pattern.text)) {
    if (token.kind == CppToken::Kind::end) return;
    if (token.is(kConstant)) {
      expect_constant(cursor, pattern.constants.at(next_constant++), precision, what);
      continue;
    }
    const CppToken& found = cursor.peek();
    if (found.kind != token.kind || found.text != token.text)
      throw TextDifference(found.line,
                           fmt::format("'{}' where {} has '{}'", found.text, what, token.text));
    cursor.take();
  }
}

}  // namespace hamgen
