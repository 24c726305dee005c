// Symmetric compositions of a symmetric step of order 2, and the same with the Stormer-Verlet step.
//
// A substep of size c h has the modified Hamiltonian c h H + (c h)^3 H3 + ..., so the composition
// has order 4 if sum c = 1 and sum c^3 = 0, and so on: 1, 2, 4, 8, 16 conditions for the orders 2
// to 10 (Hairer, Lubich, Wanner, V.3.2).  The tables hold the first half of the substeps; the one
// in the middle makes the sum 1.
#include <fmt/format.h>

#include "generator/schemes/all_schemes.hpp"
#include "generator/schemes/coefficients.hpp"

namespace hamgen {

namespace {

constexpr const char* kPolished = "; further digits by Newton's iteration on the order conditions";

Scheme composition(std::string name, int order, Coefficients half, std::string source) {
  Composition method{.base = {}, .substeps = palindrome(std::move(half))};
  const std::string description =
      fmt::format("{} substeps of a symmetric member", method.substeps.size());
  return {.name = std::move(name),
          .description = description,
          .order = order,
          .symmetric = true,
          .source = std::move(source),
          .method = std::move(method)};
}

// 2^(1/3) and the like.
Expression cube_root(long n) { return Expression::power(Expression(n), ratio(1, 3)); }

// c, c, (1 - 4c), c, c with 4 c^3 + (1 - 4c)^3 = 0.
Scheme suzuki_4() {
  const Expression c = Expression(1) / (Expression(4) - cube_root(4));
  return composition("suzuki-4", 4, {c, c}, "Suzuki 1990; HLW (II.4.5)");
}

// c, (1 - 2c), c with 2 c^3 + (1 - 2c)^3 = 0.
Scheme yoshida_4() {
  const Expression c = Expression(1) / (Expression(2) - cube_root(2));
  return composition("yoshida-4", 4, {c}, "Forest, Ruth 1990; Suzuki 1990; Yoshida 1990");
}

// One of the nine is free: 25/194.
Scheme mclachlan_8() {
  Coefficients half = decimals(
      {"0.5815140871052509624302422782038136910044", "-0.4101753714698501375324061500890486599642",
       "0.1851469357165877326532719498634894574402", "-0.4095523434208514193398451736889092696187",
       "0.1444059410800120410600751871569277490622", "0.2783355003936796513091070628124172294800",
       "0.3149566839162948578902813119729508819232"});
  half.insert(half.begin(), ratio(25, 194));
  return composition("mclachlan-8", 8, std::move(half),
                     std::string("McLachlan 1995, 17 stages") + kPolished);
}

}  // namespace

std::vector<Scheme> compositions() {
  return {
      yoshida_4(),
      suzuki_4(),
      composition("mclachlan-4", 4,
                  decimals({"0.28", "0.6254664284676700450123389054926490129182"}),
                  std::string("McLachlan 1995") + kPolished),
      composition("yoshida-6", 6,
                  decimals({"0.7845136104775572638194976338663498757768",
                            "0.2355732133593581336847931829785346016865",
                            "-1.1776799841788710069464156809643157346393"}),
                  std::string("Yoshida 1990, solution A") + kPolished),
      composition("mclachlan-6", 6,
                  decimals({"0.1867", "0.5554970237124783991569135436283912009641",
                            "0.1294669489134753580560452092102047808168",
                            "-0.8432656233877346085491427813848149898690"}),
                  std::string("McLachlan 1995") + kPolished),
      composition("kahan-li-6", 6,
                  decimals({"0.3921614440073141392792505574226714038049",
                            "0.3325991367893594385997486375000496468816",
                            "-0.7062461725576393598099648195492564593955",
                            "0.0822135962935508002314904481020563311033"}),
                  std::string("Kahan, Li 1997, s9odr6a; HLW V.3.2") + kPolished),
      composition("yoshida-8", 8,
                  decimals({"0.9148442462297915667487934898475096045181",
                            "0.2536933365662113541461460206899420760977",
                            "-1.4448522368606051576947306575373903549559",
                            "-0.1582406353680501752040667767597542477554",
                            "1.9381391376225259865791864874436417609536",
                            "-1.9606102329753108076076333763996636407924",
                            "0.1027998493917964406981151316012258629110"}),
                  std::string("Yoshida 1990, solution D") + kPolished),
      mclachlan_8(),
      composition("kahan-li-8", 8,
                  decimals({"0.1302024830888900808788176320967005223572",
                            "0.5611629817751083845619644077001505672662",
                            "-0.3894749626448472864080785982352483888361",
                            "0.1588419065551556008962107457071524814121",
                            "-0.3959038941332375773362315393479389360268",
                            "0.1845396409783157070918325415333754628190",
                            "0.2583743876863220472939791099949394718131",
                            "0.2950117236093102988709662402182281129765"}),
                  std::string("Kahan, Li 1997, s17odr8a; HLW V.3.2") + kPolished),
      composition("kahan-li-8b", 8,
                  decimals({"0.1271369277348785791613126201737159179447",
                            "0.5617025379888026997163253168722461444905",
                            "-0.3825347199488301888803511646139695318826",
                            "0.1600760562946474311948332456885248993580",
                            "-0.4018163743268069667281297654801968636763",
                            "0.1873667165422784972436287843859437160992",
                            "0.2607087092077924056965616011661909419477",
                            "0.2903973881251616238870147526592234780975"}),
                  std::string("Kahan, Li 1997, s17odr8b") + kPolished),
      composition("sofroniou-spaletta-10", 10,
                  decimals({"0.0787957225216864192639076793382896066655",
                            "0.3130961034151085277648124719202568214618",
                            "0.0279183832350780661095202732659494475087",
                            "-0.2295928415939070941512133968011227048369",
                            "0.1309620610771648631746568592921583635494",
                            "-0.2697334056545107143446097322172866236481",
                            "0.0749733431558914356661371056390587135038",
                            "0.1119934239998102048895750807372699052773",
                            "0.3661334495462267511931481235371469460090",
                            "-0.3991056301360358978786298105840155568961",
                            "0.1030873985274710773158027699945038722844",
                            "0.4114308739558902378207041189774777868979",
                            "-0.0048663605831352617621956593077424091247",
                            "-0.3920333537086399064480819364299801416297",
                            "0.0519425029624496470371829048314042431473",
                            "0.0506650907599244963358743425096948739410",
                            "0.0496743706397298790545688006666647946019"}),
                  std::string("Sofroniou, Spaletta 2005; HLW V.3.2") + kPolished),
  };
}

// Kicks (c_i + c_{i+1})/2 h around drifts c_i h: neighbouring kicks of Verlet steps are one.
Scheme with_verlet(const Scheme& scheme) {
  const Coefficients& c = std::get<Composition>(scheme.method).substeps;
  Splitting splitting{.kick_first = true, .kicks = {}, .drifts = c};
  Expression before(0);
  for (const Expression& substep : c) {
    splitting.kicks.push_back(ratio(1, 2) * (before + substep));
    before = substep;
  }
  splitting.kicks.push_back(ratio(1, 2) * before);
  Scheme result = scheme;
  result.name += "-verlet";
  result.needs = "separable H";
  result.description = fmt::format("{} substeps of Stormer-Verlet", c.size());
  result.method = std::move(splitting);
  return result;
}

}  // namespace hamgen
