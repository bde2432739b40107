// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/drawn_bonds.h>

#include <sinew/core/arrays.h>
#include <sinew/core/dataset.h>
#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr std::array<std::string_view, 3> colored{"strain", "length", "force"};

}  // namespace

DrawnBonds::DrawnBonds(const RunFiles& run, const std::string& name) : run_(&run), name_(name) {
  if (std::find(colored.begin(), colored.end(), name) == colored.end())
    throw bad_input("bonds have no array " + shown(name), suggestion(name, colored));
  if (run.bond_rows.empty())
    throw bad_input(Place{run.folder.path.string()}, "the run has not written its bonds",
                    "run the scene again with --set output.bonds=true --force");
  const WrittenArray& array = *find_written("bonds", ArrayPlace::cell, name);
  if (array.unit != "1") unit_ = array.unit;
}

std::vector<DrawnBond> DrawnBonds::at(std::size_t index) const {
  if (index >= run_->bond_rows.size()) return {};
  const Place file{(run_->folder.path / run_->bond_rows[index].file).string()};
  const Dataset data = read_vtu(file.file);
  if (data.kind != CellKind::line || data.points.size() != run_->body.particles.size())
    throw bad_input(file, "has not the bonds of the run's particles",
                    "run the scene again with --force");
  try {
    const std::vector<double>& values = numbers(data.cell_columns, name_);
    const std::vector<std::int32_t>& broken = integers(data.cell_columns, "broken");
    std::vector<DrawnBond> bonds;
    for (std::size_t k = 0; k < data.cells(); ++k) {
      const std::array ends{data.connectivity[2 * k], data.connectivity[2 * k + 1]};
      if (broken[k] == 0)
        bonds.push_back({ends, data.points[ends[0]], data.points[ends[1]], values[k]});
    }
    return bonds;
  } catch (const Error& error) {
    throw error.with_context(file);
  }
}

}  // namespace sinew
