#include "generator/verify/growth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

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

// How far a value reaches: through one loop from its lowest to its highest neighbour, and through
// one routine all its loops and what it calls.
class Locality {
 public:
  explicit Locality(const std::vector<GrowingEvent>& events) : events_(events) {}

  // Elements at either end that places without an index name, and what is around them.
  long reach() {
    while (at_ < events_.size()) step();
    check_sums();
    long most = 0;
    for (const auto& [routine, loops] : radius_) most = std::max(most, loops);
    return boundary_ + radius_["prepare"] + most;
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

  const GrowingEvent& next() { return events_[at_++]; }
  [[nodiscard]] bool grows(const std::string& index) const {
    return std::ranges::any_of(loops_,
                               [&](const Loop& loop) { return loop.grows && loop.index == index; });
  }
  [[nodiscard]] bool in_growing() const { return std::ranges::any_of(loops_, &Loop::grows); }

  // The claims about all others take these for functions of which nothing is known.
  [[nodiscard]] bool is_opaque(const std::string& called) const {
    static const std::set<std::string> functions = {"vector_field", "hessian", "gradient",
                                                    "potential_gradient"};
    return functions.contains(called) && !functions.contains(routine_);
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
    switch (of.kind) {
      case Event::routine:
        // The sums and locals of another are others.
        check_sums();
        routine_ = of.text;
        radius_[routine_];
        return;
      case Event::call:
        if (in_growing()) throw NotLonger{"a routine is called for every element"};
        if (!is_opaque(of.text)) radius_[routine_] += times() * radius_[of.text];
        return;
      case Event::shared:
        throw NotLonger{"a routine reads what it changes by another name"};
      case Event::loop:
        return begin(event);
      case Event::end:
        return end();
      case Event::local:
        if (in_growing()) inner_locals_.insert(of.text);
        return;
      case Event::index:
        return index();
      case Event::get:
      case Event::set:
      case Event::add:
        return access(of);
      case Event::element:
        static_cast<void>(element(event));
        return;
      case Event::word:
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

  void begin(const GrowingEvent& event) {
    if (!event.of.names.empty())
      throw NotLonger{"the ends of a loop move with another one's index"};
    if (!in_growing()) start_nest();
    Loop loop{.index = event.of.text};
    for (const AffineNumber& bound : event.numbers) {
      loop.grows |= bound.slope != 0;
      boundary_ = std::max(boundary_, std::abs(bound.near));
    }
    loop.last = std::abs(event.numbers.back().near);
    if (!loop.grows) loop.times = std::max(1L, loop.last - event.numbers.front().near + 1);
    loops_.push_back(std::move(loop));
  }
  void start_nest() {
    lowest_ = 0;
    highest_ = 0;
    written_.clear();
    gets_.clear();
    inner_locals_.clear();
  }
  void end() {
    loops_.pop_back();
    if (in_growing()) return;
    // What an instance writes no other one reads: else a value could travel along the loop.
    for (const auto& [name, places] : written_) {
      const auto read = gets_.find(name);
      if (read == gets_.end()) continue;
      if (places.size() != 1 || read->second != places)
        throw NotLonger{"an instance of a loop reads what another one writes"};
    }
    radius_[routine_] += times() * (highest_ - lowest_);
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
    lowest_ = std::min(lowest_, result.second);
    highest_ = std::max(highest_, result.second);
    return result;
  }
  [[nodiscard]] long last_of(const std::string& index) const {
    const auto loop = std::ranges::find(loops_, index, &Loop::index);
    return loop == loops_.end() ? 0 : loop->last;
  }

  void access(const CodeEvent& of) {
    Offsets offsets;
    std::set<std::string> indices;
    std::string blocks;  // which part of the array
    while (at_ < events_.size() && events_[at_].of.kind == Event::element) {
      const GrowingEvent& event = next();
      const auto [index, offset] = element(event);
      offsets.emplace_back(index, offset);
      if (!index.empty()) indices.insert(index);
      for (std::size_t i = 0; i < event.of.names.size(); ++i) blocks += " " + event.of.names[i];
      blocks += fmt::format(" {}", event.numbers.back().slope);
    }
    if (of.kind == Event::get) {
      read_.insert(of.text);
      if (in_growing() && !indices.empty()) gets_[of.text].insert({blocks, offsets});
      return;
    }
    if (!in_growing() || inner_locals_.contains(of.text)) return;
    const auto growing = std::ranges::count_if(loops_, &Loop::grows);
    if (std::ssize(indices) == growing) {
      if (of.kind == Event::set || !offsets.empty()) written_[of.text].insert({blocks, offsets});
      return;
    }
    if (of.kind != Event::add || !offsets.empty()) throw NotLonger{"all elements meet in one"};
    sums_.insert(of.text);
  }

  const std::vector<GrowingEvent>& events_;
  std::size_t at_ = 0;
  std::string routine_;
  std::map<std::string, long> radius_;
  long boundary_ = 0;
  // Of the nest of loops.
  std::vector<Loop> loops_;
  long lowest_ = 0;
  long highest_ = 0;
  std::set<std::string> inner_locals_;
  std::map<std::string, std::set<std::pair<std::string, Offsets>>> written_, gets_;
  std::set<std::string> sums_, read_;
};

}  // namespace

std::optional<std::string> why_not_longer(const std::array<SizedOutline, 3>& sizes) {
  try {
    const std::vector<GrowingEvent> events = affine_events(sizes);
    // Two ends and what lies between.
    const long reach = Locality(events).reach();
    if (2 * reach + 1 > sizes[0].size) return fmt::format("its loops reach {} elements far", reach);
    return {};
  } catch (const NotLonger& not_longer) {
    return not_longer.why;
  }
}

}  // namespace hamgen
