#include "runtime/process.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <thread>

#include "runtime/tool_error.hpp"

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

// Sleeps longer than any test may take: what is said of how such a process ended does not depend
// on how fast the machine is.
const std::string endless = "sleep 3600";

TEST(Process, IsKilledWithItsChildrenAtTheTimeLimit) {
  std::array<int, 2> inherited{};  // by the program and its child
  ASSERT_EQ(::pipe(inherited.data()), 0);
  ProcessRequest request{.command = {"sh", "-c", endless + " & echo child; wait"},
                         .time_limit = milliseconds(300)};
  ProcessResult result = run_process(request);
  // On a busy machine the limit may be over before there is a child.
  for (; result.output.empty(); result = run_process(request)) request.time_limit *= 2;
  EXPECT_EQ(result.end, ProcessEnd::timed_out);
  EXPECT_EQ(result.output, "child\n");
  // The pipe is closed when nobody is left who inherited it, a moment after the signal.
  ::close(inherited[1]);
  pollfd closed{.fd = inherited[0], .events = 0, .revents = 0};
  constexpr int a_minute = 60'000;
  EXPECT_EQ(::poll(&closed, 1, a_minute), 1) << "the child of the child still runs";
  ::close(inherited[0]);
}

TEST(Process, SaysWhichTimeLimitItMet) {
  EXPECT_EQ(end_text({.end = ProcessEnd::timed_out}, {.time_limit = milliseconds(300)}),
            "not finished after 0.3 s");
}

TEST(Process, DoesNotWaitForAnHeirOfItsOutput) {
  const ProcessResult result = run_process({.command = {"sh", "-c", endless + " & echo done"}});
  EXPECT_TRUE(result.succeeded());
  EXPECT_EQ(result.output, "done\n");
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
  const ProcessResult result = run_process({.command = {"sh", "-c", endless}, .stop = &stop});
  later.join();
  EXPECT_EQ(result.end, ProcessEnd::stopped);
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

// Seen by a grandchild that starts once the limit is there.
TEST(Process, LimitsMemoryAndProcessorTimeOfAllItStarts) {
  const std::string wait = "until test \"$(ulimit -t)\" = 77; do :; done; ";
  ProcessRequest request{
      .command = {"sh", "-c",
                  wait + "until test \"$(ulimit -v)\" = 3145728; do :; done; sh -c 'ulimit -t; "
                         "ulimit -v'"},
      .time_limit = std::chrono::seconds(77),
      .memory_limit = std::uint64_t{3} << 30};
  EXPECT_EQ(run_process(request).output, "77\n3145728\n");
  request.memory_limit = 0;
  request.command.back() = wait + "sh -c 'ulimit -v'";
  EXPECT_NE(run_process(request).output, "3145728\n");
}

}  // namespace
}  // namespace hamgen::runtime
