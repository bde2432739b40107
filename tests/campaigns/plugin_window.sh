#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# plugin_window.sh PICTURE.png RUN: ParaView's window with the plugin, as a user sees it: loaded by PV_PLUGIN_PATH, a run
# opened, a surface filled. RUN is the folder of a run of configs/box_bend.yaml. libqt5svg5 gives the window its icons.
set -euo pipefail

picture=$(realpath -m "${1:?usage: plugin_window.sh PICTURE.png RUN}")
run=$(realpath "${2:?usage: plugin_window.sh PICTURE.png RUN}")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
PYTHONPATH=$PWD/tools/paraview/debian12:$PWD/build/paraview-python/usr/lib/python3/dist-packages:$PWD/build/python
export PYTHONPATH PV_PLUGIN_PATH=$PWD/tools/paraview SINEW=$PWD/build/bin/sinew
export SINEW_RUN=$run/run.json SINEW_MACROS=$PWD/tools/paraview/macros
tests/campaigns/screenshot.sh "$picture" paraview --script=tests/campaigns/plugin_window.py
# The window is smaller than the display.
ffmpeg -y -loglevel error -i "$picture" -vf crop=1152:762:0:0 "$picture.window.png"
mv "$picture.window.png" "$picture"
