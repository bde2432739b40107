# SPDX-License-Identifier: GPL-3.0-or-later
"""vtk_scene.py SCENE.yaml PICTURE.png: poses a body's bones from Python and draws its surface with VTK."""
import sys

import numpy
import sinew
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

scene, picture = sys.argv[1:]
simulation = sinew.Simulation(sinew.read_scene(scene))
half = numpy.radians(30) / 2
simulation.set_pose({simulation.bones[-1]: (numpy.cos(half), 0, numpy.sin(half), 0)}, over=0.3)
simulation.run_until(0.4)

points, cells, surface = vtk.vtkPoints(), vtk.vtkCellArray(), vtk.vtkPolyData()
points.SetData(numpy_to_vtk(simulation.surface, deep=True))
faces = simulation.faces.astype(numpy.int64)
cells.SetData(3, numpy_to_vtkIdTypeArray(faces.ravel(), deep=True))
surface.SetPoints(points)
surface.SetPolys(cells)
mapper, actor, renderer, window = (vtk.vtkPolyDataMapper(), vtk.vtkActor(), vtk.vtkRenderer(), vtk.vtkRenderWindow())
mapper.SetInputData(surface)
actor.SetMapper(mapper)
actor.GetProperty().SetColor(0.9, 0.75, 0.65)
renderer.AddActor(actor)
renderer.SetBackground(1, 1, 1)
camera = renderer.GetActiveCamera()
camera.SetPosition(0.4, -1, 0.4)
camera.SetViewUp(0, 0, 1)
renderer.ResetCamera()
window.SetOffScreenRendering(1)
window.SetSize(800, 600)
window.AddRenderer(renderer)
window.Render()
shot, writer = vtk.vtkWindowToImageFilter(), vtk.vtkPNGWriter()
shot.SetInput(window)
writer.SetFileName(picture)
writer.SetInputConnection(shot.GetOutputPort())
writer.Write()
