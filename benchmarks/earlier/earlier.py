#!/usr/bin/env python3
"""Sets headers beside those that an earlier commit emitted, both in turn in one process.

  earlier.py EARLIER HAMGEN lanes [MODEL...]    eight trajectories in lanes beside a step of one
  earlier.py EARLIER HAMGEN stages [MODEL...]   Gauss methods by a fixed point, whose stages are in lanes
  earlier.py EARLIER HAMGEN stages-portable [MODEL...]   the same without the machine's own instructions
  earlier.py EARLIER HAMGEN goal [MODEL...]     the best method for an energy error of 1e-12

EARLIER and HAMGEN are commands `hamgen`, the first built from commit 9c0ac14 (`git worktree add
--detach DIRECTORY 9c0ac14`, and there `cmake --preset release` and `cmake --build build/release
--target hamgen`).  Times are of the processor, the least of 15 rounds (stages and goal: 7).  Of stages
and goal each takes the largest step of a scan by the root of 2 whose relative energy error stays below
1e-12.  In goal, the earlier header has the flags that its `hamgen run` had, without the machine's own
instructions, and the new one those of today's.
"""

import json
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

MODELS = pathlib.Path(__file__).resolve().parent.parent.parent / "hamiltonians"
PORTABLE = "-std=c++20 -w -O3 -ffp-contract=off -fno-math-errno".split()
FLAGS = [*PORTABLE, "-march=native"]
# As `hamgen run` compiles: Gauss methods of one trajectory, what else is written out, and loops.
STAGES_ALONE = [*FLAGS, "-fno-tree-slp-vectorize", "-mno-fma"]
LOOPS = [*FLAGS, "-mno-fma", "-mno-avx512vl"]
ALONE = [*LOOPS, "-mprefer-vector-width=128"]

STARTS = {
    "pendulum": {"q": 3.1},
    "henon_heiles": {"q2": 0.1, "p1": 0.39581140290126},
    "kepler": {"q1": 0.4, "p2": 2},
    "product": {"q": 0.5, "p": 0.5},
    "double_pendulum": {"q1": 0.6, "q2": 0.8},
    "stiff_fpu": {"x[0]": 1, "px[0]": 1, "y[0]": 0.02, "py[0]": 1},
    "fput": {"q[499]": 1},
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
    ("outer_solar_system", 1600, 20000),
]
GOAL = [  # model, the largest step tried, time, of the earlier time at most: alone, in eight lanes
    ("pendulum", 8, 1024, 0.7, 0.19),
    ("henon_heiles", 4, 1024, 0.5, 0.17),
    ("kepler", 0.5, 655, 0.43, 0.12),
    ("double_pendulum", 2, 205, 0.28, None),
    ("fput", 4, 102, 0.2, None),
]
SIZES = {"fput": ["--set", "N=1000"]}
CANDIDATES = {
    "order 10": ["--order", "10"],
    "gauss-16": ["--scheme", "gauss-16", "--solver", "fixed-point"],
    "blanes-moan-rkn-6": ["--scheme", "blanes-moan-rkn-6"],
    "sofroniou-10-verlet": ["--scheme", "sofroniou-spaletta-10-verlet"],
    "kahan-li-8-verlet": ["--scheme", "kahan-li-8-verlet"],
}
NOT_FOR = {  # not separable, or too many unknowns
    "double_pendulum": ["order 10", "blanes-moan-rkn-6", "sofroniou-10-verlet", "kahan-li-8-verlet"],
    "fput": ["order 10", "gauss-16"],
}

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
  const double scale = std::fabs(first) > 1e-12 ? std::fabs(first) : 1;
  double worst = 0;
  for (double t = 0; t < length; t += h) {
    if (!p.advance(1).converged) return 1;
    worst = std::max(worst, std::fabs(UNIT::energy(par, p.state()) - first) / scale);
  }
  return worst;
}
"""


def start_of(model, hamgen, header):
    """Of the planets, where the first step of their scene takes them."""
    if model in STARTS:
        return STARTS[model]
    command = [hamgen, "run", str(MODELS / f"{model}.ham"), "--steps", "1", "--json", "--quiet"]
    state = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)["state"]
    in_loops = "Real q[18]" in header
    parts = ("q", "p") if in_loops else ("x", "y", "z", "px", "py", "pz")
    names = [f"{part}[{i}]" for part in parts for i in range(36 // len(parts))]
    return dict(zip(names, state["q"] + state["p"], strict=True))


def unit(directory, name, hamgen, model, options, flags=FLAGS, width=0, energy=False, change=None):
    """Compiles what measures a header."""
    earlier = name.startswith("earlier")
    method = name if earlier else name + "::method"
    command = [hamgen, "generate", str(MODELS / f"{model}.ham"), *options, "--namespace", method]
    if width:
        command += ["--batch", str(width)]
    header = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    if change:
        header = change(header)
    start = "".join(f"    put(z.{k}, i, {v} * (1 - 1e-3 * i));\n" for k, v in start_of(model, hamgen, header).items())
    text = COMMON + (ENERGY if energy else "")
    for word, value in (("UNIT", name), ("METHOD", method), ("START", start), ("WIDTH", str(width or 1))):
        text = text.replace(word, value)
    (directory / f"{name}.cpp").write_text(header + text)
    subprocess.run(["g++", *flags, "-c", f"{name}.cpp"], cwd=directory, check=True)
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


def largest_steps(names, largest, time):
    """Where none down to a 2000th meets the error, 0."""
    return "".join(f"""double h_{n} = {largest};
while (h_{n} > 0 && error_{n}(h_{n}, {time}) > 1e-12) h_{n} = h_{n} > {largest} / 2000 ? h_{n} / std::sqrt(2.0) : 0;
""" for n in names)


def goal(earlier, hamgen, model, largest, time, alone, in_lanes):
    methods = {name: words + SIZES.get(model, []) for name, words in CANDIDATES.items()
               if name not in NOT_FOR.get(model, [])}
    with tempfile.TemporaryDirectory() as made:
        directory = pathlib.Path(made)
        steps = 2000 if model in SIZES else 20000
        body = ""
        units = []
        for place, (name, words) in enumerate(methods.items()):
            flags = STAGES_ALONE if "gauss" in name else LOOPS if model in SIZES else ALONE
            units.append((unit(directory, f"earlier_{place}", earlier, model, words, PORTABLE, energy=True), name))
            units.append((unit(directory, f"now_{place}", hamgen, model, words, flags, energy=True), name))
        names = [name for name, _ in units]
        body += largest_steps(names, largest, time)
        if in_lanes:
            for place, (name, words) in enumerate(methods.items()):
                units.append((unit(directory, f"eight_{place}", hamgen, model, words, FLAGS, 8), name))
                body += f"const double h_eight_{place} = h_now_{place};\n"
        names = [name for name, _ in units]
        body += "".join(f"double least_{n} = 1e300;\n" for n in names)
        body += "for (int i = 0; i < 7; ++i) {\n"
        for n in names:
            body += f"  if (h_{n} > 0) least_{n} = std::min(least_{n}, time_{n}(h_{n}, {time}, {steps}));\n"
        body += "}\n"
        for n, method in units:
            body += f'if (h_{n} > 0) std::printf("{n.split("_")[0]};{method};%.3g;%.5g\\n", h_{n}, least_{n});\n'
        rows = [line.split(";") for line in output(directory, names, body).split("\n") if line]
        best = {}
        for who, method, h, ns in rows:
            if who not in best or float(ns) < best[who][2]:
                best[who] = (method, float(h), float(ns))
        print(f"{model}:", "; ".join(f"{who} {method}, h = {h}, {ns:.4g} ns"
                                     for who, (method, h, ns) in best.items()))
        for who in ("earlier", "now"):
            print("  all", who + ":", ", ".join(f"{m} {float(ns):.4g}" for w, m, h, ns in rows if w == who))
        print(f"  of the earlier: alone {best['now'][2] / best['earlier'][2]:.2f} (aim {alone})", end="")
        if in_lanes:
            print(f", in eight lanes {best['eight'][2] / best['earlier'][2]:.2f} (aim {in_lanes})", end="")
        print(flush=True)


def lanes(earlier, hamgen, model, h, scheme):
    options = ["--scheme", scheme]
    with tempfile.TemporaryDirectory() as made:
        directory = pathlib.Path(made)
        names = [unit(directory, "earlier", earlier, model, options), unit(directory, "one", hamgen, model, options)]
        names.append(unit(directory, "eight", hamgen, model, options, width=8))
        names.append(unit(directory, "eight_avx2", hamgen, model, options, [*FLAGS, "-mno-avx512f"], 8))
        names.append(unit(directory, "sixteen", hamgen, model, options, width=16))
        body = least(names, 15, f"{h}, {20000 * h}, 20000")
        body += "".join(f'std::printf(" {n} %.2f", {h} * least_{n});\n' for n in names)
        body += 'std::printf(" earlier/eight %.2f", least_earlier / least_eight);\n'
        print(f"{model}, {scheme}, h = {h}:{output(directory, names, body)}", flush=True)


def unrefined(header):
    """No such header is emitted: what it costs to solve for what rounded stages lack."""
    waits = "const bool waits = open > epsilon * epsilon * begun;"
    if waits not in header:
        sys.exit("what Refinement waits for has been written otherwise: change `unrefined`")
    # In a namespace of its own: the linker takes one of functions of the same name.
    return re.sub(r"\bhamgen_(?=[0-9a-f]{8})", "unrefined_", header).replace(waits, "const bool waits = false;")


def stages(earlier, hamgen, model, largest, time, flags=FLAGS):
    ratios = {}
    for scheme in ("gauss-16", "gauss-8"):
        options = ["--scheme", scheme, "--solver", "fixed-point"]
        as_run = [*flags, "-fno-tree-slp-vectorize"]
        with tempfile.TemporaryDirectory() as made:
            directory = pathlib.Path(made)
            names = [unit(directory, "earlier", earlier, model, options, flags, energy=True)]
            names.append(unit(directory, "now", hamgen, model, options, as_run, energy=True))
            body = largest_steps(names, largest, time)
            names.append(unit(directory, "unrefined", hamgen, model, options, as_run, change=unrefined))
            body += "const double h_unrefined = h_now;\n"
            body += least(names, 7, "h_{name}, " + f"{time}, 20000")
            body += 'std::printf("%g %g %.0f %.0f %.4f %.4f", h_earlier, h_now, least_earlier, least_now, '
            body += "least_earlier / least_now, least_earlier / least_unrefined);\n"
            words = output(directory, names, body).split()
            ratios[scheme] = float(words[4]), float(words[5])
            print(f"{model}, {scheme}: h {words[0]}, {words[1]}; ns {words[2]}, {words[3]}; earlier/now {ratios[scheme][0]:.2f}, "
                  f"without refinement {ratios[scheme][1]:.2f}", flush=True)
    return max(each[0] for each in ratios.values()), max(each[1] for each in ratios.values())


def stages_portable(earlier, hamgen, model, largest, time):
    return stages(earlier, hamgen, model, largest, time, PORTABLE)


def main():
    parts = {"lanes": (LANES, lanes), "stages": (STAGES, stages), "goal": (GOAL, goal),
             "stages-portable": (STAGES, stages_portable)}
    if len(sys.argv) < 4 or sys.argv[3] not in parts:
        sys.exit(__doc__)
    earlier, hamgen, what, *wanted = sys.argv[1:]
    rows, measure = parts[what]
    found = [measure(earlier, hamgen, *row) for row in rows if not wanted or row[0] in wanted]
    if what.startswith("stages"):
        now, bound = (statistics.geometric_mean(column) for column in zip(*found))
        print(f"geometric mean of the better of the two: {now:.2f}, without refinement {bound:.2f}")


main()
