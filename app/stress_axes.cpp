#include "app/stress_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

constexpr long kMostCells = 100'000;

// "k=1:1e6:7" or "h=1e-4:1e3"; h counts in units of the scene's.
StressAxis axis_of(const std::string& text) {
  const auto [name, range] = split_assignment("--vary", text);
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= range.size();) {
    const std::size_t end = std::min(range.find(':', begin), range.size());
    parts.push_back(range.substr(begin, end - begin));
    begin = end + 1;
  }
  const std::string option = "--vary " + text;
  if (parts.size() < 2 || parts.size() > 3)
    throw UsageError(
        fmt::format("{}: not a range\nhelp: write --vary {}=LOW:HIGH or "
                    "--vary {}=LOW:HIGH:COUNT",
                    option, name, name));
  const double low = to_double(constant_option(option, parts[0]));
  const double high = to_double(constant_option(option, parts[1]));
  if (!(low < high)) throw UsageError(fmt::format("{}: the range is empty", option));
  if (name == "h" && !(low > 0.0))
    throw UsageError(fmt::format("{}: a step is more than 0 times the scene's", option));
  StressAxis axis{.label = name, .logarithmic = low > 0.0 && high / low >= 20.0};
  const double span = axis.logarithmic ? std::log10(high / low) : high - low;
  const long count = parts.size() == 3  ? integer_value(option, parts[2], 2)
                     : axis.logarithmic ? std::lround(4.0 * span) + 1
                                        : 21;
  if (count > 1000)
    throw UsageError(fmt::format("{}: more than 1000 values\nhelp: a smaller COUNT", option));
  for (long i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(count - 1);
    axis.values.push_back(i == 0             ? low
                          : i + 1 == count   ? high
                          : axis.logarithmic ? low * std::pow(10.0, part * span)
                                             : low + part * span);
  }
  return axis;
}

bool mentions_word(const std::string& text, const std::string& word) {
  const auto is_letter = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  };
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += word.size()) {
    const bool begins = at == 0 || !is_letter(text[at - 1]);
    const std::size_t end = at + word.size();
    if (begins && (end == text.size() || !is_letter(text[end]))) return true;
  }
  return false;
}

}  // namespace

std::vector<StressAxis> read_axes(const std::vector<std::string>& vary) {
  std::vector<StressAxis> axes;
  for (const std::string& text : listed("--vary", vary)) axes.push_back(axis_of(text));
  const bool has_h = std::ranges::any_of(axes, [](const auto& axis) { return axis.label == "h"; });
  if (axes.size() < 2 && !has_h) axes.insert(axes.begin(), axis_of("h=1e-4:1e3"));
  if (axes.size() > 2)
    throw UsageError("--vary: a map has two axes\nhelp: fix the others with --set, --h, --beta");
  if (axes.size() == 2 && axes[0].label == axes[1].label)
    throw UsageError(fmt::format("--vary {}: given twice", axes[0].label));
  const auto cells =
      static_cast<long>(axes[0].values.size() * (axes.size() > 1 ? axes[1].values.size() : 1));
  if (cells > kMostCells)
    throw UsageError(fmt::format("--vary: {} cells; at most {} can be run", cells, kMostCells));
  return axes;
}

MethodOptions with_run_time_members(MethodOptions method, const std::vector<StressAxis>& axes) {
  const std::string texts = method.alpha + "," + method.beta + "," + method.gamma;
  for (const auto& [name, value] :
       {std::pair{"alpha", &method.alpha}, std::pair{"beta", &method.beta},
        std::pair{"gamma", &method.gamma}}) {
    const bool varied = std::ranges::any_of(
        axes, [name = std::string(name)](const auto& axis) { return axis.label == name; });
    if (!varied || mentions_word(texts, name)) continue;
    if (!method.scheme.empty())
      throw UsageError(
          fmt::format("--vary {}: of a member of the family, and --scheme {} is another method\n"
                      "help: leave one out",
                      name, method.scheme));
    if (!value->empty())
      throw UsageError(
          fmt::format("--vary {0} and --{0} {1}: both choose {0}\nhelp: leave one out, "
                      "or use {0} in the expression",
                      name, *value));
    *value = name;
  }
  return method;
}

}  // namespace hamgen::app
