#include "app/tune_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>

#include "app/interrupt.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

// Applies `function` to 0 .. count-1 on all processors; the caller's thread looks on.
void for_all_cells(std::size_t count, const std::function<void(std::size_t)>& function,
                   const std::function<void(std::size_t)>& on_progress) {
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> done{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t i = next++; i < count && !interrupt_flag(); i = next++) {
      try {
        function(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
      ++done;
    }
  };
  {
    std::vector<std::jthread> threads;
    const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
    for (unsigned i = 0; i < processors; ++i) threads.emplace_back(work);
    while (done < count && next < count && !interrupt_flag()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      on_progress(done);
    }
  }
  if (failure) std::rethrow_exception(failure);
  on_progress(done);
}

std::string gnuplot_text(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

}  // namespace

EnergyMap energy_map(const GaugedIntegrator& integrator, const MapAxis& b, const MapAxis& c,
                     double h, long steps, const std::function<void(std::size_t)>& on_progress) {
  const auto width = static_cast<std::size_t>(b.count);
  const std::size_t cells = width * static_cast<std::size_t>(c.count);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  EnergyMap map{.b = b, .c = c, .spread = std::vector<double>(cells, kNone)};
  for_all_cells(
      cells,
      [&](std::size_t i) {
        const std::vector<double> pair = {b.at(static_cast<int>(i % width)),
                                          c.at(static_cast<int>(i / width))};
        const Measurement measured = integrator.measure(pair, h, steps);
        if (measured.failure.empty()) map.spread[i] = measured.energy_spread;
      },
      [&](std::size_t done) {
        map.done = done;
        on_progress(done);
      });
  return map;
}

std::string map_csv(const EnergyMap& map, const std::string& header) {
  std::string text = header + "b,c,energy_spread\n";
  std::size_t i = 0;
  for (int row = 0; row < map.c.count; ++row) {
    for (int column = 0; column < map.b.count; ++column, ++i) {
      const std::string spread =
          std::isfinite(map.spread[i]) ? runtime::number_text(map.spread[i]) : "";
      text += fmt::format("{},{},{}\n", runtime::number_text(map.b.at(column)),
                          runtime::number_text(map.c.at(row)), spread);
    }
  }
  return text;
}

std::string map_script(const EnergyMap& map, const std::string& title, const std::string& output) {
  const bool svg = output.ends_with(".svg");
  std::string text = fmt::format(
      "# Drawn by: gnuplot THIS_FILE\n"
      "set terminal {} enhanced font 'Sans,11' background rgb 'white'\n"
      "set output {}\n"
      "set title {} noenhanced\n"
      "set xlabel 'b, {{/Symbol b}} = b h'\nset ylabel 'c, {{/Symbol g}} = c h'\n"
      "set cblabel 'max H - min H'\nset logscale cb\nset format cb '10^{{%T}}'\n"
      "set palette defined (0 '#440154', 1 '#3B528B', 2 '#21918C', 3 '#5EC962', 4 '#FDE725')\n"
      "set tics out nomirror\n"
      "set xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]\n",
      svg ? "svg size 640,480" : "pngcairo size 1280,960 fontscale 1.7", gnuplot_text(output),
      gnuplot_text(title), map.b.at(0), map.b.at(map.b.count - 1), map.c.at(0),
      map.c.at(map.c.count - 1));
  text += "$map << EOD\n";
  std::size_t i = 0;
  for (int row = 0; row < map.c.count; ++row) {
    for (int column = 0; column < map.b.count; ++column, ++i) {
      const bool shown = std::isfinite(map.spread[i]) && map.spread[i] > 0.0;
      text += fmt::format("{:.9g} {:.9g} {}\n", map.b.at(column), map.c.at(row),
                          shown ? fmt::format("{:.9g}", map.spread[i]) : "NaN");
    }
    text += "\n";
  }
  return text + "EOD\nplot $map using 1:2:3 with image notitle\nunset output\n";
}

}  // namespace hamgen::app
