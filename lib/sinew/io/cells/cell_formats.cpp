// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/cells/cell_formats.h>

#include <array>
#include <cassert>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/io/particle_formats/detail/writers.h>
#include <sinew/io/vtu.h>

namespace sinew {
namespace {

/// Node `k` of cell `c`, from 1.
std::int32_t node_of(const Dataset& cells, std::size_t c, std::size_t k) {
  return cells.connectivity[4 * c + k] + 1;
}

/// https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format-version-2
void add_gmsh(NewFile& file, const Dataset& cells) {
  const auto& id = integers(cells.point_columns, "id");
  std::string head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"body\"\n";
  put_row(head, '\n', "$EndPhysicalNames\n$Nodes", cells.points.size());
  write_text(file, head);
  write_rows(file, cells.points.size(),
             [&](std::string& text, std::size_t i) { put_row(text, ' ', i + 1, cells.points[i]); });
  std::string elements = "$EndNodes\n";
  put_row(elements, '\n', "$Elements", cells.cells());
  write_text(file, elements);
  write_rows(file, cells.cells(), [&](std::string& text, std::size_t c) {
    put_row(text, ' ', c + 1, "4 2 1 1", node_of(cells, c, 0), node_of(cells, c, 1),
            node_of(cells, c, 2), node_of(cells, c, 3));
  });
  std::string data = "$EndElements\n$NodeData\n1\n\"id\"\n1\n0\n3\n0\n1\n";
  put_row(data, '\n', id.size());
  write_text(file, data);
  write_rows(file, id.size(),
             [&](std::string& text, std::size_t i) { put_row(text, ' ', i + 1, id[i]); });
  write_text(file, "$EndNodeData\n");
}

/// P. J. Frey, Medit, INRIA RT-0253 (2001).
void add_medit(NewFile& file, const Dataset& cells) {
  const auto& id = integers(cells.point_columns, "id");
  std::string head = "MeshVersionFormatted 2\nDimension 3\n";
  put_row(head, '\n', "Vertices", cells.points.size());
  write_text(file, head);
  write_rows(file, cells.points.size(), [&](std::string& text, std::size_t i) {
    put_row(text, ' ', cells.points[i], id[i] + 1);
  });
  std::string elements;
  put_row(elements, '\n', "Tetrahedra", cells.cells());
  write_text(file, elements);
  write_rows(file, cells.cells(), [&](std::string& text, std::size_t c) {
    put_row(text, ' ', node_of(cells, c, 0), node_of(cells, c, 1), node_of(cells, c, 2),
            node_of(cells, c, 3), 1);
  });
  write_text(file, "End\n");
}

void add_abaqus(NewFile& file, const Dataset& cells) {
  const auto& id = integers(cells.point_columns, "id");
  write_text(file, "*NODE, NSET=ALL\n");
  write_rows(file, cells.points.size(), [&](std::string& text, std::size_t i) {
    const Vec3& p = cells.points[i];
    put_row(text, ',', i + 1, short_place(p.x()), short_place(p.y()), short_place(p.z()));
  });
  write_text(file, "*ELEMENT, TYPE=C3D4, ELSET=BODY\n");
  write_rows(file, cells.cells(), [&](std::string& text, std::size_t c) {
    put_row(text, ',', c + 1, node_of(cells, c, 0), node_of(cells, c, 1), node_of(cells, c, 2),
            node_of(cells, c, 3));
  });
  write_text(file, "*NSET, NSET=PARTICLES\n");
  write_rows(file, id.size(), [&](std::string& text, std::size_t i) {
    if (id[i] >= 0) put_row(text, ',', i + 1);
  });
}

struct CellFormat {
  std::string_view ending, help;
  void (*add)(NewFile&, const Dataset&);  ///< null: VTU
};

constexpr std::array<CellFormat, 4> formats = {{{".vtu", "VTK", nullptr},
                                                {".msh", "Gmsh 2.2", add_gmsh},
                                                {".mesh", "Medit", add_medit},
                                                {".inp", "Abaqus and CalculiX", add_abaqus}}};

const CellFormat& format_of(const std::filesystem::path& path) {
  for (const CellFormat& format : formats)
    if (lower(path.extension().string()) == format.ending) return format;
  throw bad_input("'" + path.string() + "' is no name for a file of tetrahedra",
                  "give a name that ends in .vtu, .msh, .mesh or .inp");
}

}  // namespace

void check_cell_file(const std::filesystem::path& path) { format_of(path); }

std::string help_of_cell_files() {
  std::string text;
  for (const CellFormat& format : formats)
    text.append(text.empty() ? "" : ", ").append(format.ending).append(" of ").append(format.help);
  return text;
}

void write_cells(const std::filesystem::path& path, const Dataset& cells) {
  assert(cells.kind == CellKind::tetrahedron);
  const CellFormat& format = format_of(path);
  if (!format.add) return write_vtu(path, cells, {.series = "volume", .double_points = true});
  NewFile file(path);
  format.add(file, cells);
  file.finish();
}

}  // namespace sinew
