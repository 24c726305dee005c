"""The tables of benchmarks/README.md and benchmarks/earlier/README.md, from what the benchmarks printed."""

import json
import re

from kept_output import KEPT, digits, kept, table


def commands_table():
    rows = []
    for line in kept("commands").splitlines():
        row = re.match(r"(.*): ([\d.]+) s, (\d+) MB, (\d+) bytes", line)
        if row:
            rows.append([row[1], f"{row[2]} s", f"{row[3]} MB", f"{float(row[4]) / 1000:.1f} KB"])
    return table(["command", "processor time", "memory", "output"], rows)


def split_table():
    models, parts = [], {}
    for line in kept("split").splitlines():
        row = re.match(r" +(\d+) +\d+ % +(.*)", line)
        if row:
            parts.setdefault(row[2], {})[models[-1][0]] = int(row[1])
        else:
            head = re.match(r"(\w+), .*: (\d+) instructions a step", line)
            models.append((head[1], head[2]))
    order = sorted(parts, key=lambda part: -sum(parts[part].values()))
    rows = [[part, *[parts[part].get(model, "") for model, _ in models]] for part in order]
    rows.append(["all", *[whole for _, whole in models]])
    return table(["", *[model for model, _ in models]], rows)


def advice_table():
    models, errors = {}, []
    for line in kept("advice").splitlines():
        row = re.match(r"(\w+) +(1e-\d+) +([\d.]+)  \S", line)
        other = re.match(r"(\w+) +(1e-\d+)  (nothing .*|what is advised is unstable)", line)
        found = row or other
        if found:
            models.setdefault(found[1], {})[found[2]] = row[3] if row else found[3]
            errors += [found[2]] if found[2] not in errors else []
    said = kept("advice").strip().splitlines()[-1]
    return table(["model", *errors], [[name, *[cells.get(error, "") for error in errors]]
                                      for name, cells in models.items()]) + f"\n{said[0].upper()}{said[1:]}.\n"


def dated():
    m = json.loads(kept("machine"))
    return f"{m['date']}, {m['processor']} with {m['instructions']}, {m['compiler']}."


def of_readme():
    tables = {"commands": f"{dated()}\n\n{commands_table()}", "split": split_table()}
    # That table stays, with its date, where advice was not measured here.
    if (KEPT / "advice").exists():
        tables["advice"] = f"{dated()}\n\n{advice_table()}"
    return tables


def earlier_parts():
    """Of earlier.py: the lines of each of its measurements."""
    parts = {}
    for line in kept("earlier").splitlines():
        if line in ("stages", "stages-portable", "lanes", "goal"):
            lines = parts.setdefault(line, [])
        else:
            lines.append(line)
    return parts


STAGES_AIMS = {"pendulum": 3.8, "henon_heiles": 2.2, "kepler": 2.0, "outer_solar_system": 5, "stiff_fpu": 1.5,
               "product": 1.5, "double_pendulum": 4}


def stages_table(lines, aims):
    models, mean = {}, None
    for line in lines:
        row = re.match(r"(\w+), (gauss-\d+): .*earlier/now ([\d.]+), without refinement ([\d.]+)", line)
        if row:
            models.setdefault(row[1], {})[row[2]] = row[3], row[4]
        elif line.startswith("geometric mean"):
            mean = re.findall(r"[\d.]+", line)
    rows = [[model, *cells["gauss-16"], *cells["gauss-8"], *([aims[model]] if aims else [])]
            for model, cells in models.items()]
    head = ["", "gauss-16", "of this without refinement", "gauss-8", "of this without refinement"]
    return (table(head + (["aim"] if aims else []), rows) +
            f"\nGeometric mean of the better of the two: {mean[0]}, without refinement {mean[1]}.\n")


LANES_AIMS = {("pendulum", "implicit-midpoint"): 7, ("henon_heiles", "implicit-midpoint"): 5,
              ("kepler", "implicit-midpoint"): 5, ("product", "implicit-midpoint"): 5,
              ("double_pendulum", "implicit-midpoint"): 4, ("stiff_fpu", "implicit-midpoint"): 8}


def lanes_table(lines):
    rows = []
    for line in lines:
        model, scheme = re.match(r"(\w+), ([\w-]+)", line).groups()
        ns = dict(re.findall(r" (earlier|one|eight|eight_avx2|sixteen) ([\d.]+)", line))
        aim = LANES_AIMS.get((model, scheme), 8)
        rows.append([f"{model}, {scheme}", *[digits(float(ns[key])) for key in
                                             ("earlier", "one", "eight", "eight_avx2", "sixteen")],
                     f"{float(ns['earlier']) / float(ns['eight']):.1f}", aim])
    return table(["", "9c0ac14", "one", "W = 8", "AVX2", "W = 16", "9c0ac14 / (W = 8)", "aim"], rows)


def goal_table(lines):
    rows = []
    for line in lines:
        head = re.match(r"(\w+): (.*)", line)
        if head:
            rows.append([head[1]])
            for each in head[2].split("; "):
                who = re.match(r"(\w+) (.*), h = ([\d.e-]+), ([\d.e+]+) ns", each)
                rows[-1].append(f"{who[2]}, h = {digits(float(who[3]))}: {digits(float(who[4]))}")
            continue
        ratio = re.match(r"  of the earlier: alone ([\d.]+) \(aim ([\d.]+)\)(?:, in eight lanes ([\d.]+) \(aim ([\d.]+)\))?",
                         line)
        if ratio:
            rows[-1] += [""] * (4 - len(rows[-1]))
            rows[-1] += [ratio[1], ratio[2], ratio[3] or "", ratio[4] or ""]
    return table(["", "9c0ac14, ns", "now, ns", "in eight lanes, ns", "now / 9c0ac14", "aim",
                  "lanes / 9c0ac14", "aim"], rows)


def of_earlier():
    parts = earlier_parts()
    return {"stages": f"{dated()}\n\n" + stages_table(parts["stages"], STAGES_AIMS),
            "portable stages": stages_table(parts["stages-portable"], None),
            "lanes": lanes_table(parts["lanes"]), "goal": goal_table(parts["goal"])}
