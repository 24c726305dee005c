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
  void require_found(const Place& refinement, const std::optional<Place>& patience = {},
                     int steps = 0) {
    const auto field = [&](const std::string& name) {
      Place place = refinement;
      place.field += (place.field.empty() ? "" : ".") + name;
      return at(place);
    };
    give_up(prefix("!", field("found")), [&] {
      set_number(at({"report", "increment"}), field("last"), form_.lanes);
      if (patience) set_number(at(*patience), integer(steps), form_.lanes);
    });
  }
  // `last` is written before the routine ends, or in lanes of those that have no part in the rest.
  void give_up(Value lost, const Lines& last = {}) {
    if (!form_.lanes) {
      return branch(std::move(lost), last ? Shape::braces : Shape::line, [&] {
        if (last) last();
        fail();
      });
    }
    narrow(std::move(lost), Shape::braces, [&] {
      if (last) last();
      const Value converged = at({"report", "converged"});
      set(converged, joined("&", {converged, prefix("!", lanes_in_turn())}));
    });
    set(lanes_in_turn(), joined("&", {lanes_in_turn(), at({"report", "converged"})}));
  }
};

}  // namespace hamgen::written
