// Block-triangular decomposition of a dependency graph, and tearing within a block.
#pragma once

#include <functional>
#include <vector>

namespace hamgen {

using Dependency = std::function<bool(int row, int column)>;

// Strongly connected components of the graph on `nodes` (row -> column it depends on), each sorted,
// in an order in which every component comes after those it depends on (Tarjan 1972).
[[nodiscard]] std::vector<std::vector<int>> strongly_connected_components(
    const std::vector<int>& nodes, const Dependency& depends);

// The same for these nodes, from a table: tearing asks for each pair again and again.
[[nodiscard]] Dependency tabulated(const std::vector<int>& nodes, const Dependency& depends);

// A set of nodes of the block that do not depend on each other in a cycle, taken greedily in the
// order of preference, returned in the order of evaluation.  may_self(i) allows i to depend on
// itself (it is then solved for).
[[nodiscard]] std::vector<int> tear(const std::vector<int>& preference, const Dependency& depends,
                                    const std::function<bool(int)>& may_self);

}  // namespace hamgen
