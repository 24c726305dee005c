// Records that a kill, a full disk or a flipped bit cannot turn into others.
#include "runtime/part_file.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "runtime/atomic_file.hpp"
#include "runtime/crc64.hpp"
#include "runtime/temporary_directory.hpp"

namespace hamgen::runtime {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

const std::vector<std::string> kTexts = {"first", "", "the third record", "last"};

// A file of these records with keys 10, 11, ...
class PartFiles : public testing::Test {
 protected:
  PartFiles() : directory_(private_directory()), path_(directory_.path() / "part") {
    PartFile file(path_);
    for (std::size_t i = 0; i < kTexts.size(); ++i) file.append(10 + i, bytes_of(kTexts[i]));
    whole_ = read_file(path_);
  }

  void put(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }

  // How many records there are; each is one of those that were written.
  std::size_t count() const {
    const PartScan scan = scan_part_file(path_);
    const PartReader reader(path_);
    std::vector<std::byte> bytes;
    for (const PartRecord& record : scan.records) {
      reader.read(record, bytes);
      const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      EXPECT_EQ(text, kTexts.at(record.key - 10));
    }
    return scan.records.size();
  }

  TemporaryDirectory directory_;
  std::filesystem::path path_;
  std::string whole_;
};

TEST(Crc64, OfTheNineDigitsIsTheKnownOne) {
  EXPECT_EQ(crc64(bytes_of("123456789")), 0x995dc9bbdf1939faU);
  EXPECT_EQ(crc64({}), 0U);
}

TEST_F(PartFiles, CutAnywhereHaveTheWholeRecordsAndGoOn) {
  ASSERT_EQ(count(), 4U);
  std::size_t last = 0;
  for (std::size_t size = 0; size <= whole_.size(); ++size) {
    put(whole_.substr(0, size));
    const std::size_t before = count();
    EXPECT_GE(before, last);
    last = before;
    {
      PartFile file(path_);
      file.append(13, bytes_of(kTexts[3]));
    }
    EXPECT_EQ(count(), before + 1) << size;
  }
  EXPECT_EQ(last, 4U);
}

TEST_F(PartFiles, WithAnyByteChangedHaveNoOtherRecords) {
  for (std::size_t i = 0; i < whole_.size(); ++i) {
    for (const unsigned char flip : {1, 128, 255}) {
      std::string text = whole_;
      text[i] = static_cast<char>(static_cast<unsigned char>(text[i]) ^ flip);
      put(text);
      EXPECT_LT(count(), 4U) << i;
    }
  }
  put(std::string(100, '\0'));
  EXPECT_EQ(count(), 0U);
}

TEST_F(PartFiles, SayWhichRecordsAreSpoiltAndReadThoseBehind) {
  std::string text = whole_;
  text[40] = 'F';  // behind the first head
  put(text);
  const PartScan scan = scan_part_file(path_);
  EXPECT_EQ(scan.spoilt, 1U);
  ASSERT_EQ(scan.records.size(), 3U);
  EXPECT_EQ(scan.records.front().key, 11U);
}

}  // namespace
}  // namespace hamgen::runtime
