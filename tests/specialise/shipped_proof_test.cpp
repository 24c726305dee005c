// What verify says of the step of a scene: all it says of a whole one, of the text as well.
#include <gtest/gtest.h>

#include <algorithm>

#include "generator/base/source_text.hpp"
#include "tests/specialise/specialised_request.hpp"

namespace hamgen {
namespace {

TEST(ShippedScenes, AreProvedFromTheTextOfTheModelToThatOfTheHeader) {
  for (const auto& [model, scene] : {std::pair{"two_bodies", "mirror"},
                                     {"two_bodies", "apart"},
                                     {"beads", "plucked"},
                                     {"oblate_kepler", "equatorial"},
                                     {"spring_pendulum", "hanging"}}) {
    const std::string path = std::string(HAMGEN_SOURCE_DIR "/hamiltonians/") + model + ".ham";
    const SourceText source = read_source(path);
    const Proof proof = verify_step(source, for_scene(source, {.scene = scene}));
    for (const auto& [property, verdict] : {std::pair{"program", Verdict::proved},
                                            {"emitted code", Verdict::proved},
                                            {"specialised", Verdict::proved},
                                            {"model", Verdict::tested}}) {
      const auto found = std::ranges::find(proof, property, &Finding::property);
      ASSERT_NE(found, proof.end()) << model << scene << property;
      EXPECT_EQ(found->verdict, verdict) << model << scene << ": " << found->detail;
    }
  }
}

}  // namespace
}  // namespace hamgen
