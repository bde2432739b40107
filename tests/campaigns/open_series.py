#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens every series of the runs in a folder with ParaView, at each of its times.

usage: tests/tools/paraview.sh PRIVATE_FOLDER tests/campaigns/open_series.py FOLDER
"""
import sys
from pathlib import Path

from paraview import simple


def main():
    files = sorted(Path(sys.argv[1]).rglob("*.pvd"))
    frames = 0
    for file in files:
        reader = simple.PVDReader(FileName=str(file))
        times = list(reader.TimestepValues or [])
        assert times == sorted(set(times)), file
        for time in times:
            reader.UpdatePipeline(time)
            assert reader.GetDataInformation().GetNumberOfPoints() > 0, (file, time)
            frames += 1
        simple.Delete(reader)
    print(f"{len(files)} series, {frames} frames opened")
    assert files


if __name__ == "__main__":
    main()
