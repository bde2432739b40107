// SPDX-License-Identifier: GPL-3.0-or-later
#include "config/paths.h"

#include <string>
#include <system_error>

#include "core/settings_table.h"

namespace fs = std::filesystem;

namespace sinew {

fs::path seen_from(const fs::path& folder, const fs::path& path) {
  const fs::path here = ".";
  std::error_code error;
  const fs::path way = fs::proximate(here / path.parent_path(), here / folder, error);
  if (error) return path;
  return way == here ? path.filename() : way / path.filename();
}

std::string path_in(const fs::path& folder, const std::string& path) {
  return path.empty() || fs::path(path).is_absolute() ? path : seen_from(folder, path).string();
}

void open_paths_from_here(Settings& settings, const fs::path& folder) {
  const std::string scene = settings.place("").file;
  for (const auto& row : settings_table()) {
    if (row.kind != FieldKind::path) continue;
    const std::string name = std::string(row.section) + '.' + std::string(row.name);
    const FieldValue value = row.get(settings);
    const auto* path = std::get_if<std::string>(&value);
    if (path == nullptr || settings.place(name).file != scene || fs::path(*path).is_absolute())
      continue;
    row.set(settings, seen_from("", folder / *path).string());
  }
  for (ObstacleSettings& obstacle : settings.world.obstacles)
    if (!obstacle.mesh.empty() && !fs::path(obstacle.mesh).is_absolute())
      obstacle.mesh = seen_from("", folder / obstacle.mesh).string();
}

}  // namespace sinew
