#include "tests/fuzz/grammar.hpp"

#include <fmt/format.h>

#include <vector>

#include "tests/fuzz/random.hpp"

namespace hamgen::fuzz {
namespace {

class Writer {
 public:
  explicit Writer(std::uint64_t seed) : random_(seed) {}

  std::string text() {
    if (random_.one_in(8)) return option();
    std::string result;
    if (random_.one_in(2)) result += "system " + any_name() + end();
    declare_sizes(result);
    declare_variables(result);
    for (int i = random_.below(4); i > 0; --i) result += parameter();
    for (int i = random_.below(3); i > 0; --i) result += definition();
    result += "H = " + expression(random_.between(1, 6)) + end();
    for (int i = random_.below(3); i > 0; --i) {
      result += fmt::format("invariant A{} = {}", i, expression(3)) + end();
    }
    for (int i = random_.below(3); i > 0; --i) result += scene(i);
    return random_.one_in(6) ? damaged(result) : result;
  }

 private:
  std::string option() {
    const std::string option = random_.of({"--alpha", "--beta", "--gamma", "--h", "--steps"});
    scalars_ = {"h", "E0", "w"};
    arrays_ = {"m"};
    if (random_.one_in(2)) return option + " " + expression(random_.between(0, 4));
    return fmt::format("{} {}={}", random_.of({"--set", "--initial", "--reference"}),
                       random_.of({"w", "q", "m", "x[2]", "m[i]", "x[i]", "N", "h", "z"}),
                       random_.one_in(3) ? list() : expression(random_.between(0, 3)));
  }

  void declare_sizes(std::string& text) {
    if (random_.one_in(2)) return;
    text += fmt::format(
        "size N = {}", random_.one_in(16) ? random_.of({"1", "12", "0", "-1", "2*2", "1e3"}) : "3");
    text += end();
    sizes_ = true;
  }

  std::string range() {
    if (random_.one_in(16)) return random_.of({"[0..2]", "[2..2]", "[-1..1]", "[3..1]", "[0..N]"});
    return sizes_ && !random_.one_in(3) ? "[1..N]" : "[1..3]";
  }

  std::string unit() {
    return random_.one_in(4) ? random_.of({" [m]", " [kg m^2/s]", " [rad]", " [1/s]"}) : "";
  }

  std::string beyond(const std::string& name) {
    if (random_.one_in(2)) return " periodic";
    if (random_.one_in(3)) return fmt::format(" with {0}[0] = 0, {0}[4] = {1}", name, number());
    return random_.one_in(6) ? fmt::format(" with {}[4] = 1/2", name) : "";
  }

  void declare_variables(std::string& text) {
    for (int i = random_.between(1, 3); i > 0; --i) {
      const std::string q = fmt::format("q{}", i);
      const std::string p = fmt::format("p{}", i);
      if (random_.one_in(2)) {
        const std::string r = range();
        text += "coordinate " + q + r + unit() + beyond(q) + end();
        text += "momentum " + p + r + unit() + end();
        arrays_.insert(arrays_.end(), {q, p});
      } else {
        text += "coordinate " + q + unit() + end() + "momentum " + p + unit() + end();
        scalars_.insert(scalars_.end(), {q, p});
      }
    }
    if (random_.one_in(6)) {
      text += "time t" + end();
      scalars_.emplace_back("t");
    }
  }

  std::string parameter() {
    const std::string name = fmt::format("{}{}", random_.of({"w", "eps", "I", "double"}), count_++);
    if (random_.one_in(3)) {
      const std::string r = range();
      arrays_.push_back(name);
      return "parameter " + name + r + " = " + (random_.one_in(2) ? number() : list()) + unit() +
             end();
    }
    const std::string text = "parameter " + name + " = " + constant() + unit() + end();
    scalars_.push_back(name);
    return text;
  }

  std::string definition() {
    const std::string name = fmt::format("d{}", count_++);
    const std::string text = "let " + name + " = " + expression(3) + end();
    scalars_.push_back(name);
    return text;
  }

  std::string scene(int i) {
    std::string text = fmt::format("scene s{} {{{}", i, random_.one_in(2) ? end() : " ");
    for (int k = random_.below(5); k > 0; --k) {
      text += setting() + (random_.one_in(2) ? "; " : "\n");
    }
    if (random_.one_in(2)) text += "h = " + constant() + "; ";
    if (random_.one_in(2)) text += "steps = " + (random_.one_in(16) ? constant() : "10*2") + "; ";
    if (random_.one_in(4)) text += "every = 10; ";
    if (random_.one_in(4)) text += random_.of({"observe energy; ", "observe A1; "});
    return text + "}\n";
  }

  std::string setting() {
    if (!arrays_.empty() && random_.one_in(2)) {
      const std::string& name = arrays_[pick(arrays_.size())];
      if (random_.one_in(3)) return name + " = " + list();
      if (random_.one_in(3)) return name + "[i] = " + constant() + "*i";
      return name + random_.of({"", "[1]", "[2]", "[i]", "[7]"}) + " = " + constant();
    }
    const std::string name = any_name();
    return (name.starts_with("d") ? "q1" : name) + " = " + constant();
  }

  std::string end() {
    if (random_.one_in(8)) {
      return random_.of({"  # a comment\n", " # \xCE\xB1 // */ \"\\\n", "\n\n", "\r\n", " #\n"});
    }
    return "\n";
  }

  std::string any_name() {
    if (random_.one_in(100)) {
      return random_.of({"h", "H", "pi", "sum", "sin", "Q", "E0", "p_t", "linux", "q1", "i"});
    }
    return scalars_.empty() ? "pi" : scalars_[pick(scalars_.size())];
  }
  std::size_t pick(std::size_t count) {
    return static_cast<std::size_t>(random_.below(static_cast<int>(count)));
  }

  std::string number() {
    if (random_.one_in(200)) return random_.of({"1e400", "1e-400", "1e999999999"});
    if (random_.one_in(10)) {
      return random_.of({"1e-3", ".5", "0", "1e308", "4.9e-324", "123456789012345678",
                         "0.1000000000000000055511151231257827", "00012", "1e22"});
    }
    return random_.of({"1", "2", "3", "0.1", "1/3", "10", "0.25", "1000", "-1", "-0.5"});
  }

  std::string constant() {
    if (random_.one_in(2)) return number();
    if (random_.one_in(5)) return random_.of({"pi", "sqrt(2)", "2*pi/3", "exp(1)"});
    if (random_.one_in(40)) return random_.of({"N", "i", "log(-1)", "1/0"});
    return fmt::format("{}{}{}", number(), random_.of({"*", "+", "-", "/", "^"}), number());
  }

  std::string list() {
    std::string text = "[" + constant();
    const int count = random_.one_in(16) ? random_.below(5) : 2;
    for (int i = count; i > 0; --i) text += ", " + constant();
    return text + "]";
  }

  std::string subscript() {
    const std::string index = indices_.empty() ? "1" : indices_[pick(indices_.size())];
    if (random_.one_in(100)) return random_.of({"q[1]", "0.5", "N", "q1", "2^70"});
    if (!random_.one_in(4)) return index;
    return random_.of({index + "+1", index + "-1", std::string("2"), "4-" + index});
  }

  std::string atom() {
    switch (random_.below(6)) {
      case 0:
        return number();
      case 1:
        if (!indices_.empty()) return indices_[pick(indices_.size())];
        return "pi";
      case 2:
      case 3:
        if (!arrays_.empty()) return arrays_[pick(arrays_.size())] + "[" + subscript() + "]";
        [[fallthrough]];
      default:
        return any_name();
    }
  }

  std::string sum(int depth) {
    std::string text = "sum(";
    const std::size_t before = indices_.size();
    for (int i = random_.between(1, 2); i > 0; --i) {
      const std::string index =
          fmt::format("{}{}", "ijk"[indices_.size() % 3], indices_.size() < 3 ? "" : "1");
      const std::string lower =
          indices_.size() == before || random_.one_in(2) ? "1" : indices_.back() + "+1";
      const std::string upper =
          random_.one_in(16) ? random_.of({"N", "2*N", "0", "300"}) : random_.of({"3", "2"});
      text += fmt::format("{} = {}..{}, ", index, lower, upper);
      indices_.push_back(index);
    }
    text += expression(depth - 1) + ")";
    indices_.resize(before);
    return text;
  }

  std::string call(int depth) {
    const std::string name =
        random_.of({"abs", "acos", "acosh", "asin", "asinh", "atan", "atanh", "cos", "cosh", "exp",
                    "expm1", "log", "log1p", "sin", "sinh", "sqrt", "tan", "tanh"});
    if (random_.one_in(16)) {
      return fmt::format("atan2({}, {})", expression(depth - 1), expression(depth - 1));
    }
    if (random_.one_in(30)) return name + "()";
    return name + "(" + expression(depth - 1) + ")";
  }

  std::string exponent(int depth) {
    if (random_.one_in(4)) return expression(depth - 1);
    return random_.one_in(40) ? "1001"
                              : random_.of({"2", "3", "-1", "(1/2)", "(-3/2)", "4", "2^3"});
  }

  std::string expression(int depth) {
    if (depth <= 0) return atom();
    switch (random_.below(10)) {
      case 0:
        return "-" + expression(depth - 1);
      case 1:
        return sum(depth);
      case 2:
        return call(depth);
      case 3:
        return expression(depth - 1) + "^" + exponent(depth);
      case 4:
        return "(" + expression(depth - 1) + (random_.one_in(8) ? "\n  )" : ")");
      case 5:
        return atom();
      default:
        return expression(depth - 1) + random_.of({" + ", " - ", "*", "/", " * ", "+", "-"}) +
               expression(depth - 1);
    }
  }

  // One place with a word left out, twice, or another in its place.
  std::string damaged(std::string text) {
    const std::size_t at = pick(text.size());
    const std::size_t length = std::min(text.size() - at, pick(6) + 1);
    const std::string part = text.substr(at, length);
    switch (random_.below(3)) {
      case 0:
        return text.erase(at, length);
      case 1:
        return text.insert(at, part);
      default:
        return text.replace(at, length,
                            random_.of({"(",
                                        ")",
                                        "[",
                                        "]",
                                        "{",
                                        "}",
                                        "..",
                                        ",",
                                        ";",
                                        "=",
                                        "^^",
                                        "\r",
                                        "\xE2\x80\xA8",
                                        "\xC2\x85",
                                        "\xFF",
                                        "sum(",
                                        "let ",
                                        "\xE2\x80\xAE",
                                        "# ",
                                        "1e",
                                        "9^9^9",
                                        "\n"}));
    }
  }

  Random random_;
  bool sizes_ = false;
  int count_ = 0;
  std::vector<std::string> scalars_, arrays_, indices_;
};

}  // namespace

std::string random_text(std::uint64_t seed) { return Writer(seed).text(); }

}  // namespace hamgen::fuzz
