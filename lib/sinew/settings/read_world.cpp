// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/sections.h>

#include <array>
#include <string>
#include <vector>

#include <sinew/settings/detail/entries.h>
#include <sinew/settings/text_file.h>

namespace sinew {
namespace {

bool has_region(const RegionSettings& region) { return region.low || region.center; }

/// Throws unless a key that `owner` needs is given.
void require(bool given, const std::string& path, const std::string& key, const std::string& owner,
             const Settings& settings) {
  if (!given)
    throw bad_input(settings.place(path),
                    path + '.' + key + " is missing, which a " + owner + " needs",
                    "add " + key + ':');
}

bool is_given(const ObstacleSettings& obstacle, std::string_view key) {
  for (const auto& field : obstacle_fields())
    if (field.name == key) {
      const FieldValue value = field.get(obstacle);
      const auto* text = std::get_if<std::string>(&value);
      return !std::holds_alternative<std::monostate>(value) && !(text && text->empty());
    }
  return false;
}

/// Throws unless the keys that a shape needs are given, and sound.
void check_shape(const ObstacleSettings& obstacle, const std::string& path,
                 const Settings& settings) {
  const ObstacleShapeRow& shape = obstacle_shapes()[static_cast<std::size_t>(obstacle.shape)];
  for (const std::string_view key : shape.needs)
    require(is_given(obstacle, key), path, std::string(key), std::string(shape.name), settings);
  if (obstacle.normal.norm() == 0)
    throw bad_input(settings.place(path + ".normal"), "a direction without length",
                    "give [x, y, z], not all zero");
  if (obstacle.size && !(obstacle.size->array() > 0).all())
    throw bad_input(settings.place(path + ".size"), "a box without size along an axis",
                    "give three lengths above 0");
}

void read_obstacle(const YamlNode& item, const std::string& path, ObstacleSettings& obstacle,
                   Settings& settings) {
  static constexpr std::array<std::string_view, 2> lists = {"keys", "friction_keys"};
  read_fields(item, path, obstacle_fields(), lists, obstacle, settings.places);
  check_shape(obstacle, path, settings);
  read_keys(item, path, place_key_fields(), obstacle.keys, settings);
  read_keys(item, path, friction_key_fields(), obstacle.friction_keys, settings, lists[1]);
  if (!obstacle.friction_keys.empty() && obstacle.friction == 0)
    throw bad_input(settings.place(path + ".friction_keys"),
                    path + " has factors on a friction of 0", "add friction: with a coefficient");
  check_axes_of_keys(obstacle.keys, path, settings);
  if (!obstacle.bone.empty() && !obstacle.keys.empty())
    throw bad_input(settings.place(path + ".keys"), path + " has a bone and keys of its own",
                    "keep one of them");
}

void read_pin(const YamlNode& item, const std::string& path, PinSettings& pin, Settings& settings) {
  read_fields(item, path, pin_fields(), "", pin, settings.places);
  check_region(pin.region, path, settings);
  if (!has_region(pin.region))
    throw bad_input(settings.place(path), path + " has no region",
                    "add low: and high: of a box, or center: and radius: of a ball");
}

/// Throws unless the keys that a field's shape needs are given.
void check_field(const FieldSettings& field, const std::string& path, const Settings& settings) {
  const auto need = [&](bool given, const char* key, const std::string& shape) {
    require(given, path, key, "field of shape " + shape, settings);
  };
  const auto need_center = [&](const char* shape) {
    need(field.point.has_value(), "point", shape);
    need(field.strength.has_value(), "strength", shape);
    need(field.core.has_value(), "core", shape);
  };
  switch (field.shape) {
    case FieldShape::uniform:
      return need(field.acceleration.has_value(), "acceleration", "uniform");
    case FieldShape::density:
      return need(field.density.has_value(), "density", "density");
    case FieldShape::attraction:
      return need_center("attraction");
    case FieldShape::swirl:
      if (field.axis.norm() == 0)
        throw bad_input(settings.place(path + ".axis"), "a direction without length",
                        "give [x, y, z], not all zero");
      return need_center("swirl");
  }
}

void read_field(const YamlNode& item, const std::string& path, FieldSettings& field,
                Settings& settings) {
  read_fields(item, path, field_fields(), "keys", field, settings.places);
  check_field(field, path, settings);
  check_region(field.region, path, settings);
  read_keys(item, path, strength_fields(), field.keys, settings);
}

void read_muscle(const YamlNode& item, const std::string& path, MuscleSettings& muscle,
                 Settings& settings) {
  read_fields(item, path, muscle_fields(), "keys", muscle, settings.places);
  check_region(muscle.region, path, settings);
  read_keys(item, path, activation_fields(), muscle.keys, settings);
  if (muscle.bone.empty() && !muscle.direction)
    throw bad_input(settings.place(path), path + " has neither a bone nor a direction",
                    "add bone: with the name of a bone, or direction: [x, y, z]");
  if (muscle.direction && muscle.direction->norm() == 0)
    throw bad_input(settings.place(path + ".direction"), "a direction without length",
                    "give [x, y, z], not all zero");
}

void read_spring(const YamlNode& item, const std::string& path, SpringSettings& spring,
                 Settings& settings) {
  read_fields(item, path, spring_fields(), "keys", spring, settings.places);
  read_keys(item, path, spring_key_fields(), spring.keys, settings);
  if (spring.at.has_value() == spring.particle.has_value())
    throw bad_input(settings.place(path),
                    path + " has " + (spring.at ? "a point and a particle" : "no point"),
                    "give at: [x, y, z] of the body at rest, or particle: ID");
  if (spring.keys.empty())
    throw bad_input(settings.place(path), path + " has no free end",
                    "add keys, as in keys: [{time: 0, to: [0, 0, 1]}]");
}

}  // namespace

void check_axes_of_keys(const std::vector<PlaceKeySettings>& keys, const std::string& path,
                        const Settings& settings) {
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (keys[i].axis.norm() == 0)
      throw bad_input(settings.place(path_of_entry(path, "keys", i) + ".axis"),
                      "a direction without length", "give [x, y, z], not all zero");
}

void check_region(const RegionSettings& region, const std::string& path, const Settings& settings) {
  const bool box = region.low || region.high, ball = region.center || region.radius;
  const Place place = settings.place(path);
  if (box && ball)
    throw bad_input(place, path + " has a region given as a box and as a ball",
                    "keep low and high, or center and radius");
  if (box && !(region.low && region.high))
    throw bad_input(place, path + " has one corner of a box", "give low and high");
  if (ball && !(region.center && region.radius))
    throw bad_input(place, path + " has half of a ball", "give center and radius");
  if (box && !(region.low->array() < region.high->array()).all())
    throw bad_input(settings.place(path + ".low"), path + ".low is not below high on all axes",
                    "give the least corner as low and the greatest as high");
}

namespace {

std::string friction_text(const ObstacleSettings& obstacle, bool first) {
  const auto key_text = [&](const ValueKeySettings& key, bool first_key) {
    return entry_text(friction_key_fields(), key, 8, first && first_key);
  };
  return list_text("friction_keys", obstacle.friction_keys, 6, key_text);
}

}  // namespace

void read_world(const YamlNode& node, Settings& settings) {
  WorldSettings& world = settings.world;
  const auto with = [&](auto read) {
    return [&settings, read](const YamlNode& item, const std::string& path, auto& owner) {
      read(item, path, owner, settings);
    };
  };
  Places& places = settings.places;
  read_entries(node, "world", "obstacles", world.obstacles, places, with(read_obstacle));
  read_entries(node, "world", "pins", world.pins, places, with(read_pin));
  read_entries(node, "world", "fields", world.fields, places, with(read_field));
  read_entries(node, "world", "muscles", world.muscles, places, with(read_muscle));
  read_entries(node, "world", "springs", world.springs, places, with(read_spring));
  check_names(world.obstacles, "world", "obstacles", settings);
  check_names(world.fields, "world", "fields", settings);
  check_names(world.muscles, "world", "muscles", settings);
  check_names(world.springs, "world", "springs", settings);
}

std::string world_text(const Settings& settings, const std::filesystem::path& folder) {
  const WorldSettings& world = settings.world;
  std::string text =
      list_text("obstacles", world.obstacles, 2, [&](ObstacleSettings obstacle, bool first) {
        obstacle.mesh = path_in(folder, obstacle.mesh);
        return entry_text(obstacle_fields(), obstacle, 4, first) +
               keys_text(place_key_fields(), obstacle, 4, first) + friction_text(obstacle, first);
      });
  text += list_text("pins", world.pins, 2, [](const PinSettings& pin, bool first) {
    return entry_text(pin_fields(), pin, 4, first);
  });
  text += list_text("fields", world.fields, 2, [](const FieldSettings& field, bool first) {
    return entry_text(field_fields(), field, 4, first) +
           keys_text(strength_fields(), field, 4, first);
  });
  text += list_text("muscles", world.muscles, 2, [](const MuscleSettings& muscle, bool first) {
    return entry_text(muscle_fields(), muscle, 4, first) +
           keys_text(activation_fields(), muscle, 4, first);
  });
  text += list_text("springs", world.springs, 2, [](const SpringSettings& spring, bool first) {
    return entry_text(spring_fields(), spring, 4, first) +
           keys_text(spring_key_fields(), spring, 4, first);
  });
  return text;
}

}  // namespace sinew
