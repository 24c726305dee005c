// Tangent maps of systems in loops: M = dZ/dz, column by column, H'' never stored but multiplied
// by.
#include <fmt/format.h>

#include "generator/formats/cpp_arrays.hpp"
#include "generator/formats/cpp_tangent.hpp"

namespace hamgen {

namespace {

constexpr const char* kUnit = R"(    for (int column = 0; column < 2 * n; ++column) {
      State u;
      (column < n ? u.q[column] : u.p[column - n]) = 1;
)";

// Column by column in M, and whether all of it is finite.
std::string columns(const std::string& body, const ScalarType& scalar) {
  return "    Real length = 0;\n" + std::string(kUnit) + body +
         fmt::format(R"(      for (int i = 0; i < 2 * n; ++i) length += m[i][column] * m[i][column];
    }}
    // False for infinities and NaN alike.
    return length <= {};
  }}
)",
                     scalar.largest);
}

// Z = z + h J grad H(zbar): column u + h J y.
constexpr const char* kResult = R"(      for (int i = 0; i < n; ++i) {
        m[i][column] = u.q[i] + h_ * y.p[i];
        m[n + i][column] = u.p[i] - h_ * y.q[i];
      }
)";

// The stage moves by dzbar = u + h (I/2 + C) J y, y = H'' dzbar.
std::string solved(const ArrayPlan& plan, const ArrayWeights& w, const ScalarType& scalar) {
  const std::string head =
      R"(
  // M = dZ/dz of the step from here: a displacement u moves the stage by
  // dzbar = u + h (I/2 + C) J H'' dzbar, solved with the matrix of Newton's iteration, and Z by
  // u + h J H'' dzbar.  False if there is no such step.
  bool tangent(Real (&m)[2 * n][2 * n]) {
    bar_ = z_;
    StepReport report;
    if (!iterate(report) || !factorise()) return false;
)";
  if (!plan.reduced) {
    return head + columns(R"(      for (int i = 0; i < n; ++i) {
        residual_[i] = u.q[i];
        residual_[n + i] = u.p[i];
      }
      matrix_.solve(residual_);
      State moved;
      for (int i = 0; i < n; ++i) {
        moved.q[i] = residual_[i];
        moved.p[i] = residual_[n + i];
      }
      const State y = curvature(bar_, moved);
)" + std::string(kResult),
                          scalar);
  }
  // The momenta are torn out: dpbar = (u_p - h (1 - alpha) y) / (1 + h beta m), y = V'' dqbar.
  const std::string mass = plan.mass ? "mass_" : "mass_[i]";
  auto torn = [&](const std::string& value) {
    if (w.p_by_p.empty()) return value.find(' ') == std::string::npos ? value : "(" + value + ")";
    const bool is_sum = value.find(' ') != std::string::npos;
    return fmt::format("({} / (1 + {} * {}))", is_sum ? "(" + value + ")" : value, w.p_by_p, mass);
  };
  std::string start = "u.q[i]";
  if (!w.q_by_p.empty()) start += fmt::format(" + {} * {} * {}", w.q_by_p, mass, torn("u.p[i]"));
  return head +
         columns(fmt::format(R"(      for (int i = 0; i < n; ++i) {{
        residual_[i] = {};
      }}
      matrix_.solve(residual_);
      State moved;
      for (int i = 0; i < n; ++i) moved.q[i] = residual_[i];
      State y = curvature(bar_, moved);
      for (int i = 0; i < n; ++i) {{
        y.p[i] = {} * {};
      }}
)",
                             start, mass, torn("u.p[i]" + weighted("-", w.p_by_q, "y.q[i]"))) +
                     kResult,
                 scalar);
}

std::string swept(const Mechanics& mechanics, const ArrayWeights& w, int sweeps,
                  const ScalarType& scalar) {
  return R"(
  // M = dZ/dz of the sweeps from here, each linearised.
  bool tangent(Real (&m)[2 * n][2 * n]) {
)" + columns(gradient_at(mechanics, "z_", 6) +
                 fmt::format(R"(      State y = curvature(z_, u);
      for (int sweep = 0; sweep < {}; ++sweep) {{
        State moved;
        for (int i = 0; i < n; ++i) {{
          bar_.q[i] = {};
          bar_.p[i] = {};
          moved.q[i] = u.q[i]{}{};
          moved.p[i] = u.p[i]{}{};
        }}
)",
                             sweeps, stage_q(w), stage_p(w), weighted("+", w.q_by_p, "y.p[i]"),
                             weighted("+", w.q_by_q, "y.q[i]"), weighted("-", w.p_by_q, "y.q[i]"),
                             weighted("-", w.p_by_p, "y.p[i]")) +
                 gradient_at(mechanics, "bar_", 8) + R"(        y = curvature(bar_, moved);
      }
)" + kResult,
             scalar);
}

// A kick and a drift, or a drift and a kick; H'' at zbar has both blocks.
std::string explicit_tangent(bool kick_first, const ScalarType& scalar) {
  const std::string head = kick_first ? R"(
  // M = dZ/dz of the step from here: the kick's times the drift's.
  bool tangent(Real (&m)[2 * n][2 * n]) {
    State bar = z_;
    potential_gradient(par_, z_.q, slope_.q);
    for (int i = 0; i < n; ++i) bar.p[i] = z_.p[i] - h_ * slope_.q[i];
)"
                                      : R"(
  // M = dZ/dz of the step from here: the drift's times the kick's.
  bool tangent(Real (&m)[2 * n][2 * n]) {
    State bar = z_;
    kinetic_gradient(par_, z_.p, slope_.p);
    for (int i = 0; i < n; ++i) bar.q[i] = z_.q[i] + h_ * slope_.p[i];
)";
  std::string body;
  const char* lines[] = {"u.p[i] -= h_ * y.q[i]", "u.q[i] += h_ * y.p[i]"};
  for (int part = 0; part < 2; ++part) {
    const bool is_kick = kick_first == (part == 0);
    body += fmt::format("      {} = curvature(bar, u);\n", part == 0 ? "State y" : "y");
    body += fmt::format("      for (int i = 0; i < n; ++i) {};\n", lines[is_kick ? 0 : 1]);
  }
  body += R"(      for (int i = 0; i < n; ++i) {
        m[i][column] = u.q[i];
        m[n + i][column] = u.p[i];
      }
)";
  return head + columns(body, scalar);
}

}  // namespace

std::string array_tangent(const Mechanics& mechanics, const SolvePlan& plan,
                          const ArrayWeights& weights, const ScalarType& scalar) {
  const ArrayPlan& arrays = *plan.arrays;
  if (iterates(arrays)) return solved(arrays, weights, scalar);
  if (arrays.method == ArrayMethod::sweeps) return swept(mechanics, weights, *plan.sweeps, scalar);
  return explicit_tangent(arrays.method == ArrayMethod::explicit_a, scalar);
}

std::string array_curvature(const ArrayPlan& plan) {
  if (plan.reduced) {
    return R"(  // V'' u at a state.
  State curvature(const State& at, const State& u) const {
    State y;
    hessian(par_, at.q, [&](int row, int column, Real value) { y.q[row] += value * u.q[column]; });
    return y;
  }

)";
  }
  return R"(  // H'' u at a state.
  State curvature(const State& at, const State& u) const {
    State y;
    hessian(par_, at.q, at.p, [&](int row, int column, Real value) {
      (row < n ? y.q[row] : y.p[row - n]) += value * (column < n ? u.q[column] : u.p[column - n]);
    });
    return y;
  }

)";
}

void write_array_tangent_of(CodeWriter& out, StepRole role) {
  out.lines(fmt::format(R"(// M = dZ/dz of one step from z.  False if there is none.
inline bool {}(const Parameters& par, Real h, const State& z, const State&,
                    Real (&m)[2 * n][2 * n]) {{
  {} propagator(par, h, z);
  return propagator.tangent(m);
}}

)",
                        tangent_name(role), class_name(role)));
}

void write_array_splitting_tangent(CodeWriter& out, const CppContext& context) {
  const auto& substeps = context.program.sequence.substeps;
  const bool kick_first = substeps.front().kind == SubstepKind::kick;
  out.lines(fmt::format(
      R"(// M = dZ/dz of one step from z, the product over its substeps: a kick moves the momenta's
// displacement by -b h V'' of the coordinates', a drift these by a h T'' of those.
inline bool tangent(const Parameters& par, Real h, const State& z, const State&,
                    Real (&m)[2 * n][2 * n]) {{
  const Coefficients k = prepare(par, h);
  Real length = 0;
  for (int column = 0; column < 2 * n; ++column) {{
    State now = z;
    State u;
    (column < n ? u.q[column] : u.p[column - n]) = 1;
    for (int substep = 0; substep < {}; ++substep) {{
      State y;
      hessian(par, now.q, now.p, [&](int row, int entry, Real value) {{
        (row < n ? y.q[row] : y.p[row - n]) += value * (entry < n ? u.q[entry] : u.p[entry - n]);
      }});
      Real slope[n];
      if (substep % 2 == {}) {{
        potential_gradient(par, now.q, slope);
        for (int i = 0; i < n; ++i) {{
          now.p[i] -= k.kick[substep / 2] * slope[i];
          u.p[i] -= k.kick[substep / 2] * y.q[i];
        }}
      }} else {{
        kinetic_gradient(par, now.p, slope);
        for (int i = 0; i < n; ++i) {{
          now.q[i] += k.drift[substep / 2] * slope[i];
          u.q[i] += k.drift[substep / 2] * y.p[i];
        }}
      }}
    }}
    for (int i = 0; i < n; ++i) {{
      m[i][column] = u.q[i];
      m[n + i][column] = u.p[i];
      length += u.q[i] * u.q[i] + u.p[i] * u.p[i];
    }}
  }}
  // False for infinities and NaN alike.
  return length <= {};
}}

)",
      substeps.size(), kick_first ? 0 : 1, context.scalar.largest));
}

void write_array_stage_hessian(CodeWriter& out) {
  out.lines(R"(// The second derivatives of H at a state as one array, added to values.
inline void hessian(const Parameters& par, const Real (&x)[dimension],
                    Real (&values)[dimension][dimension]) {
  hessian(par, x, x + n,
          [&](int row, int column, Real value) { values[row][column] += value; });
}

)");
}

}  // namespace hamgen
