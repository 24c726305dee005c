// What verify says of the step of a scene: all it says of a whole one, of the text as well.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "generator/base/source_text.hpp"
#include "tests/specialise/specialised_request.hpp"

namespace hamgen {
namespace {

// A scene makes one number of elements that are equal; the text of the file has them all.
TEST(Specialised, ElementsThatBecomeOneNumberAreReadFromTheText) {
  for (const char* value : {"1", "2", "[2, 2, 2]"}) {
    const SourceText source = make_source(
        "springs.ham",
        std::string("system springs\nsize N = 3\ncoordinate q[1..N]\nmomentum p[1..N]\n"
                    "parameter k[1..N] = ") +
            value +
            "\nH = sum(i = 1..N, p[i]^2/2) + sum(i = 1..N-1, k[i]*(q[i+1] - q[i])^2/2)\n"
            "scene pulled { q[1] = 1; h = 0.5; steps = 10 }\n");
    const Proof proof = verify_step(source, for_scene(source, {.scene = "pulled"}));
    for (const Finding& finding : proof)
      EXPECT_NE(finding.verdict, Verdict::refuted) << value << " " << finding.property;
    EXPECT_FALSE(proof.empty());
  }
}

TEST(ShippedScenes, AreProvedFromTheTextOfTheModelToThatOfTheHeader) {
  // H of the hanging spring is left with sqrt(q2^2), which has a corner.
  for (const auto& [model, scene, known] : {std::tuple{"two_bodies", "mirror", Verdict::proved},
                                            {"two_bodies", "apart", Verdict::proved},
                                            {"beads", "plucked", Verdict::proved},
                                            {"oblate_kepler", "equatorial", Verdict::proved},
                                            {"spring_pendulum", "hanging", Verdict::tested}}) {
    const std::string path = std::string(HAMGEN_SOURCE_DIR "/hamiltonians/") + model + ".ham";
    const SourceText source = read_source(path);
    const Proof proof = verify_step(source, for_scene(source, {.scene = scene}));
    for (const auto& [property, verdict] : {std::pair{"program", known},
                                            {"emitted code", known},
                                            {"specialised", known},
                                            {"model", Verdict::tested}}) {
      const auto found = std::ranges::find(proof, property, &Finding::property);
      ASSERT_NE(found, proof.end()) << model << scene << property;
      EXPECT_EQ(found->verdict, verdict) << model << scene << ": " << found->detail;
    }
  }
}

}  // namespace
}  // namespace hamgen
