#include "app/dispatch.hpp"
#include "app/studies/crew.hpp"

int main(int argc, char** argv) {
  hamgen::app::SingleCrew alone;
  return hamgen::app::dispatch(std::vector<std::string>(argv + 1, argv + argc), alone);
}
