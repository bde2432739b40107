// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/frame_data.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <type_traits>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/io/series_table.h>
#include <sinew/material/laws.h>
#include <sinew/metrics/pair_forces.h>
#include <sinew/metrics/particle_values.h>
#include <sinew/run/detail/bond_frames.h>
#include <sinew/run/moment_arrays.h>
#include <sinew/scene/frame_content.h>

namespace sinew {
namespace {

/// The bone of the particle that moves each vertex most.
std::vector<std::int32_t> bones_of_vertices(const Skin& skin, const Body& body) {
  const Column bones = at_vertices(skin, column("bone", bones_of_particles(body)));
  return std::get<std::vector<std::int32_t>>(bones.values);
}

/// The rows of a plain column for these particles; all of them where no ids are given.
Column rows_of(Column column, const std::vector<std::int32_t>& ids) {
  const auto select = [&](auto& values) {
    if constexpr (requires { values[0]; }) {
      const auto width = static_cast<std::size_t>(column.components);
      std::remove_reference_t<decltype(values)> some;
      some.reserve(width * ids.size());
      for (const std::int32_t id : ids) {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(width) * id;
        some.insert(some.end(), first, first + column.components);
      }
      values = std::move(some);
    }
  };
  if (!ids.empty()) std::visit(select, column.values);
  return column;
}

Dataset obstacles_of(const std::vector<Triangles>& surfaces, const std::vector<ObstaclePose>& poses,
                     const std::vector<Reaction>& reactions, Moment moment) {
  std::vector<ObstacleFrame> frames;
  for (std::size_t k = 0; k < surfaces.size(); ++k)
    frames.push_back({surfaces[k], poses[k].frame, poses[k].velocity, poses[k].angular_velocity,
                      reactions[k].force, reactions[k].moment});
  return obstacles_dataset(frames, moment);
}

/// Force and moment on each bone, in separate lists.
struct ReactionColumns {
  Points force, moment;

  explicit ReactionColumns(const std::vector<Reaction>& reactions) {
    for (const Reaction& on : reactions) {
      force.push_back(on.force);
      moment.push_back(on.moment);
    }
  }
  operator Reactions() const { return {force, moment}; }
};

/// What says which series frames have.
struct FrameContent {
  const OutputSettings& output;
  const Body& body;
  const FrameScene& scene;
};

/// Where a series is written, and what makes it.
struct SeriesMaker {
  std::string_view series;
  bool (*is_written)(const FrameContent&);
  Dataset (*make)(FrameData&);
};

bool in_all_frames(const FrameContent&) { return true; }

bool with_machine(const FrameContent& of) {
  return of.body.world && !(of.body.world->supports.empty() && of.body.world->loads.empty());
}

/// For every series that frames have: see series_table.h.
constexpr auto series_makers = std::to_array<SeriesMaker>({
    {"particles", in_all_frames, [](FrameData& now) { return now.particles(); }},
    {"surface", in_all_frames, [](FrameData& now) { return now.surface(); }},
    {"bones", in_all_frames, [](FrameData& now) { return now.bones(); }},
    {"frames", in_all_frames, [](FrameData& now) { return now.frames(); }},
    {"obstacles", [](const FrameContent& of) { return !of.scene.obstacles.empty(); },
     [](FrameData& now) { return now.obstacles(); }},
    {"supports", with_machine, [](FrameData& now) { return now.supports(); }},
    {"bonds", [](const FrameContent& of) { return of.output.bonds; },
     [](FrameData& now) { return now.bonds(); }},
    {"volume", [](const FrameContent& of) { return of.scene.volume.has_value(); },
     [](FrameData& now) { return now.volume(); }},
    {"skin_lbs", [](const FrameContent& of) { return of.output.skin_lbs; },
     [](FrameData& now) { return now.skinned(linear_blend_skinned); }},
    {"skin_dqs", [](const FrameContent& of) { return of.output.skin_dqs; },
     [](FrameData& now) { return now.skinned(dual_quaternion_skinned); }},
});

std::vector<std::string_view> series_of(const FrameContent& content) {
  std::vector<std::string_view> names;
  for (const SeriesMaker& maker : series_makers)
    if (maker.is_written(content)) names.push_back(maker.series);
  return names;
}

}  // namespace

FrameData::FrameData(const OutputSettings& output, const Body& body, const FrameScene& scene,
                     StrainInFrames strain)
    : body_(body),
      series_(series_of({output, body, scene})),
      selection_{written_particles(output, body.rest, body.material.pair.r, scene.neighbors),
                 frame_arrays(output.only)},
      probed_(!scene.probes.empty()),
      skin_(make_skin(scene.surface.points, body.rest, body.material.pair.r, body.skeleton,
                      body.binding)),
      surface_(scene.surface),
      surface_bone_(bones_of_vertices(skin_, body)),
      obstacles_(scene.obstacles),
      single_(!output.double_precision) {
  if (scene.volume)
    volume_.emplace(*scene.volume, body.rest, body.material.pair.r, body.skeleton, body.binding);
  begin_arrays(output, scene, strain);
}

FrameData::FrameData(const Prepared& prepared)
    : FrameData(prepared.settings.output, prepared.body,
                {prepared.surface.triangles,
                 prepared.obstacles,
                 {},
                 {},
                 prepared.body.neighbors,
                 cells_to_write(prepared)}) {}

void FrameData::begin_arrays(const OutputSettings& output, const FrameScene& scene,
                             StrainInFrames strain) {
  const std::string words = strain == StrainInFrames::by_default ? words_for_arrays(output, body_)
                                                                 : words_asked_for(output, body_);
  arrays_ = requested_arrays(words);
  const ContentOfSkin skin = content_of_skin(output, body_);
  on_skin_.arrays = skin.named.frame;
  on_skin_too_ = skin.named.requested;
  contact_arrays_ = skin.named.contact;
  if (!contact_arrays_.empty()) contacts_.emplace(scene.surface, body_);
  if (contacts_ && skin.named.requested.all && !contacts_->any()) contact_arrays_.clear();
  const bool with_bonds = output.bonds || (volume_ && bonds_change(body_.material));
  const bool is_measured = !arrays_.measured.empty() || !on_skin_too_.measured.empty() ||
                           !skin.usual.empty() || with_bonds || probed_;
  if (is_measured) measured_.emplace(body_, scene.surface, scene.neighbors);
  const auto keep_defined = [&](RequestedArrays& arrays, const char* key) {
    try {
      if (!arrays.measured.empty())
        arrays.measured = defined_arrays(measured_->rest(), measured_->at_rest(), arrays);
      arrays.stepped = defined_moment_arrays(body_, std::move(arrays.stepped), arrays.all);
    } catch (const Error& error) {
      throw error.with_context({key});
    }
  };
  RequestedArrays named = requested_arrays(output.arrays);
  keep_defined(named, "output.arrays");
  arrays_.all = true;  // others are left out where the body lacks them
  keep_defined(arrays_, "output.arrays");
  keep_defined(on_skin_too_, "output.skin");
  if (!skin.usual.empty() && has_strain(measured_->rest()))
    on_skin_too_.measured.insert(on_skin_too_.measured.end(), skin.usual.begin(), skin.usual.end());
}

void FrameData::take(Simulation& simulation, double time, bool with_particles) {
  FrameMoment& frame = now_;
  simulation.reuse(std::move(frame.particles), std::move(frame.forces));
  frame.moment = {time, static_cast<std::int32_t>(simulation.steps())};
  frame.with_particles = with_particles;
  frame.pose = simulation.pose();
  frame.gravity = simulation.stepping().gravity;
  frame.energies = simulation.energies();
  frame.unbalanced = simulation.unbalanced();
  if (body_.world) {
    WorldNow now = world_at(*body_.world, time, frame.pose);
    frame.obstacles = std::move(now.obstacles);
    frame.on_obstacles = simulation.reactions_of_obstacles();
    frame.supports = std::move(now.supports);
    frame.support_reactions = simulation.support_reactions();
    frame.load_reactions = simulation.load_reactions();
  }
  skin_columns_.clear();
  if (frame.with_particles || !on_skin_.arrays.empty()) {
    frame.broken_bonds = simulation.broken_bonds();
    frame.limited = simulation.limited().in_frame;
  }
  frame.grouping = simulation.body().grouping;
  frame.reactions = simulation.reactions_of_bones();
  frame.forces = simulation.take_forces();
  frame.particles = simulation.take_particles();
  find_positions_by_id(frame.particles, frame.positions);
  frame.measured = FrameState();
  if (measured_ && (frame.with_particles || probed_ || !on_skin_too_.measured.empty())) {
    frame.measured.positions = frame.positions;
    for (const BonePose& bone : frame.pose) frame.measured.bones.push_back(bone.frame);
    measured_->take_forces(simulation, time, frame.measured);
  }
  for (const auto axis : {&Particles::x, &Particles::y, &Particles::z})
    frame.particles.*axis = std::vector<double>();  // {} would keep their memory
}

Dataset FrameData::particles() { return particles_at(now_.positions); }

Dataset FrameData::dataset(std::string_view series) {
  const auto* maker = std::find_if(series_makers.begin(), series_makers.end(),
                                   [&](const SeriesMaker& one) { return one.series == series; });
  const SeriesRow* row = find_series(series);
  if (maker == series_makers.end() || row == nullptr)
    throw bad_input("there is no series " + shown(series), suggestion(series, series_));
  const bool is_there = std::find(series_.begin(), series_.end(), series) != series_.end();
  if (!is_there && !row->asked_by.empty())
    throw bad_input("this scene has no series " + shown(series),
                    "set " + std::string(row->asked_by) + " to true");
  return maker->make(*this);
}

void FrameData::lend(std::string_view series, const std::function<void(const Dataset&)>& use) {
  if (series != "particles") return use(dataset(series));
  const bool all = selection_.ids.empty();
  Dataset lent = particles_at(all ? std::move(now_.positions) : now_.positions);
  use(lent);
  if (all) now_.positions = std::move(lent.points);
}

Dataset FrameData::frame_of(Points positions, const ParticleSelection& selection) {
  const Forces& forces = now_.forces;
  group_.clear(), level_.clear();
  if (now_.grouping) group_ = now_.grouping->group, level_ = now_.grouping->levels();
  return particles_dataset({now_.particles,
                            body_.rest,
                            body_.binding,
                            forces.pair,
                            forces.damping,
                            forces.bone,
                            forces.neighbors,
                            now_.energies,
                            forces.world,
                            body_.material_number,
                            now_.broken_bonds,
                            {},
                            group_,
                            level_,
                            forces.group,
                            now_.limited,
                            now_.unbalanced},
                           std::move(positions), now_.moment, selection);
}

Dataset FrameData::particles_at(Points positions) {
  assert(now_.with_particles);
  const bool all = selection_.ids.empty();
  Dataset particles = frame_of(std::move(positions), selection_);
  std::vector<Column> columns = measure(arrays_.measured);
  add_stepped(arrays_.stepped, all ? particles.points : now_.positions, columns);
  for (Column& array : columns)
    particles.point_columns.push_back(rows_of(std::move(array), selection_.ids));
  return particles;
}

/// Measures these and, once for each moment, what the skin has.
std::vector<Column> FrameData::measure(std::vector<std::string_view> names) {
  const std::size_t count = names.size();
  if (skin_columns_.empty())
    for (const std::string_view name : on_skin_too_.measured)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  if (names.empty()) return {};
  std::vector<Column> columns = particle_arrays(measured_->rest(), now_.measured, names);
  if (skin_columns_.empty())
    for (const std::string_view name : on_skin_too_.measured)
      skin_columns_.push_back(at_vertices(skin_, *find(columns, name)));
  columns.resize(count);
  return columns;
}

void FrameData::add_stepped(std::span<const std::string_view> names, const Points& positions,
                            std::vector<Column>& columns) const {
  const BodyMoment moment{body_, positions, now_.particles, now_.forces, now_.pose, now_.gravity};
  for (Column& array : moment_arrays(moment, names)) columns.push_back(std::move(array));
}

std::vector<Column> FrameData::columns_of_skin() {
  std::vector<Column> of_particles;
  if (!on_skin_.arrays.empty())
    of_particles = evaluated(frame_of(now_.positions, on_skin_)).point_columns;
  add_stepped(on_skin_too_.stepped, now_.positions, of_particles);
  if (skin_columns_.empty()) measure({});
  std::vector<Column> columns = skin_columns_;
  for (const Column& array : of_particles) columns.push_back(at_vertices(skin_, array));
  return columns;
}

std::vector<Column> FrameData::columns_of_contact() const {
  if (contact_arrays_.empty()) return {};
  Points velocities(now_.positions.size());
  for (std::size_t k = 0; k < velocities.size(); ++k)
    velocities[static_cast<std::size_t>(now_.particles.id[k])] = now_.particles.velocity(k);
  const SurfaceContact on =
      contacts_->at(surface_.points, now_.positions, velocities, now_.obstacles);
  std::vector<Column> columns;
  for (const std::string_view name : contact_arrays_)
    columns.push_back(column(std::string(name), name == "contact_area" ? on.area : on.pressure));
  return columns;
}

Dataset FrameData::surface() {
  surface_.points = follow(skin_, now_.positions);
  Dataset skin = surface_dataset(surface_, skin_.rest, surface_bone_, now_.moment);
  for (Column& array : columns_of_skin()) skin.point_columns.push_back(std::move(array));
  for (Column& array : columns_of_contact()) skin.point_columns.push_back(std::move(array));
  return skin;
}

Dataset FrameData::skinned(SkinningMethod method) {
  if (vertex_weights_.first.empty())
    vertex_weights_ = carried_weights(body_.rest, weights_of(body_.binding), skin_.rest);
  const Triangles moved{method(skin_.rest, vertex_weights_, body_.skeleton, now_.pose),
                        surface_.faces};
  return surface_dataset(moved, skin_.rest, surface_bone_, now_.moment);
}

Dataset FrameData::bones() const { return bones_dataset(body_.skeleton, now_.pose, now_.moment); }

Dataset FrameData::frames() const {
  const ReactionColumns reactions(now_.reactions.sums());
  return frames_dataset(body_.skeleton, now_.pose, reactions, now_.moment);
}

Dataset FrameData::obstacles() const {
  return obstacles_of(obstacles_, now_.obstacles, now_.on_obstacles, now_.moment);
}

MachineMoment FrameData::machine() const {
  return {now_.moment.time, now_.positions, now_.supports, now_.support_reactions,
          now_.load_reactions};
}

Dataset FrameData::supports() const {
  if (!body_.world) return supports_dataset({}, now_.moment);
  return supports_dataset(support_frames(*body_.world, machine(), body_.rest), now_.moment);
}

Dataset FrameData::bonds() const {
  assert(measured_);
  return bonds_dataset(bond_values(measured_->rest(), now_.measured), now_.positions,
                       selection_.ids, now_.moment);
}

/// Whether pairs are apart: by their bonds, or where there are none by the range of forces.
std::vector<char> FrameData::pairs_apart(const Points& positions) const {
  const auto& pairs = volume_->pairs();
  if (!law_of(body_.material).has_bonds)
    return volume_->apart_beyond(positions, body_.material.pair.b);
  if (!bonds_change(body_.material)) return std::vector<char>(pairs.size());
  const BondValues bonds = bond_values(measured_->rest(), now_.measured);
  std::vector<ParticlePair> broken;
  for (std::size_t k = 0; k < bonds.ends.size(); ++k)
    if (bonds.broken[k]) broken.push_back(bonds.ends[k]);
  std::sort(broken.begin(), broken.end());
  return apart_if_broken(pairs, broken);
}

Dataset FrameData::volume() {
  Dataset particles = evaluated(FrameData::particles());
  if (single_) particles = in_single_precision(std::move(particles), body_.material.pair.r);
  return volume_->at(particles, pairs_apart(particles.points));
}

std::vector<Column> FrameData::measured(std::span<const std::string_view> names) const {
  assert(measured_ && probed_);
  return particle_arrays(measured_->rest(), now_.measured, names);
}

bool FrameData::is_plain() const {
  return !volume_ && arrays_.measured.empty() && arrays_.stepped.empty() &&
         selection_.ids.empty() && body_.material_number.empty() && !body_.grouping;
}

}  // namespace sinew
