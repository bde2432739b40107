// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/arrays.h>

#include <algorithm>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

using enum ArrayPlace;
using enum ArrayNumbers;
using enum ArrayRole;

const std::vector<std::string_view> one = {};
const std::vector<std::string_view> xyz = {"X", "Y", "Z"};
const std::vector<std::string_view> tensor = {"XX", "YY", "ZZ", "XY", "YZ", "XZ"};
const std::vector<std::string_view> full_tensor = {"XX", "XY", "XZ", "YX", "YY",
                                                   "YZ", "ZX", "ZY", "ZZ"};
const std::vector<std::string_view> principal = {"1", "2", "3"};
const std::vector<std::string_view> wxyz = {"W", "X", "Y", "Z"};

std::vector<WrittenArray> table_of_all() {
  return {
      {"all", field, "TimeValue", "s", one, exact, plain, "simulated time"},
      {"all", field, "CYCLE", "1", one, whole, plain, "steps taken so far"},
      {"all", field, "sinew_meta", "1", one, bytes, plain, "metadata of the file, as UTF-8 JSON"},
  };
}

std::vector<WrittenArray> table_of_body() {
  return {
      {"body", point, "Points", "m", xyz, exact, plain,
       "position of the particle at rest, in the mesh's coordinates"},
      {"body", point, "id", "1", one, whole, plain, "number of the particle, from 0"},
      {"body", point, "radius", "m", one, exact, plain, "radius of the particle"},
      {"body", point, "mass", "kg", one, exact, plain, "mass of the particle"},
      {"body", point, "neighbors", "1", one, whole, plain, "number of touching particles at rest"},
      {"body", point, "component", "1", one, whole, plain,
       "connected component it belongs to, from 0"},
      {"body", point, "share", "1", one, exact, plain,
       "volume of the body around it over that of a particle inside, if the material needs it"},
      {"body", point, "stiffness", "1", one, exact, plain,
       "stiffness of the material of its part over the body's, where they differ"},
      {"body", point, "density", "1", one, exact, plain,
       "density of the material of its part over the body's, where they differ"},
      {"body", point, "common_mass", "kg", one, exact, plain,
       "mass of a particle with the body's density, where they differ"},
      {"body", point, "volume_stiffness", "Pa", one, exact, plain,
       "stiffness against its change of volume, where parts differ"},
      {"body", point, "bone", "1", one, whole, plain, "bone it is bound to, -1 for none"},
      {"body", point, "weight", "1", one, exact, plain, "weight of that bone, 0 for none"},
  };
}

std::vector<WrittenArray> table_of_particles() {
  return {
      {"particles", point, "Points", "m", xyz, real, plain, "position of the particle"},
      {"particles", point, "id", "1", one, whole, plain, "number of the particle, from 0"},
      {"particles", point, "bone", "1", one, whole, scalars, "bone it is bound to, -1 for none"},
      {"particles", point, "material", "1", one, whole, plain,
       "number of its material in the scene's list materials, from 1, or 0, if the scene has any"},
      {"particles", point, "group", "1", one, whole, plain,
       "group of particles that moves as one, from 0, or -1, if the scene asks for groups"},
      {"particles", point, "level", "1", one, whole, plain,
       "0: free; 1: on the rim of its group; 2: within it, where forces are zero"},
      {"particles", point, "weight", "1", one, real, plain, "weight of that bone, 0 for none"},
      {"particles", point, "radius", "m", one, real, plain, "radius of the particle"},
      {"particles", point, "displacement", "m", xyz, real, vectors,
       "displacement from the rest position"},
      {"particles", point, "velocity", "m/s", xyz, real, plain, "velocity"},
      {"particles", point, "force", "N", xyz, real, plain, "sum of all forces on it"},
      {"particles", point, "force_pair", "N", xyz, real, plain, "elastic force of its neighbors"},
      {"particles", point, "force_damping", "N", xyz, real, plain,
       "damping force of its neighbors"},
      {"particles", point, "force_bone", "N", xyz, real, plain, "force of its bone"},
      {"particles", point, "force_world", "N", xyz, real, plain,
       "force of obstacles, drag, fields, muscles, pins, supports, loads and friction of the body "
       "on "
       "itself, if the scene has any"},
      {"particles", point, "neighbors", "1", one, whole, plain,
       "number of neighbors within the range b; of solids, bonded or touching"},
      {"particles", point, "broken_bonds", "1", one, whole, plain,
       "number of its broken bonds, if the material has bonds"},
      {"particles", point, "limited", "1", one, whole, plain,
       "how often its speed was limited since the frame before, in frames in which any was"},
      {"particles", field, "kinetic_energy", "J", one, exact, plain, "kinetic energy"},
      {"particles", field, "pair_energy", "J", one, exact, plain, "elastic energy of all pairs"},
      {"particles", field, "bone_energy", "J", one, exact, plain,
       "elastic energy of the bone springs"},
      {"particles", field, "gravity_energy", "J", one, exact, plain, "potential energy of gravity"},
      {"particles", field, "work_of_bones", "J", one, exact, plain,
       "work the bones have done so far"},
      {"particles", field, "dissipation", "J", one, exact, plain,
       "energy lost to damping, drag and friction so far"},
      {"particles", field, "contact_energy", "J", one, exact, plain,
       "elastic energy of contacts with obstacles"},
      {"particles", field, "work_of_world", "J", one, exact, plain,
       "work that moving obstacles, pins, fields, muscles, supports and loads have done so far"},
      {"particles", field, "unbalanced_force", "N", one, exact, plain,
       "size of the sum of all forces from outside, of a body that is brought to rest"},
      {"particles", field, "unbalanced_moment", "N m", one, exact, plain,
       "size of the sum of their moments about the center of mass"},
  };
}

/// Additional arrays of particles, by output.arrays or sinew measure --arrays.
std::vector<WrittenArray> table_of_measured(const char* series) {
  std::vector<WrittenArray> rows = {
      {series, point, "F", "1", full_tensor, real, plain,
       "deformation gradient over the neighbors at rest, on request"},
      {series, point, "J", "1", one, real, plain, "local volume ratio det F, on request"},
      {series, point, "stretch", "1", principal, real, plain,
       "principal stretches, largest first, on request"},
      {series, point, "strain", "1", tensor, real, plain,
       "Green-Lagrange strain (F^T F - I) / 2, on request"},
      {series, point, "hencky_strain", "1", tensor, real, plain,
       "Hencky strain ln(F^T F) / 2, on request"},
      {series, point, "strain_eq", "1", one, real, plain,
       "equivalent strain sqrt(2/3 dev H : dev H), H the Hencky strain, on request and up to "
       "200,000 particles"},
      {series, point, "stress", "Pa", tensor, real, plain,
       "Cauchy's (true) stress, virial -(1/2JV) sum f r with volumes and muscles, tension "
       "positive; "
       "none where J <= 0.05; on request"},
      {series, point, "stress_kirchhoff", "Pa", tensor, real, plain,
       "Kirchhoff's stress, J times the former, on request"},
      {series, point, "von_mises", "Pa", one, real, plain,
       "von Mises stress of Cauchy's stress, on request and where positions alone do not give it"},
      {series, point, "energy_density", "J/m^3", one, real, plain,
       "elastic energy per volume at rest: half of that of its pairs, and that of its volume; on "
       "request"},
      {series, point, "D2min", "m^2", one, real, plain,
       "non-affine motion of the neighbors, which F does not explain, on request"},
      {series, point, "turnover", "1", one, real, plain,
       "neighbors lost and gained, relative to those at rest, on request"},
      {series, point, "surface_layer", "1", one, whole, plain,
       "1 in the outermost layer at rest, 2 in the layer below, 0 inside; on request"},
      {series, point, "inverted", "1", one, whole, plain, "1 where J <= 0, on request"},
      {series, point, "pose_error", "m", one, real, plain,
       "distance from the rigid pose of its bone, on request"},
  };
  for (WrittenArray& row : rows) row.partial = true;
  return rows;
}

/// What forces and bones of the moment define.
std::vector<WrittenArray> table_of_stepped() {
  std::vector<WrittenArray> rows = {
      {"particles", point, "acceleration", "m/s^2", xyz, real, plain,
       "force over mass, and gravity, on request"},
      {"particles", point, "bone_point", "m", xyz, real, plain,
       "reference point on its bone, where the bone is, on request"},
      {"particles", point, "force_radial", "N", xyz, real, plain,
       "force of the spring that keeps its distance from that point; of an anchor its whole "
       "spring; "
       "on request"},
      {"particles", point, "force_twist", "N", xyz, real, plain,
       "force of the spring that turns it with its bone, on request"},
      {"particles", point, "force_axial", "N", xyz, real, plain,
       "force of the spring against sliding along its bone, on request"},
  };
  rows[1].partial = true;
  return rows;
}

std::vector<WrittenArray> table_of_measured_in_particles() {
  return table_of_measured("particles");
}

std::vector<WrittenArray> table_of_values() {
  std::vector<WrittenArray> rows = {
      {"values", point, "Points", "m", xyz, real, plain, "position of the particle"},
      {"values", point, "id", "1", one, whole, scalars, "number of the particle, from 0"},
  };
  for (WrittenArray& row : table_of_measured("values")) rows.push_back(std::move(row));
  return rows;
}

std::vector<WrittenArray> table_of_surface_in(const char* series, const char* of_points) {
  return {
      {series, point, "Points", "m", xyz, real, plain, of_points},
      {series, point, "displacement", "m", xyz, real, vectors,
       "displacement from the rest position"},
      {series, point, "normal", "1", xyz, real, plain, "outward unit normal"},
      {series, point, "bone", "1", one, whole, scalars,
       "bone with the most influence on it, -1 for none"},
  };
}

std::vector<WrittenArray> table_of_contact() {
  return {
      {"surface", point, "contact_pressure", "Pa", one, real, plain,
       "pressure of obstacles and other bodies on its contact_area, 0 without contact; by "
       "output.skin"},
      {"surface", point, "contact_area", "m^2", one, real, plain,
       "the part of the surface around it, as deformed, that touches an obstacle or another body; "
       "by output.skin"},
  };
}

std::vector<WrittenArray> table_of_surface() {
  std::vector<WrittenArray> rows =
      table_of_surface_in("surface", "point of the input surface, deformed");
  rows.push_back({"surface", point, "strain_eq", "1", one, real, plain,
                  "equivalent strain of the particles around it, up to 200,000 of them; like every "
                  "other array of particles by output.skin",
                  true});
  rows.push_back({"surface", point, "von_mises", "Pa", one, real, plain,
                  "von Mises stress of the particles around it, if the material has bonds; "
                  "likewise",
                  true});
  for (WrittenArray& row : table_of_contact()) rows.push_back(std::move(row));
  return rows;
}

std::vector<WrittenArray> table_of_skin_lbs() {
  return table_of_surface_in("skin_lbs", "the same point by linear-blend skinning");
}

std::vector<WrittenArray> table_of_skin_dqs() {
  return table_of_surface_in("skin_dqs", "the same point by dual-quaternion skinning");
}

std::vector<WrittenArray> table_of_bones() {
  return {
      {"bones", point, "Points", "m", xyz, real, plain, "head, tail and tips of the three axes"},
      {"bones", cell, "axis", "1", one, whole, scalars, "0 the bone, 1, 2, 3 its x, y, z axis"},
      {"bones", cell, "bone", "1", one, whole, plain, "number of the bone, from 0"},
      {"bones", cell, "parent", "1", one, whole, plain, "parent of the bone, -1 for none"},
  };
}

std::vector<WrittenArray> table_of_bonds() {
  std::vector<WrittenArray> rows = {
      {"bonds", point, "Points", "m", xyz, real, plain, "position of the particle"},
      {"bonds", point, "id", "1", one, whole, plain, "number of the particle, from 0"},
      {"bonds", cell, "strain", "1", one, real, scalars,
       "length over its rest length, which may have crept, minus 1; none once broken"},
      {"bonds", cell, "length", "m", one, real, plain, "distance of the two particles"},
      {"bonds", cell, "force", "N", one, real, plain,
       "of its spring alone, without volumes and contacts; tension positive, 0 once broken"},
      {"bonds", cell, "broken", "1", one, whole, plain,
       "1 once it is broken; in the paper's model while it is longer than b"},
  };
  rows[2].partial = true;
  return rows;
}

/// Its points have the arrays of particles as well.
std::vector<WrittenArray> table_of_volume() {
  return {
      {"volume", point, "Points", "m", xyz, real, plain,
       "position of the particle, or of a point of the border that follows particles"},
      {"volume", point, "id", "1", one, whole, plain,
       "number of the particle, from 0; -1 at other points"},
      {"volume", cell, "J", "1", one, real, scalars, "volume over the volume at rest"},
      {"volume", cell, "torn", "1", one, whole, plain,
       "1 where particles of the cell are apart: their bond is broken or, in the paper's model, "
       "they touched at rest and are farther than b from each other; or the cell lies beside such "
       "a cell, and J exceeds 1.5"},
  };
}

std::vector<WrittenArray> table_of_frames() {
  return {
      {"frames", point, "Points", "m", xyz, real, plain, "head of the bone"},
      {"frames", point, "bone", "1", one, whole, scalars, "number of the bone, from 0"},
      {"frames", point, "parent", "1", one, whole, plain, "parent of the bone, -1 for none"},
      {"frames", point, "length", "m", one, real, plain, "distance from head to tail"},
      {"frames", point, "orientation", "1", wxyz, real, plain, "quaternion: scene to bone axes"},
      {"frames", point, "axis_x", "1", xyz, real, plain, "unit x axis, along the bone"},
      {"frames", point, "axis_y", "1", xyz, real, plain, "unit y axis"},
      {"frames", point, "axis_z", "1", xyz, real, plain, "unit z axis"},
      {"frames", point, "twist", "degree", one, real, plain, "rotation about the bone's own axis"},
      {"frames", point, "velocity", "m/s", xyz, real, vectors, "velocity of the head"},
      {"frames", point, "angular_velocity", "rad/s", xyz, real, plain, "angular velocity"},
      {"frames", point, "reaction_force", "N", xyz, real, plain, "force of the body on the bone"},
      {"frames", point, "reaction_moment", "N m", xyz, real, plain, "its moment about the head"},
  };
}

std::vector<WrittenArray> table_of_supports() {
  return {
      {"supports", point, "Points", "m", xyz, real, plain,
       "mean place of what a support holds or a load acts on"},
      {"supports", point, "number", "1", one, whole, scalars,
       "its row in a frame of supports.csv, from 0"},
      {"supports", point, "load", "1", one, whole, plain, "1 for a load, 0 for a support"},
      {"supports", point, "force", "N", xyz, real, vectors, "its force on the body"},
      {"supports", point, "moment", "N m", xyz, real, plain, "its moment about its pivot"},
      {"supports", point, "power", "W", one, real, plain, "its power into the body"},
      {"supports", point, "displacement", "m", xyz, real, plain, "mean displacement"},
  };
}

std::vector<WrittenArray> table_of_obstacles() {
  return {
      {"obstacles", point, "Points", "m", xyz, real, plain, "point of an obstacle's surface"},
      {"obstacles", point, "obstacle", "1", one, whole, scalars, "number of the obstacle, from 0"},
      {"obstacles", point, "velocity", "m/s", xyz, real, vectors, "velocity of that point"},
      {"obstacles", point, "normal", "1", xyz, real, plain, "outward unit normal"},
      {"obstacles", point, "reaction_force", "N", xyz, real, plain,
       "force of the body on the obstacle"},
      {"obstacles", point, "reaction_moment", "N m", xyz, real, plain,
       "its moment about the obstacle's center"},
  };
}

std::vector<WrittenArray> table_of_defects() {
  return {
      {"defects", point, "Points", "m", xyz, exact, plain, "point of the cleaned mesh"},
      {"defects", cell, "defect", "1", one, whole, scalars,
       "0 none; edges: 1 open, 2 non-manifold, 3 twisted; faces: 4 reversed, 5 intersecting "
       "another, 6 degenerate"},
      {"defects", cell, "component", "1", one, whole, plain,
       "connected component of the face, from 0; -1 for edges"},
      {"defects", cell, "hole", "1", one, whole, plain, "hole of the edge, from 0; -1 for faces"},
  };
}

std::vector<WrittenArray> table_of_blowup() {
  return {
      {"blowup", point, "Points", "m", xyz, real, plain,
       "position of the particle before the step"},
      {"blowup", point, "id", "1", one, whole, plain, "number of the particle, from 0"},
      {"blowup", point, "bone", "1", one, whole, plain, "bone it is bound to, -1 for none"},
      {"blowup", point, "radius", "m", one, real, plain, "radius of the particle"},
      {"blowup", point, "displacement", "m", xyz, real, vectors,
       "displacement from the rest position"},
      {"blowup", point, "velocity", "m/s", xyz, real, plain, "velocity before the step"},
      {"blowup", point, "offender", "1", one, whole, scalars,
       "0 no; 1 moved too far in the step; 2 reached a non-finite value"},
      {"blowup", point, "moved", "radii", one, real, plain,
       "distance that an offender moved in the step, relative to its bone; 0 if not finite"},
  };
}

std::vector<WrittenArray> make_table() {
  std::vector<WrittenArray> table;
  for (auto rows :
       {table_of_all, table_of_body, table_of_particles, table_of_measured_in_particles,
        table_of_stepped, table_of_values, table_of_surface, table_of_skin_lbs, table_of_skin_dqs,
        table_of_bones, table_of_bonds, table_of_volume, table_of_frames, table_of_obstacles,
        table_of_supports, table_of_defects, table_of_blowup})
    for (WrittenArray& row : rows()) table.push_back(std::move(row));
  return table;
}

std::vector<std::string_view> names_of(const std::vector<WrittenArray>& rows) {
  std::vector<std::string_view> names;
  for (const WrittenArray& row : rows) names.push_back(row.name);
  return names;
}

std::vector<std::string_view> names_in_frames() {
  std::vector<std::string_view> names;
  for (const WrittenArray& row : table_of_particles())
    if (row.place == point && row.name != "Points") names.push_back(row.name);
  return names;
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  constexpr std::string_view between = ", \t";
  for (auto at = text.find_first_not_of(between); at != text.npos;
       at = text.find_first_not_of(between, at)) {
    const auto end = std::min(text.find_first_of(between, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

}  // namespace

std::span<const WrittenArray> written_arrays() {
  static const std::vector<WrittenArray> table = make_table();
  return table;
}

const WrittenArray* find_written(std::string_view series, ArrayPlace place, std::string_view name) {
  const auto table = written_arrays();
  const auto row = std::find_if(table.begin(), table.end(), [&](const WrittenArray& candidate) {
    return (candidate.series == series || candidate.series == "all") && candidate.place == place &&
           candidate.name == name;
  });
  if (row != table.end()) return &*row;
  if ((series == "surface" || series == "volume") && place == point)
    return find_written("particles", place, name);
  return nullptr;
}

std::string_view place_text(ArrayPlace place) {
  return place == point ? "point" : place == cell ? "cell" : "field";
}

std::span<const std::string_view> measured_arrays() {
  static const std::vector<std::string_view> names = names_of(table_of_measured("values"));
  return names;
}

std::span<const std::string_view> stepped_arrays() {
  static const std::vector<std::string_view> names = names_of(table_of_stepped());
  return names;
}

std::span<const std::string_view> contact_arrays() {
  static const std::vector<std::string_view> names = names_of(table_of_contact());
  return names;
}

std::vector<std::string_view> frame_arrays(std::string_view text) {
  const std::vector<std::string_view> names = names_in_frames();
  std::vector<std::string_view> found;
  for (const std::string_view word : words_of(text)) {
    const auto name = std::find(names.begin(), names.end(), word);
    if (name == names.end())
      throw bad_input("frames have no array " + shown(word), suggestion(word, names));
    found.push_back(*name);
  }
  return found;
}

RequestedArrays requested_arrays(std::string_view text) {
  const std::vector<std::string_view> words = words_of(text);
  const auto is_word = [&](std::string_view name) {
    return std::find(words.begin(), words.end(), name) != words.end();
  };
  RequestedArrays found;
  found.all = is_word("all");
  std::vector<std::string_view> names;
  const auto pick = [&](std::span<const std::string_view> from, std::vector<std::string_view>& to) {
    names.insert(names.end(), from.begin(), from.end());
    for (const std::string_view name : from)
      if (found.all || is_word(name)) to.push_back(name);
  };
  pick(measured_arrays(), found.measured);
  pick(stepped_arrays(), found.stepped);
  for (const std::string_view word : words)
    if (word != "all" && std::find(names.begin(), names.end(), word) == names.end())
      throw bad_input("there is no array " + shown(word) + " to ask for",
                      suggestion(word, names) + " (or all)");
  return found;
}

SkinArrays skin_arrays(std::string_view text) {
  SkinArrays found;
  std::string requested;
  const std::vector<std::string_view> in_frames = names_in_frames();
  std::vector<std::string_view> names = in_frames;
  const auto is_contact = [](std::string_view word) {
    const auto some = contact_arrays();
    return std::find(some.begin(), some.end(), word) != some.end();
  };
  for (const auto more : {measured_arrays(), stepped_arrays(), contact_arrays()})
    names.insert(names.end(), more.begin(), more.end());
  const auto is_in = [](const std::vector<std::string_view>& some, std::string_view word) {
    return std::find(some.begin(), some.end(), word) != some.end();
  };
  const std::vector<std::string_view> words = words_of(text);
  for (const std::string_view word : words) {
    if (word == "none")
      found.usual = false;
    else if (is_contact(word))
      continue;
    else if (word == "all" || (is_in(names, word) && !is_in(in_frames, word)))
      requested += ' ' + std::string(word);
    else if (!is_in(names, word))
      throw bad_input("particles have no array " + shown(word) + " for the surface",
                      suggestion(word, names) + " (or all, none)");
  }
  found.requested = requested_arrays(requested);
  const std::vector<std::string_view> own = names_of(table_of_surface_in("surface", ""));
  for (const std::string_view name : in_frames)
    if ((found.requested.all || is_in(words, name)) && !is_in(own, name))
      found.frame.push_back(name);
  for (const std::string_view name : contact_arrays())
    if (found.requested.all || is_in(words, name)) found.contact.push_back(name);
  return found;
}

}  // namespace sinew
