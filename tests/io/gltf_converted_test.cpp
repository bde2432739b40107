// SPDX-License-Identifier: GPL-3.0-or-later
// Files that Blender converts, with programs in its place that do what it may do.
#include <sinew/io/gltf/converted.h>
#include <sinew/io/gltf/rig.h>

#include <cstdlib>

#include "io/gltf_rigs.h"
#include "support/expect_error.h"

namespace sinew::gltf_converted_test {

using namespace gltf_files;
using test::expect_bad_input;

class Converted : public Scratch {
 protected:
  Converted() { ::setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1); }

  /// A program that runs `job` with the input as $1, the GLB as $2, the file for reasons as $3.
  BlenderOptions blender(const std::string& job) const {
    const auto path = folder / "blender.sh";
    put(path, "#!/bin/sh\nwhile [ \"$1\" != -- ]; do shift; done; shift\n" + job + "\n");
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    return {path.string(), 60};
  }
  BlenderOptions copier() const { return blender("cp \"$1\" \"$2\""); }
  /// A GLB under a name that needs Blender.
  std::filesystem::path put_body(const std::string& name = "body.fbx") const {
    std::filesystem::create_directory(folder / "files");
    const auto path = folder / "files" / name;
    std::filesystem::rename(write(folder, bending_bar(), Form::packed), path);
    return path;
  }
};

TEST_F(Converted, OthersAreTheirOwn) {
  EXPECT_EQ(gltf_of("body.glb", blender("exit 1")), "body.glb");
  EXPECT_TRUE(needs_blender("BODY.FBX"));
  EXPECT_TRUE(needs_blender("body.dae"));
  EXPECT_FALSE(needs_blender("fbx"));
}

TEST_F(Converted, IsConvertedOnceBesideTheFile) {
  const auto path = put_body();
  const auto glb = gltf_of(path, copier());
  EXPECT_EQ(glb.parent_path(), path.parent_path());
  EXPECT_EQ(glb.string().find(path.string() + "."), 0u);
  EXPECT_EQ(gltf_of(path, blender("exit 1")), glb);
  EXPECT_EQ(read_gltf_rig(path).rig.skeleton.size(), 2u);
  put(path, text_of(path) + ' ');
  EXPECT_NE(gltf_of(path, copier()), glb);
}

TEST_F(Converted, FilesOfAnyName) {
  for (const std::string& name : {std::string("-P.fbx"), std::string("two 'words\" $(x)\n;.fbx"),
                                  std::string("\xff\xfe.DAE"), std::string(240, 'n') + ".fbx"}) {
    const auto path = put_body(name);
    const auto here = std::filesystem::current_path();
    std::filesystem::current_path(path.parent_path());
    EXPECT_EQ(text_of(gltf_of(name, copier())), text_of(name)) << name;
    std::filesystem::current_path(here);
    // A name that has no room for the hash is that of the user's cache.
    EXPECT_EQ(std::filesystem::exists(folder / "cache/sinew"), name.size() > 200);
  }
}

TEST_F(Converted, BlenderTakesThePythonOfTheSystem) {
  const auto path = put_body();
  gltf_of(path, blender("cp \"$1\" \"$2\"; echo $PATH > \"" + (folder / "path").string() + '"'));
  EXPECT_TRUE(text_of(folder / "path").starts_with("/usr/bin:"));
}

TEST_F(Converted, FailuresHaveTheirCure) {
  const auto path = put_body();
  const auto fails = [&](const BlenderOptions& options, const std::string& what,
                         const std::string& cure = "export it as GLB") {
    expect_bad_input([&] { gltf_of(path, options); }, {path.string(), what, cure});
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path.parent_path()), {}), 1);
  };
  fails({(folder / "none").string(), 60}, "Blender", "apt-get install blender python3-numpy");
  fails(blender("echo \"No module named 'numpy'\" > \"$3\"; exit 3"), "numpy", "apt-get install");
  fails(blender("echo it is text > \"$3\"; exit 3"), "Blender cannot convert it: it is text");
  fails(blender("exit 0"), "Blender cannot convert it: no reason given");
  fails(blender("kill -SEGV $$"), "Blender crashed on it, by signal 11");
  fails({blender("exec sleep 60").program, 0.2}, "not converted it in 0.2 s");
  expect_bad_input([&] { gltf_of(folder / "gone.fbx", copier()); }, {"gone.fbx"});
}

TEST_F(Converted, WhatIsConvertedIsCheckedUnderItsOwnName) {
  const auto path = put_body();
  put(path, "glTF of another kind");
  gltf_of(path, copier());
  expect_bad_input([&] { read_gltf_rig(path); }, {path.string() + ": "});
}

}  // namespace sinew::gltf_converted_test
