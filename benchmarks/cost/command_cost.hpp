// What a run of the command costs: time and memory of the whole process.
#pragma once

#include <string>
#include <vector>

namespace hamgen::cost_table {

struct CommandCost {
  int status = 0;         // exit status; -1 if it did not end by itself
  double seconds = 0.0;   // processor time
  long megabytes = 0;     // the most it held
  long output_bytes = 0;  // written to standard output
};

// Runs `hamgen` with these words; after so many seconds of processor time it is ended.
[[nodiscard]] CommandCost run_command(const std::string& hamgen,
                                      const std::vector<std::string>& words, long limit);

}  // namespace hamgen::cost_table
