# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of a run: their folder, and the data needed before anything is shown."""
import json
import mmap
import os
import re
import sys

from paraview.simple import *
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from camera import *

LEFT_IN = ""


def stop(what, code=2):
    print(f"{SCRIPT}: {what}", file=sys.stderr)
    sys.exit(code)


def program():
    """The name of the program that runs this."""
    return os.path.basename(os.path.realpath("/proc/self/exe"))


def run_folder():
    """The folder of the series: the one that sinew view names, or that of this script. In ParaView's
    window a script does not know its own path."""
    places = [globals().get("__file__", "")] + sys.argv
    try:
        with open("/proc/self/cmdline", encoding="utf-8", errors="surrogateescape") as command:
            places += command.read().split("\0")
    except OSError:
        pass
    folders = [os.path.dirname(os.path.abspath(place)) for place in places if place.endswith(".py")]
    for folder in [os.environ.get("SINEW_RUN", ""), *folders, os.getcwd(), LEFT_IN]:
        if os.path.exists(os.path.join(folder, "run.json")):
            return folder
        if os.path.exists(os.path.join(folder, "particles.pvd")):
            return folder
    stop("no run beside this script; start it in the folder of a run")


def described_array(path, name):
    """The attributes and the unit of a point array in a VTU file, without its data; its range in all
    pieces. None where there is no such array."""
    with open(path, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as text:
        array = array_at(text, max(0, text.find(b"<PointData")), name)
        if array is None or b"<FieldData" in text[:4096]:  # one piece: the field data come first
            return array
        piece = text.find(b"<PointData", array["end"])
        while piece >= 0:
            other = array_at(text, piece, name)
            (low, high), (least, most) = range_in(array), range_in(other)
            array["RangeMin"], array["RangeMax"] = min(low, least), max(high, most)
            piece = text.find(b"<PointData", other["end"])
        return array


def array_at(text, begin, name):
    """The next one of that name."""
    begin = text.find(b'Name="' + name.encode() + b'"', begin)
    if begin < 0:
        return None
    tag = text[text.rfind(b"<", 0, begin):text.find(b">", begin)]
    array = {key.decode(): value.decode() for key, value in re.findall(rb'(\w+)="([^"]*)"', tag)}
    array["end"] = text.find(b"</DataArray>", begin)
    label = re.search(rb'"UNITS_LABEL"[^>]*>\s*([^<]*?)\s*<', text[max(begin, array["end"] - 4096):array["end"]])
    array["unit"] = label[1].decode() if label else "1"
    return array


def range_in(array):
    """Lowest and highest value; of vectors, of their magnitudes."""
    return float(array.get("RangeMin", 0)), float(array.get("RangeMax", 1))


def origin_of(folder):
    """The point near a body far away, relative to which it is shown; else zero."""
    try:
        with open(os.path.join(folder, "run.json"), encoding="utf-8") as record:
            x, y, z = map(float, json.load(record)["origin"])
        return x, y, z
    except (OSError, ValueError, KeyError, TypeError):
        return 0.0, 0.0, 0.0


def near_body(sources, folder):
    """Sources whose points are relative to the origin of the run: graphics have single precision."""
    x, y, z = origin_of(folder)
    if not (x or y or z):
        return sources
    near = {}
    for name, source in sources.items():
        near[name] = Calculator(registrationName=f"{name}, from the run's origin", Input=source)
        near[name].CoordinateResults = 1
        near[name].Function = f"coords-(({x!r})*iHat+({y!r})*jHat+({z!r})*kHat)"
    return near


def body_at_rest(folder):
    """The bounds, relative to the origin of the run, and the number of its particles."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(os.path.join(folder, "body.vtu"))
    reader.Update()
    bounds, origin = reader.GetOutput().GetBounds(), origin_of(folder)
    return [side - origin[k // 2] for k, side in enumerate(bounds)], reader.GetOutput().GetNumberOfPoints()


class Scene:
    """The data needed before anything is shown."""

    def __init__(self, folder):
        bounds, self.count = body_at_rest(folder)
        self.corners = corners_of(bounds)  # of the boxes around the body at all times
        self.middle, self.size = middle_and_size(self.corners)
        self.array = {}         # attributes of the array shown
        self.skin_has_array = False
        self.limits = (0, 1)    # its lowest and highest value
        self.strongest = 0      # the largest of the forces shown, N
        self.hardest = 0        # the largest force of a support or a load, N
        self.arrows = []        # of these forces


def array_or_stop(path, name):
    array = described_array(path, name)
    if array is None:
        with open(path, "rb") as file:
            named = re.findall(rb'Name="([A-Za-z_]\w*)"', file.read().split(b"<PointData")[-1])
        known = [word.decode() for word in named if word != b"UNITS_LABEL"]
        known = known[:known.index("Points")] if "Points" in known else known
        stop(f"the particles have no array '{name}'; they have {', '.join(known)}")
    return array


def keep_what_has_the_array(scene, sources, name, first):
    """Finds whether the skin has it, and leaves out cells that lack it. `first`: the first frame of a series."""
    scene.skin_has_array = described_array(first("surface"), name) is not None
    if "volume" in sources and not all(described_array(first("volume"), needed) for needed in (name, "displacement")):
        Delete(sources.pop("volume"))


def default_array(path):
    """What deformation looks like, or else motion."""
    return "strain_eq" if described_array(path, "strain_eq") else "displacement"


def is_vector(array):
    return int(array.get("NumberOfComponents", 1)) > 1
