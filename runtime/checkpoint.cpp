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

class CheckpointWriter {
 public:
  template <class Number>
  void add(Number value) {
    static_assert(std::is_trivially_copyable_v<Number>);
    text_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void add_bytes(std::string_view bytes) {
    add(static_cast<std::uint64_t>(bytes.size()));
    text_ += bytes;
  }
  template <class Number>
  void add_optional(const std::optional<Number>& value) {
    add(value.has_value());
    if (value) add(*value);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

class CheckpointReader {
 public:
  explicit CheckpointReader(std::string_view text) : text_(text) {}

  template <class Number>
  void take(Number& value) {
    const std::string_view bytes = take_bytes(sizeof value);
    if (bytes.size() == sizeof value) std::memcpy(&value, bytes.data(), sizeof value);
  }
  std::string_view take_bytes() {
    std::uint64_t size = 0;
    take(size);
    return take_bytes(size);
  }
  template <class Number>
  void take_optional(std::optional<Number>& value) {
    bool has = false;
    take(has);
    if (has) take(value.emplace());
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

std::uint64_t checksum(std::string_view text) {
  return crc64(std::as_bytes(std::span(text.data(), text.size())));
}

[[noreturn]] void throw_not_read(const std::filesystem::path& path, const std::string& reason) {
  throw ToolError({.message = fmt::format("cannot go on from '{}': {}", path.string(), reason)});
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  CheckpointWriter body;
  body.add(static_cast<std::uint64_t>(checkpoint.manifest.size()));
  for (const std::string& line : checkpoint.manifest) body.add_bytes(line);
  const RunSummary& summary = checkpoint.state.summary;
  body.add(summary.steps_done);
  body.add(summary.iterations);
  body.add(summary.last_iterations);
  body.add_optional(summary.last_increment);
  body.add_optional(summary.energy);
  body.add(summary.energy_scale);
  body.add(summary.records);
  body.add(summary.advance_seconds);
  body.add(summary.total_seconds);
  body.add(checkpoint.state.jump_limit);
  body.add(checkpoint.state.largest_error);
  const std::vector<std::byte>& bytes = checkpoint.state.integrator;
  body.add_bytes({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  body.add(checkpoint.rows_size);
  body.add(checkpoint.rows_checksum);
  const std::string text = body.take();
  CheckpointWriter whole;
  whole.add_bytes(text);
  whole.add(checksum(text));
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
  const std::string_view inside = whole.take_bytes();
  std::uint64_t sum = 0;
  whole.take(sum);
  if (!whole.is_whole() || sum != checksum(inside))
    throw_not_read(path, "it is cut or changed: its checksum is another");

  Checkpoint checkpoint;
  CheckpointReader body(inside);
  std::uint64_t lines = 0;
  body.take(lines);
  for (std::uint64_t i = 0; i < lines && lines <= inside.size(); ++i)
    checkpoint.manifest.emplace_back(body.take_bytes());
  RunSummary& summary = checkpoint.state.summary;
  body.take(summary.steps_done);
  body.take(summary.iterations);
  body.take(summary.last_iterations);
  body.take_optional(summary.last_increment);
  body.take_optional(summary.energy);
  body.take(summary.energy_scale);
  body.take(summary.records);
  body.take(summary.advance_seconds);
  body.take(summary.total_seconds);
  body.take(checkpoint.state.jump_limit);
  body.take(checkpoint.state.largest_error);
  const std::string_view bytes = body.take_bytes();
  const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
  checkpoint.state.integrator.assign(first, first + bytes.size());
  body.take(checkpoint.rows_size);
  body.take(checkpoint.rows_checksum);
  if (!body.is_whole()) throw_not_read(path, "its fields are not those of this version");
  return checkpoint;
}

}  // namespace hamgen::runtime
