#!/usr/bin/env python3
"""check_certificate_test.py HAMGEN SOURCES [some]: certificates of shipped models hold; with any field
changed they do not."""
import copy
import importlib.machinery
import importlib.util
import json
import os
import subprocess
import sys
import tempfile

hamgen, sources = sys.argv[1:3]
path = os.path.join(sources, "scripts", "check-certificate")
with open(path, encoding="utf-8") as file:
    lines = file.readlines()
assert len(lines) <= 400, f"{len(lines)} lines"
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("check_certificate", path)
checker = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
loader.exec_module(checker)

# Model, options of the method, fields that its certificate has to have entries in, and how many of
# the changes are tried: of a chain in loops, whose certificate is long, some in every field.
# With `some`, a tenth of those.
CASES = [("kepler", [], ["atoms", "invariants"], 1),
         ("morse", ["--alpha", "1/3", "--beta", "h/7", "--gamma=-h/5"], ["atoms"], 1),
         ("driven_oscillator", [], ["atoms"], 1),
         ("fput", ["--set", "N=25", "--alpha", "1/3"], ["hessian"], 800)]
FEWER = 10 if sys.argv[3:] == ["some"] else 1


def refused(certificate, model, header):
    try:
        checker.Checker(certificate, model, header)
    except Exception:  # the command refuses with each of them
        return True
    return False


def changes(value):
    """Other values of a field, itself or one inside, each with its path."""
    if isinstance(value, dict):
        for key in value:
            for path, other in changes(value[key]):
                yield [key] + path, {**value, key: other}
            yield [key, "left out"], {k: v for k, v in value.items() if k != key}
            yield [key, "renamed"], {(k + "x" if k == key else k): v for k, v in value.items()}
    elif isinstance(value, list):
        for i, item in enumerate(value):
            for path, other in changes(item):
                yield [i] + path, value[:i] + [other] + value[i + 1:]
            yield [i, "twice"], value[:i] + [item] + value[i:]
        if len(value) > 1 and value[0] != value[1]:
            yield ["exchanged"], [value[1], value[0]] + value[2:]
    elif isinstance(value, bool):
        yield [], not value
        yield [], None
    elif isinstance(value, int):
        yield [], value + 1
        yield [], value - 1
        yield [], str(value)
    else:
        factors = ["2*" + value, "-" + value, "h*" + value, "0"] if value != "0" else ["1", "h"]
        for other in [value + "x", value + " + 1", "", None, *factors]:
            yield [], other


def exchange_that_means_nothing(path, certificate):
    """Lists whose order or completeness claims nothing."""
    order = path[-1] == "exchanged"
    if order and path[0] in ("invariants", "hessian"):
        return True
    if order and path[0] == "atoms":  # as long as none is made of another
        return not any(atom["name"] in other["argument"] for atom in certificate["atoms"]
                       for other in certificate["atoms"])
    return order and path[:2] == ["model", "parameters"]


def sample(changed, every):
    """One in so many, and one of every kind."""
    seen = {}
    for k, (path, other) in enumerate(changed):
        kind = tuple("*" if isinstance(step, int) else step for step in path)
        seen[kind] = seen.get(kind, 0) + 1
        if seen[kind] == 1 or k % every == 0:
            yield path, other


count = 0
for name, options, filled, every in CASES:
    model = os.path.join(sources, "hamiltonians", name + ".ham")
    with tempfile.TemporaryDirectory() as folder:
        header, made = os.path.join(folder, name + ".hpp"), os.path.join(folder, "certificate.json")
        subprocess.run([hamgen, "generate", model, *options, "-o", folder], check=True,
                       stderr=subprocess.DEVNULL)
        subprocess.run([hamgen, "verify", model, *options, "--emitted", header, "--certificate",
                        made], check=True, stdout=subprocess.DEVNULL)
        with open(made, encoding="utf-8") as file:
            certificate = json.load(file)
        checker.Checker(copy.deepcopy(certificate), model, header)  # it holds
        assert all(certificate[field] for field in filled), name
        for changed_path, other in sample(changes(certificate), every * FEWER):
            if exchange_that_means_nothing(changed_path, certificate):
                continue
            count += 1
            assert refused(other, model, header), f"{name}: accepted with {changed_path} changed"
        # The files are those that it speaks of.
        with open(header, "a", encoding="utf-8") as file:
            file.write("\n")
        assert refused(certificate, model, header), "another header"
print(f"{count} changed certificates are refused")
assert count > 500 / FEWER
