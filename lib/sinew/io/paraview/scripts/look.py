# SPDX-License-Identifier: GPL-3.0-or-later
"""Representations and colors of the parts of a run."""
import ctypes
import time

import paraview.simple
import vtkmodules.vtkRenderingOpenGL2
from paraview.simple import *
from vtkmodules.vtkRenderingCore import vtkRenderWindow

from run_files import *

SKIN = [0.55, 0.71, 0.86]
EDGE = [0.20, 0.33, 0.47]
BONE = [0.98, 0.93, 0.80]
OBSTACLE = [0.62, 0.60, 0.58]
FORCE = [0.86, 0.30, 0.10]
RED_GREEN_BLUE = [0.88, 0.15, 0.17, 0.13, 0.62, 0.24, 0.13, 0.36, 0.92]
# Lightness increases with the value, and the lowest color still shows the spheres' shading.
COLORS = [(0.0, 0.27, 0.33, 0.62), (0.25, 0.17, 0.52, 0.70), (0.5, 0.25, 0.71, 0.60),
           (0.75, 0.67, 0.83, 0.38), (1.0, 0.99, 0.84, 0.22)]
# A sphere lit from the upper left on each splat; fragments outside its outline are discarded.
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
MOST_ARROWS = 1500  # more would hide each other
SKIN_OPACITY, BARE_SKIN_OPACITY = 0.45, 0.2  # bones shine through
LIGHT = 0.35, 0.75  # ambient and diffuse: what is seen at an angle still has the colors of the scale
CREASE = 40  # degrees: flatter edges of the body are shaded smoothly


def as_spheres(shown):
    shown.SetRepresentationType("Point Gaussian")
    shown.ShaderPreset = "Custom"
    shown.CustomTriangleScale = 2
    shown.CustomShader = SPHERE


def place_at_rest(name, source, options):
    """Along the axis of the cut."""
    axis = options.cut.upper()
    place = Calculator(registrationName=name, Input=source)
    place.ResultArrayName = "place at rest"
    place.Function = f"coords{axis}-displacement_{axis}"
    return place


def middle_of_cut(options, scene):
    return scene.middle["xyz".index(options.cut)]


def cut_particles(source, options, scene, name):
    """The particles beyond a plane across an axis. It deforms with the body, so that the same
    particles are seen at all times. Change the threshold to move it."""
    if options.cut == "none":
        return source
    cut = Threshold(registrationName=name, Input=place_at_rest("place at rest", source, options))
    cut.Scalars = ["POINTS", "place at rest"]
    cut.ThresholdMethod = "Above Upper Threshold"
    cut.UpperThreshold = middle_of_cut(options, scene)
    return cut


def cut_cells(source, options, scene):
    """The surface of the same part of the body, by its cells, without torn ones."""
    body = Threshold(registrationName="untorn cells", Input=source)
    body.Scalars = ["CELLS", "torn"]
    body.LowerThreshold = body.UpperThreshold = 0
    if options.cut != "none":
        body = Clip(registrationName="cut-away body", Input=place_at_rest("place of cells at rest", body, options))
        body.ClipType = "Scalar"
        body.Scalars = ["POINTS", "place at rest"]
        body.Value = middle_of_cut(options, scene)
        body.Invert = 0
    outside = ExtractSurface(registrationName="outside of the body", Input=body)
    smooth = GenerateSurfaceNormals(registrationName="smooth body", Input=outside)
    smooth.FeatureAngle = CREASE
    return smooth


def spread_colors(colors, low, high):
    span = high - low if high > low else 1
    colors.RGBPoints = [part for at, *rgb in COLORS for part in (low + at * span, *rgb)]


def color_table(options, limits):
    """The same colors for the same values at all times."""
    colors = GetColorTransferFunction(options.array)
    colors.AutomaticRescaleRangeMode = "Never"
    colors.ColorSpace = "Lab"
    colors.NanColor = [0.62, 0.62, 0.62]  # gray, which is no color of the scale: no value here
    spread_colors(colors, *limits)
    if options.colormap:
        if not colors.ApplyPreset(options.colormap, True):
            stop(f"ParaView has no color map '{options.colormap}'; its Color Map Editor lists them")
        colors.RescaleTransferFunction(*limits)
    return colors


def color_by_array(shown, options, scene):
    ColorBy(shown, ("POINTS", options.array) + (("Magnitude",) if is_vector(scene.array) else ()))
    color_table(options, scene.limits)


def show_particles(source, view, options, scene):
    shown = Show(source, view)
    as_spheres(shown)
    shown.GaussianRadius = 1.0
    shown.ScaleByArray = 1
    shown.SetScaleArray = ["POINTS", "radius"]
    shown.UseScaleFunction = 0
    color_by_array(shown, options, scene)


def show_cells(source, view, options, scene):
    shown = Show(source, view)
    shown.SetRepresentationType("Surface")
    shown.Ambient, shown.Diffuse = LIGHT
    color_by_array(shown, options, scene)


def show_color_bar(source, view, options, scene):
    bar = GetScalarBar(color_table(options, scene.limits), view)
    bar.Title = f"{plain_name(options.array)} ({scene.array['unit']})"
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
    GetDisplayProperties(source, view).SetScalarBarVisibility(view, True)


def plain_name(array):
    return "equivalent strain" if array == "strain_eq" else array.replace("_", " ")


def letters(options, share):
    """The font size in a picture, pixels."""
    return max(9, round(share * options.size[1]))


def show_plain(source, view, color, opacity=1.0):
    shown = Show(source, view)
    shown.SetRepresentationType("Surface")
    shown.ColorArrayName = ["POINTS", ""]  # ColorBy(shown, None) fails where there are no lines
    shown.AmbientColor = shown.DiffuseColor = color
    shown.Opacity = opacity
    return shown


def show_surface(source, view, options, scene):
    """In the colors of the body, where the surface has the array. Bones shine through it."""
    shown = show_plain(source, view, SKIN, SKIN_OPACITY if scene.skin_has_array else BARE_SKIN_OPACITY)
    if scene.skin_has_array:
        shown.Ambient, shown.Diffuse = LIGHT
        color_by_array(shown, options, scene)
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


def arrow_scale(scene):
    """Of the arrows of supports and loads, m/N."""
    return 0.2 * scene.size / scene.hardest if scene.hardest > 0 else 0


def resize_arrows(scene):
    for arrows in scene.arrows:
        arrows.ScaleFactor = arrow_scale(scene)


def show_supports(source, view, scene):
    """An arrow for the force of each support (dark) and load (red) on the body, at the middle of its
    part; the longest at any time is a fifth of the body."""
    for name, load, color in (("supports", 0, INK), ("loads", 1, FORCE)):
        chosen = Threshold(registrationName=name, Input=source)
        chosen.Scalars = ["POINTS", "load"]
        chosen.LowerThreshold = chosen.UpperThreshold = load
        arrows = Glyph(registrationName=name + " arrows", Input=chosen, GlyphType="Arrow")
        arrows.OrientationArray = ["POINTS", "force"]
        arrows.ScaleArray = ["POINTS", "force"]
        arrows.ScaleFactor = arrow_scale(scene)
        scene.arrows.append(arrows)
        arrows.GlyphMode = "All Points"
        arrows.GlyphType.TipResolution = arrows.GlyphType.ShaftResolution = 24
        show_plain(arrows, view, color)


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


def has_cells(source):
    source.UpdatePipeline()
    return source.GetDataInformation().GetNumberOfCells() > 0


def show_bones(parts, view):
    bones = show_plain(parts[0], view, BONE)
    bones.Ambient, bones.Specular = 0.25, 0.4
    axes = Show(parts[1], view)
    ColorBy(axes, ("CELLS", "axis"))
    colors = GetColorTransferFunction("axis")
    colors.InterpretValuesAsCategories = 1
    colors.Annotations = ["1", "x", "2", "y", "3", "z"]
    colors.IndexedColors = RED_GREEN_BLUE
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
    """Arrows at some of the particles; the longest at any time is a fifth of the body."""
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


def need_screen():
    """Without one, a render window of X aborts the whole program. The connection stays open: xvfb-run's
    server starts over when its last client leaves, and a program that comes back then finds none."""
    if vtkRenderWindow().GetClassName() != "vtkXOpenGLRenderWindow":
        return
    try:
        open_display = ctypes.CDLL("libX11.so.6").XOpenDisplay
    except OSError:
        return
    open_display.restype = ctypes.c_void_p
    end = time.monotonic() + 3
    while not open_display(None):
        if not os.environ.get("DISPLAY") or time.monotonic() > end:
            break
        time.sleep(0.1)
    else:
        return
    stop(f"there is no screen; draw without one by: xvfb-run -a pvbatch {SCRIPT} --picture FILE.png")


def show_body(sources, view, options, scene):
    """By its cells, if the run has them, and the particles hidden; or else by these."""
    has_cells = "volume" in sources
    shown = cut_particles(sources["particles"], options, scene,
                          "cut-away particles" if has_cells else "cut-away body")
    show_particles(shown, view, options, scene)
    if has_cells:
        Hide(shown, view)
        shown = cut_cells(sources["volume"], options, scene)
        show_cells(shown, view, options, scene)
    show_color_bar(shown, view, options, scene)


def show_all(sources, options, scene):
    """`sources` by the names of their series. Left: the body cut open; right: the bones inside the
    translucent skin. Returns the layout and its left view."""
    need_screen()
    paraview.simple._DisableFirstRenderCameraReset()  # it would undo look_at()
    layout, left, right = two_views()
    show_body(sources, left, options, scene)
    edges = feature_edges(sources["surface"])
    show_surface(sources["surface"], right, options, scene)
    radius = 0.009 * scene.size
    parts = bone_parts(sources["bones"], radius)
    for view, opacity in ((left, 0.35), (right, 0.8)):
        show_edges(edges, view, opacity)
        if has_cells(sources["bones"]):  # a body in a testing machine may have none
            show_bones(parts, view)
            show_heads(sources["frames"], view, radius)
        if "obstacles" in sources:
            show_obstacles(sources["obstacles"], view)
        if "supports" in sources:
            show_supports(sources["supports"], view, scene)
        look_at(view, scene.corners, options.camera, options.size[0] / 2 / options.size[1])
    arrows = force_arrows(sources["particles"], scene, options.forces or "force_pair")
    if options.forces:
        show_forces(arrows, right, options, scene)
    SetActiveView(left)
    return layout, left
