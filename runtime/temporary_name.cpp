#include "runtime/temporary_name.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <random>
#include <system_error>
#include <vector>

namespace hamgen::runtime {
namespace {

namespace fs = std::filesystem;

// Letters and digits of the host's name: a shared directory has the files of several machines.
std::string machine() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) return "host";
  std::string name;
  for (const char c : std::string_view(host.data())) {
    const bool is_word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (is_word && name.size() < 32) name += c;
  }
  return name.empty() ? "host" : name;
}

bool is_ours(const fs::path& path) {
  struct stat info {};
  return ::lstat(path.c_str(), &info) == 0 && info.st_uid == ::geteuid();
}

}  // namespace

std::string process_tag() { return fmt::format("{}-{}-", machine(), ::getpid()); }

bool is_tag_of_the_dead(std::string_view tag) {
  const std::string here = machine() + "-";
  if (!tag.starts_with(here)) return false;
  tag.remove_prefix(here.size());
  long process = 0;
  const auto [end, error] = std::from_chars(tag.data(), tag.data() + tag.size(), process);
  if (error != std::errc() || process <= 1 || end == tag.data() + tag.size() || *end != '-')
    return false;
  return ::kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH;
}

void collect_left_overs(const fs::path& directory, std::string_view prefix) {
  std::vector<fs::path> dead;
  std::error_code failed;
  fs::directory_iterator at(directory.empty() ? "." : directory, failed);
  for (; !failed && at != fs::directory_iterator(); at.increment(failed)) {
    const std::string name = at->path().filename().string();
    if (name.starts_with(prefix) &&
        is_tag_of_the_dead(std::string_view(name).substr(prefix.size())) && is_ours(at->path()))
      dead.push_back(at->path());
  }
  for (const fs::path& path : dead) fs::remove_all(path, failed);
}

fs::path temporary_name(const fs::path& file) {
  // Long names are cut: the temporary name must fit where the target's name fits.
  const std::string prefix = fmt::format(".{}.", file.filename().string().substr(0, 180));
  collect_left_overs(file.parent_path(), prefix);
  std::random_device random;
  for (;;) {
    const fs::path name = file.parent_path() / fmt::format("{}{}{:08x}.tmp", prefix, process_tag(),
                                                           static_cast<unsigned>(random()));
    struct stat info {};
    if (::lstat(name.c_str(), &info) != 0) return name;
  }
}

}  // namespace hamgen::runtime
