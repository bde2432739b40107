// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of HTML. All text that comes from a user is escaped before it becomes part of a page.
//
//     const std::string heading = element("h2", escaped(title));
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sinew {

/// Text for an element or a quoted attribute: & < > " ' escaped, control characters left out.
std::string escaped(std::string_view text);

/// JSON that is safe in a script element: "<" is written by its number, which can neither end the
/// element nor begin a comment.
std::string inert(std::string json);

/// A relative link from a path: all but letters, digits and - _ . ~ / is percent-encoded and
/// leading slashes are removed, so that it can neither leave the attribute nor name another scheme
/// or host.
std::string link_to(std::string_view path);

/// An element `tag`; its content is markup already. `attributes`: markup as well, or empty.
std::string element(std::string_view tag, const std::string& content,
                    std::string_view attributes = {});

struct Cell {
  std::string_view label;  ///< label of its column
  std::string text;        ///< plain
};

/// A row of a table; `first`: markup.
std::string row(const std::string& first, const std::vector<Cell>& cells);

std::string table(const std::vector<std::string_view>& columns, const std::string& rows);

/// A number for display: four significant digits, a dash for not-a-number.
std::string readable(double value);

/// The same with a fixed number of decimals.
std::string fixed(double value, int decimals);

}  // namespace sinew
