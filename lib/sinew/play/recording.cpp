// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/play/recording.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/rig/key_table.h>
#include <sinew/settings/write_scene.h>

namespace sinew {
namespace {

constexpr std::size_t recent_keys = 3;

bool is_rest(const LocalMotion& key) {
  return key.rotation.coeffs() == Quat::Identity().coeffs() && key.translation.isZero(0) &&
         key.twist == 0;
}

std::filesystem::path table_of(const std::filesystem::path& folder, const std::string& name) {
  return folder / (name + ".keys.csv");
}

/// The longest interval of whole keys, no longer than `interval` (s), that divides all of them.
std::int64_t keys_per_frame(const KeyGrid& grid, double interval, std::int64_t keys) {
  auto per = std::max<std::int64_t>(1, std::llround(interval / grid.interval()));
  while (keys % per != 0) --per;
  return per;
}

template <class Key>
void forget_after(std::vector<Key>& keys, double time) {
  while (!keys.empty() && keys.back().time > time) keys.pop_back();
}

}  // namespace

KeyGrid key_grid(double max_step, double keys_per_second) {
  KeyGrid grid;
  grid.steps = static_cast<int>(std::ceil(1 / (keys_per_second * max_step)));
  grid.step = static_cast<float>(1 / (keys_per_second * grid.steps));  // 24 binary digits
  return grid;
}

Recording::Recording(Settings scene, Skeleton skeleton, KeyGrid grid, bool twists)
    : scene_(std::move(scene)),
      skeleton_(std::move(skeleton)),
      grid_(grid),
      twists_(twists),
      moved_(skeleton_.size(), 0) {}

void Recording::add(std::int64_t number, const BoneKeys& keys) {
  last_ = number;
  for (std::size_t b = 0; b < keys.size(); ++b) {
    const int bone = static_cast<int>(b);
    if (moved_[b] == 0 && is_rest(keys[b])) continue;
    if (moved_[b] == 0 && number > 0) rows_.push_back({number - 1, bone, {}});
    moved_[b] = 1;
    rows_.push_back({number, bone, keys[b]});
  }
  recent_.push_back(keys);
  if (recent_.size() > recent_keys) recent_.erase(recent_.begin());
}

const BoneKeys& Recording::at(std::int64_t number) const {
  return recent_[recent_.size() - 1 - static_cast<std::size_t>(last_ - number)];
}

Motion Recording::motion_of(std::int64_t first, const std::vector<BoneKeys>& keys) const {
  std::vector<TrackDefinition> tracks;
  for (std::size_t b = 0; b < skeleton_.size(); ++b) {
    if (moved_[b] == 0) continue;
    TrackDefinition& track = tracks.emplace_back();
    track.bone = skeleton_.bones[b].name;
    track.interpolation = Interpolation::linear;
    for (std::size_t k = 0; k < keys.size(); ++k)
      track.keys.push_back(key_of(keys[k][b], grid_.time(first + static_cast<std::int64_t>(k))));
  }
  return played(make_motion(tracks, skeleton_), {});
}

void Recording::truncate(std::int64_t number, std::vector<BoneKeys> keys) {
  last_ = number;
  recent_ = std::move(keys);
  while (!rows_.empty() && rows_.back().number > number) rows_.pop_back();
  // A bone that began to move later has a row of rest before, at which it still is.
  std::fill(moved_.begin(), moved_.end(), 0);
  for (const Row& row : rows_) moved_[static_cast<std::size_t>(row.bone)] = 1;
  if (rows_.size() < kept_) table_.reset();  // is written anew
  const double time = grid_.time(number);
  for (MuscleSettings& muscle : scene_.world.muscles) forget_after(muscle.keys, time);
  for (ObstacleSettings& one : scene_.world.obstacles) forget_after(one.friction_keys, time);
  for (LoadSettings& load : scene_.loads) forget_after(load.keys, time);
  for (SpringSettings& spring : scene_.world.springs) forget_after(spring.keys, time);
}

Settings Recording::settings_until(std::int64_t end, const std::filesystem::path& table) const {
  Settings out = scene_;
  const std::int64_t per =
      keys_per_frame(grid_, out.output.interval, std::max<std::int64_t>(end, 1));
  out.motion.file = table.string();
  out.solver.time_step = grid_.step;
  out.output.interval = grid_.time(per);
  out.solver.duration = grid_.time(std::max<std::int64_t>(end, 1));
  return out;
}

std::string Recording::rows_text(std::size_t from) const {
  std::string text;
  for (std::size_t k = from; k < rows_.size(); ++k)
    text += key_row(skeleton_.bones[static_cast<std::size_t>(rows_[k].bone)].name,
                    key_of(rows_[k].key, grid_.time(rows_[k].number)), twists_);
  return text;
}

void Recording::write_scene(const std::filesystem::path& folder, const std::string& name,
                            std::int64_t end) const {
  const Settings settings = settings_until(end, table_of(folder, name));
  const std::filesystem::path path = folder / (name + ".yaml");
  write_file(path, readable_scene(settings, path));
}

void Recording::write(const std::filesystem::path& folder, const std::string& name,
                      std::int64_t end) const {
  write_file(table_of(folder, name), key_table_header(twists_) + rows_text(0));
  write_scene(folder, name, end);
}

void Recording::keep(const std::filesystem::path& folder, const std::string& name,
                     std::int64_t end) {
  const std::filesystem::path path = table_of(folder, name);
  if (!table_) {
    const std::string text = key_table_header(twists_) + rows_text(0);
    write_file(path, text);
    table_ = std::make_unique<GrowingFile>(path, text.size());
  } else if (kept_ < rows_.size()) {
    const std::string text = rows_text(kept_);
    table_->add(text.data(), text.size());
  }
  kept_ = rows_.size();
  write_scene(folder, name, end);
}

}  // namespace sinew
