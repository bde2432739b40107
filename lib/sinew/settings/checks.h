// SPDX-License-Identifier: GPL-3.0-or-later
// Checks that involve more than one setting.
//
//     apply_preset(settings);
//     check_together(settings);
#pragma once

#include <span>
#include <string_view>

#include <sinew/settings/settings.h>

namespace sinew {

/// Two keys that specify the same thing: at most one of them may be given.
struct EitherOr {
  std::string_view first, second;
  bool needed;  ///< one of them must be given
};

std::span<const EitherOr> either_or();

/// The other key of a pair, or "".
std::string_view rival_of(std::string_view path);

/// Sets the values of a named material, for keys that the scene does not give.
void apply_preset(Settings& settings);

/// Throws bad input, with the scene's line, for both or neither of a pair of keys, a >= b, frames
/// further apart than the duration of the run, up along forward, and a clip that ends before it
/// begins.
void check_together(const Settings& settings);

}  // namespace sinew
