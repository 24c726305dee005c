// A progress bar for a terminal.
#pragma once

#include <string>
#include <string_view>

#include "runtime/trajectory.hpp"

namespace hamgen::runtime {

// "pendulum  [=======>        ]  45 %  1.2e+07 steps/s  0:42 left", cut to `width` columns; with
// colour the bar is green.
[[nodiscard]] std::string progress_line(std::string_view label, const Progress& progress, int width,
                                        bool colour);

// "0:42", "3:05:00".
[[nodiscard]] std::string duration_text(double seconds);

// Is standard error a terminal that can move its cursor?
[[nodiscard]] bool is_watched();

// Draws on standard error if that is a terminal that can move its cursor, otherwise does nothing.
// The line is removed at the end.  No colour if NO_COLOR is set.
class ProgressBar {
 public:
  explicit ProgressBar(std::string label, int descriptor = 2);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();

  void update(const Progress& progress);
  void remove();

  [[nodiscard]] bool is_visible() const { return visible_; }

 private:
  [[nodiscard]] int width() const;
  void draw(std::string_view text) const;

  std::string label_;
  int descriptor_;
  bool visible_;
  bool colour_;
  bool drawn_ = false;
};

}  // namespace hamgen::runtime
