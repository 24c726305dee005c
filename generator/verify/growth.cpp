#include "generator/verify/growth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace hamgen {

namespace {

using Event = CodeEvent::Kind;

// near + slope * size
struct AffineNumber {
  long near = 0;
  long slope = 0;
};
struct GrowingEvent {
  const CodeEvent& of;
  std::vector<AffineNumber> numbers;
};

bool is_same(const CodeEvent& a, const CodeEvent& b) {
  return a.kind == b.kind && a.text == b.text && a.names == b.names &&
         a.numbers.size() == b.numbers.size();
}

// Not local, and why.
struct NotLonger {
  std::string why;
};

std::vector<GrowingEvent> affine_events(const std::array<SizedOutline, 3>& sizes) {
  const auto& [a, b, c] = sizes;
  if (a.events.size() != b.events.size() || a.events.size() != c.events.size())
    throw NotLonger{"its routines have other instructions"};
  std::vector<GrowingEvent> merged;
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    const CodeEvent& event = a.events[i];
    if (!is_same(event, b.events[i]) || !is_same(event, c.events[i]))
      throw NotLonger{"its routines have other instructions"};
    GrowingEvent growing{event, {}};
    for (std::size_t j = 0; j < event.numbers.size(); ++j) {
      const long first = event.numbers[j];
      const long slope = (b.events[i].numbers[j] - first) / (b.size - a.size);
      const AffineNumber number{first - slope * a.size, slope};
      const auto at = [&](long size) { return number.near + slope * size; };
      if (b.events[i].numbers[j] != at(b.size) || c.events[i].numbers[j] != at(c.size))
        throw NotLonger{"its places are not affine in the size"};
      growing.numbers.push_back(number);
    }
    merged.push_back(std::move(growing));
  }
  return merged;
}

// How far values reach, and whether there are sums over pairs.
struct Reach {
  long elements = 0;
  bool pairs = false;
  // Two ends and what lies between; with pairs, two elements that are at no end and next to each
  // other, and on either side of them one that is far from both.
  [[nodiscard]] long least_size() const { return pairs ? 4 * elements + 4 : 2 * elements + 1; }
};

// How far a value reaches: through one loop from its lowest to its highest neighbour, and through
// one routine all its loops and what it calls.
class Locality {
 public:
  explicit Locality(const std::vector<GrowingEvent>& events) : events_(events) {}

  // Elements at either end that places without an index name, and what is around them.
  Reach reach() {
    while (at_ < events_.size()) step();
    check_sums();
    long most = 0;
    for (const auto& [routine, loops] : radius_) most = std::max(most, loops);
    return {boundary_ + radius_["prepare"] + most, !with_pairs_.empty()};
  }

 private:
  struct Loop {
    std::string index;
    bool grows = false;
    long times = 1;  // of one that does not
    long last = 0;
  };
  // An element in a nest of loops: by dimension the growing index, and what is added to it.
  using Offsets = std::vector<std::pair<std::string, long>>;
  // Which part of its array it is in: the indices that choose it, and by dimension where it begins,
  // in multiples of the size.
  struct Block {
    std::string indices;
    std::vector<long> begins;
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

  // The claims about all others take these for functions of which nothing is known.
  static bool is_function(const std::string& routine) {
    static const std::set<std::string> functions = {"vector_field", "hessian", "gradient",
                                                    "potential_gradient", "generating_gradient"};
    return functions.contains(routine);
  }
  [[nodiscard]] bool is_opaque(const std::string& called) const {
    return is_function(called) && !is_function(routine_);
  }
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
        return;
      case Event::index:
        return index();
      case Event::get:
      case Event::set:
      case Event::add:
        return access(of, alone);
      case Event::element:
        static_cast<void>(element(event));
        return;
      case Event::word:
        alone_ = of.text == kAlone;
        return;
    }
  }

  void check_sums() {
    for (const std::string& name : sums_) {
      if (read_.contains(name)) throw NotLonger{"a sum over all elements enters a loop"};
    }
    std::erase_if(sums_, [](const std::string& name) { return name.starts_with("local"); });
    std::erase_if(read_, [](const std::string& name) { return name.starts_with("local"); });
  }

  void call(const std::string& called) {
    if (in_growing()) throw NotLonger{"a routine is called for every element"};
    if (is_opaque(called)) return;
    if (with_pairs_.contains(called) && called != "differentiate") {
      if (!is_function(routine_)) throw NotLonger{"a sum over pairs is looked into"};
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
    Loop loop{.index = event.of.text, .grows = moves};
    for (const AffineNumber& bound : event.numbers) {
      loop.grows |= bound.slope != 0;
      boundary_ = std::max(boundary_, std::abs(bound.near));
    }
    loop.last = std::abs(event.numbers.back().near);
    if (!loop.grows) loop.times = std::max(1L, loop.last - event.numbers.front().near + 1);
    if (loop.grows) covers_ = growing_loops() == 0 && !moves ? covered(event) : std::nullopt;
    if (loop.grows && in_pairs()) throw NotLonger{"a sum runs over more than pairs"};
    loops_.push_back(std::move(loop));
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
      if (there != place || other.begins.size() != 1 || other.indices != block.indices)
        return false;
      begins.insert(other.begins.front());
    }
    const auto meet = [this](long a, long b) { return !covers_ || b - a < *covers_; };
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

  // In one dimension the growing index, if there is one, and what is added to it.  Other indices
  // may choose a block, whose length grows with the size, or an element near an end.
  std::pair<std::string, long> element(const GrowingEvent& event) {
    std::pair<std::string, long> result{"", event.numbers.back().near};
    long furthest = std::abs(result.second);
    for (std::size_t i = 0; i < event.of.names.size(); ++i) {
      const std::string& name = event.of.names[i];
      const auto& [near, slope] = event.numbers[i];
      if (!grows(name)) {
        furthest += std::abs(near) * last_of(name);
        continue;
      }
      if (!result.first.empty() || slope != 0 || near != 1)
        throw NotLonger{"neighbours in its loops do not have neighbouring places"};
      result.first = name;
    }
    if (result.first.empty()) {
      boundary_ = std::max(boundary_, furthest);
      return result;
    }
    if (furthest != std::abs(result.second))
      throw NotLonger{"neighbours in its loops do not have neighbouring places"};
    lowest_ = std::min(lowest_.value_or(result.second), result.second);
    highest_ = std::max(highest_.value_or(result.second), result.second);
    return result;
  }
  [[nodiscard]] long last_of(const std::string& index) const {
    const auto loop = std::ranges::find(loops_, index, &Loop::index);
    return loop == loops_.end() ? 0 : loop->last;
  }

  void access(const CodeEvent& of, bool alone) {
    Offsets offsets;
    std::set<std::string> indices;
    Block block;
    while (at_ < events_.size() && events_[at_].of.kind == Event::element) {
      const GrowingEvent& event = next();
      const auto [index, offset] = element(event);
      offsets.emplace_back(index, offset);
      if (!index.empty()) indices.insert(index);
      for (const std::string& name : event.of.names) block.indices += " " + name;
      block.indices += ",";
      block.begins.push_back(event.numbers.back().slope);
    }
    if (of.kind == Event::get) {
      read_.insert(of.text);
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

  const std::vector<GrowingEvent>& events_;
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
  // Of the routine: arrays and locals that are sums over the other one of a pair.
  std::set<std::string> summed_over_pairs_;
  std::set<std::string> with_pairs_;  // routines
  bool passes_on_ = false;            // what the routine has called has given it some of them
  bool alone_ = false;                // of the value that follows a multiple is taken
  bool adds_pairs_ = false;           // ... such a sum
};

}  // namespace

std::optional<std::string> why_not_longer(const std::array<SizedOutline, 3>& sizes) {
  try {
    const std::vector<GrowingEvent> events = affine_events(sizes);
    const Reach reach = Locality(events).reach();
    if (reach.least_size() > sizes[0].size)
      return fmt::format("its loops reach {} elements far", reach.elements);
    return {};
  } catch (const NotLonger& not_longer) {
    return not_longer.why;
  }
}

}  // namespace hamgen
