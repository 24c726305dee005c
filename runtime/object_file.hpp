// What a shared object must be before it is mapped.
#pragma once

#include <filesystem>
#include <string>

namespace hamgen::runtime {

// Why the file is no whole shared object of this machine; empty if it is one.  The dynamic linker
// maps what the file's tables say without asking how long it is: behind its end is a SIGBUS.
[[nodiscard]] std::string object_problem(const std::filesystem::path& object);

}  // namespace hamgen::runtime
