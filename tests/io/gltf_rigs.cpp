// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf_rigs.h"

#include <vtkCell.h>
#include <vtkCompositeDataIterator.h>
#include <vtkGLTFDocumentLoader.h>
#include <vtkGLTFReader.h>
#include <vtkMatrix4x4.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

namespace sinew::gltf_files {
namespace {

Affine affine(vtkMatrix4x4& matrix) {
  Affine affine;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) affine.matrix()(i, j) = matrix.GetElement(i, j);
  return affine;
}

/// A node with a skin: what takes its joint matrices to the scene.
std::vector<Affine> vtk_joints(const std::filesystem::path& path, int animation, double time) {
  vtkNew<vtkGLTFDocumentLoader> loader;
  std::vector<char> buffer;
  EXPECT_TRUE(loader->LoadModelMetaDataFromFile(path.string()));
  EXPECT_TRUE(path.extension() != ".glb" || loader->LoadFileBuffer(path.string(), buffer));
  EXPECT_TRUE(loader->LoadModelData(buffer));
  EXPECT_TRUE(animation < 0 || loader->ApplyAnimation(static_cast<float>(time), animation));
  loader->BuildGlobalTransforms();
  auto& model = *loader->GetInternalModel();
  for (auto& node : model.Nodes)
    if (node.Skin == 0) {
      std::vector<vtkSmartPointer<vtkMatrix4x4>> matrices;
      vtkGLTFDocumentLoader::ComputeJointMatrices(model, model.Skins[0], node, matrices);
      std::vector<Affine> joints;
      for (const auto& matrix : matrices)
        joints.push_back(affine(*node.GlobalTransform) * affine(*matrix));
      return joints;
    }
  ADD_FAILURE() << "no node has skin 0";
  return {};
}

}  // namespace

Points vtk_corners(const std::filesystem::path& path, int animation, double time) {
  vtkNew<vtkGLTFReader> reader;
  reader->SetFileName(path.c_str());
  reader->SetFrameRate(60);
  reader->UpdateInformation();
  if (animation >= 0) reader->EnableAnimation(animation);
  reader->UpdateTimeStep(time);
  const auto blocks = vtk::TakeSmartPointer(reader->GetOutput()->NewIterator());
  Points corners;
  for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem()) {
    vtkPolyData& shape = *vtkPolyData::SafeDownCast(blocks->GetCurrentDataObject());
    for (vtkIdType i = 0; i < shape.GetNumberOfCells(); ++i)
      for (vtkIdType k = 0; k < 3; ++k)
        corners.emplace_back(shape.GetPoint(shape.GetCell(i)->GetPointId(static_cast<int>(k))));
  }
  return corners;
}

VtkPose vtk_pose(const std::filesystem::path& path, int animation, double time) {
  return {vtk_joints(path, animation, time), vtk_corners(path, animation, time)};
}

Points skinned_corners(const SkinnedRig& rig, const Pose& pose) {
  Points points;
  for (std::size_t i = 0; i < rig.mesh.points.size(); ++i) {
    Vec3 point = Vec3::Zero();
    for (const BoneWeight& weight : rig.weights.of(i)) {
      const auto bone = static_cast<std::size_t>(weight.bone);
      point += weight.weight *
               carried(rig.mesh.points[i], rig.rig.skeleton.bones[bone].rest, pose[bone].frame);
    }
    points.push_back(point);
  }
  Points corners;
  for (const auto& polygon : rig.mesh.polygons)
    for (const int corner : polygon) corners.push_back(points[static_cast<std::size_t>(corner)]);
  return corners;
}

}  // namespace sinew::gltf_files
