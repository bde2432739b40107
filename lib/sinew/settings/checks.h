// SPDX-License-Identifier: GPL-3.0-or-later
// What settings ask of each other.
#pragma once

#include <span>
#include <string_view>

#include <sinew/settings/settings.h>

namespace sinew {

/// Two keys that say the same in two ways: at most one of them is given.
struct EitherOr {
  std::string_view first, second;
  bool needed;  ///< one of them must be given
};

std::span<const EitherOr> either_or();

/// The other key of a pair, or "".
std::string_view rival_of(std::string_view path);

/// Gives the keys that a named material stands for their values, where the scene gives none.
void apply_preset(Settings& settings);

/// Throws bad input, naming the scene's line, for two rivals or none of a needed pair, a >= b,
/// frames further apart than the run is long, up along forward, and a clip that ends before it
/// begins.
void check_together(const Settings& settings);

}  // namespace sinew
