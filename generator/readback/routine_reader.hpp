// One function of the text against one routine of the program.
#pragma once

#include <functional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "generator/base/diagnostic.hpp"
#include "generator/program/program.hpp"
#include "generator/readback/text_scope.hpp"

namespace hamgen {

// Throws TextDifference at the first statement that is not the routine's, TextNotUnderstood where
// the text cannot be read.  n: what the text calls n, else 0.
class RoutineReader {
 public:
  RoutineReader(const CppFunction& function, const Routine& routine, const Precision& precision,
                int n);

  void compare();
  // How many instructions of the routine were found in the text.
  [[nodiscard]] int instructions() const { return instructions_; }

  void operator()(const Let& let);
  void operator()(const Array& array);
  void operator()(const Matrix& matrix);
  void operator()(const Copy& copy);
  void operator()(const Assign& assign);
  [[nodiscard]] bool is_of_stages(const std::string& symbol) const;
  void lanes_assignment(const std::string& how, const std::string& to, const Expression& value);
  void operator()(const Collect& sum);
  void operator()(const Accumulate& sum);
  void operator()(const Clear& clear);
  void operator()(const Put& put);
  void operator()(const SetFlag& set);
  void operator()(const For& loop);
  void operator()(const Scope& scope);
  void operator()(const If& branch);
  void operator()(const Call& call);
  void operator()(const Alternate& alternate);
  void operator()(const Factorise& factorise);
  void operator()(const SolveFactorised& solve);
  void operator()(const Invert& invert);
  void operator()(const Iterate& iterate);
  void operator()(const IterateArray& iterate);
  void operator()(const Refine& refine);
  void operator()(const RefineArray& refine);
  void operator()(const Sweep& sweep);
  // Read word by word: see run_words.hpp.
  void operator()(const InstructionOfRun auto&) { internal_error("a step that keeps a history"); }
  void operator()(const Return& end);

 private:
  using Statements = std::span<const CppStatement>;
  using Values = std::vector<MachineValue>;

  void compare_signature();
  void compare_argument(const CppArgument& written, const Argument& argument);
  void compare(const Body& body);
  // The body in these statements, all of them, with names of its own.
  void within(const CppStatement& statement, const std::function<void()>& inside);
  void compare_inside(const CppStatement& statement, const Body& body);

  // The next statement, which `what` is expected of.
  const CppStatement& next(CppStatement::Kind kind, const std::string& what);
  [[nodiscard]] const CppStatement* peek() const;
  // A declaration, of which nothing is read but that it has this type.
  const CppStatement& declaration(const std::string& type, const std::string& what);
  // TYPE name = value; the name means `symbol`.
  void local(const std::string& type, const std::string& symbol, const MachineValue& value);
  void object(const std::string& type, const std::string& name);
  void array(const std::string& name, const std::vector<int>& sizes, const Values& values);
  // a = b, a += b and the like.
  void assignment(const MachineValue& to, const std::string& sign, const MachineValue& value);
  // A statement that is this call.
  void call(const MachineValue& value);
  const CppStatement& branch(const MachineValue& condition);
  const CppStatement& loop(const KernelRange& range, int step = 1);
  // for (int name = 1;; ++name), which `symbol` is what it counts in.
  const CppStatement& endless(const std::string& symbol);
  void same(const MachineValue& written, const MachineValue& exact, int line,
            const std::string& what);
  [[nodiscard]] bool is_place(const CppExpression& written, const Place& place) const;
  [[nodiscard]] bool is_called(const CppExpression& written, const Call& call) const;
  // return false; or return report;
  void failure();
  void leave_with(const std::string& jump);

  [[nodiscard]] MachineValue meant(const Expression& e);
  [[nodiscard]] std::string meaning_of(const std::string& symbol) const;
  [[nodiscard]] MachineValue symbol(const std::string& name) const;
  [[nodiscard]] MachineValue magnitude(const MachineValue& value) const;
  [[nodiscard]] MachineValue length(const Unknown& u);
  [[nodiscard]] MachineValue length(const UnknownArray& u);

  void newton(const Iterate& iterate);
  void fixed_point(const Iterate& iterate);
  void newton(const IterateArray& iterate);
  void contraction(const IterateArray& iterate);
  void distance_of(const IterateArray& iterate);
  void end_newton();
  void end_contraction(const MachineValue& size);
  void for_elements(const std::vector<KernelRange>& ranges, const std::function<void()>& lines,
                    std::size_t depth = 0);
  void refine_body(const Refine& refine, const std::string& kept);

  const CppFunction& function_;
  const Routine& routine_;
  TextScope scope_;
  Statements statements_;
  std::size_t at_ = 0;
  int end_line_ = 0;  // of the function, as far as it is known
  std::set<std::string> kept_;
  bool iterates_ = false;
  int instructions_ = 0;
};

}  // namespace hamgen
