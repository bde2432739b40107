// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/source_dir.h"

namespace sinew::test {

const std::string& source_dir() {
  static const std::string folder = SINEW_SOURCE_DIR;
  return folder;
}

}  // namespace sinew::test
