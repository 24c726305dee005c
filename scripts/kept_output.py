"""What scripts/speed has measured, and how it writes tables of it."""

import pathlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
KEPT = ROOT / "build/release/speed"


def kept(name):
    return (KEPT / name).read_text()


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines) + "\n"


def digits(value, count=3):
    """1234.5 is 1230 and 0.01234 is 0.0123."""
    text = f"{value:.{count}g}"
    return f"{float(text):.0f}" if "e+" in text else text


def listed(words):
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " and " + words[-1]
