#include "runtime/csv_writer.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <bit>
#include <clocale>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>

#include "runtime/tool_error.hpp"
#include "tests/runtime/oscillator.hpp"

namespace hamgen::runtime {
namespace {

namespace fs = std::filesystem;
using tests::count_entries;
using tests::text_of;
using tests::write_text;

const std::vector<std::string> kColumns = {"step", "q", "p"};

// Files end at this size until the end of the scope, as if the disk were full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : old_handler_(::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    ::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_{};
  sighandler_t old_handler_;
};

class FileTest : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return directory_.path() / name; }
  std::size_t files() const { return count_entries(directory_.path()); }

  TemporaryDirectory directory_ = private_directory();
};

using CsvWriterTest = FileTest;
using AtomicWriteTest = FileTest;

template <typename Action>
std::string error_of(const Action& action) {
  try {
    action();
  } catch (const ToolError& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(CsvWriterTest, WritesMetadataNamesAndRows) {
  const std::vector<std::string> metadata = {"model pendulum", "two\nlines"};
  const std::vector<std::string> columns = {"step", "q", "a \"b\", c"};
  CsvWriter writer(path("a.csv"), metadata, columns);
  writer.write_row(0, std::vector<double>{0.1, -0.0});
  writer.write_row(100000, std::vector<double>{1e300, std::numeric_limits<double>::quiet_NaN()});
  EXPECT_FALSE(fs::exists(path("a.csv")));
  writer.publish("stopped at step 100000: not converged");
  EXPECT_EQ(
      text_of(path("a.csv")),
      "# model pendulum\n# two\n# lines\nstep,q,\"a \"\"b\"\", c\"\n0,0.1,-0\n100000,1e+300,\n"
      "# stopped at step 100000: not converged\n");
  EXPECT_EQ(files(), 1u);
}

TEST_F(CsvWriterTest, WritesNumbersThatReadBackTheSameInEveryLocale) {
  // Whatever locales are installed; a comma as the decimal point would show.
  for (const char* const locale : {"C", "de_DE.UTF-8", "de_DE", "fr_FR.UTF-8"}) {
    std::setlocale(LC_ALL, locale);
    EXPECT_EQ(number_text(0.5), "0.5");
  }
  std::setlocale(LC_ALL, "C");
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(number_text(value).c_str(), nullptr)),
              std::bit_cast<std::uint64_t>(value));
  }
  EXPECT_EQ(number_text(5e-324), "5e-324");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "");
}

TEST_F(CsvWriterTest, LeavesNothingIfItIsNotPublished) {
  write_text(path("old.csv"), "old");
  {
    CsvWriter writer(path("old.csv"), {}, kColumns);
    for (int i = 0; i < 100000; ++i) writer.write_row(i, std::vector<double>{0.1, 0.2});
  }
  EXPECT_EQ(text_of(path("old.csv")), "old");
  EXPECT_EQ(files(), 1u);
}

TEST_F(CsvWriterTest, RefusesARowOfAnotherLength) {
  CsvWriter writer(path("a.csv"), {}, kColumns);
  EXPECT_THROW(writer.write_row(0, std::vector<double>{1.0}), std::invalid_argument);
}

TEST_F(CsvWriterTest, OnAFullDiskNamesTheFileAndLeavesNothing) {
  const std::string error = error_of([this] {
    const FullDisk disk(100000);
    CsvWriter writer(path("a.csv"), {}, kColumns);
    for (int i = 0; i < 100000; ++i) writer.write_row(i, std::vector<double>{0.1, 0.2});
    writer.publish();
  });
  EXPECT_EQ(error, "cannot write '" + path("a.csv").string() + "': File too large");
  EXPECT_EQ(files(), 0u);
}

TEST_F(CsvWriterTest, OnAFullDeviceSaysSo) {
  const std::string error = error_of([] {
    CsvWriter writer("/dev/full", {}, kColumns);
    writer.publish();
  });
  EXPECT_EQ(error, "cannot write '/dev/full': No space left on device");
}

TEST_F(CsvWriterTest, NamesADirectoryThatIsMissing) {
  const fs::path target = path("missing") / "a.csv";
  EXPECT_EQ(error_of([&] { CsvWriter(target, {}, kColumns); }),
            "cannot write '" + target.string() + "': No such file or directory");
  EXPECT_EQ(error_of([&] { CsvWriter(directory_.path(), {}, kColumns); }),
            "cannot write '" + directory_.path().string() + "': Is a directory");
}

TEST_F(CsvWriterTest, WritesIntoADeviceInsteadOfReplacingIt) {
  fs::create_symlink("/dev/null", path("null"));
  CsvWriter writer(path("null"), {}, kColumns);
  writer.publish();
  EXPECT_TRUE(fs::is_symlink(path("null")));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(files(), 1u);
}

TEST_F(CsvWriterTest, ReplacesTheFileALinkPointsToAndKeepsItsMode) {
  write_text(path("real.csv"), "old");
  ::chmod(path("real.csv").c_str(), 0640);
  fs::create_symlink("real.csv", path("link.csv"));
  CsvWriter writer(path("link.csv"), {}, kColumns);
  writer.publish();
  EXPECT_TRUE(fs::is_symlink(path("link.csv")));
  EXPECT_EQ(text_of(path("real.csv")), "step,q,p\n");
  EXPECT_EQ(fs::status(path("real.csv")).permissions(), fs::perms(0640));
}

TEST_F(AtomicWriteTest, CreatesDirectoriesAndDoesNotTouchAnEqualFile) {
  const fs::path target = path("a") / "b" / "c.hpp";
  EXPECT_TRUE(atomic_write(target, "text"));
  const fs::file_time_type long_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
  fs::last_write_time(target, long_ago);
  const fs::file_time_type before = fs::last_write_time(target);
  EXPECT_FALSE(atomic_write(target, "text"));
  EXPECT_EQ(fs::last_write_time(target), before);
  EXPECT_TRUE(atomic_write(target, "next"));
  EXPECT_EQ(text_of(target), "next");
  EXPECT_EQ(count_entries(target.parent_path()), 1u);
}

TEST_F(AtomicWriteTest, OnAFullDiskKeepsTheOldFileAndNothingElse) {
  const fs::path target = path("a.hpp");
  atomic_write(target, "old");
  const std::string error = error_of([&] {
    const FullDisk disk(1000);
    atomic_write(target, std::string(5000, 'x'));
  });
  EXPECT_EQ(error, "cannot write '" + target.string() + "': File too large");
  EXPECT_EQ(text_of(target), "old");
  EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicWriteTest, NamesWhatIsInTheWay) {
  write_text(path("file"), "");
  EXPECT_EQ(error_of([&] { atomic_write(path("file") / "a.hpp", "text"); }),
            "cannot create the directory '" + path("file").string() + "': Not a directory");
}

}  // namespace
}  // namespace hamgen::runtime
