#include <fmt/format.h>
#include <hdf5.h>

#include <filesystem>

#include "app/output/ensemble_file.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/temporary_name.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {
namespace {

namespace fs = std::filesystem;

// A handle of the library, closed by its own function.
class Handle {
 public:
  Handle(hid_t id, herr_t (*closing)(hid_t)) : id_(id), close_(closing) {}
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { close(); }

  [[nodiscard]] hid_t get() const { return id_; }
  herr_t close() { return id_ < 0 ? 0 : close_(std::exchange(id_, H5I_INVALID_HID)); }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

constexpr const char* kManifestName = "manifest";

// One data set a column, and one for the manifest: an attribute has 64 KiB at most.  Nothing in it
// tells the time.
class EnsembleHdf5 : public EnsembleFile {
 public:
  EnsembleHdf5(const std::string& output, const EnsembleFileHead& head)
      : target_(fs::weakly_canonical(output)),
        temporary_(runtime::temporary_name(target_)),
        file_(create(), H5Fclose),
        count_(static_cast<hsize_t>(head.manifest->count)) {
    write_manifest(fmt::format("{}\n", fmt::join(head.manifest->lines, "\n")));
    status_.push_back(column("status", H5T_STD_I32LE));
    write_status_names();
    steps_.push_back(column("steps", H5T_STD_I64LE));
    for (const std::string& name : head.manifest->columns)
      values_.push_back(column(name, H5T_IEEE_F64LE));
  }
  ~EnsembleHdf5() override {
    const fs::path left = std::exchange(temporary_, {});
    close_all();
    std::error_code failed;
    if (!left.empty()) fs::remove(left, failed);
  }

  void add(const std::vector<EnsembleRow>& rows) override {
    pending_.insert(pending_.end(), rows.begin(), rows.end());
    if (pending_.size() >= kRowsOfAWrite) flush();
  }

  void publish(const std::string& remark) override {
    flush();
    write_text(file_.get(), "ended", remark);
    close_all();
    runtime::publish_file(temporary_, target_);
    temporary_.clear();
  }

 private:
  static constexpr std::size_t kRowsOfAWrite = 65536;

  [[noreturn]] void fail() const {
    throw runtime::ToolError(
        {.message = fmt::format("cannot write '{}': HDF5 says no", target_.string())});
  }
  void require(bool good) const {
    if (!good) fail();
  }

  hid_t create() {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const hid_t file = H5Fcreate(temporary_.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT);
    require(file >= 0);
    return file;
  }

  void write_text(hid_t at, const char* name, const std::string& text) {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    require(H5Tset_size(type.get(), text.size() + 1) >= 0);
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(at, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    require(attribute.get() >= 0 && H5Awrite(attribute.get(), type.get(), text.c_str()) >= 0);
  }
  void write_manifest(const std::string& text) {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    require(H5Tset_size(type.get(), text.size() + 1) >= 0);
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    require(H5Pset_obj_track_times(properties.get(), false) >= 0);
    const Handle set(H5Dcreate2(file_.get(), kManifestName, type.get(), space.get(), H5P_DEFAULT,
                                properties.get(), H5P_DEFAULT),
                     H5Dclose);
    require(set.get() >= 0 &&
            H5Dwrite(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()) >= 0);
  }

  // What the numbers of the status mean.
  void write_status_names() {
    std::string text;
    for (int i = 0; i < runtime::kStatuses; ++i)
      text += fmt::format("{}{}={}", i == 0 ? "" : ", ", i,
                          runtime::to_text(static_cast<runtime::Status>(i)));
    write_text(status_.front().get(), "meaning", text);
  }

  Handle column(const std::string& name, hid_t type) {
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const hsize_t chunk = std::min<hsize_t>(count_, kRowsOfAWrite);
    require(H5Pset_obj_track_times(properties.get(), false) >= 0 &&
            H5Pset_chunk(properties.get(), 1, &chunk) >= 0);
    const Handle space(H5Screate_simple(1, &count_, nullptr), H5Sclose);
    // A slash would make a group.
    std::string plain = name;
    for (char& c : plain) c = c == '/' ? '_' : c;
    Handle set(H5Dcreate2(file_.get(), plain.c_str(), type, space.get(), H5P_DEFAULT,
                          properties.get(), H5P_DEFAULT),
               H5Dclose);
    require(set.get() >= 0);
    return set;
  }

  template <class Number>
  void write(const Handle& set, hid_t type, const std::vector<Number>& numbers) {
    const hsize_t first = done_;
    const hsize_t count = numbers.size();
    const Handle all(H5Dget_space(set.get()), H5Sclose);
    const Handle part(H5Screate_simple(1, &count, nullptr), H5Sclose);
    require(H5Sselect_hyperslab(all.get(), H5S_SELECT_SET, &first, nullptr, &count, nullptr) >= 0 &&
            H5Dwrite(set.get(), type, part.get(), all.get(), H5P_DEFAULT, numbers.data()) >= 0);
  }

  void flush() {
    if (pending_.empty()) return;
    std::vector<int> status;
    std::vector<long long> steps;
    for (const EnsembleRow& row : pending_) {
      status.push_back(static_cast<int>(row.status));
      steps.push_back(row.steps);
    }
    write(status_.front(), H5T_NATIVE_INT, status);
    write(steps_.front(), H5T_NATIVE_LLONG, steps);
    std::vector<double> numbers(pending_.size());
    for (std::size_t i = 0; i < values_.size(); ++i) {
      for (std::size_t k = 0; k < pending_.size(); ++k) numbers[k] = pending_[k].values[i];
      write(values_[i], H5T_NATIVE_DOUBLE, numbers);
    }
    done_ += pending_.size();
    pending_.clear();
  }

  void close_all() {
    status_.clear();
    steps_.clear();
    values_.clear();
    if (file_.close() < 0 && !temporary_.empty()) fail();
  }

  fs::path target_, temporary_;
  Handle file_;
  hsize_t count_;
  hsize_t done_ = 0;
  std::vector<Handle> status_, steps_, values_;
  std::vector<EnsembleRow> pending_;
};

}  // namespace

bool has_hdf5() { return true; }

std::unique_ptr<EnsembleFile> make_ensemble_hdf5(const std::string& output,
                                                 const EnsembleFileHead& head) {
  return std::make_unique<EnsembleHdf5>(output, head);
}

std::vector<std::string> manifest_lines_of_hdf5(const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (file.get() < 0) return {};
  const Handle set(H5Dopen2(file.get(), kManifestName, H5P_DEFAULT), H5Dclose);
  if (set.get() < 0) return {};
  const Handle type(H5Dget_type(set.get()), H5Tclose);
  std::string text(H5Tget_size(type.get()), '\0');
  if (H5Dread(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) return {};
  std::vector<std::string> lines;
  for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos;
       begin = end + 1)
    lines.push_back(text.substr(begin, end - begin));
  return lines;
}

}  // namespace hamgen::app
