// Systems of one text at several sizes.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "generator/verify/growth.hpp"
#include "generator/verify/proof.hpp"
#include "tests/verify/mutants.hpp"

namespace hamgen::verify_test {

// The system of a text at a size.
inline SizedSystem system_of(const std::string& text, long size, const std::string& scheme_name,
                             int order = 2, const std::string& solver = "fixed-point") {
  const Model model = read_model(
      make_source("chain.ham", fmt::format("system chain\nsize N = {}\n{}", size, text)));
  Mechanics mechanics = derive(model, true, 0);  // in loops at any size
  EXPECT_TRUE(mechanics.keeps_sums()) << text;
  Scheme scheme = for_system(*find_scheme(scheme_name), mechanics);
  if (order > 2) scheme = raise_order(std::move(scheme), order);
  const bool is_explicit = scheme_name == "stormer-verlet" || scheme_name == "rk4";
  const LoweredStep lowered = lowered_of(mechanics, scheme, is_explicit ? "" : solver);
  return {size,         std::move(mechanics),   std::move(scheme),
          lowered.plan, build_program(lowered), written_out_hamiltonian(model)};
}

inline SizedOutline routines(const SizedSystem& system) {
  return {system.size, outline(system.program, {"invariants"})};
}
inline SizedOutline kernels(const SizedSystem& system) {
  return {system.size, outline(system.mechanics.kernels)};
}

}  // namespace hamgen::verify_test
