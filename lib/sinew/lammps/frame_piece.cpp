// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lammps/frame_piece.h>

#include <mpi.h>
#include <algorithm>
#include <utility>

#include <sinew/core/file.h>
#include <sinew/core/particles.h>
#include <sinew/io/particle_frame.h>
#include <sinew/io/vtu.h>
#include <sinew/lammps/lammps_run.h>
#include <sinew/material/laws.h>

namespace sinew {
namespace {

constexpr int row_bytes = sizeof(PieceRow);

int ranks() {
  int count = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  return count;
}

/// Where the rows of each rank begin in a list of all of them.
std::vector<int> begins_of(const std::vector<int>& counts) {
  std::vector<int> begins(counts.size(), 0);
  for (std::size_t k = 1; k < counts.size(); ++k) begins[k] = begins[k - 1] + counts[k - 1];
  return begins;
}

/// Each row where it is written, there by ascending id.
std::vector<PieceRow> exchanged(std::vector<PieceRow> rows, std::uint64_t particles) {
  const auto by_id = [](const PieceRow& a, const PieceRow& b) { return a.id < b.id; };
  std::sort(rows.begin(), rows.end(), by_id);
  const auto count = static_cast<std::size_t>(ranks());
  std::vector<int> sent(count, 0), received(count, 0);
  for (const PieceRow& row : rows) ++sent[static_cast<std::uint64_t>(row.id) * count / particles];
  MPI_Alltoall(sent.data(), 1, MPI_INT, received.data(), 1, MPI_INT, MPI_COMM_WORLD);
  const std::vector<int> from = begins_of(sent), to = begins_of(received);
  std::vector<PieceRow> here(static_cast<std::size_t>(to.back() + received.back()));
  MPI_Datatype row_type = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(row_bytes, MPI_BYTE, &row_type);
  MPI_Type_commit(&row_type);
  MPI_Alltoallv(rows.data(), sent.data(), from.data(), row_type, here.data(), received.data(),
                to.data(), row_type, MPI_COMM_WORLD);
  MPI_Type_free(&row_type);
  std::sort(here.begin(), here.end(), by_id);
  return here;
}

/// The columns of a frame.
struct Columns {
  Points rest, position, pair, damping, bone, world;
  std::vector<std::int32_t> ids, neighbors, broken_bonds;
  Binding binding;
  Particles particles;

  Columns(const std::vector<PieceRow>& rows, const EngineSetup& setup) {
    const Material& material = setup.material;
    for (Points* vectors : {&rest, &position, &pair, &damping, &bone, &world})
      vectors->reserve(rows.size());
    for (auto* numbers : {&ids, &neighbors, &broken_bonds}) numbers->reserve(rows.size());
    binding.first.reserve(rows.size() + 1);
    binding.influences.reserve(rows.size());
    binding.first.push_back(0);
    for (const PieceRow& row : rows) add(row);
    if (!law_of(material).has_bonds) broken_bonds.clear();
    if (!setup.world) world.clear();
    particles = particles_at(position, material.pair.r, material.mass);
    for (std::size_t i = 0; i < rows.size(); ++i) particles.set_velocity(i, rows[i].velocity);
  }

 private:
  void add(const PieceRow& row) {
    ids.push_back(row.id);
    rest.push_back(row.rest);
    position.push_back(row.position);
    pair.push_back(row.pair);
    damping.push_back(row.damping);
    bone.push_back(row.on_bones);
    world.push_back(row.world);
    neighbors.push_back(row.neighbors);
    broken_bonds.push_back(row.broken_bonds);
    if (row.bone != no_bone) binding.influences.push_back({row.bone, row.weight, 0});
    binding.first.push_back(static_cast<std::uint32_t>(binding.influences.size()));
  }
};

/// The same of all ranks: Float64 where one of them needs it.
VtuFormat format_of(const EngineSetup& setup, const Points& positions) {
  const bool here = beyond_float32(positions, setup.material.pair.r);
  bool far = false;
  MPI_Allreduce(&here, &far, 1, MPI_CXX_BOOL, MPI_LOR, MPI_COMM_WORLD);
  return {setup.pieces->encoding, setup.pieces->double_precision, "particles", 0, far};
}

/// One after the other, the first with the beginning of the file.
void write_in_turn(const std::filesystem::path& file, const std::string& text) {
  const std::uint64_t size = text.size();
  std::uint64_t place = 0;
  MPI_Exscan(&size, &place, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
  const bool first = Ranks::first();
  if (first) write_part(file, 0, text);
  MPI_Barrier(MPI_COMM_WORLD);
  if (!first && size > 0) write_part(file, place, text);
}

}  // namespace

void write_frame_piece(const std::filesystem::path& file, const EngineSetup& setup,
                       std::vector<PieceRow> rows, Moment moment) {
  Columns own(exchanged(std::move(rows), setup.particles), setup);
  const VtuFormat format = format_of(setup, own.position);
  const std::vector<std::string>& names = setup.pieces->arrays;
  const ParticleSelection selection{{}, {names.begin(), names.end()}};
  const ParticleFrame frame{own.particles, own.rest, own.binding,      own.pair,
                            own.damping,   own.bone, own.neighbors,    {},
                            own.world,     {},       own.broken_bonds, own.ids};
  Dataset data = particles_dataset(frame, std::move(own.position), moment, selection);
  const std::string beginning = Ranks::first() ? vtu_beginning(format) : "";
  write_in_turn(file, own.ids.empty() ? beginning : beginning + vtu_piece(data, format));
}

}  // namespace sinew
