// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes, what a run leaves behind, and results of finite elements.
#include <cstring>
#include <nlohmann/json.hpp>

#include <sinew/core/hash.h>
#include <sinew/core/json.h>
#include <sinew/io/calculix/frd.h>
#include <sinew/io/checkpoint.h>
#include <sinew/io/series.h>
#include <sinew/io/vtu.h>
#include <sinew/settings/read_scene.h>
#include <sinew/settings/write_scene.h>
#include "targets.h"

namespace sinew::fuzz {
namespace {

/// With the length and the checksum that a checkpoint of these bytes would have: what lies behind
/// those checks is tried too.
std::string sealed(std::string_view bytes) {
  constexpr std::size_t length_at = 16, head = 24, tail = 8;
  std::string text(bytes);
  if (text.size() < head + tail) return text;
  const std::uint64_t length = text.size();
  std::memcpy(&text[length_at], &length, sizeof length);
  Hash hash;
  hash.add(text.data(), text.size() - tail);
  const std::uint64_t sum = hash.value();
  std::memcpy(&text[text.size() - tail], &sum, sizeof sum);
  return text;
}

void try_checkpoint(std::string_view bytes) {
  const auto path = file_of(bytes, "a.bin");
  for (const std::uint64_t particles : {std::uint64_t{3}, std::uint64_t{5}})
    expect_sound_or_refused([&] {
      const Checkpoint read = read_checkpoint(path, particles);
      require(read.run.particles == particles && read.state.order.size() <= bytes.size());
    });
}

}  // namespace

void scene(std::string_view bytes) {
  const auto path = file_of(bytes, "fuzz.yaml");
  expect_sound_or_refused([&] {
    const Settings settings = read_scene(path);
    require(!resolved_scene(settings, path.parent_path()).empty());
  });
}

void checkpoint(std::string_view bytes) {
  try_checkpoint(bytes);
  try_checkpoint(sealed(bytes));
}

void vtu(std::string_view bytes) {
  const auto path = file_of(bytes, "fuzz.vtu");
  expect_sound_or_refused([&] {
    const Dataset data = read_vtu(path);
    const auto points = static_cast<std::int32_t>(data.points.size());
    for (const Vec3& point : data.points) require(point.allFinite());
    for (const std::int32_t point : data.connectivity) require(point >= 0 && point < points);
  });
}

void frd(std::string_view bytes) {
  const auto path = file_of(bytes, "fuzz.frd");
  expect_sound_or_refused([&] {
    const FrdResult result = read_frd(path);
    const std::size_t nodes = result.mesh.nodes.size();
    for (const VolumeElement& element : result.mesh.elements)
      for (const std::uint32_t node : element.used()) require(node < nodes);
    for (const FrdStep& step : result.steps)
      require(step.displacement.size() == nodes &&
              (step.stress.empty() || step.stress.size() == nodes));
  });
}

/// run.json, which is read, changed and written again.
void record(std::string_view bytes) {
  constexpr std::size_t longest_indent = 40;
  const auto json = own_json<nlohmann::ordered_json>(bytes);
  if (json.is_discarded()) return;
  const std::string text = json_text(json, 2);
  require(text.size() <= (6 + longest_indent) * bytes.size() + 10);
  require(own_json<nlohmann::ordered_json>(text) == json || text.find("\xEF\xBF\xBD") != text.npos);
}

void pvd(std::string_view bytes) {
  const auto path = file_of(bytes, "fuzz.pvd");
  expect_sound_or_refused([&] {
    for (const PvdRow& row : read_pvd(path))
      require(std::filesystem::path(row.file).is_relative() &&
              row.file.find("/../") == row.file.npos && !row.file.starts_with("../"));
  });
}

}  // namespace sinew::fuzz
