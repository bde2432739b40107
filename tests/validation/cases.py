# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies whose deformation is known: from closed forms, and from what others have published.

    for case in cases(): case.write(folder)      # scene.yaml and body.obj
"""
import csv
import json
import math
from dataclasses import dataclass, field

import hertz

WITHIN = 0.03
BOX = [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4),
       (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7)]

SCENE = """
body: {{mesh: body.obj, radius: 0.01}}
material: {material}
{machine}
solver: {{{solver}, duration: {duration}}}
output: {{interval: {interval}, only: displacement}}
"""


def prism(outline, low, high):
    """A quadrilateral in x and y, between two heights."""
    return [(x, y, z) for z in (low, high) for x, y in outline]


def box(size, low=(0, 0, 0)):
    (x, y, z), (dx, dy, dz) = low, size
    return prism([(x, y), (x + dx, y), (x + dx, y + dy), (x, y + dy)], z, z + dz)


def hexahedron(points):
    """Eight corners as points and faces."""
    return points, BOX


def revolved(profile, sides):
    """About z: (radius, z) from the lower end of the axis to its upper one."""
    low, *rings, high = profile
    points = [(0, 0, low[1])]
    for radius, z in rings:
        turns = [2 * math.pi * k / sides for k in range(sides)]
        points += [(radius * math.cos(t), radius * math.sin(t), z) for t in turns]
    points.append((0, 0, high[1]))
    faces = []
    for k in range(sides):
        n = (k + 1) % sides
        faces += [(0, 1 + n, 1 + k), (len(points) - 1, len(points) - 1 - sides + k, len(points) - 1 - sides + n)]
        for ring in range(len(rings) - 1):
            a, b = 1 + ring * sides, 1 + (ring + 1) * sides
            faces += [(a + k, a + n, b + n), (a + k, b + n, b + k)]
    return points, faces


def half_ball(radius, sides=96):
    """On its flat side."""
    angles = [math.pi / 2 * k / (sides // 4) for k in range(sides // 4)]
    return revolved([(0, 0)] + [(radius * math.cos(a), radius * math.sin(a)) for a in angles] + [(0, radius)], sides)


@dataclass
class Case:
    name: str
    title: str
    shape: tuple            # points and triangles
    layer: float            # what the layers count across, m
    layers: list            # odd numbers: the packing fits at each radius
    material: str
    machine: str            # supports, loads, probes
    expected: dict          # (result of the study, kind) -> (value, unit)
    source: str
    duration: float = 0
    interval: float = 1
    within: float = WITHIN  # of the expected value
    remark: str = ""
    quick: list = field(default_factory=list)  # layers of the small case of the tests; none: not one
    solver: str = "method: static"
    by_elements: list = field(default_factory=list)  # probes' columns that have their limit where elements put them
    elements: float = 0     # side of finite elements at the finest radius, in radii; 0: none
    measured: dict = field(default_factory=dict)  # result -> (of the folder of a run, value, unit)

    def radii(self, layers=None):
        return [round(self.layer / math.sqrt(2) / n, 12) for n in layers or self.layers]

    def write(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "body.obj").write_text(
            "".join("v %.12f %.12f %.12f\n" % tuple(p) for p in self.shape[0]) +
            "".join("f %d %d %d\n" % tuple(k + 1 for k in face) for face in self.shape[1]))
        scene = folder / f"{self.name}.yaml"
        scene.write_text(SCENE.format(material=self.material, machine=self.machine, solver=self.solver,
                                      duration=self.duration, interval=self.interval))
        return scene


def elastic(modulus, ratio=0.25, density=1000):
    model = "bonded" if ratio == 0.25 else f"bonded_volume, poisson_ratio: {ratio}"
    return f"{{model: {model}, young_modulus: {modulus}, density: {density}}}"


def elastica(load):
    """Deflection over length of a clamped rod with P L^2 / (E I) = load at its end, dead across: by shooting."""
    steps = 2000

    def shot(curvature):
        angle, y, h = 0.0, 0.0, 1 / steps
        for _ in range(steps):  # the middle point's rule: angle'' = -load cos(angle)
            half = angle + h / 2 * curvature
            middle = curvature - h / 2 * load * math.cos(angle)
            angle, y = angle + h * middle, y + h * math.sin(half)
            curvature -= h * load * math.cos(half)
        return curvature, y

    low, high = 0.0, 2 * load
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if shot(middle)[0] < 0 else (low, middle)
    return shot(low)[1]


def bar(wide, length):
    """Square, upright, its lower end on z = 0."""
    return hexahedron(box((wide, wide, length), (-wide / 2, -wide / 2, 0)))


def beside_elements():
    """What has no closed form: finite elements alone are the reference."""
    W, L, E = 0.1, 0.8, 1e5
    held = "supports:\n  - {name: below, facing: [0, 0, -1]}\n"
    force = 0.5 * E * W**4 / 12 / L**2
    end = f"loads:\n  - {{name: end, force: [{force}, 0, 0], facing: [0, 0, 1]}}\nprobes:\n  - {{name: tip, facing: [0, 0, 1]}}\n"
    yield Case("cantilever", "A cantilever of eight widths, P L^2/(E I) = 0.5", bar(W, L), W, [5, 7, 9, 13, 17],
               elastic(E), held + end, {}, "", elements=8)
    yield Case("two_materials", "A cantilever of eight widths, its upper half four times as soft", bar(W, L), W, [5, 7, 9, 13, 17],
               elastic(E), held + end +
               f"materials:\n  - {{name: soft, young_modulus: {E / 4}, low: [-1, -1, {L / 2}], high: [1, 1, {L}]}}\n",
               {}, "", elements=8)
    R = 0.1
    yield Case("half_ball", "Half a ball on its clamped flat side, under its weight", half_ball(R), R, [21, 31, 41, 81],
               elastic(E), held + "loads:\n  - {name: weight, gravity: [0, 0, -10]}\n"
               "probes:\n  - {name: top, facing: [0, 0, 1], facing_angle: 15}\n", {}, "", elements=14)


def bars():
    """W wide, E, isotropic bonds: a Poisson's ratio of 1/4."""
    W, E = 0.1, 1e5
    G = E / 2.5
    held = "supports:\n  - {name: below, facing: [0, 0, -1]}\n"
    L = 5 * W
    yield Case("pull", "A bar pulled by 0.1 %, free to contract", bar(W, L), W, [5, 7, 9, 11],
               elastic(E),
               "supports:\n  - {name: below, hold: z, facing: [0, 0, -1]}\n"
               f"  - {{name: above, hold: z, facing: [0, 0, 1], keys: [{{time: 0}}, {{time: 1, translation: [0, 0, {L / 1000}]}}]}}\n"
               "  - {name: left, hold: x, facing: [-1, 0, 0]}\n  - {name: front, hold: y, facing: [0, -1, 0]}\n",
               {("above: force_z", "final"): (E * W * W / 1000, "N")}, "E A times the strain", duration=1, quick=[3, 5, 7])
    angle = 1
    yield Case("twist", "A bar twisted by 1 degree, free to warp", bar(W, L), W, [5, 7, 9, 11],
               elastic(E),
               "supports:\n  - {name: below, hold: xy, facing: [0, 0, -1]}\n"
               f"  - {{name: above, hold: xy, facing: [0, 0, 1], keys: [{{time: 0}}, {{time: 1, angle: {angle}}}]}}\n"
               "  - {name: foot, hold: z, low: [-0.02, -0.02, -1], high: [0.02, 0.02, 0.02]}\n",
               {("above: moment_z", "final"): (0.1406 * G * W**4 * math.radians(angle) / L, "N m")},
               "0.1406 G W^4 per length (Timoshenko and Goodier, Theory of Elasticity)", duration=1)
    turned = 45
    yield Case("torsion", "A bar twisted by 45 degrees, free to warp", bar(W, L), W, [5, 7, 9, 11], elastic(E),
               "supports:\n  - {name: below, hold: xy, facing: [0, 0, -1]}\n"
               f"  - {{name: above, hold: xy, facing: [0, 0, 1], keys: [{{time: 0}}, {{time: 1, angle: {turned}}}]}}\n"
               "  - {name: foot, hold: z, low: [-0.02, -0.02, -1], high: [0.02, 0.02, 0.02]}\n",
               {("above: moment_z", "final"): (0.1406 * G * W**4 * math.radians(turned) / L, "N m")},
               "0.1406 G W^4 per length, which is for small angles", duration=1, interval=0.25, elements=8, quick=[5, 7, 9, 11])
    H = 6 * W
    yield Case("column", "A column of six widths, Poisson's ratio 0.45, twisted by 180 degrees", bar(W, H), W, [5, 7, 9, 11],
               elastic(E, 0.45),
               "supports:\n  - {name: below, facing: [0, 0, -1]}\n"
               "  - {name: above, facing: [0, 0, 1], keys: [{time: 0}, {time: 1, angle: 180}]}\n"
               f"probes:\n  - {{name: middle, at: [{W / 2}, 0, {H / 2}]}}\n",
               {("middle: displacement_x", "final"): (-W / 2, "m"), ("inverted", "worst"): (0, "particles")},
               "the middle turns by 90 degrees, by symmetry; nothing is turned inside out", duration=1, interval=0.125, quick=[5, 7, 9])
    H = 7 * W
    # Its upper end goes around so that the axis keeps its length.
    turns = [(k / 8, math.pi * k / 8) for k in range(1, 9)]
    keys = ", ".join(f"{{time: {t}, axis: [0, 1, 0], angle: {math.degrees(a):.10g}, translation: "
                     f"[{H / a * (1 - math.cos(a))!r}, 0, {H / a * math.sin(a) - H!r}]}}" for t, a in turns)
    yield Case("bent_column", "A column of seven widths, Poisson's ratio 0.45, bent by 180 degrees", bar(W, H), W, [5, 7, 9, 11],
               elastic(E, 0.45),
               "supports:\n  - {name: below, facing: [0, 0, -1]}\n"
               f"  - {{name: above, facing: [0, 0, 1], interpolation: linear, keys: [{{time: 0}}, {keys}]}}\n"
               f"probes:\n  - {{name: middle, at: [0, 0, {H / 2}]}}\n",
               {("middle: displacement_x", "final"): (H / math.pi, "m"), ("inverted", "worst"): (0, "particles")},
               "the middle is on the plane of symmetry; nothing is turned inside out", duration=1, interval=0.125, quick=[5, 7])
    L = 21 * W
    for load in (0.25, 1, 2):
        force = load * E * W**4 / 12 / L**2
        yield Case(f"elastica_{load}".replace(".", "_"), f"A cantilever with P L^2/(E I) = {load} at its end",
                   bar(W, L), W, [5, 7, 9, 11], elastic(E),
                   held + "loads:\n" + f"  - {{name: end, force: [{force}, 0, 0], facing: [0, 0, 1]}}\n" +
                   f"probes:\n  - {{name: tip, facing: [0, 0, 1]}}\n",
                   {("tip: displacement_x", "final"): (elastica(load) * L, "m")},
                   "the elastica, without shear (0.2 % more, small loads)")


def turek_hron():
    """Their beam, from the cylinder's rear to its end: plane strain by rollers on both faces."""
    thick, end = 0.02, 0.6
    start = 0.2 + math.sqrt(0.05**2 - (thick / 2)**2)
    for name, modulus, down, back, layers in (("csm1", 1.4e6, -66.1023e-3, -7.18767e-3, [15, 21]),
                                              ("csm2", 5.6e6, -16.9739e-3, -0.469e-3, [15, 21])):
        depth = thick / 3
        yield Case(f"turek_{name}", f"Turek and Hron's {name.upper()}: a beam under its weight, plane strain",
                   hexahedron(prism([(start, 0), (end, 0), (end, thick), (start, thick)], 0, depth)), thick, layers,
                   elastic(modulus, 0.4),
                   "supports:\n  - {name: cylinder, facing: [-1, 0, 0]}\n"
                   "  - {name: front, hold: z, facing: [0, 0, 1]}\n  - {name: back, hold: z, facing: [0, 0, -1]}\n"
                   "loads:\n  - {name: weight, gravity: [0, -2, 0]}\n"
                   f"probes:\n  - {{name: A, at: [{end}, {thick / 2}, {depth / 2}]}}\n",
                   {("A: displacement_y", "final"): (down, "m"), ("A: displacement_x", "final"): (back, "m")},
                   "Turek and Hron 2006, doi 10.1007/3-540-34596-5_15", elements=10 if name == "csm1" else 0)


def frequency(run, probe, column):
    """Of a swing from rest at one of its ends: until it is back there."""
    with (run / "probes.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["name"] == probe]
    times, values = ([float(row[name]) for row in rows] for name in ("time", column))
    far = max(range(len(values)), key=lambda k: abs(values[k]))
    back = min(range(far, len(values) - 1), key=lambda k: abs(values[k] - values[0]))
    a, b, c = values[back - 1:back + 2]  # the end of a parabola through three frames
    return 1 / (times[back] + (a - c) / (2 * (a - 2 * b + c)) * (times[1] - times[0]))


def swinging_beam():
    """Turek and Hron's CSM3: the beam let go, without damping, over a little more than a period."""
    thick, end, depth, start = 0.02, 0.6, 0.02 / 3, 0.2 + math.sqrt(0.05**2 - 0.01**2)
    yield Case("turek_csm3", "Turek and Hron's CSM3: the beam of CSM1 let go", hexahedron(
                   prism([(start, 0), (end, 0), (end, thick), (start, thick)], 0, depth)), thick, [15, 21],
               elastic(1.4e6, 0.4)[:-1] + ", damping: 0}",
               "supports:\n  - {name: cylinder, facing: [-1, 0, 0]}\n"
               "  - {name: front, hold: z, facing: [0, 0, 1]}\n  - {name: back, hold: z, facing: [0, 0, -1]}\n"
               "loads:\n  - {name: weight, gravity: [0, -2, 0]}\n"
               f"probes:\n  - {{name: A, at: [{end}, {thick / 2}, {depth / 2}]}}\n",
               {("A: displacement_y", "largest"): (-(63.607 + 65.160) * 1e-3, "m"),
                ("A: displacement_x", "largest"): (-(14.305 + 14.305) * 1e-3, "m")},
               "Turek and Hron 2006, mean and amplitude", duration=1.05, interval=0.01, solver="method: dynamic",
               measured={"frequency": (lambda run: frequency(run, "A", "displacement_y"), 1.0995, "Hz")})


INDENTED = {"modulus": 1e5, "depth": 0.1, "ball": 1, "pressed": 0.002}


def over_hertz(run):
    """Force over that of Hertz on a layer, for the contact of the particles: an obstacle touches them at their radius, so
    its ball is a radius larger, and touches the outermost layer 0.29 radii above the mesh, half a layer further out."""
    radius = json.loads((run / "run.json").read_text())["radius"]
    with (run / "supports.csv").open() as file:
        found = [float(row["force_z"]) for row in csv.DictReader(file) if row["name"] == "below"][-1]
    given = INDENTED
    return found / hertz.force(given["modulus"], 0.25, given["ball"] + radius,
                               given["pressed"] + radius * (1 - 1 / math.sqrt(2)), given["depth"])


def indentation():
    """Of a block three times as wide as deep, on clamped ground, by a rigid ball."""
    H, given = INDENTED["depth"], INDENTED
    yield Case("hertz", "A rigid ball pressed into a block: Hertz's contact, on rigid ground", bar(3 * H, H), H, [9, 13, 17, 25],
               elastic(given["modulus"]),
               "supports:\n  - {name: below, facing: [0, 0, -1]}\n"
               "world:\n  obstacles:\n"
               f"    - {{name: ball, shape: sphere, radius: {given['ball']}, stiffness: 20, "
               f"center: [0, 0, {H + given['ball'] - given['pressed']}]}}\n",
               {}, "4/3 E* sqrt(R) d^1.5 (Hertz 1882), times what the ground, two contact radii below, adds "
               "(Lebedev and Ufliand 1958), for the particles' radius of the ball and depth",
               quick=[9, 13, 17], measured={"force, over the closed form": (over_hertz, 1, "")})


def soft_cantilever():
    """Its grip, half a height deep, ends in a layer of particles."""
    H, L = 0.04, 0.1
    yield Case("soft_cantilever", "A soft cantilever under its weight, Poisson's ratio 0.45",
               hexahedron(box((L + H / 2, H, H), (-H / 2, -H / 2, -H / 2))), H, [9, 13, 17, 25],
               elastic(5e4, 0.45, 1265),
               f"supports:\n  - {{name: grip, low: [-1, -1, -1], high: [{H / 1e6}, 1, 1]}}\n"
               "loads:\n  - {name: weight, gravity: [0, -9.8, 0]}\n"
               f"probes:\n  - {{name: tip, at: [{L}, 0, 0]}}\n",
               {("tip: displacement_y", "final"): (-25.86e-3, "m")},
               "Zhu, Zhang and Hu 2022, doi 10.1016/j.jcp.2022.111105, by SPH of 24 particles across, not extrapolated: it "
               "hangs 5 % lower than finite elements, hence within 5 %",
               within=0.05, elements=6, by_elements=["tip: displacement_y"])


KELVIN_VOIGT = {"modulus": 1e5, "density": 1000, "damping": 600}


def retardation(run):
    """The time in which a load's strain comes within 1/e of its end, over that of the bonds: along a cube axis twelve
    dashpots of c = C / 12 each resist as 2 c, springs of k to first and k / 4 to second neighbors as 3 k."""
    with (run / "probes.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["name"] == "top"]
    times, values = ([float(row[name]) for row in rows] for name in ("time", "displacement_z"))
    part = (1 - math.exp(-1)) * values[-1]
    after = next(k for k, value in enumerate(values) if abs(value) > abs(part))
    found = times[after - 1] + (part - values[after - 1]) / (values[after] - values[after - 1]) * (times[after] - times[after - 1])
    radius = json.loads((run / "run.json").read_text())["radius"]
    given = KELVIN_VOIGT
    return found / (given["damping"] / 18 * radius * math.sqrt(5 * given["density"] / given["modulus"]))


def creep():
    """Along the axes, and free of strain across. The load comes at once; its end is that of twenty times."""
    W, given = 0.1, KELVIN_VOIGT
    rollers = "".join(f"  - {{name: {name}, hold: {axis}, facing: {facing}}}\n" for name, axis, facing in (
        ("below", "z", [0, 0, -1]), ("left", "x", [-1, 0, 0]), ("right", "x", [1, 0, 0]), ("front", "y", [0, -1, 0]),
        ("back", "y", [0, 1, 0])))
    yield Case("creep", "A confined cube creeps under a load: Kelvin and Voigt's solid", bar(W, W), W, [5, 9, 13],
               elastic(given["modulus"], density=given["density"])[:-1] +
               f", damping: {given['damping']}, damping_form: central}}",
               f"supports:\n{rollers}loads:\n  - {{name: press, traction: [0, 0, -100], facing: [0, 0, 1]}}\n"
               "probes:\n  - {name: top, facing: [0, 0, 1]}\n", {}, "2 c / (3 k) of its dashpots c = C / 12 and springs k, along a cube axis",
               duration=0.6, interval=0.002, solver="method: dynamic",
               measured={"retardation time, over the closed form": (retardation, 1, "")})


PRONY = {"share": 0.5, "time": 0.5, "ramp": 0.05, "strain": 1e-3}


def prony(time):
    """The modulus over that at once of a bar that is pulled within the ramp and then held."""
    g, tau, ramp = PRONY["share"], PRONY["time"], PRONY["ramp"]
    return 1 - g + g * tau / ramp * (math.exp(-(time - ramp) / tau) - math.exp(-time / tau))


def left_of_force(run):
    """The load at the end over that after a fifth of the time, over the closed form."""
    with (run / "supports.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["name"] == "above"]
    early, late = rows[len(rows) // 5], rows[-1]
    expected = prony(float(late["time"])) / prony(float(early["time"]))
    return float(late["force_z"]) / float(early["force_z"]) / expected


def relaxation():
    """One branch of Maxwell's beside each bond."""
    W, E, end = 0.1, 1e5, 1.0
    L, by = 5 * W, 5 * W * PRONY["strain"]
    yield Case("relaxation", "A bar pulled by 0.1 % and held relaxes: the standard linear solid", bar(W, L), W, [5, 7, 9, 11],
               elastic(E)[:-1] + f", relaxation_shares: [{PRONY['share']}], relaxation_times: [{PRONY['time']}], damping_ratio: 0.5, damping_form: central}}",
               "supports:\n  - {name: below, hold: z, facing: [0, 0, -1]}\n"
               "  - {name: above, hold: z, facing: [0, 0, 1], interpolation: linear, keys: [{time: 0}, "
               f"{{time: {PRONY['ramp']}, translation: [0, 0, {by}]}}]}}\n"
               "  - {name: left, hold: x, facing: [-1, 0, 0]}\n  - {name: front, hold: y, facing: [0, -1, 0]}\n",
               {("above: force_z", "final"): (E * W * W * PRONY["strain"] * prony(end), "N")},
               "E (1 - g (1 - exp(-t / tau))) A times the strain, g = 1/2, tau = 0.5 s", duration=end, interval=0.05,
               solver="method: dynamic", quick=[3, 5, 7],
               measured={"load at 1 s over that at 0.2 s, over the closed form": (left_of_force, 1, "")})


def cook():
    """Cook's membrane in plane stress: a thin plate, sheared at its end. Linear: the load is small."""
    scale, thin = 1e-3, 48 / 13
    yield Case("cook", "Cook's membrane, plane stress, Poisson's ratio 1/3",
               hexahedron(prism([(0, 0), (48, 44), (48, 60), (0, 44)], 0, thin)), thin, [3, 5, 7, 9],
               elastic(1, 1 / 3, 1),
               "supports:\n  - {name: wall, facing: [-1, 0, 0]}\n"
               f"loads:\n  - {{name: shear, force: [0, {scale * thin}, 0], facing: [1, 0, 0]}}\n"
               f"probes:\n  - {{name: tip, at: [48, 52, {thin / 2}]}}\n",
               {("tip: displacement_y", "final"): (23.96 * scale, "m")},
               "Cook's test; 23.96 by fine meshes for a load of 1")


def cases():
    return [*bars(), *cook(), *indentation(), *soft_cantilever(), *creep(), *relaxation(), *beside_elements(), *turek_hron(),
            *swinging_beam()]
