#include "generator/program/contents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "generator/program/lane_program.hpp"

namespace hamgen {

namespace {

// Adds the fields of `par` that a routine reads.
void collect_parameters(const Routine& routine, std::set<std::string>& fields) {
  std::set<std::string> symbols;
  collect_symbols(routine.body, symbols);
  for (const auto& [symbol, place] : routine.places) {
    if (place.object == "par" && symbols.contains(symbol)) fields.insert(place.field);
  }
}

class ContentsBuilder {
 public:
  ContentsBuilder(const Program& program, const ContentsWishes& wishes)
      : program_(program), wishes_(wishes), arrays_(program.environment.arrays) {}

  Contents build() {
    Contents contents;
    pieces_ = &contents.system;
    split_parameters();
    add(of_system_);
    add(*program_.record("State"));
    add_constants();
    add_with_callees("energy");
    add_with_callees("gradient");
    if (arrays_) add(gradient_of_state());
    add_with_callees("invariants");
    pieces_ = &contents.method;
    if (!of_method_.fields.empty()) add(of_method_);
    add_with_callees("modified_energies");
    if (!program_.facts.modified_powers.empty()) add(modified_energy());
    if (program_.matrix) add(*program_.matrix);
    add_record("Coefficients");
    add_with_callees("prepare");
    add_record("Start");
    add_record("Derivatives");
    add_with_callees("solve");
    add_steps();
    add_with_callees("events");
    if (!program_.events.empty()) add(Watch{program_.events});
    if (wishes_.tangent) add_with_callees("tangent");
    return contents;
  }

 private:
  void add(Piece piece) { pieces_->push_back(std::move(piece)); }
  void add_record(const char* name) {
    if (const Record* record = program_.record(name)) add(*record);
  }
  // The routine of this name, if there is one, behind those that it calls; each once.
  void add_with_callees(const char* name) {
    const std::set<std::string> wanted = callees(program_, name);
    for (const Routine& routine : program_.routines) {
      if (wanted.contains(routine.name) && taken_.insert(routine.name).second) add(routine);
    }
  }

  void split_parameters() {
    std::set<std::string> by_system;
    std::set<std::string> by_method;
    const auto collect = [&](std::initializer_list<const char*> names,
                             std::set<std::string>& fields) {
      for (const char* name : names) {
        for (const std::string& called : callees(program_, name))
          collect_parameters(*program_.routine(called), fields);
      }
    };
    collect({"energy", "gradient", "invariants"}, by_system);
    collect({"prepare", "solve", "events"}, by_method);
    if (wishes_.tangent) collect({"tangent"}, by_method);
    of_system_ = *program_.record("Parameters");
    of_method_ = {.name = "Parameters",
                  .fields = {},
                  .remark = {"Those of the system, and what the method takes besides."},
                  .extends = true};
    if (!wishes_.own_space) return;
    std::erase_if(of_system_.fields, [&](const Field& field) {
      const bool ours = by_method.contains(field.name) && !by_system.contains(field.name);
      if (ours) of_method_.fields.push_back(field);
      return ours;
    });
  }

  void add_constants() {
    if (program_.facts.constants.empty()) return;
    Record folded = layout("Folded", program_.facts.constants, Defaults::values).record;
    folded.remark = {
        "Parameters whose values are part of the code: to be read, not to be changed."};
    add(std::move(folded));
  }

  // Of a state as one, where the routine takes arrays.
  [[nodiscard]] Routine gradient_of_state() const {
    const int n = program_.environment.degrees_of_freedom;
    return {.name = "gradient",
            .remark = {"grad H, the derivatives by q first."},
            .arguments = {parameters_argument(),
                          state_argument("z"),
                          {.name = "values", .sizes = {2 * n}, .changes = true}},
            .body = {{Call{
                .routine = "gradient",
                .arguments = {
                    {"par"}, {"z", "q"}, {"z", "p"}, {"values"}, {"values", "", {{n, {}}}}}}}}};
  }

  // With as many terms as there are.
  [[nodiscard]] Routine modified_energy() const {
    const std::vector<int>& powers = program_.facts.modified_powers;
    const int count = static_cast<int>(powers.size());
    Routine routine{.name = "modified_energy",
                    .remark = {fmt::format("Cut off after h^{}.", powers.back())},
                    .result = {"Real"},
                    .arguments = {parameters_argument(), {"h"}, state_argument("z")}};
    const Expression last = bind_element(routine, "values", {count - 1});
    routine.body = {
        {Array{"values", {count}}},
        {Call{.routine = "modified_energies", .arguments = {{"par"}, {"h"}, {"z"}, {"values"}}}},
        {Return{.value = last}}};
    return routine;
  }

  void add_steps() {
    const bool by_propagator = program_.substeps.size() > 1 || arrays_ || wishes_.lanes > 0;
    if (!by_propagator) add(single_step(program_));
    add(wishes_.lanes > 0 ? lane_propagator_of(program_, wishes_.lanes) : propagator_of(program_));
    if (by_propagator) add(StepOfPropagator{});
  }

  const Program& program_;
  const ContentsWishes& wishes_;
  bool arrays_;
  std::vector<Piece>* pieces_ = nullptr;  // that are added to
  Record of_system_, of_method_;          // parameters
  std::set<std::string> taken_;
};

}  // namespace

Contents contents_of(const Program& program, const ContentsWishes& wishes) {
  if (wishes.lanes == 0) return ContentsBuilder(program, wishes).build();
  const Program together = in_lanes(program);
  return ContentsBuilder(together, wishes).build();
}

const Field* parameter_of_method(const Contents& contents) {
  const auto* const record =
      contents.method.empty() ? nullptr : std::get_if<Record>(&contents.method.front());
  return record != nullptr && record->extends ? &record->fields.front() : nullptr;
}

}  // namespace hamgen
