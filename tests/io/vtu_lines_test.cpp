// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/vtu_lines.h>

#include <cstring>
#include <random>

#include <sinew/core/parallel.h>
#include <sinew/io/decode.h>
#include <sinew/io/encode.h>
#include <sinew/io/vtu.h>
#include "scratch.h"
#include "synthetic_run.h"

namespace sinew {
namespace {

constexpr Encoding in_elements[] = {Encoding::zlib, Encoding::lz4, Encoding::none};

std::string noise(std::size_t count) {
  std::mt19937 random(static_cast<unsigned>(count));
  std::string bytes(count, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random() % 7);
  return bytes;
}

TEST(FromBase64, TakesBackWhatBase64Makes) {
  for (const std::size_t count : {0, 1, 2, 3, 4, 5, 100, 1'000'003}) {
    const std::string bytes = noise(count);
    std::string back(count, 'x');
    auto* to = reinterpret_cast<unsigned char*>(back.data());
    for (const int threads : {1, 3})
      with_threads(threads, [&] { EXPECT_TRUE(from_base64(base64(bytes), count, to)); });
    EXPECT_EQ(back, bytes);
    EXPECT_FALSE(from_base64(base64(bytes) + "AAAA", count, to));
  }
}

TEST(FromBase64, RefusesWhatIsNone) {
  unsigned char to[6];
  EXPECT_TRUE(from_base64("Zm9vYg==", 4, to));
  for (const char* text : {"Zm9vYg=A", "Zm9vYgA=", "Zm9vY===", "Zm9 Yg==", "=m9vYg==", "Zm9vYg"})
    EXPECT_FALSE(from_base64(text, 4, to)) << text;
}

TEST(ElementBytes, AreThoseThatWereEncoded) {
  for (const Encoding encoding : in_elements)
    for (const std::size_t count : {0, 1, 32767, 32768, 32769, 1'000'000}) {
      const std::string bytes = noise(count);
      const auto back = element_bytes(element_text(bytes_array(bytes), encoding), encoding, count);
      ASSERT_TRUE(back) << count;
      EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), back->begin(), back->end(),
                             [](char a, unsigned char b) { return a == static_cast<char>(b); }));
    }
}

TEST(ElementBytes, AreNoneOfAnotherCountOrCoding) {
  const std::string bytes = noise(40000);
  for (const Encoding encoding : in_elements) {
    const std::string text = element_text(bytes_array(bytes), encoding);
    for (const std::uint64_t count :
         {std::uint64_t{0}, std::uint64_t{39999}, std::uint64_t{40001}, std::uint64_t{1} << 40})
      EXPECT_FALSE(element_bytes(text, encoding, count)) << count;
    for (const Encoding other : in_elements)
      EXPECT_EQ(element_bytes(text, other, bytes.size()).has_value(), other == encoding);
  }
}

TEST(ElementBytes, OfDamagedTextAreNeverTakenForOthers) {  // zlib ends in a checksum of each block
  const std::string bytes = noise(40000);
  const std::string sound = element_text(bytes_array(bytes), Encoding::zlib);
  for (std::size_t at = 0; at < sound.size(); at += 97) {
    std::string text = sound;
    text[at] = text[at] == 'A' ? 'B' : 'A';
    const auto back = element_bytes(text, Encoding::zlib, bytes.size());
    EXPECT_TRUE(!back || std::memcmp(back->data(), bytes.data(), bytes.size()) == 0) << at;
  }
}

void expect_equal(const std::vector<Column>& one, const std::vector<Column>& other) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].name, other[i].name);
    EXPECT_EQ(one[i].components, other[i].components) << one[i].name;
    EXPECT_EQ(one[i].values, other[i].values) << one[i].name;
  }
}

void expect_equal(const Dataset& one, const Dataset& other) {
  EXPECT_EQ(one.time, other.time);
  EXPECT_EQ(one.cycle, other.cycle);
  EXPECT_EQ(one.meta, other.meta);
  EXPECT_EQ(one.kind, other.kind);
  EXPECT_EQ(one.points, other.points);
  EXPECT_EQ(one.connectivity, other.connectivity);
  expect_equal(one.point_columns, other.point_columns);
  expect_equal(one.cell_columns, other.cell_columns);
  expect_equal(one.field_columns, other.field_columns);
}

class VtuLines : public Scratch {
 protected:
  /// The same file for a reader that knows all of XML, but none that we would have written.
  std::filesystem::path made_foreign(const std::filesystem::path& path) const {
    const std::string text = text_of(path), mark = "<UnstructuredGrid>";
    const auto at = text.find(mark);
    put(folder / "foreign.vtu", text.substr(0, at) + "\n" + text.substr(at));
    return folder / "foreign.vtu";
  }

  bool serves(const std::string& text) const {
    put(folder / "f.vtu", text);
    return read_vtu_lines(folder / "f.vtu", std::nullopt).has_value();
  }

  std::string ours() const {
    write_vtu(folder / "ours.vtu", SyntheticRun().surface({}),
              {Encoding::zlib, false, "surface", 0.01});
    return text_of(folder / "ours.vtu");
  }
};

TEST_F(VtuLines, HoldWhatVtkFindsInThem) {
  const SyntheticRun run;
  const Moment moment{1.0 / 3, 123};
  std::map<std::string, Dataset> all = {{"particles", run.particles(moment)},
                                        {"surface", run.surface(moment)},
                                        {"bones", run.bones(moment)},
                                        {"frames", run.frames(moment)},
                                        {"empty", Dataset()}};
  all["surface"].meta = "{\"name\": \"\u00c4rm\"}";
  for (const auto& [series, data] : all)
    for (const Encoding encoding : in_elements)
      for (const bool double_precision : {false, true}) {
        const auto file = folder / "f.vtu";
        write_vtu(file, data, {encoding, double_precision, series, 0.01});
        const auto read = read_vtu_lines(file, std::nullopt);
        ASSERT_TRUE(read) << series;
        ASSERT_FALSE(read_vtu_lines(made_foreign(file), std::nullopt));
        expect_equal(*read, read_vtu(folder / "foreign.vtu"));
      }
}

TEST_F(VtuLines, HoldOnlyTheNamedArraysOfThePoints) {
  write_vtu(folder / "f.vtu", SyntheticRun().particles({}),
            {Encoding::zlib, false, "particles", 0.01});
  const auto read = read_vtu_lines(folder / "f.vtu", {{"velocity", "absent"}});
  ASSERT_TRUE(read);
  ASSERT_EQ(read->point_columns.size(), 1u);
  EXPECT_EQ(read->point_columns[0].name, "velocity");
  expect_equal(*read, read_vtu(made_foreign(folder / "f.vtu"), {"velocity", "absent"}));
}

TEST_F(VtuLines, LeaveOtherFilesToVtk) {
  const std::string text = ours();
  EXPECT_TRUE(serves(text));
  for (std::size_t size = 0; size < text.size(); size += 1 + size / 20)
    EXPECT_FALSE(serves(text.substr(0, size))) << size;
  write_vtu(folder / "f.vtu", SyntheticRun().surface({}), {Encoding::raw, false, "surface", 0.01});
  EXPECT_FALSE(read_vtu_lines(folder / "f.vtu", std::nullopt));
  Dataset mixed = SyntheticRun().surface({});
  mixed.lines = {0, 1};
  for (Column& column : mixed.cell_columns)
    column.values = std::vector<std::int32_t>(mixed.cells());
  write_vtu(folder / "f.vtu", mixed, {Encoding::zlib, false, "", 0.01});
  EXPECT_FALSE(read_vtu_lines(folder / "f.vtu", std::nullopt));
  for (const std::int32_t far : {-1, 1 << 20}) {
    Dataset beyond = SyntheticRun().surface({});
    beyond.connectivity.back() = far;
    write_vtu(folder / "f.vtu", beyond, {Encoding::lz4, false, "surface", 0.01});
    EXPECT_FALSE(read_vtu_lines(folder / "f.vtu", std::nullopt));
  }
  EXPECT_FALSE(read_vtu_lines(folder, std::nullopt));
  EXPECT_FALSE(read_vtu_lines(folder / "none.vtu", std::nullopt));
  for (const auto& [old, other] : std::map<std::string, std::string>{
           {"NumberOfPoints=\"", "NumberOfPoints=\"9"},
           {"NumberOfCells=\"", "NumberOfCells=\"9999999999999"},
           {"Name=\"offsets\"", "Name=\"ofsets\""},
           {"type=\"Float32\"", "type=\"Float64\""},
           {"NumberOfComponents=\"3\"", "NumberOfComponents=\"18446744073709551615\""},
           {"<FieldData>", "<FieldData><a>"},
           {"<Cells>", "<Cellss>"},
           {"format=\"binary\"", "format=\"ascii\""},
           {"Name=\"displacement\"", "Name=\"a&amp;b\""}}) {
    std::string changed = text;
    const auto at = changed.find(old);
    ASSERT_NE(at, changed.npos) << old;
    EXPECT_FALSE(serves(changed.replace(at, old.size(), other))) << old;
  }
}

}  // namespace
}  // namespace sinew
