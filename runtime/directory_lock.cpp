#include "runtime/directory_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <cerrno>

#include "runtime/tool_error.hpp"

namespace hamgen::runtime {

DirectoryLock::DirectoryLock(const std::filesystem::path& directory)
    : file_(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (!file_.is_open()) throw file_error("open", directory, errno);
  if (::flock(file_.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw ToolError(
        {.message = fmt::format("another process is working on '{}'", directory.string())});
}

}  // namespace hamgen::runtime
