// Reference solutions with one degree of freedom against closed forms and periods, and against
// integrations in 113-bit arithmetic by an explicit extrapolation with automatic differentiation.
#include <gtest/gtest.h>

#include "tests/app/reference_problem.hpp"

namespace hamgen::app_test {
namespace {

// After a period the state is the initial one.  The digits of the period count with the speed,
// below 1 here unless a tolerance says more.
TEST(Reference, OfThePendulum) {
  expect_references({
      {"pendulum, q0 = 0.8",
       "pendulum",
       {"--initial", "q=0.8,p=0"},
       "100",
       {{0, "-0.487705690688532389"}, {1, "0.105840517980004865"}}},
      {"pendulum, q0 = 2.5",
       "pendulum",
       {"--initial", "q=2.5,p=0"},
       "100",
       {{0, "-1.29772507248023753"}, {1, "0.253475889400307744"}}},
      {"pendulum, q0 = 3.1",
       "pendulum",
       {"--initial", "q=3.1,p=0"},
       "100",
       {{0, "2.29712982881406863"}, {1, "0.141774928393845888"}}},
      {"pendulum, q0 = 3.13",
       "pendulum",
       {"--initial", "q=3.13,p=0"},
       "100",
       {{0, "-2.73786286440304995"}, {1, "0.0694250661413196795"}}},
      {"period of 0.8",
       "pendulum",
       {"--initial", "q=0.8,p=0"},
       "37.78257427312574976252",
       {{0, "0.8", 1e-19L}, {1, "0.0", 1e-19L}}},
      {"period of 2.5",
       "pendulum",
       {"--initial", "q=2.5,p=0"},
       "59.60080859497882316393",
       {{0, "2.5", 5e-19L}, {1, "0.0", 1e-19L}}},
      {"period of 3.1",
       "pendulum",
       {"--initial", "q=3.1,p=0"},
       "121.4700144823372372842",
       {{0, "3.1", 5e-19L}, {1, "0.0", 1e-19L}}},
  });
}

TEST(Reference, OfTheHarmonicOscillator) {
  // q = cos(1000), p = -1000 sin(1000) for w = 1000 after t = 1.
  expect_references({{"harmonic",
                      "harmonic",
                      {"--scene", "unit"},
                      "2*pi",
                      {{0, "1.0", 1e-19L}, {1, "0.0", 1e-19L}}},
                     {"harmonic, w = 1000",
                      "harmonic",
                      {"--scene", "stiff"},
                      "pi/100",
                      {{0, "1.0", 1e-19L}, {1, "0.0", 1e-16L}}}});
}

constexpr const char* wall = R"(system wall
coordinate q
momentum p
size m = 32
H = p^2/2 + q^(2*m)/(2*m)
scene one {
  p = 1
  h = 0.01
  steps = 1000
}
)";

TEST(Reference, OfTheMonomialWall) {
  const auto of = [](const char* m, const char* period) {
    return Problem{"wall", wall, {"--set", m}, period, {{0, "0.0", 1e-19L}, {1, "1.0", 1e-17L}}};
  };
  expect_references({of("m=2", "6.236338999021644921159"), of("m=3", "5.833312628520677158767"),
                     of("m=4", "5.535010258628305488459"), of("m=8", "4.938254055084094692739"),
                     of("m=16", "4.548161147029778329592"), of("m=32", "4.313349246022697451714")});
  expect_reference({"wall, t = 10",
                    wall,
                    {},
                    "10",
                    {{0, "0.783373115025920996"}, {1, "-0.999999997442507085"}}});
}

TEST(Reference, OfDuffingAndMorse) {
  expect_references({
      {"duffing, one well",
       "duffing",
       {"--scene", "one_well"},
       "4.623905221811913002917",
       {{0, "1.2", 1e-19L}, {1, "0.0", 1e-19L}}},
      {"duffing, both wells",
       "duffing",
       {"--scene", "both_wells"},
       "9.223662748324173107576",
       {{0, "1.5", 1e-19L}, {1, "0.0", 1e-19L}}},
      {"morse",
       "morse",
       {"--scene", "bound"},
       "100",
       {{0, "1.01702301188469242"}, {1, "-0.824839278083011115"}}},
      {"morse, period",
       "morse",
       {"--scene", "bound"},
       "8.844208569930647780734",
       {{0, "2.0", 1e-19L}, {1, "0.0", 1e-19L}}},
  });
}

constexpr const char* inverse_square = R"(system inverse_square
coordinate q
momentum p
parameter g = 1
H = p^2/2 + g/q^2
scene one {
  q = 1
  p = -1/2
  h = 0.01
  steps = 1000
}
)";

TEST(Reference, OfTheInverseSquare) {
  // q^2 = q0^2 + 2 q0 p0 t + 2 E t^2 with E = 9/8: at t = 2, q^2 = 1 - 2 + 9 = 8.
  expect_reference({"inverse square", inverse_square, {}, "2", {{0, "2.828427124746190098"}}});
}

TEST(Reference, OfTheProduct) {
  expect_references({
      {"product, t = 1",
       "product",
       {"--scene", "tao"},
       "1",
       {{0, "-2.54721840378759952"}, {1, "0.579148281369033415"}}},
      {"product, t = 10",
       "product",
       {"--scene", "tao"},
       "10",
       {{0, "-0.690609507457253471"}, {1, "-2.40223831310082726"}}},
      {"product, t = 100",
       "product",
       {"--scene", "tao"},
       "100",
       {{0, "2.10720622005237038"}, {1, "0.915493214909792463"}}},
      // The speed is q' = (q^2 + 1) p = -3 at the end.
      {"product, period",
       "product",
       {"--scene", "tao"},
       "3.261057238358885321096",
       {{0, "0.0", 1e-19L}, {1, "-3.0", 5e-19L}}},
  });
}

TEST(Reference, OfTheDrivenOscillator) {
  expect_references({{"driven, s = 10",
                      "driven_oscillator",
                      {"--scene", "modulated"},
                      "10",
                      {{0, "-1.03688741508004341"},
                       {1, "10.0"},
                       {2, "0.441253599041630633"},
                       {3, "0.0552914346548973664"}}},
                     {"driven, s = 100",
                      "driven_oscillator",
                      {"--scene", "modulated"},
                      "100",
                      {{0, "0.404543617238134315"},
                       {1, "100.0"},
                       {2, "1.45929987042748774"},
                       {3, "-0.560718150957473082"}}}});
}

}  // namespace
}  // namespace hamgen::app_test
