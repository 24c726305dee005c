// Every command of README and docs/ is run, and what it prints is what the page shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

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
    if (pages.contains(name)) {
      EXPECT_GE(commands, pages.at(name)) << name;
    }
  }
}

// The blocks that these tests do not run, each with what looks at it.
const std::map<std::string, std::string> looked_at_elsewhere = {
    {"README.md:   for (int iteration = 1;; ++iteration) {", "app/readme_test.cpp"},
    {"README.md: scripts/quickstart", "app/pages_test.cpp"},
    {"README.md: sudo apt-get install cmake ninja-build g++ pkg-config libginac-dev libfmt-dev "
     "libcli11-dev \\",
     "app/pages_test.cpp"},
    {"README.md: find_package(hamgen CONFIG REQUIRED)", "consumer/page.cmake"},
    {"runtime.md: find_package(hamgen 0.1 CONFIG REQUIRED COMPONENTS runtime)",
     "consumer/page.cmake"},
    {"runtime.md: // orbit MODEL: loads a Kepler problem, prints its periods, and stops where the "
     "bodies collide.",
     "app/load_test.cpp"},
    {"runtime.md: kepler by gauss-8, order 8", "consumer/pkg_config.cmake"},
    {"plugin.md: /* A Kepler ellipse by an emitted plugin, in C: what it is, its period, then a "
     "smaller step. */",
     "app/readme_test.cpp"},
    {"plugin.md: \"\"\"A Kepler ellipse by an emitted plugin, with the standard library of Python "
     "alone.\"\"\"",
     "app/readme_test.cpp"},
    {"emitted-code.md: #include <cstdio>", "emitted/documentation_test.cpp"},
    {"emitted-code.md: #include \"midpoint/fput.hpp\"  // hamgen generate fput.ham -o midpoint",
     "emitted/documentation_test.cpp"},
    {"emitted-code.md: #include <cmath>", "emitted/documentation_test.cpp"},
    {"emitted-code.md: #include <stdio.h>", "emitted/documentation_test.cpp"},
    {"extending.md: // yoshida-4 three times, of sizes c, 1 - 2c, c with 2 c^5 + (1 - 2c)^5 = 0.",
     "app/extending_page_test.cpp"},
    {"emitted-code.md: #include \"pendulum.cl\"", "emitted/documentation_test.cpp"},
    {"extending.md:     CFamily{.format = \"opencl-header\",", "app/extending_page_test.cpp"},
    {"extending.md:     NamedFormat{\"opencl-header\", \"the functions of a c-header for kernels "
     "in "
     "OpenCL C\",",
     "app/extending_page_test.cpp"},
    {"extending.md: OutputFiles meson_package(const Program& program, const EmitOptions& options) "
     "{",
     "app/extending_page_test.cpp"},
    {"extending.md:     NamedFormat{\"meson-package\", \"the header as a Meson project with a "
     "dependency\", meson_package},",
     "app/extending_page_test.cpp"},
    {"extending.md:     {.name = \"expm1\",", "app/extending_page_test.cpp"},
    {"extending.md: // When to stop a fixed point: where an increment is nothing, or no smaller "
     "than the "
     "one before, as",
     "app/extending_page_test.cpp"},
    {"extending.md:     NamedSolver{\"stagnation\", \"iterates until increments no longer fall; no "
     "Hessian\",",
     "app/extending_page_test.cpp"},
    // Of days, of many machines, of a run that is interrupted: with other numbers there.
    {"command.md: hamgen run hamiltonians/pendulum.ham --steps 1e11 --every 1e6 -o pendulum.csv "
     "--checkpoint pendulum.checkpoint",
     "app/checkpoint_test.cpp"},
    {"ensemble.md: $ hamgen ensemble pendulum.ham --over q=0:3:10000 --seed 3 --random "
     "'p=normal(0,1)' -o x.csv --resume",
     "app/ensemble_resume_test.cpp"},
    {"ensemble.md: mpirun -n 4 hamgen-mpi ensemble hamiltonians/henon_heiles.ham --over "
     "q2=-0.4:0.6:400,p2=-0.4:0.4:400 --steps 2000 -o map.csv",
     "app/ensemble_mpi_test.cpp"}};

// The options of the synopsis of a command are those of its help.
void expect_synopsis(const PageBlock& block) {
  const std::string text = block.text();
  std::istringstream stream(text);
  std::string word;
  std::string command;
  stream >> word >> command;
  const std::string help = hamgen({command, "--help"}).out;
  const std::regex option("--[a-z][a-z-]*");
  for (std::sregex_iterator it(text.begin(), text.end(), option), end; it != end; ++it)
    EXPECT_TRUE(contains(help, it->str())) << command << ": " << it->str();
}

bool is_system(const PageBlock& block) {
  return std::ranges::any_of(block.lines,
                             [](const std::string& line) { return line.starts_with("system "); });
}

// What is not run, a model, the synopsis of a command or a program that a command of the page
// compiles, is looked at by another test.
void expect_looked_at(const std::string& page, const PageBlock& block,
                      std::set<std::string>& seen) {
  const std::string first = block.first();
  const bool is_program = block.mark == "cpp" && contains(block.text(), "int main()");
  if (block.mark == "console" || block.mark == "sh") {
    EXPECT_TRUE(pages.contains(page) || with_own_tests.contains(page)) << page << ": " << first;
  } else if (page == "language.md") {  // language/documentation_test.cpp
    EXPECT_TRUE(block.mark == "ham" || block.mark == "ham-error" || block.mark == "text") << first;
  } else if (block.mark == "ham" && is_system(block)) {
    const Scratch scratch;
    const Result result = hamgen({"check", scratch.write("m.ham", block.text())});
    EXPECT_EQ(result.status, 0) << page << '\n' << result.err;
  } else if (first.starts_with("hamgen ") &&
             (contains(first, " MODEL") || contains(first, " FILE.csv"))) {
    expect_synopsis(block);
  } else if (!looked_at_elsewhere.contains(page + ": " + first)) {
    EXPECT_TRUE(is_program && pages.contains(page)) << page << " [" << block.mark << "]: " << first;
  } else {
    seen.insert(page + ": " + first);
  }
}

TEST(Pages, HaveNoBlockThatNobodyLooksAt) {
  std::set<std::string> seen;
  std::vector<std::string> names = {"README.md"};
  for (const auto& entry : std::filesystem::directory_iterator(docs)) {
    if (entry.path().extension() == ".md") names.push_back(entry.path().filename().string());
  }
  for (const std::string& page : names) {
    for (const PageBlock& block : blocks_of_page(path_of(page)))
      expect_looked_at(page, block, seen);
  }
  for (const auto& [block, test] : looked_at_elsewhere) {
    EXPECT_TRUE(seen.contains(block)) << block;
    EXPECT_TRUE(std::filesystem::exists(HAMGEN_SOURCE_DIR "/tests/" + test)) << test;
  }
}

// The packages that the page names for a build by hand are those that the script installs.
TEST(Pages, NameThePackagesThatAreInstalled) {
  const std::string script = read(HAMGEN_SOURCE_DIR "/scripts/install-dependencies");
  const std::size_t begin = script.find("packages=(") + 10;
  const std::string installed = " " + script.substr(begin, script.find(')', begin) - begin) + " ";
  const std::string page = read(HAMGEN_SOURCE_DIR "/README.md");
  const std::size_t from = page.find("sudo apt-get install ") + 21;
  std::istringstream named(page.substr(from, page.find("cmake --preset", from) - from));
  std::size_t count = 0;
  for (std::string word; named >> word;) {
    if (word == "\\") continue;
    ++count;
    EXPECT_TRUE(contains(std::regex_replace(installed, std::regex("\\s"), " "), " " + word + " "))
        << word;
  }
  EXPECT_GE(count, 10u);
  EXPECT_TRUE(std::filesystem::exists(HAMGEN_SOURCE_DIR "/scripts/quickstart"));
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
                         [](const auto& instance) {
                           return instance.param.substr(0, instance.param.find('.'));
                         });

}  // namespace
}  // namespace hamgen::app_test
