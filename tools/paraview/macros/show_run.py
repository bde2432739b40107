# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows the run that is selected in the pipeline: particles with their true radii, the skin, the bones.

A macro of ParaView: Macros > Import New Macro. Select what the reader Sinew Run has opened, and start it.
"""
import json

from paraview.simple import *

SKIN, BONES, OBSTACLES = [0.55, 0.71, 0.86], [0.98, 0.93, 0.80], [0.62, 0.60, 0.58]
SPHERE = """//VTK::Color::Impl
float outside = dot(offsetVCVSOutput.xy, offsetVCVSOutput.xy);
if (outside > 1.0) { discard; }
vec3 normal = vec3(offsetVCVSOutput.xy, sqrt(1.0 - outside));
float light = 0.3 + 0.7 * max(dot(normal, normalize(vec3(-0.35, 0.50, 0.79))), 0.0);
ambientColor = ambientColor * light;
diffuseColor = diffuseColor * light;
"""


def part(run, name):
    found = ExtractBlock(registrationName=name, Input=run, Selectors=[f"/Root/{name}"])
    with open(run.FileName, encoding="utf-8") as record:
        origin = json.load(record).get("origin")
    if origin:  # a body far away: spheres have single precision
        found = Calculator(registrationName=f"{name}, from the run's origin", Input=found)
        found.CoordinateResults = 1
        found.Function = "coords-(({!r})*iHat+({!r})*jHat+({!r})*kHat)".format(*origin)
    found.UpdatePipeline()
    return found


def times_of(run):
    """ParaView has a number where there is one time, and nothing where there is none."""
    times = run.TimestepValues
    return list(times) if hasattr(times, "__len__") and len(times) else [times or 0]


def range_over_time(source, name, times):
    """Of three moments: a run may have thousands."""
    spans = []
    for time in {times[0], times[len(times) // 2], times[-1]}:
        source.UpdatePipeline(time)
        spans.append(source.PointData.GetArray(name).GetRange())
    return min(span[0] for span in spans), max(span[1] for span in spans)


def color_by_first_of(shown, source, names, times):
    """The first of these arrays that there is, in a scale for the whole run."""
    for name in names:
        if source.PointData.GetArray(name):
            ColorBy(shown, ("POINTS", name))
            GetColorTransferFunction(name).RescaleTransferFunction(*range_over_time(source, name, times))
            shown.SetScalarBarVisibility(GetActiveView(), True)
            return


def as_spheres(shown):
    """Of the array radius."""
    shown.SetRepresentationType("Point Gaussian")
    shown.ShaderPreset = "Custom"
    shown.CustomTriangleScale = 2
    shown.CustomShader = SPHERE
    shown.ScaleByArray = 1
    shown.SetScaleArray = ["POINTS", "radius"]
    shown.UseScaleFunction = 0
    shown.GaussianRadius = 1


def show_particles(run, view):
    particles = part(run, "particles")
    shown = Show(particles, view)
    as_spheres(shown)
    color_by_first_of(shown, particles, ("strain_eq", "bone"), times_of(run))


def show_surface(run, view, color, name, opacity):
    shown = Show(part(run, name), view)
    shown.SetRepresentationType("Surface")
    ColorBy(shown, None)
    shown.DiffuseColor = shown.AmbientColor = color
    shown.Opacity = opacity


def show_bones(run, view):
    shown = Show(part(run, "bones"), view)
    shown.SetRepresentationType("Wireframe")
    ColorBy(shown, None)
    shown.DiffuseColor = shown.AmbientColor = BONES
    shown.LineWidth = 5
    shown.RenderLinesAsTubes = 1


def show_run(run=None, view=None):
    """Extracts the series of a run, and shows each as it looks best."""
    run = run or GetActiveSource()
    if run is None or run.GetXMLName() != "SinewRun":
        raise RuntimeError("select a run of sinew in the pipeline first; File > Open its run.json")
    view = view or GetActiveViewOrCreate("RenderView")
    run.UpdatePipeline()
    names = [name for name in run.Series.GetAvailable() if name in run.Series.GetData()]
    Hide(run, view)
    if "particles" in names:
        show_particles(run, view)
    if "surface" in names:
        show_surface(run, view, SKIN, "surface", 0.2)
    if "obstacles" in names:
        show_surface(run, view, OBSTACLES, "obstacles", 1)
    if "bones" in names:
        show_bones(run, view)
    GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
    view.ResetCamera()
    Render(view)


if __name__ in ("__main__", "__vtkconsole__"):
    show_run()
