// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/retarget.h>

#include <algorithm>
#include <array>
#include <string_view>

#include <sinew/core/text.h>

namespace sinew {
namespace {

/// Words for one part of a body; each row is one.
constexpr std::array<std::array<std::string_view, 6>, 14> limb_words = {{
    {"hips", "hip", "pelvis"},
    {"spine", "spine01", "abdomen", "lowerback"},
    {"spine1", "spine02", "chest"},
    {"spine2", "spine03", "upperchest"},
    {"neck", "neck1", "neck01"},
    {"head"},
    {"shoulder", "clavicle", "collar"},
    {"arm", "upperarm", "uparm", "shldr"},
    {"forearm", "lowerarm", "lowarm"},
    {"hand", "wrist"},
    {"upleg", "upperleg", "thigh"},
    {"leg", "lowerleg", "calf", "shin"},
    {"foot", "ankle"},
    {"toebase", "toe", "toes", "ball"},
}};

struct Words {
  char side = ' ';   ///< 'l', 'r' or ' '
  std::string word;  ///< in lower case, without separators
};

bool take_front(std::string& name, std::string_view what) {
  if (!name.starts_with(what) || name.size() == what.size()) return false;
  name.erase(0, what.size());
  return true;
}

bool take_back(std::string& name, std::string_view what) {
  if (!name.ends_with(what) || name.size() == what.size()) return false;
  name.erase(name.size() - what.size());
  return true;
}

/// "LeftArm" and "lShldr" have their side in a word of its own; "leg" has none.
bool begins_word(const std::string& name, std::size_t at) {
  return at < name.size() && std::isupper(static_cast<unsigned char>(name[at])) != 0;
}

Words words_of(std::string name) {
  name.erase(0, name.find_last_of(":|") + 1);
  for (const char* prefix : {"Armature_", "mixamorig_", "mixamorig", "J_Bip_C_", "J_Bip_", "Bip01 ",
                             "Bip001 ", "Bip01_", "Bip001_", "DEF-", "ORG-"})
    if (take_front(name, prefix)) break;
  Words words;
  if (name.size() > 1 && (name[0] == 'l' || name[0] == 'r' || name[0] == 'L' || name[0] == 'R') &&
      begins_word(name, 1) && !begins_word(name, 2))
    words.side = name[0], name.erase(0, 1);
  name = sinew::lower(name);
  for (const char* side : {"left", "right"})
    if (take_front(name, side) || take_back(name, side)) words.side = side[0];
  for (const char* mark : {"_", ".", " ", "-"})
    for (const char* side : {"l", "r"})
      if (take_front(name, side + std::string(mark)) || take_back(name, mark + std::string(side)))
        words.side = side[0];
  words.side = sinew::lower(std::string(1, words.side))[0];
  std::erase_if(name,
                [](char c) { return std::string_view("_.- ").find(c) != std::string_view::npos; });
  words.word = name;
  return words;
}

int part_of(const std::string& word) {
  for (std::size_t i = 0; i < limb_words.size(); ++i)
    if (!word.empty() &&
        std::find(limb_words[i].begin(), limb_words[i].end(), word) != limb_words[i].end())
      return static_cast<int>(i);
  return -1;
}

/// How names agree; each way takes what the one before has left.
enum class Way { equal, word, part };

bool agree(const std::string& one, const std::string& other, Way way) {
  if (way == Way::equal) return one == other;
  const Words a = words_of(one), b = words_of(other);
  if (a.side != b.side) return false;
  return way == Way::word ? a.word == b.word
                          : part_of(a.word) >= 0 && part_of(a.word) == part_of(b.word);
}

}  // namespace

std::vector<NamePair> matched_names(const Skeleton& to, const Skeleton& from) {
  std::vector<int> source(to.size(), no_bone);
  std::vector<bool> taken(from.size());
  for (const Way way : {Way::equal, Way::word, Way::part})
    for (std::size_t b = 0; b < to.size(); ++b)
      for (std::size_t s = 0; s < from.size() && source[b] == no_bone; ++s)
        if (!taken[s] && agree(to.bones[b].name, from.bones[s].name, way))
          taken[s] = true, source[b] = static_cast<int>(s);
  std::vector<NamePair> names;
  for (std::size_t b = 0; b < to.size(); ++b)
    if (source[b] != no_bone)
      names.push_back({to.bones[b].name, from.bones[static_cast<std::size_t>(source[b])].name});
  return names;
}

bool are_same(const std::vector<NamePair>& names) {
  return std::all_of(names.begin(), names.end(),
                     [](const NamePair& pair) { return pair[0] == pair[1]; });
}

}  // namespace sinew
