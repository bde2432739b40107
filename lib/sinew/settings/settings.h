// SPDX-License-Identifier: GPL-3.0-or-later
// Everything a scene says, as plain values with their defaults. SI units, angles in degrees,
// "radii" are multiples of the particle radius. What each key means stands in settings_table.cpp.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/vector.h>

namespace sinew {

enum class Packing { fcc, hcp };
enum class LengthUnit { m, dm, cm, mm, um, inch, foot };
enum class FillRule { unite, hollow };
enum class Keep { centre, sphere };
enum class Axis { x, y, z, minus_x, minus_y, minus_z };

/// One of the unit, m.
double metres(LengthUnit unit);

struct BodySettings {
  std::string mesh;  ///< a path; relative to the scene's folder until the scene is read
  LengthUnit unit = LengthUnit::m;
  double scale = 1;
  Axis up = Axis::z;
  std::optional<Axis> forward;
  double weld = 0;
  FillRule rule = FillRule::unite;
  bool close_holes = false;
  std::optional<double> wrap;
  std::optional<double> thickness;
  std::optional<double> radius;
  std::optional<int> count;
  Packing packing = Packing::fcc;
  std::optional<Vec3> lattice_origin;
  Vec3 lattice_rotation = Vec3::Zero();
  Keep keep = Keep::centre;
  double clearance = 0;
};

enum class MaterialModel { paper, bonded, bonded_volume };
enum class MaterialPresetName { none, fat, muscle, skin, silicone, rubber_foam, clay };
enum class Cohesion { all, initial_neighbours };
enum class DampingForm { paper, symmetric, central };

struct MaterialSettings {
  MaterialPresetName preset = MaterialPresetName::none;
  MaterialModel model = MaterialModel::paper;
  Cohesion cohesion = Cohesion::all;
  double density = 1000;
  double young_modulus = 10e3;
  std::optional<Vec3> modulus_direction;
  double poisson_ratio = 0.45;
  std::optional<double> k1;
  std::optional<double> k2;
  double lambda = 1;
  double a = 2;
  double b = 2.6;
  double damping = 0.5;
  std::optional<double> damping_ratio;
  DampingForm damping_form = DampingForm::paper;
  std::optional<double> breaking_strain;
  std::optional<double> yield_strain;
  double creep_rate = 1;
};

struct SkeletonSettings {
  std::string file;  ///< a path, as body.mesh; none once a file of YAML has been read
  double scale = 1;
  Axis up = Axis::z;
  std::optional<Axis> forward;
};

/// Turns the own directions of a mesh or a rig into the scene's: up becomes z, forward x. Exact.
Mat3 to_scene(const BodySettings& settings);
Mat3 to_scene(const SkeletonSettings& settings);

struct LimitSettings {
  std::optional<double> swing = {};
  std::optional<std::array<double, 2>> twist = {};
};

struct BoneSettings {
  std::string name;
  std::string parent;
  std::optional<Vec3> head;       ///< the parent's tail when not given
  std::optional<Vec3> tail = {};  ///< this or length
  std::optional<double> length = {};
  std::optional<Vec3> direction = {};  ///< with length; the parent's when not given
  std::optional<bool> connected = {};
  double roll = 0;
  double stiffness = 1;  ///< these three: factors on the binding's
  double twist_stiffness = 1;
  double axial_stiffness = 1;
  LimitSettings limits = {};
};

enum class Interpolation { step, linear, smooth, cubic };
enum class Extrapolation { hold, loop, ping_pong };

enum class Positions { replace, add };

struct MotionSettings {
  std::string file;  ///< a path, as body.mesh; none once a file of YAML has been read
  std::string clip;
  double start = 0;
  std::optional<double> end;
  std::optional<double> frame_rate;
  Positions positions = Positions::replace;
  Extrapolation extrapolation = Extrapolation::hold;
  double preroll = 0;
};

struct KeySettings {
  std::optional<double> time;  ///< this or frame
  std::optional<double> frame;
  std::optional<Vec3> axis;
  std::optional<double> angle;
  std::optional<Vec3> euler;
  std::optional<std::array<double, 4>> quaternion;  ///< w, x, y, z
  double twist = 0;
  Vec3 translation = Vec3::Zero();
  double stretch = 1;
};

struct TrackSettings {
  std::string bone;
  Interpolation interpolation = Interpolation::smooth;
  std::string order = "xyz";
  std::vector<KeySettings> keys;
};

enum class BoneForce { paper, anchor };
enum class TwistForm { servo, open_loop };
enum class BindMethod { nearest, inside, file };

struct BindingSettings {
  BindMethod method = BindMethod::nearest;
  std::optional<double> core_radius;
  BoneForce force = BoneForce::paper;
  TwistForm twist_form = TwistForm::servo;
  double stiffness = 1.6;
  double twist_stiffness = 1.6;
  double axial_stiffness = 0.64;
  double bone_damping = 1;
  double joint_zone = 0;
};

/// A box (low, high) or a ball (centre, radius) of the scene; none of them: everywhere.
struct RegionSettings {
  std::optional<Vec3> low = {}, high = {};
  std::optional<Vec3> centre = {};
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
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();  ///< of a plane
  std::optional<Vec3> centre = {};
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
  std::optional<Vec3> density = {};       ///< of force
  std::optional<Vec3> point = {};         ///< of attraction, or on the axis of a swirl
  Vec3 axis = Vec3::UnitZ();              ///< of a swirl
  std::optional<double> strength = {};    ///< acceleration of attraction and swirl
  std::optional<double> core = {};        ///< of attraction and swirl
  RegionSettings region = {};
  std::vector<ValueKeySettings> keys = {};  ///< of strength
};

struct MuscleSettings {
  std::string name;
  std::string bone;
  std::optional<Vec3> direction = {};
  double strength = 0;
  RegionSettings region = {};
  std::vector<ValueKeySettings> keys = {};  ///< of activation
};

struct WorldSettings {
  double drag = 0;
  std::vector<ObstacleSettings> obstacles = {};
  std::vector<PinSettings> pins = {};
  std::vector<FieldSettings> fields = {};
  std::vector<MuscleSettings> muscles = {};

  /// Whether nothing is in it.
  bool empty() const {
    return drag == 0 && obstacles.empty() && pins.empty() && fields.empty() && muscles.empty();
  }
};

/// Particles that belong to a bone, whatever is near: by number, in a box, or in a ball.
struct BoundSettings {
  std::string bone;  ///< "": to none
  std::optional<std::vector<double>> ids = {};
  std::optional<Vec3> low = {}, high = {};  ///< corners of the box
  std::optional<Vec3> centre = {};          ///< of the ball
  std::optional<double> radius = {};        ///< of the ball
};

enum class Integrator { symplectic_euler, explicit_euler, velocity_verlet };
enum class Precision { binary64, binary32 };
enum class NeighbourSearch { lists, cells };

struct SolverSettings {
  Integrator integrator = Integrator::symplectic_euler;
  std::optional<double> time_step;
  double time_step_factor = 0.5;
  double duration = 1;
  Vec3 gravity = Vec3::Zero();
  Precision precision = Precision::binary64;
  NeighbourSearch neighbour_search = NeighbourSearch::lists;
  std::optional<double> wall_time;
};

enum class Encoding { zlib, lz4, raw, none };

struct OutputSettings {
  double interval = 1.0 / 30;
  double checkpoint_interval = 60;
  Encoding encoding = Encoding::zlib;
  bool double_precision = false;
  bool skin_lbs = false;
  bool skin_dqs = false;
  bool export_surface = false;
  std::string arrays;  ///< see requested_arrays()
};

struct Settings {
  BodySettings body;
  MaterialSettings material;
  SkeletonSettings skeleton;
  std::vector<BoneSettings> bones;  ///< section skeleton
  MotionSettings motion;
  std::vector<TrackSettings> tracks;  ///< section motion
  BindingSettings binding;
  WorldSettings world;
  std::vector<BoundSettings> bound;  ///< section binding, list explicit
  SolverSettings solver;
  OutputSettings output;

  /// Where each value was read, by its path: "body.mesh", "skeleton.bones[1].parent".
  std::map<std::string, Place, std::less<>> places;

  /// The place of `path`, or of the nearest enclosing path that has one.
  Place place(std::string path) const;
};

// Materials by name: what material.preset stands for, each with its source.

struct MaterialPreset {
  MaterialPresetName name;
  double density;        ///< kg/m^3
  double young_modulus;  ///< Pa
  double poisson_ratio;  ///< within what bonded_volume reaches
  double damping_ratio;  ///< of the first bending: our choice, such bodies swing once or twice
  std::optional<double> yield_strain;  ///< of one that flows
  std::string_view what, source;
};

/// In the order of the names, without none.
std::span<const MaterialPreset> material_presets();

/// nullptr for none.
const MaterialPreset* preset_named(MaterialPresetName name);

}  // namespace sinew
