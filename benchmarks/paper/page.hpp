// The page docs/paper/README.md as values: claims of the paper beside what was measured.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace hamgen::paper {

enum class Verdict { reproduces, partly, does_not };

// `yes` if the first holds, `partly` if only the second does.
[[nodiscard]] Verdict verdict(bool holds, bool in_part = false);

struct Claim {
  std::string source;    // "Fig. 4, 4.1.2 a"
  std::string claim;     // in the paper's words, shortened
  std::string measured;  // one or two sentences
  Verdict verdict = Verdict::does_not;
};

struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

struct Section {
  std::string title;
  std::string picture;  // a file beside the page; empty for none
  std::string caption;
  std::vector<Claim> claims;
  std::vector<std::string> body;               // paragraphs and tables in Markdown
  std::map<std::string, double> numbers = {};  // for tests
};

[[nodiscard]] std::string to_markdown(const Table& table);

// 1.499e-06; "-" for what is not finite.
[[nodiscard]] std::string number(double value, int digits = 3);
[[nodiscard]] std::string number(long double value, int digits = 3);

// The order p of errors e_i ~ h_i^p from the two smallest steps whose errors are above `floor`,
// where rounding counts.  "-" without two such errors.  Steps ascend.
[[nodiscard]] std::string order_text(const std::vector<double>& steps,
                                     const std::vector<double>& errors, double floor);

// The whole page.  `provenance` says where and how the numbers were measured.
[[nodiscard]] std::string page_text(const std::vector<Section>& sections,
                                    const std::string& provenance);

// The sections' numbers as one JSON object.
[[nodiscard]] std::string numbers_text(const std::vector<Section>& sections);

}  // namespace hamgen::paper
