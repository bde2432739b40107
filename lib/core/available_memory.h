// SPDX-License-Identifier: GPL-3.0-or-later
// How much memory can be taken without swapping.
#pragma once

namespace sinew {

/// Bytes: the kernel's estimate (free pages and what caches give back), else the free pages alone.
double available_memory();

}  // namespace sinew
