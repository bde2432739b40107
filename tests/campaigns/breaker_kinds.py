# SPDX-License-Identifier: GPL-3.0-or-later
"""What breaker.py tries: one function per kind of trial. Each draws its case by trial.chance alone."""
import base64
import json
import os
import re
import resource
import shutil
import signal
import struct
import subprocess
import time
import zlib
from pathlib import Path

SCENE = """body: {{mesh: {source}/data/meshes/box.obj, radius: {radius}}}
material: {{model: {model}}}
skeleton: {{bones: [{{name: a, head: [0, 0, 0], tail: [0, 0, 0.35]}}, {{name: b, parent: a, tail: [0, 0, 0.69]}}]}}
motion: {{tracks: [{{bone: b, keys: [{{time: 0}}, {{time: 0.4, axis: [0, 1, 0], angle: 40}}]}}]}}
solver: {{duration: {duration}}}
output: {{interval: 0.05, checkpoint_interval: 0}}
"""
STATIC = """body: {{mesh: {source}/data/meshes/box.obj, radius: 0.03}}
material: {{model: bonded, young_modulus: 1e5}}
supports: [{{name: clamp, facing: [0, 0, -1]}}]
loads: [{{name: pull, force: [0, 0, 5], facing: [0, 0, 1]}}]
solver: {{method: static, duration: 0.2}}
output: {{interval: 0.1, checkpoint_interval: 0}}
"""
FAR = ["0", "-0", "1e-320", "1e-160", "1e-30", "1", "-1", "1e9", "-1e30", "1e99", "-1e99", "1e101", "1e155", "-1e200", "1e308",
       ".inf", "-.inf", ".nan", "''", "[]", "{}", "[0, 0, 0]", "[1e155, 0, 0]", "[1e99, -1e99, 1e99]", "auto", "true", "~",
       "0x10", "1_000", "9223372036854775808", "-2147483649", "1e400"]
STRANGE = ["a b", "it's", 'say "x"', "semi;colon", "$HOME", "`id`", "-rf", "--help", "new\nline", "tab\there", "\x1b[2J", "\x9b31m",
           "ü", "骨", "\udcff\udcfe", "a" * 200, "..", ".hidden", "%s%n", "<script>", "&amp;", "*", "?", "#x", "a:b", "~", "{x}"]
SERIES = ("particles", "surface", "bones", "frames")


def scene(trial, text=SCENE, name="s.yaml", **values):
    values = {"source": trial.source, "radius": 0.03, "model": "paper", "duration": 0.2, **values}
    path = trial.inside / name
    path.write_text(text.format(**values))
    return path


def make_samples(bin, source, folder):
    """A finished run, a run of the static method, and the keys of a scene with their defaults."""
    for name, text in (("run", SCENE), ("static", STATIC)):
        path = folder / f"{name}.yaml"
        path.write_text(text.format(source=source, radius=0.03, model="paper", duration=0.2))
        subprocess.run([bin / "sinew", "simulate", "--quiet", path, "-o", folder / name], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([bin / "sinew", "measure", "--quiet", folder / "run"], check=True, stdout=subprocess.DEVNULL)
    said = subprocess.run([bin / "sinew", "check", "--help-settings"], check=True, capture_output=True, text=True).stdout
    keys, section = [], ""
    for line in said.splitlines():
        if found := re.match(r"  (\w+)\s*$", line):
            section = found[1]
        elif section and (found := re.match(r"    (\w+)\s", line)):
            keys.append(f"{section}.{found[1]}")
    (folder / "keys").write_text("\n".join(keys))


def settings(trial):
    """Any value for any key."""
    keys = (trial.samples / "keys").read_text().split()
    path = scene(trial, trial.chance.choice((SCENE, STATIC)), model=trial.chance.choice(("paper", "bonded", "bonded_volume")))
    words = []
    for _ in range(trial.chance.randint(1, 3)):
        words += ["--set", f"{trial.chance.choice(keys)}={trial.chance.choice(FAR)}"]
    trial.sinew("check", path, *words, text=10_000)


def numbers(trial):
    """Numbers of any size anywhere in a scene."""
    text = trial.chance.choice((SCENE, STATIC)).format(source=trial.source, radius=0.03, model="bonded", duration=0.1)
    places = list(re.finditer(r"(?<=[\s\[,])-?[0-9.]+(?=[\s\],}])", text))
    for place in sorted(trial.chance.sample(places, 2), key=lambda found: -found.start()):
        text = text[:place.start()] + trial.chance.choice(FAR[:18]) + text[place.end():]
    path = trial.inside / "s.yaml"
    path.write_text(text)
    words = ["simulate", path, "-o", trial.inside / "r", "--set", "solver.wall_time=2"]
    trial.sinew(*(words if trial.chance.random() < 0.5 else ["check", path]), text=10_000)


def mutated(trial, data):
    """Bytes flipped, cut out, doubled, overwritten by numbers that are too large."""
    data = bytearray(data)
    for _ in range(trial.chance.choice((1, 1, 2, 5, 20))):
        at = trial.chance.randrange(len(data) + 1)
        length = trial.chance.choice((1, 1, 4, 8, 100, 5000))
        how = trial.chance.randrange(6)
        if how == 0 and at < len(data):
            data[at] ^= 1 << trial.chance.randrange(8)
        elif how == 1:
            del data[at:at + length]
        elif how == 2:
            data[at:at] = data[at:at + length]
        elif how == 3:
            data[at:at + 8] = struct.pack("<Q", trial.chance.choice((0, 1, 2**31, 2**32 + 1, 2**62, 2**64 - 1)))
        elif how == 4:
            data[at:at + length] = trial.chance.choice(FAR).encode()
        elif trial.chance.random() < 0.3:
            del data[at + length:]
    return bytes(data)


def meshes(trial):
    files = sorted(file for file in (trial.source / "data/meshes").iterdir() if file.stat().st_size < 300_000)
    chosen = trial.chance.choice(files)
    path = trial.inside / chosen.name
    data = mutated(trial, chosen.read_bytes())
    path.write_bytes(data)
    words = trial.chance.choice((["info", path], ["fill", path, "--count", "200"], ["new", path]))
    trial.sinew(*words, text=len(data), declared=len(data))


def rigs(trial):
    files = sorted((trial.source / "data/motions").iterdir())
    chosen = trial.chance.choice([file for file in files if file.suffix in (".bvh", ".glb", ".gltf") and file.stat().st_size < 10**6])
    path = trial.inside / chosen.name
    data = mutated(trial, chosen.read_bytes())
    path.write_bytes(data)
    trial.sinew(*trial.chance.choice((["info", path], ["new", path])), text=len(data), declared=len(data))


def damaged_run(trial, skipped=".lock"):
    """A run of which a file is damaged, is something else, or is gone, and the bytes of its files. `skipped`: the end of names
    of files that are left."""
    run = trial.small_run()
    files = sorted(file for file in run.rglob("*") if file.is_file() and not file.name.endswith(skipped))
    for _ in range(trial.chance.choice((1, 1, 3))):
        file = trial.chance.choice(files)
        if not file.is_file() or file.is_symlink():
            continue
        how = trial.chance.randrange(6)
        data = file.read_bytes()
        file.unlink()
        if how < 2:
            file.write_bytes(mutated(trial, data))
        elif how == 2:
            file.mkdir()
        elif how == 3:
            file.symlink_to(trial.chance.choice((trial.outside / "precious", file, "/dev/zero", "/dev/null", "nowhere")))
        elif how == 4:
            os.mkfifo(file)
    return run, sum(file.stat().st_size for file in run.rglob("*") if file.is_file() and not file.is_symlink())


def run_folders(trial):
    run, size = damaged_run(trial)
    words = trial.chance.choice((["measure", run], ["info", run], ["info", run, "--verify"], ["export", run, "--to", "xyz"],
                                 ["simulate", run / "scene.yaml", "-o", run, "--resume"],
                                 ["simulate", trial.samples / "run.yaml", "-o", run, "--force"]))
    trial.sinew(*words, text=size, declared=4 * size)


def readers(trial):
    """What the Python package and the plugin for ParaView read of such a run; VTK's reader has faults of its own."""
    how, where, skipped = trial.chance.choice((("package", trial.bin.parent / "python", ".lock"),
                                               ("plugin", trial.source / "tools/paraview", (".lock", ".vtu"))))
    run, size = damaged_run(trial, skipped)
    if trial.chance.random() < 0.2:
        pvd = run / "particles.pvd"
        place = trial.chance.choice((trial.outside / "precious", "../../out/precious", "\x1b[2J", "particles", "/dev/zero", ""))
        if pvd.is_file() and not pvd.is_symlink():
            pvd.write_bytes(pvd.read_bytes().replace(b"particles/particles_000001.vtu", os.fsencode(place), 1))
    trial.run("/usr/bin/python3", Path(__file__).with_name("read_run.py"), how, where, run, text=size + 10**7, codes={0, 2})


def records(trial):
    """run.json, and what body.vtu says of itself, are JSON from elsewhere."""
    run = trial.small_run()
    record = json.loads((run / "run.json").read_text())
    for _ in range(trial.chance.randint(1, 3)):
        key = trial.chance.choice(sorted(record))
        record[key] = trial.chance.choice((None, [], {}, -1, 1e308, 2**64, "\x1b[2J\x9b", "x" * 10_000, True, {"a": {"b": [1]}},
                                           [{}], [[1]], "@"))
    depth = trial.chance.choice((3, 17, 1000, 100_000))
    text = json.dumps(record, ensure_ascii=False).replace('"@"', "[" * depth + "]" * depth)
    (run / "run.json").write_text(text)
    trial.sinew(*trial.chance.choice((["measure", run], ["info", run], ["info", run, "--json"], ["export", run, "--to", "csv"])),
                text=len(text) + 10**6, declared=10**6)
    if (run / "run.json").stat().st_size > 10 * len(text) + 100_000:
        raise AssertionError("run.json grows")


def checkpoints(trial):
    """Bytes forged, with the right length and checksum."""
    kind = trial.chance.choice(("run", "static"))
    run = trial.inside / "run"
    words = ["simulate", trial.samples / f"{kind}.yaml", "-o", run, "--set", "solver.duration=3", "--set"]
    trial.sinew(*words, "solver.wall_time=0.2", codes={0, 130})
    newest = max((run / "checkpoint").iterdir(), key=lambda file: file.stat().st_mtime_ns)
    data = newest.read_bytes()
    size, count = struct.unpack_from("<QQ", data, 32)
    begin = 48 + size * count  # of what the version reads: numbers, counts, columns
    # Names and counts stand at the ends of large columns: half of the places are near the beginning.
    last = trial.chance.choice((len(data) - 16, min(len(data) - 16, begin + 400)))
    at, width = trial.chance.randrange(begin, last), trial.chance.choice((1, 4, 8))
    stretch = data[at:at + trial.chance.choice((8, 100, 10_000))]
    value = trial.chance.choice((b"\xff" * width, b"\0" * width, struct.pack("<d", float("nan"))[-width:],
                                 struct.pack("<q", 10**18)[:width], struct.pack("<d", 1e300)[-width:],
                                 struct.pack("<q", int.from_bytes(data[at:at + 8], "little", signed=True) // 2 + 1000)[:width]))
    put = trial.chance.choice((value, value, value, stretch + stretch, b"", bytes(reversed(stretch))))
    taken = width if put is value else len(stretch)
    text = bytearray(data[:at] + put + data[at + taken:-8] + b"\0" * 8)
    struct.pack_into("<Q", text, 16, len(text))
    value = 0xcbf29ce484222325
    for byte in text[:-8]:
        value = ((value ^ byte) * 0x100000001b3) & (2**64 - 1)
    struct.pack_into("<Q", text, len(text) - 8, value)
    for file in (run / "checkpoint").iterdir():
        file.unlink()
    newest.write_bytes(text)
    trial.sinew(*words, "solver.wall_time=2", "--resume", declared=len(text))


def elements(trial):
    """Results of CalculiX: blocks doubled, emptied, numbers of other widths."""
    lines = ["    1C", "    2C%30d%38d" % (8, 1)]
    lines += [" -1%10d%12.5E%12.5E%12.5E" % (i + 1, i % 2, i // 2 % 2, i // 4) for i in range(8)] + [" -3", "    3C%30d%38d" % (1, 1)]
    nodes = [trial.chance.randint(1, 8) for _ in range(8)] if trial.chance.random() < 0.3 else [1, 2, 4, 3, 5, 6, 8, 7]
    lines += [" -1%10d    1    0    1" % 1, " -2" + "".join("%10d" % node for node in nodes), " -3"]
    for step in range(trial.chance.choice((1, 3, 2000))):
        lines += ["  100CL  101%12.5E%12d                     0    1           1" % (0.1 * step, 8), " -4  DISP        4    1"]
        values = [trial.chance.choice((0, 1, -1e-3, 1e-120, -1e-200, 1e99, 1e150, float("nan"))) for _ in range(3)]
        if trial.chance.random() < 0.8:
            lines += [" -1%10d%12.5E%12.5E%12.5E" % (i + 1, *values) for i in range(8)]
        lines += [" -3"]
    data = ("\n".join(lines) + "\n 9999\n").encode()
    if trial.chance.random() < 0.5:
        data = mutated(trial, data)
    (trial.inside / "a.frd").write_bytes(data)
    trial.sinew("measure", trial.small_run(), "--reference", trial.inside / "a.frd", "-o", trial.inside / "o", text=len(data) + 10**6)


def packed(data, block=1 << 15):
    parts = [data[i:i + block] for i in range(0, len(data), block)] or [b""]
    small = [zlib.compress(part, 9) for part in parts]
    head = struct.pack("<QQQ", len(parts), block, len(parts[-1]) % block) + b"".join(struct.pack("<Q", len(one)) for one in small)
    return (base64.b64encode(head) + base64.b64encode(b"".join(small))).decode()


def grids(trial):
    """Images and grids of VTK: noise, few bytes that inflate to many, sizes that are not theirs."""
    n = trial.chance.choice((2, 3, 10, 40, 100, 160))
    fill = trial.chance.randrange(3)
    data = (bytes(n**3) if fill == 0 else trial.chance.randbytes(n**3) if fill == 1 else
            bytes(1 if (x + y + z) % 2 else 255 for z in range(n) for y in range(n) for x in range(n)))
    claimed = n if trial.chance.random() < 0.8 else trial.chance.choice((1, n + 1, 2000, 10**6))
    kind = trial.chance.choice(("Int8", "UInt8", "Int16", "Float32", "Float64"))
    head = 'version="1.0" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor"'
    if trial.chance.random() < 0.6:
        extent = " ".join([f"0 {claimed - 1}"] * 3)
        text = (f'<VTKFile type="ImageData" {head}><ImageData WholeExtent="{extent}" Origin="0 0 0" Spacing="1 1 1"><Piece '
                f'Extent="{extent}"><PointData Scalars="d"><DataArray type="{kind}" Name="d" format="binary">{packed(data)}'
                f'</DataArray></PointData></Piece></ImageData></VTKFile>\n')
        path = trial.inside / "a.vti"
    else:
        shared = '<Piece NumberOfPoints="1000" NumberOfCells="0"><Points><DataArray type="Float32" NumberOfComponents="3" ' \
                 'format="appended" offset="0"/></Points></Piece>\n' * trial.chance.choice((1, 20, 2000))
        text = (f'<VTKFile type="UnstructuredGrid" {head}><UnstructuredGrid>{shared}</UnstructuredGrid><AppendedData '
                f'encoding="base64">_{packed(trial.chance.randbytes(12_000))}</AppendedData></VTKFile>\n')
        path = trial.inside / "a.vtu"
    path.write_text(text)
    trial.sinew(*trial.chance.choice((["info", path], ["fill", path, "--count", "100"])), text=len(text), declared=len(data))


def yaml(trial):
    """Aliases of aliases, deep and long scenes."""
    n = trial.chance.choice((10, 1000, 30_000))
    kind = trial.chance.randrange(5)
    text = {0: "x: &t \"" + "a" * trial.chance.choice((10, 100_000)) + "\"\nbody: [" + "*t, " * n + "*t]\n",
            1: "a: &a [1]\n" + "".join(f"b{i}: &b{i} [*{'a' if i == 0 else f'b{i-1}'}, *{'a' if i == 0 else f'b{i-1}'}]\n" for i in range(min(n, 60))),
            2: "body: " + "[" * n, 3: "body: {mesh: " + "x" * n * 10 + "}\n",
            4: "motion:\n  tracks:\n    - bone: a\n      keys:\n" + "".join(f"        - {{time: {i}, angle: 1}}\n" for i in range(n))}[kind]
    path = trial.inside / "s.yaml"
    path.write_text(text)
    trial.sinew("check", path, text=len(text))


def names(trial):
    """Files and folders of any name."""
    name = trial.chance.choice(STRANGE).encode("utf-8", "surrogateescape")
    folder = os.fsencode(trial.inside) + b"/" + (name if name not in (b"..", b"~") else b"x")
    os.makedirs(folder, exist_ok=True)
    mesh = folder + b"/" + (b"m" if trial.chance.random() < 0.5 else name.replace(b"..", b"dots")) + b".obj"
    shutil.copyfile(trial.source / "data/meshes/box.obj", mesh)
    words = trial.chance.choice((["info", mesh], ["fill", mesh, "--count", "100"], ["new", mesh, "-o", folder + b"/s.yaml"],
                                 ["check", mesh], ["info", folder],
                                 ["simulate", scene(trial, duration=0.1), "-o", folder + b"/r"]))
    trial.sinew(*words, text=10**6)


def links(trial):
    """Links planted where a command will write."""
    run = trial.small_run()
    names = ["run.json", "log.txt", "bones.csv", "metrics.csv", "metrics.json", "report.html", "checksums.sfv", "body.vtu",
             "scene.yaml", "view.pvsm", "particles.pvd", "particles/particles_000001.vtu", "checkpoint/a.bin"]
    for name in trial.chance.sample(names, 4):
        place = run / name
        if trial.chance.random() < 0.6:
            place = place.parent / f".{place.name}.tmp"
        place.parent.mkdir(exist_ok=True)
        place.unlink(missing_ok=True)
        link = os.symlink if trial.chance.random() < 0.7 else os.link
        link(trial.outside / "precious", place)
    for folder in trial.chance.sample(SERIES + ("checkpoint", "pictures"), 1):
        if trial.chance.random() < 0.3:
            shutil.rmtree(run / folder, ignore_errors=True)
            (run / folder).symlink_to(trial.outside)
    trial.sinew(*trial.chance.choice((["measure", run], ["simulate", trial.samples / "run.yaml", "-o", run, "--force"],
                                      ["simulate", trial.samples / "run.yaml", "-o", run, "--resume"])), declared=10**7)


def surroundings(trial):
    """Limits, closed descriptors, an environment that is odd."""
    path = scene(trial)
    limits = []
    if trial.chance.random() < 0.5:
        limits = [trial.chance.choice(((resource.RLIMIT_FSIZE, trial.chance.choice((0, 100, 5000, 50_000))),
                                       (resource.RLIMIT_NOFILE, trial.chance.choice((4, 8, 12, 30))),
                                       (resource.RLIMIT_AS, trial.chance.choice((10**8, 3 * 10**8, 6 * 10**8)))))]
    closed = [number for number in (0, 1, 2) if trial.chance.random() < 0.3]
    environment = {key: trial.chance.choice(("", "/nowhere", "x" * 5000, "\x1b[2J", "de_DE.UTF-8", "0", "-1"))
                   for key in ("HOME", "TMPDIR", "LANG", "LC_ALL", "TERM", "PATH", "NO_COLOR", "DISPLAY") if trial.chance.random() < 0.2}
    words = trial.chance.choice((["simulate", path, "-o", trial.inside / "r"], ["measure", trial.small_run()],
                                 ["fill", trial.source / "data/meshes/arm.ply", "--count", "300"], ["info", trial.samples / "run"]))
    trial.sinew(*words, limits=limits, environment=environment, declared=10**7, silent=2 in closed or (resource.RLIMIT_FSIZE, 0) in limits,
                before=lambda: [os.close(number) for number in closed])


def kills(trial):
    """SIGKILL and signals to stop at any moment; the run that goes on ends in the bits of one that was never stopped."""
    path = scene(trial, model=trial.chance.choice(("paper", "bonded")), duration=0.6)
    out, whole = trial.inside / "r", trial.inside / "whole"
    name = trial.chance.choice((signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGPIPE))

    def strike(child):
        time.sleep(trial.chance.uniform(0, 0.5))
        os.kill(child.pid, name)  # it is not waited for yet
    for _ in range(trial.chance.randint(1, 3)):
        words = ["--resume"] if out.exists() else []
        trial.sinew("simulate", path, "-o", out, *words, after=strike, codes={0, 130, name})
    trial.sinew("simulate", path, "-o", out, *(["--resume"] if out.exists() else []), codes={0})
    trial.sinew("simulate", path, "-o", whole, codes={0})
    states = [json.loads((folder / "run.json").read_text())["state_hash"] for folder in (out, whole)]
    if states[0] != states[1]:
        raise AssertionError(f"other bits: {states}")
    trial.sinew("info", out, "--verify", codes={0})


def resumptions(trial):
    """--resume of a finished or stopped run by another scene is refused by key and leaves it as it is; its own goes on."""
    mesh, out = trial.inside / "mine.obj", trial.inside / "r"
    shutil.copy(trial.source / "data/meshes/box.obj", mesh)
    words = ["simulate", scene(trial, duration=0.6), "-o", out, "--set", f"body.mesh={mesh}"]
    trial.sinew(*words, *trial.chance.choice(([], ["--set", "solver.wall_time=0.02"])), codes={0, 130})
    before = {file: file.read_bytes() for file in out.rglob("*") if file.is_file()}
    key, value = trial.chance.choice([
        ("body.mesh", trial.source / "data/meshes/arm.ply"), ("body.radius", 0.04), ("material.model", "bonded"),
        ("material.young_modulus", 1e6), ("skeleton.scale", 1.1), ("motion.speed", 2), ("binding.method", "inside"),
        ("world.drag", 1), ("solver.gravity", "[0, 0, -1]"), ("solver.duration", 9), ("output.interval", 0.01), ("mesh", None)])
    if value is None:  # another content of the same name
        mesh.write_text(mesh.read_text().replace("v -0.0777", "v -0.0767", 1))
    _, _, said = trial.sinew(*words, "--resume", *(["--set", f"{key}={value}"] if value else []), codes={2})
    if key.split(".")[-1] not in said or "--force" not in said:
        raise AssertionError(f"{key}: {said}")
    if before != {file: file.read_bytes() for file in out.rglob("*") if file.is_file()}:
        raise AssertionError(f"{key}: a refused resumption has changed the run")
    shutil.copy(trial.source / "data/meshes/box.obj", mesh)
    trial.sinew(*words, "--resume", codes={0})


KINDS = [settings, numbers, meshes, rigs, run_folders, readers, records, checkpoints, elements, grids, yaml, names, links, surroundings,
         settings, numbers, run_folders, readers, kills, resumptions]
