#!/usr/bin/env python3
"""Sets headers beside those that an earlier commit emitted, both in turn in one process.

  earlier.py EARLIER HAMGEN lanes [MODEL...]    eight trajectories in lanes beside a step of one
  earlier.py EARLIER HAMGEN stages [MODEL...]   Gauss methods by a fixed point, whose stages are in lanes

EARLIER and HAMGEN are commands `hamgen`, the first built from commit 9c0ac14 (`git worktree add
--detach DIRECTORY 9c0ac14`, and there `cmake --preset release` and `cmake --build build/release
--target hamgen`).  Times are of the processor, the least of 15 rounds (stages: 7).  Of stages each
takes the largest step of a scan by the root of 2 whose relative energy error stays below 1e-12.
"""

import pathlib
import subprocess
import sys
import tempfile

MODELS = pathlib.Path(__file__).resolve().parent.parent.parent / "hamiltonians"
FLAGS = "-std=c++20 -w -O3 -ffp-contract=off -fno-math-errno -march=native".split()

STARTS = {
    "pendulum": {"q": 3.1},
    "henon_heiles": {"q2": 0.1, "p1": 0.39581140290126},
    "kepler": {"q1": 0.4, "p2": 2},
    "product": {"q": 0.5, "p": 0.5},
    "double_pendulum": {"q1": 0.6, "q2": 0.8},
    "stiff_fpu": {"x[0]": 1, "px[0]": 1, "y[0]": 0.02, "py[0]": 1},
}
LANES = [  # model, h, method
    ("pendulum", 0.1, "stormer-verlet"),
    ("henon_heiles", 0.05, "stormer-verlet"),
    ("kepler", 0.01, "stormer-verlet"),
    ("stiff_fpu", 0.001, "stormer-verlet"),
    ("pendulum", 0.1, "implicit-midpoint"),
    ("henon_heiles", 0.05, "implicit-midpoint"),
    ("kepler", 0.01, "implicit-midpoint"),
    ("product", 0.005, "implicit-midpoint"),
    ("double_pendulum", 0.02, "implicit-midpoint"),
    ("stiff_fpu", 0.001, "implicit-midpoint"),
]
STAGES = [  # model, the largest step tried, time
    ("pendulum", 2, 100),
    ("henon_heiles", 2, 100),
    ("kepler", 0.5, 20),
    ("product", 1, 20),
    ("double_pendulum", 2, 10),
    ("stiff_fpu", 0.4, 2),
]

COMMON = """
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
namespace {
double seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}
void put(double& x, int, double value) { x = value; }
template <class Pack>
void put(Pack& x, int lane, double value) { x.set(lane, value); }
UNIT::State start(int lanes) {
  UNIT::State z;
  for (int i = 0; i < lanes; ++i) {
START  }
  return z;
}
}  // namespace
// Nanoseconds for a unit of time; `length` is that of a run.
double time_UNIT(double h, double length, long steps) {
  const long run = std::lround(std::ceil(length / h));
  long done = 0;
  const double begin = seconds();
  while (done < steps) {
    METHOD::Propagator p(UNIT::Parameters(), h, start(WIDTH));
    const auto report = p.advance(run);
    asm volatile("" ::"m"(report));
    done += run;
  }
  return (seconds() - begin) / static_cast<double>(done) / WIDTH / h * 1e9;
}
"""
ENERGY = """
double error_UNIT(double h, double length) {
  const UNIT::Parameters par;
  METHOD::Propagator p(par, h, start(1));
  const double first = UNIT::energy(par, p.state());
  const double scale = std::fabs(first) > 1e-3 ? std::fabs(first) : 1;
  double worst = 0;
  for (double t = 0; t < length; t += h) {
    if (!p.advance(1).converged) return 1;
    worst = std::max(worst, std::fabs(UNIT::energy(par, p.state()) - first) / scale);
  }
  return worst;
}
"""


def unit(directory, name, hamgen, model, options, flags=(), width=0, energy=False):
    """Compiles what measures a header."""
    earlier = name == "earlier"
    method = name if earlier else name + "::method"
    command = [hamgen, "generate", str(MODELS / f"{model}.ham"), *options, "--namespace", method]
    if width:
        command += ["--batch", str(width)]
    header = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    start = "".join(f"    put(z.{k}, i, {v} * (1 - 1e-3 * i));\n" for k, v in STARTS[model].items())
    text = COMMON + (ENERGY if energy else "")
    for word, value in (("UNIT", name), ("METHOD", method), ("START", start), ("WIDTH", str(width or 1))):
        text = text.replace(word, value)
    (directory / f"{name}.cpp").write_text(header + text)
    subprocess.run(["g++", *FLAGS, *flags, "-c", f"{name}.cpp"], cwd=directory, check=True)
    return name


def output(directory, names, body):
    declared = "".join(
        f"double time_{n}(double, double, long);\ndouble error_{n}(double, double);\n" for n in names
    )
    text = f"#include <algorithm>\n#include <cmath>\n#include <cstdio>\n{declared}int main() {{\n{body}}}\n"
    (directory / "main.cpp").write_text(text)
    objects = [f"{n}.o" for n in names]
    subprocess.run(["g++", *FLAGS, "main.cpp", *objects, "-o", "program"], cwd=directory, check=True)
    return subprocess.run(["./program"], cwd=directory, capture_output=True, text=True, check=True).stdout


def least(names, rounds, arguments):
    body = "".join(f"double least_{n} = 1e300;\n" for n in names)
    body += f"for (int i = 0; i < {rounds}; ++i) {{\n"
    body += "".join(f"least_{n} = std::min(least_{n}, time_{n}({arguments.format(name=n)}));\n" for n in names)
    return body + "}\n"


def lanes(earlier, hamgen, model, h, scheme):
    options = ["--scheme", scheme]
    with tempfile.TemporaryDirectory() as made:
        directory = pathlib.Path(made)
        names = [unit(directory, "earlier", earlier, model, options), unit(directory, "one", hamgen, model, options)]
        names.append(unit(directory, "eight", hamgen, model, options, width=8))
        names.append(unit(directory, "eight_avx2", hamgen, model, options, ["-mno-avx512f"], 8))
        names.append(unit(directory, "sixteen", hamgen, model, options, width=16))
        body = least(names, 15, f"{h}, {20000 * h}, 20000")
        body += "".join(f'std::printf(" {n} %.2f", {h} * least_{n});\n' for n in names)
        body += 'std::printf(" earlier/eight %.2f", least_earlier / least_eight);\n'
        print(f"{model}, {scheme}, h = {h}:{output(directory, names, body)}", flush=True)


def stages(earlier, hamgen, model, largest, time):
    for scheme in ("gauss-16", "gauss-8"):
        options = ["--scheme", scheme, "--solver", "fixed-point"]
        as_run = ["-fno-tree-slp-vectorize"]
        with tempfile.TemporaryDirectory() as made:
            directory = pathlib.Path(made)
            names = [unit(directory, "earlier", earlier, model, options, energy=True)]
            names.append(unit(directory, "now", hamgen, model, options, as_run, energy=True))
            body = ""
            for n in names:
                body += f"double h_{n} = {largest};\n"
                body += f"while (error_{n}(h_{n}, {time}) > 1e-12) h_{n} /= std::sqrt(2.0);\n"
            body += least(names, 7, "h_{name}, " + f"{time}, 20000")
            body += 'std::printf(" h %.3g, %.3g; ns %.0f, %.0f; earlier/now %.2f", h_earlier, h_now, '
            body += "least_earlier, least_now, least_earlier / least_now);\n"
            print(f"{model}, {scheme}:{output(directory, names, body)}", flush=True)


def main():
    if len(sys.argv) < 4 or sys.argv[3] not in ("lanes", "stages"):
        sys.exit(__doc__)
    earlier, hamgen, what, *wanted = sys.argv[1:]
    rows, measure = (LANES, lanes) if what == "lanes" else (STAGES, stages)
    for row in rows:
        if not wanted or row[0] in wanted:
            measure(earlier, hamgen, *row)


main()
