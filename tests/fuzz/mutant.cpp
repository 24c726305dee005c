#include "tests/fuzz/mutant.hpp"

#include <algorithm>

namespace hamgen::fuzz {
namespace {

constexpr int kMostOfSpan = 40;

class Mutation {
 public:
  Mutation(const std::vector<std::string>& texts, const std::vector<std::string>& words,
           Random& random)
      : texts_(texts), words_(words), random_(random) {}

  std::string changed(std::string text) {
    const std::size_t at = place(text);
    const auto length = static_cast<std::size_t>(random_.between(1, kMostOfSpan));
    switch (random_.below(5)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random_.below(256));
        return text;
      case 1:
        return text.erase(at, length);
      case 2:
        return text.insert(place(text), text.substr(at, length));
      case 3:
        return text.insert(at, one_of(words_));
      default: {
        const std::string& other = one_of(texts_);
        return text.replace(at, std::string::npos, other.substr(place(other)));
      }
    }
  }

 private:
  const std::string& one_of(const std::vector<std::string>& list) {
    return list[static_cast<std::size_t>(random_.below(static_cast<int>(list.size())))];
  }
  // The end is a place, too.
  std::size_t place(const std::string& text) {
    return static_cast<std::size_t>(random_.below(static_cast<int>(text.size()) + 1));
  }

  const std::vector<std::string>& texts_;
  const std::vector<std::string>& words_;
  Random& random_;
};

}  // namespace

std::string mutant(const std::vector<std::string>& texts, const std::vector<std::string>& words,
                   Random& random) {
  std::string text = texts[static_cast<std::size_t>(random.below(static_cast<int>(texts.size())))];
  Mutation mutation(texts, words, random);
  for (int changes = random.between(1, 4); changes > 0; --changes) {
    text = mutation.changed(std::move(text));
  }
  return text;
}

}  // namespace hamgen::fuzz
