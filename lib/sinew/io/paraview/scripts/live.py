# SPDX-License-Identifier: GPL-3.0-or-later
"""Follows a run in progress in ParaView: shows the newest frame as soon as it is written.

    paraview live.py                                        in the window
    pvbatch live.py --frames 10 --picture out.png           the next ten frames, and a picture
    pvbatch live.py --help                                  all options

The layout is that of view.py. New frame files, which a run writes atomically, are looked for ten
times a second. The ranges of colors and forces grow with the run. Of a run that has ended it shows
the last frame; view.py shows all of them.
"""
import json
import time
import types

from options import *

SCRIPT = "live.py"
SERIES = ["particles", "surface", "bones", "frames"]


class Follower:
    """Finds the newest frame that all series have, and reads it."""

    def __init__(self, folder, options):
        self.folder, self.options = folder, options
        self.series = list(SERIES)
        self.number = self.ranged = -1
        self.shown = {}
        self.limits = None
        self.hardest = 0
        self.scene = None
        self.wait_for_first()
        self.series += [series for series in ("volume", "obstacles", "supports") if os.path.exists(self.path(series, 0))]

    def path(self, series, number):
        return os.path.join(self.folder, series, f"{series}_{number:06d}.vtu")

    def complete(self, number):
        return all(os.path.exists(self.path(series, number)) for series in self.series)

    def wait_for_first(self):
        end = time.monotonic() + self.options.patience
        while self.newest() < 0:
            if self.ended() and self.newest() < 0:
                stop("the run has ended without a frame; its run.json and log.txt tell why")
            if time.monotonic() > end:
                stop(f"no frame within {self.options.patience:g} s; start the run first")
            time.sleep(0.1)

    def newest(self):
        """Number of the newest frame; starts over for a restarted run."""
        if self.number >= 0 and not self.complete(self.number):
            self.number = self.ranged = -1
        while self.complete(self.number + 1):
            self.number += 1
        return self.number

    def ended(self):
        """Whether its record says that no frame will come any more."""
        try:
            with open(os.path.join(self.folder, "run.json"), encoding="utf-8") as record:
                return json.load(record)["status"] != "running"
        except (OSError, ValueError, KeyError, TypeError):
            return False

    def stamp(self, series):
        status = os.stat(self.path(series, self.number))
        return self.number, status.st_ino, status.st_mtime_ns

    def has_news(self, series):
        """Called by ParaView's window, ten times a second for each source."""
        try:
            if self.newest() < 0 or self.shown.get(series) == self.stamp(series):
                return False
            if series == "particles":
                self.grow_colors()
        except OSError:  # a restarted run removes its files
            return False
        return True

    def read(self, series, output):
        try:
            stamp = self.stamp(series)
        except OSError:
            return
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(self.path(series, self.number))
        reader.Update()
        output.ShallowCopy(reader.GetOutput())
        self.shown[series] = stamp

    def grow_limits(self):
        """Includes the frames since the last call; returns whether that changed the limits."""
        before = self.limits
        for number in range(self.ranged + 1, self.number + 1):
            low, high = range_in(array_or_stop(self.path("particles", number), self.options.array))
            old = self.limits or (low, high)
            self.limits = min(low, old[0]), max(high, old[1])
            if "supports" in self.series:
                force = described_array(self.path("supports", number), "force")
                self.hardest = max(self.hardest, range_in(force)[1])
        self.ranged = self.number
        return self.limits != before

    def grow_colors(self):
        if self.grow_limits() and not self.options.range:
            colors = GetColorTransferFunction(self.options.array)
            colors.RescaleTransferFunction(*self.limits)
        if self.scene and self.scene.hardest != self.hardest:
            self.scene.hardest = self.hardest
            resize_arrows(self.scene)


def live_source(series):
    """Its script is run separately and imports the follower as a Python module."""
    source = LiveProgrammableSource(registrationName=series)
    source.OutputDataSetType = "vtkUnstructuredGrid"
    find = "import sinew_live\n"
    source.Script = f"{find}sinew_live.follower.read({series!r}, self.GetOutput())"
    source.ScriptCheckNeedsUpdate = (
        f"{find}self.SetNeedsUpdate(sinew_live.follower.has_news({series!r}))")
    return source


def time_note(source):
    note = AnnotateGlobalData(registrationName="time", Input=source)
    note.SelectArrays = "TimeValue"
    note.Prefix, note.Suffix, note.Format = "t = ", " s", "%.3f"
    return note


def scene_of(folder, follower, sources, options):
    scene = Scene(folder)
    newest = follower.path("particles", follower.number)
    options.array = options.array or default_array(newest)
    scene.array = array_or_stop(newest, options.array)
    keep_what_has_the_array(scene, sources, options.array, lambda series: follower.path(series, follower.number))
    follower.grow_limits()
    scene.limits = options.range or follower.limits
    scene.hardest = follower.hardest
    follower.scene = scene
    scene.strongest = range_in(array_or_stop(newest, options.forces or "force_pair"))[1]
    scene.corners += roomier(scene)
    return scene


def roomier(scene):
    """A box around the body at rest with space to bend: its motion is not yet known."""
    reach = 0.6 * scene.size
    return [tuple(m + math.copysign(min(reach, 3 * abs(c - m)), c - m)
                  for c, m in zip(corner, scene.middle)) for corner in scene.corners]


def refresh(sources):
    for source in sources.values():
        source.GetClientSideObject().Modified()
        source.MarkModified(source.SMProxy)
    RenderAllViews()


def follow_in_batch(follower, sources, options):
    """Updates the sources, as the window does otherwise; prints a line per frame. Returns what went
    wrong, or nothing."""
    RenderAllViews()
    shown = 1
    print(f"frame {follower.shown['particles'][0]}", flush=True)
    end = time.monotonic() + options.patience
    while shown < options.frames:
        ended = follower.ended()
        if not follower.has_news("particles"):
            if ended:
                print(f"the run has ended, {shown} shown; view.py shows all of it", flush=True)
                return None
            if time.monotonic() > end:
                return f"no further frame within {options.patience:g} s, {shown} shown"
            time.sleep(0.02)
            continue
        refresh(sources)
        shown += 1
        end = time.monotonic() + options.patience
        print(f"frame {follower.shown['particles'][0]}", flush=True)
    return None


def main():
    options = arguments(
        "Follows a run in progress.",
        (["--frames"], {"type": int, "default": 1, "help": "number of frames, under pvbatch"}),
        (["--patience"], {"type": float, "default": 60, "help": "how long to wait for a frame, s"}),
        (["--picture"], {"metavar": "FILE.png", "help": "write a picture of the last one"}))
    folder = run_folder()
    global follower
    follower = Follower(folder, options)
    readers = {series: live_source(series) for series in follower.series}
    sources = near_body(readers, folder)
    layout, left = show_all(sources, options, scene_of(folder, follower, sources, options))
    show_time(time_note(sources["particles"]), left, options)
    SetActiveSource(sources["particles"])
    if "pvbatch" not in program() and "pvpython" not in program():
        RenderAllViews()
        return
    layout.SetSize(*options.size)
    wrong = follow_in_batch(follower, readers, options)
    if options.picture:
        save_picture(options, layout)
    if wrong:
        end_batch(wrong, 2)


def moved(thing, module):
    """A function or class of this script with the names of the module in place of its own."""
    if isinstance(thing, types.FunctionType):
        made = types.FunctionType(thing.__code__, module.__dict__, thing.__name__, thing.__defaults__, thing.__closure__)
        made.__kwdefaults__ = thing.__kwdefaults__
        return made
    if isinstance(thing, type) and thing.__module__ == __name__:
        parts = {name: moved(part, module) for name, part in thing.__dict__.items()
                 if name not in ("__dict__", "__weakref__")}
        return type(thing.__name__, thing.__bases__, parts)
    return thing


def main_in_a_module():
    """Moves what this script defines into the module sinew_live: ParaView runs the script of a source in the main
    module, and imports numpy's max, dot and others there."""
    module = sys.modules["sinew_live"] = types.ModuleType("sinew_live")
    for name, thing in list(globals().items()):
        if not name.startswith("__"):
            own = isinstance(thing, (types.FunctionType, type)) and thing.__module__ == __name__
            setattr(module, name, moved(thing, module) if own else thing)
    module.main()


main_in_a_module()
