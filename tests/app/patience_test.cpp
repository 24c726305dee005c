// A word for who waits, said once and only to who waits.
#include "app/output/patience.hpp"

#include <gtest/gtest.h>

#include <future>
#include <memory>

namespace hamgen::app_test {
namespace {

TEST(Patience, IsAskedForOnceByWorkThatTakesLong) {
  std::promise<void> said;
  int times = 0;
  const auto say = [&] {
    ++times;
    said.set_value();
  };
  auto waiting = std::make_unique<app::Patience>(say, std::chrono::milliseconds(0));
  said.get_future().wait();
  waiting.reset();
  EXPECT_EQ(times, 1);
}

TEST(Patience, IsNotAskedForByWorkThatEnds) {
  int times = 0;
  for (int k = 0; k < 100; ++k)
    const app::Patience waiting([&times] { ++times; }, std::chrono::hours(1));
  EXPECT_EQ(times, 0);
}

}  // namespace
}  // namespace hamgen::app_test
