// The language on inputs that nobody wrote: see scripts/fuzz for more of them, with sanitizers.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/fuzz/check_input.hpp"
#include "tests/fuzz/grammar.hpp"

namespace hamgen::fuzz {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

int accepted_in(const fs::path& folder) {
  int accepted = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    try {
      if (check_input(content(entry.path())) == Answer::accepted) ++accepted;
    } catch (const std::exception& error) {
      ADD_FAILURE() << entry.path() << ": " << error.what();
    }
  }
  return accepted;
}

TEST(Fuzz, TheCorpusIsAcceptedOrRefused) {
  const fs::path root = HAMGEN_SOURCE_DIR;
  EXPECT_GT(accepted_in(root / "hamiltonians"), 15);
  EXPECT_GT(accepted_in(root / "tests/fuzz/corpus"), 7);
  accepted_in(root / "tests/diagnostics");
}

TEST(Fuzz, TextsByTheGrammarAreAcceptedOrRefused) {
  constexpr int texts = 2000;
  int accepted = 0;
  for (int seed = 0; seed < texts; ++seed) {
    try {
      if (check_input(random_text(static_cast<std::uint64_t>(seed))) == Answer::accepted) {
        ++accepted;
      }
    } catch (const std::exception& error) {
      ADD_FAILURE() << "seed " << seed << ": " << error.what();
    }
  }
  // What is refused is refused early: enough of them must get to the end.
  EXPECT_GT(accepted, texts / 5);
  EXPECT_LT(accepted, texts * 4 / 5);
}

}  // namespace
}  // namespace hamgen::fuzz
