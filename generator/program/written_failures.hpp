// Where a routine ends because what it looks for is not found.
#pragma once

#include <optional>

#include "generator/program/written_statements.hpp"

namespace hamgen::written {

class FailureWriter : public StatementWriter {
 public:
  using StatementWriter::StatementWriter;

 protected:
  // What Refinement has not found is left to the solver behind, if there is one.
  void require_found(Place found, const std::optional<Place>& patience = {}, int steps = 0) {
    found.field += found.field.empty() ? "found" : ".found";
    give_up(prefix("!", at(found)), patience, steps);
  }
  void give_up(Value lost, const std::optional<Place>& patience = {}, int steps = 0) {
    const auto wait = [&] {
      if (patience) set_number(at(*patience), integer(steps), form_.lanes);
    };
    if (!form_.lanes) {
      return branch(std::move(lost), patience ? Shape::braces : Shape::line, [&] {
        wait();
        fail();
      });
    }
    narrow(std::move(lost), Shape::braces, [&] {
      wait();
      const Value converged = at({"report", "converged"});
      set(converged, joined("&", {converged, prefix("!", lanes_in_turn())}));
    });
    set(lanes_in_turn(), joined("&", {lanes_in_turn(), at({"report", "converged"})}));
  }
};

}  // namespace hamgen::written
