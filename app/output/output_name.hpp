// What the name behind -o means, to every command that writes a table.
#pragma once

#include <string>

namespace hamgen::app {

enum class OutputKind { none, directory, csv, json, standard };

// Of a command that can write several files: one table by its ending, standard output for "-", else
// a directory of all of them.  Throws UsageError for the name of a picture.
[[nodiscard]] OutputKind output_kind(const std::string& name);
// Of a command that writes one table: no directory.  Throws UsageError for any other ending.
[[nodiscard]] OutputKind table_kind(const std::string& name);
// Throws UsageError if both are documents on standard output.
void require_one_document(bool json, OutputKind kind);

}  // namespace hamgen::app
