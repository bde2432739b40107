// SPDX-License-Identifier: GPL-3.0-or-later
// The force between two particles at distance d (Komiya and Tokoi, eq. 1); positive repels:
//
//     f(d) = k1 (4 r^2 - d^2)       0 <= d < 2r     repulsion, finite at contact
//            0                     2r <= d < a
//            -k2 (d - a)(b - d)     a <= d < b      attraction
//            0                      b <= d
//
// and its potential, f = -dphi/dd with phi = 0 beyond b.
//
//     const double f = pair.force(d), phi = pair.potential(d);
#pragma once

namespace sinew {

/// Spring of a bond.
struct BondSpring {
  double length;     ///< at rest, m
  double stiffness;  ///< N/m
};

struct PairForce {
  double r = 0;   ///< particle radius, m
  double k1 = 0;  ///< Pa
  double k2 = 0;  ///< Pa
  double a = 0;   ///< where attraction begins, m; at least 2r
  double b = 0;   ///< where it ends: the interaction range, m

  double force(double d) const {
    if (d < 2 * r) return k1 * (4 * r * r - d * d);
    if (d < a || d >= b) return 0;
    return -k2 * (d - a) * (b - d);
  }

  double potential(double d) const {
    if (d >= b) return 0;
    if (d >= a) return -k2 / 6 * (b - d) * (b - d) * (2 * d + b - 3 * a);
    const double cohesion = k2 / 6 * (b - a) * (b - a) * (b - a);
    if (d >= 2 * r) return -cohesion;
    return -cohesion + k1 / 3 * (2 * r - d) * (2 * r - d) * (4 * r + d);
  }

  double contact_stiffness() const { return 4 * k1 * r; }    ///< in compression at 2r, N/m
  double tension_stiffness() const { return k2 * (b - a); }  ///< at a, N/m
  double lambda() const { return tension_stiffness() / contact_stiffness(); }
};

}  // namespace sinew
