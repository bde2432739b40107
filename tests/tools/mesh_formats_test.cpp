// SPDX-License-Identifier: GPL-3.0-or-later
// What the settings' help says of mesh formats is what is read.
#include <gtest/gtest.h>

#include <algorithm>

#include <sinew/scene/body_mesh.h>
#include <sinew/settings/table.h>

namespace sinew::mesh_formats_test {

TEST(MeshFormats, AreThoseThatTheSettingsHelpLists) {
  const auto table = settings_table();
  const auto mesh = std::find_if(table.begin(), table.end(), [](const Field<Settings>& field) {
    return field.section == "body" && field.name == "mesh";
  });
  ASSERT_NE(mesh, table.end());
  EXPECT_EQ(mesh->help, "path of the mesh (" + mesh_formats() + "), relative to the scene file");
}

}  // namespace sinew::mesh_formats_test
