// SPDX-License-Identifier: GPL-3.0-or-later
// The contents of a scene: the options of core/options.h, its world, solver and output, and the
// place of each value in the file. SI units, angles in degrees.
//
//     const double duration = settings.solver.duration;
//     throw bad_input(settings.place("solver.duration"), what, cure);
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/options.h>
#include <sinew/core/triangles.h>

namespace sinew {

/// A box (low, high) or a ball (center, radius) of the scene; none of them: everywhere.
struct RegionSettings {
  std::optional<Vec3> low = {}, high = {};
  std::optional<Vec3> center = {};
  std::optional<double> radius = {};
  double falloff = 0;
};

/// A number at a time.
struct ValueKeySettings {
  double time = 0;
  double value = 1;
};

struct PlaceKeySettings {
  double time = 0;
  Vec3 translation = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();
  double angle = 0;
};

enum class ObstacleShape { plane, sphere, capsule, box, mesh };

struct ObstacleSettings {
  std::string name;
  ObstacleShape shape = ObstacleShape::plane;
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();  ///< plane
  std::optional<Vec3> center = {};
  std::optional<double> radius = {};
  std::optional<Vec3> from = {}, to = {};
  std::optional<Vec3> size = {};
  Vec3 rotation = Vec3::Zero();
  std::string mesh;  ///< a path, as body.mesh
  std::string bone;
  double friction = 0;
  double stiffness = 1;
  double damping = 0.5;
  Interpolation interpolation = Interpolation::smooth;
  std::vector<PlaceKeySettings> keys = {};
  std::vector<ValueKeySettings> friction_keys = {};  ///< factors on friction
};

struct PinSettings {
  RegionSettings region = {};
  std::string bone;
};

enum class FieldShape { uniform, density, attraction, swirl };

struct FieldSettings {
  std::string name;
  FieldShape shape = FieldShape::uniform;
  std::optional<Vec3> acceleration = {};  ///< uniform
  std::optional<Vec3> density = {};       ///< density of force
  std::optional<Vec3> point = {};         ///< point of attraction, or on the axis of a swirl
  Vec3 axis = Vec3::UnitZ();              ///< axis of a swirl
  std::optional<double> strength = {};    ///< acceleration of attraction and swirl
  std::optional<double> core = {};        ///< core of attraction and swirl
  RegionSettings region = {};
  std::vector<ValueKeySettings> keys = {};  ///< keys of strength
};

struct MuscleSettings {
  std::string name;
  std::string bone;
  std::optional<Vec3> direction = {};
  double strength = 0;
  RegionSettings region = {};
  std::vector<ValueKeySettings> keys = {};  ///< keys of activation
};

struct SpringKeySettings {
  double time = 0;
  Vec3 to = Vec3::Zero();
  double factor = 1;
};

struct SpringSettings {
  std::string name;
  std::optional<Vec3> at = {};       ///< a point of the body at rest
  std::optional<int> particle = {};  ///< or an id
  double stiffness = 0;
  std::vector<SpringKeySettings> keys = {};
};

struct WorldSettings {
  double drag = 0;
  std::vector<ObstacleSettings> obstacles = {};
  std::vector<PinSettings> pins = {};
  std::vector<FieldSettings> fields = {};
  std::vector<MuscleSettings> muscles = {};
  std::vector<SpringSettings> springs = {};

  /// Whether it has no entries.
  bool empty() const {
    return drag == 0 && obstacles.empty() && pins.empty() && fields.empty() && muscles.empty() &&
           springs.empty();
  }
};

/// Side of a face around an axis: a bore looks at its axis, a shaft away from it.
enum class AxisSide { none, inward, outward };

/// A part of the body at rest: what is in all of the regions that are given. None: all of it.
struct PartSettings {
  RegionSettings region = {};                      ///< a box or a ball
  std::optional<Vec3> point = {}, normal = {};     ///< plane: what is in front of it
  std::optional<Vec3> axis = {}, axis_point = {};  ///< direction and place of an axis
  std::optional<double> axis_radius = {};          ///< largest distance from it
  std::optional<int> component = {};
  std::optional<Vec3> facing = {};  ///< at the surface
  AxisSide facing_axis = AxisSide::none;
  double facing_angle = 30;
  std::string bone;
  std::optional<std::vector<double>> ids = {};
  std::string mesh = {};  ///< a path, as body.mesh; of materials

  /// Whether it is of the surface alone.
  bool faces() const { return facing || facing_axis != AxisSide::none; }
  bool empty() const {
    return !region.low && !region.high && !region.center && !region.radius && !point && !normal &&
           !axis && !component && !faces() && bone.empty() && !ids && mesh.empty();
  }
};

/// A part of the body of another material than `material`.
struct LocalMaterialSettings {
  std::string name;
  std::optional<double> young_modulus = {}, poisson_ratio = {}, density = {};
  std::optional<double> breaking_strain = {}, yield_strain = {};
  PartSettings part = {};

  bool is_elastic() const { return young_modulus || poisson_ratio; }
  bool has_strength() const { return breaking_strain || yield_strain; }
};

enum class HeldAxes { x, y, xy, z, xz, yz, xyz };

struct SupportSettings {
  std::string name;
  HeldAxes hold = HeldAxes::xyz;
  std::optional<Vec3> hold_along = {};
  PartSettings part = {};
  std::optional<Vec3> pivot = {};
  Interpolation interpolation = Interpolation::smooth;
  std::vector<PlaceKeySettings> keys = {};
};

struct LoadSettings {
  std::string name;
  std::optional<Vec3> force = {}, traction = {}, gravity = {};
  std::optional<double> pressure = {};
  PartSettings part = {};
  std::optional<Vec3> pivot = {};
  std::vector<ValueKeySettings> keys = {};  ///< factors
};

struct ProbeSettings {
  std::string name;
  std::optional<Vec3> at = {};  ///< a point, instead of a part
  PartSettings part = {};
};

/// Particles that belong to a bone, whatever is nearest: by number, in a box, or in a ball.
struct BoundSettings {
  std::string bone;  ///< "": to none
  std::optional<std::vector<double>> ids = {};
  std::optional<Vec3> low = {}, high = {};  ///< corners of the box
  std::optional<Vec3> center = {};          ///< center of the ball
  std::optional<double> radius = {};        ///< radius of the ball
};

struct SolverSettings {
  Method method = Method::dynamic;
  Integrator integrator = Integrator::symplectic_euler;
  std::optional<double> time_step;
  double time_step_factor = 0.5;
  double duration = 1;
  Vec3 gravity = Vec3::Zero();
  Precision precision = Precision::binary64;
  NeighborSearch neighbor_search = NeighborSearch::lists;
  std::optional<double> wall_time;
  std::optional<double> residual;  ///< residual of the static method
  int iterations = 200'000;        ///< iterations of the static method, for each frame
  StaticSolver static_solver = StaticSolver::automatic;
};

struct HierarchySettings {
  bool enabled = false;
  bool dynamic = false;
  std::optional<GroupForm> motion;
  std::optional<double> joint_distance;
  double tolerance = 0.15;
  double surface_distance = 0;
  std::optional<std::array<double, 6>> free_region;  ///< x y z of the least corner, of the greatest
  std::string free_bones;
  int min_particles = 4096;
};

struct OutputSettings {
  double interval = 1.0 / 30;
  double checkpoint_interval = 60;
  Encoding encoding = Encoding::zlib;
  bool double_precision = false;
  bool skin_lbs = false;
  bool skin_dqs = false;
  bool export_surface = false;
  bool bonds = false;
  bool volume = false;
  std::string arrays;  ///< see requested_arrays()
  std::string only;    ///< see frame_arrays()
  std::string skin;    ///< see skin_arrays()
  int every = 1;
  std::optional<std::array<double, 6>> region;  ///< x y z of the least corner, of the greatest
  int inside_every = 1;
};

/// Polygons that the copies of a scene share.
class SharedPolygons {
 public:
  SharedPolygons(PolygonSoup soup = {})
      : soup_(std::make_shared<const PolygonSoup>(std::move(soup))) {}
  const PolygonSoup& operator*() const { return *soup_; }

 private:
  std::shared_ptr<const PolygonSoup> soup_;
};

struct Settings {
  BodyOptions body;
  std::vector<PartOptions> bodies;  ///< list bodies: in addition to body.mesh
  MaterialOptions material;
  SkeletonOptions skeleton;
  std::vector<BoneDefinition> bones;  ///< section skeleton
  MotionOptions motion;
  std::vector<TrackDefinition> tracks;  ///< section motion
  BindingOptions binding;
  ContactOptions contact;
  WorldSettings world;
  std::vector<BoundSettings> bound;  ///< section binding, list explicit
  std::vector<LocalMaterialSettings> materials;
  std::vector<SupportSettings> supports;
  std::vector<LoadSettings> loads;
  std::vector<ProbeSettings> probes;
  SolverSettings solver;
  HierarchySettings hierarchy;
  OutputSettings output;

  /// Polygons in place of files: by what body.mesh and the like give instead of a path.
  std::map<std::string, SharedPolygons> meshes;

  /// Where each value was read, by its path: "body.mesh", "skeleton.bones[1].parent".
  std::map<std::string, Place, std::less<>> places;
  std::vector<std::string> warnings;  ///< warnings of words that have changed, with their places

  /// Whether any of its meshes begins with a velocity.
  bool moves_initially() const;

  /// The place of `path`, or of the nearest enclosing path that has one.
  Place place(std::string path) const;
};

}  // namespace sinew
