#include "generator/program/lane_program.hpp"

#include <algorithm>

namespace hamgen {

namespace {

Record* record_of(Program& code, const char* name) {
  const auto found = std::ranges::find(code.records, name, &Record::name);
  return found == code.records.end() ? nullptr : &*found;
}

// Flags and counts of each lane.
void set_types(Record& record) {
  for (Field& field : record.fields) {
    if (field.type == "bool") field.type = "Mask";
    if (field.type == "int") field.type = "Real";
  }
}

// Fields of start that functions of the state fill in, of all lanes: no step reads what they were.
void collect_filled(const Program& code, const Body& body, std::set<std::string>& fields) {
  for (const Instruction& instruction : body) {
    for (const Body* inner : inner_bodies(instruction)) collect_filled(code, *inner, fields);
    const auto* call = std::get_if<Call>(&instruction.value);
    const Routine* called = call == nullptr ? nullptr : code.routine(call->routine);
    for (std::size_t i = 0; called != nullptr && i < called->arguments.size(); ++i) {
      const Argument& argument = called->arguments[i];
      if (argument.changes && argument.record.empty() && call->arguments[i].object == "start")
        fields.insert(call->arguments[i].field);
    }
  }
}

}  // namespace

Program in_lanes(Program code) {
  if (!code.retries) return code;
  if (Record* coefficients = record_of(code, "Coefficients")) set_types(*coefficients);
  Record& start = *record_of(code, "Start");
  const bool is_kept =
      std::ranges::find(start.fields, "factorised", &Field::name) != start.fields.end();
  if (code.matrix) code.matrix->in_lanes = true;
  if (code.matrix) code.matrix->kept = is_kept;
  std::set<std::string> filled;
  for (const Routine& routine : code.routines) collect_filled(code, routine.body, filled);
  std::vector<Place> in_turn = {{"dz"}, {"rest"}};
  for (const Field& field : start.fields) {
    const bool flag = field.type == "bool" || field.type == "int";
    const bool number = field.type == "Real" && !filled.contains(field.name);
    if (flag || number || (field.type == "Matrix" && is_kept))
      in_turn.push_back({"start", field.name});
  }
  for (Routine& routine : code.routines) {
    const bool solves =
        std::ranges::find(routine.arguments, "Start", &Argument::record) != routine.arguments.end();
    if (!solves) continue;
    routine.in_turn = in_turn;
    if (routine.result.type == "bool") routine.result.type = "Mask";
  }
  set_types(start);
  start.fields.insert(
      start.fields.begin(),
      {.name = "turn", .remark = "the lanes that have a part in it", .type = "Turn"});
  return code;
}

}  // namespace hamgen
