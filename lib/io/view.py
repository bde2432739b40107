# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens this run in ParaView.

    paraview view.py                             in the window
    pvbatch view.py --picture out.png            a picture of the most deformed moment
    pvbatch view.py --picture out.png --time 1   of that moment (s)

Left the particles as spheres of their true size, coloured by one array; right the bones with their
x, y, z axes in red, green, blue inside the translucent surface. Choose another array with --array.
"""
import argparse
import math
import mmap
import os
import re
import sys
import xml.etree.ElementTree as ET

from paraview.simple import *

LEFT_IN = ""

INK = [0.16, 0.18, 0.22]
PAPER_TOP = [0.86, 0.89, 0.93]
PAPER = [0.98, 0.98, 0.99]
SKIN = [0.55, 0.71, 0.86]
EDGE = [0.20, 0.33, 0.47]
BONE = [0.98, 0.93, 0.80]
OBSTACLE = [0.62, 0.60, 0.58]
RED_GREEN_BLUE = [0.88, 0.15, 0.17, 0.13, 0.62, 0.24, 0.13, 0.36, 0.92]
# Lightness grows with the value, and the lowest is still light enough to see the spheres' shading.
COLOURS = [(0.0, 0.27, 0.33, 0.62), (0.25, 0.17, 0.52, 0.70), (0.5, 0.25, 0.71, 0.60),
           (0.75, 0.67, 0.83, 0.38), (1.0, 0.99, 0.84, 0.22)]
# A sphere lit from the upper left on each splat; beyond its outline there is nothing.
SPHERE = """//VTK::Color::Impl
vec2 at = offsetVCVSOutput.xy;
float outside = dot(at, at);
if (outside > 1.0) { discard; }
vec3 normal = vec3(at, sqrt(1.0 - outside));
float light = max(dot(normal, normalize(vec3(-0.35, 0.50, 0.79))), 0.0);
float shine = 0.25 * pow(max(dot(normal, normalize(vec3(-0.19, 0.27, 0.95))), 0.0), 40.0);
ambientColor = ambientColor * (0.25 + 0.75 * light) + vec3(shine);
diffuseColor = diffuseColor * (0.25 + 0.75 * light) + vec3(shine);
"""


# The run's files.

def run_folder():
    """Where the series lie. In ParaView's window a script does not know its own path."""
    places = [globals().get("__file__", "")] + sys.argv
    try:
        with open("/proc/self/cmdline", encoding="utf-8", errors="surrogateescape") as command:
            places += command.read().split("\0")
    except OSError:
        pass
    folders = [os.path.dirname(os.path.abspath(place)) for place in places if place.endswith(".py")]
    for folder in folders + [os.getcwd(), LEFT_IN]:
        if os.path.exists(os.path.join(folder, "particles.pvd")):
            return folder
    sys.exit("view.py: no particles.pvd beside this script; start it in the folder of a run")


def frame_files(folder, series):
    rows = ET.parse(os.path.join(folder, series + ".pvd")).getroot().iter("DataSet")
    return [(float(row.get("timestep")), os.path.join(folder, row.get("file"))) for row in rows]


def described_arrays(path):
    """What a VTU file says of its arrays, by name: attributes and unit, without their data."""
    arrays = {}
    with open(path, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as text:
        for tag in re.finditer(rb"<DataArray ([^>]*)>", text):
            array = {key.decode(): value.decode()
                     for key, value in re.findall(rb'(\w+)="([^"]*)"', tag[1])}
            end = text.find(b"<DataArray ", tag.end())
            label = re.compile(rb'"UNITS_LABEL"[^>]*>\s*([^<]*?)\s*<').search(
                text, tag.end(), end if end >= 0 else len(text))
            array["unit"] = label[1].decode() if label else "1"
            arrays[array["Name"]] = array
    return arrays


def unit_of(array):
    return array["unit"]


def ranges_over_time(frames, name):
    """(low, high) of the array, of its magnitude for vectors, in every frame."""
    arrays = [described_arrays(path)[name] for _, path in frames]
    return [(float(array.get("RangeMin")), float(array.get("RangeMax"))) for array in arrays]


# What is shown.

def open_series(folder, series):
    return PVDReader(registrationName=series, FileName=os.path.join(folder, series + ".pvd"))


def as_spheres(shown):
    shown.SetRepresentationType("Point Gaussian")
    shown.ShaderPreset = "Custom"
    shown.CustomTriangleScale = 2
    shown.CustomShader = SPHERE


def show_particles(source, view, name, unit, limits, vector):
    shown = Show(source, view)
    as_spheres(shown)
    shown.GaussianRadius = 1.0
    shown.ScaleByArray = 1
    shown.SetScaleArray = ["POINTS", "radius"]
    shown.UseScaleFunction = 0
    ColorBy(shown, ("POINTS", name, "Magnitude") if vector else ("POINTS", name))
    colours = GetColorTransferFunction(name)
    low, high = limits
    span = high - low if high > low else 1
    colours.AutomaticRescaleRangeMode = "Never"
    colours.ColorSpace = "Lab"
    colours.RGBPoints = [part for at, *rgb in COLOURS for part in (low + at * span, *rgb)]
    bar = GetScalarBar(colours, view)
    bar.Title = name if unit == "1" else f"{name} ({unit})"
    bar.ComponentTitle = ""
    bar.Orientation = "Horizontal"
    bar.WindowLocation = "Any Location"
    bar.Position = [0.25, 0.02]
    bar.ScalarBarLength = 0.5
    bar.ScalarBarThickness = 14
    bar.TitleColor = bar.LabelColor = INK
    bar.TitleFontSize = 22
    bar.LabelFontSize = 18
    bar.AutomaticLabelFormat = 0
    bar.LabelFormat = bar.RangeLabelFormat = "%.3g"
    shown.SetScalarBarVisibility(view, True)


def show_surface(source, view):
    shown = Show(source, view)
    shown.SetRepresentationType("Surface")
    ColorBy(shown, None)
    shown.AmbientColor = shown.DiffuseColor = SKIN
    shown.Opacity = 0.2
    shown.SelectNormalArray = "normal"
    shown.Specular = 0.3
    edges = FeatureEdges(registrationName="feature edges",
                         Input=ExtractSurface(registrationName="skin", Input=source))
    edges.FeatureAngle = 50
    edges.Coloring = 0
    lines = Show(edges, view)
    ColorBy(lines, None)
    lines.AmbientColor = lines.DiffuseColor = EDGE
    lines.LineWidth = 2
    lines.Opacity = 0.8


def show_obstacles(source, view):
    shown = Show(source, view)
    shown.SetRepresentationType("Surface")
    ColorBy(shown, None)
    shown.AmbientColor = shown.DiffuseColor = OBSTACLE
    shown.Opacity = 0.6
    shown.SelectNormalArray = "None"


def tubes(bones, name, first, last, radius):
    chosen = Threshold(registrationName=name, Input=bones)
    chosen.Scalars = ["CELLS", "axis"]
    chosen.LowerThreshold, chosen.UpperThreshold = first, last
    lines = ExtractSurface(registrationName=name + " lines", Input=chosen)
    tube = Tube(registrationName=name + " tubes", Input=lines)
    tube.Radius = radius
    tube.NumberofSides = 24
    return tube


def show_bones(source, view, radius):
    bones = Show(tubes(source, "bone", 0, 0, radius), view)
    ColorBy(bones, None)
    bones.AmbientColor = bones.DiffuseColor = BONE
    bones.Ambient, bones.Specular = 0.25, 0.4
    axes = Show(tubes(source, "axes", 1, 3, 1.25 * radius), view)
    ColorBy(axes, ("CELLS", "axis"))
    colours = GetColorTransferFunction("axis")
    colours.InterpretValuesAsCategories = 1
    colours.Annotations = ["1", "x", "2", "y", "3", "z"]
    colours.IndexedColors = RED_GREEN_BLUE
    axes.Ambient, axes.Specular = 0.25, 0.3
    axes.SetScalarBarVisibility(view, False)


def show_heads(source, view, radius):
    """A ball at the head of every bone."""
    shown = Show(source, view)
    as_spheres(shown)
    shown.GaussianRadius = 1.8 * radius
    ColorBy(shown, None)
    shown.AmbientColor = shown.DiffuseColor = INK


def show_time(source, view):
    note = AnnotateTimeFilter(registrationName="time", Input=source)
    note.Format = "t = {time:.3f} s"
    shown = Show(note, view)
    shown.Color = INK
    shown.FontSize = 26
    shown.WindowLocation = "Upper Left Corner"


# The views and their camera.

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


def corners_over_time(source, times, most=16):
    """Corners of the boxes around the source at times spread over the run."""
    step = max(1, math.ceil(len(times) / most))
    corners = []
    for time in times[::step] + [times[-1]]:
        source.UpdatePipeline(time)
        b = source.GetDataInformation().GetBounds()
        corners += [(x, y, z) for x in b[0:2] for y in b[2:4] for z in b[4:6]]
    return corners


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


# What the body may fill of the picture's width and height; the colour bar stands below it.
WIDE, TALL = 0.9, 0.8


def look_at(view, corners, aspect):
    """Three quarters from the front, as near as all corners allow at any time."""
    back = [-0.46, -0.84, 0.29]
    length = math.sqrt(dot(back, back))
    back = [part / length for part in back]
    across = [-back[1], back[0], 0]
    length = math.sqrt(dot(across, across))
    across = [part / length for part in across]
    up = [back[1] * across[2] - back[2] * across[1], back[2] * across[0] - back[0] * across[2],
          back[0] * across[1] - back[1] * across[0]]
    centre = [(min(c[k] for c in corners) + max(c[k] for c in corners)) / 2 for k in range(3)]
    half = math.tan(math.radians(15))
    distance = 0
    for corner in corners:
        way = [c - m for c, m in zip(corner, centre)]
        wide = max(abs(dot(way, up)) / TALL, abs(dot(way, across)) / WIDE / aspect)
        distance = max(distance, dot(way, back) + wide / half)
    low = half * distance * (0.95 - TALL)
    centre = [m - low * part for m, part in zip(centre, up)]
    view.CameraViewAngle = 30
    view.CameraFocalPoint = centre
    view.CameraPosition = [m + distance * part for m, part in zip(centre, back)]
    view.CameraViewUp = up
    view.CenterOfRotation = centre


def arguments():
    parser = argparse.ArgumentParser(prog="view.py", description="Opens this run in ParaView.")
    parser.add_argument("--picture", metavar="FILE.png", help="leave a picture there")
    parser.add_argument("--time", type=float, help="moment of the picture, s")
    parser.add_argument("--array", default="displacement", help="what colours the particles")
    parser.add_argument("--size", type=int, nargs=2, default=[1920, 1000], metavar=("W", "H"))
    return parser.parse_args()


def main():
    options = arguments()
    folder = run_folder()
    frames = frame_files(folder, "particles")
    times = [time for time, _ in frames]
    array = described_arrays(frames[0][1]).get(options.array)
    if array is None:
        sys.exit(f"view.py: the particles have no array '{options.array}'")
    ranges = ranges_over_time(frames, options.array)
    limits = (min(low for low, _ in ranges), max(high for _, high in ranges))

    particles, surface, bones, heads = (open_series(folder, series)
                                        for series in ("particles", "surface", "bones", "frames"))
    layout, left, right = two_views()
    corners = corners_over_time(particles, times)
    size = max(max(c[k] for c in corners) - min(c[k] for c in corners) for k in range(3))
    vector = int(array.get("NumberOfComponents", 1)) > 1
    show_particles(particles, left, options.array, unit_of(array), limits, vector)
    show_time(particles, left)
    show_surface(surface, right)
    show_bones(bones, right, 0.009 * size)
    show_heads(heads, right, 0.009 * size)
    if os.path.exists(os.path.join(folder, "obstacles.pvd")):
        obstacles = open_series(folder, "obstacles")
        for view in (left, right):
            show_obstacles(obstacles, view)
    width, height = options.size
    look_at(left, corners, width / 2 / height)
    look_at(right, corners, width / 2 / height)

    scene = GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    moment = options.time
    if moment is None:
        moment = max(zip(ranges, times), key=lambda entry: entry[0][1])[1]
    scene.AnimationTime = min(times, key=lambda time: abs(time - moment))
    SetActiveView(left)
    SetActiveSource(particles)
    if options.picture:
        layout.SetSize(*options.size)
        SaveScreenshot(options.picture, layout, ImageResolution=options.size, SeparatorWidth=0)
    else:
        RenderAllViews()


main()
