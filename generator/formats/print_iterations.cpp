#include <fmt/format.h>

#include "generator/formats/routine_printer.hpp"

namespace hamgen {

std::string RoutinePrinter::magnitude(const std::string& x) const {
  return dialect_.block("magnitude") + "(" + (x.starts_with('-') ? x.substr(1) : x) + ")";
}

void RoutinePrinter::operator()(const Iterate& iterate) {
  for (const std::string& symbol : iterate.kept) {
    out_.line(fmt::format("{} {} = {};", dialect_.real(), names_.local(symbol),
                          literal(0, dialect_.scalar)));
  }
  for (const Unknown& u : iterate.unknowns) {
    const std::string start = cpp_(u.start);
    out_.line(fmt::format(
        fmt::runtime(dialect_.has_lanes() ? "{0} {1} = select({2}known, {2}value[{3}], {4});"
                                          : "{0} {1} = {2}known ? {2}value[{3}] : {4};"),
        dialect_.real(), names_.local(u.symbol), of("start"), u.memory, start));
  }
  kept_.insert(iterate.kept.begin(), iterate.kept.end());
  iterates_ = true;
  iterate.rule == Rule::newton ? newton(iterate) : fixed_point(iterate);
  iterates_ = false;
  for (const Unknown& u : iterate.unknowns) {
    std::string value = names_.local(u.symbol);
    if (iterate.rule == Rule::newton) value += " + " + cpp_(u.correction);
    out_.line(fmt::format("{}value[{}] = {};", of("start"), u.memory, value));
  }
}

void RoutinePrinter::operator()(const IterateArray& iterate) {
  iterates_ = true;
  iterate.rule == Rule::newton ? newton(iterate) : contraction(iterate);
  iterates_ = false;
}

void RoutinePrinter::operator()(const Refine& refine) {
  const std::string kept = kept_name(refine);
  const auto list = [&](const auto& items, const auto& item) {
    std::vector<std::string> texts;
    for (const auto& each : items) texts.push_back(item(each));
    return joined_texts(texts, ", ");
  };
  out_.line(fmt::format("Refinement<{}, {}> {};", refine.unknowns.size(), refine.gradient.size(),
                        refine.name));
  if (!refine.kept.empty()) out_.line(fmt::format("Real {}[{}] = {{}};", kept, refine.kept.size()));
  out_.open("for (bool more = true; more;)");
  print(refine.body);
  out_.line(fmt::format("const Real lack[{}] = {{{}}};", refine.unknowns.size(),
                        list(refine.unknowns, [&](const Unknown& u) {
                          return cpp_(u.correction - Expression::symbol(u.symbol));
                        })));
  out_.line(fmt::format("const Real slope[{}] = {{{}}};", refine.gradient.size(),
                        list(refine.gradient, [&](const Expression& e) { return cpp_(e); })));
  if (!refine.kept.empty()) {
    out_.open(fmt::format("if ({}.rounds == 0)", refine.name));
    for (std::size_t j = 0; j < refine.kept.size(); ++j) {
      out_.line(fmt::format("{}[{}] = {};", kept, j, names_.local(refine.kept[j])));
    }
    out_.close();
  }
  out_.line(
      fmt::format("Real point[{}] = {{{}}};", refine.unknowns.size(),
                  list(refine.unknowns, [&](const Unknown& u) { return names_.local(u.symbol); })));
  out_.line(fmt::format("more = {}(point, lack, slope);", refine.name));
  for (std::size_t j = 0; j < refine.unknowns.size(); ++j) {
    out_.line(fmt::format("{} = point[{}];", names_.local(refine.unknowns[j].symbol), j));
  }
  out_.close();
  for (std::size_t j = 0; j < refine.kept.size(); ++j) {
    out_.line(fmt::format("{} = {}[{}];", names_.local(refine.kept[j]), kept, j));
  }
}

void RoutinePrinter::operator()(const RefineArray& refine) {
  out_.open("for (bool more = true; more;)");
  print(refine.body);
  const std::string rule = refine.rule.empty() ? "" : of("start") + refine.rule + ", ";
  out_.line(fmt::format("more = {}({}{}, {}, {});", text(refine.refinement), rule,
                        text(refine.point), text(refine.lack), text(refine.gradient)));
  out_.close();
}

void RoutinePrinter::operator()(const Sweep& sweep) {
  for (const Unknown& u : sweep.unknowns) {
    const std::string start = cpp_(u.start);
    out_.line(fmt::format("{} {} = {};", dialect_.real(), names_.local(u.symbol), start));
  }
  out_.open(fmt::format("for (int sweep = 0; sweep < {}; ++sweep)", sweep.count));
  print(sweep.body);
  std::vector<std::string> next;
  for (const Unknown& u : sweep.unknowns) {
    const std::string value = cpp_(u.correction);
    next.push_back(names_.unique(names_.local(u.symbol) + "_next"));
    out_.line(fmt::format("const {} {} = {};", dialect_.real(), next.back(), value));
  }
  for (std::size_t j = 0; j < next.size(); ++j) {
    out_.line(fmt::format("{} = {};", names_.local(sweep.unknowns[j].symbol), next[j]));
  }
  out_.close();
  for (std::size_t j = 0; j < sweep.results.size(); ++j) {
    out_.line(fmt::format("const {} {} = {};", dialect_.real(), names_.local(sweep.results[j]),
                          names_.local(sweep.unknowns[j].symbol)));
  }
  out_.line(fmt::format("report.iterations = {};", sweep.count));
}

void RoutinePrinter::newton(const Iterate& iterate) {
  const std::string rule = of("start") + iterate.name;
  for (const std::string& line : *remark_) out_.remark("// ", line);
  out_.line(dialect_.call("NewtonRule", rule, "begin", of("start") + "known") + ";");
  out_.open("for (int iteration = 1;; ++iteration)");
  rule_ = rule;
  print(iterate.body);
  std::vector<std::string> corrections;
  std::vector<std::string> sizes;
  for (const Unknown& u : iterate.unknowns) {
    corrections.push_back(cpp_(u.correction));
    sizes.push_back(magnitude(corrections.back()));
  }
  out_.line(fmt::format("const {} size = {};", dialect_.real(), joined_texts(sizes, " + ")));
  out_.line(fmt::format("const {} scale = {};", dialect_.real(), scale(iterate)));
  if (dialect_.has_lanes()) return end_newton_of_lanes(iterate, corrections);
  out_.line(fmt::format("const {} verdict = {};", dialect_.block("Verdict"),
                        dialect_.call("NewtonRule", rule, "", "size, scale, iteration")));
  end_newton();
  for (std::size_t j = 0; j < corrections.size(); ++j) {
    out_.line(fmt::format("{} += {};", names_.local(iterate.unknowns[j].symbol), corrections[j]));
  }
  out_.close();
}

// Lanes that are done stand still until all are.
void RoutinePrinter::end_newton_of_lanes(const Iterate& iterate,
                                         const std::vector<std::string>& corrections) {
  out_.line(fmt::format("const Mask moving = {}(size, scale, iteration);", rule_));
  out_.line("if (!any(moving)) break;");
  for (std::size_t j = 0; j < corrections.size(); ++j) {
    out_.line(fmt::format("{0} = select(moving, {0} + {1}, {0});",
                          names_.local(iterate.unknowns[j].symbol), corrections[j]));
  }
  out_.close();
  out_.line(fmt::format("end_iteration(report, {});", rule_));
}

void RoutinePrinter::newton(const IterateArray& iterate) {
  const std::string rule = of("start") + iterate.name;
  out_.line(dialect_.call("NewtonRule", rule, "begin", of("start") + "known") + ";");
  out_.open("for (int iteration = 1;; ++iteration)");
  print(iterate.body);
  out_.line(dialect_.real() + " size = 0;");
  out_.line(dialect_.real() + " scale = 0;");
  for_elements(iterate, [&](const UnknownArray& u) {
    out_.line("size += " + magnitude(name(u.increment)) + ";");
    out_.line("scale += " + length(u) + ";");
  });
  out_.line(fmt::format("const {} verdict = {};", dialect_.block("Verdict"),
                        dialect_.call("NewtonRule", rule, "", "size, scale, iteration")));
  end_newton();
  for_elements(iterate, [&](const UnknownArray& u) {
    out_.line(fmt::format("{} += {};", name(u.value), name(u.increment)));
  });
  out_.close();
}

void RoutinePrinter::end_newton() {
  out_.open("if (verdict == " + dialect_.verdict("failed") + ")");
  out_.line("report.iterations += iteration;");
  out_.line("report.increment = size;");
  out_.line(failure());
  out_.close();
  out_.open("if (verdict == " + dialect_.verdict("done") + ")");
  out_.line("report.iterations += iteration;");
  out_.line("break;");
  out_.close();
}

void RoutinePrinter::fixed_point(const Iterate& iterate) {
  out_.line(fmt::format("FixedPointRule<2> {};", iterate.name));
  out_.open("for (int iteration = 1;; ++iteration)");
  print(iterate.body);
  std::vector<std::string> values;
  for (const Unknown& u : iterate.unknowns) {
    values.push_back(cpp_(u.correction - Expression::symbol(u.symbol)));
  }
  out_.line(
      fmt::format("const Real increment[{}] = {{{}}};", values.size(), joined_texts(values, ", ")));
  out_.line("Distance distance;");
  for (std::size_t j = 0; j < values.size(); ++j) {
    const Unknown& u = iterate.unknowns[j];
    out_.line(fmt::format("distance.add(magnitude(increment[{}]), {});", j, length(u)));
    out_.line(fmt::format("{} += increment[{}];", names_.local(u.symbol), j));
  }
  out_.line("const Verdict verdict = " + iterate.name + "(distance, iteration);");
  end_contraction(iterate.name);
}

// The fixed point, and Newton with a matrix that serves for many steps.
void RoutinePrinter::contraction(const IterateArray& iterate) {
  const std::string rule = of("start") + iterate.name;
  const bool newton = iterate.rule == Rule::simplified_newton;
  const std::string served = newton ? text(*iterate.factorised) : "";
  const std::string work = iterate.work ? std::to_string(*iterate.work) : "";
  out_.line(fmt::format("{}.begin({});", rule, newton ? served : work));
  out_.open("for (int iteration = 1;; ++iteration)");
  print(iterate.body);
  out_.line("Distance distance;");
  if (const std::vector<WholeUnknowns> arrays = whole_unknowns(routine_, iterate);
      !arrays.empty()) {
    const char* add = iterate.lanes > 0 ? "add_lanes(Lanes(0), distance, " : "distance.add(";
    for (const WholeUnknowns& u : arrays) {
      out_.line(fmt::format("{}{}, {}, {}, {});", add, given(u.increment), given(u.value),
                            given(u.beside), count_text(u.count)));
    }
  } else {
    for_elements(iterate, [&](const UnknownArray& u) {
      out_.line(fmt::format("distance.add({}, {});", magnitude(name(u.increment)), length(u)));
    });
  }
  // In a loop of their own: g++ 12.2 -O3 loses the last stores where both are in one.
  if (iterate.lanes > 0) {
    (*this)(moved_in_lanes(iterate));
  } else {
    for_elements(iterate, [&](const UnknownArray& u) {
      out_.line(fmt::format("{} += {};", name(u.value), name(u.increment)));
    });
  }
  out_.line(fmt::format("const Verdict verdict = {}(distance, {}iteration);", rule,
                        newton ? name(iterate.residual) + ", " + served + ", " : ""));
  end_contraction(rule);
}

void RoutinePrinter::end_contraction(const std::string& rule) {
  out_.line("if (verdict == Verdict::go_on) continue;");
  out_.line("report.iterations += iteration;");
  out_.line("if (verdict == Verdict::done) break;");
  out_.line("report.increment = " + rule + ".size;");
  out_.line(failure());
  out_.close();
}

void RoutinePrinter::for_elements(const IterateArray& iterate,
                                  const std::function<void(const UnknownArray&)>& lines) {
  for (const KernelRange& range : iterate.ranges) out_.open(head(range));
  for (const UnknownArray& u : iterate.unknowns) lines(u);
  for (std::size_t i = 0; i < iterate.ranges.size(); ++i) out_.close();
}

std::string RoutinePrinter::length(const Unknown& u) {
  return magnitude(names_.local(u.symbol)) + " + " + magnitude(cpp_(u.start));
}
std::string RoutinePrinter::length(const UnknownArray& u) {
  return magnitude(name(u.value)) + " + " + magnitude(cpp_(u.beside));
}
std::string RoutinePrinter::scale(const Iterate& iterate) {
  std::vector<std::string> parts;
  for (const Unknown& u : iterate.unknowns) parts.push_back(length(u));
  return joined_texts(parts, " + ");
}

std::string RoutinePrinter::kept_name(const Refine& refine) {
  return "kept" + refine.name.substr(refine.name.rfind('_'));
}

}  // namespace hamgen
