#include "app/dispatch.hpp"

int main(int argc, char** argv) {
  return hamgen::app::dispatch(std::vector<std::string>(argv + 1, argv + argc));
}
