// From the claims about two small systems to those about a longer one of the same kind.
//
// Where the routines of size N are those of size M but for ends of loops and places that grow with
// the size, and each instance of a growing loop knows its neighbours only, an element of the longer
// system has the neighbours of some element of the shorter ones: its claim is the claim there, with
// other names.  A sum over all elements is the right one, too: its slope by each variable is, by
// the same argument, so that it can be wrong by a constant only, which is affine in N, and vanishes
// at M and M + 1.
//
// A sum over all elements that a loop reads is to an element one number more, the same for all:
// what is claimed is E(z near k, C1, C2, ...) = 0, where E does not know N.  In the short systems
// it vanishes for all z.  If there the sums take all values of an open set, whatever is near k, E
// vanishes there, as the analytic function that it is everywhere, and so for the sums of a longer
// system.  That they do is for independent_sums.hpp to see.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "generator/verify/code_outline.hpp"

namespace hamgen {

struct SizedOutline {
  long size = 0;  // the constant of the model
  std::vector<CodeEvent> events;
};

// How long the first has to be for what its loops reach; 0 where that is not known.
[[nodiscard]] long least_size(const std::array<SizedOutline, 3>& sizes);
// Why the third is not the first two, longer; empty if it is, but for what sums are read in it. The
// sizes of the first two differ.
[[nodiscard]] std::optional<std::string> why_not_longer(const std::array<SizedOutline, 3>& sizes);
// The routines in which sums over all elements are read, of outlines that continue each other.
[[nodiscard]] std::set<std::string> readers_of_sums(const std::array<SizedOutline, 3>& sizes);

}  // namespace hamgen
