// The examples of docs/language.md do what the text beside them says.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "generator/language/read_model.hpp"

namespace hamgen {
namespace {

struct Block {
  std::string language;  // "ham", "ham-error", "text"
  std::string text;
};

std::vector<Block> blocks_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<Block> blocks;
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) blocks.push_back({.language = line.substr(3), .text = {}});
    } else if (inside) {
      blocks.back().text += line + "\n";
    }
  }
  return blocks;
}

std::string said_of(const std::string& text) {
  try {
    const Model model = read_model(make_source("example.ham", text));
    // What is accepted can be printed and read again.
    const std::string printed = to_text(model);
    EXPECT_EQ(to_text(read_model(make_source("printed.ham", printed))), printed);
    return render(model.warnings, model.source);
  } catch (const ModelError& error) {
    return error.what();
  }
}

TEST(Documentation, every_example_is_accepted_or_refused_as_it_says) {
  const std::vector<Block> blocks = blocks_of(HAMGEN_SOURCE_DIR "/docs/language.md");
  EXPECT_GT(blocks.size(), 10U);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (blocks[i].language == "ham") {
      EXPECT_EQ(said_of(blocks[i].text), "") << blocks[i].text;
    } else if (blocks[i].language == "ham-error") {
      ASSERT_LT(i + 1, blocks.size());
      EXPECT_EQ(blocks[i + 1].language, "text");
      EXPECT_EQ(said_of(blocks[i].text), blocks[i + 1].text) << blocks[i].text;
    }
  }
}

}  // namespace
}  // namespace hamgen
