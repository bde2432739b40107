// SPDX-License-Identifier: GPL-3.0-or-later
// Descriptions of a body, its material, its bones and their motion: plain values with their
// defaults, as scenes hold them and algorithms take them. SI units, angles in degrees; "radii" are
// multiples of the particle radius. The table of settings (settings/table.h) documents each value.
//
//     MaterialOptions options;
//     options.young_modulus = 5e3;
//     const Material material = make_material(options, {radius, mass});
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/vector.h>

namespace sinew {

/// fcc, hcp: closest packings; random: no order; conformal: fcc, its outer layer along the surface.
enum class Packing { fcc, hcp, random, conformal };
/// The lattice that a packing is, or comes from.
constexpr Packing lattice_of(Packing packing) {
  return packing == Packing::hcp ? Packing::hcp : Packing::fcc;
}
constexpr bool is_lattice(Packing packing) { return packing == lattice_of(packing); }

enum class LengthUnit { m, dm, cm, mm, um, inch, foot };
enum class FillRule { unite, hollow };
enum class Keep { center, sphere };
enum class Axis { x, y, z, minus_x, minus_y, minus_z };

/// One of the unit, m.
double meters(LengthUnit unit);

struct BodyOptions {
  std::string mesh = {};  ///< a path; relative to the scene's folder until the scene is read
  LengthUnit unit = LengthUnit::m;
  double scale = 1;
  Axis up = Axis::z;
  std::optional<Axis> forward = {};
  Vec3 rotation = Vec3::Zero();
  Vec3 offset = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();          ///< initial, m/s
  Vec3 angular_velocity = Vec3::Zero();  ///< initial, about the center of mass, degrees/s
  std::optional<double> level = {};      ///< value of an image at the surface
  double weld = 0;
  FillRule rule = FillRule::unite;
  bool close_holes = false;
  std::optional<double> wrap = {};
  std::optional<double> thickness = {};
  std::optional<double> radius = {};
  std::optional<int> count = {};
  Packing packing = Packing::fcc;
  std::optional<Vec3> lattice_origin = {};
  std::optional<Vec3> lattice_rotation = Vec3::Zero();  ///< none: any, by the seed
  int seed = 1;
  Keep keep = Keep::center;
  double clearance = 0;

  bool moves() const { return !velocity.isZero(0) || !angular_velocity.isZero(0); }
};

/// A further mesh of the body. Of `body` the keys that place and repair the mesh count.
struct PartOptions {
  BodyOptions body;
  std::optional<double> young_modulus;  ///< Pa; by default the material's
};

enum class MaterialModel { paper, bonded, bonded_volume };

/// What a scene calls a model, and what it can do: its forces are in material/laws.h.
struct MaterialModelRow {
  std::string_view name;
  bool has_bonds;     ///< between neighbors at rest, which may break, yield and relax
  bool keeps_volume;  ///< with a Poisson's ratio of one's choice
};
/// In the order of MaterialModel.
inline constexpr std::array<MaterialModelRow, 3> material_models = {
    {{"paper", false, false}, {"bonded", true, false}, {"bonded_volume", true, true}}};
constexpr bool has_bonds(MaterialModel model) {
  return material_models[static_cast<std::size_t>(model)].has_bonds;
}
constexpr bool keeps_volume(MaterialModel model) {
  return material_models[static_cast<std::size_t>(model)].keeps_volume;
}

/// In the order of material_presets(), which has their words.
enum class MaterialPresetName {
  none,
  fat,
  muscle,
  skin,
  cartilage,
  bone,
  gelatin,
  natural_rubber,
  silicone,
  silicone_20a,
  silicone_40a,
  silicone_60a,
  rubber_foam,
  clay
};
enum class Cohesion { all, initial_neighbors };
enum class DampingForm { paper, symmetric, central, rigid };
/// Whether eq. 2 acts along the pairs alone.
constexpr bool acts_along_pairs(DampingForm form) {
  return form == DampingForm::central || form == DampingForm::rigid;
}

struct MaterialOptions {
  MaterialPresetName preset = MaterialPresetName::none;
  MaterialModel model = MaterialModel::paper;
  Cohesion cohesion = Cohesion::all;
  double density = 1000;
  double young_modulus = 10e3;
  std::optional<Vec3> modulus_direction;
  double poisson_ratio = 0.45;
  std::optional<bool> isotropic;  ///< default: true, in HCP false
  std::optional<double> k1;
  std::optional<double> k2;
  double lambda = 1;
  double a = 2;
  double b = 2.6;
  double damping = 0.5;
  std::optional<double> damping_ratio;
  std::optional<DampingForm> damping_form;      ///< default: rigid with bonds, else the paper's
  std::optional<std::vector<double>> rayleigh;  ///< alpha, 1/s, and beta, s
  std::optional<double> breaking_strain;
  std::optional<double> fracture_energy;
  std::optional<double> yield_strain;
  std::optional<double> creep_rate;  ///< default follows the scene's motion: see creep_rate_of()
  std::optional<std::vector<double>> relaxation_shares, relaxation_times;  ///< g_i and tau_i
  double friction = 0;
};

inline constexpr std::size_t max_relaxation_branches = 4;  ///< room in kernel::Bonds

/// Whether bonds of first and second neighbors, with factors, make the packed material isotropic.
constexpr bool is_isotropic(const MaterialOptions& material, Packing packing) {
  return has_bonds(material.model) && material.isotropic.value_or(packing != Packing::hcp);
}

// Materials by name: the values of material.preset, each with its source.

struct MaterialPreset {
  std::string_view name;  ///< the word by which a scene chooses it
  double density;         ///< kg/m^3
  double young_modulus;   ///< Pa
  double poisson_ratio;   ///< in the range of bonded_volume
  /// Ratio of the lowest elastic mode: our choice, such bodies swing once or twice.
  double damping_ratio;
  std::optional<double> yield_strain;  ///< strain at which materials that flow yield
  std::string_view what, source;
};

/// All but none.
std::span<const MaterialPreset> material_presets();

/// nullptr for none.
const MaterialPreset* preset_named(MaterialPresetName name);

enum class Fit { none, mesh };

struct SkeletonOptions {
  std::string file;  ///< a path, as body.mesh; none once a file of YAML has been read
  double scale = 1;
  Axis up = Axis::z;
  std::optional<Axis> forward;
  Vec3 rotation = Vec3::Zero();
  Vec3 offset = Vec3::Zero();
  Fit fit = Fit::none;
  std::optional<double> rest_at = {};  ///< s of the clip: the pose there is the rest pose
};

/// Rotates the directions of a mesh or a rig into the scene's: up becomes z, forward x. Exact.
Mat3 to_scene(const BodyOptions& settings);
Mat3 to_scene(const SkeletonOptions& settings);

/// How the points of a file come into the scene: turned, scaled, then moved by `offset` (m).
struct Placement {
  double scale = 1;
  Mat3 turn = Mat3::Identity();
  Vec3 offset = Vec3::Zero();

  bool is_identity() const { return scale == 1 && turn == Mat3::Identity() && offset.isZero(0); }
  Vec3 operator()(const Vec3& point) const { return scale * (turn * point) + offset; }
};

/// Combines unit, scale, up and forward, rotation and offset.
Placement placement_of(const BodyOptions& settings);
Placement placement_of(const SkeletonOptions& settings);

/// About x, then y, then z, degrees; exact in right angles.
Mat3 rotation_of(const Vec3& degrees_about_axes);
/// The angles of that rotation, degrees, y within 90; right angles exact.
Vec3 angles_of(const Mat3& rotation);

struct LimitDefinition {
  std::optional<double> swing = {};
  std::optional<std::array<double, 2>> twist = {};
};

struct BoneDefinition {
  std::string name = {};
  std::string parent = {};
  std::optional<Vec3> head = {};  ///< the parent's tail when not given
  std::optional<Vec3> tail = {};  ///< this or length
  std::optional<double> length = {};
  std::optional<Vec3> direction = {};  ///< with length; the parent's when not given
  std::optional<bool> connected = {};
  double roll = 0;
  double stiffness = 1;  ///< these three: factors on the binding's
  double twist_stiffness = 1;
  double axial_stiffness = 1;
  LimitDefinition limits = {};
};

enum class Interpolation { step, linear, smooth, cubic };
enum class Extrapolation { hold, loop, ping_pong };

enum class Positions { replace, add };
/// Where a body is when its motion begins; automatic: in the first pose where that is far.
enum class Begin { rest, pose, automatic };

using NamePair = std::array<std::string, 2>;

struct MotionOptions {
  std::string file;  ///< a path, as body.mesh; none once a file of YAML has been read
  std::string clip;
  std::vector<NamePair> names = {};  ///< [bone of the skeleton, joint of the clip]
  double start = 0;
  std::optional<double> end;
  std::optional<double> frame_rate;
  Positions positions = Positions::replace;
  Extrapolation extrapolation = Extrapolation::hold;
  double speed = 1;
  std::optional<double> preroll = {};
  Begin begin = Begin::rest;
};

struct KeyDefinition {
  std::optional<double> time = {};  ///< this or frame
  std::optional<double> frame = {};
  std::optional<Vec3> axis = {};
  std::optional<double> angle = {};
  std::optional<Vec3> euler = {};
  std::optional<std::array<double, 4>> quaternion = {};  ///< w, x, y, z
  double twist = 0;
  Vec3 translation = Vec3::Zero();
  double stretch = 1;
};

struct TrackDefinition {
  std::string bone = {};
  Interpolation interpolation = Interpolation::smooth;
  std::string order = "xyz";
  std::vector<KeyDefinition> keys = {};
};

enum class BoneForce { paper, anchor };
enum class TwistForm { servo, open_loop };
enum class BindMethod { nearest, inside, file };

struct BindingOptions {
  BindMethod method = BindMethod::nearest;
  std::optional<double> core_radius;
  BoneForce force = BoneForce::paper;
  TwistForm twist_form = TwistForm::servo;
  double stiffness = 1.6;
  double twist_stiffness = 1.6;
  double axial_stiffness = 0.64;
  double bone_damping = 1;
  double joint_zone = 0;
  double rigid_below = 0;   ///< particles across
  double soften_below = 0;  ///< particles of a bone
  std::optional<double> max_force = {};
};

/// Bones whose flesh passes through each other: named, or found along the motion.
struct PassThroughOptions {
  bool automatic = false;
  std::vector<NamePair> pairs = {};  ///< names of bones

  bool any() const { return automatic || !pairs.empty(); }
};

struct ContactOptions {
  PassThroughOptions pass_through = {};
};

enum class Integrator { symplectic_euler, explicit_euler, velocity_verlet };
enum class Method { dynamic, static_equilibrium };
/// How equilibria are found; automatic: by Newton's method where that pays.
enum class StaticSolver { automatic, newton, relaxation };
enum class Precision { binary64, binary32 };
enum class NeighborSearch { lists, cells };
enum class GroupForm { affine, cubic };

enum class Encoding { zlib, lz4, raw, none };

}  // namespace sinew
