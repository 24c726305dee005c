// What an emitted file has of a step, in its order.
#include "generator/program/contents.hpp"

#include <gtest/gtest.h>

#include <string>

#include "generator/stages.hpp"

namespace hamgen {
namespace {

struct NameOfPiece {
  std::string operator()(const Record& record) const {
    return record.name + (record.extends ? "+" : "");
  }
  std::string operator()(const Routine& routine) const { return routine.name + "()"; }
  std::string operator()(const ArrayMatrix&) const { return "Matrix"; }
  std::string operator()(const StepOfPropagator&) const { return "step by Propagator"; }
  std::string operator()(const Watch& watch) const {
    return "Watch " + std::to_string(watch.events.size());
  }
  std::string operator()(const Propagator& propagator) const {
    std::string text = "Propagator:";
    for (const auto& [name, value] : propagator.constants)
      text += " " + name + "=" + std::to_string(value);
    for (const Accessor& accessor : propagator.accessors) text += " " + accessor.name;
    return text;
  }
};

std::string names_of_pieces(const std::vector<Piece>& pieces) {
  std::string text;
  for (const Piece& piece : pieces)
    text += (text.empty() ? "" : ", ") + std::visit(NameOfPiece{}, piece);
  return text;
}

Contents contents_of_model(const std::string& model, const Request& request,
                           const ContentsWishes& wishes = {}) {
  return contents_of(run_stages(make_source("test.ham", model), request).program, wishes);
}

const std::string kOscillator =
    "coordinate q\nmomentum p\nparameter k = 2\nH = p^2/2 + k*q^4/4\ninvariant E = p^2 + k*q^4/2\n"
    "event top = p\n";

TEST(Contents, OfTheSystemComeFirst) {
  const Contents contents = contents_of_model(kOscillator, {});
  EXPECT_EQ(names_of_pieces(contents.system),
            "Parameters, State, energy(), gradient(), invariants()");
  EXPECT_EQ(names_of_pieces(contents.method),
            "Coefficients, prepare(), Start, solve(), step(), "
            "Propagator: state carry time h parameters");
}

TEST(Contents, EventsAndTheTangentFollowTheSteps) {
  const Contents contents =
      contents_of_model(kOscillator, {.tangent = true, .events = true}, {.tangent = true});
  const std::string names = names_of_pieces(contents.method);
  EXPECT_TRUE(names.ends_with("parameters, events(), Watch 1, tangent()")) << names;
}

TEST(Contents, ACompositionStepsByItsPropagator) {
  const Contents contents = contents_of_model(kOscillator, {.scheme = "yoshida-4"});
  const std::string names = names_of_pieces(contents.method);
  EXPECT_TRUE(
      names.ends_with("Propagator: substeps=3 state carry time h parameters, "
                      "step by Propagator"))
      << names;
}

TEST(Contents, InLanesFlagsAreMasksAndEachLaneRunsForItself) {
  const Contents contents = contents_of_model(kOscillator, {}, {.lanes = 4});
  const std::string names = names_of_pieces(contents.method);
  EXPECT_TRUE(
      names.ends_with("solve(), Propagator: lanes=4 state carry running time h parameters, "
                      "step by Propagator"))
      << names;
  for (const Piece& piece : contents.method) {
    const auto* const record = std::get_if<Record>(&piece);
    if (record == nullptr || record->name != "Start") continue;
    for (const Field& field : record->fields) EXPECT_NE(field.type, "bool") << field.name;
  }
}

// alpha is read by the steps alone: in a namespace of its own the method adds it.
TEST(Contents, AParameterOfTheMethodAloneIsItsOwn) {
  const std::string model =
      "coordinate q\nmomentum p\nparameter k = 2\nparameter a = 1/3\nH = p^2/2 + k*q^4/4\n";
  const Request request{.alpha = "a"};
  const Contents contents = contents_of_model(model, request);
  ASSERT_NE(parameter_of_method(contents), nullptr);
  EXPECT_EQ(parameter_of_method(contents)->name, "a");
  EXPECT_TRUE(names_of_pieces(contents.method).starts_with("Parameters+, "));
  const Contents as_one = contents_of_model(model, request, {.own_space = false});
  EXPECT_EQ(parameter_of_method(as_one), nullptr);
  EXPECT_EQ(std::get<Record>(as_one.system.front()).fields.size(), 2U);
}

TEST(Contents, OfSystemsInLoopsHaveTheGradientOfAStateAndTheirMatrix) {
  const std::string chain =
      "size N = 32\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, (q[i+1] - q[i])^2/2 + (q[i+1] - q[i])^4/4)\n";
  const Contents contents = contents_of_model(chain, {.solver = "newton"});
  EXPECT_NE(names_of_pieces(contents.system).find("gradient(), gradient()"), std::string::npos)
      << names_of_pieces(contents.system);
  EXPECT_TRUE(names_of_pieces(contents.method).starts_with("Matrix, "))
      << names_of_pieces(contents.method);
}

}  // namespace
}  // namespace hamgen
