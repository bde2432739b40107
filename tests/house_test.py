#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds the house in order: which room of lib may see which, which packages, and where; the size of files and
functions; words that the code has given up.

usage: house_test.py SOURCE_DIR      prints one line per breach, exit code 1 if there is any
"""
import re
import statistics
import sys
from pathlib import Path

ARROWS = {
    "core": set(), "settings": {"core"}, "mesh": {"core"}, "repair": {"core", "mesh"}, "fill": {"core", "mesh"}, "rig": {"core"},
    "volume": {"core", "mesh", "fill", "rig"},
    "metrics": {"core", "rig", "material", "body"}, "io": {"core", "rig"}, "render": {"core"}, "display": {"core"}, "vtk": {"core"},
    "material": {"core"}, "body": {"core", "rig", "material"}, "world": {"core", "rig", "material", "body"},
    "analysis": {"core", "rig", "material", "body", "world"}, "kernel": set(),
    "lists": {"core", "rig", "material", "body", "world", "kernel"},
    "groups": {"core", "rig", "material", "body", "world", "kernel", "lists"},
    "stepping": {"core", "rig", "material", "body", "world", "analysis", "kernel", "lists", "groups"},
    "engine": {"core", "rig", "material", "body", "world"},
    "lammps": {"core", "rig", "material", "body", "world", "engine", "io"},
    "scene": {"core", "settings", "mesh", "repair", "fill", "volume", "rig", "material", "body", "world", "analysis", "kernel", "groups",
              "stepping", "io"},
    "run": {"core", "settings", "mesh", "repair", "fill", "volume", "rig", "material", "body", "world", "stepping", "engine", "io", "scene",
            "metrics"},
    "inspection": {"core", "settings", "mesh", "repair", "fill", "rig", "material", "body", "world", "analysis", "kernel", "groups", "stepping", "io",
                   "scene", "run"},
    "figures": {"core", "settings", "volume", "rig", "material", "body", "world", "io", "scene", "metrics", "render", "run"},
    "study": {"core", "settings", "mesh", "repair", "io", "scene", "metrics", "run"},
    "play": {"core", "settings", "mesh", "rig", "material", "body", "world", "stepping", "scene", "metrics", "run"},
}
# Rooms whose headers are not installed -> those that are.
INTERNAL = {"kernel": ("instruction_set.h",), "lists": ("list_counts.h",), "lammps": (),
            "groups": ("bone_assemblies.h", "kept_free.h", "make_grouping.h", "static_groups.h")}
# Pattern of an include -> the places that may have it: a room (its .cpp files only) or one file.
HEAVY = {
    r"CGAL/": ("mesh", "repair", "fill", "volume"),
    r"boost/": ("mesh", "repair", "fill", "volume", "study/sweep/design.cpp", "play/server.cpp"),
    r"vtk\w*\.h": ("render", "vtk", "render/detail/shapes.h", "vtk/data_sets.h"),
    r"yaml-cpp/": ("settings",),
    r"(tbb|oneapi)/": ("core/threads_tbb.cpp",),
    r"nlohmann/json\.hpp": ("core/json.cpp", "io", "metrics", "scene", "run", "inspection", "study", "play", "run/detail/run_log.h"),
    r"(libdeflate|lz4|expat|meshoptimizer)\.h|draco/": ("io",),
    r"X11/": ("display",),
    r"(lammps|fmt)/": ("lammps", "lammps/lammps_headers.h"),
    r"mpi\.h": ("lammps",),
    r"CLI/": (),
}
# Pattern of a CMake target -> the rooms that may link it, PRIVATE.
HEAVY_TARGETS = {
    r"CGAL::|Boost::": (),  # CGAL_SOURCES get it
    r"VTK::": ("render", "vtk"),
    r"yaml-cpp": ("settings",),
    r"TBB::": ("core",),
    r"nlohmann_json::": ("core", "io", "metrics", "scene", "run", "inspection", "study", "play"),
    r"^(deflate|lz4|expat|meshoptimizer|draco)$": ("io",),
    r"X11::": ("display",),
    r"LAMMPS::|fmt::": ("lammps",),
    r"CLI11::": (),
}
# What a room hands on to those who link it: its headers include it.
PUBLIC_TARGETS = {"vtk": ("VTK::CommonCore", "VTK::CommonDataModel")}
# Pattern of a call -> the only files that may have it.
IN_ONE_PLACE = {
    r"O_CREAT|\bstd::o?fstream\b|\b(fopen|creat|mkstemp|copy_file|create_director\w+)\(": ("lib/sinew/core/file.cpp",),
    r"\bf(printf|put[cs]|write)\(|\bstd::(cout|cerr|clog)\b": ("tools/command/results.cpp", "tools/command/terminal.cpp"),
}
PARTS = ("SOURCES", "CGAL_SOURCES", "PUBLIC", "PRIVATE", "INTERFACE")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)

LONGEST_FILE = 560
LONGEST_FUNCTION = 55
SHORT_FILE, MOST_SHORT_FILES = 40, 0.15
LONGEST_README = 150
# What the code used to say -> what it says.
GIVEN_UP = {
    r"\b[Nn]eighbour": "neighbor", r"\b[Cc]olour": "color", r"\b[Cc]entre[sd]?\b": "center", r"\b[Mm]etres?\b": "meter",
    r"\b[Gg]rey\b": "gray", r"\b[Bb]ehaviour": "behavior", r"\b[Ll]icence": "license",
    r"\bsift": "prune", r"\b[Cc]arrier_?[Ss]lots?\b|\bCarriers\b": "co-moving frames", r"\bRiders\b": "MovingParticles",
    r"\bstrays\b|\bstrayed\b": "escaped particles",
    r"EnergyBook": "ledger", r"StepWay|\bstep_way\b": "stepper choice", r"\b[Uu]nserved\b": "unsupported",
    r"\btold_at\b": "with_context", r"\balbum\b": "figure set", r"\b(Plate|DrawnLook)\b": "figure, view preset",
    r"\b[Ff]ilm_|\bFilm": "playback",
    r"\bwide list|\bnarrow list": "outer or inner list", r"asked of CGAL|asks CGAL": "checked against CGAL",
    r"whole or not at all": "atomically", r"\b(Vec3|double|Corners|Floats) ways?\b": "path, displacement or direction",
    r"//+<? (Of|By|That|Those|As|From)\b": "a comment that begins with a noun or a verb",
    r"\bmost_(?!common\b)\w+|\bleast_\w+": "max_ or min_",
}
# Trailing comments begin with a noun or a verb as well.
TRAILING = re.compile(r"^\s*[^\s/].*?//+<? (of|by|that|those|as|from)\b")


def is_installed(name):
    """Whether others get a header, by its name in lib/sinew: see sinew_library in lib/targets.cmake."""
    room, _, file = name.partition("/")
    return "detail" not in name.split("/") and (room not in INTERNAL or file in INTERNAL[room])


def folder_of(name):
    """What counts as the folder of a file: `detail` is part of the one that has it."""
    folders = name.split("/")[:-1]
    return "/".join(folders[:folders.index("detail")] if "detail" in folders else folders)


def circle_breaches(lib):
    seen = {}
    for path in sorted(lib.rglob("*")):
        if path.suffix in (".h", ".cpp"):
            name = path.relative_to(lib).as_posix()
            for _, included in INCLUDE.findall(path.read_text()):
                if included.startswith("sinew/"):
                    seen.setdefault((folder_of(name), folder_of(included[6:])), (name, included))
    for (one, other), (name, included) in sorted(seen.items()):
        if one < other and (other, one) in seen:
            yield "lib/sinew/{} includes {}, and {} includes {}: {} and {} are one".format(
                name, included, *seen[other, one], one or "lib", other or "lib")


def include_breaches(lib, path):
    name, room = path.relative_to(lib).as_posix(), path.relative_to(lib).parts[0]
    for kind, included in INCLUDE.findall(path.read_text()):
        owner = included.split("/")[1] if included.startswith("sinew/") else ""
        if kind == '"':
            yield f'lib/sinew/{name} includes "{included}"; files of lib are included as <sinew/ROOM/file.h>'
        elif owner and not (lib.parent / included).is_file():
            yield f"lib/sinew/{name} includes <{included}>, which is no file of lib"
        elif owner and owner not in ARROWS[room] | {room}:
            yield f"lib/sinew/{name} includes {included}: {room} must not see {owner}"
        elif owner not in ("", room) and "detail" in included.split("/"):
            yield f"lib/sinew/{name} includes {included}, which {owner} has for itself"
        elif path.suffix == ".h" and owner and is_installed(name) and not is_installed(included[6:]):
            yield f"lib/sinew/{name}, which is installed, includes {included}, which is not"
        for pattern, places in HEAVY.items():
            if not re.match(pattern, included):
                continue
            if name not in places and (room not in places or path.suffix == ".h"):
                yield f"lib/sinew/{name} includes {included}, which belongs in .cpp files of {places}"


def used_rooms(lib, room):
    for path in (lib / room).rglob("*"):
        if path.suffix in (".h", ".cpp"):
            for _, included in INCLUDE.findall(path.read_text()):
                if included.startswith("sinew/") and included.split("/")[1] != room:
                    yield included.split("/")[1]


def reached(linked, links):
    """The rooms that linking these brings."""
    all_of_them = set(linked)
    for room in linked:
        all_of_them |= reached(links.get(room, set()), links)
    return all_of_them


def linked_words(lib, room):
    text = re.sub(r"#.*", "", (lib / room / "CMakeLists.txt").read_text())
    calls = re.findall(r"sinew_library\(([^)]*(?:\([^)]*\)[^)]*)*)\)", text)
    others = re.findall(r"(?:target_link_libraries|link_libraries)\(([^)]*)\)", text)
    for call in calls + others:
        part = ""
        for word in call.split():
            part = word if word in PARTS else part
            yield part, word


def links_of(lib, room):
    return {word.removeprefix("sinew::") for _, word in linked_words(lib, room) if word.startswith("sinew::")}


def link_breaches(lib, room):
    for part, word in linked_words(lib, room):
        for pattern, rooms in HEAVY_TARGETS.items():
            if not part.endswith("SOURCES") and re.search(pattern, word):
                if room not in rooms or (part != "PRIVATE" and word not in PUBLIC_TARGETS.get(room, ())):
                    yield f"lib/sinew/{room}/CMakeLists.txt links {word} as {part or 'plain'}"
    links = {name: links_of(lib, name) for name in ARROWS}
    for other in links[room] - ARROWS[room]:
        yield f"lib/sinew/{room}/CMakeLists.txt links sinew::{other}: {room} must not see {other}"
    for other in set(used_rooms(lib, room)) - reached(links[room], links):
        yield f"lib/sinew/{room} includes {other} without linking sinew::{other}"


def rounding_breaches(lib, room):
    """CGAL needs compile options of its own, which no other source may get."""
    text = (lib / room / "CMakeLists.txt").read_text()
    own = re.search(r"CGAL_SOURCES([^)A-Z]*)", text)
    own = own.group(1).split() if own else []
    for path in sorted((lib / room).rglob("*.cpp")):
        name = path.relative_to(lib / room).as_posix()
        uses = re.search(r"#include <CGAL/", path.read_text()) is not None
        if uses != (name in own):
            yield f"lib/sinew/{room}/{name}: files that include CGAL, and no others, are CGAL_SOURCES"


def linkage_breaches(lib):
    """What one source alone calls is in an anonymous namespace."""
    defined = re.compile(r"^(?!static|template|using|namespace|struct|class|enum|constexpr|inline|return|extern|const \w+<)"
                         r"[\w:<>,&*\s]+?[\s&*](\w+)\(")
    headers = " ".join(path.read_text() for path in lib.rglob("*.h"))
    for path in sorted(lib.rglob("*.cpp")):
        hidden = False
        for number, line in enumerate(path.read_text().split("\n"), 1):
            hidden = line == "namespace {" or (hidden and line != "}  // namespace")
            found = defined.match(line)
            if found and not hidden and not line.startswith(" ") and not re.search(rf"\b{found.group(1)}\(", headers):
                yield f"lib/sinew/{path.relative_to(lib)}:{number}: {found.group(1)} is declared in no header"


def license_breaches(source, path):
    head = path.read_text().split("\n")[:2]
    line = head[1] if head[0].startswith("#!") and len(head) > 1 else head[0]
    if not re.fullmatch(r"(//|#) SPDX-License-Identifier: GPL-3\.0-or-later", line):
        yield f"{path.relative_to(source)} does not begin with the SPDX line"


def functions(lines):
    """Name and length of each function, as clang-format lays them out: its end is a } below its first letter."""
    opened = re.compile(r"^( *)(?!namespace|struct|class|enum|union|if|for|while|switch|do|else|try|\}|//|:|constexpr std::array|const|\w+_\(|\w+ \w+\{)\S.*\{$")
    for first, line in enumerate(lines):
        found = opened.match(line)
        if not found or "(" not in " ".join(lines[max(0, first - 4):first + 1]) or "= {" in line:
            continue
        for last in range(first + 1, len(lines)):
            if lines[last].startswith(found.group(1) + "}"):
                yield line.strip(), last - first + 1
                break


def size_breaches(source, path):
    lines = path.read_text().split("\n")
    if len(lines) - 1 > LONGEST_FILE:
        yield f"{path.relative_to(source)} has {len(lines) - 1} lines, over {LONGEST_FILE}"
    if path.suffix == ".cpp" and "tests" not in path.relative_to(source).parts:
        for name, length in functions(lines):
            if length > LONGEST_FUNCTION:
                yield f"{path.relative_to(source)}: a function of {length} lines: {name}"


def product_files(source):
    for folder in ("lib", "tools"):
        yield from (path for path in sorted((source / folder).rglob("*")) if path.suffix in (".h", ".cpp"))


def place_breaches(source, path):
    """Files are created, and messages printed, where links and control characters are seen to."""
    name = path.relative_to(source).as_posix()
    code = re.sub(r"//[^\n]*", "", path.read_text())
    for pattern, places in IN_ONE_PLACE.items():
        found = re.search(pattern, code)
        if found and name not in places and not name.startswith("lib/examples/"):
            yield f"{name}: {found.group(0)} belongs in {' or '.join(places)}"


def share_breaches(source):
    sizes = [len(path.read_text().split("\n")) - 1 for path in product_files(source)]
    short = sum(size < SHORT_FILE for size in sizes)
    if short > MOST_SHORT_FILES * len(sizes):
        yield (f"{short} of {len(sizes)} files of lib and tools have fewer than {SHORT_FILE} lines "
               f"(median {statistics.median(sizes):.0f}): ideas are torn apart")


def word_breaches(source, path):
    if path.name == "house_test.py":
        return
    for number, line in enumerate(path.read_text().split("\n"), 1):
        for pattern, instead in GIVEN_UP.items():
            if re.search(pattern, line):
                yield f"{path.relative_to(source)}:{number}: {re.search(pattern, line).group(0)!r}, now {instead}"


def trailing_breaches(source, path):
    for number, line in enumerate(path.read_text().split("\n"), 1):
        if TRAILING.match(line):
            yield f"{path.relative_to(source)}:{number}: a trailing comment that begins with no noun or verb"


def source_files(source):
    for folder in ("lib", "tools", "tests"):
        for path in sorted((source / folder).rglob("*")):
            if path.suffix in (".h", ".cpp", ".py", ".sh", ".js"):
                yield path


def pages(source):
    yield source / "README.md"
    for folder in ("lib", "tools", "tests", "configs", "data"):
        yield from sorted((source / folder).rglob("README.md"))


def forgotten_tests(source):
    """Tests that no list of sources names never run."""
    lists = "\n".join(path.read_text() for path in sorted((source / "tests").rglob("CMakeLists.txt")))
    for path in sorted((source / "tests").rglob("*_test.cpp")):
        if not re.search(rf"\b{re.escape(path.name)}\b", lists):
            yield f"{path.relative_to(source)} is in no list of sources"


def breaches(source):
    lib = source / "lib" / "sinew"
    for room in sorted(path.name for path in lib.iterdir() if path.is_dir()):
        if room not in ARROWS:
            yield f"lib/sinew/{room} is a room without arrows: add it to this test"
            continue
        yield from link_breaches(lib, room)
        yield from rounding_breaches(lib, room)
        for path in sorted((lib / room).rglob("*")):
            if path.suffix in (".h", ".cpp", ".in"):
                yield from include_breaches(lib, path)
    yield from circle_breaches(lib)
    yield from linkage_breaches(lib)
    for path in product_files(source):
        yield from place_breaches(source, path)
        yield from trailing_breaches(source, path)
    for path in source_files(source):
        yield from license_breaches(source, path)
        yield from size_breaches(source, path)
        yield from word_breaches(source, path)
    yield from share_breaches(source)
    yield from forgotten_tests(source)
    for page in pages(source):
        yield from word_breaches(source, page)
    front = len((source / "README.md").read_text().split("\n")) - 1
    if front > LONGEST_README:
        yield f"README.md has {front} lines, over {LONGEST_README}"


def main():
    found = list(breaches(Path(sys.argv[1]).resolve()))
    print("\n".join(found) or "the house is in order")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
