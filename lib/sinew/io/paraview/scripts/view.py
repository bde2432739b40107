# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens this run in ParaView.

    paraview view.py                             in the window
    pvbatch view.py --picture out.png            a picture of the most deformed frame
    pvbatch view.py --picture out.png --time 1   of that moment (s)
    pvbatch view.py --help                       all options

Left the body, cut open and colored by one array: its cells, if the run has the series volume, or
particles as spheres of their true size. Right the bones with their x, y, z axes in red, green, blue
inside the translucent surface, in the same colors where it has the array. In the window, options
stand in the variable SINEW_VIEW: SINEW_VIEW="--array velocity --forces" paraview view.py
"""
import xml.etree.ElementTree as ET

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from options import *

SCRIPT = "view.py"


def frame_files(folder, series):
    rows = ET.parse(os.path.join(folder, series + ".pvd")).getroot().iter("DataSet")
    return [(float(row.get("timestep")), os.path.join(folder, row.get("file"))) for row in rows]


def open_series(folder):
    names = ["particles", "surface", "bones", "frames"]
    for name in ("volume", "obstacles", "supports"):
        if os.path.exists(os.path.join(folder, name + ".pvd")):
            names.append(name)
    return {name: PVDReader(registrationName=name, FileName=os.path.join(folder, name + ".pvd"))
            for name in names}


def ranges_over_time(frames, name):
    """(low, high) in every frame."""
    return [range_in(array_or_stop(path, name)) for _, path in frames]


def limits_of(ranges):
    return min(low for low, _ in ranges), max(high for _, high in ranges)


def color_ranges(frames, name, most=12):
    """(low, high, time) without the hundredth of the values farthest out at each end, spread over the run."""
    found = []
    for time, path in frames[::max(1, math.ceil(len(frames) / most))] + [frames[-1]]:
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(path)
        reader.Update()
        values = vtk_to_numpy(reader.GetOutput().GetPointData().GetArray(name)).astype(float)
        values = numpy.linalg.norm(values, axis=1) if values.ndim > 1 else values
        low, high = numpy.nanpercentile(values, [1, 99])
        found.append((low, high, time))
    return found


def color_limits(ranges):
    low, high = limits_of([(low, high) for low, high, _ in ranges])
    return (0 if 0 <= low < 0.25 * high else low), high


def corners_over_time(source, times, most=16):
    """Corners of the boxes around the source at times spread over the run."""
    step = max(1, math.ceil(len(times) / most))
    corners = []
    for time in times[::step] + [times[-1]]:
        source.UpdatePipeline(time)
        corners += corners_of(bounds_of(source))
    return corners


def tips_over_time(source, times, scene, most=16):
    """The ends of the arrows of supports and loads at times spread over the run."""
    tips = []
    for time in times[::max(1, math.ceil(len(times) / most))] + [times[-1]]:
        source.UpdatePipeline(time)
        shown = servermanager.Fetch(source)
        force = shown.GetPointData().GetArray("force")
        for i in range(shown.GetNumberOfPoints()):
            tips.append([place + arrow_scale(scene) * along
                         for place, along in zip(shown.GetPoint(i), force.GetTuple(i))])
    return tips


def time_note(source):
    note = AnnotateTimeFilter(registrationName="time", Input=source)
    note.Format = "t = {time:.3f} s"
    return note


def scene_of(folder, frames, sources, options):
    """The scene of a run, and the time at which the array is largest. Drops sources that are not shown."""
    scene = Scene(folder)
    options.array = options.array or default_array(frames[0][1])
    scene.array = array_or_stop(frames[0][1], options.array)
    keep_what_has_the_array(scene, sources, options.array, lambda series: frame_files(folder, series)[0][1])
    ranges = color_ranges(frames, options.array)
    scene.limits = options.range or color_limits(ranges)
    scene.strongest = limits_of(ranges_over_time(frames, options.forces or "force_pair"))[1]
    if "supports" in sources:
        files = [path for _, path in frame_files(folder, "supports")]
        scene.hardest = max(range_in(described_array(path, "force"))[1] for path in files)
    times = [time for time, _ in frames]
    scene.corners += corners_over_time(sources["particles"], times)
    _, scene.size = middle_and_size(scene.corners)
    if "supports" in sources:
        scene.corners += tips_over_time(sources["supports"], times, scene)
    return scene, max(ranges, key=lambda entry: entry[1])[2]


def main():
    options = arguments("Opens this run in ParaView.",
                        (["--picture"], {"metavar": "FILE.png", "help": "write a picture to this file"}),
                        (["--time"], {"type": float, "help": "time of the picture, s"}))
    folder = run_folder()
    frames = frame_files(folder, "particles")
    if not frames:
        stop("the run has no frames yet; live.py follows it")
    sources = near_body(open_series(folder), folder)
    scene, moment = scene_of(folder, frames, sources, options)
    layout, left = show_all(sources, options, scene)
    show_time(time_note(sources["particles"]), left, options)
    SetActiveSource(sources["particles"])

    animation = GetAnimationScene()
    animation.UpdateAnimationUsingDataTimeSteps()
    moment = moment if options.time is None else options.time
    animation.AnimationTime = min((time for time, _ in frames), key=lambda t: abs(t - moment))
    if options.picture:
        layout.SetSize(*options.size)
        save_picture(options, layout)
    else:
        RenderAllViews()


main()
