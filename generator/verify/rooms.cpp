#include "generator/verify/rooms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "generator/algebra/exact.hpp"

namespace hamgen {

namespace {

using Event = CodeEvent::Kind;

std::string key_of(const std::string& routine, const std::string& array, std::size_t dimension) {
  return fmt::format("{} {} {}", routine, array, dimension);
}
std::string with_field(const std::string& object, const std::string& field) {
  if (field.empty()) return object;
  return object.ends_with('.') ? object + field : object + "." + field;
}
// What is left of the array's name behind that of the object; none if it is no array of it.
std::optional<std::string> field_of(const std::string& array, const std::string& object) {
  if (array == object) return "";
  const std::string begin = object.ends_with('.') ? object : object + ".";
  if (!array.starts_with(begin)) return {};
  return array.substr(begin.size());
}

// Numbers known up to a factor: which are multiples of which.
class Ratios {
 public:
  void add(const std::string& a, const Rational& times, const std::string& b) {
    edges_[a].emplace_back(b, 1 / times);
    edges_[b].emplace_back(a, times);
  }
  [[nodiscard]] bool contains(const std::string& name) const { return edges_.contains(name); }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> list;
    for (const auto& [name, edges] : edges_) list.push_back(name);
    return list;
  }
  // All that hang together with it, where it is 1.
  [[nodiscard]] std::map<std::string, Rational> around(const std::string& name) const {
    std::map<std::string, Rational> values = {{name, Rational(1)}};
    std::vector<std::string> next = {name};
    while (!next.empty()) {
      const std::string at = std::move(next.back());
      next.pop_back();
      for (const auto& [other, times] : edges_.at(at)) {
        const Rational value = values.at(at) * times;
        const auto [known, is_new] = values.try_emplace(other, value);
        if (is_new) next.push_back(other);
        if (known->second != value)
          throw NotLonger{"neighbours in its loops do not have neighbouring places"};
      }
    }
    return values;
  }

 private:
  std::map<std::string, std::vector<std::pair<std::string, Rational>>> edges_;
};

const std::string kLoop = "loop ";

// What the events say of the numbers of arrays and loops.
class Relations {
 public:
  explicit Relations(const std::vector<GrowingEvent>& events) {
    for (const GrowingEvent& event : events) read(event);
    end_list();
    hand_over();
    join();
    relate();
  }
  [[nodiscard]] const Ratios& ratios() const { return ratios_; }

 private:
  struct OfCall {
    std::string caller;
    std::vector<std::string> given;
    std::string callee;
  };

  void read(const GrowingEvent& event) {
    const CodeEvent& of = event.of;
    if (of.kind == Event::element) return element(event);
    dimension_ = 0;
    array_.clear();
    const bool continues = of.kind == Event::word && !of.names.empty();
    if (!continues && of.kind != Event::word) end_list();
    switch (of.kind) {
      case Event::routine:
        routine_ = of.text;
        loops_.clear();
        break;
      case Event::call:
        call_ = OfCall{routine_, {}, of.text};
        break;
      case Event::loop:
        loops_.emplace_back(of.text, grows(event) ? fmt::format("{}{}", kLoop, ++count_) : "");
        break;
      case Event::end:
        loops_.pop_back();
        break;
      case Event::get:
      case Event::set:
      case Event::add:
        array_ = of.text;
        break;
      case Event::word:
        if (continues) word(of);
        break;
      default:
        break;
    }
  }
  void word(const CodeEvent& of) {
    if (of.text == "given") {
      if (call_) call_->given.push_back(of.names.front());
    } else if (of.text.starts_with("argument")) {
      arguments_[routine_].push_back(of.names.front());
    } else if (of.text.starts_with("copy")) {
      beside_.push_back({routine_, of.names[0] + ".", routine_, of.names[1] + "."});
    } else if (of.text == "solve") {
      end_list();  // of the one before
      list_ = of.names;
      square_.emplace_back(routine_, of.names.front());
    } else if (of.text == "refinement") {
      end_list();
      list_ = {with_field(of.names.front(), "slope"), with_field(of.names.front(), "change")};
    } else if (of.text == "for" || of.text == "at" || of.text == "lack" || of.text == "gradient") {
      list_.push_back(of.names.front());
    }
  }
  // Of a call, a linear system or a refinement.
  void end_list() {
    if (call_) calls_.push_back(*std::exchange(call_, std::nullopt));
    for (const std::string& array : list_) {
      if (array != list_.front()) beside_.push_back({routine_, list_.front(), routine_, array});
    }
    list_.clear();
  }
  void element(const GrowingEvent& event) {
    const std::size_t dimension = dimension_++;
    if (array_.empty()) return;
    const std::string key = key_of(routine_, array_, dimension);
    arrays_[routine_].insert({array_, dimension});
    for (std::size_t i = 0; i < event.of.names.size(); ++i) {
      const auto loop =
          std::ranges::find(loops_, event.of.names[i], &std::pair<std::string, std::string>::first);
      if (loop == loops_.end() || loop->second.empty()) continue;
      const auto& [near, slope] = event.numbers[i];
      if (near <= 0 || slope != 0)
        throw NotLonger{"neighbours in its loops do not have neighbouring places"};
      ratios_.add(key, Rational(near), loop->second);
    }
  }

  // All arrays of one object, or itself, beside those of another.
  struct Beside {
    std::string routine, object, other_routine, other;
  };
  void hand_over() {
    for (const auto& [caller, given, callee] : calls_) {
      const std::vector<std::string>& arguments = arguments_[callee];
      for (std::size_t i = 0; i < std::min(given.size(), arguments.size()); ++i)
        beside_.push_back({callee, arguments[i] + ".", caller, given[i]});
    }
  }
  // What one routine only hands on to another it has, too.
  void join() {
    for (bool is_new = true; is_new;) {
      is_new = false;
      for (const auto& [routine, object, other_routine, other] : beside_) {
        is_new |= join(routine, object, other_routine, other);
        is_new |= join(other_routine, other, routine, object);
      }
    }
  }
  bool join(const std::string& routine, const std::string& object, const std::string& other_routine,
            const std::string& other) {
    bool is_new = false;
    const Arrays arrays = arrays_[routine];
    for (const auto& [array, dimension] : arrays) {
      const std::optional<std::string> field = field_of(array, object);
      if (!field) continue;
      const std::string name = with_field(other, *field);
      if (!arrays_[other_routine].insert({name, dimension}).second) continue;
      is_new = true;
    }
    return is_new;
  }
  void relate() {
    for (const auto& [routine, object, other_routine, other] : beside_) {
      for (const auto& [array, dimension] : arrays_[routine]) {
        const std::optional<std::string> field = field_of(array, object);
        if (!field) continue;
        ratios_.add(key_of(routine, array, dimension), Rational(1),
                    key_of(other_routine, with_field(other, *field), dimension));
      }
    }
    for (const auto& [routine, matrix] : square_)
      ratios_.add(key_of(routine, matrix, 0), Rational(1), key_of(routine, matrix, 1));
  }

  using Arrays = std::set<std::pair<std::string, std::size_t>>;  // and a dimension
  Ratios ratios_;
  std::string routine_, array_;
  std::size_t dimension_ = 0;
  std::vector<std::pair<std::string, std::string>> loops_;  // index and number; none if it is fixed
  long count_ = 0;
  std::optional<OfCall> call_;
  std::vector<std::string> list_;
  std::map<std::string, Arrays> arrays_;
  std::map<std::string, std::vector<std::string>> arguments_;
  std::vector<OfCall> calls_;
  std::vector<Beside> beside_;
  std::vector<std::pair<std::string, std::string>> square_;
};

}  // namespace

Rooms::Rooms(const std::vector<GrowingEvent>& events) {
  const Relations relations(events);
  std::set<std::string> done;
  for (const std::string& name : relations.ratios().names()) {
    if (done.contains(name)) continue;
    const std::map<std::string, Rational> values = relations.ratios().around(name);
    std::optional<Rational> one;  // of the loop that goes from element to element
    for (const auto& [each, value] : values) {
      done.insert(each);
      if (each.starts_with(kLoop) && (!one || value < *one)) one = value;
    }
    for (const auto& [each, value] : values) {
      if (each.starts_with(kLoop) || !one) continue;
      const Rational room = value / *one;
      if (room.get_den() != 1)
        throw NotLonger{"neighbours in its loops do not have neighbouring places"};
      rooms_[each] = room.get_num().get_si();
    }
  }
}

long Rooms::of(const std::string& routine, const std::string& array, std::size_t dimension) const {
  const auto room = rooms_.find(key_of(routine, array, dimension));
  return room == rooms_.end() ? 1 : room->second;
}

bool grows(const GrowingEvent& loop) {
  return loop.of.names.size() > 1 ||
         std::ranges::any_of(loop.numbers, [](const AffineNumber& n) { return n.slope != 0; });
}

}  // namespace hamgen
