# SPDX-License-Identifier: GPL-3.0-or-later
"""Charts after figures 1 and 2 of Komiya and Tokoi, from numbers of sinew: packed particles by `sinew fill`, constants
of the law of force by `sinew check`. Needs Debian's python3-matplotlib."""
import csv
import json
import subprocess
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

COLORS = {"self": "#d65200", "within": "#f2b98a", "beyond": "#e4e6ea", "2r": "#30343c", "a": "#0096a0", "b": "#006cbe"}
SECOND = 8 ** 0.5  # distance of second neighbors, radii
plt.rcParams.update({"font.size": 10, "font.family": "DejaVu Sans", "axes.spines.top": False,
                     "axes.spines.right": False})


def constants(sinew, scene, *settings):
    """Radius (m), k1 and k2 (Pa) of a scene's particles."""
    words = [word for setting in settings for word in ("--set", setting)]
    done = subprocess.run([sinew, "check", "--quiet", "--json", scene, *words], check=True, capture_output=True, text=True)
    found = json.loads(done.stdout)
    return found["radius"], found["k1"], found["k2"]


def packed(sinew, scene):
    """Centers of a scene's particles, m."""
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "body.csv"
        subprocess.run([sinew, "fill", "--quiet", scene, "-o", table], check=True, stdout=subprocess.DEVNULL)
        with table.open() as file:
            return [tuple(float(row[axis]) for axis in "xyz") for row in csv.DictReader(file)]


def layer(points, radius, normal):
    """Particles of the layer through the one nearest to the middle, in its plane and in radii from that one."""
    middle = [sum(point[k] for point in points) / len(points) for k in range(3)]
    center = min(points, key=lambda point: sum((point[k] - middle[k]) ** 2 for k in range(3)))
    offsets = [[(point[k] - center[k]) / radius for k in range(3)] for point in points]
    unit = [part / sum(n * n for n in normal) ** 0.5 for part in normal]
    along = [1 / 2 ** 0.5, -1 / 2 ** 0.5, 0]  # a row of touching particles, in both layers
    across = [unit[1] * along[2] - unit[2] * along[1], unit[2] * along[0] - unit[0] * along[2],
              unit[0] * along[1] - unit[1] * along[0]]

    def dot(u, v):
        return sum(one * other for one, other in zip(u, v))

    return [(dot(offset, along), dot(offset, across)) for offset in offsets if abs(dot(offset, unit)) < 1e-3]


def draw_layer(axes, places, ranges):
    for x, y in places:
        distance = (x * x + y * y) ** 0.5
        kind = "self" if distance < 1e-6 else "within" if distance < ranges["b"] else "beyond"
        axes.add_patch(plt.Circle((x, y), 1, facecolor=COLORS[kind], edgecolor="#9a9da4", linewidth=0.6))
        if distance > 1e-6:
            axes.plot(x, y, ".", color="#30343c", markersize=6, zorder=3)
    for name, reach in ranges.items():
        axes.add_patch(plt.Circle((0, 0), reach, fill=False, color=COLORS[name], linewidth=1.6,
                                  linestyle="-" if name != "a" else (0, (4, 2))))
    half = 4.1
    axes.set(xlim=(-half, half), ylim=(-half, half), aspect="equal", xticks=[], yticks=[])
    for side in axes.spines.values():
        side.set_visible(False)


def interaction_range(sinew, scene, a, b, picture):
    """Layers of closest packing through one particle, with the circles of its law of force; a and b in radii."""
    points, (radius, _, _) = packed(sinew, scene), constants(sinew, scene)
    ranges = {"2r": 2, "a": a, "b": b}
    figure, axes = plt.subplots(1, 2, figsize=(7, 4.3))
    figure.subplots_adjust(left=0.01, right=0.99, bottom=0.18, top=0.94, wspace=0.03)
    for ax, normal, title in ((axes[0], (1, 1, 1), "densest layer: six neighbors touch"),
                              (axes[1], (0, 0, 1), f"face of the cube: second neighbors at {SECOND:.2f} r")):
        draw_layer(ax, layer(points, radius, normal), ranges)
        ax.set_title(title, fontsize=10)
    meanings = {"2r": "2 r: contact, repulsion within", "a": f"a = {a:g} r: attraction begins",
                "b": f"b = {b:g} r: attraction ends"}
    lines = [plt.Line2D([], [], color=COLORS[name], linewidth=1.6, linestyle="-" if name != "a" else (0, (4, 2)),
                        label=text) for name, text in meanings.items()]
    dots = [plt.Line2D([], [], marker="o", linestyle="", markersize=9, markeredgecolor="#9a9da4",
                       markerfacecolor=COLORS[kind], label=text)
            for kind, text in (("self", "the particle"), ("within", "within b"), ("beyond", "no force"))]
    figure.legend(handles=lines + dots, loc="lower center", ncols=2, frameon=False, fontsize=9)
    figure.savefig(picture, dpi=100, facecolor="white")
    plt.close(figure)


def force(d, radius, k1, k2, a, b):
    """Equation 1, N; positive: repulsion. All lengths in m."""
    if d < 2 * radius:
        return k1 * (4 * radius ** 2 - d ** 2)
    return -k2 * (d - a) * (b - d) if a <= d < b else 0


def draw_force(axes, sinew, scene, settings, a, b, look):
    radius, k1, k2 = constants(sinew, scene, *settings)
    distances = [1.7 + 0.002 * k for k in range(701)]  # radii
    values = [1000 * force(d * radius, radius, k1, k2, a * radius, b * radius) for d in distances]
    b_text = f"{b:.2f}".rstrip("0")
    axes.plot(distances, values, label=f"a = {a:g} r, b = {b_text} r, $k_2$ = {k2 / 1000:.2f} kPa", **look)
    return radius, k1


def force_curve(sinew, gap, bend, literal, picture):
    """The law of a scene with a gap, at equal stiffness in tension and compression, beside those of two others."""
    figure, axes = plt.subplots(figsize=(7, 4.2), layout="constrained")
    axes.axhline(0, color="#30343c", linewidth=0.8)
    radius, k1 = draw_force(axes, sinew, gap, ["material.lambda=1"], 2.1, 2.6,
                            {"color": "#006cbe", "linewidth": 2.2, "zorder": 3})
    draw_force(axes, sinew, bend, [], 2, 2.6, {"color": "#8a8f98", "linestyle": (0, (4, 2)), "linewidth": 1.4})
    draw_force(axes, sinew, literal, [], 2, SECOND, {"color": "#0096a0", "linestyle": (0, (1, 1)), "linewidth": 1.8})
    for d, name in ((2, "2 r"), (2.1, "a"), (2.6, "b")):
        axes.axvline(d, color="#c4c7cc", linewidth=0.8, zorder=0)
        axes.annotate(name, (d, 1), xycoords=("data", "axes fraction"), ha="center", va="bottom", fontsize=10)
    axes.annotate("repulsion\n$k_1\\,(4r^2 - d^2)$", (1.86, 205), xytext=(1.92, 250), fontsize=10, color="#006cbe")
    axes.annotate("attraction\n$-k_2\\,(d - a)(b - d)$", (2.56, -130), ha="left", va="top", fontsize=10,
                  color="#006cbe")
    axes.annotate("none from 2 r to a", (2.05, 0), xytext=(2.2, 75), fontsize=10, color="#006cbe",
                  arrowprops={"arrowstyle": "-", "color": "#006cbe", "linewidth": 0.8})
    axes.set(xlim=(1.7, 3.1), ylim=(-290, 430), xlabel=f"distance d, radii (r = {1000 * radius:g} mm)", ylabel="force, mN")
    axes.set_title(f"$k_1$ = {k1 / 1000:.2f} kPa", fontsize=10, loc="right", pad=18)
    axes.legend(loc="upper right", frameon=False, fontsize=9)
    figure.savefig(picture, dpi=100, facecolor="white")
    plt.close(figure)
