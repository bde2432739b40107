// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/vtk/vtk_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <locale>
#include <map>
#include <new>
#include <sstream>
#include <string>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/io/detail/vtk_xml.h>
#include <sinew/io/vtk/detail/grids.h>

namespace sinew {
namespace {

constexpr double memory_per_byte = 8;  // what reads, cleans and searches a mesh takes

using PieceElements = std::span<const XmlElement>;

/// Finds the only array in a group, or the one of that name; none: nullptr.
const XmlElement* array_of(const VtkXmlFile& file, PieceElements piece, const std::string& group,
                           std::string_view name) {
  for (const XmlElement* array : file.arrays_in(piece, group))
    if (array->attribute("Name") == name || name.empty()) return array;
  return nullptr;
}

std::vector<std::int64_t> integers_of(const VtkXmlFile& file, PieceElements piece,
                                      const std::string& group, const char* name,
                                      std::uint64_t count) {
  const XmlElement* array = array_of(file, piece, group, name);
  if (array == nullptr) throw vtu_refused("its " + group + " have no " + std::string(name));
  const Column column = file.arrays.column(*array, count);
  if (const auto* integers = std::get_if<std::vector<std::int32_t>>(&column.values))
    return {integers->begin(), integers->end()};
  throw vtu_refused("array " + quoted(name) + " does not hold integers of 32 bits");
}

/// Adds the cells of one group of a piece, whose points begin at `first`; `type`: of all of them,
/// or -1 where the file says.
void add_cells(const VtkXmlFile& file, PieceElements piece, const std::string& group,
               std::uint64_t count, int type, std::size_t first, VtkCells& cells) {
  if (count == 0) return;
  const auto ends = integers_of(file, piece, group, "offsets", count);
  if (ends.back() < 0) throw vtu_refused("its offsets are below 0");
  const auto points =
      integers_of(file, piece, group, "connectivity", static_cast<std::uint64_t>(ends.back()));
  const auto begin = static_cast<std::int64_t>(cells.points.size());
  for (const std::int64_t id : points)
    cells.points.push_back(id < 0 ? id : id + static_cast<std::int64_t>(first));
  for (const std::int64_t end : ends) cells.ends.push_back(begin + end);
  if (type >= 0)
    cells.types.insert(cells.types.end(), count, type);
  else
    for (const std::int64_t one : integers_of(file, piece, group, "types", count))
      cells.types.push_back(static_cast<int>(one));
}

std::uint64_t count_if_any(const VtkXmlFile& file, const XmlElement& piece, const char* name) {
  return piece.attribute(name).empty() ? 0 : file.arrays.count(piece, name);
}

/// Flags of the last `count` cells of a piece, of which it has `before` others.
void add_ghosts(const VtkXmlFile& file, PieceElements piece, std::uint64_t before,
                std::uint64_t count, VtkCells& cells) {
  cells.ghosts.resize(cells.ends.size() - count);
  for (const std::string_view name : {ghost_array, old_ghost_array}) {
    const XmlElement* array = array_of(file, piece, "Piece/CellData", name);
    if (array == nullptr) continue;
    const Column column = file.arrays.column(*array, before + count);
    const auto* flags = std::get_if<std::vector<std::int32_t>>(&column.values);
    if (flags == nullptr || flags->size() != before + count)
      throw vtu_refused("array " + quoted(name) + " does not hold flags");
    for (std::size_t i = before; i < flags->size(); ++i)
      cells.ghosts.push_back(static_cast<std::uint8_t>(
          name == ghost_array ? (*flags)[i] : static_cast<int>((*flags)[i] > 0)));
    return;
  }
}

/// Appends `count` values, if there are that many and all are whole.
template <class Number>
void append_whole(const std::vector<Number>& values, std::size_t count,
                  std::vector<std::int64_t>& to) {
  const auto whole = [](double value) {
    return std::abs(value) < 1e15 && value == std::floor(value);
  };
  if (values.size() != count || !std::all_of(values.begin(), values.end(), whole)) return;
  for (const Number value : values) to.push_back(static_cast<std::int64_t>(value));
}

/// Adds the numbers of materials of the last cells, of the first array that has them; none of a
/// damaged one, which the surface does not need.
void add_materials(const VtkXmlFile& file, PieceElements piece, VtkCells& cells) {
  const std::size_t count = cells.ends.size() - cells.materials.size();
  for (const XmlElement* array : file.arrays_in(piece, "Piece/CellData")) {
    const auto components = array->attribute("NumberOfComponents");
    if (!names_materials(array->attribute("Name")) || (!components.empty() && components != "1"))
      continue;
    try {
      std::visit([&](const auto& values) { append_whole(values, count, cells.materials); },
                 file.arrays.column(*array, count).values);
    } catch (const Error&) {
    }
    return;
  }
}

void add_piece(const VtkXmlFile& file, PieceElements piece, VtkGrid& grid) {
  const std::uint64_t count = file.arrays.count(piece.front(), "NumberOfPoints");
  const std::size_t first = grid.points.size();
  if (count > 0) {
    const XmlElement* places = array_of(file, piece, "Piece/Points", "");
    if (places == nullptr) throw vtu_refused("its points are missing");
    Points points = file.arrays.points(*places, count);
    for (const Vec3& point : points)
      if (!is_computable(point)) throw vtu_refused("a point is too large or not finite");
    if (grid.points.empty())
      grid.points = std::move(points);
    else
      grid.points.insert(grid.points.end(), points.begin(), points.end());
  }
  const auto count_of = [&](const char* number) {
    return count_if_any(file, piece.front(), number);
  };
  const auto add = [&](const char* group, const char* number, int type) {
    add_cells(file, piece, std::string("Piece/") + group, count_of(number), type, first,
              grid.cells);
    return count_of(number);
  };
  if (file.type == "UnstructuredGrid") {
    add_ghosts(file, piece, 0, add("Cells", "NumberOfCells", -1), grid.cells);
    return add_materials(file, piece, grid.cells);
  }
  const std::uint64_t polygons = add("Polys", "NumberOfPolys", vtk_polygon),
                      strips = add("Strips", "NumberOfStrips", vtk_strip);
  add_ghosts(file, piece, count_of("NumberOfVerts") + count_of("NumberOfLines"), polygons + strips,
             grid.cells);
}

VtkGrid grid_of(const VtkXmlFile& file) {
  VtkGrid grid;
  const auto pieces = file.pieces();
  for (const PieceElements piece : pieces) add_piece(file, piece, grid);
  grid.pieces = pieces.size() > 1;
  return grid;
}

/// The numbers of an attribute; as many as `initial` has, which stay where there are none.
template <std::size_t count>
std::array<double, count> numbers_of(const XmlElement& element, const char* attribute,
                                     std::array<double, count> initial) {
  const auto text = element.attribute(attribute);
  if (text.empty()) return initial;
  std::istringstream words{std::string(text)};
  words.imbue(std::locale::classic());
  for (double& number : initial)
    if (!(words >> number) || !std::isfinite(number))
      throw vtu_refused(std::string(attribute) + " is " + quoted(text));
  return initial;
}

/// Samples along each axis and in all; throws where the file cannot hold them.
std::uint64_t read_extent(const VtkXmlFile& file, LevelSet& image) {
  const auto extent = numbers_of<6>(file.grid(), "WholeExtent", {0, -1, 0, -1, 0, -1});
  double all = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double size = extent[2 * k + 1] - extent[2 * k] + 1;
    all *= size;
    if (!(size >= 1) || !(all <= static_cast<double>(file.arrays.most)) || size > 1e9)
      throw vtu_refused("its WholeExtent is " + quoted(file.grid().attribute("WholeExtent")) +
                        ", which its size cannot hold");
    image.size[k] = static_cast<int>(size);
  }
  const auto origin = numbers_of<3>(file.grid(), "Origin", {0, 0, 0});
  const auto spacing = numbers_of<3>(file.grid(), "Spacing", {1, 1, 1});
  const auto turn = numbers_of<9>(file.grid(), "Direction", {1, 0, 0, 0, 1, 0, 0, 0, 1});
  for (int row = 0; row < 3; ++row)
    for (int k = 0; k < 3; ++k) image.axes(row, k) = turn[3 * row + k] * spacing[k];
  image.origin = Vec3(origin.data()) + image.axes * Vec3(extent[0], extent[2], extent[4]);
  return static_cast<std::uint64_t>(all);
}

/// Finds the active scalars of points or cells, or their first array of one component; none:
/// nullptr.
const XmlElement* scalars_in(const VtkXmlFile& file, PieceElements piece,
                             const std::string& group) {
  std::string_view active;
  for (const XmlElement& element : piece)
    if (element.path == "VTKFile/ImageData/" + group) active = element.attribute("Scalars");
  const XmlElement* named = array_of(file, piece, group, active);
  if (named != nullptr && !active.empty()) return named;
  for (const XmlElement* array : file.arrays_in(piece, group)) {
    const auto components = array->attribute("NumberOfComponents"), name = array->attribute("Name");
    if ((components.empty() || components == "1") && name != ghost_array) return array;
  }
  return nullptr;
}

PolygonSoup surface_of_image(const VtkXmlFile& file, std::optional<double> level) {
  const auto pieces = file.pieces();
  if (pieces.size() != 1)
    throw vtu_refused("the image has " + std::to_string(pieces.size()) + " pieces, not one");
  LevelSet image;
  std::uint64_t count = read_extent(file, image);
  const XmlElement* array = scalars_in(file, pieces.front(), "Piece/PointData");
  if (array == nullptr) {
    array = scalars_in(file, pieces.front(), "Piece/CellData");
    move_to_cells(image);
    count = static_cast<std::uint64_t>(image.size[0]) * static_cast<std::uint64_t>(image.size[1]) *
            static_cast<std::uint64_t>(image.size[2]);
  }
  if (array == nullptr)
    throw bad_input("the image has no scalars at its points or cells",
                    "store the level set as point data");
  const Column scalars = file.arrays.column(*array, count);
  image.bytes = count * size_of_type(*array);
  if (scalars.components != 1) throw vtu_refused("the image's scalars have several components");
  std::visit(
      [&](const auto& values) {
        if (values.empty()) return;
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        if (*low == *high) throw no_surface(*low, *high);
        image.values.assign(values.begin(), values.end());
      },
      scalars.values);
  return level_surface(std::move(image), level);
}

/// What is told of a file with several moments; arrays of the first precede those of others.
std::string moments_told(const VtkXmlFile& file) {
  std::istringstream words{std::string(file.grid().attribute("TimeValues"))};
  std::vector<std::string> times;
  for (std::string word; words >> word;) times.push_back(word);
  if (times.size() < 2) return {};
  return "it holds " + std::to_string(times.size()) + " moments, from " + shown(times.front()) +
         " to " + shown(times.back()) + " s, of which the first is read; save another as a file " +
         "of its own";
}

PolygonSoup xml_surface(std::string_view text, const std::string& extension,
                        std::optional<double> level) {
  const VtkXmlFile file = vtk_xml_file(text);
  const std::map<std::string, std::string> extensions = {
      {"PolyData", ".vtp"}, {"UnstructuredGrid", ".vtu"}, {"ImageData", ".vti"}};
  const auto own = extensions.find(file.type);
  if (own == extensions.end())
    throw bad_input("it holds " + shown(file.type) + ", which is not read",
                    "save its surface as .vtp: in ParaView, Extract Surface");
  if (own->second != extension)
    throw bad_input("the extension is not the content's: it holds " + file.type,
                    "rename it to " + own->second);
  if (file.type != "ImageData" && level) throw no_image();
  PolygonSoup soup =
      file.type == "ImageData" ? surface_of_image(file, level) : soup_of(grid_of(file));
  add_warning(soup, moments_told(file));
  return soup;
}

PolygonSoup surface_in(std::string_view text, const std::string& extension,
                       std::optional<double> level) {
  if (text.empty()) throw bad_input("the file is empty", "export the mesh again");
  if (extension != ".vtk") return xml_surface(text, extension, level);
  LegacyContent content = legacy_content(text);
  if (content.image) return level_surface(std::move(*content.image), level);
  if (level) throw no_image();
  return soup_of(std::move(content.grid));
}

std::vector<MaterialSurface> materials_in(std::string_view text, const std::string& extension) {
  if (extension == ".vtk") return materials_of(legacy_content(text).grid);
  const VtkXmlFile file = vtk_xml_file(text);
  if (file.type != "UnstructuredGrid") return {};
  return materials_of(grid_of(file));
}

/// Calls read(text, extension) for a file of VTK.
template <class Read>
auto read_file(const std::filesystem::path& path, const Read& read) {
  try {
    const std::string extension = lower(path.extension().string());
    const std::string text = read_begun(
        path, memory_per_byte, extension == ".vtk" ? check_start_of_legacy : check_start_of_xml);
    return read(text, extension);
  } catch (const Error& error) {
    throw error.with_context({path.string()});
  } catch (const std::bad_alloc&) {
    throw bad_input({path.string()}, "it takes more memory than there is", "make it smaller");
  }
}

}  // namespace

PolygonSoup read_vtk_mesh(const std::filesystem::path& path, std::optional<double> level) {
  return read_file(path, [&](std::string_view text, const std::string& extension) {
    return surface_in(text, extension, level);
  });
}

std::vector<MaterialSurface> read_vtk_materials(const std::filesystem::path& path) {
  return read_file(path, materials_in);
}

}  // namespace sinew
