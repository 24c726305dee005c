// Named quantities in their order.  Elements of an array that follow each other are kept as one, so
// that a million of them take no more room than one.
#pragma once

#include <compare>
#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

#include "generator/algebra/exact.hpp"

namespace hamgen {

// A name of the user's with what is said of it in the emitted code.
struct Quantity {
  std::string name;  // "eps", "m[2]"
  std::string unit;
  std::string comment;
  Rational value;  // default of a parameter
};

class QuantityList {
 public:
  // Elements that follow each other, or a single quantity.
  struct Run {
    Quantity of;  // under the name of the array
    bool indexed = false;
    long first = 0;         // index
    std::size_t begin = 0;  // in the list
    std::size_t count = 1;
  };

  QuantityList() = default;
  explicit QuantityList(const std::vector<Quantity>& quantities) {
    for (const Quantity& each : quantities) push_back(each);
  }

  // All elements share what is said of the array.
  void append(Quantity array, long first, long count);
  void push_back(Quantity quantity);
  void clear() { runs_.clear(); }

  [[nodiscard]] std::size_t size() const {
    return runs_.empty() ? 0 : runs_.back().begin + runs_.back().count;
  }
  [[nodiscard]] bool empty() const { return runs_.empty(); }
  [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }
  // Which element of its array, by its own index.
  [[nodiscard]] long element(std::size_t i) const;
  [[nodiscard]] std::vector<Quantity> elements() const { return {begin(), end()}; }
  [[nodiscard]] std::string name(std::size_t i) const;
  [[nodiscard]] Quantity operator[](std::size_t i) const;
  [[nodiscard]] Quantity back() const { return (*this)[size() - 1]; }

  class Iterator {
   public:
    using iterator_concept = std::random_access_iterator_tag;
    using iterator_category = std::input_iterator_tag;
    using value_type = Quantity;
    using difference_type = std::ptrdiff_t;
    using reference = Quantity;
    using pointer = void;

    Iterator() = default;
    Iterator(const QuantityList& list, std::size_t at) : list_(&list), at_(at) {}
    Quantity operator*() const { return (*list_)[at_]; }
    Quantity operator[](difference_type n) const { return *(*this + n); }
    Iterator& operator+=(difference_type n) {
      at_ = static_cast<std::size_t>(static_cast<difference_type>(at_) + n);
      return *this;
    }
    Iterator& operator-=(difference_type n) { return *this += -n; }
    Iterator& operator++() { return *this += 1; }
    Iterator& operator--() { return *this += -1; }
    Iterator operator++(int) {
      Iterator before = *this;
      ++*this;
      return before;
    }
    Iterator operator--(int) {
      Iterator before = *this;
      --*this;
      return before;
    }
    friend Iterator operator+(Iterator it, difference_type n) { return it += n; }
    friend Iterator operator+(difference_type n, Iterator it) { return it += n; }
    friend Iterator operator-(Iterator it, difference_type n) { return it -= n; }
    friend difference_type operator-(const Iterator& a, const Iterator& b) {
      return static_cast<difference_type>(a.at_) - static_cast<difference_type>(b.at_);
    }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.at_ == b.at_; }
    friend std::strong_ordering operator<=>(const Iterator& a, const Iterator& b) {
      return a.at_ <=> b.at_;
    }

   private:
    const QuantityList* list_ = nullptr;
    std::size_t at_ = 0;
  };
  [[nodiscard]] Iterator begin() const { return {*this, 0}; }
  [[nodiscard]] Iterator end() const { return {*this, size()}; }

 private:
  [[nodiscard]] const Run& run_of(std::size_t i) const;

  std::vector<Run> runs_;
};

// What they are called, whatever their values.
[[nodiscard]] QuantityList names_of(const std::vector<Quantity>& quantities);

}  // namespace hamgen
