// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/front.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

namespace sinew {
namespace {

enum class Flank { left, right, middle };

struct Named {
  Flank side = Flank::middle;
  std::string what;  ///< the same on both sides
};

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_lower(char c) { return std::islower(static_cast<unsigned char>(c)) != 0; }

std::string without_digits(std::string name) {
  std::erase_if(name, [](unsigned char c) { return std::isdigit(c) != 0; });
  return name;
}

std::string lower_case(std::string name) {
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

/// Whether name[i], an L or an R, stands for a side: a word of its own, or lower case before a
/// capital as in "lThigh".
bool tells_side(const std::string& name, std::size_t i) {
  const bool begins = i == 0 || !is_letter(name[i - 1]);
  const bool ends = i + 1 == name.size() || !is_letter(name[i + 1]);
  const bool before_capital =
      is_lower(name[i]) && i + 1 < name.size() && is_letter(name[i + 1]) && !is_lower(name[i + 1]);
  return begins && (ends || before_capital);
}

Named named(const std::string& full) {
  const std::string name = without_digits(full), plain = lower_case(name);
  for (const auto& [word, side] : {std::pair("left", Flank::left), {"right", Flank::right}})
    if (const auto at = plain.find(word); at != std::string::npos)
      return {side, lower_case(std::string(name).replace(at, std::string(word).size(), "*"))};
  for (std::size_t i = 0; i < name.size(); ++i)
    if ((plain[i] == 'l' || plain[i] == 'r') && tells_side(name, i))
      return {plain[i] == 'l' ? Flank::left : Flank::right,
              lower_case(std::string(name).replace(i, 1, "*"))};
  return {Flank::middle, plain};
}

bool is_foot(const std::string& name) {
  return name.find("foot") != std::string::npos || name.find("toe") != std::string::npos;
}

Vec3 level(const Vec3& v) { return {v.x(), v.y(), 0}; }

}  // namespace

std::optional<Vec3> front_of(std::span<const std::string> names, const Points& heads,
                             const Points& tails) {
  struct Sum {
    Vec3 heads = Vec3::Zero();
    double count = 0;
  };
  std::map<std::string, std::array<Sum, 2>> pairs;
  Vec3 feet = Vec3::Zero();
  double size = 0;
  for (std::size_t b = 0; b < names.size(); ++b) {
    size = std::max(size, (heads[b] - heads[0]).norm());
    const Named bone = named(names[b]);
    if (is_foot(bone.what)) feet += level(tails[b] - heads[b]);
    if (bone.side == Flank::middle) continue;
    Sum& sum = pairs[bone.what][bone.side == Flank::left ? 0 : 1];
    sum.heads += heads[b];
    ++sum.count;
  }
  Vec3 to_left = Vec3::Zero();
  for (const auto& [what, sides] : pairs)
    if (sides[0].count > 0 && sides[1].count > 0)
      to_left += level(sides[0].heads / sides[0].count - sides[1].heads / sides[1].count);
  constexpr double clear = 0.02;  // fraction of the figure's size
  Vec3 front = to_left.cross(Vec3::UnitZ());
  if (front.norm() < clear * size) front = feet;
  if (front.norm() < clear * size) return std::nullopt;
  front.normalize();
  if (feet.norm() > clear * size && feet.normalized().dot(front) < -0.5) front = -front;
  return front;
}

}  // namespace sinew
