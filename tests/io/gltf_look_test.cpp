// SPDX-License-Identifier: GPL-3.0-or-later
// What glTF files say of their surfaces beside the shape, also damaged ones.
#include <sinew/io/gltf/look.h>

#include "io/gltf_files.h"

namespace sinew::gltf_look_test {

using namespace gltf_files;

const std::string png = "\x89PNG\r\n\x1a\n and so on";

class GltfLook : public Scratch {
 protected:
  GltfLook() : gltf_(one_tetrahedron()) {
    vertices_ = gltf_.json["accessors"][primitive()["attributes"]["POSITION"].get<int>()]["count"];
  }

  Json& primitive() { return gltf_.json["meshes"][0]["primitives"][0]; }

  /// Numbers 0, 1, 2, ... of so many components for each vertex.
  void attribute(const std::string& name, const std::string& type, std::size_t components) {
    std::vector<float> numbers;
    for (std::size_t i = 0; i < components * vertices_; ++i)
      numbers.push_back(static_cast<float>(i) / 64);
    primitive()["attributes"][name] =
        gltf_.accessor(gltf_.view(raw(numbers)), vertices_, type, 5126);
  }

  SurfaceLook look() {
    PolygonLook look;
    soup_ = read_gltf_look(write(folder, gltf_, Form::embedded), look);
    corners_ = look.corners;
    return look.look;
  }

  Json materials() { return Json::parse(look().gltf.json); }

  Gltf gltf_;
  std::size_t vertices_ = 0;
  PolygonSoup soup_;
  PolygonLook::Corners corners_;
};

TEST_F(GltfLook, OfBareSurfacesIsEmpty) {
  const SurfaceLook bare = look();
  EXPECT_TRUE(bare.coordinates.empty());
  EXPECT_TRUE(bare.normals.empty());
  EXPECT_TRUE(bare.layers.empty());
  EXPECT_TRUE(bare.gltf.json.empty());
  EXPECT_EQ(bare.part.size(), soup_.polygons.size());
}

TEST_F(GltfLook, CoordinatesPointUp) {
  attribute("TEXCOORD_0", "VEC2", 2);
  attribute("TEXCOORD_1", "VEC2", 2);
  attribute("COLOR_0", "VEC3", 3);
  const SurfaceLook all = look();
  ASSERT_EQ(all.coordinates.size(), soup_.points.size());
  EXPECT_EQ(all.coordinates[0], (std::array{0.0, 1 - 1 / 64.0}));
  EXPECT_EQ(corners_[0], soup_.polygons[0]);
  ASSERT_EQ(all.layers.size(), 2U);
  EXPECT_EQ(all.layers[0].name, "COLOR_0");
  EXPECT_EQ((std::vector<float>(all.layers[0].values.begin(), all.layers[0].values.begin() + 4)),
            (std::vector<float>{0, 1 / 64.F, 2 / 64.F, 1}));
  EXPECT_EQ(all.layers[1].values[1], 1 / 64.F);
}

TEST_F(GltfLook, NormalsStayUprightInNodesThatMirrorAndStretch) {
  const Vec3 across = Vec3(1, 1, 0).normalized();
  primitive()["attributes"]["NORMAL"] = gltf_.positions(Points(vertices_, across));
  gltf_.json["nodes"][0]["scale"] = {-2, 1, 1};
  const SurfaceLook stretched = look();  // normals of planes: by the inverse, transposed
  EXPECT_LT((stretched.normals.at(0) - Vec3(-0.5, 1, 0).normalized()).norm(), 1e-6);
}

TEST_F(GltfLook, AttributesOfAnotherKindAreLeftOut) {
  attribute("TEXCOORD_0", "VEC3", 3);
  attribute("NORMAL", "VEC2", 2);
  primitive()["attributes"]["COLOR_0"] = gltf_.positions(Points(vertices_ + 1, Vec3::Zero()));
  const SurfaceLook odd = look();
  EXPECT_TRUE(odd.coordinates.empty());
  EXPECT_TRUE(odd.normals.empty());
  for (const float value : odd.layers.at(0).values) EXPECT_EQ(value, 1);  // white
}

TEST_F(GltfLook, NamesNodesAndMaterials) {
  gltf_.json["nodes"][0]["name"] = "crate";
  gltf_.json["materials"] = {{{"name", "wood\n"}}, Json::object()};
  primitive()["material"] = 1;
  const SurfaceLook::Part part = look().parts.at(0);
  EXPECT_EQ(part.object, "crate");
  EXPECT_EQ(part.material, "material_1");
  EXPECT_EQ(part.gltf_material, 1);
  primitive()["material"] = 0;
  EXPECT_EQ(look().parts.at(0).material, "wood?");
  primitive()["material"] = 2;
  EXPECT_EQ(look().parts.at(0).gltf_material, -1);
}

TEST_F(GltfLook, TakesImagesFromWhereverTheyAre) {
  gltf_.json["materials"] = {Json::object()};
  put(folder / "in a file.png", png);
  gltf_.json["images"] = {{{"bufferView", gltf_.view(png)}, {"mimeType", "image/png"}},
                          {{"uri", "data:image/png;base64," + base64(png)}},
                          {{"uri", "in%20a%20file.png"}, {"name", "filed"}}};
  const SurfaceLook found = look();
  EXPECT_EQ(found.gltf.images, (std::vector<std::string>{png, png, png}));
  const Json images = Json::parse(found.gltf.json)["images"];
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(images[k]["bufferView"], k);
    EXPECT_EQ(images[k]["mimeType"], "image/png");
    EXPECT_FALSE(images[k].contains("uri"));
  }
  EXPECT_EQ(images[2]["name"], "filed");
}

TEST_F(GltfLook, KeepsTheUriOfImagesThatItCannotRead) {
  gltf_.json["materials"] = {Json::object()};
  put(folder / "text.png", "no picture");
  gltf_.json["images"] = {{{"uri", "missing.png"}},
                          {{"uri", "../secret.png"}},
                          {{"uri", "text.png"}},
                          {{"bufferView", 999}, {"mimeType", "image/png"}},
                          {{"bufferView", -1}},
                          {{"uri", 7}},
                          "no object"};
  const SurfaceLook found = look();
  EXPECT_TRUE(found.gltf.images.empty());
  const Json images = Json::parse(found.gltf.json)["images"];
  ASSERT_EQ(images.size(), 7U);
  EXPECT_EQ(images[0]["uri"], "missing.png");
  EXPECT_EQ(images[1]["uri"], "../secret.png");
  for (const std::size_t k : {3, 4}) EXPECT_FALSE(images[k].contains("bufferView"));
}

TEST_F(GltfLook, KeepsExtensionsOfMaterialsAlone) {
  gltf_.json["materials"] = {{{"extensions", {{"KHR_materials_unlit", Json::object()}}}}};
  gltf_.json["extensionsUsed"] = {"KHR_materials_unlit", "KHR_lights_punctual", 5};
  gltf_.json["textures"] = "none";
  const Json kept = materials();
  EXPECT_EQ(kept["extensionsUsed"], (Json{"KHR_materials_unlit"}));
  EXPECT_EQ(kept["materials"], gltf_.json["materials"]);
  EXPECT_FALSE(kept.contains("textures"));
  for (const Json& none : {Json(5), Json::array()}) {
    gltf_.json["materials"] = none;
    EXPECT_TRUE(look().gltf.json.empty());
  }
}

}  // namespace sinew::gltf_look_test
