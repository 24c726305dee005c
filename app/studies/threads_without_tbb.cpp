#include "app/studies/threads.hpp"

namespace hamgen::app {

bool has_threads() { return false; }

int all_threads() { return 1; }

void on_threads(int /*threads*/, const std::function<void()>& work) { work(); }

}  // namespace hamgen::app
