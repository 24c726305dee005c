#include "runtime/judge.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/runtime/oscillator.hpp"

namespace hamgen::runtime {
namespace {

using tests::oscillator_library;

// omega = 2, (q, p) = (1, 0): H = 2, |q| |H_q| + |p| |H_p| = 1*4, q H_q/2 = 2, p H_p/2 = 0.
Judge judge(bool defined_everywhere = false) {
  return {oscillator_library(), std::vector<Wide>{{2.0}, {0.0}}, std::vector<Wide>{{1.0}, {0.0}},
          defined_everywhere};
}

TEST(Status, HasADifferentNameForEach) {
  std::set<std::string> names;
  for (int i = 0; i < kStatuses; ++i) names.emplace(to_text(static_cast<Status>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kStatuses));
  EXPECT_FALSE(names.contains(""));
}

TEST(Judge, MeasuresByTheStart) {
  EXPECT_EQ(judge().energy(), (Wide{2.0}));
  EXPECT_EQ(judge().energy_scale(), 4.0);
  // q by 1; p by sqrt(2*4), the momentum of that energy.
  EXPECT_EQ(judge().size_of(std::vector<double>{-3.0, 1.0}), 3.0);
  EXPECT_EQ(judge().size_of(std::vector<double>{0.0, 10.0}), 10.0 / std::sqrt(8.0));
  EXPECT_FALSE(judge().is_jump(40.0));
  EXPECT_TRUE(judge().is_jump(40.5));
  // p H_p/2 = 2 and q H_q/2 = 18.
  EXPECT_EQ(judge().terms(std::vector<double>{3.0, 2.0}), 18.0);
  EXPECT_TRUE(judge().keeps_energy(std::vector<double>{3.0, 2.0}, 1.75));
  EXPECT_FALSE(judge().keeps_energy(std::vector<double>{3.0, 2.0}, 1.85));
}

// q in units a million times larger, and omega larger for it: the energies are the same.
TEST(Judge, MeasuresEnergiesWhateverTheUnits) {
  for (const double unit : {1.0, 0x1p-20, 0x1p20}) {
    const Judge here(oscillator_library(), std::vector<Wide>{{1.0 / unit}, {0.0}},
                     std::vector<Wide>{{unit}, {1.0}}, false);
    EXPECT_EQ(here.energy(), (Wide{1.0}));
    EXPECT_EQ(here.energy_scale(), 2.0) << unit;
  }
}

TEST(Judge, TellsFailuresApart) {
  const std::vector<double> near = {1.0, 1.0};
  const std::vector<double> far = {2e3, 0.0};
  const std::vector<double> huge = {1e20, 0.0};
  const std::vector<double> beyond = {1e60, 0.0};
  // Errors of all of H there: nothing is kept.
  EXPECT_EQ(judge().failure(Status::not_converged, near, 1e9), Status::not_converged);
  EXPECT_EQ(judge().failure(Status::not_converged, huge, 1e41), Status::not_converged);
  EXPECT_EQ(judge().failure(Status::not_converged, beyond, 1e121), Status::overflow);
  EXPECT_EQ(judge().failure(Status::left_domain, near, 1e9), Status::left_domain);
  EXPECT_EQ(judge().failure(Status::left_domain, far, 1e9), Status::left_domain);
  EXPECT_EQ(judge().failure(Status::left_domain, huge, 1e41), Status::overflow);
  EXPECT_EQ(judge(true).failure(Status::left_domain, near, 1e9), Status::overflow);
  EXPECT_EQ(judge(true).failure(Status::jumped, huge, 1e41), Status::jumped);
  for (const Status reason : {Status::not_converged, Status::left_domain, Status::jumped}) {
    EXPECT_EQ(judge().failure(reason, far, 1.0), Status::escaped);
    EXPECT_NE(judge().failure(reason, near, 1e-9), Status::escaped);
  }
}

}  // namespace
}  // namespace hamgen::runtime
