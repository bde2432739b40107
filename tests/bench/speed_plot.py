# SPDX-License-Identifier: GPL-3.0-or-later
"""A plot of the figures of compare.py: speed over particles, at rest and flowed, on one thread."""
import math
from html import escape

from speed_tables import Figures, counts_of, limits

WIDTH, HEIGHT = 760, 420
LEFT, RIGHT, TOP, BOTTOM = 70, 210, 30, 50
KINDS = {"single": ("sinew, single", "#c0392b"), "double": ("sinew, double", "#1f5fa8"),
         "lammps": ("LAMMPS, eq. 1 alone", "#444444"), "cells": ("the paper's cells", "#2e8b57"),
         "all_pairs": ("all pairs", "#b8860b")}
DASHED = 'stroke-dasharray="5 4"'


class Axis:
    """Decades of [low, high] onto [begin, end]."""

    def __init__(self, low, high, begin, end):
        self.low, self.high = math.floor(math.log10(low)), math.ceil(math.log10(high))
        self.begin, self.end = begin, end

    def at(self, value):
        share = (math.log10(value) - self.low) / (self.high - self.low)
        return self.begin + share * (self.end - self.begin)

    def decades(self):
        return [10.0**power for power in range(self.low, self.high + 1)]


def text(x, y, words, anchor="start", color="#222222", more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{color}" {more}>{escape(words)}</text>'


def line(x1, y1, x2, y2, color, more=""):
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{color}" {more}/>'


def grid(across, up):
    for value in across.decades():
        yield line(across.at(value), TOP, across.at(value), HEIGHT - BOTTOM, "#dddddd")
        yield text(across.at(value), HEIGHT - BOTTOM + 18, f"{value:,.0f}", "middle")
    for value in up.decades():
        yield line(LEFT, up.at(value), WIDTH - RIGHT, up.at(value), "#dddddd")
        yield text(LEFT - 8, up.at(value) + 4, f"{value:g}", "end")
    yield text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 12, "particles", "middle")
    yield text(LEFT, TOP - 12, "million particle-steps per second, one thread")


def curve(points, across, up, color, dashed):
    places = [(across.at(x), up.at(y)) for x, y in points]
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
    dash = DASHED if dashed else ""
    yield f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="2" {dash}/>'
    for x, y in places:
        yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{color}"/>'


def curves(results):
    """(kind, state, [(particles, Mps)]), what has any."""
    figures = Figures(results)
    for kind in KINDS:
        for state in ("rest", "flowed"):
            found = [(results["particles"][count], figures.speed(state, count, kind)) for count in counts_of(results)]
            points = [(count, speed) for count, speed in found if speed]
            if points:
                yield kind, state, points


def legend(kinds):
    x = WIDTH - RIGHT + 14
    entries = [(*KINDS[kind], "") for kind in kinds]
    entries += [("at rest", "#888888", ""), ("flowed", "#888888", DASHED)]
    for number, (name, color, dash) in enumerate(entries):
        y = TOP + 12 + 20 * number
        yield line(x, y - 4, x + 26, y - 4, color, 'stroke-width="2" ' + dash)
        yield text(x + 32, y, name)


def limit_lines(results, across, up):
    for kind in ("single", "double"):
        allowed = min(limit for other, *_, limit in limits(results) if other == kind)
        color = KINDS[kind][1]
        yield line(LEFT, up.at(allowed), WIDTH - RIGHT, up.at(allowed), color, 'stroke-dasharray="1 4"')
        yield text(LEFT + 6, up.at(allowed) - 4, f"limit, {kind}", color=color, more='font-size="11"')


def svg(results):
    drawn = list(curves(results))
    counts = [count for *_, points in drawn for count, _ in points]
    speeds = [speed for *_, points in drawn for _, speed in points] + [limit for *_, limit in limits(results)]
    across = Axis(min(counts), max(counts), LEFT, WIDTH - RIGHT)
    up = Axis(min(speeds), max(speeds), HEIGHT - BOTTOM, TOP)
    parts = [*grid(across, up), *limit_lines(results, across, up)]
    for kind, state, points in drawn:
        parts += curve(points, across, up, KINDS[kind][1], state == "flowed")
    parts += legend(dict.fromkeys(kind for kind, *_ in drawn))
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" '
            f'font-size="13">\n<rect width="100%" height="100%" fill="white"/>\n' + "\n".join(parts) + "\n</svg>\n")
