// SPDX-License-Identifier: GPL-3.0-or-later
// What reading a hostile glTF file must answer: exit code 2, and one line that names the file and a
// cure.
#pragma once

#include <cctype>
#include <cmath>
#include <random>

#include <sinew/io/gltf/geometry.h>

#include "io/gltf_files.h"

namespace sinew {

using namespace gltf_files;

class HostileGltf : public Scratch {
 protected:
  /// What reading the file says; "" where it is taken. Whatever is taken holds together, whatever
  /// is said has the form of an error line.
  static std::string answer(const std::filesystem::path& path) {
    testing::internal::CaptureStderr();
    std::string message;
    try {
      const PolygonSoup soup = read_gltf(path);
      for (const auto& polygon : soup.polygons)
        for (const int corner : polygon) EXPECT_TRUE(soup.points.at(corner).allFinite());
      EXPECT_FALSE(soup.polygons.empty());
    } catch (const Error& error) {
      message = error.what();
      EXPECT_EQ(error.exit(), Exit::bad_input) << message;
      EXPECT_EQ(message.rfind(path.string() + ": ", 0), 0u) << message;
      EXPECT_NE(message.find("; "), std::string::npos) << message;
      for (const char c : message)
        EXPECT_FALSE(std::iscntrl(static_cast<unsigned char>(c))) << message;
      EXPECT_LT(message.size(), 2 * path.string().size() + 300) << message;
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    return message;
  }

  void expect_refused(const std::string& name, const std::string& content,
                      const std::string& part = "") const {
    put(folder / name, content);
    const std::string message = answer(folder / name);
    EXPECT_FALSE(message.empty()) << name << '\n' << content.substr(0, 300);
    EXPECT_TRUE(contains(message, part)) << "no \"" << part << "\" in: " << message;
  }

  /// In every form.
  void expect_refused(const Gltf& gltf, const std::string& part) const {
    for (const Form form : forms) {
      const std::string message = answer(write(folder, gltf, form));
      EXPECT_FALSE(message.empty()) << part;
      EXPECT_TRUE(contains(message, part)) << "no \"" << part << "\" in: " << message;
    }
  }

  /// The tetrahedron with one value put where the JSON pointer says.
  void expect_refused_with(const std::string& pointer, const Json& value,
                           const std::string& part) const {
    Gltf gltf = one_tetrahedron();
    gltf.json[Json::json_pointer(pointer)] = value;
    expect_refused(gltf, part);
  }
};

}  // namespace sinew
