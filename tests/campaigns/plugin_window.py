# SPDX-License-Identifier: GPL-3.0-or-later
"""Shown by plugin_window.sh: a run by the macro of the reader, beside it a filled sphere that is cut open."""
import os
import sys

from paraview.simple import *

sys.path.append(os.environ["SINEW_MACROS"])
import show_run

run = OpenDataFile(os.environ["SINEW_RUN"])
show_run.show_run(run)
view = GetActiveView()
sphere = Sphere(registrationName="sphere", Center=[0.75, 0, 0.3], Radius=0.2, ThetaResolution=60, PhiResolution=60)
packing = ClosestPacking(registrationName="packing", Input=sphere, Radius=0.012)
half = Threshold(registrationName="half", Input=Calculator(Input=packing, ResultArrayName="y", Function="coordsY"),
                 Scalars=["POINTS", "y"], LowerThreshold=0, UpperThreshold=1)
shown = Show(half, view)
shown.SetRepresentationType("Point Gaussian")
shown.GaussianRadius = 0.012
ColorBy(shown, ("POINTS", "neighbors"))
Hide(packing, view)
SetActiveSource(packing)
GetAnimationScene().AnimationTime = 1
view.ResetActiveCameraToPositiveY()
view.ResetCamera()
view.CameraViewUp = [0, 0, 1]
Render(view)
