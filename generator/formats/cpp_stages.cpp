#include "generator/formats/cpp_stages.hpp"

#include <fmt/format.h>

#include "generator/formats/cpp_arrays.hpp"
#include "generator/formats/cpp_functions.hpp"
#include "generator/formats/cpp_step.hpp"
#include "generator/formats/cpp_tableau.hpp"
#include "generator/formats/cpp_tangent.hpp"
#include "generator/formats/numerics.hpp"

namespace hamgen {

namespace {

std::string step_text(const ScalarType& scalar) {
  return fmt::format(
      R"(constexpr int unknowns = stages * dimension;

// Many steps: the stages start from the polynomial of the step before, rounding errors of the
// updates are carried along.
class Propagator {{
 public:
  Propagator(const Parameters& par, Real h, const State& z) : par_(par), z_(z) {{
    // h b_i, the same from both ends, with the sum h: the middle takes what rounding lost.
    Real half = h / 2;
    for (int i = 0; i < stages / 2; ++i) {{
      const bool last = stages % 2 == 0 && i == stages / 2 - 1;
      scaled_[i] = last ? half : h * weight[i];
      scaled_[stages - 1 - i] = scaled_[i];
      half -= scaled_[i];
    }}
    if (stages % 2 == 1) scaled_[stages / 2] = 2 * half;
  }}

  // One step; on failure the state stays as it was.
  StepReport step() {{
    StepReport report;
    read(z_, y_);
    read(carry_, rest_);
    predict(known_);
    bool solved = iterate(report);
    if (!solved && known_) {{
      // Extrapolation may lead astray, the state itself seldom does.
      predict(false);
      solved = iterate(report);
    }}
    known_ = false;
    if (!solved) return report;
    refine();
    Real dz[dimension];
    Real length = 0;
    for (int k = 0; k < dimension; ++k) {{
      dz[k] = 0;
      for (int i = 0; i < stages; ++i) {{
        dz[k] += slope_[i][k];
        rest_[k] += refinement_.change[i * dimension + k];
      }}
      length += dz[k] * dz[k] + rest_[k] * rest_[k];
    }}
    // False for infinities and NaN alike.
    report.converged = length <= {largest};
    if (!report.converged) {{
      report.increment = length;
      return report;
    }}
    add(z_, carry_, dz, rest_);
    known_ = true;
    return report;
  }}

)",
      fmt::arg("largest", scalar.largest));
}

std::string private_text(bool newton) {
  return R"(
 private:
  // Increments Y_i - z to begin with: of the polynomial of the last step, or none.
  void predict(bool known) {
    for (int i = 0; i < stages; ++i) {
      for (int k = 0; k < dimension; ++k) {
        first_[i][k] = 0;
        if (!known) continue;
        for (int j = 0; j < stages; ++j) first_[i][k] += ahead[i][j] * slope_[j][k];
      }
    }
    restart();
  }
  void restart() {
    for (int i = 0; i < stages; ++i) {
      for (int k = 0; k < dimension; ++k) increment_[i][k] = first_[i][k];
    }
  }
  // L_i = h b_i f(Y_i).
  void evaluate() {
    for (int i = 0; i < stages; ++i) {
      for (int k = 0; k < dimension; ++k) point_[i][k] = y_[k] + (rest_[k] + increment_[i][k]);
    }
    evaluate_at_points();
  }
  void evaluate_at_points() {
    for (int i = 0; i < stages; ++i) {
      vector_field(par_, point_[i], slope_[i]);
      for (int k = 0; k < dimension; ++k) slope_[i][k] *= scaled_[i];
    }
  }
  // sum_j coupling[i][j] L_j.
  Real collected(int i, int k) const {
    Real sum = 0;
    for (int j = 0; j < stages; ++j) sum += coupling[i][j] * slope_[j][k];
    return sum;
  }
  // The points where f was evaluated are rounded to the side that the iteration came from, at every
  // step alike.  What the equations lack there is solved for too.
  void refine() {
    Real point[unknowns];
    Real lack[unknowns];
    Real slope[unknowns];
    for (bool more = true; more;) {
      for (int row = 0; row < unknowns; ++row) {
        const int i = row / dimension;
        const int k = row % dimension;
        point[row] = point_[i][k];
        lack[row] = (y_[k] - point[row]) + (rest_[k] + collected(i, k));
        slope[row] = slope_[i][k];
      }
)" + std::string(newton ? "      if (factorised_) matrix_.solve(lack);\n" : "") +
         R"(      more = refinement_(point, lack, slope);
      for (int row = 0; row < unknowns; ++row) {
        point_[row / dimension][row % dimension] = point[row];
        slope_[row / dimension][row % dimension] = refinement_.slope[row];
      }
      if (more) evaluate_at_points();
    }
  }
)";
}

std::string fixed_point_text(bool switches) {
  std::string text =
      switches
          ? "  // Y_i = z + sum coupling L, over and over.  False if that contracts slowly or not "
            "at all.\n"
          : "  // Y_i = z + sum coupling L, over and over.  False if that does not contract.\n";
  text += R"(  bool fixed_point(StepReport& report) {
    FixedPointRule<dimension, 2> rule;
)";
  if (switches) text += "    Real before = 0;\n    int slow = 0;\n";
  text += R"(    for (int iteration = 1;; ++iteration) {
      ++report.iterations;
      evaluate();
      Real moved[dimension] = {};
      Real length[dimension] = {};
      Real scale = 0;
      for (int k = 0; k < dimension; ++k) {
        for (int i = 0; i < stages; ++i) {
          const Real next = collected(i, k);
          moved[k] += magnitude(next - increment_[i][k]);
          increment_[i][k] = next;
          length[k] += magnitude(next);
        }
        scale += magnitude(y_[k]) + length[k];
      }
      const Verdict verdict = rule(moved, length, scale, iteration);
      report.increment = rule.size;
      if (verdict == Verdict::done) return true;
      if (verdict == Verdict::failed) return false;
)";
  if (switches) {
    text += R"(      const bool visible = rule.size > 4096 * epsilon * scale;
      slow = iteration > 1 && visible && 2 * rule.size > before ? slow + 1 : 0;
      if (slow >= 3) return false;
      before = rule.size;
)";
  }
  return text + "    }\n  }\n";
}

std::string newton_text(bool arrays) {
  const std::string fill =
      arrays ? R"(    hessian(par_, x, x + n, [&values](int row, int column, Real value) {
      values[row][column] += value;
    });
)"
             : "    hessian(par_, x, values);\n";
  return R"(  // I - coupling h b J H'' with the Hessian at the mean of the stages.
  bool factorise() {
    Real x[dimension];
    for (int k = 0; k < dimension; ++k) {
      x[k] = 0;
      for (int i = 0; i < stages; ++i) x[k] += increment_[i][k];
      x[k] = y_[k] + x[k] / stages;
    }
    Real values[dimension][dimension] = {};
)" + fill +
         R"(    constexpr int half = dimension / 2;
    matrix_.clear();
    for (int row = 0; row < Elimination::size; ++row) {
      const int i = row / dimension;
      const int k = row % dimension;
      for (int column = 0; column < Elimination::size; ++column) {
        const int j = column / dimension;
        const int l = column % dimension;
        const Real slope = k < half ? values[half + k][l] : -values[k - half][l];
        matrix_.put(row, column, (row == column ? 1 : 0) - coupling[i][j] * scaled_[j] * slope);
      }
    }
    return matrix_.factorise();
  }
  // Simplified Newton: one elimination serves until it contracts slowly, over many steps.
  bool newton(StepReport& report) {
    FixedPointRule<dimension, 1> rule;
    Real before = 0;
    int age = factorised_ ? 1 : 0;  // of the matrix, in iterations of this step
    for (int iteration = 1;; ++iteration) {
      ++report.iterations;
      evaluate();
      if (!factorised_) {
        if (!factorise()) return false;
        factorised_ = true;
        age = 0;
      }
      Real vector[Elimination::size];
      Real residual = 0;
      Real reach = 0;
      for (int row = 0; row < Elimination::size; ++row) {
        const int i = row / dimension;
        const int k = row % dimension;
        const Real image = collected(i, k);
        vector[row] = increment_[i][k] - image;
        residual += magnitude(vector[row]);
        reach += magnitude(y_[k]) + magnitude(increment_[i][k]) + magnitude(image);
      }
      matrix_.solve(vector);
      Real moved[dimension] = {};
      Real length[dimension] = {};
      for (int row = 0; row < Elimination::size; ++row) {
        const int i = row / dimension;
        const int k = row % dimension;
        moved[k] += magnitude(vector[row]);
        increment_[i][k] -= vector[row];
        length[k] += magnitude(increment_[i][k]);
      }
      Real scale = 0;
      for (int k = 0; k < dimension; ++k) scale += magnitude(y_[k]) + length[k];
      const Verdict verdict = rule(moved, length, scale, iteration);
      report.increment = rule.size;
      // Where the Hessian is huge the increments are small, far from any solution.
      const bool holds = 16 * residual <= reach;
      if (verdict == Verdict::done && holds) return true;
      if (verdict != Verdict::go_on) {
        factorised_ = false;
        if (age == 0 || iteration > 100) return false;
        restart();  // once more with a matrix of this step
        rule = {};
        before = 0;
        age = 0;
        continue;
      }
)" +
         R"(      const bool visible = rule.size > 4096 * epsilon * scale;
      if (before > 0 && visible && 4 * rule.size > before && age > 1) factorised_ = false;
      before = rule.size;
      ++age;
    }
  }
)";
}

std::string iterate_text(StageSolver solver) {
  switch (solver) {
    case StageSolver::fixed_point:
      return "  bool iterate(StepReport& report) { return fixed_point(report); }\n";
    case StageSolver::newton:
      return "  bool iterate(StepReport& report) { return newton(report); }\n";
    case StageSolver::both:
      return R"(  // Newton where the fixed point contracts slowly, and then for 32 steps.
  bool iterate(StepReport& report) {
    if (patience_ == 0) {
      if (fixed_point(report)) return true;
      restart();
      patience_ = 32;
    }
    --patience_;
    return newton(report);
  }
)";
  }
  return "";
}

}  // namespace

void write_stage_hessian(CodeWriter& out, CppContext& context) {
  if (context.arrays()) {  // hessian(par, q, p, put) is there
    if (context.options.tangent) write_array_stage_hessian(out);
    return;
  }
  context.write_routine(out, "hessian");
}

void write_stages(CodeWriter& out, CppContext& context, const RungeKutta& tableau) {
  const StageSolver solver = *context.program.plan.stage_solver;
  const bool newton = solver != StageSolver::fixed_point;
  write_tableau(out, context.scalar, context.program.sequence.stages, tableau.c);
  const bool tangent = context.options.tangent;
  if (newton || tangent) write_stage_hessian(out, context);
  out.lines(cpp_numerics("verdict") + cpp_numerics("fixed_point_rule") +
            cpp_numerics("refinement"));
  if (newton || tangent) {
    out.lines(cpp_numerics("dense_matrix"));
    out.line("using Elimination = DenseMatrix<stages * dimension>;");
    out.line();
  }
  out.lines(step_text(context.scalar));
  out.indent();
  write_advance(out);
  out.dedent();
  if (tangent) out.lines(stages_tangent());
  out.lines(private_text(newton));
  if (solver != StageSolver::newton) {
    out.lines(fixed_point_text(solver == StageSolver::both));
  }
  if (newton) out.lines(newton_text(context.arrays()));
  out.lines(iterate_text(solver));
  out.lines(R"(
  Parameters par_;
  State z_;
  State carry_;
  Real scaled_[stages] = {};                // h b_i
  Real y_[dimension] = {};                  // z as an array
  Real rest_[dimension] = {};               // the carry, then all that is small of the increment
  Real first_[stages][dimension] = {};      // Y_i - z to begin with
  Real increment_[stages][dimension] = {};  // Y_i - z
  Real point_[stages][dimension] = {};      // Y_i, rounded
  Real slope_[stages][dimension] = {};      // L_i there
  Refinement<unknowns, unknowns> refinement_;
  bool known_ = false;                      // L_i are of the step before
)");
  if (newton) out.lines("  Elimination matrix_;\n  bool factorised_ = false;\n");
  if (solver == StageSolver::both) out.lines("  int patience_ = 0;  // steps left to Newton\n");
  out.lines("};\n\n");
}

}  // namespace hamgen
