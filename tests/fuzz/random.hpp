// Numbers by chance that are the same everywhere: distributions of <random> are not.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <iterator>

namespace hamgen::fuzz {

// SplitMix64.  Source: G. L. Steele, D. Lea, C. H. Flood: Fast splittable pseudorandom number
// generators, OOPSLA 2014.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }
  // 0 .. count - 1
  int below(int count) { return static_cast<int>(next() % static_cast<std::uint64_t>(count)); }
  bool one_in(int count) { return below(count) == 0; }
  // first .. last
  int between(int first, int last) { return first + below(last - first + 1); }
  template <class T>
  T of(std::initializer_list<T> choices) {
    return *std::next(choices.begin(), below(static_cast<int>(choices.size())));
  }
  const char* of(std::initializer_list<const char*> choices) { return of<const char*>(choices); }

 private:
  std::uint64_t state_;
};

}  // namespace hamgen::fuzz
