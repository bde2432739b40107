// SPDX-License-Identifier: GPL-3.0-or-later
#include <set>

#include <sinew/settings/detail/entries.h>
#include <sinew/settings/sections.h>
#include <sinew/settings/text_file.h>

namespace sinew {
namespace {

void check_direction(const std::optional<Vec3>& direction, const std::string& path,
                     const Settings& settings) {
  if (direction && direction->norm() == 0)
    throw bad_input(settings.place(path), "a direction without length",
                    "give [x, y, z], not all zero");
}

void check_part(const PartSettings& part, const std::string& path, const Settings& settings) {
  check_region(part.region, path, settings);
  if (part.point.has_value() != part.normal.has_value())
    throw bad_input(settings.place(path), path + " has half of a plane", "give point and normal");
  check_direction(part.normal, path + ".normal", settings);
  check_direction(part.facing, path + ".facing", settings);
  check_direction(part.axis, path + ".axis", settings);
  const bool around = part.axis_radius || part.facing_axis != AxisSide::none;
  if (part.axis.has_value() != around || part.axis_point.has_value() != around)
    throw bad_input(settings.place(path), path + " has a part of an axis",
                    "give axis and axis_point, and axis_radius, facing_axis or both");
}

void read_support(const YamlNode& item, const std::string& path, SupportSettings& support,
                  Settings& settings) {
  read_fields(item, path, support_fields(), "keys", support, settings.places);
  check_part(support.part, path, settings);
  check_direction(support.hold_along, path + ".hold_along", settings);
  if (support.hold_along && settings.places.find(path + ".hold") != settings.places.end() &&
      support.hold != HeldAxes::xyz)
    throw bad_input(settings.place(path + ".hold_along"),
                    "support '" + support.name + "' has hold and hold_along", "keep one of them");
  read_keys(item, path, place_key_fields(), support.keys, settings);
  check_axes_of_keys(support.keys, path, settings);
  if (support.keys.empty()) return;
  const PlaceKeySettings& first = support.keys.front();
  if (!first.translation.isZero(0) || first.angle != 0)
    throw bad_input(settings.place(path_of_entry(path, "keys", 0)),
                    "the first key of support '" + support.name + "' is not at rest",
                    "begin with a key without translation and angle, as in - time: 0");
}

void read_load(const YamlNode& item, const std::string& path, LoadSettings& load,
               Settings& settings) {
  read_fields(item, path, load_fields(), "keys", load, settings.places);
  check_part(load.part, path, settings);
  read_keys(item, path, factor_fields(), load.keys, settings);
  const int given = (load.force ? 1 : 0) + (load.traction ? 1 : 0) + (load.pressure ? 1 : 0) +
                    (load.gravity ? 1 : 0);
  if (given != 1)
    throw bad_input(
        settings.place(path),
        "load '" + load.name + "' has " + (given == 0 ? "no" : "more than one") + " kind of load",
        "give one of force, traction, pressure and gravity");
}

void read_probe(const YamlNode& item, const std::string& path, ProbeSettings& probe,
                Settings& settings) {
  read_fields(item, path, probe_fields(), "", probe, settings.places);
  check_part(probe.part, path, settings);
  if (probe.at && !probe.part.empty())
    throw bad_input(settings.place(path), "probe '" + probe.name + "' has a point and a part",
                    "keep one of them");
}

void read_material(const YamlNode& item, const std::string& path, LocalMaterialSettings& material,
                   Settings& settings) {
  read_fields(item, path, material_fields(), "", material, settings.places);
  check_part(material.part, path, settings);
  if (!material.is_elastic() && !material.has_strength() && !material.density)
    throw bad_input(settings.place(path), "material '" + material.name + "' has nothing of its own",
                    "give young_modulus, poisson_ratio, density, breaking_strain or yield_strain");
}

}  // namespace

void read_machine(const YamlNode& scene, Settings& settings) {
  const auto with = [&](auto read) {
    return [&settings, read](const YamlNode& item, const std::string& path, auto& owner) {
      read(item, path, owner, settings);
    };
  };
  read_entries(scene, "", "materials", settings.materials, settings.places, with(read_material));
  read_entries(scene, "", "supports", settings.supports, settings.places, with(read_support));
  read_entries(scene, "", "loads", settings.loads, settings.places, with(read_load));
  read_entries(scene, "", "probes", settings.probes, settings.places, with(read_probe));
}

void check_names_of_machine(const Settings& settings) {
  check_names(settings.materials, "", "materials", settings);
  check_names(settings.supports, "", "supports", settings);
  check_names(settings.loads, "", "loads", settings);
  check_names(settings.probes, "", "probes", settings);
  std::set<std::string> taken;
  for (const SupportSettings& support : settings.supports) taken.insert(support.name);
  const auto take = [&](const auto& list, const std::string& path, const char* name) {
    for (std::size_t i = 0; i < list.size(); ++i)
      if (!taken.insert(list[i].name).second)
        throw bad_input(settings.place(path_of_entry(path, name, i) + ".name"),
                        "two of supports, loads and springs are named '" + list[i].name + '\'',
                        "give each a name of its own");
  };
  take(settings.loads, "", "loads");
  take(settings.world.springs, "world", "springs");
}

std::string machine_text(const Settings& settings, const std::filesystem::path& folder) {
  std::string text;
  if (!settings.materials.empty())
    text += '\n' + list_text("materials", settings.materials, 0,
                             [&](LocalMaterialSettings material, bool first) {
                               material.part.mesh = path_in(folder, material.part.mesh);
                               return entry_text(material_fields(), material, 2, first);
                             });
  if (!settings.supports.empty())
    text += '\n' + list_text("supports", settings.supports, 0,
                             [](const SupportSettings& support, bool first) {
                               return entry_text(support_fields(), support, 2, first) +
                                      keys_text(place_key_fields(), support, 2, first);
                             });
  if (!settings.loads.empty())
    text += '\n' + list_text("loads", settings.loads, 0, [](const LoadSettings& load, bool first) {
              return entry_text(load_fields(), load, 2, first) +
                     keys_text(factor_fields(), load, 2, first);
            });
  if (!settings.probes.empty())
    text +=
        '\n' + list_text("probes", settings.probes, 0, [](const ProbeSettings& probe, bool first) {
          return entry_text(probe_fields(), probe, 2, first);
        });
  return text;
}

}  // namespace sinew
