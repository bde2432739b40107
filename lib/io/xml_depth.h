// SPDX-License-Identifier: GPL-3.0-or-later
// VTK frees nested XML elements by recursion: a file of a few hundred kilobytes could exhaust the
// stack.
#pragma once

#include <string_view>

namespace sinew {

/// Whether the elements of `xml` nest no deeper than any of our files, by far. False for comments
/// and CDATA too, which none of our files has.
bool nests_moderately(std::string_view xml);

}  // namespace sinew
