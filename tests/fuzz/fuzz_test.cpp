// The language on inputs that nobody wrote: see scripts/fuzz for more of them, with sanitizers,
// which the full tier has.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/fuzz/check_input.hpp"
#include "tests/fuzz/grammar.hpp"
#include "tests/fuzz/mutant.hpp"

namespace hamgen::fuzz {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// In the order of their names, which the folder does not have everywhere.
std::vector<std::string> texts_of(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<std::string> texts;
  for (const fs::path& file : files) {
    if (std::string text = content(file); !text.empty()) texts.push_back(std::move(text));
  }
  return texts;
}

// "word" in each line but those of remarks.
std::vector<std::string> words_of(const fs::path& dictionary) {
  std::ifstream file(dictionary);
  std::vector<std::string> words;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('"') && line.size() > 2) words.push_back(line.substr(1, line.size() - 2));
  }
  return words;
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

TEST(Fuzz, MutantsOfTheCorpusAreAcceptedOrRefused) {
  const fs::path root = HAMGEN_SOURCE_DIR;
  std::vector<std::string> texts;
  for (const char* folder : {"hamiltonians", "tests/diagnostics", "tests/fuzz/corpus"}) {
    std::ranges::move(texts_of(root / folder), std::back_inserter(texts));
  }
  const std::vector<std::string> words = words_of(root / "tests/fuzz/words.dict");
  ASSERT_GT(texts.size(), 30U);
  ASSERT_GT(words.size(), 30U);
  constexpr int mutants = 8000;
  int accepted = 0;
  Random random(1);
  for (int i = 0; i < mutants; ++i) {
    const std::string text = mutant(texts, words, random);
    try {
      if (check_input(text) == Answer::accepted) ++accepted;
    } catch (const std::exception& error) {
      ADD_FAILURE() << "mutant " << i << ": " << error.what() << "\n" << text;
    }
  }
  EXPECT_GT(accepted, mutants / 100);
  EXPECT_LT(accepted, mutants / 2);
}

}  // namespace
}  // namespace hamgen::fuzz
