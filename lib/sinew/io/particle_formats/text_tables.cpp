// SPDX-License-Identifier: GPL-3.0-or-later
// Formats of one line per particle: extended XYZ (https://github.com/libAtoms/extxyz), CSV, YADE's
// ymport.textExt, and the text meshes of Peridigm and PeriLab.
#include <cmath>
#include <numbers>

#include <sinew/io/particle_formats/detail/writers.h>

namespace sinew {
namespace {

/// A comment line per region, "# KIND number: name".
std::string legend(const ParticleCloud& cloud, std::string_view kind, std::size_t first) {
  std::string text;
  for (std::size_t k = 0; k < cloud.region_names.size(); ++k)
    put_row(text, ' ', '#', kind, k + first, "is", cloud.region_names[k]);
  return text;
}

}  // namespace

// The species X is no element; OVITO and ASE know the names of the other columns.
void add_xyz(NewFile& file, const ParticleCloud& cloud) {
  const bool moves = !cloud.velocities.empty();
  std::string head;
  put_row(head, '\n', cloud.positions.size(),
          "Properties=species:S:1:pos:R:3:id:I:1:radius:R:1:mass:R:1:component:I:1:region:I:1");
  head.pop_back();
  if (moves) head += ":velo:R:3";
  put_row(head, ' ', " pbc=\"F F F\" units=\"m kg s\"");
  head.pop_back();
  head += " Time=", put_value(head, cloud.time), head += '\n';
  write_text(file, head);
  write_rows(file, cloud.positions.size(), [&](std::string& text, std::size_t i) {
    put_words(text, ' ', 'X', cloud.positions[i], cloud.id[i], cloud.radius, cloud.mass,
              cloud.component[i], cloud.region[i]);
    if (moves) text += ' ', put_value(text, cloud.velocities[i]);
    text += '\n';
  });
}

void add_csv(NewFile& file, const ParticleCloud& cloud) {
  const bool moves = !cloud.velocities.empty(), bound = !cloud.bone.empty();
  write_text(file, std::string("id,x,y,z,radius,mass,volume,component,region") +
                       (bound ? ",bone" : "") + (moves ? ",vx,vy,vz\n" : "\n"));
  write_rows(file, cloud.positions.size(), [&](std::string& text, std::size_t i) {
    const Vec3& p = cloud.positions[i];
    put_words(text, ',', cloud.id[i], p.x(), p.y(), p.z(), cloud.radius, cloud.mass, cloud.volume,
              cloud.component[i], cloud.region[i]);
    if (bound) text += ',', put_value(text, cloud.bone[i]);
    if (moves) {
      const Vec3& v = cloud.velocities[i];
      text += ',', put_words(text, ',', v.x(), v.y(), v.z());
    }
    text += '\n';
  });
}

// YADE takes the mass from the density of the material, here of spheres alone.
void add_yade(NewFile& file, const ParticleCloud& cloud) {
  const double sphere = 4.0 / 3 * std::numbers::pi * std::pow(cloud.radius, 3);
  std::string head = "#format x_y_z_r_matId\n# density of the materials, kg/m^3: ";
  put_row(head, ' ', cloud.mass / sphere);
  write_text(file, head + legend(cloud, "matId", 0));
  write_rows(file, cloud.positions.size(), [&](std::string& text, std::size_t i) {
    put_row(text, ' ', cloud.positions[i], cloud.radius, cloud.region[i]);
  });
}

// PeriLab finds its columns in the first line, which is a comment for Peridigm.
void add_peridigm(NewFile& file, const ParticleCloud& cloud) {
  write_text(file, "#header: x y z block_id volume\n" + legend(cloud, "block_id", 1));
  write_rows(file, cloud.positions.size(), [&](std::string& text, std::size_t i) {
    put_row(text, ' ', cloud.positions[i], cloud.region[i] + 1, cloud.volume);
  });
}

// Nodes are numbered from 1 in the order of the mesh.
void write_node_sets(const std::filesystem::path& mesh, const ParticleCloud& cloud) {
  const std::size_t regions = cloud.region_names.size();
  if (regions < 2) return;
  std::vector<std::string> texts;
  for (const std::string& name : cloud.region_names)
    texts.push_back("#header: global_id\n# " + name + '\n');
  for (std::size_t i = 0; i < cloud.region.size(); ++i)
    put_row(texts[static_cast<std::size_t>(cloud.region[i])], ' ', i + 1);
  for (std::size_t k = 0; k < regions; ++k) {
    const std::string name = mesh.stem().string() + "_block_" + std::to_string(k + 1) + ".txt";
    write_file(mesh.parent_path() / name, texts[k]);
  }
}

}  // namespace sinew
