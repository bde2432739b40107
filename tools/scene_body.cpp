// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_body.h"

#include <nlohmann/json.hpp>

#include "command.h"
#include "core/closest_packing.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/scene_text.h"
#include "core/settings_table.h"
#include "mesh/read_surface.h"

namespace sinew {
namespace {

constexpr std::uint64_t largest_mesh = std::uint64_t{4} << 30;  // bytes

/// Runs `job`; what it throws is told as reached through a line of the scene.
template <class Job>
auto told_at(const Settings& settings, const char* key, Job&& job) {
  try {
    return job();
  } catch (const Error& error) {
    throw error.within(settings.place(key));
  }
}

}  // namespace

bool is_scene(const std::filesystem::path& path) {
  return path.extension() == ".yaml" || path.extension() == ".yml";
}

Surface read_mesh(const Settings& settings) {
  return told_at(settings, "body.mesh", [&] { return read_surface(settings.body.mesh); });
}

Filling fill_body(const Settings& settings, const Surface& surface) {
  const BodySettings& body = settings.body;
  const PackOptions options{body.packing, body.radius, body.count, settings.material.density};
  return told_at(settings, body.radius ? "body.radius" : "body.count",
                 [&] { return pack(surface, options); });
}

BodyFile body_file(const Filling& filling, const std::string& origin) {
  nlohmann::ordered_json meta;
  meta["program"] = "sinew";
  meta["version"] = version();
  meta["origin"] = origin;
  for (const ReportRow& row : rows_of(filling.report))
    meta["fill"][row.key] = nlohmann::ordered_json::parse(row.value, nullptr, false);
  BodyFile body;
  body.particles = filling.particles;
  body.neighbours = filling.neighbours;
  body.component = filling.component;
  body.meta = meta.dump();
  return body;
}

std::string origin_of(const Settings& settings) {
  Hash hash;
  hash.add(
      told_at(settings, "body.mesh", [&] { return read_file(settings.body.mesh, largest_mesh); }));
  for (const auto& field : settings_table())
    if ((field.section == "body" && field.name != "mesh") || field.name == "density")
      hash.add(scene_text(field.get(settings), "") + '\n');
  return hash_text(hash.value());
}

std::optional<BodyFile> body_of_scene(const std::filesystem::path& path,
                                      const std::string& origin) {
  std::error_code unreachable;
  if (!std::filesystem::exists(path, unreachable)) return std::nullopt;
  try {
    BodyFile body = read_body(path);
    const auto meta = nlohmann::json::parse(body.meta, nullptr, false);
    if (meta.is_object() && meta.value("origin", "") == origin) return body;
  } catch (const Error&) {
    // Not a body, or a torn one: it is made again.
  }
  return std::nullopt;
}

}  // namespace sinew
