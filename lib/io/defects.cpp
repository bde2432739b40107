// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/defects.h"

#include "core/dataset.h"
#include "io/vtu.h"

namespace sinew {

void write_defects(const std::filesystem::path& path, const DefectsFile& defects) {
  Dataset data;
  data.points = defects.surface.points;
  data.kind = CellKind::triangle;
  for (const auto& face : defects.surface.faces)
    data.connectivity.insert(data.connectivity.end(), face.begin(), face.end());
  for (const auto& edge : defects.edges)
    data.lines.insert(data.lines.end(), edge.begin(), edge.end());
  data.cell_columns = {column("defect", defects.defect), column("component", defects.component),
                       column("hole", defects.hole)};
  VtuFormat format;
  format.series = "defects";
  write_vtu(path, data, format);
}

}  // namespace sinew
