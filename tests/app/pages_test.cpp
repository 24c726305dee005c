// Every command of README and docs/ is run, and what it prints is what the page shows.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/page_examples.hpp"

namespace hamgen::app_test {
namespace {

const std::string docs = HAMGEN_SOURCE_DIR "/docs/";

std::string path_of(const std::string& page) {
  return page == "README.md" ? HAMGEN_SOURCE_DIR "/README.md" : docs + page;
}

// The pages with tests of their own in readme_test.cpp.
const std::set<std::string> with_own_tests = {"plugin.md"};
// The others with commands, and how many at least.
const std::map<std::string, std::size_t> pages = {
    {"batch.md", 3},     {"certificates.md", 3},   {"command.md", 4},      {"ensemble.md", 4},
    {"gallery.md", 12},  {"README.md", 10},        {"scaling.md", 2},      {"studies.md", 9},
    {"tutorial.md", 14}, {"specialisation.md", 2}, {"verification.md", 12}};

TEST(Pages, WithCommandsAreAllRun) {
  for (const auto& entry : std::filesystem::directory_iterator(docs)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".md" || with_own_tests.contains(name)) continue;
    const std::size_t commands = number_of_commands(entry.path().string());
    EXPECT_EQ(commands > 0, pages.contains(name)) << name;
    if (pages.contains(name)) EXPECT_GE(commands, pages.at(name)) << name;
  }
}

// A block with a command that is not run is the synopsis of one, with MODEL or FILE in it, or one
// of these: of days, of many machines, of a run that is interrupted (which other tests do).
TEST(Pages, HaveNoCommandThatIsOnlyShown) {
  const std::set<std::string> known = {
      "hamgen run hamiltonians/pendulum.ham --steps 1e11 --every 1e6 -o pendulum.csv --checkpoint "
      "pendulum.checkpoint",
      "$ hamgen ensemble pendulum.ham --over q=0:3:10000 --seed 3 --random 'p=normal(0,1)' -o "
      "x.csv --resume"};
  std::vector<std::string> all;
  for (const auto& [name, commands] : pages) all.push_back(path_of(name));
  for (const std::string& page : all) {
    for (const SilentBlock& block : silent_blocks(page)) {
      const bool is_synopsis = contains(block.first, " MODEL") || contains(block.first, " FILE");
      EXPECT_TRUE(is_synopsis || known.contains(block.first)) << page << ": " << block.first;
    }
  }
}

// "Runs of days" is "runs-of-days".
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    if (c >= 'A' && c <= 'Z') anchor += static_cast<char>(c - 'A' + 'a');
    if (is_letter) anchor += c;
    if (c == ' ') anchor += '-';
  }
  return anchor;
}

// The lines of a page outside its blocks.
std::vector<std::string> prose(const std::string& page) {
  std::vector<std::string> result;
  bool inside = false;
  for (const std::string& line : lines(read(page))) {
    const std::size_t first = line.find_first_not_of(' ');
    if (first != std::string::npos && line.compare(first, 3, "```") == 0) {
      inside = !inside;
    } else if (!inside) {
      result.push_back(line);
    }
  }
  return result;
}

TEST(Pages, LinkToWhatIsThere) {
  std::vector<std::filesystem::path> all = {HAMGEN_SOURCE_DIR "/README.md"};
  for (const auto& entry : std::filesystem::directory_iterator(docs)) {
    if (entry.path().extension() == ".md") all.push_back(entry.path());
  }
  const std::regex link(R"re((\]\(|src=")([^)" #]*)(#[^)"]*)?[)"])re");
  std::size_t links = 0;
  for (const auto& page : all) {
    for (const std::string& line : prose(page.string())) {
      for (std::sregex_iterator it(line.begin(), line.end(), link), end; it != end; ++it) {
        const std::string target = (*it)[2];
        if (target.starts_with("http")) continue;
        const std::filesystem::path file = target.empty() ? page : page.parent_path() / target;
        EXPECT_TRUE(std::filesystem::exists(file)) << page << ": " << it->str();
        ++links;
        if (!(*it)[3].matched || file.extension() != ".md") continue;
        bool found = false;
        for (const std::string& each : prose(file.string()))
          found = found || (each.starts_with("#") &&
                            "#" + anchor_of(each.substr(each.find(' ') + 1)) == (*it)[3]);
        EXPECT_TRUE(found) << page << ": no heading " << it->str();
      }
    }
  }
  EXPECT_GE(links, 100u);
}

// The pictures of the gallery are those that its commands draw.
void expect_pictures(const Scratch& scratch) {
  std::set<std::string> drawn;
  std::set<std::string> shown;
  for (const std::string& name : scratch.names()) {
    if (name.ends_with(".png")) drawn.insert(name);
  }
  for (const auto& entry : std::filesystem::directory_iterator(docs + "gallery")) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with(".png")) continue;
    shown.insert(name);
    EXPECT_TRUE(contains(read(docs + "gallery.md"), "](gallery/" + name + ")")) << name;
  }
  EXPECT_EQ(drawn, shown);
}

class PagesLong : public testing::TestWithParam<std::string> {};

TEST_P(PagesLong, ShowWhatTheCommandsPrint) {
  const std::string page = path_of(GetParam());
  const Scratch scratch;
  lay_out(page, scratch);
  if (GetParam() == "tutorial.md") scratch.write("galaxy.ham", read(docs + "tutorial/galaxy.ham"));
  expect_page_is_true(page, scratch.path("."), 0);
  expect_commands_work(page, scratch.path("."));
  if (GetParam() == "gallery.md") expect_pictures(scratch);
}

std::vector<std::string> names_of_pages() {
  std::vector<std::string> names;
  for (const auto& [name, commands] : pages) names.push_back(name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Docs, PagesLong, testing::ValuesIn(names_of_pages()),
                         [](const auto& info) {
                           return info.param.substr(0, info.param.find('.'));
                         });

}  // namespace
}  // namespace hamgen::app_test
