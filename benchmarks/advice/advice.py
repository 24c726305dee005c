#!/usr/bin/env python3
"""How far `hamgen bench`'s first table is from the best of an exhaustive scan.

For each model and error the method and step size that `bench` advises by itself stand beside the
fastest of all methods of `hamgen list schemes --for MODEL`, of the midpoint rule's higher orders
and of other solvers, at steps a twelfth of an octave apart.  Both are measured again in turn in one
run of `bench`; what is unstable over ten times the time does not count.

  advice.py HAMGEN [MODEL...]     default: ten of hamiltonians/
"""

import json
import pathlib
import subprocess
import sys

MODELS = {  # and the time of a run
    "pendulum": 100, "henon_heiles": 100, "kepler": 20, "double_pendulum": 5, "product": 10,
    "stiff_fpu": 5, "toda": 50, "duffing": 50, "spring_pendulum": 20, "morse": 50,
}
ERRORS = ["1e-4", "1e-6", "1e-8", "1e-10"]
ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, words))}\n{done.stderr}")
    return json.loads(done.stdout)


def bench(hamgen, model, time, *more):
    return run(hamgen, "bench", model, "--time", time, "--observe", "state", "--quiet", "--json",
               *more)


def schemes(hamgen, model):
    names = [row["name"] for row in run(hamgen, "list", "schemes", "--for", model, "--json")
             if row["order"] and not row["name"].startswith("-")]
    names += [f"implicit-midpoint:order={order}" for order in (4, 6, 8, 10)]
    names += ["implicit-midpoint:solver=fixed-point"]
    names += [f"{name}:solver=fixed-point" for name in names if name.startswith("gauss-")]
    return names


def steps(time, shortest, longest):
    """Numbers of steps, a twelfth of an octave apart."""
    numbers = set()
    h = longest
    while h > shortest:
        numbers.add(max(1, round(time / h)))
        h /= 2 ** (1 / 12)
    return sorted(numbers)


def row_of(found, scheme, h):
    for row in found["rows"]:
        if row["scheme"] == scheme and abs(row["h"] - h) < 1e-9 * h:
            return row
    return None


def scan(hamgen, model, time, names, advised):
    h = [row["h"] for row in advised.values()]
    numbers = steps(time, min(h) / 8, min(max(h) * 8, time / 4))
    rows = []
    for name in names:  # one that refuses a model refuses the run
        try:
            rows += bench(hamgen, model, time, "--schemes", name, "--rounds", 3, "--target", "1",
                          "--h", ",".join(f"{time}/{n}" for n in numbers))["rows"]
        except SystemExit as refused:
            print(f"    {name}: {str(refused).splitlines()[-1][:100]}", file=sys.stderr)
    return [row for row in rows if row["outcome"] == "done" and row["symplectic"]]


def side_by_side(hamgen, model, time, error, first, second):
    """Their times, in turn in one run, the best of three; None for what is unstable."""
    best = {}
    for _ in range(3):
        names = dict.fromkeys([first["scheme"], second["scheme"]])
        numbers = dict.fromkeys(f"{time}/{round(time / row['h'])}" for row in (first, second))
        found = bench(hamgen, model, time, "--schemes", ",".join(names), "--h", ",".join(numbers),
                      "--target", error)
        for row in (first, second):
            again = row_of(found, row["scheme"], row["h"])
            key = (row["scheme"], row["h"])
            if again is None or again["unstable"]:
                best[key] = None
            elif best.get(key, 1) is not None:
                best[key] = min(best.get(key, 1e9), again["s_per_time"])
    return tuple(best[row["scheme"], row["h"]] for row in (first, second))


def compare(hamgen, name, time):
    model = ROOT / "hamiltonians" / f"{name}.ham"
    answer = bench(hamgen, model, time, "--target", ",".join(ERRORS))
    advised = {row["error"]: row for row in answer["time_for_error"] if row.get("h")}
    rows = scan(hamgen, model, time, schemes(hamgen, model), advised)
    ratios = []
    for error in ERRORS:
        row = advised.get(float(error))
        if row is None:
            print(f"{name:<16} {error:>6}  nothing advised", flush=True)
            continue
        fast = sorted((r for r in rows if r["state_error"] and r["state_error"] <= float(error)),
                      key=lambda r: r["s_per_time"])
        for best in fast[:5]:
            ours, theirs = side_by_side(hamgen, model, time, error, row, best)
            if ours is None or theirs is not None:
                break
        else:
            print(f"{name:<16} {error:>6}  nothing of the scan is stable", flush=True)
            continue
        if ours is None:
            print(f"{name:<16} {error:>6}  what is advised is unstable: {row['scheme']}", flush=True)
            ratios.append(float("inf"))
            continue
        ratio = ours / theirs
        ratios.append(ratio)
        print(f"{name:<16} {error:>6}  {ratio:5.2f}  {row['scheme']} h = {row['h']:.4g}: "
              f"{ours * 1e6:.3g} us; {best['scheme']} h = {best['h']:.4g}: {theirs * 1e6:.3g} us",
              flush=True)
    return ratios


def main():
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    hamgen = sys.argv[1]
    print(f"{'model':<16} {'error':>6}  ratio  advised; best of the scan, per unit of time")
    ratios = []
    for name in sys.argv[2:] or MODELS:
        ratios += compare(hamgen, name, MODELS.get(name, 20))
    within = sum(ratio <= 1.05 for ratio in ratios)
    if not ratios:
        raise SystemExit("nothing was compared")
    print(f"{within} of {len(ratios)} within 5 per cent, the worst {max(ratios):.2f}")


main()
