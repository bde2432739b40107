# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows the run that is selected in the pipeline by its state, view.pvsm, wherever its folder is now.

A macro of ParaView: Macros > Import New Macro. Select what the reader Sinew Run has opened, and start it. It opens what lies
in the folder, as File > Load State does; `sinew view` writes the state anew instead.
"""
import os

from paraview.simple import *


def show_run(run=None):
    run = run or GetActiveSource()
    if run is None or run.GetXMLName() != "SinewRun":
        raise RuntimeError("select a run of sinew in the pipeline first; File > Open its run.json")
    folder = os.path.dirname(os.path.abspath(run.FileName))
    state = os.path.join(folder, "view.pvsm")
    if not os.path.isfile(state):
        raise RuntimeError(f"{state} is not there: the run has no frames yet; or write it by: sinew view {folder}")
    LoadState(state, data_directory=folder)


if __name__ in ("__main__", "__vtkconsole__"):
    show_run()
