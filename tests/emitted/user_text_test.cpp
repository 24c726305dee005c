// User text in emitted code: whatever it is, a compiler does not see it.  Behind every character
// that could end a comment or a string stands a #error.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>

#include "generator/base/code_writer.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/quoted_text.hpp"
#include "generator/base/source_text.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

// Every byte, and the characters beyond ASCII that end lines or turn the order of text.
std::vector<std::string> characters() {
  std::vector<std::string> all;
  for (int byte = 0; byte < 256; ++byte) all.emplace_back(1, static_cast<char>(byte));
  for (const char* character :
       {"\u0085", "\u2028", "\u2029", "\u061C", "\u200E", "\u200F", "\u202A", "\u202B", "\u202C",
        "\u202D", "\u202E", "\u2066", "\u2067", "\u2068", "\u2069", "\uFEFF"})
    all.emplace_back(character);
  return all;
}

std::string trap(const std::string& character) { return "x" + character + "#error reached\n"; }

std::string all_traps() {
  std::string text;
  for (const std::string& character : characters()) text += trap(character);
  return text;
}

// The header or plugin of a model.
std::string emitted(const std::string& text, Request request, const std::string& path = "m.ham") {
  const SourceText source = make_source(path, text);
  if (request.format != "cpp-plugin") return without_pragma(generate(source, request).at(0).text);
  return generate(source, request).at(0).text;
}

const std::string declarations = "system m\ncoordinate q\nmomentum p\n";
const std::string safe_pendulum = declarations + "H = p^2/2 - cos(q)\n";
const std::string safe_chain =
    "system m\ncoordinate q[1..40] periodic\nmomentum p[1..40]\n"
    "H = sum(i = 1..40, p[i]^2/2 - cos(q[i+1] - q[i]))\n";

void expect_clean(const std::string& code) {
  for (const std::string& compiler : compilers()) EXPECT_EQ(messages(compiler, code), "");
}

TEST(UserText, ThatIsWrittenRawIsReachedByTheCompiler) {
  // What the other tests would find.
  for (const std::string character : {"\r", "\n", "\\\n"}) {
    const std::string code = "// " + trap(character) + "int x;\n";
    for (const std::string& compiler : compilers())
      EXPECT_NE(messages(compiler, code), "") << compiler;
  }
  EXPECT_NE(messages("g++", "const char* s = \"" + trap("\"") + "\";\n"), "");
  EXPECT_NE(messages("g++", "// ends with a backslash \\ \nint x;\n"), "");
  EXPECT_NE(messages("g++", "// \u202E turned\n"), "");
}

TEST(UserText, OfAnyCharactersStaysInCommentsAndStrings) {
  CodeWriter out;
  out.remark("// ", all_traps());
  out.comment("//   hanging ", all_traps());
  std::vector<std::pair<std::string, std::string>> members;
  int count = 0;
  for (const std::string& character : characters()) {
    const std::string number = std::to_string(++count);
    const std::string long_name = std::string(60, 'n') + number;  // its remark stands above it
    for (const std::string& text :
         {trap(character), "ends with " + character, "ends with " + character + "  ",
          "\\" + character, "?\?/" + character}) {
      out.remark("// ", text);
      out.comment("//   ", text);
      out.line("static_assert(sizeof(" + cpp_string(text) +
               ") == " + std::to_string(text.size() + 1) + ");");
    }
    members.emplace_back("int a" + number + ";", trap(character));
    members.emplace_back("int b" + number + ";", "ends with " + character);
    members.emplace_back("int " + long_name + ";", "ends with " + character);
  }
  out.open("struct Members");
  out.aligned(members);
  out.close(";");
  expect_clean(out.text());
}

TEST(UserText, InPathsCommandsAndDigestsStaysThere) {
  for (const std::string format : {"cpp-header", "cpp-plugin"}) {
    for (const std::string& model : {safe_pendulum, safe_chain}) {
      const Request request{.format = format,
                            .tangent = true,
                            .command = "hamgen " + all_traps() + "\\",
                            .model_digest = all_traps() + "\\"};
      expect_clean(emitted(model, request, "m" + all_traps() + "\\"));
    }
  }
}

// The model with the text as comments and units, or nothing if the language refuses it.
std::optional<std::string> with_remarks(const std::string& text, const std::string& range,
                                        const std::string& format = {},
                                        const std::string& name_space = "m::n") {
  std::string unit = text;
  std::erase_if(unit, [](char c) { return c == ']' || c == '#' || c == '\n'; });
  const std::string rest = " [" + unit + "] # " + text + "\n";
  const std::string hamiltonian = range.empty() ? "p^2/2 - a*cos(q)"
                                                : "sum(i = " + range.substr(1, range.size() - 2) +
                                                      ", p[i]^2/2 - a[i]*cos(q[i]))";
  const std::string model = "# " + text + "\nsystem m # " + text + "\ncoordinate q" + range + rest +
                            "momentum p" + range + rest + "parameter a" + range + " = 1" + rest +
                            "H = " + hamiltonian + " # " + text + "\ninvariant c = " + hamiltonian +
                            " # " + text + "\nscene s { # " + text + "\n  h = 1\n}\n";
  try {
    return emitted(model, {.format = format, .name_space = name_space});
  } catch (const ModelError&) {
    return std::nullopt;
  }
}

TEST(UserText, InCommentsAndUnitsOfAModelStaysThereOrIsRefused) {
  std::string accepted;
  int refused = 0;
  for (const std::string& character : characters()) {
    if (with_remarks(trap(character).substr(0, 15), "")) {
      accepted += "x" + character + "#error reached ";
    } else {
      ++refused;
    }
  }
  // All bytes from 0x80 on and the control characters but tab and line end; a line's end leaves a
  // line "#error reached" of comment behind.
  EXPECT_EQ(refused, 128 + 30 + 1 + 15);
  std::erase(accepted, '\n');
  for (const std::string range : {"", "[1..2]"}) {
    for (const std::string format : {"cpp-header", "cpp-plugin"}) {
      const std::optional<std::string> code = with_remarks(accepted, range, format);
      ASSERT_TRUE(code);
      EXPECT_NE(code->find("#error reached"), std::string::npos);
      expect_clean(*code);
    }
    std::string together;
    int count = 0;
    for (const std::string end : {"\\", "\\ ", "?\?/", "*/", "\"", "\r"}) {
      const std::optional<std::string> ended =
          with_remarks("x" + end, range, {}, "m" + std::to_string(++count) + "::n");
      together += ended.value_or("");
      EXPECT_EQ(ended.has_value(), end != "\r") << end;
    }
    expect_clean(together);
  }
}

TEST(UserText, InOptionsBecomesTheExpressionItIs) {
  struct Case {
    Request request;
    std::string description;
  };
  std::string together;
  for (const Case& each : std::vector<Case>{
           {{.beta = "(0.01*h\n)"}, "alpha = 1/2, beta = 0.01*h, gamma = 0"},
           {{.beta = "(0.01*h # a comment\r\n)"}, "alpha = 1/2, beta = 0.01*h, gamma = 0"},
           {{.alpha = "\t[[ 1/2 ]]", .gamma = "-2.5e-3 * h"},
            "alpha = [[1/2]], beta = 0, gamma = -0.0025*h"},
           {{.beta = " - h/(2 ^ 3)"}, "alpha = 1/2, beta = -h/2^3, gamma = 0"},
           {{.gauge = "[[0, h/7],[h/9\n, 0]]"}, "C = [[0, h/7], [h/9, 0]]"}}) {
    const std::string code = emitted(safe_pendulum, each.request);
    EXPECT_NE(code.find("//   scheme    " + each.description + ": order 2"), std::string::npos)
        << code.substr(0, 500);
    together += code;
  }
  expect_clean(together);
}

TEST(UserText, OnASecondLineOfAnOptionIsNotPassedOver) {
  EXPECT_THROW(static_cast<void>(emitted(safe_pendulum, {.beta = "0.01*h\n + 1"})), ModelError);
  EXPECT_NO_THROW(static_cast<void>(emitted(safe_pendulum, {.beta = "0.01*h\n\n"})));
}

TEST(UserText, OfAnyCharactersInOptionsIsRefusedOrCompiles) {
  std::string code;
  int accepted = 0;
  for (const std::string& character : characters()) {
    const std::string text = "(0.01*h" + character + "#error reached\n)";
    const auto requests = std::to_array<std::function<Request()>>(
        {[&] { return Request{.alpha = text}; }, [&] { return Request{.beta = text}; },
         [&] { return Request{.gamma = text}; },
         [&] { return Request{.gauge = "[[0, " + text + "], [0, 0]]"}; }});
    for (const auto& make : requests) {
      ++accepted;
      try {
        Request request = make();
        request.name_space = "m::n" + std::to_string(accepted);
        code += emitted(safe_pendulum, request);
      } catch (const ModelError&) {
        --accepted;
      } catch (const UsageError&) {
        --accepted;
      }
    }
  }
  // Blank, tab, line end, and # itself.
  EXPECT_EQ(accepted, 4 * 4);
  expect_clean(code);
}

TEST(UserText, IsNoNamespaceUnlessItIsAName) {
  int accepted = 0;
  for (const std::string& character : characters()) {
    try {
      static_cast<void>(emitted(safe_pendulum, {.name_space = "a" + character + "b"}));
      ++accepted;
    } catch (const UsageError&) {
    }
  }
  EXPECT_EQ(accepted, 26 + 26 + 10 + 1);  // letters, digits, _
}

}  // namespace
}  // namespace hamgen::emitted_test
