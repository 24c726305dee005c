// hamgen run --checkpoint and --resume: a run that survives its process.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/command_line.hpp"
#include "app/output/trajectory_table.hpp"
#include "runtime/checkpoint.hpp"

namespace hamgen::app {

struct CheckpointOptions {
  std::string checkpoint, every_seconds, resume;
  [[nodiscard]] bool is_wanted() const { return !checkpoint.empty() || !resume.empty(); }
};

// Adds --checkpoint and --resume.
void add_checkpoint_options(CLI::App& parser, CheckpointOptions& options);
// Adds --every-seconds, whose help is with that of what comes behind it.
void add_checkpoint_interval(CLI::App& parser, CheckpointOptions& options);

// Throws UsageError where it cannot be done: a checkpoint has steps and rows, not what is found
// between steps or drawn of them.
void require_to_be_kept(const CheckpointOptions& options, const std::string& output,
                        bool looks_between_steps);

class RunKeeper {
 public:
  // `manifest` is what the run is.  Throws UsageError where the options make no sense or the
  // checkpoint is of another run, ToolError where it cannot be read or the step cannot be saved.
  RunKeeper(const CheckpointOptions& options, std::vector<std::string> manifest,
            const runtime::Integrator& integrator);

  // The table of the trajectory, from where the checkpoint left it.
  [[nodiscard]] TrajectoryTable table(const std::string& output,
                                      const std::vector<std::string>& metadata,
                                      Columns columns) const;
  // Makes integrate() go on and save; `table` may be empty, and lives as long.
  void prepare(runtime::IntegrateOptions& options, std::optional<TrajectoryTable>& table);
  // Where steps are left to do: how to do them.
  [[nodiscard]] std::string stopped_text() const;
  // All is written: the checkpoint goes.
  void remove() const;

 private:
  std::string path_;
  double seconds_ = 60.0;
  runtime::Checkpoint checkpoint_;  // its manifest is this run's
  bool resumes_ = false;
};

}  // namespace hamgen::app
