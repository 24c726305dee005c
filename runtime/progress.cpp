#include "runtime/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace hamgen::runtime {
namespace {

constexpr std::string_view kGreen = "\x1b[32m";
constexpr std::string_view kNormal = "\x1b[0m";
constexpr std::string_view kErase = "\r\x1b[K";

bool is_set(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr && value[0] != '\0';
}

bool can_draw(int descriptor) {
  const char* const terminal = std::getenv("TERM");
  return ::isatty(descriptor) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

}  // namespace

bool is_watched() { return can_draw(STDERR_FILENO); }

std::string duration_text(double seconds) {
  if (!(seconds < 1e9)) return "?";
  const auto whole = static_cast<long long>(std::ceil(seconds));
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string progress_line(std::string_view label, const Progress& progress, int width,
                          bool colour) {
  const double done = static_cast<double>(progress.steps_done);
  const double all = static_cast<double>(progress.steps);
  const double fraction = all > 0.0 ? std::clamp(done / all, 0.0, 1.0) : 1.0;
  const double rate = progress.seconds > 0.0 ? done / progress.seconds : 0.0;
  const std::string left = rate > 0.0 ? duration_text((all - done) / rate) : "?";
  const std::string head = fmt::format("{}  ", label);
  const std::string tail =
      fmt::format("  {:3.0f} %{}  {} left", std::floor(100.0 * fraction),
                  progress.show_rate ? fmt::format("  {:.3g} steps/s", rate) : std::string(), left);
  const long long room =
      width - static_cast<long long>(head.size()) - static_cast<long long>(tail.size()) - 2;
  if (room < 5) {
    return (head + tail.substr(2)).substr(0, static_cast<std::size_t>(std::max(width, 0)));
  }
  const auto cells = static_cast<std::size_t>(std::min(room, 40LL));
  const auto filled = static_cast<std::size_t>(fraction * static_cast<double>(cells));
  std::string bar(filled, '=');
  if (filled < cells) bar += '>';
  bar.resize(cells, ' ');
  return colour ? fmt::format("{}[{}{}{}]{}", head, kGreen, bar, kNormal, tail)
                : fmt::format("{}[{}]{}", head, bar, tail);
}

ProgressBar::ProgressBar(std::string label, int descriptor)
    : label_(std::move(label)),
      descriptor_(descriptor),
      visible_(can_draw(descriptor)),
      colour_(!is_set("NO_COLOR")) {}

ProgressBar::~ProgressBar() { remove(); }

int ProgressBar::width() const {
  winsize size{};
  // One column less: a full line would wrap on some terminals.
  if (::ioctl(descriptor_, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col - 1;
  return 79;
}

void ProgressBar::draw(std::string_view text) const {
  // A terminal that has gone away is no reason to stop the integration.
  [[maybe_unused]] const ssize_t written = ::write(descriptor_, text.data(), text.size());
}

void ProgressBar::update(const Progress& progress) {
  if (!visible_) return;
  draw(fmt::format("{}{}", kErase, progress_line(label_, progress, width(), colour_)));
  drawn_ = true;
}

void ProgressBar::remove() {
  if (drawn_) draw(kErase);
  drawn_ = false;
}

}  // namespace hamgen::runtime
