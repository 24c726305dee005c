// Reference solutions against values that were computed otherwise: closed forms, and integrations
// in 113-bit arithmetic by an explicit extrapolation with automatic differentiation.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

// A value of the state at the end: q1..qn, p1..pn from place 0.
struct Expected {
  std::size_t place = 0;
  const char* value = "";
  long double tolerance = 0;  // 0: two units of the last digit
};

struct Problem {
  const char* name = "";
  const char* model = "";                 // of hamiltonians/, or the text of a model
  std::vector<std::string> options = {};  // scene, --set, --initial
  const char* time = "";
  std::vector<Expected> expected = {};
};

// Two units of the last digit that is printed.
long double resolution(const std::string& digits) {
  const std::size_t point = digits.find('.');
  return 2 * std::pow(10.0L, -static_cast<long double>(digits.size() - 1 - point));
}

void expect_reference(const Problem& problem) {
  const Scratch scratch;
  const std::string text = problem.model;
  const std::string path = text.find('\n') == std::string::npos
                               ? HAMGEN_SOURCE_DIR "/hamiltonians/" + text + ".ham"
                               : scratch.write("m.ham", text);
  std::vector<std::string> words = {"bench",     path,
                                    "--time",    problem.time,
                                    "--h",       std::string(problem.time) + "/1000",
                                    "--schemes", "symplectic-euler-a",
                                    "--rounds",  "1",
                                    "--json",    "--quiet"};
  words.insert(words.end(), problem.options.begin(), problem.options.end());
  const Result result = hamgen(words);
  ASSERT_EQ(result.status, 0) << problem.name << ": " << result.err;
  const json reference = json::parse(result.out)["reference"];
  ASSERT_TRUE(reference.contains("state")) << problem.name << ": " << reference;
  const double own_error = reference["error"];
  EXPECT_LT(own_error, 1e-17) << problem.name;
  std::printf("%-24s own error %.1e, %.2f s\n", problem.name, own_error,
              reference["seconds"].get<double>());
  for (const Expected& expected : problem.expected) {
    const json& pair = reference["state"][expected.place];
    const long double wanted = std::strtold(expected.value, nullptr);
    const long double difference =
        (pair[0].get<long double>() - wanted) + pair[1].get<long double>();
    const long double bound =
        expected.tolerance > 0 ? expected.tolerance : resolution(expected.value);
    EXPECT_LE(std::fabs(difference), bound + 10 * own_error)
        << problem.name << ", component " << expected.place;
  }
}

void expect_references(const std::vector<Problem>& problems) {
  for (const Problem& problem : problems) expect_reference(problem);
}

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
                      {"--scene", "stable"},
                      "10",
                      {{0, "-1.03688741508004341"},
                       {1, "10.0"},
                       {2, "0.441253599041630633"},
                       {3, "0.0552914346548973664"}}},
                     {"driven, s = 100",
                      "driven_oscillator",
                      {"--scene", "stable"},
                      "100",
                      {{0, "0.404543617238134315"},
                       {1, "100.0"},
                       {2, "1.45929987042748774"},
                       {3, "-0.560718150957473082"}}}});
}

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
                      {"--scene", "chaotic"},
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
