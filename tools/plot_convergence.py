#!/usr/bin/env python3
"""Draws how soft bodies come near to theory with their resolution: plot_convergence.py FILE.jsonl OUT.svg

FILE is what `avbd verify bar cantilever --json` printed. A line for each of them: error against theory by the cells
across, both logarithmic, with the bound of the finest. Needs nothing but Python."""

import json
import math
from html import escape

import svg

WIDTH, HEIGHT, LEFT, TOP = 460, 300, 70, 40
COLORS = {"bar": "#1668b8", "cantilever": "#c8442c"}
NAMES = {"bar": "a bar under its own weight: stretch", "cantilever": "a beam under its own weight: sag of its tip"}
LOW, HIGH, BOUND = 1e-4, 1, 0.03


def curves(path):
    """Points (cells across, ratio to theory) by line."""
    found = {}
    with open(path, encoding="utf-8") as file:
        for line in file:
            record = json.loads(line)
            if record["figure"] == "of_theory" and record["params"].startswith("across="):
                found.setdefault(record["line"], []).append((int(record["params"][7:]), record["measured"]))
    return found


def at_x(cells, most):
    return LEFT + WIDTH * (0.06 + 0.88 * math.log(cells) / math.log(most))


def at_y(error):
    return TOP + HEIGHT * math.log(HIGH / max(error, LOW)) / math.log(HIGH / LOW)


def text(x, y, words, anchor="middle"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(words)}</text>'


def horizontal(error, style):
    return f'<line x1="{LEFT}" y1="{at_y(error):.1f}" x2="{LEFT + WIDTH}" y2="{at_y(error):.1f}" {style}/>'


def draw(found):
    cells = sorted({x for points in found.values() for x, _ in points})
    most = max(cells[-1], 2)
    parts = [text(LEFT + WIDTH / 2, TOP - 16, "Error against theory by resolution")]
    parts.append(text(LEFT + WIDTH / 2, TOP + HEIGHT + 34, "cells across"))
    for power in range(round(math.log10(LOW)), round(math.log10(HIGH)) + 1):
        parts.append(horizontal(10.0**power, 'stroke="#dddddd"'))
        parts.append(text(LEFT - 6, at_y(10.0**power) + 4, f"{10.0**power:g}", "end"))
    parts += [text(at_x(x, most), TOP + HEIGHT + 16, str(x)) for x in cells]
    parts.append(horizontal(BOUND, 'stroke="#888888" stroke-dasharray="4 3"'))
    parts.append(text(LEFT + WIDTH, at_y(BOUND) - 4, "bound of the finest", "end"))
    for i, (name, points) in enumerate(found.items()):
        color = COLORS.get(name, "#555555")
        places = [(at_x(x, most), at_y(abs(ratio - 1)), ratio) for x, ratio in sorted(points)]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y, _ in places)
        parts.append(f'<polyline points="{path}" fill="none" stroke="{color}"/>')
        for x, y, ratio in places:
            parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{color}"/>')
            parts.append(text(x, y - 8, f"{ratio:.3f}"))
        parts.append(f'<circle cx="{LEFT + 14}" cy="{TOP + HEIGHT - 32 + 16 * i}" r="4" fill="{color}"/>')
        parts.append(text(LEFT + 24, TOP + HEIGHT - 28 + 16 * i, NAMES.get(name, name), "start"))
    return svg.page(LEFT + WIDTH + 30, HEIGHT + TOP + 50, parts)


if __name__ == "__main__":
    svg.main(__doc__, lambda path: draw(curves(path)))
