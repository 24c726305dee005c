#include "benchmarks/cost/command_cost.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

namespace hamgen::cost_table {

namespace {

[[noreturn]] void become(const std::string& hamgen, const std::vector<std::string>& words,
                         long limit, int output) {
  std::vector<char*> arguments{const_cast<char*>(hamgen.c_str())};
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const rlimit time{static_cast<rlim_t>(limit), static_cast<rlim_t>(limit)};
  setrlimit(RLIMIT_CPU, &time);
  dup2(output, STDOUT_FILENO);
  dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
  execv(hamgen.c_str(), arguments.data());
  _exit(127);
}

}  // namespace

CommandCost run_command(const std::string& hamgen, const std::vector<std::string>& words,
                        long limit) {
  CommandCost cost{.status = -1};
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return cost;
  const pid_t child = fork();
  if (child == 0) become(hamgen, words, limit, ends[1]);
  close(ends[1]);
  std::array<char, 65536> buffer{};
  for (ssize_t count = 0; (count = read(ends[0], buffer.data(), buffer.size())) > 0;) {
    cost.output_bytes += count;
  }
  close(ends[0]);
  int status = 0;
  rusage usage{};
  if (child < 0 || wait4(child, &status, 0, &usage) != child) return cost;
  if (WIFEXITED(status)) cost.status = WEXITSTATUS(status);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  cost.seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  cost.megabytes = usage.ru_maxrss / 1024;
  return cost;
}

}  // namespace hamgen::cost_table
