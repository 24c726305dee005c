// What the installation makes of the command's own definition.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "runtime/process.hpp"
#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

namespace fs = std::filesystem;

// What bash proposes for the last of these words.
std::vector<std::string> completed(const std::vector<std::string>& typed) {
  const fs::path path = fs::temp_directory_path() / "hamgen_completion_test.bash";
  std::ofstream file(path);
  file << hamgen({"completion", "bash"}).out << "COMP_WORDS=(hamgen";
  for (const std::string& word : typed) file << " '" << word << "'";
  file << ")\nCOMP_CWORD=" << typed.size() << "\n_hamgen\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
  file.close();
  const runtime::ProcessResult result = runtime::run_process({.command = {"bash", path.string()}});
  fs::remove(path);
  EXPECT_TRUE(result.succeeded()) << result.output;
  return lines(result.output);
}

TEST(Completion, ProposesCommandsOptionsAndNames) {
  EXPECT_EQ(completed({"che"}), std::vector<std::string>{"check"});
  EXPECT_EQ(completed({"help", "tun"}), std::vector<std::string>{"tune"});
  EXPECT_EQ(completed({"generate", "a.ham", "--watch"}),
            std::vector<std::string>{"--watch-modified"});
  EXPECT_EQ(completed({"run", "a.ham", "--scheme", "gauss-1"}),
            (std::vector<std::string>{"gauss-10", "gauss-12", "gauss-14", "gauss-16"}));
  EXPECT_EQ(completed({"run", "a.ham", "--scheme", "=", "stormer"}),
            std::vector<std::string>{"stormer-verlet"});
  EXPECT_EQ(hamgen({"completion", "fish"}).status, 2);
}

TEST(Completion, AndManualNameEveryCommandAndNoHiddenOne) {
  const std::string help = hamgen({"--help"}).out;
  const std::string manual = hamgen({"man"}).out;
  const std::string zsh = hamgen({"completion", "zsh"}).out;
  EXPECT_FALSE(contains(help, "completion"));
  for (const char* command : {"new", "check", "run", "section", "cache"}) {
    EXPECT_TRUE(contains(manual, std::string(".SS hamgen ") + command + "\n")) << command;
    EXPECT_TRUE(contains(zsh, std::string("    '") + command + ":")) << command;
  }
  EXPECT_TRUE(contains(manual, "\\-\\-watch\\-modified K\n")) << manual;
  EXPECT_FALSE(contains(manual, ".SS hamgen man"));
}

}  // namespace
}  // namespace hamgen::app_test
