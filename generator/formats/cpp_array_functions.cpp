// The mathematics of a large system in C++: loops over kernels, scattered into arrays.
#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/formats/cpp_arrays.hpp"
#include "generator/program/names.hpp"

namespace hamgen {

namespace {

// Which kernels a function sums, by what they read.
enum class Part { all, potential, kinetic };

constexpr std::string_view kLocals[] = {"x", "sum", "gradient", "put", "n"};

// A loop's index: the user's name unless the function around it uses that itself.
std::string loop_index(const std::string& name) {
  const bool taken = std::ranges::find(kLocals, name) != std::end(kLocals);
  return taken ? name + "_index" : identifier(name);
}

std::string affine(const AffineIndex& a) {
  std::string text;
  for (const auto& [index, factor] : a.factors) {
    const std::string name = loop_index(index);
    if (factor == 1) {
      text += (text.empty() ? "" : " + ") + name;
    } else {
      text += fmt::format("{}{} * {}", text.empty() ? "" : " + ", factor, name);
    }
  }
  if (text.empty()) return std::to_string(a.constant);
  if (a.constant > 0) text += fmt::format(" + {}", a.constant);
  if (a.constant < 0) text += fmt::format(" - {}", -a.constant);
  return text;
}

class ArrayWriter {
 public:
  ArrayWriter(CodeWriter& out, CppContext& context)
      : out_(out), context_(context), mechanics_(context.mechanics) {}

  void write() {
    write_energy();
    if (mechanics_.is_separable()) {
      write_gradient("potential_gradient", Part::potential, "Adds dH/dq to gradient[0..n-1].");
      write_gradient("kinetic_gradient", Part::kinetic, "Adds dH/dp to gradient[n..2n-1].");
    }
    write_full_gradient();
    const ArrayPlan& plan = *context_.program.plan.arrays;
    if (uses_newton(plan)) {
      if (plan.bandwidth) {
        write_band_matrix(out_, *plan.bandwidth);
      } else {
        write_sparse_matrix(out_);
      }
      const bool reduced = plan.method == ArrayMethod::reduced_newton;
      write_hessian(reduced ? Part::potential : Part::all, "hessian");
      if (reduced) write_hessian(Part::kinetic, "masses");
    }
    const auto stages = context_.program.plan.stage_solver;
    if (stages && *stages != StageSolver::fixed_point) write_hessian(Part::all, "hessian");
  }

 private:
  [[nodiscard]] std::vector<const Kernel*> kernels(Part part) const {
    std::vector<const Kernel*> result;
    for (const Kernel& kernel : mechanics_.kernels) {
      const bool kinetic = uses_momenta(kernel);
      if (part == Part::all || kinetic == (part == Part::kinetic)) result.push_back(&kernel);
    }
    return result;
  }

  // Opens the kernel's loops and computes the wanted expressions; `use` gets them as C++.
  template <class Use>
  void write_kernel(const Kernel& kernel, const std::vector<Expression>& values, Use use) {
    Names names;
    for (const std::string_view local : kLocals) names.reserve(std::string(local));
    for (const KernelRange& range : kernel.ranges) names.reserve(loop_index(range.index));
    for (const Slot& slot : kernel.slots)
      names.set(slot.symbol, names.unique(slot_name(slot.symbol)));
    const CppExpression cpp(
        context_.scalar,
        [&](const std::string& symbol) -> std::string {
          const auto& parameters = context_.parameter_text;
          if (const auto it = parameters.find(symbol); it != parameters.end()) {
            return it->second;
          }
          for (const ParameterSlot& slot : kernel.parameters) {
            if (slot.symbol != symbol) continue;
            return fmt::format("par.{}[{}]", member_identifier(slot.parameter),
                               affine(slot.position));
          }
          for (const KernelRange& range : kernel.ranges) {
            if (range.index == symbol) return fmt::format("Real({})", loop_index(symbol));
          }
          if (symbol == "pi")
            return literal(*parse_decimal("3.14159265358979323846264338327950288"),
                           context_.scalar);
          return names.local(symbol);
        },
        context_.options.builtins);
    std::set<std::string> used;
    for (const Expression& value : values) collect_symbols(value, used);
    const Evaluation evaluation = evaluate_together(values);
    for (const KernelRange& range : kernel.ranges) {
      out_.open(fmt::format("for (int {0} = {1}; {0} <= {2}; ++{0})", loop_index(range.index),
                            affine(range.lower), affine(range.upper)));
    }
    if (kernel.ranges.empty()) out_.open("");
    for (const Slot& slot : kernel.slots) {
      if (!used.contains(slot.symbol)) continue;
      out_.line(
          fmt::format("const Real {} = x[{}];", names.local(slot.symbol), affine(slot.position)));
    }
    for (const Statement& s : evaluation.statements) {
      const std::string text = cpp(s.value);
      out_.line(fmt::format("const Real {} = {};", names.local(s.name), text));
    }
    std::vector<std::string> texts;
    for (const Expression& result : evaluation.results) texts.push_back(cpp(result));
    use(texts);
    if (kernel.ranges.empty()) out_.close();
    for (std::size_t i = 0; i < kernel.ranges.size(); ++i) out_.close();
    context_.note(cpp);
  }

  static std::string slot_name(const std::string& symbol) {
    std::string text;
    for (const char c : symbol) {
      if (c == ']') continue;
      if (c == '[') {
        text += '_';
      } else if (c == '+') {
        text += "_plus_";
      } else if (c == '-') {
        text += "_minus_";
      } else if (c == '*') {
        text += "_times_";
      } else {
        text += c;
      }
    }
    return identifier(text);
  }

  void write_energy() {
    out_.line("// H(q, p).");
    out_.open("inline Real energy([[maybe_unused]] const Parameters& par, const State& z)");
    out_.line("const Real* x = z.q;  // p follows q");
    out_.line("Real sum = 0;");
    for (const Kernel& kernel : mechanics_.kernels) {
      write_kernel(kernel, {kernel.value}, [&](const std::vector<std::string>& texts) {
        out_.line("sum += " + texts[0] + ";");
      });
    }
    out_.line("return sum;");
    out_.close();
    out_.line();
  }

  void write_gradient(const std::string& name, Part part, const std::string& comment) {
    out_.line("// " + comment);
    out_.open(
        fmt::format("inline void {}([[maybe_unused]] const Parameters& par, "
                    "[[maybe_unused]] const Real* x, [[maybe_unused]] Real* gradient)",
                    name));
    for (const Kernel* kernel : kernels(part)) {
      std::vector<Expression> values;
      std::vector<std::string> targets;
      for (std::size_t i = 0; i < kernel->slots.size(); ++i) {
        if (kernel->gradient[i].is_zero()) continue;
        values.push_back(kernel->gradient[i]);
        targets.push_back(affine(kernel->slots[i].position));
      }
      write_kernel(*kernel, values, [&](const std::vector<std::string>& texts) {
        for (std::size_t i = 0; i < texts.size(); ++i) {
          out_.line(fmt::format("gradient[{}] += {};", targets[i], texts[i]));
        }
      });
    }
    out_.close();
    out_.line();
  }

  void write_full_gradient() {
    if (!mechanics_.is_separable()) {
      write_gradient("add_gradient", Part::all, "Adds grad H to gradient[0..2n-1].");
    }
    out_.line("// grad H: the derivatives by q first.");
    out_.open("inline void gradient(const Parameters& par, const Real* x, Real* values)");
    out_.line("for (int i = 0; i < 2 * n; ++i) values[i] = 0;");
    if (mechanics_.is_separable()) {
      out_.line("potential_gradient(par, x, values);");
      out_.line("kinetic_gradient(par, x, values);");
    } else {
      out_.line("add_gradient(par, x, values);");
    }
    out_.close();
    out_.line();
  }

  // put(row, column, value) for every entry, in an order that never changes.
  void write_hessian(Part part, const std::string& name) {
    out_.line(
        "// put(row, column, value) for the second derivatives of H, repeated entries to be "
        "added.");
    out_.line("template <class Put>");
    out_.open(
        fmt::format("inline void {}([[maybe_unused]] const Parameters& par, "
                    "[[maybe_unused]] const Real* x, Put put)",
                    name));
    for (const Kernel* kernel : kernels(part)) {
      if (kernel->hessian.empty()) continue;
      std::vector<Expression> values;
      std::vector<std::pair<std::size_t, std::size_t>> places;
      for (const auto& [place, value] : kernel->hessian) {
        values.push_back(value);
        places.push_back(place);
      }
      write_kernel(*kernel, values, [&](const std::vector<std::string>& texts) {
        for (std::size_t k = 0; k < texts.size(); ++k) {
          const std::string row = affine(kernel->slots[places[k].first].position);
          const std::string column = affine(kernel->slots[places[k].second].position);
          if (places[k].first == places[k].second) {
            out_.line(fmt::format("put({}, {}, {});", row, column, texts[k]));
          } else {
            const std::string entry = fmt::format("entry_{}", k + 1);
            out_.line(fmt::format("const Real {} = {};", entry, texts[k]));
            out_.line(fmt::format("put({}, {}, {});", row, column, entry));
            out_.line(fmt::format("put({}, {}, {});", column, row, entry));
          }
        }
      });
    }
    out_.close();
    out_.line();
  }

  CodeWriter& out_;
  CppContext& context_;
  const Mechanics& mechanics_;
};

}  // namespace

void write_array_functions(CodeWriter& out, CppContext& context) {
  ArrayWriter(out, context).write();
}

}  // namespace hamgen
