// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are not ours, cut short or damaged give an error or a dataset: never a crash, never a
// word on the console.
#include <random>

#include <sinew/io/vtu.h>
#include "support/scratch.h"
#include "synthetic_run.h"

namespace sinew::vtu_hostile_test {

class HostileVtu : public Scratch {
 protected:
  /// The error that reading `text` gives, or "" when it is accepted.
  std::string message(const std::string& text) const {
    put(folder / "f.vtu", text);
    testing::internal::CaptureStderr();
    std::string message;
    try {
      const Dataset data = read_vtu(folder / "f.vtu");
      for (const std::int32_t id : data.connectivity)
        EXPECT_LT(static_cast<std::size_t>(id), data.points.size());
    } catch (const Error& error) {
      message = error.what();
      EXPECT_EQ(error.exit(), Exit::bad_input);
      EXPECT_TRUE(contains(message, "f.vtu: ")) << message;
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    return message;
  }

  std::string ours(Encoding encoding) const {
    write_vtu(folder / "ours.vtu", SyntheticRun().surface({}), {encoding, false, "surface", 0.01});
    return text_of(folder / "ours.vtu");
  }
};

/// A file as other programs write them: one piece, everything in plain text.
std::string foreign(const std::string& ids, const std::string& ends, int type,
                    const std::string& point_data = "", const std::string& points = "3") {
  return R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints=")" +
         points + R"(" NumberOfCells="1"><PointData>)" + point_data +
         R"(</PointData><Points>
<DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">)" +
         ids + R"(</DataArray><DataArray type="Int64" Name="offsets" format="ascii">)" + ends +
         R"(</DataArray><DataArray type="UInt8" Name="types" format="ascii">)" +
         std::to_string(type) + R"(</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>)";
}

TEST_F(HostileVtu, ForeignFilesOfOurKindsAreRead) {
  EXPECT_EQ(message(foreign("0 1 2", "3", 5)), "");
  EXPECT_EQ(message(foreign("0 1", "2", 3)), "");
  EXPECT_EQ(message(foreign("2", "1", 1)), "");
}

TEST_F(HostileVtu, WideIntegersBecomeNumbersWhereInt32CannotHoldThem) {
  put(folder / "f.vtu",
      foreign("0 1 2", "3", 5,
              R"(<DataArray type="Int64" Name="wide" format="ascii">1 2 5000000000</DataArray>
                 <DataArray type="Int64" Name="narrow" format="ascii">1 2 3</DataArray>)"));
  const Dataset data = read_vtu(folder / "f.vtu");
  EXPECT_EQ(numbers(data.point_columns, "wide"), (std::vector<double>{1, 2, 5e9}));
  EXPECT_EQ(integers(data.point_columns, "narrow"), (std::vector<std::int32_t>{1, 2, 3}));
}

TEST_F(HostileVtu, CellsThatAreNotOursAreRefused) {
  EXPECT_TRUE(contains(message(foreign("0 1 2", "3", 7)), "type 7"));
  EXPECT_NE(message(foreign("0 1 2", "3", 1)), "");
  EXPECT_NE(message(foreign("0 1 3", "3", 5)), "");
  EXPECT_NE(message(foreign("0 1 -1", "3", 5)), "");
  EXPECT_NE(message(foreign("0 1 2", "99", 5)), "");
  EXPECT_NE(message(foreign("0 1 2", "-3", 5)), "");
  EXPECT_NE(message(foreign("0 1", "3", 5)), "");
}

TEST_F(HostileVtu, ArraysThatAreNotNumericAreRefused) {
  EXPECT_TRUE(
      contains(message(foreign(
                   "0 1 2", "3", 5,
                   R"(<Array type="String" Name="label" format="ascii">97 0 98 0 99 0</Array>)")),
               "label"));
}

TEST_F(HostileVtu, CountsBeyondTheFilesSizeAreRefused) {
  EXPECT_TRUE(contains(message(foreign("0 1 2", "3", 5, "", "99999999999999")), "NumberOfPoints"));
  EXPECT_TRUE(contains(message(foreign("0 1 2", "3", 5, "", "-1")), "NumberOfPoints"));
  EXPECT_NE(message(foreign("0 1 2", "3", 5, "", "4")), "");
}

TEST_F(HostileVtu, OtherFilesAreRefused) {
  EXPECT_TRUE(contains(message(""), "not a VTK XML file"));
  EXPECT_TRUE(contains(message(std::string(5000, '\0')), "not a VTK XML file"));
  EXPECT_TRUE(contains(message("v 0 0 0\n"), "not a VTK XML file"));
  EXPECT_TRUE(contains(message("<VTKFile type=\"PolyData\"></VTKFile>"), "PolyData"));
  EXPECT_NE(message("<VTKFile type=\"UnstructuredGrid\">"), "");
  EXPECT_NE(message("<VTKFile type=\"UnstructuredGrid\"></VTKFile>"), "");
}

TEST_F(HostileVtu, MissingFilesAndFoldersAreNamed) {
  for (const char* name : {"absent.vtu", "."}) {
    const Error error = error_of([&] { read_vtu(folder / name); });
    EXPECT_EQ(error.exit(), Exit::bad_input);
    EXPECT_TRUE(contains(error.what(), name)) << error.what();
  }
}

TEST_F(HostileVtu, EntitiesThatGrowWithoutEndAreRefused) {
  std::string text = "<?xml version=\"1.0\"?><!DOCTYPE VTKFile [<!ENTITY a0 \"xxxxxxxxxx\">";
  for (int i = 1; i < 30; ++i) {
    const std::string inner = "&a" + std::to_string(i - 1) + ';';
    text += "<!ENTITY a" + std::to_string(i) + " \"" + inner + inner + inner + "\">";
  }
  EXPECT_NE(message(text + "]><VTKFile type=\"UnstructuredGrid\">&a29;</VTKFile>"), "");
}

class DamagedVtu : public HostileVtu, public testing::WithParamInterface<Encoding> {};

TEST_P(DamagedVtu, CutAnywhereIsRefused) {
  const std::string whole = ours(GetParam());
  for (std::size_t k = 0; k < 200; ++k)
    EXPECT_NE(message(whole.substr(0, k * (whole.size() - 12) / 199)), "") << k;
}

/// Where the block of an array begins, with the counts that VTK believes.
std::vector<std::size_t> blocks_of(const std::string& text) {
  std::vector<std::size_t> blocks;
  const std::size_t appended = text.find("<AppendedData");
  if (appended == text.npos) {  // each within its element
    for (auto at = text.find("<DataArray"); at < text.size(); at = text.find("<DataArray", at + 1))
      blocks.push_back(text.find_first_not_of(" \n", text.find('>', at) + 1));
    return blocks;
  }
  const std::size_t data = text.find('_', appended) + 1;
  for (auto at = text.find("offset=\""); at < data; at = text.find("offset=\"", at + 1))
    blocks.push_back(data + std::stoul(text.substr(at + 8)));
  return blocks;
}

TEST_P(DamagedVtu, WithWrongBytesDoesNotCrash) {
  const std::string whole = ours(GetParam());
  const std::vector<std::size_t> blocks = blocks_of(whole);
  const std::size_t header = std::min(whole.find("<AppendedData"), whole.size());
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    std::string text = whole;
    for (int k = 0; k < 1 + round % 4; ++k) {
      const std::size_t places[4] = {random() % header, random() % text.size(),
                                     blocks[random() % blocks.size()] + random() % 40,
                                     blocks[random() % blocks.size()] + random() % 40};
      const char base64[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=";
      text[places[random() % 4]] =
          round % 2 ? static_cast<char>(random() % 256) : base64[random() % 65];
    }
    message(text);
  }
}

INSTANTIATE_TEST_SUITE_P(All, DamagedVtu,
                         testing::Values(Encoding::zlib, Encoding::lz4, Encoding::raw,
                                         Encoding::none));

}  // namespace sinew::vtu_hostile_test
