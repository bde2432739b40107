# SPDX-License-Identifier: GPL-3.0-or-later
"""Lets Debian 12's ParaView load plugins in Python: it asks for a function that Python 3.11 no longer has.

PYTHONPATH=FOLDER-OF-THIS-FILE paraview; the package sinew-paraview needs no such word.
"""
import inspect

if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec
