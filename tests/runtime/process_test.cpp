#include "runtime/process.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <thread>

#include "runtime/tool_error.hpp"
#include "tests/runtime/oscillator.hpp"

namespace hamgen::runtime {
namespace {

using std::chrono::milliseconds;

TEST(Process, HandsOverWordsAsTheyAre) {
  const ProcessResult result =
      run_process({.command = {"printf", "[%s]", "a b", "$HOME", "; rm x"}});
  EXPECT_TRUE(result.succeeded());
  EXPECT_EQ(result.output, "[a b][$HOME][; rm x]");
}

TEST(CommandText, IsReadBackByAShellAndHasNoControlCharacter) {
  std::string bytes;
  for (int byte = 1; byte < 256; ++byte) bytes += static_cast<char>(byte);
  for (const std::string& word : {bytes, std::string("a b"), std::string("it's"), std::string(),
                                  std::string("\n7"), std::string("\\\r'$(id)`id`")}) {
    const std::string text = command_text(std::vector<std::string>{"printf", "%s", word});
    for (const char c : text) EXPECT_FALSE(static_cast<unsigned char>(c) < 0x20 || c == 0x7F);
    EXPECT_EQ(run_process({.command = {"bash", "-c", text}}).output, word) << text;
  }
}

TEST(Process, KeepsBothStreamsInOrderAndTheExitStatus) {
  const ProcessResult result =
      run_process({.command = {"sh", "-c", "echo out; echo err >&2; echo out; exit 7"}});
  EXPECT_EQ(result.end, ProcessEnd::exited);
  EXPECT_EQ(result.code, 7);
  EXPECT_EQ(result.output, "out\nerr\nout\n");
}

TEST(Process, KeepsTheLastBytesOfALongOutput) {
  const ProcessResult result =
      run_process({.command = {"sh", "-c", "yes 0123456789 | head -n 200000; echo the end"},
                   .output_limit = 1000});
  EXPECT_EQ(result.output.size(), 1000u);
  EXPECT_TRUE(result.output.ends_with("0123456789\nthe end\n"));
}

TEST(Process, NamesASignal) {
  const ProcessRequest request{.command = {"sh", "-c", "kill -SEGV $$"}};
  const ProcessResult result = run_process(request);
  EXPECT_EQ(result.end, ProcessEnd::signalled);
  EXPECT_EQ(end_text(result, request), "killed by signal 11 (Segmentation fault)");
}

TEST(Process, IsKilledWithItsChildrenAtTheTimeLimit) {
  const TemporaryDirectory directory = private_directory();
  const ProcessRequest request{.command = {"sh", "-c", "sleep 60 & echo $!; wait"},
                               .time_limit = milliseconds(300)};
  const ProcessResult result = run_process(request);
  EXPECT_EQ(result.end, ProcessEnd::timed_out);
  EXPECT_LT(result.seconds, 10.0);
  EXPECT_EQ(end_text(result, request), "not finished after 0.3 s");
  // The grandchild is gone, or a zombie waiting for its new parent.
  const pid_t grandchild = std::stoi(result.output);
  const std::string status = "/proc/" + std::to_string(grandchild) + "/status";
  for (int i = 0; i < 100; ++i) {
    const std::string text = tests::text_of(status);
    if (text.empty() || text.find("State:\tZ") != std::string::npos) return;
    std::this_thread::sleep_for(milliseconds(20));
  }
  FAIL() << "the child of the child still runs:\n" << tests::text_of(status);
}

TEST(Process, DoesNotWaitForAnHeirOfItsOutput) {
  const ProcessResult result = run_process(
      {.command = {"sh", "-c", "sleep 60 & echo done"}, .time_limit = milliseconds(20000)});
  EXPECT_TRUE(result.succeeded());
  EXPECT_EQ(result.output, "done\n");
  EXPECT_LT(result.seconds, 10.0);
}

TEST(Process, MayCloseItsOutputEarly) {
  const ProcessResult result =
      run_process({.command = {"sh", "-c", "exec >&- 2>&-; sleep 0.1; exit 3"}});
  EXPECT_EQ(result.code, 3);
}

TEST(Process, StopsOnRequest) {
  std::atomic<bool> stop = false;
  std::thread later([&stop] {
    std::this_thread::sleep_for(milliseconds(100));
    stop = true;
  });
  const ProcessResult result = run_process({.command = {"sleep", "60"}, .stop = &stop});
  later.join();
  EXPECT_EQ(result.end, ProcessEnd::stopped);
  EXPECT_LT(result.seconds, 10.0);
}

TEST(Process, HasAnEmptyInput) { EXPECT_TRUE(run_process({.command = {"cat"}}).succeeded()); }

TEST(Process, ThatDoesNotExistIsAToolErrorWithItsName) {
  try {
    (void)run_process({.command = {"/no/such/program", "a b"}});
    FAIL();
  } catch (const ToolError& error) {
    EXPECT_STREQ(error.what(),
                 "cannot run '/no/such/program': No such file or directory\n"
                 "  command: /no/such/program 'a b'");
    EXPECT_FALSE(error.failure().exit_status.has_value());
  }
}

TEST(TailOf, CutsAtALineStart) {
  EXPECT_EQ(tail_of("a\nb\nc\n", 2), "b\nc\n");
  EXPECT_EQ(tail_of("a\nb\nc", 2), "b\nc");
  EXPECT_EQ(tail_of("a\nb\nc\n", 20), "a\nb\nc\n");
  EXPECT_EQ(tail_of("aaaa\nbbbb\ncc\n", 20, 6), "cc\n");
  EXPECT_EQ(tail_of("abcdefgh", 20, 3), "fgh");
}

}  // namespace
}  // namespace hamgen::runtime
