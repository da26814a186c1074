#!/usr/bin/env python3
"""Draws what `avbd bench --json` printed: plot_bench.py FILE.jsonl OUT.svg

Left: time of a step against the number of bodies, with the fitted power for each engine. Right: error (the larger of
penetration and joint gap) against time, a dot for each record. Hollow dots failed their scene's check. Needs nothing but
Python."""

import json
import math
from html import escape

import svg

WIDTH, HEIGHT, LEFT, TOP = 460, 380, 70, 40
FAMILIES = {"boxes_": "boxes", "slab_": "points of slabs"}  # scenes of one kind and many sizes
COLORS = ["#1668b8", "#c8442c", "#2d8a4e", "#8454b0", "#a67c00", "#555555"]


def records(path):
    found = []
    with open(path, encoding="utf-8") as file:
        for line in file:
            record = json.loads(line)
            if record.get("ms_median"):
                found.append(record)
    return found


def label(record):
    return record["engine"] + (f" x{record['workers']}" if record["workers"] > 1 else "")


def error(record):
    return max(record.get("penetration_max") or 0, record.get("joint_gap_max") or 0) * 1e3


def slope(points):
    """Least-squares power of y by x, or None."""
    x, y = [math.log(p[0]) for p in points], [math.log(p[1]) for p in points]
    n, sx = len(points), sum(x)
    spread = n * sum(v * v for v in x) - sx * sx
    return (n * sum(a * b for a, b in zip(x, y)) - sx * sum(y)) / spread if n > 2 and spread > 1e-9 else None


class Chart:
    """A chart with two logarithmic axes."""

    def __init__(self, left, title, x_name, y_name, points):
        self.left, self.parts = left, []
        self.x = self.range(p[0] for p in points)
        self.y = self.range(p[1] for p in points)
        self.text(left + WIDTH / 2, TOP - 16, title, "middle", 14)
        self.text(left + WIDTH / 2, TOP + HEIGHT + 34, x_name, "middle")
        self.parts.append(
            f'<text transform="translate({left - 48},{TOP + HEIGHT / 2}) rotate(-90)" text-anchor="middle">{escape(y_name)}</text>'
        )
        for axis, at in ((self.x, self.at_x), (self.y, self.at_y)):
            for power in range(axis[0], axis[1] + 1):
                self.tick(axis is self.x, at(10.0**power), 10.0**power)

    @staticmethod
    def range(values):
        values = list(values)
        low = math.floor(math.log10(min(values)))
        return low, max(low + 1, math.ceil(math.log10(max(values))))

    def at_x(self, value):
        return self.left + WIDTH * (math.log10(value) - self.x[0]) / (self.x[1] - self.x[0])

    def at_y(self, value):
        return TOP + HEIGHT * (1 - (math.log10(value) - self.y[0]) / (self.y[1] - self.y[0]))

    def tick(self, across, at, value):
        bottom, right = TOP + HEIGHT, self.left + WIDTH
        ends = (at, TOP, at, bottom) if across else (self.left, at, right, at)
        self.parts.append('<line x1="%.1f" y1="%.1f" x2="%.1f" y2="%.1f" stroke="#dddddd"/>' % ends)
        self.text(*((at, bottom + 16) if across else (self.left - 6, at + 4)), f"{value:g}", "middle" if across else "end")

    def text(self, x, y, text, anchor="start", size=11):
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}">{escape(text)}</text>')

    def dot(self, x, y, color, full, name):
        fill = color if full else "white"
        self.parts.append(
            f'<circle cx="{self.at_x(x):.1f}" cy="{self.at_y(y):.1f}" r="4" fill="{fill}" stroke="{color}">'
            f"<title>{escape(name)}</title></circle>"
        )

    def line(self, points, color):
        path = " ".join(f"{self.at_x(x):.1f},{self.at_y(y):.1f}" for x, y in points)
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{color}"/>')


def draw(found):
    engines = list(dict.fromkeys(label(r) for r in found))
    color = {name: COLORS[i % len(COLORS)] for i, name in enumerate(engines)}
    sized = [(r["bodies"], r["ms_median"], r) for r in found if r["bodies"] > 0]
    errors = [(r["ms_median"], error(r), r) for r in found if error(r) > 0]
    parts = []
    if sized:
        chart = Chart(LEFT, "Time of a step by number of bodies", "bodies", "ms", sized)
        for x, y, r in sized:
            chart.dot(x, y, color[label(r)], r["check"] == "pass", f"{r['scene']}: {y:g} ms")
        for i, name in enumerate(engines):
            powers = []
            for prefix, kind in FAMILIES.items():
                line = sorted((x, y) for x, y, r in sized if label(r) == name and r["scene"].startswith(prefix))
                if power := slope(line):
                    powers.append(f"{kind} to the power {power:.2f}")
                if len(line) > 1:
                    chart.line(line, color[name])
            chart.text(LEFT + 10, TOP + 16 + 15 * i, ": ".join([name] + ([", ".join(powers)] if powers else [])))
            chart.parts.append(f'<circle cx="{LEFT + 4}" cy="{TOP + 12 + 15 * i}" r="3" fill="{color[name]}"/>')
        parts += chart.parts
    if errors:
        chart = Chart(2 * LEFT + WIDTH + 20, "Error by time of a step", "ms", "largest penetration or gap, mm", errors)
        for x, y, r in errors:
            chart.dot(x, y, color[label(r)], r["check"] == "pass", f"{r['scene']}: {x:g} ms, {y:g} mm")
        parts += chart.parts
    return svg.page(2 * (WIDTH + LEFT) + 50, HEIGHT + TOP + 50, parts)


if __name__ == "__main__":
    svg.main(__doc__, lambda path: draw(records(path)))
