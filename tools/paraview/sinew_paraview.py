# SPDX-License-Identifier: GPL-3.0-or-later
"""sinew in ParaView: a reader of whole runs, a reader of their tables, and the filters Closest Packing and Deformation.

Tools > Manage Plugins > Load New, or PV_PLUGIN_PATH=FOLDER-OF-THIS-FILE; for pvpython LoadPlugin(FILE, ns=globals()).
Needs ParaView 5.11 or later with its Python. Particles are found by the package sinew (python3-sinew), or where that
cannot be imported by the command sinew through files.
"""
import contextlib
import inspect
import os
import sys

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

if not hasattr(inspect, "getargspec"):  # which ParaView 5.11 takes from Python, and Python 3.11 no longer has
    inspect.getargspec = inspect.getfullargspec

from paraview.util.vtkAlgorithm import smdomain, smhint, smproperty, smproxy
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkDataArraySelection
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkDataObject, vtkMultiBlockDataSet, vtkTable, vtkUnstructuredGrid
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

if os.path.dirname(os.path.abspath(__file__)) not in sys.path:
    sys.path.append(os.path.dirname(os.path.abspath(__file__)))
from sinew_parts import deformation, packing, run_files
from sinew_parts.common import Refused, ask_for_times, errors_shown, publish_times, requested_time, rescale_colors, texts, updated_to, vtk_array


def choice(name, words, default=0):
    entries = "".join(f'<Entry text="{word}" value="{i}"/>' for i, word in enumerate(words))
    return smproperty.xml(f'<IntVectorProperty name="{name}" command="Set{name}" number_of_elements="1" '
                          f'default_values="{default}"><EnumerationDomain name="enum">{entries}</EnumerationDomain>'
                          "</IntVectorProperty>")


@smproxy.reader(name="SinewRun", label="Sinew Run", extensions="json", file_description="Run of sinew (run.json)")
@smhint.xml('<LiveSource interval="1000" /><ReaderFactory extensions="json" file_description="Run of sinew (run.json)" />')
class SinewRun(VTKPythonAlgorithmBase):
    """All series of a run as one composite: a named block for each. While the run goes on, its frames are added."""

    def __init__(self):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkMultiBlockDataSet")
        self._file, self._series, self._seen = None, [], None
        self._arrays, self._blocks = vtkDataArraySelection(), vtkDataArraySelection()
        for selection in (self._arrays, self._blocks):
            selection.AddObserver("ModifiedEvent", lambda *_: self.Modified())

    @smproperty.stringvector(name="FileName")
    @smdomain.filelist()
    @smhint.filechooser(extensions="json", file_description="Run of sinew (run.json)")
    def SetFileName(self, name):
        if name != self._file:
            self._file, self._seen = name, None
            self.Modified()

    @smproperty.doublevector(name="TimestepValues", information_only="1", si_class="vtkSITimeStepsProperty")
    def GetTimestepValues(self):
        with contextlib.suppress(Refused):
            self._open()
            return self._times()
        return []

    @smproperty.dataarrayselection(name="Series")
    def GetSeries(self):
        return self._blocks

    @smproperty.dataarrayselection(name="Arrays")
    def GetArrays(self):
        return self._arrays

    def _state(self):
        return run_files.state_of(run_files.folder_of_run(self._file))

    def _open(self):
        state = self._state()
        if state == self._seen:
            return
        self._series = run_files.open_series(state[0])
        for one in self._series:
            one.choose(self._arrays)
            if not self._blocks.ArrayExists(one.name):
                self._blocks.AddArray(one.name)
        self._seen = state

    def _times(self):
        return sorted({time for one in self._series for time, _ in one.rows})

    def GetNeedsUpdate(self):
        """Whether there are new frames; ParaView asks every second."""
        with contextlib.suppress(Refused, OSError):
            if self._seen is not None and self._state() != self._seen:
                self.Modified()
                ask_for_times(self)
                return True
        return False

    def RequestInformation(self, request, inInfo, outInfo):
        with errors_shown(self):
            self._open()
            publish_times(outInfo.GetInformationObject(0), self._times())
        return 1

    def RequestData(self, request, inInfo, outInfo):
        output = vtkMultiBlockDataSet.GetData(outInfo, 0)
        with errors_shown(self):
            self._open()
            times = self._times()
            time = requested_time(outInfo.GetInformationObject(0))
            if time is None:
                time = times[0] if times else 0
            wanted = [one for one in self._series if self._blocks.ArrayIsEnabled(one.name)]
            for index, one in enumerate(wanted):
                output.SetBlock(index, one.at(time, self._arrays))
                output.GetMetaData(index).Set(vtkCompositeDataSet.NAME(), one.name)
            output.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), time)
        return 1


@smproxy.source(name="SinewSeries", label="Sinew Series")
@smhint.xml('<LiveSource interval="500" />')
class SinewSeries(VTKPythonAlgorithmBase):
    """The newest frame of one series of a run, as soon as it is written: what `sinew view --live` shows. What is mere rounding
    is zero. An array of vectors may be given as arrows, of which the largest so far has a length; the colors of an array may
    grow with it. All sources of a run have the same moment, which goes on with that of its particles."""
    _moments = {}

    def __init__(self):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkUnstructuredGrid")
        self._file, self._name, self._vectors, self._length, self._largest = None, "", "", 0.0, 0.0
        self._colors, self._range, self._fixed = "", (0.0, 0.0), False
        self._seen = self._shown = None

    @smproperty.stringvector(name="FileName")
    @smdomain.filelist()
    @smhint.filechooser(extensions="json", file_description="Run of sinew (run.json)")
    def SetFileName(self, name):
        self._file = name
        self.Modified()

    @smproperty.stringvector(name="Series", default_values="particles")
    def SetSeries(self, name):
        self._name = name
        self.Modified()

    @smproperty.stringvector(name="Vectors", default_values="")
    def SetVectors(self, name):
        self._vectors = name or ""
        self.Modified()

    @smproperty.doublevector(name="ArrowLength", default_values=0.0)
    def SetArrowLength(self, length):
        self._length = length
        self.Modified()

    @smproperty.stringvector(name="Colors", default_values="")
    def SetColors(self, name):
        self._colors = name or ""
        self.Modified()

    @smproperty.doublevector(name="ColorRange", default_values=[0.0, 0.0])
    def SetColorRange(self, low, high):
        self._range = low, high
        self.Modified()

    @smproperty.intvector(name="FixedRange", default_values=0)
    def SetFixedRange(self, fixed):
        self._fixed = bool(fixed)
        self.Modified()

    def GetNeedsUpdate(self):
        """Whether there are new frames; ParaView asks twice a second."""
        with contextlib.suppress(Refused):
            if self._moment(self._name == "particles") != self._shown:
                self.Modified()
                return True
        return False

    def _moment(self, goes_on):
        folder = run_files.folder_of_run(self._file)
        state = run_files.state_of(folder)
        if folder not in self._moments or (goes_on and state != self._seen):
            self._moments[folder], self._seen = run_files.newest_time(folder), state
        return self._moments[folder]

    def RequestData(self, request, inInfo, outInfo):
        with errors_shown(self):
            self._shown = self._moment(False)
            found = run_files.whole_frame(run_files.folder_of_run(self._file), self._name, self._shown)
            if found is None:  # a run that begins anew removes its files
                return 1
            run_files.without_rounding(found)
            self._add_arrows(found.GetPointData())
            self._grow_colors(found.GetPointData())
            vtkUnstructuredGrid.GetData(outInfo, 0).ShallowCopy(found)
        return 1

    def _add_arrows(self, arrays):
        vectors = arrays.GetArray(self._vectors)
        if vectors:
            values = vtk_to_numpy(vectors).astype(float)
            self._largest = max(self._largest, numpy.linalg.norm(values, axis=1).max(initial=0))
            arrays.AddArray(vtk_array("arrow", values * (self._length / self._largest if self._largest else 0)))

    def _grow_colors(self, arrays):
        """To all but half a percent of the values at each end, unless a range was asked for."""
        if self._fixed:
            rescale_colors(self._colors, *self._range)
            return
        array = arrays.GetArray(self._colors)
        if array and array.GetNumberOfValues():
            values = vtk_to_numpy(array).astype(float)
            values = numpy.linalg.norm(values, axis=1) if values.ndim > 1 else values
            low, high = numpy.nanpercentile(values, [0.5, 99.5])
            known = self._range if self._range[0] < self._range[1] else (low, high)
            low, high = min(low, known[0]), max(high, known[1])
            self._range = 0 if 0 <= low < 0.5 * high else low, high
            if self._range[0] < high:
                rescale_colors(self._colors, *self._range)


@smproxy.source(name="SinewTables", label="Sinew Tables")
@smhint.xml('<LiveSource interval="1000" />')
class SinewTables(VTKPythonAlgorithmBase):
    """A table of a run, a row for each time, to be plotted over its column time: metrics, bones, supports or probes."""

    def __init__(self):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkTable")
        self._file, self._table, self._seen = None, 0, None

    @smproperty.xml('<Property name="Reload" command="Modified" panel_widget="command_button" />')
    def Reload(self):
        self.Modified()

    @smproperty.stringvector(name="FileName")
    @smdomain.filelist()
    @smhint.filechooser(extensions="json", file_description="Run of sinew (run.json)")
    def SetFileName(self, name):
        self._file = name
        self.Modified()

    @smproperty.xml('<IntVectorProperty name="Table" command="SetTable" number_of_elements="1" default_values="0">'
                    '<EnumerationDomain name="enum">' +
                    "".join(f'<Entry text="{name}" value="{i}"/>' for i, name in enumerate(run_files.TABLES)) +
                    "</EnumerationDomain></IntVectorProperty>")
    def SetTable(self, table):
        self._table = table
        self.Modified()

    def _path(self):
        return os.path.join(run_files.folder_of_run(self._file), f"{run_files.TABLES[self._table]}.csv")

    def GetNeedsUpdate(self):
        """Whether the file has changed; ParaView asks every second."""
        with contextlib.suppress(Refused):
            if self._seen is not None and run_files.time_of(self._path()) != self._seen:
                self.Modified()
                return True
        return False

    def RequestData(self, request, inInfo, outInfo):
        output = vtkTable.GetData(outInfo, 0)
        with errors_shown(self):
            self._seen = run_files.time_of(self._path())
            table = run_files.table_of(self._path())
            columns = output.GetRowData()
            columns.AllocateArrays(len(table))
            for label, values in table.items():
                column = texts(None, values) if isinstance(values, list) else vtk_array(None, values)
                columns.AddArray(column)  # which compares names with all there are
                column.SetName(label)
        return 1


@smproxy.filter(name="ClosestPacking", label="Closest Packing")
@smhint.xml('<ShowInMenu category="sinew" />')
@smproperty.input(name="Input", port_index=0)
@smdomain.datatype(dataTypes=["vtkDataObject"], composite_data_supported=True)
@smproperty.xml('<OutputPort index="0" name="Packing" /><OutputPort index="1" name="Diagnosis" />')
class ClosestPacking(VTKPythonAlgorithmBase):
    """Fills any surface with closest-packed particles, or with tetrahedra between them.

    Port 1 has the mesh with its defects: 1 open edge, 2 crowded edge, 3 twisted edge, 4 turned face, 5 intersecting
    face, 6 flat face."""

    def __init__(self):
        super().__init__(nInputPorts=1, nOutputPorts=2, outputType="vtkUnstructuredGrid")
        self._values = {"Radius": 0.0, "Count": 0, "CloseHoles": 0, "Packing": 0, "NestedShells": 0, "Output": 0,
                        "Rotation": (0.0, 0.0, 0.0)}

    def _set(self, name, value):
        if self._values[name] != value:
            self._values[name] = value
            self.Modified()

    @smproperty.doublevector(name="Radius", default_values=0.0)
    def SetRadius(self, radius):
        """Of the particles, in the units of the mesh; 0: by Count."""
        self._set("Radius", radius)

    @smproperty.intvector(name="Count", default_values=0)
    def SetCount(self, count):
        self._set("Count", count)

    @smproperty.xml('<IntVectorProperty name="CloseHoles" command="SetCloseHoles" number_of_elements="1" default_values="0">'
                    '<BooleanDomain name="bool"/></IntVectorProperty>')
    def SetCloseHoles(self, close):
        self._set("CloseHoles", close)

    @choice("Packing", packing.PACKINGS)
    def SetPacking(self, lattice):
        self._set("Packing", lattice)

    @smproperty.doublevector(name="Rotation", default_values=[0.0, 0.0, 0.0])
    def SetRotation(self, x, y, z):
        """Of the packing about its x, then y, then z axis, in degrees."""
        self._set("Rotation", (x, y, z))

    @choice("NestedShells", packing.RULES)
    def SetNestedShells(self, rule):
        self._set("NestedShells", rule)

    @choice("Output", ("particles", "tetrahedra"))
    def SetOutput(self, output):
        self._set("Output", output)

    def FillInputPortInformation(self, port, info):
        info.Set(self.INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject")
        return 1

    def _size(self):
        radius, count = self._values["Radius"], self._values["Count"]
        if radius and count:
            raise Refused("the size of the particles is given twice; set Radius or Count to 0")
        if not radius and not count:
            raise Refused("the size of the particles is not given; set Radius, or Count to about how many there shall be")
        return {"radius": radius} if radius else {"count": count}

    def _preparation(self):
        """Options for reading the mesh."""
        options = {"close_holes": True} if self._values["CloseHoles"] else {}
        return {**options, "rule": packing.RULES[1]} if self._values["NestedShells"] else options

    def _placement(self):
        options = {"packing": packing.PACKINGS[self._values["Packing"]]} if self._values["Packing"] else {}
        return {**options, "lattice_rotation": list(self._values["Rotation"])} if any(self._values["Rotation"]) else options

    def RequestData(self, request, inInfo, outInfo):
        with errors_shown(self):
            mesh, told = packing.polygons_of(vtkDataObject.GetData(inInfo[0], 0))
            by = packing.engine()
            defects, found, warnings = by.diagnose(mesh, self._preparation())
            output = vtkUnstructuredGrid.GetData(outInfo, 1)
            output.ShallowCopy(defects)
            packing.add_findings(output, found, [*told, *warnings], by.name)
            options = {**self._size(), **self._preparation(), **self._placement()}
            filled, report, warnings = by.fill(mesh, options, self._values["Output"] == 1)
            output = vtkUnstructuredGrid.GetData(outInfo, 0)
            output.ShallowCopy(filled)
            packing.add_findings(output, report, [*told, *warnings], by.name)
        return 1


@smproxy.filter(name="Deformation", label="Deformation")
@smhint.xml('<ShowInMenu category="sinew" />')
@smproperty.input(name="Reference", port_index=1, multiple_input=False, clean_command="RemoveReference",
                  none_string="ReferenceTime of the input")
@smdomain.datatype(dataTypes=["vtkDataObject"], composite_data_supported=True)
@smproperty.input(name="Input", port_index=0)
@smdomain.datatype(dataTypes=["vtkDataObject"], composite_data_supported=True)
class Deformation(VTKPythonAlgorithmBase):
    """Deformation of any points between two moments, by least squares over the neighbors at the first: F (row by row),
    J, strain (Green-Lagrange), stretch (principal), strain_eq, D2min (mean of |dx - F dX|^2), R and its angle, rotation
    (degrees). The first moment is ReferenceTime of the input, or the second input. Points are matched by ids."""

    def __init__(self):
        super().__init__(nInputPorts=2, nOutputPorts=1, outputType="vtkUnstructuredGrid")
        self._reference_time, self._cutoff, self._id_array = 0.0, 0.0, ""
        self._kept, self._stamp = None, None

    @smproperty.doublevector(name="ReferenceTime", default_values=0.0)
    def SetReferenceTime(self, time):
        self._reference_time = time
        self.Modified()

    @smproperty.doublevector(name="Cutoff", default_values=0.0)
    def SetCutoff(self, cutoff):
        """Points closer than this at rest are neighbors; 0: 2.4 radii of particles that touch, of other points 1.2 times
        the usual distance of the twelfth nearest."""
        self._cutoff = cutoff
        self.Modified()

    @smproperty.stringvector(name="IdArray", default_values="")
    def SetIdArray(self, name):
        """The array that tells points apart; empty: one of the usual names (id, particle_id, GlobalIds)."""
        self._id_array = name or ""
        self.Modified()

    def FillInputPortInformation(self, port, info):
        info.Set(self.INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject")
        if port == 1:
            info.Set(self.INPUT_IS_OPTIONAL(), 1)
        return 1

    def RemoveReference(self):
        """What ParaView calls before it sets another Reference, or none."""
        self.RemoveAllInputConnections(1)

    def RequestUpdateExtent(self, request, inInfo, outInfo):
        """The wanted moment of both inputs: they may have one source, which has one moment at a time."""
        for port in (0, 1):
            if inInfo[port].GetNumberOfInformationObjects() and self._wanted(inInfo[port], outInfo) is not None:
                source = inInfo[port].GetInformationObject(0)
                source.Set(vtkStreamingDemandDrivenPipeline.UPDATE_TIME_STEP(), self._wanted(inInfo[port], outInfo))
        return 1

    @staticmethod
    def _wanted(inInfo, outInfo):
        """The moment asked for, or the first one; None: the input has one moment."""
        keys, source = vtkStreamingDemandDrivenPipeline, inInfo.GetInformationObject(0)
        if not source.Has(keys.TIME_STEPS()) or not source.Length(keys.TIME_STEPS()):
            return None
        asked = requested_time(outInfo.GetInformationObject(0))
        return source.Get(keys.TIME_STEPS(), 0) if asked is None else asked

    def RequestData(self, request, inInfo, outInfo):
        with errors_shown(self):
            rest = self._rest(inInfo, outInfo)
            deformation.add_deformation(vtkUnstructuredGrid.GetData(outInfo, 0), rest, vtkDataObject.GetData(inInfo[0], 0),
                                        self._cutoff, self._id_array)
        return 1

    def _rest(self, inInfo, outInfo):
        """The points at rest, kept until something upstream changes. Where they are not, their source is updated to their
        moment, and the input back to the wanted one: in rounds of this filter's own, VTK would ask anew without end where
        an input fails."""
        port = 1 if inInfo[1].GetNumberOfInformationObjects() else 0
        timed = self._wanted(inInfo[port], outInfo) is not None
        if port == 0 and not timed:
            raise Refused("the input has one moment; give the moment at rest as the second input, Reference")
        producer, index = self.GetInputAlgorithm(port, 0), self.GetInputConnection(port, 0).GetIndex()
        stamp = (producer, index, self.GetInputExecutive(port, 0).GetPipelineMTime(), self._reference_time, self._id_array)
        if self._kept is not None and self._stamp == stamp:
            return self._kept
        self._stamp = None
        try:
            if timed:
                updated_to(inInfo[port], producer, index, self._reference_time)
            found = deformation.Rest(vtkDataObject.GetData(inInfo[port], 0), self._id_array)
        finally:
            wanted = self._wanted(inInfo[0], outInfo)
            if wanted is not None and timed:
                connection = self.GetInputConnection(0, 0)
                updated_to(inInfo[0], connection.GetProducer(), connection.GetIndex(), wanted)
        if self._kept is None or not self._kept.is_like(found):
            self._kept = found
        self._stamp = stamp
        return self._kept
