// SPDX-License-Identifier: GPL-3.0-or-later
// The one table of settings. The scene's parser, the resolved scene, --set, --help and the README's
// table are generated from it: to add a setting, add its member in settings.h and its row in
// table.cpp.
//
//     for (const Field<Settings>& row : settings_table()) print(row.section, row.name, row.help);
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <sinew/core/text.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// pairs: of names; or one of the choices.
enum class FieldKind { number, whole, text, path, choice, flag, vector, numbers, pairs };

/// The value of a field. monostate: not given, written as the field's `absent` word.
using FieldValue = std::variant<std::monostate, double, int, bool, std::string, Vec3,
                                std::vector<double>, std::vector<NamePair>>;

struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool above_low = false;  ///< low itself is not allowed

  bool holds(double value) const {
    return (above_low ? value > low : value >= low) && value <= high;
  }
  std::string text() const;  ///< "> 0", "0 to 1", "> 0, up to 1"; "" without limits
};

/// One key of a mapping that describes an Owner (Settings by section, a bone, a track, a key).
template <class Owner>
struct Field {
  std::string_view section;  ///< "" for the members of list entries
  std::string_view name;
  FieldKind kind;
  std::string_view unit;  ///< "" for pure numbers
  std::string_view help;  ///< one line
  std::function<FieldValue(const Owner&)> get;
  std::function<void(Owner&, const FieldValue&)>
      set;  ///< the value has kind `kind` and is in range
  Range range = {};
  std::vector<std::string_view> choices = {};
  std::string_view absent = {};  ///< the word for "not given" where that is allowed: "auto", "none"
  bool required = false;
  std::size_t count = 0;  ///< length of a list of numbers; 0: any but none
};

std::span<const Field<Settings>> settings_table();
std::span<const Field<PartOptions>> part_fields();       ///< bodies[]
std::span<const Field<BoneDefinition>> bone_fields();    ///< skeleton.bones[]
std::span<const Field<LimitDefinition>> limit_fields();  ///< skeleton.bones[].limits
std::span<const Field<TrackDefinition>> track_fields();  ///< motion.tracks[] (and its list `keys`)
std::span<const Field<BoundSettings>> bound_fields();    ///< binding.explicit[]
std::span<const Field<KeyDefinition>> key_fields();      ///< motion.tracks[].keys[]

// Lists of the section world, and the keys of their entries.
std::span<const Field<ObstacleSettings>> obstacle_fields();   ///< world.obstacles[]
std::span<const Field<PlaceKeySettings>> place_key_fields();  ///< world.obstacles[].keys[]
std::span<const Field<ValueKeySettings>>
friction_key_fields();                                       ///< world.obstacles[].friction_keys[]
std::span<const Field<PinSettings>> pin_fields();            ///< world.pins[]
std::span<const Field<FieldSettings>> field_fields();        ///< world.fields[]
std::span<const Field<ValueKeySettings>> strength_fields();  ///< world.fields[].keys[]
std::span<const Field<MuscleSettings>> muscle_fields();      ///< world.muscles[]
std::span<const Field<ValueKeySettings>> activation_fields();   ///< world.muscles[].keys[]
std::span<const Field<SpringSettings>> spring_fields();         ///< world.springs[]
std::span<const Field<SpringKeySettings>> spring_key_fields();  ///< world.springs[].keys[]

std::span<const Field<LocalMaterialSettings>> material_fields();  ///< materials[]

// Lists of a testing machine, and the keys of their entries; those of supports are as obstacles'.
std::span<const Field<SupportSettings>> support_fields();  ///< supports[]
std::span<const Field<LoadSettings>> load_fields();        ///< loads[]
std::span<const Field<ValueKeySettings>> factor_fields();  ///< loads[].keys[]
std::span<const Field<ProbeSettings>> probe_fields();      ///< probes[]

/// A shape of obstacles: the word for it, and the keys that it needs.
struct ObstacleShapeRow {
  std::string_view name;
  std::vector<std::string_view> needs;
};

/// In the order of ObstacleShape.
std::span<const ObstacleShapeRow> obstacle_shapes();

/// The order of sections in a scene.
std::span<const std::string_view> sections();

}  // namespace sinew
