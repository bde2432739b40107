// SPDX-License-Identifier: GPL-3.0-or-later
// The elements of an XML file that consists mostly of data: expat parses the tags, the data between
// them are skipped and referred to in place. Files with declarations or entities of their own are
// refused.
//
//     const std::vector<XmlElement> elements = xml_elements(text, "VTKFile/AppendedData");
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace sinew {

struct XmlElement {
  std::string path;  ///< the names from the root down: "VTKFile/Collection/DataSet"
  std::map<std::string, std::string, std::less<>> attributes;
  std::string_view text;  ///< up to the next tag, unchanged from the file

  /// The value, "" where there is none.
  std::string_view attribute(std::string_view name) const;
};

/// All elements in the order of their tags; beyond 200,000 they must have 32 bytes in the mean.
/// What follows the tag of the element with the path `last` is not parsed: all of it becomes its
/// text. Throws bad input.
std::vector<XmlElement> xml_elements(std::string_view xml, std::string_view last = {});

/// ` name="value"`, with what XML does not take as it stands replaced.
std::string xml_attribute(std::string_view name, std::string_view value);

}  // namespace sinew
