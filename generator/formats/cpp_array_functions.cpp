// The mathematics of a large system in C++: loops over kernels, scattered into arrays.
#include <algorithm>
#include <cctype>

#include "generator/base/diagnostic.hpp"
#include "generator/formats/cpp_arrays.hpp"
#include "generator/program/names.hpp"

namespace hamgen {

namespace {

// Which kernels a function sums, by what they read.
enum class Part { all, potential, kinetic };

constexpr std::string_view kLocals[] = {"par", "q", "p", "z", "sum", "dq", "dp", "put", "n"};

// Does the text use the name, as in "par.x" or "q[i]"?
bool mentions(const std::string& text, const std::string& name) {
  auto in_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  for (auto at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    const bool begins = at == 0 || (!in_name(text[at - 1]) && text[at - 1] != '.');
    if (begins && (end == text.size() || !in_name(text[end]))) return true;
  }
  return false;
}

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
    const SolvePlan& plan = context_.program.plan;
    const ArrayPlan& arrays = *plan.arrays;
    const bool splitting = std::holds_alternative<Splitting>(context_.equations.scheme.method);
    const bool whole = arrays.method == ArrayMethod::gradient_only && !splitting;
    if (mechanics_.is_separable()) {
      write_gradient("potential_gradient", Part::potential);
      write_gradient("kinetic_gradient", Part::kinetic);
      if (whole || context_.options.gradient) write_both_gradients();
    } else {
      write_gradient("gradient", Part::all);
    }
    if (arrays.reduced && !arrays.mass) write_masses();
    if (arrays.matrix) {
      write_array_matrix(out_, *arrays.matrix);
      write_hessian(arrays.reduced ? Part::potential : Part::all);
    }
    const bool newton_on_stages =
        plan.stage_solver && *plan.stage_solver != StageSolver::fixed_point;
    if (newton_on_stages || (context_.options.tangent && !arrays.matrix)) write_hessian(Part::all);
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

  // Where an element of the state stands: "q[i - 1]".
  [[nodiscard]] std::string element(const Slot& slot, const std::string& state = "") const {
    AffineIndex position = slot.position;
    if (slot.is_momentum) position.constant -= mechanics_.degrees_of_freedom;
    return fmt::format("{}{}[{}]", state, slot.is_momentum ? "p" : "q", affine(position));
  }

  // Opens the kernel's loops and computes the wanted expressions; `use` gets them as C++.
  template <class Use>
  void write_kernel(CodeWriter& out, const Kernel& kernel, const std::vector<Expression>& values,
                    Use use, const std::string& state = "") {
    Names names;
    for (const std::string_view local : kLocals) names.reserve(std::string(local));
    for (const KernelRange& range : kernel.ranges) names.reserve(loop_index(range.index));
    for (const Slot& slot : kernel.slots)
      names.set(slot.symbol, names.unique(slot_name(slot.symbol)));
    const CppExpression cpp(
        context_.scalar,
        [&](const std::string& symbol) { return name_in_loop(kernel, symbol, names); },
        context_.options.builtins);
    std::set<std::string> used;
    for (const Expression& value : values) collect_symbols(value, used);
    const Evaluation evaluation = evaluate_together(values);
    for (const KernelRange& range : kernel.ranges) {
      out.open(fmt::format("for (int {0} = {1}; {0} <= {2}; ++{0})", loop_index(range.index),
                           affine(range.lower), affine(range.upper)));
    }
    for (const Slot& slot : kernel.slots) {
      if (!used.contains(slot.symbol)) continue;
      out.line(fmt::format("const Real {} = {};", names.local(slot.symbol), element(slot, state)));
    }
    write_statements(out, cpp, names, evaluation.statements);
    std::vector<std::string> texts;
    for (const Expression& result : evaluation.results) texts.push_back(cpp(result));
    use(out, texts);
    for (std::size_t i = 0; i < kernel.ranges.size(); ++i) out.close();
    context_.note(cpp);
  }

  [[nodiscard]] std::string name_in_loop(const Kernel& kernel, const std::string& symbol,
                                         Names& names) const {
    const auto& parameters = context_.parameter_text;
    if (const auto it = parameters.find(symbol); it != parameters.end()) return it->second;
    for (const ParameterSlot& slot : kernel.parameters) {
      if (slot.symbol != symbol) continue;
      return fmt::format("par.{}[{}]", member_identifier(slot.parameter), affine(slot.position));
    }
    for (const KernelRange& range : kernel.ranges) {
      if (range.index == symbol) return fmt::format("Real({})", loop_index(symbol));
    }
    if (symbol == "pi") {
      context_.used.pi = true;
      return "pi";
    }
    return names.local(symbol);
  }

  // Writes the kernels of a function: single instances last, each in a block of its own if there
  // are several, for all have the same names.
  template <class Write>
  void write_kernels(CodeWriter& out, Part part, const Write& write) {
    std::vector<const Kernel*> single;
    for (const Kernel* kernel : kernels(part)) {
      if (kernel->ranges.empty()) {
        single.push_back(kernel);
      } else {
        write(out, *kernel);
      }
    }
    for (const Kernel* kernel : single) {
      CodeWriter inner;
      write(inner, *kernel);
      if (inner.text().empty()) continue;
      if (single.size() > 1) out.open("");
      out.lines(inner.text());
      if (single.size() > 1) out.close();
    }
  }

  struct Argument {
    std::string type, name;
  };
  // A function; arguments that its body does not mention have no name.
  void write_function(const std::string& head, const std::vector<Argument>& arguments,
                      const CodeWriter& body) {
    std::string list;
    for (const Argument& argument : arguments) {
      list += (list.empty() ? "" : ", ") + argument.type;
      if (mentions(body.text(), argument.name)) list += " " + argument.name;
    }
    out_.open(head + "(" + list + ")");
    out_.lines(body.text());
    out_.close();
    out_.line();
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
    CodeWriter body;
    body.line("Real sum = 0;");
    write_kernels(body, Part::all, [&](CodeWriter& out, const Kernel& kernel) {
      write_kernel(
          out, kernel, {kernel.value},
          [&](CodeWriter& loop, const std::vector<std::string>& texts) {
            loop.line("sum += " + texts[0] + ";");
          },
          "z.");
    });
    body.line("return sum;");
    out_.line("// H(q, p).");
    write_function("inline Real energy", {{"const Parameters&", "par"}, {"const State&", "z"}},
                   body);
  }

  [[nodiscard]] std::vector<Argument> arguments(Part part) const {
    std::vector<Argument> list{{"const Parameters&", "par"}};
    if (part != Part::kinetic) list.push_back({"const Real*", "q"});
    if (part != Part::potential) list.push_back({"const Real*", "p"});
    return list;
  }

  void write_gradient(const std::string& name, Part part) {
    CodeWriter body;
    const bool by_q = part != Part::kinetic;
    const bool by_p = part != Part::potential;
    body.line(fmt::format("for (int i = 0; i < n; ++i) {};", !by_p   ? "dq[i] = 0"
                                                             : !by_q ? "dp[i] = 0"
                                                                     : "dq[i] = dp[i] = 0"));
    write_kernels(body, part, [&](CodeWriter& out, const Kernel& kernel) {
      std::vector<Expression> values;
      std::vector<std::string> targets;
      for (std::size_t i = 0; i < kernel.slots.size(); ++i) {
        if (kernel.gradient[i].is_zero()) continue;
        values.push_back(kernel.gradient[i]);
        targets.push_back("d" + element(kernel.slots[i]));
      }
      write_kernel(out, kernel, values,
                   [&](CodeWriter& loop, const std::vector<std::string>& texts) {
                     for (std::size_t i = 0; i < texts.size(); ++i) add(loop, targets[i], texts[i]);
                   });
    });
    std::vector<Argument> list = arguments(part);
    if (by_q) list.push_back({"Real*", "dq"});
    if (by_p) list.push_back({"Real*", "dp"});
    out_.line(!by_p   ? "// dq[i] = dH/dq_i."
              : !by_q ? "// dp[i] = dH/dp_i."
                      : "// dq[i] = dH/dq_i, dp[i] = dH/dp_i.");
    write_function("inline void " + name, list, body);
  }

  // target += text, where that begins with a minus, target -= what follows, if it is one product.
  static void add(CodeWriter& out, const std::string& target, const std::string& text) {
    const bool negative =
        text.starts_with('-') && text.find_first_of("+-(", 1) == std::string::npos;
    out.line(
        fmt::format("{} {}= {};", target, negative ? '-' : '+', text.substr(negative ? 1 : 0)));
  }

  void write_both_gradients() {
    out_.line("// dq[i] = dH/dq_i, dp[i] = dH/dp_i.");
    out_.lines(
        R"(inline void gradient(const Parameters& par, const Real* q, const Real* p, Real* dq, Real* dp) {
  potential_gradient(par, q, dq);
  kinetic_gradient(par, p, dp);
}

)");
  }

  void write_masses() {
    CodeWriter body;
    body.line("for (int i = 0; i < n; ++i) dp[i] = 0;");
    write_kernels(body, Part::kinetic, [&](CodeWriter& out, const Kernel& kernel) {
      if (kernel.hessian.empty()) return;
      std::vector<Expression> values;
      std::vector<std::string> targets;
      for (const auto& [slots, value] : kernel.hessian) {
        values.push_back(value);
        targets.push_back("d" + element(kernel.slots[slots.first]));
      }
      write_kernel(out, kernel, values,
                   [&](CodeWriter& loop, const std::vector<std::string>& texts) {
                     for (std::size_t i = 0; i < texts.size(); ++i) add(loop, targets[i], texts[i]);
                   });
    });
    out_.line("// dp[i] = d2H/dp_i^2, which is constant.");
    write_function("inline void masses", {{"const Parameters&", "par"}, {"Real*", "dp"}}, body);
  }

  // put(row, column, value) for every entry, in an order that never changes.
  void write_hessian(Part part) {
    CodeWriter body;
    write_kernels(body, part, [&](CodeWriter& out, const Kernel& kernel) {
      if (kernel.hessian.empty()) return;
      std::vector<Expression> values;
      for (const auto& [slots, value] : kernel.hessian) values.push_back(value);
      write_kernel(out, kernel, values,
                   [&](CodeWriter& loop, const std::vector<std::string>& texts) {
                     write_entries(loop, kernel, texts);
                   });
    });
    out_.line(
        "// put(row, column, value) for the second derivatives, repeated entries to be added.");
    out_.line("template <class Put>");
    std::vector<Argument> list = arguments(part);
    list.push_back({"Put", "put"});
    write_function("inline void hessian", list, body);
  }

  static void write_entries(CodeWriter& out, const Kernel& kernel,
                            const std::vector<std::string>& texts) {
    std::size_t k = 0;
    int named = 0;
    for (const auto& [slots, value] : kernel.hessian) {
      std::string text = texts[k++];
      const std::string row = affine(kernel.slots[slots.first].position);
      const std::string column = affine(kernel.slots[slots.second].position);
      if (slots.first != slots.second && text.find(' ') != std::string::npos) {
        const std::string entry = fmt::format("entry_{}", ++named);
        out.line(fmt::format("const Real {} = {};", entry, text));
        text = entry;
      }
      out.line(fmt::format("put({}, {}, {});", row, column, text));
      if (slots.first != slots.second) out.line(fmt::format("put({}, {}, {});", column, row, text));
    }
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
