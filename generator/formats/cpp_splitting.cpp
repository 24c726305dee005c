// Kicks and drifts.
#include <fmt/format.h>

#include "generator/base/diagnostic.hpp"
#include "generator/formats/cpp_arrays.hpp"
#include "generator/formats/cpp_functions.hpp"
#include "generator/formats/cpp_member.hpp"
#include "generator/formats/cpp_schemes.hpp"
#include "generator/formats/cpp_support.hpp"

namespace hamgen {

namespace {

// Of the two kinds of substeps the one that comes first and the other.
struct Kind {
  std::string gradient;      // "potential_gradient"
  std::string coefficients;  // "kick"
  std::string values;        // where its gradient stands
  bool kick = true;
};

class SplittingWriter {
 public:
  SplittingWriter(CodeWriter& out, CppContext& context)
      : out_(out),
        context_(context),
        kicks_(numbers(lengths_of(context.program.sequence, SubstepKind::kick))),
        drifts_(numbers(lengths_of(context.program.sequence, SubstepKind::drift))),
        closed_(kicks_.size() != drifts_.size()) {
    const std::vector<Substep>& substeps = context.program.sequence.substeps;
    const bool kick_first = substeps.front().kind == SubstepKind::kick;
    for (std::size_t i = 1; i < substeps.size(); ++i) {
      if (substeps[i].kind == substeps[i - 1].kind)
        internal_error("substeps that do not alternate");
    }
    const Kind kick{"potential_gradient", "kick", "", true};
    const Kind drift{"kinetic_gradient", "drift", "", false};
    first_ = kick_first ? kick : drift;
    second_ = kick_first ? drift : kick;
    first_.values = closed_ ? "start.value" : "first";
    second_.values = "second";
  }

  void write() {
    write_types(out_, context_, false);
    MemberParts parts;
    parts.coefficients = true;
    const std::vector<ScaledNumbers> scaled{{"kick", kicks_}, {"drift", drifts_}};
    if (context_.arrays()) {
      write_array_functions(out_, context_);
      (void)write_prepare(out_, context_, parts, scaled);
    } else {
      write_functions(out_, context_);
      const CoefficientText text = write_prepare(out_, context_, parts, scaled);
      write_gradient("dV/dq at z.", "potential_gradient", context_.program.potential_gradient,
                     text);
      write_gradient("dT/dp at z.", "kinetic_gradient", context_.program.kinetic_gradient, text);
    }
    out_.lines(cpp_two_sum() + "\n" + cpp_sum_with_rest() + "\n" + cpp_collected_sum() + "\n");
    write_start();
    write_solve();
    write_step();
    write_propagator();
  }

 private:
  static std::vector<Rational> numbers(const std::vector<Expression>& coefficients) {
    std::vector<Rational> values;
    for (const Expression& e : coefficients) values.push_back(numeric_value(e));
    return values;
  }

  // Components that change: in a written-out system those whose derivative is not zero.
  [[nodiscard]] std::vector<int> components(bool kick) const {
    const Evaluation& evaluation =
        kick ? context_.program.potential_gradient : context_.program.kinetic_gradient;
    std::vector<int> result;
    for (int i = 0; i < context_.n(); ++i) {
      if (!evaluation.results[static_cast<std::size_t>(i)].is_zero()) result.push_back(i);
    }
    return result;
  }

  void write_gradient(const std::string& comment, const std::string& name,
                      const Evaluation& evaluation, const CoefficientText& coefficients) {
    out_.line("// " + comment);
    const std::string signature = fmt::format(
        "inline void {}([[maybe_unused]] const Parameters& par, [[maybe_unused]] const "
        "Coefficients& k, [[maybe_unused]] const State& z, [[maybe_unused]] Real (&values)[{}])",
        name, context_.n());
    write_evaluation(
        out_, context_, signature, evaluation,
        [&](CodeWriter& w, const CppExpression& cpp) {
          for (std::size_t i = 0; i < evaluation.results.size(); ++i) {
            if (evaluation.results[i].is_zero()) continue;
            w.line(fmt::format("values[{}] = {};", i, cpp(evaluation.results[i])));
          }
        },
        CppContext::StateForm::fields, coefficients);
  }

  void write_start() {
    if (!closed_) return;
    out_.line(fmt::format("// The {} a step ends with is the one the next begins with.",
                          first_.kick ? "dV/dq" : "dT/dp"));
    out_.open("struct Start");
    out_.line(fmt::format("Real value[{}] = {{}};", context_.n()));
    out_.line("bool known = false;");
    out_.close(";");
    out_.line();
  }

  void write_call(const Kind& kind) {
    if (!context_.arrays()) {
      out_.line(fmt::format("{}(par, k, now, {});", kind.gradient, kind.values));
      return;
    }
    out_.line(
        fmt::format("{}(par, now.{}, {});", kind.gradient, kind.kick ? "q" : "p", kind.values));
  }

  // The change of the state by substep `index`, and the state there unless nobody looks.
  void write_change(const Kind& kind, const std::string& index, bool last) {
    const std::string factor = fmt::format("k.{}[{}]", kind.coefficients, index);
    if (context_.arrays()) {
      const std::string field = kind.kick ? "p[j]" : "q[j]";
      out_.open("for (int j = 0; j < n; ++j)");
      out_.line(fmt::format("collect(dz.{0}, rest.{0}, {1}{2} * {3}[j]);", field,
                            kind.kick ? "-" : "", factor, kind.values));
      if (!last) out_.line(fmt::format("now.{0} = z.{0} + dz.{0};", field));
      out_.close();
      return;
    }
    for (const int i : components(kind.kick)) {
      const std::string& field = context_.state_field(kind.kick ? context_.n() + i : i);
      out_.line(fmt::format("collect(dz.{0}, rest.{0}, {1}{2} * {3}[{4}]);", field,
                            kind.kick ? "-" : "", factor, kind.values, i));
      if (!last) out_.line(fmt::format("now.{0} = z.{0} + dz.{0};", field));
    }
  }

  void write_pair(const std::string& index) {
    if (!closed_) write_call(first_);
    write_change(first_, index, false);
    write_call(second_);
    write_change(second_, index, false);
    if (closed_) write_call(first_);
  }

  void write_solve() {
    const std::size_t pairs = std::min(kicks_.size(), drifts_.size());
    // Note [sums of kicks]
    // What is small is summed first, the carry with it, and nothing of it is lost.  The kicks of a
    // step are rounded multiples of one force where h and the coefficients are simple fractions,
    // and then what their rounded sum loses is a pattern, the same at every step, and not chance:
    // for h = 1/5, w = 1.3 the form of an oscillator drifts by 1e-3 units of rounding a step with
    // sbab-3.
    out_.line("// dz + rest = Z - z for one step from z + carry.");
    out_.open(fmt::format(
        "[[nodiscard]] inline StepReport solve([[maybe_unused]] const Parameters& "
        "par, const Coefficients& k, const State& z, const State& carry, {}State& dz, State& rest)",
        closed_ ? "Start& start, " : ""));
    out_.line("StepReport report;");
    out_.line("State now = z;");
    out_.line("dz = carry;");
    out_.line("rest = State();");
    for (const Kind& kind : {first_, second_}) {
      if (kind.values == "start.value") continue;
      out_.line(fmt::format("Real {}[{}];", kind.values, context_.n()));
    }
    if (closed_) {
      out_.open("if (!start.known)");
      write_call(first_);
      out_.close();
      out_.line("start.known = false;");
    }
    if (pairs == 1) {
      write_pair("0");
    } else {
      out_.open(fmt::format("for (int i = 0; i < {}; ++i)", pairs));
      write_pair("i");
      out_.close();
    }
    if (closed_) write_change(first_, std::to_string(pairs), true);
    write_end();
    out_.close();
    out_.line();
  }

  // Of a closed splitting the gradient is kept, unless the step failed.
  void write_end() {
    out_.line("// False for infinities and NaN alike.");
    if (context_.arrays()) {
      out_.line("Real length = 0;");
      out_.line("for (int i = 0; i < n; ++i) length += dz.q[i] * dz.q[i] + dz.p[i] * dz.p[i];");
    } else {
      std::string length;
      for (const bool kick : {false, true}) {
        for (const int i : components(kick)) {
          const std::string& field = context_.state_field(kick ? context_.n() + i : i);
          length += (length.empty() ? "" : " + ") + fmt::format("dz.{0} * dz.{0}", field);
        }
      }
      if (length.empty()) length = literal(Rational(0), context_.scalar);
      out_.line("const Real length = " + length + ";");
    }
    out_.line(fmt::format("report.converged = length <= {};", context_.scalar.largest));
    out_.line("if (!report.converged) report.increment = length;");
    if (closed_) out_.line("start.known = report.converged;");
    out_.line("return report;");
  }

  void write_update(const std::string& one) {
    if (context_.arrays()) {
      out_.open("for (int i = 0; i < n; ++i)");
      for (const char* field : {"q[i]", "p[i]"}) {
        out_.line(fmt::format(fmt::runtime(one), fmt::arg("x", field)));
      }
      out_.close();
      return;
    }
    for (const bool kick : {false, true}) {
      for (const int i : components(kick)) {
        const std::string& field = context_.state_field(kick ? context_.n() + i : i);
        out_.line(fmt::format(fmt::runtime(one), fmt::arg("x", field)));
      }
    }
  }

  void write_step() {
    out_.line("// Advances z by one step of size h.  On failure z is left unchanged.");
    out_.open("[[nodiscard]] inline StepReport step(const Parameters& par, Real h, State& z)");
    out_.line("const Coefficients k = prepare(par, h);");
    if (closed_) out_.line("Start start;");
    out_.line("State dz, rest;");
    out_.line(fmt::format("const StepReport report = solve(par, k, z, State(), {}dz, rest);",
                          closed_ ? "start, " : ""));
    out_.line("if (!report.converged) return report;");
    write_update("z.{x} += dz.{x} + rest.{x};");
    out_.line("return report;");
    out_.close();
    out_.line();
  }

  void write_propagator() {
    out_.line("// Many steps: rounding errors of the updates are carried along.");
    out_.open("class Propagator");
    out_.dedent();
    out_.line(" public:");
    out_.indent();
    out_.line("Propagator(const Parameters& par, Real h, const State& z)");
    out_.line("    : par_(par), z_(z), k_(prepare(par, h)) {}");
    out_.line();
    out_.line("// One step; on failure the state stays as it was.");
    out_.open("StepReport step()");
    out_.line("State dz, rest;");
    out_.line(fmt::format("const StepReport report = solve(par_, k_, z_, carry_, {}dz, rest);",
                          closed_ ? "start_, " : ""));
    out_.line("if (!report.converged) return report;");
    write_update("add(z_.{x}, carry_.{x}, dz.{x}, rest.{x});");
    out_.line("return report;");
    out_.close();
    out_.line();
    write_advance(out_);
    out_.line();
    out_.dedent();
    out_.line(" private:");
    out_.indent();
    out_.line("Parameters par_;");
    out_.line("State z_;");
    out_.line("State carry_;");
    out_.line("Coefficients k_;");
    if (closed_) out_.line("Start start_;");
    out_.close(";");
    out_.line();
  }

  CodeWriter& out_;
  CppContext& context_;
  std::vector<Rational> kicks_, drifts_;
  bool closed_;  // it begins and ends with the same kind
  Kind first_, second_;
};

}  // namespace

void write_splitting(CodeWriter& out, CppContext& context) {
  SplittingWriter(out, context).write();
}

}  // namespace hamgen
