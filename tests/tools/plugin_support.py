# SPDX-License-Identifier: GPL-3.0-or-later
"""ParaView with the plugin loaded, for its tests: to be imported whole in a script of pvbatch that is called with the folder
of the programs and the folder of the project. SINEW_MODULE names the folder of the Python package.
"""
import os
import sys
from pathlib import Path

BIN, SOURCE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
MODULE = os.environ.get("SINEW_MODULE")
if MODULE:
    sys.path.insert(0, MODULE)
os.environ["SINEW"] = str(BIN / "sinew")
sys.path[:0] = [str(SOURCE / "tools/paraview"), str(SOURCE / "tests/tools")]

import numpy
import sinew_paraview  # mends Python 3.11 for ParaView 5.11, which otherwise loads no plugin in Python
from paraview import servermanager
from paraview.simple import *
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkIOGeometry import vtkSTLWriter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from small_run import SmallRun
from small_run import sinew as command

LoadPlugin(sinew_paraview.__file__, ns=globals())


def fetched(source, time=None, port=0):
    source.UpdatePipeline(time) if time is not None else source.UpdatePipeline()
    return servermanager.Fetch(source, idx=port)


def blocks(data):
    return {data.GetMetaData(i).Get(data.NAME()): data.GetBlock(i) for i in range(data.GetNumberOfBlocks())}


def points(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def arrays(data):
    """Of numbers, by name."""
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays()) if data.GetArray(i)}


def read(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def field(data, name):
    array = data.GetFieldData().GetAbstractArray(name)
    return array.GetValue(0) if array and array.GetNumberOfValues() else None


class Messages:
    """What ParaView's window of messages would show."""

    def __enter__(self):
        self.window, self.before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
        vtkOutputWindow.SetInstance(self.window)
        return self

    def __exit__(self, *_):
        vtkOutputWindow.SetInstance(self.before)
        self.text = self.window.GetOutput()
