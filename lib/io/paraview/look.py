# SPDX-License-Identifier: GPL-3.0-or-later
"""What view.py and live.py share: a run's files, how its parts look, and from where. CMake puts this
text in the place of their `from look import *`, so that each is one file in a run's folder."""
import argparse
import math
import mmap
import os
import re
import shlex
import sys

import paraview.simple
from paraview.simple import *
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

LEFT_IN = ""

INK = [0.16, 0.18, 0.22]
PAPER_TOP = [0.86, 0.89, 0.93]
PAPER = [0.98, 0.98, 0.99]
SKIN = [0.55, 0.71, 0.86]
EDGE = [0.20, 0.33, 0.47]
BONE = [0.98, 0.93, 0.80]
OBSTACLE = [0.62, 0.60, 0.58]
FORCE = [0.86, 0.30, 0.10]
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
MOST_ARROWS = 1500  # more of them hide each other


# The run's files.

def stop(what):
    sys.exit(f"{SCRIPT}: {what}")


def program():
    """The name of the program that runs this."""
    return os.path.basename(os.path.realpath("/proc/self/exe"))


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
        if os.path.exists(os.path.join(folder, "run.json")):
            return folder
        if os.path.exists(os.path.join(folder, "particles.pvd")):
            return folder
    stop("no run beside this script; start it in the folder of a run")


def described_array(path, name):
    """What a VTU file says of one of its points' arrays: its attributes and its unit, without the
    data. None where there is no such array."""
    with open(path, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as text:
        begin = text.find(b'Name="' + name.encode() + b'"', max(0, text.find(b"<PointData")))
        if begin < 0:
            return None
        tag = text[text.rfind(b"<", 0, begin):text.find(b">", begin)]
        array = {key.decode(): value.decode()
                 for key, value in re.findall(rb'(\w+)="([^"]*)"', tag)}
        end = text.find(b"</DataArray>", begin)
        label = re.search(rb'"UNITS_LABEL"[^>]*>\s*([^<]*?)\s*<', text[max(begin, end - 4096):end])
        array["unit"] = label[1].decode() if label else "1"
        return array


def range_in(array):
    """Lowest and highest value; of vectors, of their magnitudes."""
    return float(array.get("RangeMin", 0)), float(array.get("RangeMax", 1))


def body_at_rest(folder):
    """The bounds and the number of its particles."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(os.path.join(folder, "body.vtu"))
    reader.Update()
    return reader.GetOutput().GetBounds(), reader.GetOutput().GetNumberOfPoints()


class Scene:
    """What must be known before anything is shown."""

    def __init__(self, folder):
        bounds, self.count = body_at_rest(folder)
        self.corners = corners_of(bounds)  # of the boxes around the body at all times
        self.middle, self.size = middle_and_size(self.corners)
        self.array = {}         # what its file says of the array shown
        self.limits = (0, 1)    # its lowest and highest value
        self.strongest = 0      # the largest of the forces shown, N


def array_or_stop(path, name):
    array = described_array(path, name)
    if array is None:
        with open(path, "rb") as file:
            named = re.findall(rb'Name="([A-Za-z_]\w*)"', file.read().split(b"<PointData")[-1])
        known = [word.decode() for word in named if word != b"UNITS_LABEL"]
        known = known[:known.index("Points")] if "Points" in known else known
        stop(f"the particles have no array '{name}'; they have {', '.join(known)}")
    return array


def is_vector(array):
    return int(array.get("NumberOfComponents", 1)) > 1


# What is shown.

def as_spheres(shown):
    shown.SetRepresentationType("Point Gaussian")
    shown.ShaderPreset = "Custom"
    shown.CustomTriangleScale = 2
    shown.CustomShader = SPHERE


def cut_body(source, options, scene):
    """The particles beyond a plane across an axis. It bends with the body, so that the same particles
    are seen at all times. Change the threshold to move it."""
    if options.cut == "none":
        return source
    axis = options.cut.upper()
    place = Calculator(registrationName="place at rest", Input=source)
    place.ResultArrayName = "place at rest"
    place.Function = f"coords{axis}-displacement_{axis}"
    cut = Threshold(registrationName="cut-away body", Input=place)
    cut.Scalars = ["POINTS", "place at rest"]
    cut.ThresholdMethod = "Above Upper Threshold"
    cut.UpperThreshold = scene.middle["XYZ".index(axis)]
    return cut


def spread_colours(colours, low, high):
    span = high - low if high > low else 1
    colours.RGBPoints = [part for at, *rgb in COLOURS for part in (low + at * span, *rgb)]


def colour_table(options, limits):
    """The same colours for the same values at all times."""
    colours = GetColorTransferFunction(options.array)
    colours.AutomaticRescaleRangeMode = "Never"
    colours.ColorSpace = "Lab"
    spread_colours(colours, *limits)
    if options.colours:
        if not colours.ApplyPreset(options.colours, True):
            stop(f"ParaView has no colours '{options.colours}'; its Colour Map Editor lists them")
        colours.RescaleTransferFunction(*limits)
    return colours


def show_particles(source, view, options, array, limits):
    shown = Show(source, view)
    as_spheres(shown)
    shown.GaussianRadius = 1.0
    shown.ScaleByArray = 1
    shown.SetScaleArray = ["POINTS", "radius"]
    shown.UseScaleFunction = 0
    ColorBy(shown, ("POINTS", options.array) + (("Magnitude",) if is_vector(array) else ()))
    bar = GetScalarBar(colour_table(options, limits), view)
    bar.Title = options.array if array["unit"] == "1" else f"{options.array} ({array['unit']})"
    bar.ComponentTitle = ""
    bar.Orientation = "Horizontal"
    bar.WindowLocation = "Any Location"
    bar.Position = [0.25, 0.02]
    bar.ScalarBarLength = 0.5
    bar.ScalarBarThickness = letters(options, 0.014)
    bar.TitleColor = bar.LabelColor = INK
    bar.TitleFontSize, bar.LabelFontSize = letters(options, 0.022), letters(options, 0.018)
    bar.AutomaticLabelFormat = 0
    bar.LabelFormat = bar.RangeLabelFormat = "%.3g"
    shown.SetScalarBarVisibility(view, True)


def letters(options, share):
    """The size of letters in a picture, pixels."""
    return max(9, round(share * options.size[1]))


def show_plain(source, view, colour, opacity=1.0):
    shown = Show(source, view)
    shown.SetRepresentationType("Surface")
    shown.ColorArrayName = ["POINTS", ""]  # ColorBy(shown, None) fails where there are no lines
    shown.AmbientColor = shown.DiffuseColor = colour
    shown.Opacity = opacity
    return shown


def show_surface(source, view):
    shown = show_plain(source, view, SKIN, 0.2)
    shown.SelectNormalArray = "normal"
    shown.Specular = 0.3


def feature_edges(source):
    edges = FeatureEdges(registrationName="feature edges",
                         Input=ExtractSurface(registrationName="skin", Input=source))
    edges.FeatureAngle = 50
    edges.Coloring = 0
    return edges


def show_edges(edges, view, opacity):
    lines = show_plain(edges, view, EDGE, opacity)
    lines.LineWidth = 2


def show_obstacles(source, view):
    show_plain(source, view, OBSTACLE, 0.6).SelectNormalArray = "None"


def tubes(bones, name, first, last, radius):
    chosen = Threshold(registrationName=name, Input=bones)
    chosen.Scalars = ["CELLS", "axis"]
    chosen.LowerThreshold, chosen.UpperThreshold = first, last
    lines = ExtractSurface(registrationName=name + " lines", Input=chosen)
    tube = Tube(registrationName=name + " tubes", Input=lines)
    tube.Radius = radius
    tube.NumberofSides = 24
    return tube


def bone_parts(source, radius):
    """Tubes of the bones, and of their axes."""
    return tubes(source, "bone", 0, 0, radius), tubes(source, "axes", 1, 3, 1.25 * radius)


def show_bones(parts, view):
    bones = show_plain(parts[0], view, BONE)
    bones.Ambient, bones.Specular = 0.25, 0.4
    axes = Show(parts[1], view)
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
    shown.ColorArrayName = ["POINTS", ""]
    shown.AmbientColor = shown.DiffuseColor = INK


def force_arrows(source, scene, name):
    """An arrow at some of the particles; the longest of all times is a fifth of the body."""
    arrows = Glyph(registrationName="force arrows", Input=source, GlyphType="Arrow")
    arrows.OrientationArray = ["POINTS", name]
    arrows.ScaleArray = ["POINTS", name]
    arrows.ScaleFactor = 0.2 * scene.size / scene.strongest if scene.strongest > 0 else 0
    arrows.GlyphMode = "Every Nth Point"
    arrows.Stride = max(1, scene.count // MOST_ARROWS)
    arrows.GlyphType.TipResolution = arrows.GlyphType.ShaftResolution = 12
    arrows.GlyphType.TipRadius, arrows.GlyphType.ShaftRadius = 0.09, 0.03
    return arrows


def show_forces(arrows, view, options, scene):
    show_plain(arrows, view, FORCE)
    note = Text(registrationName="length of arrows")
    note.Text = f"{options.forces}: the longest arrow at any time is {scene.strongest:.3g} N"
    shown = Show(note, view)
    shown.Color = FORCE
    shown.FontSize = letters(options, 0.022)
    shown.WindowLocation = "Lower Center"


def show_time(note, view, options):
    shown = Show(note, view)
    shown.Color = INK
    shown.FontSize = letters(options, 0.026)
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


def corners_of(bounds):
    return [(x, y, z) for x in bounds[0:2] for y in bounds[2:4] for z in bounds[4:6]]


def bounds_of(source):
    return source.GetDataInformation().GetBounds()


def middle_and_size(corners):
    """Of the box around all corners: its middle, and the longest of its sides."""
    low, high = ([pick(corner[k] for corner in corners) for k in range(3)] for pick in (min, max))
    return [(a + b) / 2 for a, b in zip(low, high)], max(b - a for a, b in zip(low, high))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    length = math.sqrt(dot(a, a))
    return [part / length for part in a]


# What the body may fill of the picture's width and height; the colour bar stands below it.
WIDE, TALL = 0.9, 0.8


def look_at(view, corners, back, aspect):
    """From the direction `back`, z up, as near as all corners allow."""
    back = unit(back)
    across = unit([-back[1], back[0], 0]) if back[0] or back[1] else [1, 0, 0]
    up = [back[1] * across[2] - back[2] * across[1], back[2] * across[0] - back[0] * across[2],
          back[0] * across[1] - back[1] * across[0]]
    centre, _ = middle_and_size(corners)
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


def show_all(sources, options, scene):
    """`sources` by the names of their series. Left the cut-away body, right the bones within the
    translucent skin. Returns the layout and its left view."""
    paraview.simple._DisableFirstRenderCameraReset()  # it would undo look_at()
    layout, left, right = two_views()
    show_particles(cut_body(sources["particles"], options, scene), left, options, scene.array,
                   scene.limits)
    edges = feature_edges(sources["surface"])
    show_surface(sources["surface"], right)
    radius = 0.009 * scene.size
    parts = bone_parts(sources["bones"], radius)
    for view, opacity in ((left, 0.35), (right, 0.8)):
        show_edges(edges, view, opacity)
        show_bones(parts, view)
        show_heads(sources["frames"], view, radius)
        if "obstacles" in sources:
            show_obstacles(sources["obstacles"], view)
        look_at(view, scene.corners, options.camera, options.size[0] / 2 / options.size[1])
    arrows = force_arrows(sources["particles"], scene, options.forces or "force_pair")
    if options.forces:
        show_forces(arrows, right, options, scene)
    SetActiveView(left)
    return layout, left


def arguments(description, *more):
    """Of the command line under pvbatch; of the variable SINEW_VIEW in ParaView's window too."""
    parser = argparse.ArgumentParser(prog=SCRIPT, description=description)
    for words, how in more:
        parser.add_argument(*words, **how)
    parser.add_argument("--array", default="displacement", help="what colours the particles")
    parser.add_argument("--range", type=float, nargs=2, metavar=("LOW", "HIGH"),
                        help="values of the lowest and highest colour; all of the run's if not given")
    parser.add_argument("--colours", help="a colour map of ParaView, 'Viridis (matplotlib)'")
    parser.add_argument("--cut", choices=["x", "y", "z", "none"], default="y",
                        help="axis across which the body is cut open")
    parser.add_argument("--forces", nargs="?", const="force_pair", metavar="NAME",
                        help="show arrows of that force, by default force_pair")
    parser.add_argument("--camera", type=float, nargs=3, default=[-0.46, -0.84, 0.29],
                        metavar=("X", "Y", "Z"), help="direction towards the viewer")
    parser.add_argument("--size", type=int, nargs=2, default=[1920, 1000], metavar=("W", "H"))
    words = shlex.split(os.environ.get("SINEW_VIEW", ""))
    if sys.argv and sys.argv[0].endswith(".py"):
        words += sys.argv[1:]
    options = parser.parse_args(words)
    if not any(options.camera):
        stop("a camera needs a direction; give one that is not 0 0 0")
    return options
