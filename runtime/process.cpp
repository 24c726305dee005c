#include "runtime/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <system_error>
#include <thread>

#include "runtime/file_descriptor.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::runtime {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void throw_not_started(const ProcessRequest& request, int error_number) {
  throw ToolError({.message = fmt::format("cannot run '{}': {}", request.command.front(),
                                          std::generic_category().message(error_number)),
                   .command = command_text(request.command)});
}

int reap(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

void set_limit(int resource, std::uint64_t most) {
  const auto kind = static_cast<__rlimit_resource>(resource);
  rlimit limits{};
  if (::getrlimit(kind, &limits) != 0) return;
  limits.rlim_max = std::min<rlim_t>(limits.rlim_max, most);
  limits.rlim_cur = std::min<rlim_t>(limits.rlim_cur, most);
  ::setrlimit(kind, &limits);
}

// What the child does between fork and exec: functions that are safe there only.  It leads a
// process group of its own, so that its children can be killed with it, and starts with the default
// signals whatever this process ignores or blocks.  Returns where it cannot go on.
void become(const ProcessRequest& request, char* const* arguments, int output) {
  ::setpgid(0, 0);
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXFSZ, SIGXCPU})
    ::signal(signal_number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  // Above the three that are about to be replaced, as they may be closed here.
  output = ::fcntl(output, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  const int input = ::open("/dev/null", O_RDONLY);
  if (input < 0 || ::dup2(input, STDIN_FILENO) < 0 || ::dup2(output, STDOUT_FILENO) < 0 ||
      ::dup2(output, STDERR_FILENO) < 0)
    return;
  if (input > STDERR_FILENO) ::close(input);
  if (!request.working_directory.empty() && ::chdir(request.working_directory.c_str()) != 0) return;
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(request.time_limit).count();
  set_limit(RLIMIT_CPU, static_cast<std::uint64_t>(std::max<long long>(seconds, 1)));
  if (request.memory_limit > 0) set_limit(RLIMIT_AS, request.memory_limit);
  ::execvp(arguments[0], arguments);
}

pid_t start(const ProcessRequest& request, int output) {
  std::vector<std::string> words = request.command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::array<int, 2> ends{};  // exec closes the writing end, or the reason comes through it
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw_not_started(request, errno);
  const FileDescriptor reading(ends[0]);
  FileDescriptor writing(ends[1]);
  const pid_t child = ::fork();
  if (child < 0) throw_not_started(request, errno);
  if (child == 0) {
    const int report = ::fcntl(writing.get(), F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    become(request, arguments.data(), output);
    const int reason = errno;
    static_cast<void>(::write(report, &reason, sizeof reason) + 1);
    ::_exit(127);
  }
  writing.close();
  int reason = 0;
  ssize_t count = 0;
  do {
    count = ::read(reading.get(), &reason, sizeof reason);
  } while (count < 0 && errno == EINTR);
  if (count == 0) return child;
  reap(child);
  throw_not_started(request, reason);
}

// Reads what there is; false at the end of the stream.
bool read_some(int pipe, std::size_t limit, std::string& output) {
  std::array<char, 16384> buffer;
  const ssize_t count = ::read(pipe, buffer.data(), buffer.size());
  if (count < 0) return errno == EINTR || errno == EAGAIN;
  output.append(buffer.data(), static_cast<std::size_t>(count));
  // Drops the oldest bytes, now and then rather than at every read.
  if (output.size() > 2 * limit + buffer.size()) output.erase(0, output.size() - limit);
  return count > 0;
}

// True once the child has ended; it stays a zombie, so that its group's number is not given to
// others before the group is killed.
bool has_ended(pid_t child) {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == child;
}

}  // namespace

ProcessResult run_process(const ProcessRequest& request) {
  if (request.command.empty() || request.command.front().empty()) {
    throw ToolError({.message = "no program to run was named"});
  }
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw_not_started(request, errno);
  const FileDescriptor reading(ends[0]);
  FileDescriptor writing(ends[1]);
  fcntl(reading.get(), F_SETFL, O_NONBLOCK);

  const Clock::time_point begin = Clock::now();
  const pid_t child = start(request, writing.get());
  writing.close();

  ProcessResult result;
  bool stream_open = true;
  bool ended = false;
  while (!ended) {
    const auto left = request.time_limit - (Clock::now() - begin);
    if (left <= Clock::duration::zero()) {
      result.end = ProcessEnd::timed_out;
      break;
    }
    if (request.stop != nullptr && request.stop->load(std::memory_order_relaxed)) {
      result.end = ProcessEnd::stopped;
      break;
    }
    if (stream_open) {
      // Wakes up on output; a child that ends while a grandchild holds the pipe is seen by time.
      const auto wait = std::min<std::chrono::milliseconds>(
          std::chrono::ceil<std::chrono::milliseconds>(left), std::chrono::milliseconds(50));
      pollfd waiting{.fd = reading.get(), .events = POLLIN, .revents = 0};
      if (poll(&waiting, 1, static_cast<int>(wait.count())) > 0) {
        stream_open = read_some(reading.get(), request.output_limit, result.output);
        if (stream_open) continue;
      }
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ended = has_ended(child);
  }
  kill(-child, SIGKILL);
  const int status = reap(child);
  // What was written before the end and not yet read; at most one pipe full.
  for (int i = 0; i < 64 && stream_open; ++i) {
    pollfd waiting{.fd = reading.get(), .events = POLLIN, .revents = 0};
    if (poll(&waiting, 1, 0) <= 0) break;
    stream_open = read_some(reading.get(), request.output_limit, result.output);
  }
  if (result.output.size() > request.output_limit) {
    result.output.erase(0, result.output.size() - request.output_limit);
  }
  if (ended && WIFSIGNALED(status)) result.end = ProcessEnd::signalled;
  result.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
  result.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return result;
}

std::string end_text(const ProcessResult& result, const ProcessRequest& request) {
  switch (result.end) {
    case ProcessEnd::exited:
      return fmt::format("exit status {}", result.code);
    case ProcessEnd::signalled:
      return fmt::format("killed by signal {} ({})", result.code, strsignal(result.code));
    case ProcessEnd::timed_out:
      return fmt::format("not finished after {} s",
                         std::chrono::duration<double>(request.time_limit).count());
    case ProcessEnd::stopped:
      return "stopped on request";
  }
  return {};
}

}  // namespace hamgen::runtime
