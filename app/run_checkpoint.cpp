#include "app/run_checkpoint.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "app/studies/manifest.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {
namespace {

double read_seconds(const std::string& text) {
  const double seconds = to_double(constant_option("--every-seconds", text));
  if (!(seconds >= 0.0))
    throw UsageError(
        fmt::format("--every-seconds {}: 0 or more is wanted; 0 is as often as can be", text));
  return seconds;
}

}  // namespace

void add_checkpoint_options(CLI::App& parser, CheckpointOptions& options) {
  parser.add_option("--checkpoint", options.checkpoint, "")->type_name("FILE");
  parser.add_option("--resume", options.resume, "save the run every S seconds; go on with it")
      ->type_name("FILE");
}

void add_checkpoint_interval(CLI::App& parser, CheckpointOptions& options) {
  parser.add_option("--every-seconds", options.every_seconds, "")->type_name("S");
}

void require_to_be_kept(const CheckpointOptions& options, const std::string& output,
                        bool looks_between_steps) {
  if (!options.is_wanted() && !options.every_seconds.empty())
    throw UsageError("--every-seconds is for --checkpoint FILE");
  if (!options.is_wanted()) return;
  if (looks_between_steps)
    throw UsageError(
        "--checkpoint and --resume keep steps and their rows, and no events, --at, --every-time, "
        "--until or --plot\nhelp: leave these out; `hamgen plot` draws the finished trajectory");
  if (output == "-")
    throw UsageError(
        "-o - and --checkpoint: what is on standard output cannot be gone on with\nhelp: give the "
        "trajectory a file: -o FILE.csv");
}

RunKeeper::RunKeeper(const CheckpointOptions& options, std::vector<std::string> manifest,
                     const runtime::Integrator& integrator)
    : path_(options.checkpoint.empty() ? options.resume : options.checkpoint),
      resumes_(!options.resume.empty()) {
  if (!options.every_seconds.empty()) seconds_ = read_seconds(options.every_seconds);
  if (integrator.saved().empty())
    throw UsageError(
        "--checkpoint: this step cannot be saved: it is interpreted, or keeps matrices of "
        "Eigen\nhelp: without --interpret; for a large system another --solver, such as "
        "fixed-point");
  checkpoint_.manifest = std::move(manifest);
  if (path_ != options.resume && std::filesystem::exists(path_))
    throw UsageError(fmt::format(
        "--checkpoint {0}: that is there, perhaps of a run that did not come to its end\nhelp: "
        "--resume {0} goes on with it; to begin anew, remove it",
        path_));
  if (!resumes_) return;
  runtime::Checkpoint there = runtime::read_checkpoint(options.resume);
  const std::string difference = difference_of(there.manifest, checkpoint_.manifest);
  if (!difference.empty())
    throw UsageError(
        fmt::format("--resume {}: that is a checkpoint of another run:\n{}help: resume with the "
                    "command it was begun with",
                    options.resume, difference));
  checkpoint_ = std::move(there);
}

TrajectoryTable RunKeeper::table(const std::string& output,
                                 const std::vector<std::string>& metadata, Columns columns) const {
  return {output,
          metadata,
          std::move(columns),
          {.size = checkpoint_.rows_size, .checksum = checkpoint_.rows_checksum},
          checkpoint_.state.summary.records};
}

void RunKeeper::prepare(runtime::IntegrateOptions& options, std::optional<TrajectoryTable>& table) {
  if (resumes_) options.from = &checkpoint_.state;
  options.save_interval = std::chrono::duration<double>(seconds_);
  options.on_save = [this, &table](const runtime::RunState& state) {
    runtime::Checkpoint now{.manifest = checkpoint_.manifest, .state = state};
    if (table) {
      const runtime::AtomicFile::Part rows = table->synced();
      now.rows_size = rows.size;
      now.rows_checksum = rows.checksum;
    }
    runtime::write_checkpoint(path_, now);
  };
}

std::string RunKeeper::stopped_text() const {
  return fmt::format("help: the same command with --resume {} goes on\n", path_);
}

void RunKeeper::remove() const {
  std::error_code failed;
  std::filesystem::remove(path_, failed);
  if (failed) throw runtime::file_error("remove", path_, failed.value());
}

}  // namespace hamgen::app
