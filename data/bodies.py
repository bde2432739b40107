# SPDX-License-Identifier: GPL-3.0-or-later
"""The shapes of the example bodies, in meters; z points up.

A limb is a tube through knots (x, y, z, radius). The bones in configs/ run along the same knots.
"""

from field import Body, at, ellipsoid, flattened, tube, tube_cubics

# Where the fingers begin (x, z at the knuckle), how they spread (direction x, z), length, width.
FINGERS = [
    (0.548, 0.037, (0.9563, 0.2924), 0.080, 1.0),  # index
    (0.553, 0.012, (0.9952, 0.0978), 0.092, 1.0),
    (0.549, -0.013, (0.9952, -0.0978), 0.085, 1.0),
    (0.539, -0.037, (0.9563, -0.2924), 0.068, 0.92),  # little
]


def arm():
    """A left arm stretched out along x, thumb up, its palm towards -y; the shoulder at x = 0."""
    body = Body("An arm with a hand")
    body.add(tube((0.047, 0, 0, 0.047), (0.12, 0, 0, 0.040), (0.20, 0, 0, 0.034),
                  (0.255, 0, 0, 0.030)), 0)
    body.add(ellipsoid((0.140, 0, 0.014), (0.080, 0.033, 0.035)), 0.035)  # biceps
    body.add(ellipsoid((0.130, 0, -0.016), (0.090, 0.032, 0.030)), 0.03)  # triceps
    body.add(tube((0.255, 0, 0, 0.030), (0.315, 0, 0.002, 0.0345), (0.37, 0, 0.001, 0.031),
                  (0.43, 0, 0, 0.0255), (0.475, 0, 0, 0.0240)), 0.018)
    body.add(ellipsoid((0.257, 0, -0.020), (0.016, 0.012, 0.012)), 0.02)  # point of the elbow
    palm(body)
    for x, z, (dx, dz), length, width in FINGERS:
        knots = [(x + s * length * dx, y, z + s * length * dz, r * width) for s, y, r in
                 ((0, 0.002, 0.0130), (0.5, 0.002, 0.0122), (1, -0.001, 0.0103))]
        body.add(tube(*knots), 0.010)
    return body


def palm(body):
    for x, z, _, _, width in FINGERS:
        body.add(tube((0.460, 0, 0.30 * z, 0.018), (0.505, 0.002, 0.75 * z, 0.0160),
                      (x, 0.002, z, 0.0135 * width)), 0.025)
    body.add(ellipsoid((0.502, -0.007, 0.026), (0.036, 0.014, 0.018), (1, 0, 0.5)), 0.02)
    body.add(ellipsoid((0.496, -0.008, -0.026), (0.036, 0.012, 0.014), (1, 0, -0.25)), 0.02)
    body.add(tube((0.478, -0.006, 0.022, 0.0175), (0.507, -0.011, 0.050, 0.0165),
                  (0.536, -0.014, 0.077, 0.0142), (0.562, -0.015, 0.097, 0.0115)), 0.018)  # thumb


def creature():
    """A young fox that stands on z = 0 and looks along x."""
    body = Body("A young fox")
    body.add(tube((-0.100, 0, 0.152, 0.054), (-0.02, 0, 0.148, 0.057), (0.070, 0, 0.155, 0.062)), 0)
    body.add(tube((0.080, 0, 0.175, 0.048), (0.112, 0, 0.215, 0.042), (0.135, 0, 0.255, 0.040)),
             0.05)
    head(body)
    for side in (1, -1):
        body.add(tube((0.080, 0.038 * side, 0.135, 0.034), (0.082, 0.043 * side, 0.080, 0.0235),
                      (0.084, 0.043 * side, 0.026, 0.0210)), 0.04)
        body.add(ellipsoid((0.095, 0.043 * side, 0.020), (0.031, 0.0240, 0.020)), 0.014)
        body.add(tube((-0.100, 0.036 * side, 0.142, 0.043), (-0.086, 0.043 * side, 0.084, 0.0275),
                      (-0.106, 0.043 * side, 0.028, 0.0210)), 0.04)
        body.add(ellipsoid((-0.094, 0.043 * side, 0.020), (0.032, 0.0240, 0.020)), 0.014)
    body.add(tube((-0.135, 0, 0.165, 0.020), (-0.180, 0, 0.182, 0.027), (-0.218, 0, 0.228, 0.035),
                  (-0.226, 0, 0.280, 0.028), (-0.212, 0, 0.322, 0.014)), 0.025)  # tail
    return body


def head(body):
    body.add(ellipsoid((0.150, 0, 0.290), (0.068, 0.076, 0.064)), 0.03)  # skull
    for side in (1, -1):
        body.add(ellipsoid((0.163, 0.042 * side, 0.266), (0.040, 0.041, 0.031)), 0.03)  # cheeks
    body.add(tube((0.185, 0, 0.268, 0.038), (0.218, 0, 0.260, 0.028), (0.242, 0, 0.258, 0.022)),
             0.03)
    body.add(ellipsoid((0.259, 0, 0.271), (0.013, 0.016, 0.012)), 0.006)  # nose
    for side in (1, -1):
        body.add(ellipsoid((0.201, 0.035 * side, 0.300), (0.0150, 0.0145, 0.0175)), 0.004)  # eyes
        base, middle, top = ((0.134, 0.040 * side, 0.320), (0.129, 0.052 * side, 0.362),
                             (0.124, 0.062 * side, 0.397))
        ear = tube((*base, 0.038), (*middle, 0.0285), (*top, 0.0155))
        body.add(flattened(ear, base, (1, 0.35 * side, 0.08), 0.62), 0.015)


TENTACLE = [(0, 0, 0.054, 0.046), (0.012, 0, 0.15, 0.042), (0.008, 0, 0.27, 0.035),
            (-0.014, 0, 0.39, 0.027), (-0.010, 0, 0.50, 0.019), (0.035, 0, 0.584, 0.0115)]


def tentacle():
    """An arm of an octopus that rises from z = 0; two rows of suckers look along x."""
    body = Body("An arm of an octopus")
    body.add(tube(*TENTACLE), 0)
    body.add(ellipsoid((0, 0, 0.0388), (0.062, 0.062, 0.030)), 0.05)  # foot
    for x, y, z, size, outward in suckers():
        body.add(ellipsoid((x, y, z), (0.45 * size, size, size), outward, (0, 0, 1)), 0.004)
    return body


def suckers():
    """Places of the suckers (m), their radii, and the directions they look in."""
    spans = tube_cubics(*TENTACLE)
    along = 0.55  # in spans
    while along < 4.6:
        x, y, z, radius = (at(cubic, along % 1) for cubic in spans[int(along)])
        for side in (1, -1):
            outward = (0.85, 0.53 * side, 0)
            yield x + outward[0] * radius, y + outward[1] * radius, z, 0.36 * radius, outward
        along += 8.2 * radius  # a span is about 0.11 m long: the pairs are 0.9 radii apart
