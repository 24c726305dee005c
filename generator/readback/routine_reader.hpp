// One function of the text against one routine of the program: its statements in
// routine_reader.cpp, the values in them in routine_values.cpp.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "generator/base/diagnostic.hpp"
#include "generator/program/program.hpp"
#include "generator/program/written_code.hpp"
#include "generator/readback/text_scope.hpp"

namespace hamgen {

// What a routine stands in.
struct TextOf {
  const Precision& precision;
  int n = 0;                    // what it calls n, else 0
  bool c = false;               // C, as `without_addresses` leaves it
  bool lanes = false;           // a number is a pack of one of each trajectory
  const Record* run = nullptr;  // what a run keeps
};

// Throws TextDifference at the first statement that is not the routine's, TextNotUnderstood where
// the text cannot be read.
class RoutineReader {
 public:
  RoutineReader(const CppFunction& function, const Routine& routine, const TextOf& text);

  void compare();

 private:
  using Statements = std::span<const CppStatement>;

  void compare_signature();
  void compare_argument(const CppArgument& written, const Argument& argument);
  void compare(const written::Body& body);
  void compare_inside(const CppStatement& statement, const written::Body& body);

  void read(const Declare& declare);
  void read(const written::Define& define);
  void read(const written::Set& set);
  void read(const written::Do& action);
  void read(const written::For& node);
  void read(const written::Loop& node);
  void read(const written::While& node);
  void read(const written::If& branch);
  void read(const written::Block& block);
  void read(const Break& leave);
  void read(const written::Continue& next);
  void read(const written::Return& end);
  void read(const written::Each& node);

  // The next statement, which `what` is expected of.
  const CppStatement& next(CppStatement::Kind kind, const std::string& what);
  [[nodiscard]] const CppStatement* peek() const;
  // A declaration, of which nothing is read but that it has this type.
  const CppStatement& declaration(std::string type, const std::string& what);
  const CppStatement& counter(const std::string& type, const std::string& what, int lanes = 0);
  const CppStatement& loop(const KernelRange& range, int lanes);
  void require_same(const CppExpression& e, const written::Value& value, int line,
                    const std::string& what);

  [[nodiscard]] bool same(const CppExpression& e, const written::Value& v);
  // The parts of the expression from `first` on.
  [[nodiscard]] bool same_parts(const CppExpression& e, std::size_t first, const written::Value& v,
                                std::size_t first_of_value);
  [[nodiscard]] bool is_free_name(const CppExpression& e, const std::string& name) const;
  [[nodiscard]] bool is_largest(const CppExpression& e) const;
  [[nodiscard]] bool is_action(const CppExpression& e, const written::Value& v);
  [[nodiscard]] bool is_joined(const CppExpression& e, const written::Value& v);
  [[nodiscard]] bool is_given(const CppExpression& e, const Place& place) const;

  [[nodiscard]] MachineValue meant(const Expression& e);
  [[nodiscard]] std::string meaning_of(const std::string& symbol) const;

  const CppFunction& function_;
  const Routine& routine_;
  bool c_, lanes_;
  TextScope scope_;
  Statements statements_;
  std::size_t at_ = 0;
  int end_line_ = 0;  // of the function, as far as it is known
};

// How many there are, with those inside them.
[[nodiscard]] int instructions_of(const Body& body);

}  // namespace hamgen
