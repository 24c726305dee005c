#include "benchmarks/peers/peer.hpp"

#include "benchmarks/hand_problems.hpp"
#include "benchmarks/peers/gsl_peers.hpp"
#include "benchmarks/peers/odeint_peers.hpp"

namespace hamgen::peers {

namespace {

template <class System>
std::vector<Peer> all_peers(const std::shared_ptr<const System>& system) {
  std::vector<Peer> list = odeint_peers(system);
  std::ranges::move(gsl_peers(system), std::back_inserter(list));
  std::erase_if(list, [&](const Peer& peer) {
    return system->form() < peer.form ||
           system->degrees_of_freedom() > peer.most_degrees_of_freedom;
  });
  return list;
}

template <class Problem>
std::vector<Peer> by_hand(const Problem& problem) {
  return all_peers(std::make_shared<const HandSystem<Problem>>(problem));
}

benchmarks::HandStiffFpu stiff_fpu(double w) {
  benchmarks::HandStiffFpu problem;
  problem.w = w;
  return problem;
}

}  // namespace

Form EmittedSystem::form_at(const std::vector<double>& z) const {
  const std::size_t n = z.size() / 2;
  std::vector<double> moved = z;
  for (std::size_t i = 0; i < n; ++i) moved[n + i] += 0.3 + 0.1 * static_cast<double>(i);
  std::vector<double> elsewhere = moved;
  for (std::size_t i = 0; i < n; ++i) elsewhere[i] += 0.01 * static_cast<double>(i + 1);
  std::vector<double> first(2 * n);
  std::vector<double> other(2 * n);
  std::vector<double> third(2 * n);
  gradient(z.data(), first.data());
  gradient(moved.data(), other.data());
  gradient(elsewhere.data(), third.data());
  bool unit_mass = true;
  for (std::size_t i = 0; i < n; ++i) {
    if (first[i] != other[i] || third[n + i] != other[n + i]) return Form::any;
    unit_mass = unit_mass && other[n + i] == moved[n + i];
  }
  return unit_mass ? Form::unit_mass : Form::separable;
}

std::vector<Peer> peers_of(std::shared_ptr<const EmittedSystem> system) {
  return all_peers(system);
}

std::optional<std::vector<Peer>> peers_by_hand(const std::string& model, const std::string& scene,
                                               const std::map<std::string, long>& sizes) {
  using namespace benchmarks;  // NOLINT(google-build-using-namespace): problems
  if (model == "fput") {
    const auto size = sizes.find("N");
    if (size == sizes.end() || scene == "harmonic") return {};
    if (size->second == 24) return by_hand(HandFput<24>());
    if (size->second == 25) return by_hand(HandFput<25>());
    if (size->second == 1000) return by_hand(HandFput<1000>());
    return {};
  }
  if (model == "bodies") return by_hand(fifty_bodies());
  if (model == "mean_field") return by_hand(HandMeanField<200>());
  if (!sizes.empty()) return {};
  if (model == "pendulum") return by_hand(HandPendulum());
  if (model == "henon_heiles") return by_hand(HandHenonHeiles());
  if (model == "kepler") return by_hand(HandKepler());
  if (model == "product") return by_hand(HandProduct());
  if (model == "double_pendulum") return by_hand(HandDoublePendulum());
  if (model == "outer_solar_system") return by_hand(outer_planets());
  if (model == "stiff_fpu" && scene == "w50") return by_hand(stiff_fpu(50));
  if (model == "stiff_fpu" && scene == "w300") return by_hand(stiff_fpu(300));
  return {};
}

}  // namespace hamgen::peers
