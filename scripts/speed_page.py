"""What scripts/speed writes, from what the benchmarks printed: docs/speed.md, its words included, the table of README.md
and those of benchmarks/."""

import json
import re
import textwrap

import benchmark_tables
from kept_output import KEPT, ROOT, digits, kept, listed, table

def span(values, form="{:.1f}"):
    low, high = form.format(min(values)), form.format(max(values))
    return low if low == high else f"{low} to {high}"


def by_steps():
    """Of step_benchmark's summary: problem, then (method, ns, energy spread)."""
    problems = {}
    name = None
    for line in kept("step").split("CPU time per step")[1].splitlines():
        head = re.match(r"(\w+) +ns/step", line)
        row = re.match(r"  (\S.*?) {2,}([\d.]+) +(\S+) +(\S+) +(\S+)$", line)
        if head:
            name = head.group(1)
        elif row and name:
            problems.setdefault(name, []).append((row[1], float(row[2]), float(row[3])))
    return problems


def step_section():
    text = ["""## A step

The implicit midpoint rule at h = 0.1, by the header that `generate` writes, by hand for the problem (the same
compensated sums and solved to round-off, with tuned constants where emitted code measures, and without a report of
failures), and by GSL with gradient and Jacobian by hand. GSL's "step 2h" takes the same trajectory as midpoint steps
of h; its time is per h. odeint's method is another one, explicit and of order 4.
"""]
    said = []
    rows = []
    for problem, methods in by_steps().items():
        own = next(ns for name, ns, _ in methods if name == "hamgen")
        hand = next(ns for name, ns, _ in methods if name == "hand-written")
        said.append(f"{own / hand:.2f} times on {problem}")
        for name, ns, spread in methods:
            rows.append([problem, name, digits(ns), f"{ns / own:.2f}", f"{spread:.1e}"])
    text.append(table(["problem", "step", "ns", "of hamgen's", "energy spread in 1e5 steps"], rows))
    return "\n".join(text), f"The hand-written midpoint step is faster than the emitted one: by {listed(said)}."


def by_rows():
    """Of cost_benchmark: name, solver, {who: (ns, what is said of it)}."""
    rows = []
    for line in kept("larger").splitlines():
        row = re.match(r"  (\S.*?) +([\d.]+) ns/step(?:   hamgen / this [\d.]+)?(?:   (.*))?$", line)
        if row:
            rows[-1][2][row[1]] = float(row[2]), row[3] or ""
        elif ": " in line:
            name, solver = line.split(": ", 1)
            rows.append((name, solver, {}))
    return rows


def larger_section():
    text = ["""## Steps of one method

Steps as `hamgen run` compiles them, in nanoseconds. *By hand*: for an implicit step a fixed point from an extrapolated
start with as few iterations as somebody chose who looked at the result, without compensated sums and report; how far
such steps are from the solutions of their equations stands beside, at most, of the largest element. Where that is more
than rounding the same step is also there with as many iterations as solve them. Stormer-Verlet by hand has compensated
sums. *GSL*: `rk2imp` at twice the step, the same trajectory, with a Jacobian by differences (left out where its dense
matrix is larger than 300). *odeint*: for implicit steps `symplectic_rkn_sb3a_mclachlan` at the same step, another method,
explicit and of order 4, where H is separable; for Stormer-Verlet its `velocity_verlet`, the same method without compensated
sums, where all masses are 1: hamgen's with `--plain-sums` stands beside it. The libraries' derivatives are by hand, inlined. All have the machine's own instructions. Of
pendulum, Henon-Heiles and Kepler the step by hand is Newton's with compensated sums (`hand_written.hpp`). Steps are those
of the scenes: 0.1, 0.05, 0.01, product and double pendulum 0.01, chains 0.05.
"""]
    rows, slower, faster = [], [], []
    for name, _, times in by_rows():
        if "hamgen" not in times:
            rows.append([name, "refused", *[""] * 8])
            continue
        own = times["hamgen"][0]
        hand, solved = times.get("hand-written"), times.get("hand-written, solved")
        gsl = times.get("GSL rk2imp 2h")
        odeint = next((value for who, value in times.items() if who.startswith("odeint")), None)
        lack = re.search(r"solved to (\S+)", hand[1]) if hand else None
        plain = times.get("hamgen --plain-sums")
        rows.append([name, digits(own), digits(plain[0]) if plain else "", digits(hand[0]) if hand else "", lack[1] if lack else "",
                     digits(solved[0]) if solved else "", digits(gsl[0]) if gsl else "",
                     digits(odeint[0]) if odeint else "", f"{own / hand[0]:.2f}" if hand else "",
                     f"{own / solved[0]:.2f}" if solved else ""])
        if solved or hand:
            ratio = own / (solved or hand)[0]
            (slower if ratio > 1 else faster).append((ratio, name))
    text.append(table(["step", "hamgen", "plain sums", "by hand", "lacks", "by hand, solved", "GSL", "odeint", "hamgen / by hand",
                       "hamgen / solved"], rows))
    said = ""
    if slower:
        said = "Steps by hand that solve their equations are faster, by so many times: " + "; ".join(
            f"{name}: {ratio:.1f}" for ratio, name in sorted(slower, reverse=True)) + "."
    if faster:
        said += " The emitted one is the faster: " + "; ".join(
            f"{name}: {1 / ratio:.2f}" for ratio, name in sorted(faster)) + "."
    return "\n".join(text), [said.strip(), faster_odeint()]


def faster_odeint():
    parts = []
    for name, _, times in by_rows():
        odeint = next(((who, value[0]) for who, value in times.items() if who.startswith("odeint")), None)
        own = times.get("hamgen --plain-sums", times.get("hamgen"))
        if odeint and own and odeint[1] < own[0]:
            parts.append(f"{name}: {odeint[0]} {own[0] / odeint[1]:.1f}")
    return ("Steps of odeint at the same h, sb3a another method and velocity_verlet beside Stormer-Verlet with plain "
            "sums, as it has, are faster by so many times: " + "; ".join(parts) + ".") if parts else ""


LIBRARIES = ("odeint", "GSL")


def by_targets():
    """Of peers_benchmark: (model, scene, T, targets, {error: {method: [time or None]}})."""
    cases = []
    error = None
    for line in kept("peers").splitlines():
        head = re.match(r"\S*?(\w+)\.ham, scene (.+), T = (\S+);", line)
        title = re.match(r"  us/unit, (\w+) error +(.*)", line)
        row = re.match(r"  (\S.*?) {2,}((?:(?:[\d.e+-]+|-|no peer|no hamgen) *)+)$", line)
        if head:
            cases.append((head[1], head[2], head[3], [], {}))
            error = None
        elif title:
            error = title[1]
            cases[-1][3][:] = [float(word) for word in title[2].split()]
            cases[-1][4][error] = {}
        elif row and error and not line.startswith("  best peer"):
            cases[-1][4][error][row[1]] = [None if word == "-" else float(word)
                                           for word in row[2].split()]
    return cases


def best(methods, place, of_library):
    found = [(times[place], name) for name, times in methods.items()
             if name.startswith(LIBRARIES) == of_library and times[place] is not None and name != "rk4"]
    return min(found) if found else None


def power(target):
    return f"{target:.0e}".replace("e-0", "e-")


def peers_section():
    text = ["""## Time for an error

hamgen's methods, those that `hamgen bench` takes by itself but for rk4, which conserves nothing, explicit ones also with
`--plain-sums`, as the libraries' are, beside Boost.odeint's and GSL's on the same models, in microseconds for a unit of
the model's time. The libraries have derivatives written by hand, inlined, and arrays of a size that the compiler knows;
`rk2imp` gets a Jacobian by differences. Errors are against the reference in quad precision, those of the energy relative
to its scale. These runs are short, from one revolution to some dozens: the errors of the libraries' energies grow with
the time, those of symplectic methods do not. Where H is not separable each of these methods solves equations, and the
libraries' only evaluate gradients; and a method that chooses its step takes long ones away from a pericentre, for which
a constant step pays all along the orbit.
"""]
    said = []
    for error, what in (("state", "of the state at its end"), ("energy", "of the energy on the way")):
        wins, losses = [], []
        rows = []
        for model, scene, end, targets, errors in by_targets():
            methods = errors[error]
            lost = {}
            for place, target in enumerate(targets):
                own, other = best(methods, place, False), best(methods, place, True)
                if not own and not other:
                    continue
                ratio = other[0] / own[0] if own and other else None
                rows.append([f"{model}, {scene}, T = {end}", power(target),
                             f"{own[1]}: {digits(own[0])}" if own else "none",
                             f"{other[1]}: {digits(other[0])}" if other else "none",
                             f"{ratio:.2f}" if ratio else ""])
                if ratio and 0.98 <= ratio <= 1.02:  # as fast
                    continue
                if ratio and ratio < 1:
                    lost[target] = (1 / ratio, other[1])
                elif ratio:
                    wins.append((ratio, model))
                elif other:
                    lost[target] = (None, other[1])
            if lost:
                names = sorted({name for _, name in lost.values()})
                ratios = [r for r, _ in lost.values() if r]
                losses.append(f"on {model} at {listed([power(t) for t in lost])} {listed(names)}"
                              + (f", by {span(ratios, '{:.2f}')} times" if ratios else ""))
        text.append(f"Error {what}:\n\n" + table(
            ["run", "error", "best of hamgen", "best of the libraries", "libraries / hamgen"], rows))
        won = sorted({model for _, model in wins})
        said.append(f"To an error {what}, a library is faster: " + "; ".join(losses) + "." if losses else
                    f"To an error {what}, no library is faster than the best of hamgen's methods.")
        if won:
            said[-1] += (f" At the other errors hamgen's best is faster, by "
                         f"{span([r for r, _ in wins], '{:.2f}')} times (on {listed(won)}).")
    said.append(goals())
    return "\n".join(text), said


def goals():
    """Where it was aimed at: eight problems, an energy error of 1e-12 and a state error of 1e-9."""
    parts = []
    for model, _, _, targets, errors in by_targets():
        ratios = []
        for error, target in (("energy", 1e-12), ("state", 1e-9)):
            place = targets.index(target)
            own, other = best(errors[error], place, False), best(errors[error], place, True)
            ratios.append("no library" if own and not other else
                          f"{other[0] / own[0]:.2f}" if own else "not reached")
        parts.append(f"{model} {ratios[0]}; {ratios[1]}" if ratios[0] != ratios[1] else f"{model} {ratios[0]}")
    return ("Time of the best library over that of hamgen's best, to an energy error of 1e-12 and to a state error "
            "of 1e-9: " + " / ".join(parts) + ".")


def batch_section():
    lines = kept("batch").splitlines()
    widths = re.findall(r"one|W = \d+", lines[0])
    rows, gains, of_stages = [], [], []
    eight = widths.index("W = 8")
    for line in lines[1:]:
        name, *cells = re.split(r" {2,}", line.strip())
        ns = [float(cell) for cell in " ".join(cells).split()]
        gain = ns[0] / ns[eight]
        (of_stages if "gauss" in name else gains).append(gain)
        rows.append([name, *[digits(value) for value in ns], f"{gain:.1f}"])
    text = """## Batches

Nanoseconds per trajectory and step of headers made with `--batch W`, beside the header of one trajectory, compiled
with `-march=native`; how they are used: [in lanes](batch.md).

""" + table(["model, method", *widths, "one / (W = 8)"], rows)
    said = f"Eight trajectories in lanes take, each, {span(gains)} times less than one alone."
    if of_stages:
        said += f" By Gauss collocation, where one alone has its stages in lanes, it is {span(of_stages)} times."
    slow = [row[0] for row in rows if float(row[2]) > 1.1 * float(row[1])]
    if slow:
        said += f" A batch of one is slower than the header of one trajectory for {len(slow)} of {len(rows)} rows."
    return text, said


def lanes_section():
    rows, faster, narrow = [], {"four": [], "eight": []}, 0
    for line in kept("lanes").splitlines()[2:]:
        name, *cells = line.split()
        rows.append([name, *cells])
        library, _, four, eight = (float(cell) for cell in cells)
        for width, time in (("four", four), ("eight", eight)):
            if library < time:
                faster[width].append(name)
        narrow += four < eight
    text = """## Elementary functions

Nanoseconds per value: the library's, and those on lanes that a batch computes with, `-march=native`.

""" + table(["function", "library", "1 lane", "4 lanes", "8 lanes"], rows)
    said = " ".join(f"The library's {listed(names)} {'is' if len(names) == 1 else 'are'} faster than {width} lanes."
                    for width, names in faster.items() if names)
    said = said or "Every elementary function on four or eight lanes is faster than the library's."
    if narrow:
        said += f" Of {len(rows)} functions, {narrow} take longer on eight lanes than on four here."
    return text, said


def scaling_section():
    rows = json.loads(kept("scaling"))
    columns = list(dict.fromkeys(row["scheme"] for row in rows))
    sizes = sorted({row["N"] for row in rows})
    cells = {(row["scheme"], row["N"]): min(row["ns"]) / row["N"] for row in rows}
    first = {(row["scheme"], row["N"]): row["first"] for row in rows}
    text = """## Scaling in N

A step of the chain of Fermi, Pasta, Ulam and Tsingou (`hamiltonians/fput.ham`, scene pluck) by `hamgen run --set N=...`:
nanoseconds per particle, the least of five rounds, and the seconds of processor time that a first run of one step
takes, the compiler's among them. Where a wave runs into a chain at rest, as it does here in the few steps that the largest
ones take, gauss-8 has more iterations than in a chain that moves everywhere.

""" + table(["N", *[f"{name}, ns" for name in columns], *[f"first run, {name}, s" for name in columns]],
            [[size, *[digits(cells[name, size]) for name in columns],
              *[f"{first[name, size]:.2f}" for name in columns]] for size in sizes])
    large = {name: [cells[name, size] for size in sizes if size >= 100] for name in columns}
    return text, "From N = 100 on, a particle's step takes " + listed(
        [f"{digits(min(values))} to {digits(max(values))} ns ({name})" for name, values in large.items()]) + "."


def median(values):
    return sorted(values)[len(values) // 2]


def latency_section():
    rows = json.loads(kept("latency"))
    cold = [median(row["cold"]) for row in rows]
    text = """## From a command to its result

Seconds of processor time that `hamgen run MODEL --steps 100` takes, the compiler's among them: cold, with an empty
cache, when the emitted code is compiled, and again, when it is found in the cache. Medians of five rounds; one after
the other, hamgen and the compiler take about as long by the clock if nothing else runs.

""" + table(["command", "cold", "again"],
            [[" ".join(["hamgen run", row["model"] + ".ham", *row["words"]]),
              f"{median(row['cold']):.2f}", f"{median(row['warm']):.3f}"] for row in rows])
    warm = [median(row["warm"]) for row in rows]
    return text, (f"A cold `run` of the models below takes {span(cold, '{:.2f}')} s of processor time, and "
                  f"{span(warm, '{:.2f}')} s once it is compiled.")


def page():
    m = json.loads(kept("machine"))
    sections = [step_section(), larger_section(), peers_section(), batch_section(), lanes_section(),
                scaling_section(), latency_section()]
    short = []
    for _, said in sections:
        short += said if isinstance(said, list) else [said]
    short = "\n".join(textwrap.fill(f"* {line}", 116, subsequent_indent="  ") for line in short if line)
    return f"""# Speed

Made by one command, `scripts/speed`, which builds and runs what is in [benchmarks](../benchmarks/README.md) and
writes this page, its words included. {m["date"]}; {m["processor"]}, {m["cores"]} virtual processors with
{m["instructions"]}, other programs beside; {m["system"]}, {m["compiler"]} with
`-O3 -ffp-contract=off -fno-math-errno` (and `-march=native` where `hamgen run` compiles); GSL {m["gsl"]}, Boost {m["boost"]}.
**Ratios count**: what stands in one table was measured in turn in one run, in processor time; nanoseconds
do not carry over to another machine.

In short, and where another is faster:

{short}

""" + "\n".join(text for text, _ in sections)


def faster_libraries():
    """By how much at most on each model where one is faster, to an error of the state or the energy."""
    lost = {}
    for model, _, _, targets, errors in by_targets():
        for methods in errors.values():
            for place in range(len(targets)):
                own, other = best(methods, place, False), best(methods, place, True)
                if own and other and other[0] < 0.98 * own[0]:
                    lost[model] = max(lost.get(model, 0), own[0] / other[0])
    return listed([f"{model} (by up to {ratio:.2f} times)" for model, ratio in lost.items()]) if lost else ""


def readme_table():
    """A few methods on the pendulum, to an error of the state, and where it is otherwise."""
    model, _, _, targets, errors = by_targets()[0]
    methods = errors["state"]
    rows = []
    for name, shown in (("implicit-midpoint", "implicit midpoint"), ("stormer-verlet", "Stormer-Verlet"),
                        ("implicit-midpoint:order=8", "implicit midpoint, `--order 8`")):
        rows.append([shown, *[digits(t) if t else "-" for t in methods[name]]])
    others = [best(methods, place, True) for place in range(len(targets))]
    rows.append(["best of the libraries", *[digits(each[0]) if each else "-" for each in others]])
    lost = faster_libraries()
    said = (f"It is not ahead everywhere: there are errors to which one of them is faster on {lost}. "
            "The page says to which." if lost else "")
    return (table(["state error", *[power(target) for target in targets]], rows) + "\n" +
            textwrap.fill(said, 116) + "\n")


def fill(path, tables):
    """What stands between the marks of their names."""
    text = (ROOT / path).read_text()
    for name, written in tables.items():
        begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
        before, rest = text.split(begin)
        text = before + begin + written + end + rest.split(end)[1]
    (ROOT / path).write_text(text)


def write():
    (ROOT / "docs/speed.md").write_text(page())
    fill("README.md", {"speed": readme_table()})
    fill("benchmarks/README.md", benchmark_tables.of_readme())
    # That page stays where nothing was measured beside 9c0ac14 here.
    if (KEPT / "earlier").exists():
        fill("benchmarks/earlier/README.md", benchmark_tables.of_earlier())
