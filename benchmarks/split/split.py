#!/usr/bin/env python3
"""Where the instructions of an emitted step are.

Emits the header, compiles it with -g and counts the instructions of its lines under callgrind, in runs
of two lengths, whose difference is that of steps alone.  A line belongs to what its routine or class is for,
lines of `solve` to what they mention; what the optimiser moves from one line to another goes with it.

  split.py HAMGEN MODEL [SCENE] [--option=VALUE...]   options as `hamgen generate` has them
"""

import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile

FLAGS = ["-std=c++17", "-O3", "-g", "-ffp-contract=off", "-fno-math-errno", "-w"]
SHORT, LONG = 1000, 11000

CLASSES = [  # where a routine or a class stands, what it is for
    (r"History|extrapolate", "prediction"),
    (r"Rule|Distance|magnitude", "when to stop"),
    (r"Matrix|invert", "elimination"),
    (r"Refinement", "refinement"),
    (r"two_sum|collect|difference_error|product_error", "compensated sums"),
    (r"squares_of", "is it finite"),
    (r"^(derivatives|gradient|\w*_gradient|hessian|vector_fields?|forces|lane_\w+)$", "derivatives of H"),
    (r"Pack|Lane|maskwise|compared|select", "operations of lanes"),
    (r"Propagator", "propagator: copies, counts"),
]
LINES = [  # of `solve` and what else is left
    (r"\blength\b", "is it finite"),
    (r"matrix|vector", "elimination"),
    (r"size|scale|verdict|magnitude", "when to stop"),
    (r"start\.|known", "prediction"),
    (r"rest|carry|lost|error", "compensated sums"),
    (r"change|delta", "correction at the solution"),
    (r"\bH_|\bt\d+|\bd_|derivatives", "derivatives of H"),
]


def output_of(*words, cwd=None):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, cwd=cwd)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, words))}\n{done.stderr}")
    return done.stdout


def first_match(table, text):
    return next((what for pattern, what in table if re.search(pattern, text)), None)


def purposes(header):
    """Of every line, from 1."""
    place = ""
    result = [""]
    for line in header.splitlines():
        begins = re.match(r"(?:struct|class) (\w+)|(?:\[\[nodiscard\]\] )?inline .*?(\w+)\(", line)
        if begins:
            place = begins.group(1) or begins.group(2)
        result.append(first_match(CLASSES, place) or first_match(LINES, line) or "residual, rows")
    return result


def instructions(program, steps, directory):
    """Of every line of the header; of libraries under their own name."""
    out = directory / "callgrind.out"
    output_of("valgrind", "--tool=callgrind", "--dump-line=yes", "--compress-strings=no",
              "--compress-pos=no", f"--callgrind-out-file={out}", program, steps)
    counts = collections.Counter()
    own = called = False
    for line in out.read_text().splitlines():
        if line.startswith("ob="):
            own = line.endswith("/program")
        elif line.startswith("calls="):
            called = True
        elif line[:1].isdigit():  # what a call took is the routine's that is called
            if not called:
                number, count = line.split()[:2]
                counts[int(number) if own else "functions of the library"] += int(count)
            called = False
    return counts


def program_text(header, found):
    space = re.findall(r"^namespace (\w+::\w+) \{", header, re.MULTILINE)[-1]
    system = space.split("::")[0]
    numbers = ", ".join(map(str, found["state"]["q"] + found["state"]["p"]))
    given = "".join(f"par.{name} = {value}; " for name, value in found["parameters"].items())
    return (f"#include <cstdlib>\n#include \"step.hpp\"\nint main(int, char** words) {{\n"
            f"  {system}::Parameters par; {given}\n  {system}::State z{{{numbers}}};\n"
            f"  {space}::Propagator run(par, {found['h']}, z);\n"
            f"  return run.advance(std::atoi(words[1])).converged ? 0 : 1;\n}}\n")


def main():
    hamgen, model, *rest = sys.argv[1:]
    scene = [word for word in rest if not word.startswith("-")]
    options = [word for word in rest if word.startswith("-")]
    words = [word for name in scene for word in ("--scene", name)]
    found = json.loads(output_of(hamgen, "run", model, *words, *options, "--steps", 1, "--json",
                                 "--quiet"))
    with tempfile.TemporaryDirectory() as name:
        directory = pathlib.Path(name)
        header = output_of(hamgen, "generate", model, *options)
        (directory / "step.hpp").write_text(header)
        (directory / "main.cpp").write_text(program_text(header, found))
        output_of("g++", *FLAGS, "main.cpp", "-o", "program", cwd=directory)
        counts = instructions(directory / "program", LONG, directory)
        counts.subtract(instructions(directory / "program", SHORT, directory))
    purpose = purposes(header)
    table = collections.Counter()
    for line, count in counts.items():
        table[line if isinstance(line, str) else purpose[line]] += count / (LONG - SHORT)
    whole = sum(table.values())
    print(f"{found['model']}, {found['scheme']}, h = {found['h']}: {whole:.0f} instructions a step")
    for what, count in table.most_common():
        if count >= 0.5:
            print(f"  {count:7.0f}  {100 * count / whole:3.0f} %  {what}")


main()
