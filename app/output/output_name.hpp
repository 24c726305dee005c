// What the name behind -o means, to every command that writes a table.
#pragma once

#include <initializer_list>
#include <string>

namespace hamgen::app {

enum class OutputKind { none, directory, csv, json, standard };

// Of a command that can write several files: one table by its ending, standard output for "-", else
// a directory of all of them.  Throws UsageError for the name of a picture.
[[nodiscard]] OutputKind output_kind(const std::string& name);
// Of a command that writes one table: no directory.  Throws UsageError for any other ending.
[[nodiscard]] OutputKind table_kind(const std::string& name);
// Throws UsageError where a directory is meant and the name, behind that option, ends as a file's
// does, "page.html"; "page.html/" is one, and what is a directory already.
void require_directory(const std::string& option, const std::string& name);
// Makes the directories above files or directories of these names, and says so unless quiet: it may
// be a slip of the pen.
void make_directories_above(std::initializer_list<std::string> names, bool quiet);
// Throws ToolError where a file of one of these names could not be written: before something takes
// long for it.  Directories and standard output are left out.
void require_writable(std::initializer_list<std::string> names);
// Throws UsageError where what is written would take the place of another file: `what` it is.
void require_apart(const std::string& option, const std::string& name, const std::string& other,
                   const std::string& what);
// Of a command that writes one file by this option: throws UsageError for the name of a directory,
// ToolError where it could not be written.
void require_file(const std::string& option, const std::string& name);
// Throws UsageError if both are documents on standard output.
void require_one_document(bool json, OutputKind kind);

}  // namespace hamgen::app
