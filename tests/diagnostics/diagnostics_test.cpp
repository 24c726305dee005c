// Every x.ham of this folder is wrong (or worth a warning), and x.expected says what is said of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "generator/language/read_model.hpp"

namespace hamgen {
namespace {

const std::filesystem::path root = HAMGEN_SOURCE_DIR;
const std::string folder = "tests/diagnostics/";

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> all_cases() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(root / folder)) {
    if (entry.path().extension() == ".ham") names.push_back(entry.path().stem());
  }
  std::ranges::sort(names);
  return names;
}

// What the user sees, with the path relative to the project.
std::string said_of(const std::string& name) {
  const SourceText source =
      make_source(folder + name + ".ham", read_text(root / folder / (name + ".ham")));
  try {
    return render(read_model(source).warnings, source);
  } catch (const ModelError& error) {
    return error.what();
  }
}

class Diagnostics : public testing::TestWithParam<std::string> {};

TEST_P(Diagnostics, are_as_expected) {
  const std::filesystem::path expected = root / folder / (GetParam() + ".expected");
  const std::string said = said_of(GetParam());
  EXPECT_FALSE(said.empty()) << "nothing is wrong with this file";
  if (std::getenv("HAMGEN_UPDATE_EXPECTED") != nullptr) std::ofstream(expected) << said;
  EXPECT_EQ(said, read_text(expected))
      << "if the new text is right, run this test with HAMGEN_UPDATE_EXPECTED=1";
}

INSTANTIATE_TEST_SUITE_P(Corpus, Diagnostics, testing::ValuesIn(all_cases()),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace hamgen
