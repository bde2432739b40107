#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds the house's arrows: which room of lib and of tools may see which, and which packages, and where.

usage: house_test.py SOURCE_DIR      prints one line per breach, exit code 1 if there is any
"""
import re
import sys
from pathlib import Path

ARROWS = {
    "core": set(), "config": {"core"}, "mesh": {"core"}, "fill": {"core", "mesh"}, "rig": {"core"}, "metrics": {"core"},
    "physics": {"core", "rig"}, "io": {"core", "rig"}, "render": {"core", "rig"},
}
TOOL_ARROWS = {
    "command": set(), "scene": {"command"}, "folder": {"command", "scene"}, "inspect": {"command", "scene"},
    "measure": {"command", "scene", "folder"}, "draw": {"command", "scene", "folder"},
}
# Pattern of an include -> the places that may have it: a room (its .cpp files only) or one file.
HEAVY = {
    r"(CGAL|boost)/": ("mesh", "fill", "metrics"),
    r"vtk\w*\.h": ("io", "render"),
    r"yaml-cpp/": ("config",),
    r"(tbb|oneapi)/": ("core/threads_tbb.cpp",),
    r"nlohmann/": ("io", "metrics"),
    r"(libdeflate|lz4|expat)\.h": ("io",),
    r"X11/": ("render",),
    r"(spdlog|fmt|CLI)/": (),
}
# Pattern of a CMake target -> the rooms that may link it, PRIVATE.
HEAVY_TARGETS = {
    r"CGAL::|Boost::": (),  # CGAL_SOURCES get it
    r"VTK::": ("io", "render"),
    r"yaml-cpp": ("config",),
    r"TBB::": ("core",),
    r"nlohmann_json::": ("io", "metrics"),
    r"^(deflate|lz4|expat)$": ("io",),
    r"X11::": ("render",),
    r"spdlog::|fmt::|CLI11::": (),
}
PARTS = ("SOURCES", "CGAL_SOURCES", "PUBLIC", "PRIVATE", "INTERFACE")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def include_breaches(lib, path):
    name, room = path.relative_to(lib).as_posix(), path.relative_to(lib).parts[0]
    for kind, included in INCLUDE.findall(path.read_text()):
        owner = included.split("/")[0]
        if kind == '"' and not (lib / included).is_file():
            yield f'lib/{name} includes "{included}", which is no file of lib'
        elif kind == '"' and owner not in ARROWS[room] | {room}:
            yield f"lib/{name} includes {included}: {room} must not see {owner}"
        elif kind == "<" and owner in ARROWS:
            yield f'lib/{name} includes <{included}>; files of lib are included with ""'
        for pattern, places in HEAVY.items():
            if not re.match(pattern, included):
                continue
            if name not in places and (room not in places or path.suffix == ".h"):
                yield f"lib/{name} includes {included}, which belongs in .cpp files of {places}"


def used_rooms(lib, room):
    for path in (lib / room).rglob("*"):
        if path.suffix in (".h", ".cpp"):
            for kind, included in INCLUDE.findall(path.read_text()):
                owner = included.split("/")[0]
                if kind == '"' and owner != room:
                    yield owner


def link_breaches(lib, room):
    text = re.sub(r"#.*", "", (lib / room / "CMakeLists.txt").read_text())
    calls = re.findall(r"sinew_library\(([^)]*)\)", text)
    others = re.findall(r"(?:target_link_libraries|link_libraries)\(([^)]*)\)", text)
    linked = set()
    for call in calls + others:
        part = ""
        for word in call.split():
            part = word if word in PARTS else part
            if word.startswith("sinew::"):
                linked.add(word.removeprefix("sinew::"))
            for pattern, rooms in HEAVY_TARGETS.items():
                if not part.endswith("SOURCES") and re.search(pattern, word):
                    if room not in rooms or part != "PRIVATE":
                        yield f"lib/{room}/CMakeLists.txt links {word} as {part or 'plain'}"
    for other in linked - ARROWS[room]:
        yield f"lib/{room}/CMakeLists.txt links sinew::{other}: {room} must not see {other}"
    for other in set(used_rooms(lib, room)) - linked:
        yield f"lib/{room} includes {other} without linking sinew::{other}"


def rounding_breaches(lib, room):
    """CGAL needs compile options of its own, which no other source may get."""
    text = (lib / room / "CMakeLists.txt").read_text()
    own = re.search(r"CGAL_SOURCES([^)A-Z]*)", text)
    own = own.group(1).split() if own else []
    for path in sorted((lib / room).rglob("*.cpp")):
        name = path.relative_to(lib / room).as_posix()
        uses = re.search(r"#include <CGAL/", path.read_text()) is not None
        if uses != (name in own):
            yield f"lib/{room}/{name}: files that include CGAL, and no others, are CGAL_SOURCES"


def tool_breaches(tools, path):
    name, room = path.relative_to(tools).as_posix(), path.relative_to(tools).parts[0]
    if room not in TOOL_ARROWS:
        yield f"tools/{room} is a room without arrows: add it to this test"
        return
    for kind, included in INCLUDE.findall(path.read_text()):
        owner = included.split("/")[0]
        if kind == '"' and owner in TOOL_ARROWS.keys() - TOOL_ARROWS[room] - {room}:
            yield f"tools/{name} includes {included}: {room} must not see {owner}"


def license_breaches(source, path):
    head = path.read_text().split("\n")[:2]
    line = head[1] if head[0].startswith("#!") and len(head) > 1 else head[0]
    if not re.fullmatch(r"(//|#) SPDX-License-Identifier: GPL-3\.0-or-later", line):
        yield f"{path.relative_to(source)} does not begin with the SPDX line"


def source_files(source):
    for folder in ("lib", "tools", "tests"):
        for path in sorted((source / folder).rglob("*")):
            if path.suffix in (".h", ".cpp", ".py", ".sh", ".js"):
                yield path


def breaches(source):
    lib = source / "lib"
    for room in sorted(path.name for path in lib.iterdir() if path.is_dir()):
        if room not in ARROWS:
            yield f"lib/{room} is a room without arrows: add it to this test"
            continue
        yield from link_breaches(lib, room)
        yield from rounding_breaches(lib, room)
        for path in sorted((lib / room).rglob("*")):
            if path.suffix in (".h", ".cpp", ".in"):
                yield from include_breaches(lib, path)
    for path in sorted((source / "tools").glob("*/*.[ch]*")):
        yield from tool_breaches(source / "tools", path)
    for path in source_files(source):
        yield from license_breaches(source, path)


def main():
    found = list(breaches(Path(sys.argv[1]).resolve()))
    print("\n".join(found) or "the house is in order")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
