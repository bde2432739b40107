// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/loader.h>

#include <stdlib.h>
#include <vtkGLTFDocumentLoader.h>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/io/gltf/json.h>
#include <sinew/io/vtk_messages.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code failure;
    std::string name = (fs::temp_directory_path(failure) / "sinew_XXXXXX").string();
    if (failure || !::mkdtemp(name.data()))
      throw not_written(name, "the system's folder for temporary files takes none",
                        "let TMPDIR name a folder you may write to");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// VTK takes JSON from nothing but files. What it gets is not the user's file but our words for
/// what we have checked: so it and the guard cannot understand the same text differently, and it
/// opens no images or other files.
bool load(vtkGLTFDocumentLoader& loader, const GuardedGltf& gltf) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "shapes.gltf";
  write_file(file, gltf_json(gltf.document, static_cast<std::int64_t>(gltf.bytes.size())));
  return loader.LoadModelMetaDataFromFile(file.string()) && loader.LoadModelData(gltf.bytes) &&
         loader.BuildModelVTKGeometry();
}

/// VTK leaves out what it does not like, and then all later indices are others.
bool is_whole(vtkGLTFDocumentLoader& loader, const GltfDocument& document) {
  const auto model = loader.GetInternalModel();
  if (model->Nodes.size() != document.nodes.size() || model->Scenes.size() != 1 ||
      model->Accessors.size() != document.accessors.size() ||
      model->BufferViews.size() != document.views.size() ||
      model->Meshes.size() != document.meshes.size())
    return false;
  for (std::size_t i = 0; i < document.meshes.size(); ++i)
    if (model->Meshes[i].Primitives.size() != document.meshes[i].primitives.size()) return false;
  return true;
}

}  // namespace

std::shared_ptr<vtkGLTFDocumentLoader> loaded_gltf(const GuardedGltf& gltf) {
  const VtkMessages messages;
  std::shared_ptr<vtkGLTFDocumentLoader> loader(
      vtkGLTFDocumentLoader::New(), [](vtkGLTFDocumentLoader* last) { last->Delete(); });
  const bool loaded = load(*loader, gltf);
  if (!loaded || messages.failed() || !is_whole(*loader, gltf.document))
    throw bad_input("VTK cannot read it: " + messages.first_error(), "export it again");
  return loader;
}

}  // namespace sinew
