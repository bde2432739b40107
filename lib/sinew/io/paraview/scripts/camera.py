# SPDX-License-Identifier: GPL-3.0-or-later
"""The two views side by side, and their cameras."""
import math

from paraview.simple import *

INK = [0.16, 0.18, 0.22]
PAPER_TOP = [0.86, 0.89, 0.93]
PAPER = [0.98, 0.98, 0.99]
# The part of the picture's width and height that the body may fill, above the color bar.
WIDE, TALL = 0.9, 0.8


def dress(view):
    view.UseColorPaletteForBackground = 0
    view.BackgroundColorMode = "Gradient"
    view.Background = PAPER
    view.Background2 = PAPER_TOP
    view.OrientationAxesLabelColor = INK
    view.CenterAxesVisibility = 0


def two_views():
    left = GetActiveViewOrCreate("RenderView")
    layout = GetLayout(left) or CreateLayout("sinew")
    if GetLayout(left) is None:
        AssignViewToLayout(left, layout)
    cell = layout.GetViewLocation(left)
    layout.SplitHorizontal(cell, 0.5)
    right = CreateRenderView()
    AssignViewToLayout(right, layout, cell)
    for view in (left, right):
        dress(view)
    left.OrientationAxesVisibility = 0
    AddCameraLink(left, right, "sinew camera")
    return layout, left, right


def corners_of(bounds):
    return [(x, y, z) for x in bounds[0:2] for y in bounds[2:4] for z in bounds[4:6]]


def bounds_of(source):
    return source.GetDataInformation().GetBounds()


def middle_and_size(corners):
    """The center of the box around all corners, and its longest side."""
    low, high = ([pick(corner[k] for corner in corners) for k in range(3)] for pick in (min, max))
    return [(a + b) / 2 for a, b in zip(low, high)], max(b - a for a, b in zip(low, high))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    length = math.sqrt(dot(a, a))
    return [part / length for part in a]


def look_at(view, corners, back, aspect):
    """Places the camera in the direction `back`, z up, as near as all corners allow."""
    back = unit(back)
    across = unit([-back[1], back[0], 0]) if back[0] or back[1] else [1, 0, 0]
    up = [back[1] * across[2] - back[2] * across[1], back[2] * across[0] - back[0] * across[2],
          back[0] * across[1] - back[1] * across[0]]
    center, _ = middle_and_size(corners)
    half = math.tan(math.radians(15))
    distance = 0
    for corner in corners:
        offset = [c - m for c, m in zip(corner, center)]
        wide = max(abs(dot(offset, up)) / TALL, abs(dot(offset, across)) / WIDE / aspect)
        distance = max(distance, dot(offset, back) + wide / half)
    low = half * distance * (0.95 - TALL)
    center = [m - low * part for m, part in zip(center, up)]
    view.CameraViewAngle = 30
    view.CameraFocalPoint = center
    view.CameraPosition = [m + distance * part for m, part in zip(center, back)]
    view.CameraViewUp = up
    view.CenterOfRotation = center
