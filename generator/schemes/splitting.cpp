// Splittings of H = T(p) + V(q) into drifts and kicks, each solved exactly.
#include <fmt/format.h>

#include "generator/schemes/all_schemes.hpp"
#include "generator/schemes/coefficients.hpp"

namespace hamgen {

namespace {

constexpr const char* kSeparable = "separable H";
constexpr const char* kNystrom = "separable H, T quadratic in p";
constexpr const char* kMoreDigits =
    "; further digits by Newton's iteration on the order conditions";

bool is_palindrome(const Coefficients& values) {
  return std::equal(values.begin(), values.end(), values.rbegin());
}

Scheme splitting(std::string name, int order, Splitting method, std::string source,
                 std::string needs = kSeparable) {
  const bool symmetric = is_symmetric(method);
  auto count = [](std::size_t n, const char* what) {
    return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
  };
  const std::string kicks = count(method.kicks.size(), "kick");
  const std::string drifts = count(method.drifts.size(), "drift");
  const std::string description =
      method.kick_first ? kicks + " and " + drifts : drifts + " and " + kicks;
  return {.name = std::move(name),
          .description = description,
          .order = order,
          .symmetric = symmetric,
          .needs = std::move(needs),
          .source = std::move(source),
          .method = std::move(method)};
}

Scheme drift_first(std::string name, int order, Coefficients drifts, Coefficients kicks,
                   std::string source, std::string needs = kSeparable) {
  return splitting(std::move(name), order,
                   {.kick_first = false, .kicks = std::move(kicks), .drifts = std::move(drifts)},
                   std::move(source), std::move(needs));
}

Scheme kick_first(std::string name, int order, Coefficients kicks, Coefficients drifts,
                  std::string source, std::string needs = kSeparable) {
  return splitting(std::move(name), order,
                   {.kick_first = true, .kicks = std::move(kicks), .drifts = std::move(drifts)},
                   std::move(source), std::move(needs));
}

Expression root(const Expression& e) { return square_root(e); }

// SABA_n: drifts at the nodes of Gauss, SBAB_n: kicks at those of Lobatto (Laskar, Robutel 2001).
// Order 2; for V of size eps the error is O(eps h^(2n) + eps^2 h^2).
std::vector<Scheme> laskar_robutel() {
  const std::string source = "Laskar, Robutel 2001";
  const Expression half = ratio(1, 2);
  const Expression r3 = root(Expression(3));
  const Expression r5 = root(Expression(5));
  const Expression r15 = root(Expression(15));
  const Expression r30 = root(Expression(30));
  const Expression outer = root(Expression(525) + Expression(70) * r30) / Expression(70);
  const Expression inner = root(Expression(525) - Expression(70) * r30) / Expression(70);
  const Expression r37 = root(ratio(3, 7));
  return {
      drift_first("saba-1", 2, {half, half}, {1}, source),
      drift_first("saba-2", 2, {half - r3 / 6, r3 / 3, half - r3 / 6}, {half, half}, source),
      drift_first("saba-3", 2, {half - r15 / 10, r15 / 10, r15 / 10, half - r15 / 10},
                  {ratio(5, 18), ratio(4, 9), ratio(5, 18)}, source),
      drift_first("saba-4", 2,
                  {half - outer, outer - inner, Expression(2) * inner, outer - inner, half - outer},
                  {ratio(1, 4) - r30 / 72, ratio(1, 4) + r30 / 72, ratio(1, 4) + r30 / 72,
                   ratio(1, 4) - r30 / 72},
                  source),
      kick_first("sbab-1", 2, {half, half}, {1}, source),
      kick_first("sbab-2", 2, {ratio(1, 6), ratio(2, 3), ratio(1, 6)}, {half, half}, source),
      kick_first("sbab-3", 2, {ratio(1, 12), ratio(5, 12), ratio(5, 12), ratio(1, 12)},
                 {half - r5 / 10, r5 / 5, half - r5 / 10}, source),
      kick_first("sbab-4", 2,
                 {ratio(1, 20), ratio(49, 180), ratio(16, 45), ratio(49, 180), ratio(1, 20)},
                 {half - r37 / 2, r37 / 2, r37 / 2, half - r37 / 2}, source),
      drift_first("saba-2-printed", 2, {ratio(1, 6), ratio(2, 3), ratio(1, 6)}, {half, half},
                  "Jimenez-Perez, Vilotte, Romanowicz 2015, as printed: not Laskar-Robutel's"),
  };
}

// The triple jump with drift, kick, drift in place of kick, drift, kick.
Scheme forest_ruth() {
  const Expression c =
      Expression(1) / (Expression(2) - Expression::power(Expression(2), ratio(1, 3)));
  const Coefficients kicks = palindrome({c});
  return drift_first("forest-ruth-4", 4, even_palindrome({c / 2}), kicks, "Forest, Ruth 1990");
}

Scheme mclachlan_4() {
  const Expression r19 = root(Expression(19));
  return drift_first(
      "mclachlan-4-abab", 4,
      even_palindrome({(Expression(14) - r19) / 108, (Expression(20) - Expression(7) * r19) / 108}),
      palindrome({ratio(2, 5), ratio(-1, 10)}), "McLachlan 1995, 5 stages");
}

}  // namespace

bool is_symmetric(const Splitting& method) {
  return method.kicks.size() != method.drifts.size() && is_palindrome(method.kicks) &&
         is_palindrome(method.drifts);
}

std::vector<Scheme> splittings() {
  std::vector<Scheme> list{
      kick_first("stormer-verlet", 2, {ratio(1, 2), ratio(1, 2)}, {1},
                 "HLW I.1.4, kick drift kick"),
      drift_first("position-verlet", 2, {ratio(1, 2), ratio(1, 2)}, {1},
                  "HLW I.1.4, drift kick drift"),
  };
  for (Scheme& scheme : laskar_robutel()) list.push_back(std::move(scheme));
  const std::vector<Scheme> higher{
      kick_first("ruth-3", 3, {ratio(7, 24), ratio(3, 4), ratio(-1, 24)},
                 {ratio(2, 3), ratio(-2, 3), 1}, "Ruth 1983"),
      forest_ruth(),
      mclachlan_4(),
      drift_first("mclachlan-4-sb3a", 4,
                  even_palindrome(decimals({"0.4051886183952522772205531983898517327134",
                                            "-0.2871440408165240889966277933622274550686"})),
                  palindrome({ratio(-3, 73), ratio(17, 59)}),
                  std::string("McLachlan 1995") + kMoreDigits),
      drift_first("omelyan-4", 4,
                  palindrome(decimals(
                      {"0.1786178958448091", "-0.0662645826698182342926665340609061831528"})),
                  even_palindrome(decimals({"0.7123418310626061162212669163280542754452"})),
                  std::string("Omelyan, Mryglod, Folk 2002, PEFRL") + kMoreDigits),
      drift_first("blanes-moan-4", 4,
                  palindrome(decimals({"0.0792036964311956694336634958882688733080",
                                       "0.3531729060497739884810613115731210565304",
                                       "-0.0420650803577195353681102983025170387204"})),
                  even_palindrome(decimals({"0.2095151066133620212740726400295010169021",
                                            "-0.1438517731798180082751150578565277256482"})),
                  std::string("Blanes, Moan 2002, S6") + kMoreDigits),
      drift_first("blanes-moan-6", 6,
                  palindrome(decimals({"0.0502627644003926860212216544020741094060",
                                       "0.4135143004283438150630637201338844389753",
                                       "0.0450798897943980629688970521245134711617",
                                       "-0.1880548538195689147991284889188705424878",
                                       "0.5419606784507801348314147409330724963482"})),
                  even_palindrome(decimals({"0.1488164479010432319209010055355775888774",
                                            "-0.1323858657677836474488454265989399215745",
                                            "0.0673076046921844581502578965926010468994",
                                            "0.4326664025781735975276679708835452980582"})),
                  std::string("Blanes, Moan 2002, S10") + kMoreDigits),
      kick_first("blanes-moan-rkn-4", 4,
                 palindrome(decimals({"0.0829844064174050188383474789422501124947",
                                      "0.3963098014983680770949115282636867393961",
                                      "-0.0390563049223484351708652907653792422876"})),
                 even_palindrome(decimals({"0.2452989571842711626039324260014008804072",
                                           "0.6048726657110799749608926976430762452210"})),
                 std::string("Blanes, Moan 2002, SRKN 6b") + kMoreDigits, kNystrom),
      kick_first("blanes-moan-rkn-6", 6,
                 even_palindrome(decimals({"0.0414649985182628432987781339147049367239",
                                           "0.1981286719180665411367264731814969606125",
                                           "-0.0400061921041526868888283635359448393757",
                                           "0.0752539843015803411278788785270427555418",
                                           "-0.0115113874206877700624432015012891995526"})),
                 palindrome(decimals({"0.1232297759462711515610863803333667525905",
                                      "0.2905537977995582703664141693279161833302",
                                      "-0.1270492126254169156625050538274859344730",
                                      "-0.2463317610620754041949734891040628625960",
                                      "0.3572088727959277526198603496193104628369"})),
                 std::string("Blanes, Moan 2002, SRKN 11b") + kMoreDigits, kNystrom),
  };
  list.insert(list.end(), higher.begin(), higher.end());
  return list;
}

}  // namespace hamgen
