// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/hash.h>

namespace sinew {

std::string hash_text(std::uint64_t hash) {
  std::string text(16, '0');
  for (int digit = 15; digit >= 0; --digit, hash >>= 4) text[digit] = "0123456789abcdef"[hash & 15];
  return text;
}

}  // namespace sinew
