#include "app/dispatch.hpp"
#include "app/studies/crew.hpp"
#include "app/whole_program.hpp"

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
#ifdef HAMGEN_WHOLE
  if (hamgen::app::needs_whole_program(words)) {
    return hamgen::app::hand_over_to(HAMGEN_WHOLE, argv);
  }
#endif
  hamgen::app::SingleCrew alone;
  return hamgen::app::dispatch(words, alone);
}
