#include "generator/formats/plugin_quantities.hpp"

#include <fmt/format.h>

#include "generator/base/quoted_text.hpp"

namespace hamgen {

namespace {

struct QuantityEntry {
  const Quantity* quantity;
  ElementName name;  // of the first element
  long count = 1;
};

// Elements of one array that follow each other are one entry.
std::vector<QuantityEntry> quantity_entries(const std::vector<Quantity>& quantities) {
  std::vector<QuantityEntry> entries;
  for (const Quantity& quantity : quantities) {
    const ElementName name = split_element(quantity.name);
    if (!entries.empty() && name.indexed) {
      QuantityEntry& last = entries.back();
      const bool follows = last.name.indexed && last.name.base == name.base &&
                           last.name.index + last.count == name.index;
      if (follows) {
        ++last.count;
        continue;
      }
    }
    entries.push_back({&quantity, name});
  }
  return entries;
}

void write_quantity_list(CodeWriter& out, const std::string& name,
                         const std::vector<Quantity>& quantities) {
  out.line(fmt::format("const hamgen_quantity {}[] = {{", name));
  for (const QuantityEntry& entry : quantity_entries(quantities)) {
    out.line(fmt::format("    {{{}, {}, {}, {}, {}, {}}},", cpp_string(entry.name.base),
                         cpp_string(entry.quantity->unit), cpp_string(entry.quantity->comment),
                         entry.name.indexed ? 1 : 0, entry.name.indexed ? entry.name.index : 0,
                         entry.count));
  }
  out.line("    {}};");
  out.line();
}

}  // namespace

void write_quantity_lists(CodeWriter& out, const EmitContext& context) {
  write_quantity_list(out, "variable_list", context.program.environment.variables);
  write_quantity_list(out, "parameter_list", context.program.environment.parameters);
  write_quantity_list(out, "invariant_list", context.program.facts.invariants);
}

void write_setters(CodeWriter& out, const EmitContext& context) {
  const std::vector<std::string>& fields = context.parameter_fields;
  if (fields.empty()) {
    out.line("void give_parameters(const Parameters&, double*, double*) {}");
  } else {
    out.open(
        "void give_parameters(const Parameters& par, double* parameters, double* parameters_lo)");
    for (std::size_t i = 0; i < fields.size(); ++i)
      out.line(fmt::format(
          "parameters[{0}] = high_part(par.{1}, parameters_lo ? parameters_lo + {0} : nullptr);", i,
          fields[i]));
    out.close();
  }
  out.line();
  out.lines(R"(void default_parameters(double* parameters, double* parameters_lo) {
  give_parameters(Parameters(), parameters, parameters_lo);
}

Real time_of(const hamgen_run* run) { return run->start_time + run->propagator.time(); }

double get_time(const hamgen_run* run, double* t_lo) { return high_part(time_of(run), t_lo); }

double get_h(const hamgen_run* run, double* h_lo) { return high_part(run->propagator.h(), h_lo); }

void get_parameters(const hamgen_run* run, double* parameters, double* parameters_lo) {
  give_parameters(run->propagator.parameters(), parameters, parameters_lo);
}

void set_state(hamgen_run* run, double t, double t_lo, const double* state,
               const double* state_lo) {
  run->start_time = static_cast<Real>(t) + static_cast<Real>(t_lo);
  run->propagator.reset(read_state(state, state_lo));
}

void go_on_with(hamgen_run* run, const Parameters& par, Real h) {
  run->start_time = time_of(run);
  const State z = run->propagator.state();
  run->propagator.~Propagator();
  new (&run->propagator) Propagator(par, h, z);
}

void set_h(hamgen_run* run, double h, double h_lo) {
  const Parameters par = run->propagator.parameters();
  go_on_with(run, par, static_cast<Real>(h) + static_cast<Real>(h_lo));
}

void set_parameters(hamgen_run* run, const double* parameters, const double* parameters_lo) {
  go_on_with(run, read_parameters(parameters, parameters_lo), run->propagator.h());
}

)");
}

}  // namespace hamgen
