// Formal series of a composed step: noncommutative power series, truncated by weight.
//
// A step exp(X) exp(Y) ... of flows X, Y, ... is a series in words; so is the flow it approximates.
// The order is the weight up to which all words agree, and the words that do not agree first are
// the leading error.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace hamgen {

struct Letter {
  char name = 'A';
  int weight = 1;  // power of h
};

[[nodiscard]] inline int weight_of(const std::string& word, const std::vector<Letter>& letters) {
  int weight = 0;
  for (const char c : word) {
    for (const Letter& letter : letters) {
      if (letter.name == c) weight += letter.weight;
    }
  }
  return weight;
}

// All words up to a weight, the empty one first, by weight and then in the alphabet's order.
[[nodiscard]] inline std::vector<std::string> words_up_to(const std::vector<Letter>& letters,
                                                          int weight) {
  std::vector<std::vector<std::string>> by_weight{{""}};
  std::vector<std::string> all{""};
  for (int w = 1; w <= weight; ++w) {
    auto& now = by_weight.emplace_back();
    for (const Letter& letter : letters) {
      if (letter.weight > w) continue;
      for (const std::string& rest : by_weight[static_cast<std::size_t>(w - letter.weight)]) {
        now.push_back(letter.name + rest);
      }
    }
    all.insert(all.end(), now.begin(), now.end());
  }
  return all;
}

template <class Number>
using Series = std::map<std::string, Number>;

// a b, on the words given.
template <class Number>
[[nodiscard]] Series<Number> product(const Series<Number>& a, const Series<Number>& b,
                                     const std::vector<std::string>& words) {
  Series<Number> result;
  for (const std::string& word : words) {
    for (std::size_t cut = 0; cut <= word.size(); ++cut) {
      const auto left = a.find(word.substr(0, cut));
      const auto right = b.find(word.substr(cut));
      if (left == a.end() || right == b.end()) continue;
      const Number term = left->second * right->second;
      const auto [it, fresh] = result.try_emplace(word, term);
      if (!fresh) it->second = it->second + term;
    }
  }
  return result;
}

// Modulo [B, [B, [B, A]]] = 0, which holds if A is the flow of a quadratic T(p) and B that of V(q):
// BBBA becomes 3 BBAB - 3 BABB + ABBB until no word holds it.  Its overlaps with itself are
// trivial, so that the result does not depend on the order.
template <class Number>
[[nodiscard]] Series<Number> without_bbba(Series<Number> series, const Number& three) {
  Series<Number> result;
  auto add = [](Series<Number>& to, const std::string& word, const Number& value) {
    const auto [it, fresh] = to.try_emplace(word, value);
    if (!fresh) it->second = it->second + value;
  };
  while (!series.empty()) {
    const auto first = series.begin();
    const std::string word = first->first;
    const Number value = first->second;
    series.erase(first);
    const std::size_t at = word.find("BBBA");
    if (at == std::string::npos) {
      add(result, word, value);
      continue;
    }
    auto with = [&](const char* middle) {
      return word.substr(0, at) + middle + word.substr(at + 4);
    };
    add(series, with("BBAB"), three * value);
    add(series, with("BABB"), -(three * value));
    add(series, with("ABBB"), value);
  }
  return result;
}

// Smaller than all its rotations: the coefficients of these words determine those of all others in
// a Lie series.
[[nodiscard]] inline bool is_lyndon(const std::string& word) {
  for (std::size_t i = 1; i < word.size(); ++i) {
    if (word.substr(i) + word.substr(0, i) <= word) return false;
  }
  return true;
}

}  // namespace hamgen
