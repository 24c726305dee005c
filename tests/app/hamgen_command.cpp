#include "tests/app/hamgen_command.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

extern char** environ;

namespace hamgen::app_test {
namespace {

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> result;
  for (std::string& word : words) result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

// Where the output of a program goes, and what it is run in.
struct Surroundings {
  std::string out = "/dev/null";
  std::string err = "/dev/null";
  std::string working_directory = ".";
  std::vector<std::string> variables;
};

std::vector<std::string> variables_with(const std::vector<std::string>& environment) {
  std::vector<std::string> variables = environment;  // the first of two equal names counts
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view variable = *entry;
    const std::string_view name = variable.substr(0, variable.find('=') + 1);
    if (std::ranges::none_of(environment, [&](const auto& set) { return set.starts_with(name); }))
      variables.emplace_back(variable);
  }
  return variables;
}

pid_t start(std::vector<std::string> words, Surroundings where) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, where.out.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, where.err.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0600);
  posix_spawn_file_actions_addchdir_np(&actions, where.working_directory.c_str());
  pid_t child = 0;
  const int failure = posix_spawn(&child, words.front().c_str(), &actions, nullptr,
                                  pointers(words).data(), pointers(where.variables).data());
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) throw std::runtime_error("cannot start " + words.front());
  return child;
}

// Its exit status, or 128 + signal.
int end_of(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::vector<std::string> hamgen_words(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {HAMGEN_EXECUTABLE};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

Result run(const std::vector<std::string>& words, const std::vector<std::string>& environment,
           const std::string& working_directory) {
  const Scratch scratch;
  const std::string out = scratch.path("out");
  const std::string err = scratch.path("err");
  const int status = end_of(start(words, {.out = out,
                                          .err = err,
                                          .working_directory = working_directory,
                                          .variables = variables_with(environment)}));
  return {status, read(out), read(err)};
}

}  // namespace

Result hamgen(const std::vector<std::string>& arguments,
              const std::vector<std::string>& environment, const std::string& working_directory) {
  return run(hamgen_words(arguments), environment, working_directory);
}

int status_of(const std::vector<std::string>& words, const std::string& err) {
  return end_of(start(words, {.err = err, .variables = variables_with({})}));
}

int status_if_killed(const std::vector<std::string>& arguments, std::chrono::microseconds after) {
  const pid_t child = start(hamgen_words(arguments), {.variables = variables_with({})});
  std::this_thread::sleep_for(after);
  ::kill(child, SIGKILL);
  return end_of(child);
}

Result shell(const std::string& command, const std::string& working_directory) {
  const char* const path = std::getenv("PATH");
  const std::string folder = std::filesystem::path(HAMGEN_EXECUTABLE).parent_path().string();
  return run({"/bin/sh", "-c", command},
             {"PATH=" + folder + ":" + (path != nullptr ? path : "/usr/bin:/bin")},
             working_directory);
}

Scratch::Scratch() {
  std::string name = (std::filesystem::temp_directory_path() / "hamgen-app-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot create " + name);
  directory_ = name;
}

Scratch::~Scratch() {
  std::error_code ignored;
  std::filesystem::remove_all(directory_, ignored);
}

std::string Scratch::path(std::string_view name) const { return (directory_ / name).string(); }

std::string Scratch::write(std::string_view name, std::string_view text) const {
  std::ofstream(path(name), std::ios::binary) << text;
  return path(name);
}

std::vector<std::string> Scratch::names() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(directory_))
    names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

}  // namespace hamgen::app_test
