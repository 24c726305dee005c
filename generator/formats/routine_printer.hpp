// Prints one routine: the instructions in print_code.cpp, the iterations in print_iterations.cpp.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "generator/formats/print_code.hpp"
#include "generator/formats/print_expression.hpp"
#include "generator/program/names.hpp"

namespace hamgen {

class RoutinePrinter {
 public:
  RoutinePrinter(CodeWriter& out, const Routine& routine, const Dialect& dialect, Used& used);

  void print();

  void operator()(const Let& let);
  void operator()(const Array& array);
  void operator()(const Matrix& matrix);
  void operator()(const Copy& copy);
  void operator()(const Assign& assign);
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
  void operator()(const Use& use);
  void operator()(const Declare& declare);
  void operator()(const Note& note);
  void operator()(const Count& count);
  void operator()(const Ask& ask);
  void operator()(const Forget& forget);
  void operator()(const Repeat& repeat);
  void operator()(const Break& leave);
  void operator()(const RequireFinite& finite);
  void operator()(const Return& end);

 private:
  void print(const Body& body);
  // A single statement on the line of its head, if that has room for it.
  void print_inside(const std::string& head, const Body& body);

  void newton(const Iterate& iterate);
  void fixed_point(const Iterate& iterate);
  void factorise_lanes(const Factorise& factorise);
  void newton(const IterateArray& iterate);
  void contraction(const IterateArray& iterate);
  // What follows a verdict.
  void end_newton();
  void end_newton_of_lanes(const Iterate& iterate, const std::vector<std::string>& corrections);
  void end_contraction(const std::string& rule);
  // The sum of the squares of what should be finite.
  void length_of(const Return& end);
  // Over all elements the lines that `lines` gives for every array of unknowns.
  void for_elements(const IterateArray& iterate,
                    const std::function<void(const UnknownArray&)>& lines);
  // What an unknown is rounded with.
  [[nodiscard]] std::string length(const Unknown& u);
  [[nodiscard]] std::string length(const UnknownArray& u);
  [[nodiscard]] std::string scale(const Iterate& iterate);
  [[nodiscard]] std::string magnitude(const std::string& x) const;
  // Where the values of the body at the rounded unknowns wait: kept_0 beside refinement_0.
  [[nodiscard]] static std::string kept_name(const Refine& refine);

  // How the routine says that it has failed.
  [[nodiscard]] std::string failure() const;
  [[nodiscard]] std::string call_text(const Call& call) const;
  [[nodiscard]] std::string head(const KernelRange& range, int step = 1) const;
  // Of an array in a loop over lanes: are its numbers there side by side?
  [[nodiscard]] bool is_pack(const Place& place) const;
  [[nodiscard]] std::string count_text(long count) const;
  std::string name(const std::string& symbol);
  [[nodiscard]] std::string text(const AffineIndex& a) const;
  [[nodiscard]] std::string text(const Place& place) const;
  // An argument of a call: of an element, the array from there on.
  [[nodiscard]] std::string given(const Place& place) const;
  [[nodiscard]] std::string declaration(const Argument& argument) const;
  [[nodiscard]] std::string signature() const;
  void reserve_arrays(const Body& body);
  void name_objects();
  // What an object of the routine is called.
  [[nodiscard]] std::string object(const std::string& name) const;
  // Is it a record that the routine is given the address of?
  [[nodiscard]] bool is_address(const std::string& object) const;
  // "z.", before a field, and z itself.
  [[nodiscard]] std::string of(const std::string& object) const;
  [[nodiscard]] std::string value_of(const std::string& object) const;

  CodeWriter& out_;
  const Routine& routine_;
  const Dialect& dialect_;
  Used& used_;
  Names names_;
  ExpressionPrinter cpp_;
  std::map<std::string, std::string> objects_;  // those called otherwise than in the routine
  std::set<std::string> records_;               // that it declares
  std::set<std::string> kept_;                  // locals that an iteration changes
  bool iterates_ = false;
  std::string lane_index_;  // of the loop over lanes that is printed
  std::string rule_;        // that it iterates by
  const std::vector<std::string>* remark_ = nullptr;
};

}  // namespace hamgen
