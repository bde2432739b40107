// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes with one mistake each, and what must be said of them.
#pragma once

#include <string>
#include <vector>

#include "settings/small_scene.h"

namespace sinew {

inline std::string times(int count, const std::string& text) {
  std::string out;
  for (int i = 0; i < count; ++i) out += text;
  return out;
}

inline std::string replaced(const std::string& from, const std::string& to) {
  std::string text = small_scene;
  return text.replace(text.find(from), from.size(), to);
}

inline std::string block_levels(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  return text;
}

/// Each line stands for ten of the one before.
inline std::string alias_bomb(int levels) {
  std::string text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < levels; ++i) {
    const std::string name = std::string("a") + std::to_string(i);
    const std::string last = std::string("*a") + std::to_string(i - 1);
    text += name + ": &" + name + " [" + times(9, last + ", ") + last + "]\n";
  }
  return text;
}

inline std::string motion(const std::string& track) {
  return small_scene + "motion:\n  tracks:\n    - bone: lower\n" + track;
}

struct Hostile {
  const char* name;
  std::string text;
  std::string place;  ///< "LINE:COLUMN", or "" where only the file is to blame
  std::string part;   ///< of the message
};

inline const std::vector<Hostile> scenes = {
    // not a scene at all
    {"Empty", "", "", "no scene"},
    {"OnlyComments", "# nothing\n\n# here\n", "", "no scene"},
    {"Null", "~\n", "", "no scene"},
    {"List", "- body\n- skeleton\n", "1:1", "must be a group of keys"},
    {"Word", "box\n", "1:1", "must be a group of keys"},
    {"Binary",
     std::string("\x7f"
                 "ELF\x02\x01\x00\x00",
                 8),
     "1:1", "control character"},
    {"NulByte", small_scene + std::string("\0", 1), "9:1", "control character"},
    {"Latin1", replaced("lower", "unterschl\xe4gig"), "6:22", "not UTF-8"},
    {"CutUtf8", small_scene + "# \xe2\x82", "9:3", "not UTF-8"},
    {"OverlongUtf8", small_scene + "# \xc0\xaf", "9:3", "not UTF-8"},
    {"Utf16",
     std::string("\xff\xfe"
                 "b\0o\0d\0y\0",
                 10),
     "1:4", "control character"},
    {"TooLarge", std::string(65 << 20, '#'), "", "larger than 64 MiB"},
    {"TwoDocuments", small_scene + "---\n" + small_scene, "9:1", "second document"},
    {"ForeignVersion", "%YAML 9.0\n---\n" + small_scene, "1:1", "not YAML"},
    // not YAML
    {"TabIndent", "body:\n\tmesh: box.obj\n", "2:1", "tab in the indentation"},
    {"TabAfterSpaces", "body:\n  \tmesh: box.obj\n", "2:3", "tab in the indentation"},
    {"OpenDoubleQuote", replaced("box.obj", "\"box.obj"), "2:9", "never closed"},
    {"OpenSingleQuote", replaced("box.obj", "'box.obj"), "2:9", "never closed"},
    {"OpenQuoteWithAnchor", replaced("box.obj", "&m 'it''s"), "2:9", "never closed"},
    {"BadEscape", replaced("box.obj", "\"\\q\""), "2:12", "not YAML"},
    {"OpenBracket", replaced("[0, 0, 1]", "[0, 0, 1"), "", "not YAML"},
    {"StrayBracket", small_scene + "]\n", "9:1", "not YAML"},
    {"TwoColons", replaced("box.obj", "box: obj"), "2:12", "not YAML"},
    {"NoSpaceAfterColon", replaced("radius: 0.01", "radius:0.01"), "4:9", "not YAML"},
    {"BadIndent", replaced("  radius", " radius"), "3:2", ""},
    {"AtSign", replaced("0.01", "@0.01"), "3:11", "not YAML"},
    {"Tag", replaced("0.01", "!!float 0.01"), "3:11", "tag"},
    {"TagOfList", replaced("[0, 0, 1]", "!!set [0, 0, 1]"), "8:13", "tag"},
    {"ListAsKey", small_scene + "[a, b]: 3\n", "9:1", "no word"},
    {"EmptyKey", small_scene + ": 3\n", "9:1", "no word"},
    {"QuotedEmptyKey", small_scene + "\"\": 3\n", "9:1", "unknown key ''"},
    {"UnknownAlias", replaced("0.01", "*r"), "3:11", "not YAML"},
    {"CyclicAlias", small_scene + "solver: &s\n  gravity: *s\n", "10:12", "alias inside"},
    {"CyclicList", small_scene + "solver:\n  gravity: &g [0, 0, *g]\n", "10:22", "alias inside"},
    {"AliasBomb", alias_bomb(9), "5:45", "values in one scene"},
    {"AliasesOfALongText",
     "x: &t \"" + std::string(100'000, 'a') + "\"\nbody: [" + times(90'000, "*t, ") + "*t]\n", "",
     "values in one scene"},
    {"QuotedLetters", "body: {mesh: \"\u00e4\u00f6\u9aa8\U0001f9b4\", radus: 1}\n", "1:22",
     "unknown key 'radus'"},
    {"DeepBrackets", "body: " + times(100'000, "["), "", "32 deep"},
    {"DeepClosedBrackets", "body: " + times(50'000, "[") + times(50'000, "]"), "1:38", "32 deep"},
    {"DeepBraces", times(50'000, "{a: ") + times(50'000, "}"), "1:129", "32 deep"},
    {"DeepDashes", times(100'000, "- "), "1:65", "32 deep"},
    {"DeepBlocks", block_levels(2000), "33:33", "32 deep"},
    {"DeepQuestions", times(100'000, "? "), "1:65", "32 deep"},
    {"ManyBrackets", times(1'000'000, "["), "", "brackets"},
    {"ManyValues", "body: [" + times(400'000, "1,") + "1]\n", "1:600010", "300002 values"},
    {"DuplicateSection", small_scene + "body:\n  radius: 0.02\n", "9:1", "twice"},
    {"DuplicateKey", replaced("  radius: 0.01\n", "  radius: 0.01\n  radius: 0.01\n"), "4:3",
     "line 3"},
    {"DuplicateInBone", small_scene + "      tail: [0, 0, 2]\n", "9:7", "twice"},
    // keys
    {"UnknownSection", small_scene + "sovler:\n  duration: 1\n", "9:1", "did you mean solver?"},
    {"UnknownKey", replaced("radius", "raduis"), "3:3", "did you mean radius?"},
    {"UnknownKeyOfBone", replaced("tail", "tial"), "8:7", "did you mean tail?"},
    {"UnknownKeyOfTrack", motion("      interpolate: smooth\n"), "12:7", "interpolation?"},
    {"UnknownKeyOfKey", motion("      keys:\n        - tim: 0\n"), "13:11", "did you mean time?"},
    {"UnknownKeyLikeNone", small_scene + "solver:\n  zzz: 1\n", "10:3", "use one of method"},
    {"KeyOutsideItsSection", small_scene + "duration: 1\n", "9:1", "belongs into solver"},
    {"HugeKey", small_scene + "x" + times(900, "y") + ": 1\n", "9:1", "..."},
    {"ControlInKey", small_scene + "\"a\\nb\\e[31m\": 1\n", "9:1", "a?b?[31m"},
    {"MergeKey", small_scene + "solver:\n  <<: {duration: 1}\n", "10:3", "unknown key '<<'"},
    {"SectionIsNumber", small_scene + "solver: 3\n", "9:9", "group of keys"},
    {"SectionIsList", small_scene + "solver:\n  - duration: 1\n", "9:1", "group of keys"},
    // values
    {"NumberIsText", replaced("0.01", "thick"), "3:11", "'thick', not a number"},
    {"NumberWithUnit", replaced("0.01", "10 mm"), "3:11", "give a number > 0 (m)"},
    {"NumberWithComma", replaced("0.01", "0,01"), "3:11", "not a number"},
    {"NumberQuoted", replaced("0.01", "\"0.01\""), "3:11", "in quotes"},
    {"NumberIsList", replaced("0.01", "[0.01]"), "3:11", "a list, not a number"},
    {"NumberIsEmpty", replaced("0.01", ""), "3:3", "body.radius is empty"},
    {"NumberIsNull", replaced("0.01", "null"), "3:3", "body.radius is empty"},
    {"NotANumber", replaced("0.01", ".nan"), "3:11", "not a finite number"},
    {"Infinite", replaced("0.01", ".inf"), "3:11", "not a finite number"},
    {"TooLargeForADouble", replaced("0.01", "1e999"), "3:11", "not a finite number"},
    {"DividedByZero", replaced("0.01", "1/0"), "3:11", "not a finite number"},
    {"Zero", replaced("0.01", "0"), "3:11", "out of range; give a number > 0"},
    {"Negative", replaced("0.01", "-0.01"), "3:11", "out of range"},
    {"AboveRange", small_scene + "material:\n  b: 9\n", "10:6", "out of range"},
    {"NotWhole", replaced("radius: 0.01", "count: 2.5"), "3:10", "not a whole number"},
    {"HugeWhole", replaced("radius: 0.01", "count: 99999999999"), "3:10", "out of range"},
    {"UnknownChoice", small_scene + "body2:\n", "9:1", "did you mean body?"},
    {"ChoiceMisspelt", replaced("radius: 0.01", "packing: fc"), "3:12", "did you mean fcc?"},
    {"FlagIsYes", small_scene + "output:\n  double_precision: yes\n", "10:21", "true or false"},
    {"VectorOfTwo", replaced("[0, 0, 1]", "[0, 1]"), "8:13", "of 2 values"},
    {"VectorIsNumber", replaced("[0, 0, 1]", "1"), "8:13", "[x, y, z]"},
    {"VectorOfWords", replaced("[0, 0, 1]", "[0, up, 1]"), "8:17", "bones[0].tail[1] is 'up'"},
    {"VectorWithNan", replaced("[0, 0, 1]", "[0, 0, .nan]"), "8:20", "not a finite number"},
    {"TextIsList", replaced("lower", "[lower]"), "6:13", "not a text"},
    {"TextIsEmpty", replaced("lower", "\"\""), "6:13", "empty"},
    {"TextOfTwoLines", replaced("lower", "\"a\\nb\""), "6:13", "more than one line"},
    {"MeshIsMap", replaced("box.obj", "{file: box.obj}"), "2:9", "not a text"},
    // what belongs together
    {"NoBody", "skeleton:\n  bones:\n    - {name: a, head: [0, 0, 0], tail: [0, 0, 1]}\n", "",
     "body.mesh is missing"},
    {"NoMesh", replaced("  mesh: box.obj\n", ""), "1:1", "body.mesh is missing"},
    {"NoRadius", replaced("  radius: 0.01\n", ""), "1:1", "both missing"},
    {"RadiusAndCount", replaced("0.01\n", "0.01\n  count: 100\n"), "4:10", "both given"},
    {"ModulusAndK1", small_scene + "material:\n  k1: 1\n  young_modulus: 1\n", "10:7",
     "both given"},
    {"LambdaAndK2", small_scene + "material:\n  lambda: 1\n  k2: 1\n", "11:7", "both given"},
    {"AttractionEndsFirst", small_scene + "material:\n  a: 2.7\n", "10:6", "give an a below b"},
    {"FrameAfterTheEnd", small_scene + "output:\n  interval: 2\n", "10:13", "frames every 2 s"},
    {"NoSkeleton", "body:\n  mesh: box.obj\n  radius: 0.01\n", "", "skeleton.bones is missing"},
    {"NoBones", "body: {mesh: b, radius: 1}\nskeleton: {bones: []}\n", "2:19", "no entries"},
    {"BonesIsMap", "body: {mesh: b, radius: 1}\nskeleton: {bones: {a: 1}}\n", "2:19",
     "must be a list"},
    {"BoneIsWord", "body: {mesh: b, radius: 1}\nskeleton:\n  bones:\n    - lower\n", "4:7",
     "group"},
    {"BoneIsEmpty", small_scene + "    -\n", "", "bones[1].name is missing"},
    {"BoneWithoutTail", replaced("      tail: [0, 0, 1]\n", ""), "6:7", "tail is missing"},
    // the rig
    {"UnknownParent", small_scene + "    - {name: b, parent: c, tail: [0, 0, 2]}\n", "9:25", "'c'"},
    {"TwoBonesOfOneName", small_scene + "    - {name: lower, head: [0, 0, 1], tail: [0, 0, 2]}\n",
     "9:14", "two bones"},
    {"RootWithoutHead", replaced("      head: [0, 0, 0]\n", ""), "6:13", "neither a parent nor"},
    {"BoneWithoutLength", replaced("[0, 0, 1]", "[0, 0, 0]"), "8:13", "no length"},
    {"TracksIsWord", small_scene + "motion:\n  tracks: none\n", "10:11", "must be a list"},
    {"TrackOfNoBone", small_scene + "motion:\n  tracks:\n    - {bone: b, keys: [{time: 0}]}\n",
     "11:14", "no bone 'b'"},
    {"TrackWithoutKeys", motion(""), "11:7", "keys is missing"},
    {"TrackWithEmptyKeys", motion("      keys: []\n"), "12:13", "no entries"},
    {"KeyWithoutTime", motion("      keys:\n        - twist: 1\n"), "13:11", "time is missing"},
    {"KeysOutOfOrder", motion("      keys:\n        - time: 1\n        - time: 0\n"), "14:17",
     "ascending"},
    {"AngleWithoutAxis", motion("      keys:\n        - {time: 0, angle: 3}\n"), "", "axis"},
    {"KeyWithTimeAndFrame", motion("      keys:\n        - {time: 0, frame: 0}\n"), "13:28",
     "time twice"},
    {"FramesOfNoRate", motion("      keys:\n        - frame: 3\n"), "13:18", "frame_rate"},
    {"FramesOutOfOrder",
     motion("      keys:\n        - frame: 3\n        - frame: 2\n  frame_rate: 30\n"), "14:18",
     "ascending"},
    {"NegativeFrame", motion("      keys:\n        - frame: -1\n"), "13:18", "out of range"},
    {"FrameRateOfZero", small_scene + "motion:\n  frame_rate: 0\n", "10:15", "out of range"},
    {"QuaternionOfThree", motion("      keys:\n        - {time: 0, quaternion: [1, 0, 0]}\n"),
     "13:33", "of 3 values, not of 4"},
    {"QuaternionOfNoLength", motion("      keys:\n        - {time: 0, quaternion: [0, 0, 0, 0]}\n"),
     "", "no rotation"},
    {"QuaternionTooLong", motion("      keys:\n        - {time: 0, quaternion: [1, 0, 0.1, 0]}\n"),
     "", "of length 1.0"},
    {"QuaternionAndEuler",
     motion("      keys:\n        - {time: 0, quaternion: [1, 0, 0, 0], euler: [0, 0, 0]}\n"), "",
     "twice"},
    {"StretchOfZero", motion("      keys:\n        - {time: 0, stretch: 0}\n"), "13:30",
     "out of range"},
    {"UnknownWayBetweenKeys", motion("      interpolation: cubc\n      keys: [{time: 0}]\n"),
     "12:22", "did you mean cubic?"},
    {"UnknownExtrapolation", small_scene + "motion:\n  extrapolation: lop\n", "10:18",
     "did you mean loop?"},
    {"UnknownUp", replaced("skeleton:", "skeleton:\n  up: w"), "5:7", "use one of x, y, z"},
    {"UpAlongForward", replaced("skeleton:", "skeleton:\n  up: -x\n  forward: x"), "6:12",
     "one axis"},
    {"ScaleOfZero", replaced("skeleton:", "skeleton:\n  scale: 0"), "5:10", "out of range"},
    {"RigMissing", "body: {mesh: b, radius: 1}\nskeleton:\n  file: none.yaml\n", "3:9",
     "none.yaml"},
    {"RigAndBones", replaced("skeleton:", "skeleton:\n  file: rig.yaml"), "5:9", "both given"},
    {"ClipEndsFirst", small_scene + "motion:\n  start: 3\n  end: 2\n", "11:8", "before it begins"},
    {"ClipStartsLate",
     small_scene + "motion:\n  start: 3\n  tracks: [{bone: lower, keys: [{time: 0}]}]\n", "10:10",
     "last key"},
    {"SwingTooWide", small_scene + "      limits: {swing: 190}\n", "9:23", "out of range"},
    {"TwistTheWrongWayRound", small_scene + "      limits: {twist: [10, -10]}\n", "9:23",
     "smaller limit first"},
    {"TwistIsNumber", small_scene + "      limits: {twist: 10}\n", "9:23", "not a list of 2"},
    {"UnknownLimit", small_scene + "      limits: {swng: 10}\n", "9:16", "did you mean swing?"},
    {"LimitsIsNumber", small_scene + "      limits: 10\n", "9:15", "group of keys"},
    {"TailAndLength", small_scene + "      length: 1\n", "9:15", "tail already"},
    {"LengthWithoutDirection", replaced("tail: [0, 0, 1]", "length: 1"), "8:15", "no direction"},
    {"LengthOfZero", small_scene + "    - {name: b, parent: lower, length: 0}\n", "9:40",
     "out of range"},
    {"ConnectedToNothing", replaced("head: [0, 0, 0]", "connected: true"), "7:18", "no parent"},
    {"ParentsInACircle",
     "body: {mesh: b, radius: 1}\nskeleton:\n  bones:\n"
     "    - {name: a, parent: b, tail: [0, 0, 1]}\n    - {name: b, parent: a, tail: [0, 0, 2]}\n",
     "4:25", "no bone before this one"},
    {"EmptyEntry", small_scene + "supports:\n  - {name: a}\n  -\n", "10:5",
     "supports[1].name is missing"},
    {"UnknownOrder", motion("      order: xxy\n      keys: [{time: 0}]\n"), "12:14", "xxy"},
};

}  // namespace sinew
