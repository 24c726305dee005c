// Pieces of the report's page.
#pragma once

#include <string>
#include <string_view>

#include "app/output/math_formula.hpp"
#include "app/output/report_page.hpp"

namespace hamgen::app {

// The lines that a reader wants first: method, what it conserves, what it reached, what to take for
// an error, what was left out.
[[nodiscard]] std::string report_answers(const ReportContent& content);

// "name = formula" on lines of its own, broken between terms.
[[nodiscard]] std::string formula_line(const std::string& left, const MathFormula& right);
[[nodiscard]] std::string inline_formula(const std::string& markup);
// Within a line of text; "left = right" and "h = 0.01" do not end a line in the middle.
[[nodiscard]] std::string inline_formula(const MathFormula& formula);
[[nodiscard]] std::string inline_equation(const MathFormula& left, const MathFormula& right);
[[nodiscard]] std::string named_value(std::string_view name, double value, int digits);

// A command, whose lines end between words.
[[nodiscard]] std::string command_markup(const std::string& command);

// Behind the name of an invariant, in a finding's property.
inline constexpr std::string_view kConserved = " conserved by the step";
[[nodiscard]] std::string verdict_markup(Verdict verdict);
// Shut until it is opened.
[[nodiscard]] std::string folded(const std::string& summary, const std::string& inside);
[[nodiscard]] std::string counted(std::size_t count, std::string_view one, std::string_view many);

// Seconds with the unit that suits them: "142 ns", "1.06 µs".
[[nodiscard]] std::string html_seconds(double seconds);

[[nodiscard]] std::string system_section(const ReportContent& content);
[[nodiscard]] std::string proof_section(const ReportContent& content);
[[nodiscard]] std::string modified_section(const ReportContent& content);
[[nodiscard]] std::string bench_table(const Bench& bench);
// The quickest method for each of the errors that were asked for.
[[nodiscard]] std::string ladder_table(const ReportContent& content);

}  // namespace hamgen::app
