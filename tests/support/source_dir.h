// SPDX-License-Identifier: GPL-3.0-or-later
// The folder of the project. One source alone is told it, so that clones at other places share what
// a compiler cache has.
#pragma once

#include <string>

namespace sinew::test {

const std::string& source_dir();

}  // namespace sinew::test
