# SPDX-License-Identifier: GPL-3.0-or-later
"""What all parts of the plugin share: errors in ParaView's window, arrays, composites, times."""
import contextlib

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkMultiBlockDataSet
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline


class Refused(Exception):
    """What a user has to mend, in words."""


@contextlib.contextmanager
def errors_shown(algorithm):
    """Shows what is refused in ParaView's window of messages."""
    try:
        yield
    except (Refused, MemoryError) as refused:
        what = "memory is not enough; take fewer points or neighbors" if isinstance(refused, MemoryError) else refused
        vtkOutputWindow.GetInstance().DisplayErrorText(f"ERROR: {type(algorithm).__name__}: {what}\n")


def package(name):
    """The Python package sinew, where it can be imported and has that name; else None."""
    try:
        import sinew
        return sinew if hasattr(sinew, name) else None
    except ImportError:
        return None


def vtk_array(name, values, kind=None):
    array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=1, array_type=kind)
    array.SetName(name)
    return array


def texts(name, values):
    array = vtkStringArray()
    array.SetName(name)
    for value in values:
        array.InsertNextValue(str(value))
    return array


def leaves(data):
    """The data sets in a composite, or the one."""
    if not isinstance(data, vtkCompositeDataSet):
        return [data]
    found, at = [], data.NewIterator()
    at.InitTraversal()
    while not at.IsDoneWithTraversal():
        found.append(at.GetCurrentDataObject())
        at.GoToNextItem()
    return found


def block_named(data, name):
    """The data set of that name in a composite; None: there is none."""
    if isinstance(data, vtkMultiBlockDataSet):
        for i in range(data.GetNumberOfBlocks()):
            if data.HasMetaData(i) and data.GetMetaData(i).Get(vtkCompositeDataSet.NAME()) == name:
                return data.GetBlock(i)
    return None


def requested_time(info):
    key = vtkStreamingDemandDrivenPipeline.UPDATE_TIME_STEP()
    return info.Get(key) if info.Has(key) else None


def ask_for_times(algorithm):
    """Makes the window ask a reader for its times again: of a live source, ParaView reads only the data again. Does nothing
    where the reader is on a server."""
    from paraview.modules.vtkRemotingServerManager import vtkSMProxyIterator, vtkSMProxyManager
    session = vtkSMProxyManager.GetProxyManager().GetActiveSession()
    if not session:
        return
    at = vtkSMProxyIterator()
    at.SetSession(session)
    at.SetModeToOneGroup()
    at.Begin("sources")
    while not at.IsAtEnd():
        if at.GetProxy().GetClientSideObject() is algorithm:
            at.GetProxy().UpdatePipelineInformation()
        at.Next()


def rescale_colors(array, low, high):
    """Gives the colors of an array other ends. Does nothing where the source is on a server, or nothing has these colors."""
    from paraview.modules.vtkRemotingServerManager import vtkSMProxyManager
    from paraview.modules.vtkRemotingViews import vtkSMTransferFunctionProxy
    proxies = vtkSMProxyManager.GetProxyManager().GetActiveSessionProxyManager()
    colors = proxies and proxies.GetProxy("lookup_tables", f"{array}.PVLookupTable")
    if colors:
        vtkSMTransferFunctionProxy.RescaleTransferFunction(colors, low, high, False)


def updated_to(inInfo, producer, port, time):
    """Updates what an input comes from to a time, in the pieces that are asked for. Refused where it fails."""
    keys, info = vtkStreamingDemandDrivenPipeline, inInfo.GetInformationObject(0)
    info.Set(keys.UPDATE_TIME_STEP(), time)
    if not producer.GetExecutive().Update(port):
        raise Refused(f"what the input comes from cannot be read at the time {time:g}")


def publish_times(info, times):
    keys = vtkStreamingDemandDrivenPipeline
    info.Remove(keys.TIME_STEPS())
    info.Remove(keys.TIME_RANGE())
    for time in times:
        info.Append(keys.TIME_STEPS(), time)
    if len(times):
        info.Append(keys.TIME_RANGE(), times[0])
        info.Append(keys.TIME_RANGE(), times[-1])


def flagged(attributes, number, bits):
    """Which of so many cells or points are flagged so (as copies of another piece's, or hidden)."""
    flags = attributes.GetArray("vtkGhostType")
    return vtk_to_numpy(flags) & bits != 0 if flags else numpy.zeros(number, bool)
