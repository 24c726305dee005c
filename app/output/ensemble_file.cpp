#include "app/output/ensemble_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string_view>

#include "generator/base/diagnostic.hpp"
#include "generator/base/quoted_text.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

class EnsembleCsv : public EnsembleFile {
 public:
  EnsembleCsv(const std::string& output, const EnsembleFileHead& head)
      : file_(output), varied_(head.varied) {
    std::string text;
    for (const std::string& line : head.manifest->lines) text += "# " + comment_text(line) + "\n";
    text += "index";
    const std::vector<std::string>& columns = head.manifest->columns;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i == varied_) text += ",status,steps";
      text += "," + runtime::csv_cell(columns[i]);
    }
    file_.write(text + "\n");
  }

  void add(const std::vector<EnsembleRow>& rows) override {
    for (const EnsembleRow& row : rows) {
      std::string text = fmt::format("{}", index_++);
      for (std::size_t i = 0; i < row.values.size(); ++i) {
        if (i == varied_) text += fmt::format(",{},{}", runtime::to_text(row.status), row.steps);
        text += "," + runtime::number_text(row.values[i]);
      }
      file_.write(text + "\n");
    }
  }

  void publish(const std::string& remark) override {
    file_.write("# " + comment_text(remark) + "\n");
    file_.sync();
    file_.publish();
  }

 private:
  runtime::AtomicFile file_;
  std::size_t varied_;
  long long index_ = 0;
};

}  // namespace

EnsembleFormat ensemble_format(const std::string& output) {
  if (output.ends_with(".csv")) return EnsembleFormat::csv;
  if (!output.ends_with(".h5") && !output.ends_with(".hdf5"))
    throw UsageError(fmt::format("-o {}: the name ends in .csv, .h5 or .hdf5", output));
  if (!has_hdf5())
    throw UsageError(fmt::format(
        "-o {}: this hamgen was built without HDF5\nhelp: a name that ends in .csv; or build "
        "hamgen where the package libhdf5-dev is installed",
        output));
  return EnsembleFormat::hdf5;
}

std::unique_ptr<EnsembleFile> make_ensemble_file(const std::string& output,
                                                 const EnsembleFileHead& head) {
  if (ensemble_format(output) == EnsembleFormat::hdf5) return make_ensemble_hdf5(output, head);
  return std::make_unique<EnsembleCsv>(output, head);
}

bool is_whole(const std::string& output) {
  if (ensemble_format(output) == EnsembleFormat::hdf5) return true;  // HDF5 opens no part of a file
  constexpr std::streamoff kLine = 4096;                             // more than its last one has
  std::ifstream in(output, std::ios::binary | std::ios::ate);
  in.seekg(std::max<std::streamoff>(0, in.tellg() - kLine));
  const std::string end((std::istreambuf_iterator<char>(in)), {});
  if (!end.ends_with('\n')) return false;
  const std::size_t line = end.rfind('\n', end.size() - 2);
  return std::string_view(end).substr(line + 1).starts_with("# ended");  // npos + 1 is 0
}

std::vector<std::string> manifest_lines_of(const std::string& output) {
  if (ensemble_format(output) == EnsembleFormat::hdf5) return manifest_lines_of_hdf5(output);
  std::ifstream in(output);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line) && line.starts_with("# ");)
    lines.push_back(line.substr(2));
  return lines;
}

}  // namespace hamgen::app
