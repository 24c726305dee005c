// Reference solutions with several degrees of freedom, against closed forms and integrations in
// 113-bit arithmetic by an explicit extrapolation with automatic differentiation.
#include <gtest/gtest.h>

#include "tests/app/reference_problem.hpp"

namespace hamgen::app_test {
namespace {

TEST(Reference, OfHenonAndHeiles) {
  expect_references({{"Henon-Heiles, H = 1/12",
                      "henon_heiles",
                      {"--scene", "regular"},
                      "100",
                      {{0, "0.087110463499681048"},
                       {1, "0.33362404166901964"},
                       {2, "0.259401763088530516"},
                       {3, "0.0133018927609798237"}}},
                     {"Henon-Heiles, H = 1/6",
                      "henon_heiles",
                      {"--scene", "island"},
                      "100",
                      {{0, "-0.529151960964035324"},
                       {1, "-0.12307872732645366"},
                       {2, "-0.0556781518691067881"},
                       {3, "0.320569296738868618"}}}});
}

TEST(Reference, OfKepler) {
  const auto of = [](const char* name, const char* e, const char* q1, const char* q2) {
    return Problem{name, "kepler", {"--scene", "e06", "--set", e}, "1", {{0, q1}, {1, q2}}};
  };
  expect_references(
      {of("Kepler, e = 0.2", "e=0.2", "0.17599665767001933044", "0.90789947289561487115"),
       of("Kepler, e = 0.6", "e=0.6", "-0.62894817682662423058", "0.7996647309700392666"),
       of("Kepler, e = 0.9", "e=0.9", "-1.1871884663458633858", "0.41752763873976423233"),
       of("Kepler, e = 0.99", "e=0.99", "-1.3393143181918286853", "0.13218090706078900062"),
       of("Kepler, e = 0.999", "e=0.999", "-1.3541525307684729282", "0.041795448234199008662")});
}

TEST(Reference, OfArenstorfsOrbit) {
  // The satellite starts and ends 0.0063 from the Moon, at 2 times the speed of the frame: what
  // closes to 4e-25 there is a check of the whole orbit.
  expect_reference({"Arenstorf",
                    "arenstorf",
                    {"--scene", "arenstorf"},
                    "17.0652165601579625588917206249",
                    {{0, "0.994", 1e-19L},
                     {1, "0.0", 1e-19L},
                     {2, "0.0", 1e-17L},
                     {3, "-1.00758510637908252240537862224", 1e-17L}}});
}

TEST(Reference, OfTheDoublePendulum) {
  expect_references({{"double pendulum, t = 1",
                      "double_pendulum",
                      {},
                      "1",
                      {{0, "1.09477582373490677"},
                       {1, "1.52962312350390186"},
                       {2, "-1.94251566969835726"},
                       {3, "-1.01067882822914934"}}},
                     {"double pendulum, t = 10",
                      "double_pendulum",
                      {},
                      "10",
                      {{0, "1.67912279738244996"},
                       {1, "0.993117806437875829"},
                       {2, "-1.11768305603422726"},
                       {3, "-0.589228697120611509"}}}});
}

TEST(Reference, OfTheSpringPendulum) {
  expect_references({{"spring, k = 1e2",
                      "spring_pendulum",
                      {"--set", "k=1e2"},
                      "1",
                      {{0, "0.894224077739153803"},
                       {1, "-0.477224894394303798"},
                       {2, "-0.431478279631662468"},
                       {3, "-0.865902150156620832"}}},
                     {"spring, k = 1e4",
                      "spring_pendulum",
                      {"--set", "k=1e4"},
                      "1",
                      {{0, "0.879702054668524351"},
                       {1, "-0.47582534796518139"},
                       {2, "-0.463836315130125102"},
                       {3, "-0.85808092252484877"}}},
                     {"spring, k = 1e6",
                      "spring_pendulum",
                      {"--set", "k=1e6"},
                      "1",
                      {{0, "0.879549671912561554"},
                       {1, "-0.475810077125634664"},
                       {2, "-0.464154163206450604"},
                       {3, "-0.858008758394628432"}}}});
}

TEST(Reference, OfTheMagneticField) {
  expect_reference({"magnetic",
                    "magnetic",
                    {"--scene", "drift"},
                    "100",
                    {{0, "-0.769811761400484919"},
                     {1, "-0.717347883616710294"},
                     {2, "0.4587115213357548"},
                     {3, "-0.351961706179024575"}}});
}

constexpr const char* schwarzschild = R"(system schwarzschild
coordinate t, r, phi
momentum pt, pr, L
H = (-pt^2/(1 - 2/r) + (1 - 2/r)*pr^2 + L^2/r^2)/2
scene one {
  r = 20/3
  pt = -sqrt((10 - 2)^2 - 4*0.5^2)/sqrt(10*(10 - 3 - 0.5^2))
  L = 10/sqrt(10 - 3 - 0.5^2)
  h = 1
  steps = 1000
}
)";

TEST(Reference, OfASchwarzschildGeodesic) {
  // E^2 = ((p - 2)^2 - 4 e^2)/(p (p - 3 - e^2)), L^2 = p^2/(p - 3 - e^2): p = 10, e = 1/2.
  expect_reference({"Schwarzschild",
                    schwarzschild,
                    {},
                    "1000",
                    {{0, "1145.21305323982189"},
                     {1, "18.5294309369311007"},
                     {2, "25.7066663147230867"},
                     {4, "-0.0590836242297516524"}}});
}

constexpr const char* pythagorean = R"(system pythagorean
coordinate x[1..3], y[1..3]
momentum px[1..3], py[1..3]
parameter m[1..3] = [3, 4, 5]
H = sum(i = 1..3, (px[i]^2 + py[i]^2)/(2*m[i])) - sum(i = 1..2, j = i+1..3,
      m[i]*m[j]/sqrt((x[i] - x[j])^2 + (y[i] - y[j])^2))
scene burrau {
  x = [1, -2, 1]
  y = [3, -1, -1]
  h = 0.01
  steps = 1000
}
)";

TEST(Reference, OfThreeBodies) {
  expect_references({{"figure eight",
                      "figure_eight",
                      {"--scene", "one_period"},
                      "6.325913982926211677589",
                      {{0, "-1.0", 1e-18L},
                       {1, "1.0", 1e-18L},
                       {2, "0.0", 1e-18L},
                       {6, "0.3471168881189269382427769", 1e-18L},
                       {9, "0.532724945388030229262028", 1e-18L}}},
                     {"Pythagorean",
                      pythagorean,
                      {},
                      "10",
                      {{0, "0.778480410138085493"},
                       {3, "0.141392300290086169"},
                       {1, "-2.02509247797819859"},
                       {4, "0.0972193841460583965"},
                       {2, "1.15298573629970757"},
                       {5, "-0.162610887490898418"}}}});
}

TEST(Reference, OfChains) {
  expect_references({
      {"stiff FPU, w = 50",
       "stiff_fpu",
       {"--scene", "w50"},
       "1",
       {{0, "0.747756099140788743"}, {1, "0.549612124554730422"}, {2, "0.00397191080796036953"}}},
      {"stiff FPU, w = 100",
       "stiff_fpu",
       {"--scene", "w100"},
       "1",
       {{0, "0.747755345758841685"}, {1, "0.549084907442723796"}, {2, "0.00396250802275878443"}}},
      {"stiff FPU, w = 300",
       "stiff_fpu",
       {"--scene", "w300"},
       "1",
       {{0, "0.747753091366983203"}, {1, "0.548925466948239885"}, {2, "0.00395962601539348566"}}},
      {"Toda",
       "toda",
       {"--scene", "flaschka"},
       "100",
       {{0, "0.24968814798175692"},
        {1, "0.120704691795268498"},
        {2, "-0.270392839777025419"},
        {3, "-0.392429393541180951"},
        {4, "0.499567960019187025"},
        {5, "-0.107138566478006074"}}},
      {"phi^4",
       "phi4",
       {"--scene", "ramp"},
       "10",
       {{0, "0.246544038831199127"}, {1, "0.400618936128809897"}, {2, "0.432725072136333102"}}},
  });
}

TEST(Reference, OfFermiPastaUlamTsingou) {
  expect_reference({"FPUT, N = 32",
                    "fput",
                    {"--scene", "first_mode"},
                    "50",
                    {{0, "0.00336176315878375589"},
                     {15, "0.0451887294829418113"},
                     {47, "0.0950534330956560028"}}});
}

}  // namespace
}  // namespace hamgen::app_test
