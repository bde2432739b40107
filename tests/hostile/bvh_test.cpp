// SPDX-License-Identifier: GPL-3.0-or-later
// BVH files that are cut short, lie, or are something else: each gives exit code 2 and one line
// that names the file, the line and a cure; none a crash.
#include <sinew/rig/bvh/bvh.h>

#include <gtest/gtest.h>

#include <cctype>
#include <random>

#include "rig/bvh/bvh_files.h"
#include "support/scratch.h"

namespace sinew::bvh_test {

using bvh_files::replaced;

/// What reading the text says; "" where it is taken, and then gives a rig that can be used.
/// Whatever it says has the form of an error line.
std::string answer(const std::string& text) {
  try {
    const Bvh bvh = parse_bvh(text, "a.bvh");
    EXPECT_FALSE(bvh.joints.empty());
    EXPECT_EQ(bvh.values.size(), bvh.frames * bvh.channels());
    for (const double value : bvh.values) EXPECT_LE(std::abs(value), 1e9);
    return {};
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(error.exit(), Exit::bad_input) << message;
    EXPECT_EQ(message.rfind("a.bvh:", 0), 0u) << message;
    EXPECT_TRUE(std::isdigit(static_cast<unsigned char>(message[6]))) << message;
    EXPECT_NE(message.find("; "), std::string::npos) << message;
    for (const char c : message)
      EXPECT_FALSE(std::iscntrl(static_cast<unsigned char>(c))) << message;
    EXPECT_LT(message.size(), 300u) << message;
    return message;
  }
}

void expect_refused(const std::string& text, const std::string& part) {
  const std::string message = answer(text);
  EXPECT_FALSE(message.empty()) << text.substr(0, 2000);
  EXPECT_TRUE(contains(message, part)) << "no \"" << part << "\" in: " << message;
}

/// The small file, and more.
std::string followed_by(const std::string& end) {
  std::string text = bvh_files::small;
  return text.append(end);
}

/// The small file with its first `from` as `to`.
std::string with(const std::string& from, const std::string& to) {
  std::string text = bvh_files::small;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(HostileBvh, CutAtEveryWord) {
  const std::string& text = bvh_files::small;
  const std::size_t hierarchy = text.find("MOTION"), second_frame = text.find("0.5 1.5 0.25 11.0");
  int refused = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool word_begins = text[at] > ' ' && (at == 0 || text[at - 1] <= ' ');
    if (!word_begins || at == hierarchy) continue;  // there the skeleton is whole
    const bool between_frames = at >= second_frame && text[at - 1] == '\n';
    const std::string message = answer(text.substr(0, at));
    EXPECT_EQ(message.empty(), between_frames) << text.substr(0, at);
    refused += !message.empty();
  }
  EXPECT_GT(refused, 80);
}

TEST(HostileBvh, WithoutAnyOfItsWords) {
  const std::string& text = bvh_files::small;
  const std::size_t first_value = text.find("0.125\n") + 6;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] <= ' ' || (at > 0 && text[at - 1] > ' ')) continue;
    const std::size_t end = text.find_first_of(" \n", at);
    std::string shorter = text;
    shorter.erase(at, end - at);
    const bool name =
        at < first_value && (text.compare(at, 3, "hip") == 0 || text.compare(at, 4, "knee") == 0 ||
                             text.compare(at, 4, "foot") == 0);
    EXPECT_EQ(answer(shorter).empty(), name) << shorter;
  }
}

TEST(HostileBvh, CountsOfFrames) {
  expect_refused(with("Frames: 3", "Frames: 1000000000"), "a.bvh:22:9: 1000000000 frames");
  expect_refused(with("Frames: 3", "Frames: 99999999999999999999"), "range");
  expect_refused(with("Frames: 3", "Frames: 9223372036854775807"), "do not fit");
  expect_refused(with("Frames: 3", "Frames: 1"), "26 more words");
  expect_refused(with("Frames: 3", "Frames: 0"), "0 frames");
  expect_refused(with("Frames: 3", "Frames: -3"), "-3 frames");
  expect_refused(with("Frames: 3", "Frames: 3.0"), "whole number");
  expect_refused(with("Frames: 3", "Frames: 3e0"), "whole number");
  expect_refused(with("Frames: 3", "Frames: three"), "whole number");
  expect_refused(with("Frames: 3", "Frames: NaN"), "whole number");
  expect_refused(with("Frames: 3", "Frames: +-3"), "whole number");
  expect_refused(with("Frames: 3", "Frames 3"), "':'");
}

TEST(HostileBvh, FrameTimes) {
  for (const char* time : {"0", "0.0", "-0.0", "-0.1", "1e-300", "1e-999", "1e7"})
    expect_refused(with("Time: 0.125", std::string("Time: ") + time), "a.bvh:23:13: a frame time");
  expect_refused(with("Time: 0.125", "Time: nan"), "finite");
  expect_refused(with("Time: 0.125", "Time: inf"), "finite");
  expect_refused(with("Time: 0.125", "Time: 1e999"), "larger");
  expect_refused(with("Time: 0.125", "Time: 1/30"), "not a number");
  expect_refused(with("Time: 0.125", "Time: 0,125"), "decimal point");
}

TEST(HostileBvh, CountsOfValuesNameTheFrame) {
  expect_refused(with(" 14.0", ""), "a.bvh:25:1: frame 1 has 12 values");
  expect_refused(with(" 14.0", " 14.0 14.5"), "a.bvh:25:1: frame 1 has 14 values");
  expect_refused(with(" 29.0\n", "\n"), "a.bvh:26:1: frame 2 has 12 values");
  expect_refused(with(" 29.0\n", " 29.0 1\n"), "frame 2 has 14 values");
  const std::string in_columns = replaced(bvh_files::small, ".0 ", ".0\n");
  expect_refused(replaced(in_columns, "29.0\n", "\n"), "frame 2 (of 0 to 2), after 12 of its 13");
  expect_refused(replaced(in_columns, "29.0\n", "29.0\n1"), "1 more words");
  expect_refused(followed_by("# made by hand"), "more words");
}

TEST(HostileBvh, ValuesThatAreNoNumbers) {
  for (const char* value : {"nan", "NaN", "-nan", "inf", "-INF", "infinity"})
    expect_refused(with("17.0", value), "a.bvh:25:44: ");
  for (const char* value : {"1.#QNAN", "-1.#IND00", "1,5", "0x10", "1..2", "--1", "+-1", "1e", "e5",
                            "1d5", "1:2", ":", "{", "}", "abc", "\xFF\xFE", "1\x01",
                            "\xE2\x88\x92"
                            "5"})
    expect_refused(with("17.0", value), "not a number");
  for (const char* value : {"1e10", "-1e10", "1e308", "1e999", "-1e999", "99999999999"})
    expect_refused(with("17.0", value), "larger than 1e9");
}

TEST(HostileBvh, LinesAreCountedHoweverTheyEnd) {
  const std::string text = with("17.0", "nan");
  for (const char* end : {"\n", "\r\n", "\r"})
    expect_refused(replaced(text, "\n", end), "a.bvh:25:44: ");
  expect_refused("\xEF\xBB\xBF?" + text, "a.bvh:1:1: ");
}

TEST(HostileBvh, Offsets) {
  for (const char* offset :
       {"OFFSET 0.0 -0.5", "OFFSET", "OFFSET 0 nan 0", "OFFSET 0 inf 0", "OFFSET 0 -0.5 0 0",
        "OFFSET 0 1e300 0", "OFFSET a b c", "OFSET 0 0 0", "OFFSET 0 0 0 OFFSET 0 0 0", ""})
    EXPECT_NE(answer(with("OFFSET 0.0 -0.5 0.0\n", std::string(offset) + "\n")), "") << offset;
  expect_refused(with("    OFFSET 0.0 -0.5 0.0\n", ""), "'knee' has no OFFSET");
  expect_refused(with("OFFSET 0.0 1.5", "OFSET 0.0 1.5"), "did you mean OFFSET?");
}

TEST(HostileBvh, Channels) {
  for (const char* channels :
       {"CHANNELS", "CHANNELS 2", "CHANNELS 4", "CHANNELS -3", "CHANNELS 7", "CHANNELS 1e9",
        "CHANNELS 1000000000", "CHANNELS 99999999999999999999", "CHANNELS x", "CHANNELS 3.0",
        "CHANNELS 0", "CHANNELS 3 CHANNELS 3"})
    EXPECT_NE(answer(with("CHANNELS 3", channels)), "") << channels;
  expect_refused(with("Yrotation Xrotation", "Yrotation Yrotation"), "'Yrotation' twice");
  expect_refused(with("Yrotation Xrotation", "Yrotation Wrotation"), "did you mean");
  expect_refused(with("Yrotation Xrotation", "Yrotation Xscale"), "not a channel");
  expect_refused(with("    JOINT foot", "CHANNELS 0 JOINT foot"), "twice");
  const std::string late = bvh_files::arm("", "", "");
  expect_refused(late.substr(0, late.size() - 2) + "CHANNELS 1 Xrotation\n}\n", "before");
  expect_refused(bvh_files::arm("", "", "MOTION\nFrames: 1000000000\nFrame Time: 1\n"), "channels");
}

TEST(HostileBvh, Braces) {
  expect_refused(with("    }\n  }\n}\n", "    }\n  }\n"), "'MOTION' is no part of a joint");
  expect_refused(with("    }\n  }\n}\n", "    }\n  }\n}\n}\n"), "'}'");
  expect_refused(with("ROOT hip\n{", "ROOT hip\n"), "'{'");
  expect_refused(with("JOINT foot\n    {", "JOINT foot\n    {{"), "'{'");
  expect_refused(with("      {\n        OFFSET 0.0 0.0 0.25\n      }", "      OFFSET 0 0 1"),
                 "'{'");
  expect_refused(with("OFFSET 0.0 0.0 0.25\n", ""), "End Site");
  expect_refused(with("OFFSET 0.0 0.0 0.25\n", "OFFSET 0 0 1 CHANNELS 3 "), "End Site");
  expect_refused(with("End Site", "End"), "'Site'");
}

TEST(HostileBvh, WhatStandsAtTheWrongPlace) {
  expect_refused(with("JOINT knee", "ROOT knee"), "JOINT");
  expect_refused(with("ROOT hip", "JOINT hip"), "'ROOT'");
  expect_refused(with("MOTION", "JOINT arm {OFFSET 0 0 0}\nMOTION"), "'MOTION'");
  expect_refused(with("MOTION", "MOTIONS"), "'MOTION'");
  expect_refused(with("MOTION", "MOTION\nMOTION"), "'Frames'");
  expect_refused(with("Frames: 3\nFrame Time: 0.125", "Frame Time: 0.125\nFrames: 3"), "'Frames'");
  expect_refused(with("HIERARCHY\n", ""), "HIERARCHY");
  expect_refused(with("HIERARCHY", "HIERARCHY HIERARCHY"), "'ROOT'");
  expect_refused(with("  OFFSET", "  # the hip\n  OFFSET"), "'#' is no part");
  expect_refused("# made by hand\n" + bvh_files::small, "HIERARCHY");
}

TEST(HostileBvh, Names) {
  expect_refused(with("hip",
                      "h\xFC"
                      "fte"),
                 "UTF-8");
  expect_refused(with("hip", "\xC0\xAF"), "UTF-8");
  expect_refused(with("hip", "\xED\xA0\x80"), "UTF-8");
  expect_refused(with("hip", "\xF4\x90\x80\x80"), "UTF-8");
  expect_refused(with("hip", "\xE8\x85"), "UTF-8");
  expect_refused(with("hip", "h\x1b[31m"), "UTF-8");
  expect_refused(with("hip", std::string("h\0p", 3)), "UTF-8");
  expect_refused(with("hip", std::string(201, 'h')), "201 bytes");
  expect_refused(with("hip", std::string(1 << 20, 'h')), "1048576 bytes");
}

TEST(HostileBvh, OtherFiles) {
  for (const std::string text :
       {"", " \n", "\xEF\xBB\xBF", "HIERARCHY", "glTF", "{\"asset\": {}}", "ply\n",
        "\xFF\xFEH\0I\0", "%YAML", "\x89PNG\r\n\x1a\n", "0 0 0 0"})
    EXPECT_NE(answer(text), "") << text;
  EXPECT_NE(answer(std::string(1 << 16, '\0')), "");
}

/// `depth` joints in each other.
std::string nested(int depth) {
  std::string text = "HIERARCHY\n", end;
  for (int i = 0; i < depth; ++i) {
    text += i == 0 ? "ROOT a{OFFSET 0 0 1\n" : "JOINT a{OFFSET 0 0 1\n";
    end += "}";
  }
  return text + end;
}

TEST(HostileBvh, NestingHasALimitAndNoStack) {
  EXPECT_EQ(answer(nested(200)), "");
  expect_refused(nested(201), "a.bvh:202:1: more than 200 joints");
  expect_refused(nested(1000000), "more than 200 joints");
}

TEST(HostileBvh, JointsHaveALimit) {
  std::string text = "HIERARCHY\nROOT a{OFFSET 0 0 1\n";
  for (int i = 1; i < 10000; ++i) text += "JOINT a{OFFSET 0 1 0}\n";
  EXPECT_EQ(answer(text + "}"), "");
  EXPECT_EQ(rig_of(parse_bvh(text + "}", "a.bvh")).skeleton.bones[9999].name, "a_10000");
  expect_refused(text + "JOINT a{OFFSET 0 1 0}}", "more than 10000 joints");
}

TEST(HostileBvh, ARigWithoutSizeIsRefused) {
  const Bvh bvh = parse_bvh("HIERARCHY ROOT a\n{OFFSET 1 1 1}", "a.bvh");
  EXPECT_EQ(error_of([&] { rig_of(bvh); }).exit(), Exit::bad_input);
}

TEST(HostileBvh, AnyBytesAreTakenOrRefusedInOneLine) {
  std::mt19937 random(7);
  const std::string pieces[] = {
      "{",       "}",    ":",        "nan", "1e999",       "\n",          "JOINT ",
      "OFFSET ", "\xFF", "End Site", "-",   "99999999999", "CHANNELS 6 ", std::string(1, '\0')};
  for (int trial = 0; trial < 20000; ++trial) {
    std::string text = bvh_files::small;
    for (unsigned i = 0; i <= random() % 3; ++i) {
      const std::size_t at = random() % text.size();
      if (random() % 2)
        text[at] = static_cast<char>(random());
      else
        text.replace(at, random() % 4, pieces[random() % std::size(pieces)]);
    }
    try {
      if (answer(text).empty()) rig_of(parse_bvh(text, "a.bvh"));
    } catch (const Error& error) {
      EXPECT_EQ(error.exit(), Exit::bad_input);
    }
  }
}

TEST(HostileBvh, EveryHalfOfEveryFileHasOneLine) {
  const std::string& text = bvh_files::small;
  for (std::size_t i = 0; i < text.size(); ++i) {
    answer(text.substr(0, i));
    answer(text.substr(i));
  }
}

class HostileBvhFile : public Scratch {};

TEST_F(HostileBvhFile, ThatIsLargeIsRefusedBeforeItIsRead) {
  const auto path = folder / "a.bvh";
  const double memory = raised_memory([&] {
    put_sparse(path, bvh_files::small, 3'000'000'000);
    EXPECT_TRUE(contains(error_of([&] { read_bvh(path); }).what(), "is larger than"));
    put_sparse(path, "v 0 0 0\n", 200'000'000);
    EXPECT_TRUE(contains(error_of([&] { read_bvh(path); }).what(), "HIERARCHY"));
  });
  EXPECT_LT(memory, 50e6);
}

TEST_F(HostileBvhFile, FilesThatCannotBeReadAreNamed) {
  const auto path = folder / "none.bvh";
  EXPECT_TRUE(contains(error_of([&] { read_bvh(path); }).what(), path.string() + ": "));
  EXPECT_TRUE(contains(error_of([&] { read_bvh(folder); }).what(), "regular file"));
  put(path, "HIERARCHY\n");
  EXPECT_TRUE(contains(error_of([&] { read_bvh(path); }).what(), path.string() + ":2:1: "));
}

}  // namespace sinew::bvh_test
