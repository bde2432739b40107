// SPDX-License-Identifier: GPL-3.0-or-later
// LAMMPS data files (https://docs.lammps.org/read_data.html) of atom_style bond, and dump files
// (https://docs.lammps.org/dump.html) with one frame after the other. Units are SI; ids, types and
// molecules count from 1: types are regions, molecules components.
#include <sinew/core/triangles.h>
#include <sinew/io/particle_formats/detail/writers.h>

namespace sinew {
namespace {

/// With room around the outermost particles: LAMMPS loses atoms outside.
Box box_around(const ParticleCloud& cloud) {
  const Vec3 spare = Vec3::Constant(2 * cloud.radius);
  const Box box = bounds(cloud.positions);
  return {box.min() - spare, box.max() + spare};
}

std::string data_head(const ParticleCloud& cloud) {
  std::string text =
      "Particles of sinew: units si, atom_style bond; types are regions, molecules "
      "components; radius ";
  put_row(text, ' ', cloud.radius, "m\n");
  put_row(text, ' ', cloud.positions.size(), "atoms");
  put_row(text, ' ', cloud.region_names.size(), "atom types");
  put_row(text, ' ', cloud.bonds.size(), "bonds");
  put_row(text, ' ', "1 bond types\n");
  const Box box = box_around(cloud);
  for (int axis = 0; axis < 3; ++axis) {
    const char name = static_cast<char>('x' + axis);
    put_words(text, ' ', box.min()[axis], box.max()[axis], "");
    ((text += name) += "lo ") += name;
    text += "hi\n";
  }
  text += "\nMasses\n\n";
  for (std::size_t k = 0; k < cloud.region_names.size(); ++k)
    put_row(text, ' ', k + 1, cloud.mass, '#', cloud.region_names[k]);
  return text;
}

void write_velocities(NewFile& file, const ParticleCloud& cloud) {
  if (cloud.velocities.empty()) return;
  write_text(file, "\nVelocities\n\n");
  write_rows(file, cloud.velocities.size(), [&](std::string& text, std::size_t i) {
    put_row(text, ' ', cloud.id[i] + 1, cloud.velocities[i]);
  });
}

void write_bonds(NewFile& file, const ParticleCloud& cloud) {
  if (cloud.bonds.empty()) return;
  write_text(file, "\nBonds\n\n");
  write_rows(file, cloud.bonds.size(), [&](std::string& text, std::size_t k) {
    const auto [i, j] = cloud.bonds[k];
    put_row(text, ' ', k + 1, 1, cloud.id[i] + 1, cloud.id[j] + 1);
  });
}

}  // namespace

void add_lammps_data(NewFile& file, const ParticleCloud& cloud) {
  write_text(file, data_head(cloud) + "\nAtoms # bond\n\n");
  write_rows(file, cloud.positions.size(), [&](std::string& text, std::size_t i) {
    put_row(text, ' ', cloud.id[i] + 1, cloud.component[i] + 1, cloud.region[i] + 1,
            cloud.positions[i]);
  });
  write_velocities(file, cloud);
  write_bonds(file, cloud);
}

void add_lammps_dump(NewFile& file, const ParticleCloud& cloud) {
  std::string head;
  put_row(head, '\n', "ITEM: TIME", cloud.time, "ITEM: TIMESTEP", cloud.frame,
          "ITEM: NUMBER OF ATOMS", cloud.positions.size(), "ITEM: BOX BOUNDS ff ff ff");
  const Box box = box_around(cloud);
  for (int axis = 0; axis < 3; ++axis) put_row(head, ' ', box.min()[axis], box.max()[axis]);
  const bool moves = !cloud.velocities.empty();
  head += "ITEM: ATOMS id mol type mass radius x y z";
  write_text(file, head + (moves ? " vx vy vz\n" : "\n"));
  write_rows(file, cloud.positions.size(), [&](std::string& text, std::size_t i) {
    put_words(text, ' ', cloud.id[i] + 1, cloud.component[i] + 1, cloud.region[i] + 1, cloud.mass,
              cloud.radius, cloud.positions[i]);
    if (moves) text += ' ', put_value(text, cloud.velocities[i]);
    text += '\n';
  });
}

}  // namespace sinew
