// Signals end a run in good order, with all its rows.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

extern char** environ;

namespace hamgen::app_test {
namespace {

// A run of hours, from when it has begun to write its trajectory.
class LongRun {
 public:
  explicit LongRun(const Scratch& scratch)
      : LongRun(scratch, {"run", scratch.write("pendulum.ham", pendulum), "--quiet", "--steps",
                          "1e13", "--every", "100000", "-o", scratch.path("x.csv")}) {
    while (scratch.names().size() < 3) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  // Any command that takes as long, from its beginning.
  LongRun(const Scratch& scratch, std::vector<std::string> words) {
    words.insert(words.begin(), HAMGEN_EXECUTABLE);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const std::string err = scratch.path("err");
    posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT, 0600);
    EXPECT_EQ(
        posix_spawn(&process_, HAMGEN_EXECUTABLE, &actions, nullptr, arguments.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
  }
  LongRun(const LongRun&) = delete;
  LongRun& operator=(const LongRun&) = delete;
  ~LongRun() {
    if (process_ > 0) ::kill(process_, SIGKILL);
    if (process_ > 0) static_cast<void>(status());
  }

  void send(int signal) const { ::kill(process_, signal); }

  // Exit status, or 128 + signal.
  int status() {
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  [[nodiscard]] bool ignores(int signal) const {
    const std::string text = read("/proc/" + std::to_string(process_) + "/status");
    const std::string mask = text.substr(text.find("SigIgn:") + 7, 17);
    return ((std::stoull(mask, nullptr, 16) >> (signal - 1)) & 1) != 0;
  }

 private:
  pid_t process_ = 0;
};

TEST(Signals, EndARunInGoodOrderWithAllItsRows) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU}) {
    const Scratch scratch;
    LongRun run(scratch);
    run.send(signal);
    EXPECT_EQ(run.status(), 130) << signal;
    EXPECT_EQ(scratch.names(), (std::vector<std::string>{"err", "pendulum.ham", "x.csv"}));
    const std::vector<std::string> rows = lines(read(scratch.path("x.csv")));
    ASSERT_FALSE(rows.empty());
    EXPECT_TRUE(rows.back().starts_with("# status    stopped after ")) << rows.back();
  }
}

// The orbit along which the modified Hamiltonian is looked at, too: from when it has been compiled.
TEST(Signals, EndWhatIsVerifiedAlongAnOrbit) {
  const Scratch scratch;
  const std::string cache = scratch.path("cache");
  ::setenv("HAMGEN_CACHE", cache.c_str(), 1);
  LongRun run(scratch, {"verify", scratch.write("pendulum.ham", pendulum), "--terms", "2",
                        "--scene", "swing", "--steps", "1e12"});
  ::unsetenv("HAMGEN_CACHE");
  const auto is_compiled = [&] {
    std::error_code none;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(cache, none))
      if (entry.path().extension() == ".so") return true;
    return false;
  };
  while (!is_compiled()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  run.send(SIGINT);
  EXPECT_EQ(run.status(), 130);
}

// nohup hamgen run ... &
TEST(Signals, ThatWereIgnoredStayIgnored) {
  const Scratch scratch;
  const auto before = ::signal(SIGHUP, SIG_IGN);
  LongRun run(scratch);
  ::signal(SIGHUP, before);
  EXPECT_TRUE(run.ignores(SIGHUP));
  EXPECT_FALSE(run.ignores(SIGTERM));
  run.send(SIGHUP);
  run.send(SIGTERM);
  EXPECT_EQ(run.status(), 130);
}

// A run that was killed leaves a temporary file; the next one to the same target collects it.
TEST(Signals, WhatAKilledRunLeavesIsCollectedByTheNext) {
  const Scratch scratch;
  {
    LongRun run(scratch);
    run.send(SIGKILL);
    EXPECT_EQ(run.status(), 128 + SIGKILL);
  }
  ASSERT_EQ(scratch.names().size(), 3u);
  EXPECT_EQ(hamgen({"run", scratch.path("pendulum.ham"), "--quiet", "--steps", "1", "-o",
                    scratch.path("x.csv")})
                .status,
            0);
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"err", "pendulum.ham", "x.csv"}));
}

// ulimit -f: as a full disk, status 4 and nothing left behind.
TEST(Signals, AFileThatReachesItsLimitIsAnErrorOfWriting) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  ASSERT_EQ(hamgen({"run", model, "--quiet", "--steps", "100000"}).status, 0);  // it is compiled
  rlimit old{};
  ::getrlimit(RLIMIT_FSIZE, &old);
  const rlimit small{.rlim_cur = 20480, .rlim_max = old.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  const Result result =
      hamgen({"run", model, "--quiet", "--steps", "100000", "-o", scratch.path("x.csv")});
  ::setrlimit(RLIMIT_FSIZE, &old);
  EXPECT_EQ(result.status, 4) << result.err;
  EXPECT_TRUE(contains(result.err, "x.csv")) << result.err;
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"pendulum.ham"}));
}

// Ctrl-C while the compiler is at work: a word, and no file.
TEST(Signals, EndACompilation) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string compiler = scratch.write("slow", "#!/bin/sh\nkill -INT $PPID\nexec sleep 60\n");
  std::filesystem::permissions(compiler, std::filesystem::perms::owner_all);
  for (const char* command : {"run", "bench", "certify"}) {
    const Result result = hamgen({command, model, "--compiler", compiler}, {"HAMGEN_CACHE="});
    EXPECT_EQ(result.status, 130) << command << result.err;
    EXPECT_TRUE(contains(result.err, "hamgen: stopped")) << command << result.err;
  }
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"pendulum.ham", "slow"}));
}

}  // namespace
}  // namespace hamgen::app_test
