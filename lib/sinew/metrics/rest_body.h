// SPDX-License-Identifier: GPL-3.0-or-later
// The body at rest: the reference for every frame of a run, with all that can be computed once.
//
//     const RestBody rest = rest_body(measured_body(run));
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <sinew/body/bond_factors.h>
#include <sinew/body/pass_through.h>
#include <sinew/core/deformation.h>
#include <sinew/core/rest_neighbors.h>
#include <sinew/core/triangles.h>
#include <sinew/core/vector.h>
#include <sinew/material/material.h>
#include <sinew/metrics/frame.h>
#include <sinew/metrics/sections.h>
#include <sinew/metrics/slices.h>
#include <sinew/rig/skeleton.h>

namespace sinew {

/// A skin that bends finer than a coarse mesh. Volume, area and sections are its.
struct FineSkin {
  Triangles rest;                           ///< encloses what the surface encloses
  std::function<Points(const Points&)> at;  ///< its points by those of the particles, m
};

/// What forces between the particles depend on beside their material and places.
struct RestForces {
  bool known = true;  ///< false where particles are left out of the frames, or nothing is known
  bool has_muscles = false;  ///< a frame's state must contain their stress
  /// Factors on bonds near the surface and weights of volumes; none: found where forces are asked
  /// for first, which may take seconds, from the three below.
  std::shared_ptr<const BondFactors> factors = {};
  // One value per particle; each may be empty.
  std::vector<double> stiffness = {};         ///< modulus of its material over the body's
  std::vector<double> volume_share = {};      ///< volume around it over that of one inside
  std::vector<double> volume_stiffness = {};  ///< K_v, Pa; empty: the material's
  PassThrough pass = {};                      ///< bones whose flesh exerts no contact on each other
};

/// Input: the body at rest and its constants. Particles are in the written order.
struct RestInput {
  Points positions;  ///< positions of the n particles at rest, m
  /// Neighbors there, with second ones where the material has bonds to them; none: searched.
  SharedNeighbors neighbors = {};
  Triangles surface;                  ///< the body's skin at rest, outside out
  std::optional<FineSkin> fine = {};  ///< none: the surface is fine enough
  std::vector<int> bone;              ///< n; the bone each particle follows (most), -1 for none
  std::vector<double> weight = {};    ///< n; the weight of that bone in each particle; or empty
  Skeleton skeleton;
  Material material;
  RestForces forces = {};
  Energies start;  ///< energies of the first frame, from which the energy balance is taken
  std::vector<double> density = {};  ///< n; factors on the mass; or empty
  /// n; as surface_layers() of the whole body, of which these are a part; empty: these are all.
  std::vector<std::int32_t> layer = {};
};

/// The layer of each particle below the surface at rest: 1 outermost, 2 next to one of those, 0
/// inside. Outermost are, among neighbors at 2r as in FCC and HCP, those with less than 12 of them;
/// elsewhere those whose unit vectors to their neighbors sum to over 0.2 per neighbor, which 1 % of
/// the particles inside random packings do.
std::vector<std::int32_t> surface_layers(const RestShape& shape, double radius);

/// A particle that follows a bone: its attachment at rest, and whether a joint is near.
struct Bound {
  std::uint32_t particle = 0;
  int bone = 0;
  Vec3 foot = Vec3::Zero();  ///< the nearest point of the bone's segment at rest, m
  double distance = 0;       ///< distance from it, l0, m
  bool far = true;           ///< the foot lies outside every joint zone
};

/// What stresses need beside the law: found where they are asked for first.
struct BondStiffness {
  // Values of each bond, by entry of RestBody::shape.neighbors, then of second.
  std::vector<double> factor;         ///< on its force; empty: 1
  std::vector<double> length;         ///< at rest, m; empty: there are none, or they change
  std::vector<double> volume_weight;  ///< one per particle; empty: none keeps its volume
  /// n; the volume whose stiffness each particle's bonds have, over that of one inside; empty: 1.
  std::vector<double> volume_share;
};

struct RestBody {
  RestShape shape;       ///< neighbors: pairs closer than 2.2 r
  NeighborLists second;  ///< pairs that have bonds as well; empty: there are none
  Triangles surface;
  std::optional<FineSkin> fine;
  double volume = 0;  ///< enclosed by the surface, m^3; not above 0 for a sheet
  double area = 0;    ///< area of the surface, m^2
  std::vector<Bone> bones;
  std::vector<Bound> bound;
  std::vector<int> bone_of;         ///< n; -1 for none
  std::vector<std::int32_t> layer;  ///< n; see surface_layers()
  std::vector<double> weight;       ///< n, or empty
  Slices slices;
  std::vector<Section> sections;
  Energies start;
  Material material;
  RestForces forces;
  std::vector<double> density;  ///< n; factors on it; or empty

  /// In time for the first caller of several threads.
  const BondStiffness& stiffness() const;
  double radius() const { return material.pair.r; }             ///< radius of a particle, m
  double interaction_range() const { return material.pair.b; }  ///< m
  double mass_of(std::size_t i) const {
    return density.empty() ? material.mass : material.mass * density[i];
  }
  std::size_t particles() const { return shape.points.size(); }
  /// Bonds of a particle at rest, if its material has some.
  std::size_t bonds_of(std::size_t i) const {
    return shape.neighbors.of(i).size() + (second.size() > 0 ? second.of(i).size() : 0);
  }
  double rest_pairs() const { return static_cast<double>(shape.neighbors.neighbor.size()) / 2; }

 private:
  struct Found;
  std::shared_ptr<Found> stiffness_;
  friend RestBody rest_body(RestInput input);
};

/// The rest lengths of all bonds before any has changed, m: FrameState::bond_rest. In parallel.
std::vector<double> first_bond_rest(const RestBody& rest);

/// Checks the input and computes the rest. Throws bad input for sizes that do not agree, indices
/// out of range, numbers that are not finite, or a surface without area. A joint zone reaches half
/// a width of the body, sqrt(A_B) / 2, along the bones from each joint; A_B is the volume bound to
/// a bone over its length, the larger of the two that meet counts.
RestBody rest_body(RestInput input);

/// The surface that volumes, areas and sections are measured on, at a frame: the fine skin, or the
/// body's own points.
Triangles measured_surface(const RestBody& rest, const FrameState& state);

/// Whether every coordinate is finite.
bool all_finite(const Points& points);

}  // namespace sinew
