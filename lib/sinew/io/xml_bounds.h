// SPDX-License-Identifier: GPL-3.0-or-later
// What VTK's XML parser bears. It frees nested elements by recursion: a file of a few hundred
// kilobytes could exhaust the stack. And it looks at an unfinished tag anew with every piece of the
// file it reads: one of a few megabytes takes seconds, ten times that takes minutes. An element
// takes some 2 kB of memory.
#pragma once

#include <string_view>

namespace sinew {

/// Whether the elements of `xml` are no more (200,000) and nest no deeper and its tags are no
/// longer than in any of our files, by far, and nothing stands around its elements. False for
/// comments and CDATA too, which none of our files has.
bool is_within_bounds(std::string_view xml);

}  // namespace sinew
