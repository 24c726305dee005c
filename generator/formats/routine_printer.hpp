// Prints one routine: its statements in print_code.cpp, their values in print_value.cpp.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "generator/formats/print_code.hpp"
#include "generator/formats/print_expression.hpp"
#include "generator/program/names.hpp"
#include "generator/program/written_code.hpp"

namespace hamgen {

class RoutinePrinter {
 public:
  RoutinePrinter(CodeWriter& out, const Routine& routine, const Dialect& dialect, Used& used);

  void print();

 private:
  void print(const written::Body& body);
  // A statement in one line, if it is one.
  std::optional<std::string> line(const written::Statement& statement);
  std::string line(const Declare& declare);
  std::string line(const written::Define& define);
  std::string line(const written::Set& set);
  std::string line(const written::Do& action) { return value(action.value) + ";"; }
  std::string line(const Break& /*leave*/) { return "break;"; }
  std::string line(const written::Continue& /*next*/) { return "continue;"; }
  std::string line(const written::Return& end) { return "return " + value(end.value) + ";"; }
  // What stands before a body.
  std::string head(const written::For& loop);
  std::string head(const written::Loop& loop);
  std::string head(const written::While& loop);
  std::string head(const written::Each& loop);
  std::string head(const written::If& branch) { return "if (" + value(branch.condition) + ")"; }
  std::string head(const written::Block& /*block*/) { return ""; }
  void print_inside(const std::string& head, const written::Body& body, written::Shape shape);

  std::string value(const written::Value& value);
  std::vector<std::string> values(const written::Value& of);
  std::string arguments(const written::Value& of) { return joined_texts(values(of), ", "); }
  // What a symbol of the program is called.
  std::string name(const std::string& symbol);
  [[nodiscard]] std::string sizes(const std::vector<int>& sizes) const;
  [[nodiscard]] std::string count_text(long count) const;
  [[nodiscard]] std::string text(const AffineIndex& a) const;
  [[nodiscard]] std::string text(const Place& place) const;
  // An argument of a call: of an element, the array from there on.
  [[nodiscard]] std::string given_text(const Place& place) const;
  [[nodiscard]] std::string declaration(const Argument& argument) const;
  void name_objects();
  void reserve(const written::Body& body);
  // What an object of the routine is called.
  [[nodiscard]] std::string object(const std::string& name) const;
  // Is it a record that the routine is given the address of?
  [[nodiscard]] bool is_address(const std::string& object) const;

  void set_lanes(const std::string& index) {
    lane_index_ = index;
    cpp_.set_lanes(!index.empty());
  }

  CodeWriter& out_;
  const Routine& routine_;
  const Dialect& dialect_;
  Used& used_;
  Names names_;
  ExpressionPrinter cpp_;
  std::map<std::string, std::string> objects_;  // those called otherwise than in the routine
  std::set<std::string> records_;               // that it declares
  std::string lane_index_;                      // of the loop over stages that is printed
};

}  // namespace hamgen
