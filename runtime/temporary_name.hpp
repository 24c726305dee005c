// Names of temporary files that tell whose they are, so that nobody's are collected by the next
// one.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace hamgen::runtime {

// "MACHINE-PROCESS-", for the name of what this process will remove itself.
[[nodiscard]] std::string process_tag();

// Whether such a tag is that of a process of this machine that is no more.
[[nodiscard]] bool is_tag_of_the_dead(std::string_view tag);

// A name that is not taken, beside a file: ".NAME.MACHINE-PROCESS-xxxxxxxx.tmp".  What dead
// processes left beside it under such names is removed.
[[nodiscard]] std::filesystem::path temporary_name(const std::filesystem::path& file);

// Removes what dead processes of this machine left in a directory under the names PREFIX TAG ...,
// if it is this user's.
void collect_left_overs(const std::filesystem::path& directory, std::string_view prefix);

}  // namespace hamgen::runtime
