#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the pages of the tutorials in lib/examples from their notebooks: NAME.md, and data/pictures/NAME_K.png.

usage: PYTHONPATH=build/python make_tutorials.py       in any folder; needs nbconvert, ipykernel, matplotlib and meshio
"""
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent
EXAMPLES = SOURCE / "lib/examples"
NAMES = ("rubber_block", "muscle_between_bones", "scan_that_bends")


def executed(name, folder, form):
    """The notebook, executed in a copy of its place, as a file of this form."""
    place = folder / "lib/examples"
    place.mkdir(parents=True, exist_ok=True)
    (folder / "data").exists() or (folder / "data").symlink_to(SOURCE / "data")
    shutil.copy(EXAMPLES / f"{name}.ipynb", place)
    subprocess.run([sys.executable, "-m", "nbconvert", "--to", form, "--execute", place / f"{name}.ipynb"], check=True,
                   capture_output=True, text=True, timeout=300)
    return place


def code_of(name):
    """The notebook's cells of code, in order."""
    cells = json.loads((EXAMPLES / f"{name}.ipynb").read_text())["cells"]
    return ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]


def make_page(name):
    with tempfile.TemporaryDirectory() as folder:
        place = executed(name, Path(folder), "markdown")
        page = (place / f"{name}.md").read_text().replace(f"{place}/", "")
        pictures = re.findall(r"!\[png\]\((.*?)\)", page)
        for number, picture in enumerate(pictures):
            shutil.copy(place / picture, SOURCE / f"data/pictures/{name}_{number}.png")
            before = page[:page.index(f"![png]({picture})")]
            title = re.findall(r"^#+ (.*)$", before, re.M)[-1]
            page = page.replace(f"![png]({picture})", f"![{title}](../../data/pictures/{name}_{number}.png)")
    page = re.sub(r"^ *\w+ \[#+\] 100 %$", "", page, flags=re.M)
    page = re.sub(r"[ \t]+$", "", page, flags=re.M)
    page = re.sub(r"\n{3,}", "\n\n", page)
    note = f"The notebook [{name}.ipynb]({name}.ipynb), executed.\n"
    (EXAMPLES / f"{name}.md").write_text(page.replace("\n\n", f"\n\n{note}\n", 1).strip() + "\n")


if __name__ == "__main__":
    for tutorial in NAMES:
        make_page(tutorial)
