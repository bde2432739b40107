// SPDX-License-Identifier: GPL-3.0-or-later
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <charconv>
#include <cmath>

#include "core/error.h"
#include "core/file.h"
#include "core/settings_table.h"
#include "io/series.h"
#include "io/vtk_messages.h"
#include "io/xml_bounds.h"

namespace sinew {
namespace {

constexpr std::uint64_t largest_pvd = std::uint64_t{256} << 20;  // bytes

Error refused(const std::string& what) { return bad_input(what, "use a PVD file of a run"); }

double time_of(const std::string& text) {
  double time = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), time);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(time))
    throw refused("timestep '" + text.substr(0, 40) + "' is not a number");
  return time;
}

/// A PVD from elsewhere must not make us read files outside its folder.
void check_inside(const std::filesystem::path& file) {
  bool inside = !file.empty() && file.is_relative();
  for (const auto& part : file) inside = inside && part != "..";
  if (!inside)
    throw refused("'" + file.string().substr(0, 200) + "' does not lie below the PVD's folder");
}

PvdRow row_of(vtkXMLDataElement& element) {
  const char* time = element.GetAttribute("timestep");
  const char* file = element.GetAttribute("file");
  if (!time || !file) throw refused("a DataSet lacks its timestep or file");
  check_inside(file);
  return {time_of(time), file};
}

std::vector<PvdRow> rows_of(vtkXMLDataElement& root) {
  vtkXMLDataElement* collection = root.FindNestedElementWithName("Collection");
  if (std::string_view(root.GetName()) != "VTKFile" || !collection)
    throw refused("it is not a PVD file");
  std::vector<PvdRow> rows;
  for (int i = 0; i < collection->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* element = collection->GetNestedElement(i);
    if (std::string_view(element->GetName()) == "DataSet") rows.push_back(row_of(*element));
  }
  return rows;
}

}  // namespace

std::string pvd_text(const std::vector<PvdRow>& rows) {
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (const PvdRow& row : rows)
    text += "    <DataSet timestep=\"" + number_text(row.time) +
            "\" group=\"\" part=\"0\" file=\"" + row.file + "\"/>\n";
  return text + "  </Collection>\n</VTKFile>\n";
}

std::vector<PvdRow> read_pvd(const std::filesystem::path& path) {
  const std::string text = read_file(path, largest_pvd);
  if (!is_within_bounds(text))
    throw refused("it is not a PVD file, or one of over 200000 frames").within({path.string()});
  const VtkMessages messages;
  const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(
      vtkXMLUtilities::ReadElementFromString(text.c_str()));
  try {
    if (!root || messages.failed()) throw refused("it is not a PVD file");
    return rows_of(*root);
  } catch (const Error& error) {
    throw error.within({path.string()});
  }
}

}  // namespace sinew
