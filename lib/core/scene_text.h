// SPDX-License-Identifier: GPL-3.0-or-later
// Values as a scene writes them, so that YAML reads the same values back.
#pragma once

#include <string>
#include <string_view>

#include "core/settings_table.h"

namespace sinew {

/// Numbers by number_text, true, [1, 2, 3]; texts quoted where YAML would take them for something
/// else; `absent` for a value that is not given.
std::string scene_text(const FieldValue& value, std::string_view absent);

}  // namespace sinew
