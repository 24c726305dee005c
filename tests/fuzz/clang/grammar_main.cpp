// grammar FIRST COUNT: so many texts by the grammar from this seed on (scripts/fuzz).
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

#include "tests/fuzz/check_input.hpp"
#include "tests/fuzz/grammar.hpp"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: grammar FIRST COUNT\n";
    return 2;
  }
  const auto first = std::strtoull(argv[1], nullptr, 10);
  const auto count = std::strtoull(argv[2], nullptr, 10);
  unsigned long long accepted = 0;
  unsigned long long wrong = 0;
  for (auto seed = first; seed < first + count; ++seed) {
    const std::string text = hamgen::fuzz::random_text(seed);
    try {
      if (hamgen::fuzz::check_input(text) == hamgen::fuzz::Answer::accepted) ++accepted;
    } catch (const std::exception& error) {
      ++wrong;
      std::cerr << "seed " << seed << ": " << error.what() << "\n" << text << "\n";
    }
  }
  std::cout << count << " texts, " << accepted << " accepted, " << wrong << " wrong\n";
  return wrong == 0 ? 0 : 1;
}
