// Equal input gives equal bytes, whatever the process, its addresses and its locale.
#include <gtest/gtest.h>

#include <fstream>
#include <locale>

#include "generator/base/source_text.hpp"
#include "runtime/temporary_directory.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

std::string emitted_by_a_fresh_process(const std::filesystem::path& model,
                                       const std::vector<std::string>& environment) {
  const runtime::TemporaryDirectory directory = runtime::private_directory();
  std::vector<std::string> command{"env"};
  command.insert(command.end(), environment.begin(), environment.end());
  command.insert(command.end(),
                 {HAMGEN_EXECUTABLE, "generate", model.string(), "-o", directory.path().string(),
                  "--alpha", "3/10", "--beta", "h/7,h/8"});
  const runtime::ProcessResult result = runtime::run_process({.command = command});
  EXPECT_TRUE(result.succeeded()) << result.output;
  const std::string text = read(directory.path() / (model.stem().string() + ".hpp"));
  // The command line names the directory.
  return text.substr(text.find("//   model"));
}

// A locale with a decimal comma in a directory of its own; empty if it cannot be made here.
std::vector<std::string> german(const std::filesystem::path& directory) {
  const runtime::ProcessResult made = [&]() -> runtime::ProcessResult {
    try {
      return runtime::run_process({.command = {"localedef", "-i", "de_DE", "-f", "UTF-8",
                                               (directory / "de_DE.UTF-8").string()}});
    } catch (const std::runtime_error&) {
      return {.code = 1};
    }
  }();
  if (!std::filesystem::exists(directory / "de_DE.UTF-8")) return {};
  return {"LOCPATH=" + directory.string(), "LC_ALL=de_DE.UTF-8"};
}

TEST(SameBytes, ComeFromTwentyFreshProcessesUnderTwoLocales) {
  const auto folder = std::filesystem::path(HAMGEN_SOURCE_DIR) / "hamiltonians";
  const runtime::TemporaryDirectory locales = runtime::private_directory();
  std::vector<std::string> other = german(locales.path());
  if (other.empty()) other = {"LC_ALL=de_DE.UTF-8", "LC_NUMERIC=de_DE.UTF-8", "LANG=C.UTF-8"};
  for (const char* name : {"double_pendulum.ham", "henon_heiles.ham"}) {
    const std::string first = emitted_by_a_fresh_process(folder / name, {"LC_ALL=C"});
    ASSERT_GT(first.size(), 1000u);
    for (int i = 0; i < 20; ++i) {
      std::vector<std::string> environment =
          i % 2 == 0 ? std::vector<std::string>{"LC_ALL=C"} : other;
      // The environment moves the stack.
      environment.push_back("PADDING=" + std::string(static_cast<std::size_t>(i * 37), 'x'));
      ASSERT_EQ(emitted_by_a_fresh_process(folder / name, environment), first)
          << name << ", run " << i;
    }
  }
}

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(SameBytes, ComeFromASecondCallUnderACxxLocaleWithADecimalComma) {
  const auto texts_of_all = [] {
    std::vector<std::string> texts;
    for (const auto& model : shipped_models()) {
      const Request request{.alpha = "3/10", .beta = "0.125*h", .scalar = "quad"};
      const SourceText source = read_source(model.string());
      // What is proved is said in the same words everywhere: of one model is enough.
      const bool proved = model.stem() == "kepler";
      texts.push_back((proved ? generate(source, request) : emit(source, request)).at(0).text);
    }
    return texts;
  };
  const std::vector<std::string> before = texts_of_all();
  const std::locale kept =
      std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  const std::vector<std::string> after = texts_of_all();
  std::locale::global(kept);
  EXPECT_EQ(before, after);
}

}  // namespace
}  // namespace hamgen::emitted_test
