// How many places of an array belong to one element, and where no such number makes neighbours in
// loops neighbours in the system.
#include "generator/verify/rooms.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace hamgen {
namespace {

using Event = CodeEvent::Kind;

// Events by hand, of a system with `size` elements.
class Lines {
 public:
  explicit Lines(long size) : size_(size) {}

  Lines& routine(const std::string& name, const std::vector<std::string>& arguments = {}) {
    events_.push_back({.kind = Event::routine, .text = name});
    for (const std::string& each : arguments)
      events_.push_back({.text = "argument", .names = {each}});
    return *this;
  }
  // From 0 to one less than so many for each element.
  Lines& loop(const std::string& index, long each = 1) {
    events_.push_back(
        {.kind = Event::loop, .text = index, .names = {}, .numbers = {0, each * size_ - 1}});
    return *this;
  }
  Lines& stages(const std::string& index, long count, int lanes = 0) {
    events_.push_back({.kind = Event::loop, .text = index, .names = {}, .numbers = {0, count - 1}});
    events_.back().lanes = lanes;
    return *this;
  }
  Lines& end() {
    events_.push_back({.kind = Event::end});
    return *this;
  }
  // Reads b at its place, and assigns it to a at its own.
  struct At {
    std::string array;
    std::vector<std::string> indices;
    std::vector<long> factors;      // and the constant
    long further = 0;               // so many times the size
    std::vector<long> column = {};  // of a matrix: the factors and the constant there
  };
  Lines& set(const At& a, const At& b) {
    add(Event::get, b);
    add(Event::set, a);
    return *this;
  }
  Lines& call(const std::string& name, const std::vector<std::string>& given) {
    events_.push_back({.kind = Event::call, .text = name});
    for (const std::string& each : given) events_.push_back({.text = "given", .names = {each}});
    return *this;
  }
  Lines& solve(const std::string& matrix, const std::string& vector) {
    events_.push_back({.text = "solve", .names = {matrix}});
    events_.push_back({.text = "for", .names = {vector}});
    return *this;
  }
  [[nodiscard]] long size() const { return size_; }
  [[nodiscard]] SizedOutline take() const { return {size_, events_}; }

 private:
  void add(Event kind, const At& at) {
    events_.push_back({.kind = kind, .text = at.array});
    events_.push_back({.kind = Event::element, .names = at.indices, .numbers = at.factors});
    events_.back().numbers.back() += at.further * size_;
    if (!at.column.empty())
      events_.push_back({.kind = Event::element, .names = at.indices, .numbers = at.column});
  }
  long size_;
  std::vector<CodeEvent> events_;
};

template <class Write>
std::array<SizedOutline, 3> sizes_of(const Write& write) {
  const auto of = [&](long size) {
    Lines lines(size);
    write(lines);
    return lines.take();
  };
  return {of(25), of(26), of(40)};
}

// Why it is not the same, longer; and before that whether there are rooms at all.
template <class Write>
std::string why_not(const Write& write) {
  return why_not_longer(sizes_of(write)).value_or("");
}
const std::string kNoNeighbours = "neighbours in its loops do not have neighbouring places";

TEST(Rooms, OfStagesAreAsManyAsThereAre) {
  const auto write = [](Lines& lines) {
    lines.routine("solve").loop("j").stages("i", 4, 4);
    lines.set({"stage.", {"i", "j"}, {1, 4, 0}}, {"z.q", {"j"}, {1, 0}}).end().end();
    lines.loop("k", 4).set({"stage.", {"k"}, {1, 0}}, {"lack.", {"k"}, {1, 0}}).end();
  };
  const std::array<SizedOutline, 3> sizes = sizes_of(write);
  const Rooms rooms(affine_events(sizes));
  EXPECT_EQ(rooms.of("solve", "stage.", 0), 4);
  EXPECT_EQ(rooms.of("solve", "lack.", 0), 4);
  EXPECT_EQ(rooms.of("solve", "z.q", 0), 1);
  EXPECT_EQ(rooms.of("solve", "another.", 0), 1);
  EXPECT_EQ(why_not(write), "");
}

TEST(Rooms, AreOneNumberForEachArray) {
  // y[j] = x[2 j] and, elsewhere, x[j] = y[j]: a value at 2 j goes to j.
  EXPECT_EQ(why_not([](Lines& lines) {
              lines.routine("solve");
              lines.loop("j").set({"y.", {"j"}, {1, 0}}, {"x.", {"j"}, {2, 0}}).end();
              lines.loop("k").set({"x.", {"k"}, {1, 0}}, {"y.", {"k"}, {1, 0}}).end();
            }),
            kNoNeighbours);
  // The same in one loop.
  EXPECT_EQ(why_not([](Lines& lines) {
              lines.routine("solve").loop("j");
              lines.set({"x.", {"j"}, {2, 0}}, {"x.", {"j"}, {1, 0}}).end();
            }),
            kNoNeighbours);
  // By way of a third one.
  EXPECT_EQ(why_not([](Lines& lines) {
              lines.routine("solve");
              lines.loop("j").set({"y.", {"j"}, {1, 0}}, {"x.", {"j"}, {2, 0}}).end();
              lines.loop("k").set({"w.", {"k"}, {1, 0}}, {"x.", {"k"}, {1, 0}}).end();
              lines.loop("l").set({"w.", {"l"}, {1, 0}}, {"y.", {"l"}, {1, 0}}).end();
            }),
            kNoNeighbours);
}

TEST(Rooms, AreThoseOfWhatIsHandedOver) {
  const auto write = [](const std::vector<std::string>& given, Lines& lines) {
    lines.routine("copy", {"x", "y"});
    lines.loop("k").set({"y.", {"k"}, {1, 0}}, {"x.", {"k"}, {1, 0}}).end();
    // Has nothing of its own to do with the arrays.
    lines.routine("pass", {"start"}).call("copy", given);
    lines.routine("solve", {"start"}).call("pass", {"start."});
    lines.loop("j");
    lines.set({"start.wide", {"j"}, {2, 0}}, {"start.narrow", {"j"}, {1, 0}}).end();
    lines.loop("j");
    lines.set({"start.wide", {"j"}, {2, 1}}, {"start.other", {"j"}, {1, 0}}).end();
  };
  const auto of = [&](const std::vector<std::string>& given) {
    return why_not([&](Lines& lines) { write(given, lines); });
  };
  EXPECT_EQ(of({"start.narrow", "start.other"}), "");
  EXPECT_EQ(of({"start.wide", "start.other"}), kNoNeighbours);
  EXPECT_EQ(of({"start.narrow", "start.wide"}), kNoNeighbours);
}

TEST(Rooms, OfAMatrixAreThoseOfItsVector) {
  const auto of = [&](long row, long column) {
    return why_not([&](Lines& lines) {
      lines.routine("solve").solve("matrix.", "lack.");
      lines.loop("j").set({"lack.", {"j"}, {2, 0}}, {"z.", {"j"}, {1, 0}}).end();
      lines.loop("j").set({"row.", {"j"}, {row, 0}}, {"z.", {"j"}, {1, 0}}).end();
      lines.loop("j").set({"row.", {"j"}, {row, 0}}, {"matrix.", {"j"}, {column, 0}}).end();
    });
  };
  EXPECT_EQ(of(1, 2), "");
  EXPECT_EQ(of(3, 2), "");
  EXPECT_EQ(of(1, 1), kNoNeighbours);
}

// Rows and columns of a matrix are of the same elements.
TEST(Rooms, OfRowsAreThoseOfColumns) {
  const auto of = [&](long column) {
    return why_not([&](Lines& lines) {
      lines.routine("solve").solve("matrix.", "lack.").loop("j");
      lines.set({"matrix.", {"j"}, {2, 0}, 0, {column, 1}}, {"z.", {"j"}, {1, 0}}).end();
    });
  };
  EXPECT_EQ(of(2), "");
  EXPECT_EQ(of(1), kNoNeighbours);
}

// Of vectors that one matrix is solved for, too, whose entries no line of its own names.
TEST(Rooms, OfVectorsOfOneMatrixAreTheSame) {
  const auto of = [&](long change) {
    return why_not([&](Lines& lines) {
      lines.routine("solve").solve("matrix.", "lack.").solve("matrix.", "change.");
      lines.loop("j").set({"lack.", {"j"}, {2, 0}}, {"z.", {"j"}, {1, 0}}).end();
      lines.loop("j").set({"change.", {"j"}, {change, 0}}, {"z.", {"j"}, {1, 0}}).end();
    });
  };
  EXPECT_EQ(of(2), "");
  EXPECT_EQ(of(1), kNoNeighbours);
}

// From the last element to the first, or as far apart as the system is long.
TEST(Rooms, AreNoneWhereElementsGoBackOrApart) {
  const auto of = [&](const auto& factor) {
    return why_not([&](Lines& lines) {
      lines.routine("solve").loop("j");
      lines.set({"a.", {"j"}, {factor(lines.size()), 0}}, {"b.", {"j"}, {1, 0}}).end();
    });
  };
  EXPECT_EQ(of([](long) { return 1L; }), "");
  EXPECT_EQ(of([](long) { return -1L; }), kNoNeighbours);
  EXPECT_EQ(of([](long size) { return size; }), kNoNeighbours);
}

TEST(Rooms, HoldThePlacesOfOneElement) {
  const auto of = [&](long first, long stages, long beyond) {
    return why_not([&](Lines& lines) {
      lines.routine("solve").loop("j").stages("i", stages);
      lines.set({"stage.", {"i", "j"}, {1, 2, first}}, {"z.", {"j"}, {1, 0}}).end().end();
      lines.loop("j");
      lines.set({"next.", {"j"}, {1, 0}}, {"stage.", {"j"}, {2, beyond}}).end();
    });
  };
  EXPECT_EQ(of(0, 2, 1), "");
  EXPECT_EQ(of(2, 2, 3), "");
  // From the second place of one to the first of the next.
  EXPECT_EQ(of(1, 2, 0), kNoNeighbours);
  EXPECT_EQ(of(0, 3, 0), kNoNeighbours);
}

// Each round of a loop outside takes a value a place on, those at once take it once.
TEST(Rooms, StagesAtOnceGoOneWay) {
  const auto of = [&](long stages, int lanes) {
    return why_not([&](Lines& lines) {
      lines.routine("solve").stages("i", stages, lanes).loop("j");
      lines.set({"a.", {"i", "j"}, {1, stages, 0}}, {"b.", {"i", "j"}, {1, stages, 2 * stages}});
      lines.end().end().stages("i", stages, lanes).loop("j");
      lines.set({"b.", {"i", "j"}, {1, stages, 0}}, {"a.", {"i", "j"}, {1, stages, 0}});
      lines.end().end();
    });
  };
  EXPECT_EQ(of(8, 8), "");
  EXPECT_EQ(of(8, 0), "its loops reach 17 elements far");
  EXPECT_EQ(of(16, 2), "its loops reach 17 elements far");
}

// What is written and what is read in one loop are apart if they are as far as the loop goes, in
// places of the array.
TEST(Rooms, BlocksAreAsLongAsTheirPlaces) {
  const auto of = [&](long places) {
    return why_not([&](Lines& lines) {
      lines.routine("solve").loop("j");
      lines.set({"a.", {"j"}, {2, 0}}, {"a.", {"j"}, {2, 0}, places}).end();
    });
  };
  EXPECT_EQ(of(2), "");
  EXPECT_EQ(of(1), "an instance of a loop reads what another one writes");
}

}  // namespace
}  // namespace hamgen
