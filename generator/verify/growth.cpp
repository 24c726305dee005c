#include "generator/verify/growth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "generator/verify/local_sums.hpp"
#include "generator/verify/rooms.hpp"

namespace hamgen {

namespace {

using Event = CodeEvent::Kind;

// How far values reach, and whether there are sums over pairs.
struct Reach {
  long elements = 0;
  bool pairs = false;
  std::set<std::string> readers_of_sums = {};  // routines
  // Two ends and what lies between; with pairs, two elements that are at no end and next to each
  // other, and on either side of them one that is far from both; with sums that are read, thirds
  // of which an element and its neighbours touch two.
  [[nodiscard]] long least_size() const {
    const long alone = 2 * elements + 1;
    if (!readers_of_sums.empty()) return 3 * alone;
    return pairs ? 4 * elements + 4 : alone;
  }
};

// How far a value reaches: through one loop from its lowest to its highest neighbour, and through
// one routine all its loops and what it calls.
class Locality {
 public:
  explicit Locality(std::vector<GrowingEvent> events)
      : events_(std::move(events)), rooms_(events_) {
    const auto is_linear = [](const GrowingEvent& event) {
      return event.of.kind == Event::routine && event.of.text == "gradient_error";
    };
    if (std::ranges::none_of(events_, is_linear))
      functions_.insert({"curvature", "potential_curvature"});
  }

  // Elements at either end that places without an index name, and what is around them.
  Reach reach() {
    while (at_ < events_.size()) step();
    check_sums();
    long most = 0;
    for (const auto& [routine, loops] : radius_) most = std::max(most, loops);
    return {boundary_ + radius_["prepare"] + most, !with_pairs_.empty(), readers_};
  }

 private:
  struct Loop {
    std::string index;
    bool grows = false;
    long times = 1;  // of one that does not
    long first = 0, last = 0;
  };
  // An element in a nest of loops: by dimension the growing index, and what is added to it.
  using Offsets = std::vector<std::pair<std::string, long>>;
  // Which part of its array it is in: the indices that choose it, and by dimension where it begins,
  // in multiples of the size, and how many places an instance goes on.
  struct Block {
    std::string indices;
    std::vector<long> begins;
    std::vector<long> strides;
    auto operator<=>(const Block&) const = default;
  };
  using Places = std::set<std::pair<Block, Offsets>>;

  const GrowingEvent& next() { return events_[at_++]; }
  [[nodiscard]] bool grows(const std::string& index) const {
    return std::ranges::any_of(loops_,
                               [&](const Loop& loop) { return loop.grows && loop.index == index; });
  }
  [[nodiscard]] long growing_loops() const { return std::ranges::count_if(loops_, &Loop::grows); }
  [[nodiscard]] bool in_growing() const { return growing_loops() > 0; }
  [[nodiscard]] bool in_pairs() const { return growing_loops() == 2; }

  // How often the loops around it run what stands here.
  [[nodiscard]] long times() const {
    long product = 1;
    for (const Loop& loop : loops_) product *= loop.times;
    return product;
  }

  void step() {
    const GrowingEvent& event = next();
    const CodeEvent& of = event.of;
    const bool alone = std::exchange(alone_, false);
    switch (of.kind) {
      case Event::routine:
        // The sums and locals of another are others.
        check_sums();
        local_sums_.begin_routine();
        summed_over_pairs_.clear();
        passes_on_ = false;
        routine_ = of.text;
        radius_[routine_];
        return;
      case Event::call:
        return call(of.text);
      case Event::shared:
        throw NotLonger{"a routine reads what it changes by another name"};
      case Event::loop:
        return begin(event);
      case Event::end:
        return end();
      case Event::local:
        if (in_growing()) inner_locals_[of.text] = growing_loops();
        local_sums_.declare(of.text, std::ssize(loops_));
        return;
      case Event::index:
        return index();
      case Event::get:
      case Event::set:
      case Event::add:
        return access(of, alone);
      case Event::element:
        static_cast<void>(element(event, 1));
        return;
      case Event::word:
        alone_ = of.text == kAlone;
        return;
    }
  }

  void check_sums() {
    const auto is_read = [&](const std::string& name) { return read_.contains(name); };
    if (std::ranges::any_of(sums_, is_read))
      throw NotLonger{"a sum over all elements enters a loop"};
  }

  void call(const std::string& called) {
    if (in_growing()) throw NotLonger{"a routine is called for every element"};
    const bool in_function = functions_.contains(routine_);
    if (functions_.contains(called) && !in_function) return;
    if (with_pairs_.contains(called) && called != "differentiate") {
      if (!in_function) throw NotLonger{"a sum over pairs is looked into"};
      with_pairs_.insert(routine_);
      passes_on_ = true;
    }
    radius_[routine_] += times() * radius_[called];
  }

  void begin(const GrowingEvent& event) {
    if (!in_growing()) start_nest();
    const bool moves = event.of.names.size() > 1;
    if (moves && !is_triangle(event))
      throw NotLonger{"the ends of a loop move with another one's index"};
    Loop loop{.index = event.of.text, .grows = hamgen::grows(event)};
    for (const AffineNumber& bound : event.numbers) {
      if (loop.grows) boundary_ = std::max(boundary_, std::abs(bound.near));
    }
    loop.first = event.numbers.front().near;
    loop.last = event.numbers.back().near;
    if (!loop.grows) loop.times = std::max(1L, times_of(loop, event.of.lanes));
    if (loop.grows) covers_ = growing_loops() == 0 && !moves ? covered(event) : std::nullopt;
    if (loop.grows && in_pairs()) throw NotLonger{"a sum runs over more than pairs"};
    loops_.push_back(std::move(loop));
  }
  // Those at once go through the loops inside together.
  static long times_of(const Loop& loop, int lanes) {
    const long count = loop.last - loop.first + 1;
    return lanes > 1 ? (count + lanes - 1) / lanes : count;
  }
  // How many elements the loop has at most, in multiples of the size.
  static std::optional<long> covered(const GrowingEvent& event) {
    const AffineNumber& from = event.numbers.front();
    const AffineNumber& to = event.numbers.back();
    if (to.near >= from.near) return {};
    return to.slope - from.slope;
  }
  // One end moves with the loop around it, element by element: the other one is fixed.
  [[nodiscard]] bool is_triangle(const GrowingEvent& event) const {
    const std::vector<std::string>& names = event.of.names;
    if (names.size() != 2 || growing_loops() != 1) return false;
    const bool lower = names.front() != kUpTo;
    const AffineNumber& factor = event.numbers[lower ? 1 : 2];
    const AffineNumber& moving = event.numbers[lower ? 0 : 1];
    return grows(lower ? names.front() : names.back()) && factor.near == 1 && factor.slope == 0 &&
           moving.slope == 0;
  }
  void start_nest() {
    lowest_.reset();
    highest_.reset();
    written_.clear();
    gets_.clear();
    inner_locals_.clear();
    local_sums_.begin_nest();
  }
  // Is what an instance writes and reads of an array its own?  It is if the place is the same, and
  // if the places are the same in several blocks of it that do not meet.
  [[nodiscard]] bool is_own(const Places& written, const Places& read) const {
    if (written.size() == 1 && read == written) return true;
    Places all = written;
    all.insert(read.begin(), read.end());
    const auto& [block, place] = *all.begin();
    std::set<long> begins;
    for (const auto& [other, there] : all) {
      if (there != place || other.begins.size() != 1 || other.indices != block.indices ||
          other.strides != block.strides)
        return false;
      begins.insert(other.begins.front());
    }
    const long stride = block.strides.front();
    const auto meet = [&](long a, long b) { return !covers_ || b - a < *covers_ * stride; };
    return std::ranges::adjacent_find(begins, meet) == begins.end();
  }
  void end() {
    loops_.pop_back();
    if (in_growing()) return;
    // What an instance writes no other one reads: else a value could travel along the loop.
    for (const auto& [name, places] : written_) {
      const auto read = gets_.find(name);
      if (read == gets_.end()) continue;
      if (!is_own(places, read->second))
        throw NotLonger{"an instance of a loop reads what another one writes"};
    }
    for (const std::string& name : summed_over_pairs_) {
      if (gets_.contains(name)) throw NotLonger{"a sum over pairs is looked into"};
    }
    radius_[routine_] += times() * (highest_.value_or(0) - lowest_.value_or(0));
    start_nest();
  }

  // An index as a number has to be one of few.
  void index() {
    while (at_ < events_.size() && events_[at_].of.kind == Event::element) {
      for (const std::string& name : next().of.names) {
        if (grows(name)) throw NotLonger{"its instances depend on their index"};
      }
    }
  }

  // In one dimension the growing index, if there is one, and which element from it on: the other
  // indices choose a block, whose length grows with the size, a place of the element, or an element
  // near an end.
  std::pair<std::string, long> element(const GrowingEvent& event, long room) {
    const long near = event.numbers.back().near;
    std::pair<std::string, long> result{"", near};
    long low = near, high = near;
    long stride = 0;
    for (std::size_t i = 0; i < event.of.names.size(); ++i) {
      const std::string& name = event.of.names[i];
      const auto& [factor, slope] = event.numbers[i];
      if (grows(name)) {
        if (stride != 0 || slope != 0 || factor <= 0)
          throw NotLonger{"neighbours in its loops do not have neighbouring places"};
        result.first = name;
        stride = factor;
      } else if (const auto loop = loop_of(name)) {
        low += std::min(factor * loop->first, factor * loop->last);
        high += std::max(factor * loop->first, factor * loop->last);
      }
    }
    if (stride == 0) {
      const long furthest = std::max(std::abs(low), std::abs(high));
      boundary_ = std::max(boundary_, (furthest + room - 1) / room);
      return result;
    }
    // A loop from place to place has no other index, and goes at most as far as its places.
    const long first = stride == room ? floor_of(low, room) : low;
    const long last = stride == room ? floor_of(high, room) : high;
    if (first != last) throw NotLonger{"neighbours in its loops do not have neighbouring places"};
    result.second = first;
    lowest_ = std::min(lowest_.value_or(first), first);
    highest_ = std::max(highest_.value_or(first), first);
    return result;
  }
  static long floor_of(long place, long room) {
    return place >= 0 ? place / room : -((-place + room - 1) / room);
  }
  [[nodiscard]] const Loop* loop_of(const std::string& index) const {
    const auto loop = std::ranges::find(loops_, index, &Loop::index);
    return loop == loops_.end() ? nullptr : &*loop;
  }

  void access(const CodeEvent& of, bool alone) {
    Offsets offsets;
    std::set<std::string> indices;
    Block block;
    while (at_ < events_.size() && events_[at_].of.kind == Event::element) {
      const GrowingEvent& event = next();
      const auto [index, offset] = element(event, rooms_.of(routine_, of.text, offsets.size()));
      offsets.emplace_back(index, offset);
      if (!index.empty()) indices.insert(index);
      block.strides.push_back(0);
      for (std::size_t i = 0; i < event.of.names.size(); ++i) {
        const std::string& name = event.of.names[i];
        if (name == index) block.strides.back() = event.numbers[i].near;
        // Others choose a place of the element.
        if (index.empty() || name == index || event.numbers[i].slope != 0)
          block.indices += " " + name;
      }
      block.indices += ",";
      block.begins.push_back(event.numbers.back().slope);
    }
    if (of.kind == Event::get) {
      read_.insert(of.text);
      if (of.text.starts_with("local") && local_sums_.read(of.text, in_growing()))
        readers_.insert(routine_);
      if (in_growing() && !indices.empty()) gets_[of.text].insert({block, offsets});
      return get(of.text, alone);
    }
    const bool adds_pairs = std::exchange(adds_pairs_, false);
    if (!in_growing()) return;
    if (adds_pairs) summed_over_pairs_.insert(of.text);
    if (const auto local = inner_locals_.find(of.text); local != inner_locals_.end())
      return change_local(of, local->second);
    if (in_pairs() && of.kind == Event::add && !indices.empty()) return sum_over_pairs(of.text);
    if (std::ssize(indices) == growing_loops()) {
      if (of.kind == Event::set || !offsets.empty()) written_[of.text].insert({block, offsets});
      return;
    }
    if (of.kind != Event::add || !offsets.empty()) throw NotLonger{"all elements meet in one"};
    if (in_pairs()) with_pairs_.insert(routine_);
    const long inside = std::ssize(loops_) - growing_loops();
    if (of.text.starts_with("local")) return local_sums_.add(of.text, in_pairs(), inside);
    sums_.insert(of.text);
  }

  // A value that is a sum over pairs may be added to another one, and enter nothing else.  What a
  // routine has from another one may be turned.
  void get(const std::string& name, bool alone) {
    if (passes_on_ && !alone) throw NotLonger{"a sum over pairs is looked into"};
    if (!summed_over_pairs_.contains(name)) return;
    if (in_pairs() || !alone || !inner_locals_.contains(name))
      throw NotLonger{"a sum over pairs is looked into"};
    adds_pairs_ = true;
  }
  // One of the innermost loop is an instance's own.
  void change_local(const CodeEvent& of, long declared) {
    if (!in_pairs() || declared == growing_loops()) return;
    if (of.kind != Event::add)
      throw NotLonger{"an instance of a loop reads what another one writes"};
    sum_over_pairs(of.text);
  }
  void sum_over_pairs(const std::string& name) {
    with_pairs_.insert(routine_);
    summed_over_pairs_.insert(name);
  }

  // The claims about all other routines take these for functions of which nothing is known: H''
  // times a vector, too, but where H is quadratic.
  std::set<std::string> functions_ = {"vector_field",       "hessian",       "gradient",
                                      "potential_gradient", "vector_fields", "forces",
                                      "generating_gradient"};
  std::vector<GrowingEvent> events_;
  Rooms rooms_;
  std::size_t at_ = 0;
  std::string routine_;
  std::map<std::string, long> radius_;
  long boundary_ = 0;
  // Of the nest of loops.
  std::vector<Loop> loops_;
  std::optional<long> lowest_, highest_;
  std::map<std::string, long> inner_locals_;  // in how many of them that grow
  std::optional<long> covers_;                // of a nest of one loop, in multiples of the size
  std::map<std::string, Places> written_, gets_;
  std::set<std::string> sums_, read_;
  LocalSums local_sums_;
  std::set<std::string> readers_;
  // Of the routine: arrays and locals that are sums over the other one of a pair.
  std::set<std::string> summed_over_pairs_;
  std::set<std::string> with_pairs_;  // routines
  bool passes_on_ = false;            // what the routine has called has given it some of them
  bool alone_ = false;                // of the value that follows a multiple is taken
  bool adds_pairs_ = false;           // ... such a sum
};

}  // namespace

long least_size(const std::array<SizedOutline, 3>& sizes) {
  try {
    return Locality(affine_events(sizes)).reach().least_size();
  } catch (const NotLonger&) {
    return 0;
  }
}

std::set<std::string> readers_of_sums(const std::array<SizedOutline, 3>& sizes) {
  return Locality(affine_events(sizes)).reach().readers_of_sums;
}

std::optional<std::string> why_not_longer(const std::array<SizedOutline, 3>& sizes) {
  try {
    const Reach reach = Locality(affine_events(sizes)).reach();
    if (reach.least_size() <= sizes[0].size) return {};
    return fmt::format("its loops reach {} elements far", reach.elements);
  } catch (const NotLonger& not_longer) {
    return not_longer.why;
  }
}

}  // namespace hamgen
