#include "runtime/sha256.hpp"

#include <gtest/gtest.h>

namespace hamgen::runtime {
namespace {

// The examples of FIPS 180-2, appendix B.
TEST(Sha256, GivesTheValuesOfTheStandard) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_hex(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DoesNotDependOnHowTheBytesArriveAtAnyLengthAroundABlock) {
  for (std::size_t length = 0; length < 200; ++length) {
    std::string bytes;
    for (std::size_t i = 0; i < length; ++i) bytes += static_cast<char>(i * 7);
    Sha256 hash;
    for (const char byte : bytes) hash.update(std::string_view(&byte, 1));
    EXPECT_EQ(hash.hex(), sha256_hex(bytes)) << length;
  }
}

TEST(Sha256, TellsFieldsApartByWhereTheyEnd) {
  Sha256 one;
  one.update_field("ab");
  one.update_field("c");
  Sha256 other;
  other.update_field("a");
  other.update_field("bc");
  EXPECT_NE(one.hex(), other.hex());
}

}  // namespace
}  // namespace hamgen::runtime
