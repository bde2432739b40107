#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes pictures/filled.png: three bodies, one end in its skin, the other cut open to the particles.

usage: make_fill_picture.py SINEW      the program build/bin/sinew; needs Debian's python3-vtk9 and a display
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

DATA = Path(__file__).resolve().parent
SKIN, INNER, OUTER = (0.93, 0.80, 0.71), (0.16, 0.36, 0.62), (0.55, 0.75, 0.86)
# body, particle radius (m), the axis along which skin gives way to particles, width of its picture
BODIES = [("arm", 0.0040, 0, 860), ("creature", 0.0055, 0, 640), ("tentacle", 0.0040, 2, 300)]
ACROSS, HEIGHT = 1, 640  # the cut faces us, along y


def filled(sinew, name, radius, folder):
    body = Path(folder) / f"{name}.vtu"
    subprocess.run([sinew, "fill", DATA / f"meshes/{name}.ply", "--radius", str(radius), "-o", body,
                    "--quiet"], check=True, stdout=subprocess.DEVNULL)
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(body))
    reader.Update()
    return reader.GetOutput()


def spheres(body, radius):
    """Colored by what they touch: 12 neighbors within, fewer at the surface."""
    neighbors = vtk_to_numpy(body.GetPointData().GetArray("neighbors"))
    colors = numpy_to_vtk((neighbors == 12).astype("f8"), deep=True)
    points = vtk.vtkPolyData()
    points.SetPoints(body.GetPoints())
    points.GetPointData().SetScalars(colors)
    ball = vtk.vtkSphereSource()
    ball.SetRadius(radius)
    ball.SetThetaResolution(14)
    ball.SetPhiResolution(14)
    mapper = vtk.vtkGlyph3DMapper()
    mapper.SetInputData(points)
    mapper.SetSourceConnection(ball.GetOutputPort())
    mapper.ScalingOff()
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(2)
    table.SetTableValue(0, *OUTER)
    table.SetTableValue(1, *INNER)
    mapper.SetLookupTable(table)
    mapper.SetScalarRange(0, 1)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    return actor


def skin_of(name, axis, middle):
    """What lies before the middle of the axis."""
    reader = vtk.vtkPLYReader()
    reader.SetFileName(str(DATA / f"meshes/{name}.ply"))
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputConnection(reader.GetOutputPort())
    normals.SplittingOff()
    plane = vtk.vtkPlane()
    plane.SetOrigin(middle)
    plane.SetNormal([-1.0 if i == axis else 0.0 for i in range(3)])
    clip = vtk.vtkClipPolyData()
    clip.SetInputConnection(normals.GetOutputPort())
    clip.SetClipFunction(plane)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(clip.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(SKIN)
    return actor


def cut_open(body, axis, middle):
    """Particles beyond the middle of the axis and behind the cut, and some under the skin's rim."""
    points = vtk_to_numpy(body.GetPoints().GetData())
    size = points[:, axis].max() - points[:, axis].min()
    keep = (points[:, ACROSS] >= middle[ACROSS]) & (points[:, axis] > middle[axis] - 0.05 * size)
    half = vtk.vtkUnstructuredGrid()
    places = vtk.vtkPoints()
    places.SetData(numpy_to_vtk(points[keep], deep=True))
    half.SetPoints(places)
    column = numpy_to_vtk(vtk_to_numpy(body.GetPointData().GetArray("neighbors"))[keep], deep=True)
    column.SetName("neighbors")
    half.GetPointData().AddArray(column)
    return half


def aim(camera, middle):
    camera.SetFocalPoint(middle)
    camera.SetPosition(middle[0], middle[1] - 1, middle[2])
    camera.SetViewUp(0, 0, 1)
    camera.Azimuth(-12)
    camera.Elevation(10)
    camera.ParallelProjectionOn()


def picture(body, plan):
    name, radius, axis, width = plan
    bounds = body.GetBounds()
    middle = [(bounds[0] + bounds[1]) / 2, (bounds[2] + bounds[3]) / 2, (bounds[4] + bounds[5]) / 2]
    renderer = vtk.vtkRenderer()
    renderer.AddActor(spheres(cut_open(body, axis, middle), radius))
    renderer.AddActor(skin_of(name, axis, middle))
    renderer.SetBackground(1, 1, 1)
    aim(renderer.GetActiveCamera(), middle)
    renderer.ResetCamera()
    tallest = max((bounds[1] - bounds[0]) * HEIGHT / width, bounds[5] - bounds[4])
    renderer.GetActiveCamera().SetParallelScale(0.56 * tallest)
    occlusion = vtk.vtkSSAOPass()
    occlusion.SetRadius(5 * radius)
    occlusion.SetBias(0.2 * radius)
    occlusion.SetKernelSize(256)
    occlusion.BlurOn()
    occlusion.SetDelegatePass(vtk.vtkRenderStepsPass())
    renderer.SetPass(occlusion)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(2 * width, 2 * HEIGHT)  # drawn twice as large, for smooth edges
    window.AddRenderer(renderer)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    smaller = vtk.vtkImageResize()
    smaller.SetInputConnection(image.GetOutputPort())
    smaller.SetOutputDimensions(width, HEIGHT, 1)
    smaller.Update()
    return smaller.GetOutput()


def main():
    row = vtk.vtkImageAppend()
    with tempfile.TemporaryDirectory() as folder:
        for plan in BODIES:
            row.AddInputData(picture(filled(sys.argv[1], plan[0], plan[1], folder), plan))
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(DATA / "pictures/filled.png"))
    writer.SetInputConnection(row.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()
