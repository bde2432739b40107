// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/play/live_view.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include <sinew/core/error.h>
#include <sinew/core/json.h>
#include <sinew/core/text.h>
#include <sinew/metrics/particle_values.h>
#include <sinew/run/world_shown.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;

constexpr double page_share = 0.7;  // share of what a report may take, in one frame

/// The cube around all places, m.
struct Cube {
  Vec3 low = Vec3::Zero();
  double edge = 1;
};

Cube cube_of(std::initializer_list<const Points*> all) {
  Box box;
  for (const Points* places : all)
    for (const Vec3& place : *places) box.extend(place);
  if (box.isEmpty()) return {};
  return {box.min(), std::max(box.sizes().maxCoeff(), 1e-12)};
}

void append(std::string& bytes, const Points& places, const Cube& cube) {
  for (const Vec3& place : places)
    for (int k = 0; k < 3; ++k) {
      const double fraction = std::clamp((place[k] - cube.low[k]) / cube.edge, 0.0, 1.0);
      const auto whole = static_cast<unsigned>(std::lround(65535 * fraction));
      bytes += static_cast<char>(whole & 255);
      bytes += static_cast<char>(whole >> 8);
    }
}

Points chosen(const Points& all, const std::vector<std::uint32_t>& which) {
  Points some;
  some.reserve(which.size());
  for (const std::uint32_t i : which) some.push_back(all[i]);
  return some;
}

Points ends_of_bones(const Skeleton& skeleton, const Pose& pose) {
  Points ends;
  for (std::size_t b = 0; b < pose.size(); ++b) {
    ends.push_back(pose[b].frame.origin);
    ends.push_back(pose[b].frame.origin + skeleton.bones[b].length * pose[b].axis());
  }
  return ends;
}

std::vector<double> sizes(const Points& vectors) {
  std::vector<double> sizes;
  sizes.reserve(vectors.size());
  for (const Vec3& one : vectors) sizes.push_back(one.norm());
  return sizes;
}

std::vector<double> measured(Session& session, const std::string& name) {
  std::vector<Column> found = session.meter().arrays(session.simulation(), name);
  return std::get<std::vector<double>>(std::move(found.front().values));
}

std::string levels_of(const std::vector<double>& values, const std::vector<std::uint32_t>& which,
                      const ValueRange& range) {
  std::string levels;
  const double width = range.high > range.low ? range.high - range.low : 1;
  for (const std::uint32_t i : which) {
    const double fraction = std::clamp((values[i] - range.low) / width, 0.0, 1.0);
    levels += static_cast<char>(std::isnan(values[i]) ? 255 : std::lround(254 * fraction));
  }
  return levels;
}

/// What the page offers to begin anew with.
Json settings_of(const Settings& scene) {
  const MaterialOptions& material = scene.material;
  Json all = Json::array();
  const auto add = [&](const char* key, const char* label, const char* unit, Json value) {
    all.push_back({{"key", key}, {"label", label}, {"unit", unit}, {"value", std::move(value)}});
  };
  add("material.young_modulus", "Young's modulus", "Pa", material.young_modulus);
  add("material.density", "density", "kg/m³", material.density);
  add("material.damping_ratio", "damping ratio", "",
      material.damping_ratio ? Json(*material.damping_ratio) : Json(""));
  if (keeps_volume(material.model))
    add("material.poisson_ratio", "Poisson's ratio", "", material.poisson_ratio);
  if (has_bonds(material.model)) add("material.friction", "friction", "", material.friction);
  return all;
}

}  // namespace

std::span<const LiveField> live_fields() {
  static constexpr std::array fields = {
      LiveField{"strain_eq", "", "strain", 1e-4, true},
      LiveField{"von_mises", "Pa", "von Mises stress", 1e-1, true},
      LiveField{"J", "", "volume ratio J", 1e-4, true},
      LiveField{"displacement", "m", "displacement", 1e-6},
      LiveField{"speed", "m/s", "speed", 1e-6},
      LiveField{"force", "N", "force", 1e-9},
  };
  return fields;
}

LiveView::LiveView(Session& session)
    : plan_(plan_playback(session.meter().rest(), 1, page_share)),
      rest_(session.meter().rest().shape.points) {
  const Body& body = session.simulation().body();
  skin_ = without_lone_particles(make_skin(chosen(session.surface().triangles.points, plan_.points),
                                           body.rest, body.material.pair.r, body.skeleton,
                                           body.binding));
}

std::string LiveView::scene_text(Session& session) {
  obstacles_.clear();
  Playback playback = plan_;
  const RestBody& rest = session.meter().rest();
  FrameState state = state_at_rest(rest);
  state.surface_points = rest.surface.points;
  state.bones.clear();
  for (const Bone& bone : rest.bones) state.bones.push_back(bone.rest);
  add_frame(playback, 0, rest, state, ParticleValues());
  Json fields = Json::array();
  for (const LiveField& field : live_fields())
    fields.push_back({{"name", field.name}, {"unit", field.unit}, {"label", field.label}});
  const Settings& scene = session.recorded();
  Json parents = Json::array(), knobs = Json::array();
  for (const Bone& bone : session.skeleton().bones) parents.push_back(bone.parent);
  for (const Knobs::Knob& knob : session.knobs_now().all(session.time()))
    knobs.push_back({{"name", knob.name},
                     {"max", knob.kind == Knobs::Kind::muscle ? 1 : 2},
                     {"value", knob.value}});
  const Vec3 gravity = session.knobs_now().gravity(session.time());
  const Json more = {{"fields", fields},
                     {"parents", parents},
                     {"knobs", knobs},
                     {"gravity", {gravity.x(), gravity.y(), gravity.z()}},
                     {"settings", settings_of(scene)},
                     {"stiffness", session.knobs_now().max_stiffness() / 4},
                     {"max_stiffness", session.knobs_now().max_stiffness()},
                     {"particles", rest.particles()},
                     {"step", session.grid().step}};
  return "{\"scene\":" + playback_json(playback) + ",\"more\":" + json_text(more) + '}';
}

std::vector<double> LiveView::values_of(Session& session, const Points& places) const {
  const std::string& name = wish.field;
  if (name == "displacement") {
    std::vector<double> values;
    for (std::size_t i = 0; i < places.size(); ++i) values.push_back((places[i] - rest_[i]).norm());
    return values;
  }
  if (name == "speed") {
    Points velocities;
    find_velocities_by_id(session.simulation().particles(), velocities);
    return sizes(velocities);
  }
  if (name == "force") {
    const Forces& forces = session.simulation().forces();
    const Particles& now = session.simulation().particles();
    std::vector<double> values(now.size());
    for (std::size_t i = 0; i < now.size(); ++i)
      values[static_cast<std::size_t>(now.id[i])] = forces.total(i).norm();
    return values;
  }
  return measured(session, name);
}

void LiveView::find_levels(Session& session, const Points& places) {
  constexpr auto old = std::chrono::milliseconds(100);
  const auto fields = live_fields();
  const auto field = std::find_if(fields.begin(), fields.end(),
                                  [&](const LiveField& one) { return one.name == wish.field; });
  const auto now = std::chrono::steady_clock::now();
  const bool same = ranged_ == wish.field;
  if (field == fields.end()) {
    ranged_.clear();
    return levels_.clear();
  }
  if (same && field->is_measured && !wish.exact && now - measured_ < old) return;
  const std::vector<double> values = values_of(session, places);
  if (!wish.holds_range || !same) {
    RangeFinder finder;
    finder.add(values);
    range_ = finder.range();
    range_.high = std::max(range_.high, range_.low + field->least);
  }
  levels_ = levels_of(values, plan_.particles, range_);
  ranged_ = wish.field;
  measured_ = std::chrono::steady_clock::now();
}

std::string LiveView::frame(Session& session, Json header) {
  Simulation& simulation = session.simulation();
  const Points places = positions_by_id(simulation.particles());
  const Points bones = ends_of_bones(session.skeleton(), simulation.pose());
  const Points skin = wish.skin ? follow(skin_, places) : Points();
  const Points particles = wish.particles ? chosen(places, plan_.particles) : Points();
  Points obstacles = cut_to(obstacle_space(bounds(places)), session.obstacles());
  if (obstacles == obstacles_)
    obstacles.clear();
  else
    obstacles_ = obstacles;
  const Cube cube = cube_of({&bones, &skin, &particles, &obstacles});
  find_levels(session, places);
  if (!levels_.empty())
    header["field"] = {{"name", ranged_}, {"low", range_.low}, {"high", range_.high}};
  header["low"] = {cube.low.x(), cube.low.y(), cube.low.z()};
  header["edge"] = cube.edge;
  header["counts"] = {bones.size(), skin.size(), particles.size(), obstacles.size(),
                      levels_.size()};
  std::string text = json_text(header);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string bytes;
  for (std::size_t left = text.size(), k = 0; k < 4; ++k, left >>= 8)
    bytes += static_cast<char>(left & 255);
  bytes += text;
  append(bytes, bones, cube);
  append(bytes, skin, cube);
  append(bytes, particles, cube);
  append(bytes, obstacles, cube);
  return bytes + levels_;
}

LiveView::Volumes LiveView::volumes(Session& session) {
  const std::vector<double> J = measured(session, "J");
  Volumes out;
  std::size_t inverted = 0;
  for (const double one : J) {
    if (one < out.J_min) out.J_min = one;
    if (one <= 0) ++inverted;
  }
  out.inverted = static_cast<double>(inverted) / static_cast<double>(J.size());
  return out;
}

}  // namespace sinew
