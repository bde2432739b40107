# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line options that view.py and live.py share."""
import argparse
import os
import shlex
import sys

from look import *


def arguments(description, *more):
    """From the command line under pvbatch; in ParaView's window also from SINEW_VIEW."""
    parser = argparse.ArgumentParser(prog=SCRIPT, description=description)
    for words, how in more:
        parser.add_argument(*words, **how)
    parser.add_argument("--array", help="array that colors body and skin; by default strain_eq, or displacement "
                        "without it")
    parser.add_argument("--range", type=float, nargs=2, metavar=("LOW", "HIGH"),
                        help="values of the lowest and highest color; by default the range in the run")
    parser.add_argument("--colormap", help="a color map of ParaView, 'Viridis (matplotlib)'")
    parser.add_argument("--cut", choices=["x", "y", "z", "none"], default="y",
                        help="axis across which the body is cut open")
    parser.add_argument("--forces", nargs="?", const="force_pair", metavar="NAME",
                        help="show arrows of that force, by default force_pair")
    parser.add_argument("--camera", type=float, nargs=3, default=[-0.46, -0.84, 0.29],
                        metavar=("X", "Y", "Z"), help="direction toward the viewer")
    parser.add_argument("--size", type=int, nargs=2, default=[1920, 1000], metavar=("W", "H"))
    words = shlex.split(os.environ.get("SINEW_VIEW", ""))
    if sys.argv and sys.argv[0].endswith(".py"):
        words += sys.argv[1:]
    options = parser.parse_args(words)
    if not all(64 <= pixels <= 8192 for pixels in options.size):
        stop("a picture cannot have that size; give 64 to 8192 pixels each way")
    if not any(options.camera):
        stop("a camera needs a direction; give one that is not 0 0 0")
    return options


def end_batch(what, code):
    """Ends the program without its views, whose window the display may have lost by then."""
    print(f"{SCRIPT}: {what}", file=sys.stderr, flush=True)
    os._exit(code)


def save_picture(options, layout):
    """Through a file beside it: ParaView does not tell whether it has written one."""
    part = options.picture + ".part.png"
    SaveScreenshot(part, layout, ImageResolution=options.size, SeparatorWidth=0)
    try:
        os.replace(part, options.picture)
    except OSError as error:
        end_batch(f"{options.picture}: cannot be written ({error.strerror}); choose another place, or free some space", 4)
