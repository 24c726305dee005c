// Integrators of other libraries on the same model.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/peers/systems.hpp"

namespace hamgen::peers {

// Called with the state after each step a library took.
using Observer = std::function<void(const std::vector<double>&)>;

struct Peer {
  std::string name;
  bool adaptive = true;   // the setting is a tolerance, else a step size
  Form form = Form::any;  // what it takes, and what is more special
  std::size_t most_degrees_of_freedom = 1'000'000;
  // Moves z over `time`.  False if the library gave up.  The observer may be empty.
  std::function<bool(std::vector<double>& z, double time, double setting, const Observer&)>
      integrate;
};

// Those that take this system.
[[nodiscard]] std::vector<Peer> peers_of(std::shared_ptr<const EmittedSystem> system);

// Of the model of this name and scene, with derivatives written by hand; none if nobody has.
[[nodiscard]] std::optional<std::vector<Peer>> peers_by_hand(
    const std::string& model, const std::string& scene, const std::map<std::string, long>& sizes);

}  // namespace hamgen::peers
