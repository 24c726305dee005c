#include "runtime/checkpoint.hpp"

#include <fmt/format.h>

#include <cstring>

#include "runtime/atomic_file.hpp"
#include "runtime/crc64.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::runtime {
namespace {

// The number is that of the format; what follows is in the order of bytes of the machine.
constexpr std::string_view kMark = "hamgen checkpoint 1\n";
constexpr std::string_view kAnyMark = "hamgen checkpoint ";

// Both take what a checkpoint is made of: numbers as they lie in memory, and texts, vectors and
// what may be missing after how much there is of it.
class CheckpointWriter {
 public:
  template <class Number>
  void operator()(const Number& value) {
    static_assert(std::is_trivially_copyable_v<Number>);
    text_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class Number>
  void operator()(const std::optional<Number>& value) {
    (*this)(value.has_value());
    if (value) (*this)(*value);
  }
  void operator()(std::string_view bytes) {
    (*this)(static_cast<std::uint64_t>(bytes.size()));
    text_ += bytes;
  }
  void operator()(const std::vector<std::byte>& bytes) {
    (*this)(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }
  void operator()(const std::vector<std::string>& lines) {
    (*this)(static_cast<std::uint64_t>(lines.size()));
    for (const std::string& line : lines) (*this)(std::string_view(line));
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

class CheckpointReader {
 public:
  explicit CheckpointReader(std::string_view text) : text_(text) {}

  template <class Number>
  void operator()(Number& value) {
    static_assert(std::is_trivially_copyable_v<Number>);
    const std::string_view bytes = take_bytes(sizeof value);
    if (bytes.size() == sizeof value) std::memcpy(&value, bytes.data(), sizeof value);
  }
  template <class Number>
  void operator()(std::optional<Number>& value) {
    bool has = false;
    (*this)(has);
    if (has) (*this)(value.emplace());
  }
  void operator()(std::string_view& bytes) {
    std::uint64_t size = 0;
    (*this)(size);
    bytes = take_bytes(size);
  }
  void operator()(std::vector<std::byte>& bytes) {
    std::string_view text;
    (*this)(text);
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    bytes.assign(first, first + text.size());
  }
  void operator()(std::vector<std::string>& lines) {
    std::uint64_t count = 0;
    (*this)(count);
    for (std::uint64_t i = 0; i < count && whole_; ++i) {
      std::string_view line;
      (*this)(line);
      lines.emplace_back(line);
    }
  }
  [[nodiscard]] bool is_whole() const { return whole_ && text_.empty(); }

 private:
  std::string_view take_bytes(std::uint64_t size) {
    whole_ = whole_ && size <= text_.size();
    if (!whole_) return {};
    const std::string_view bytes = text_.substr(0, size);
    text_.remove_prefix(size);
    return bytes;
  }

  std::string_view text_;
  bool whole_ = true;
};

// The fields of the format, in their order: of a Checkpoint to be written, or to be read into.
template <class Archive, class Fields>
void pass_fields(Archive& archive, Fields& checkpoint) {
  archive(checkpoint.manifest);
  auto& summary = checkpoint.state.summary;
  archive(summary.steps_done);
  archive(summary.iterations);
  archive(summary.last_iterations);
  archive(summary.last_increment);
  archive(summary.energy);
  archive(summary.energy_scale);
  archive(summary.records);
  archive(summary.advance_seconds);
  archive(summary.total_seconds);
  archive(checkpoint.state.jump_limit);
  archive(checkpoint.state.largest_error);
  archive(checkpoint.state.integrator);
  archive(checkpoint.rows_size);
  archive(checkpoint.rows_checksum);
}

std::uint64_t checksum(std::string_view text) {
  return crc64(std::as_bytes(std::span(text.data(), text.size())));
}

[[noreturn]] void throw_not_read(const std::filesystem::path& path, const std::string& reason) {
  throw ToolError({.message = fmt::format("cannot go on from '{}': {}\nhelp: take another "
                                          "checkpoint of the run, or begin it anew: --checkpoint",
                                          path.string(), reason)});
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  CheckpointWriter body;
  pass_fields(body, checkpoint);
  const std::string text = body.take();
  CheckpointWriter whole;
  whole(std::string_view(text));
  whole(checksum(text));
  AtomicFile file(path);
  file.write(kMark);
  file.write(whole.take());
  file.sync();
  file.publish();
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  if (!text.starts_with(kAnyMark)) throw_not_read(path, "it is no checkpoint of hamgen");
  if (!text.starts_with(kMark))
    throw_not_read(path,
                   fmt::format("its format is '{}', and this hamgen has '{}'",
                               text.substr(0, text.find('\n')), kMark.substr(0, kMark.size() - 1)));
  CheckpointReader whole(std::string_view(text).substr(kMark.size()));
  std::string_view inside;
  whole(inside);
  std::uint64_t sum = 0;
  whole(sum);
  if (!whole.is_whole() || sum != checksum(inside))
    throw_not_read(path, "it is cut or changed: its checksum is another");

  Checkpoint checkpoint;
  CheckpointReader body(inside);
  pass_fields(body, checkpoint);
  if (!body.is_whole()) throw_not_read(path, "its fields are not those of this version");
  return checkpoint;
}

}  // namespace hamgen::runtime
