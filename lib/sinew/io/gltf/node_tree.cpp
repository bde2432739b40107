// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/node_tree.h>

#include <Eigen/SVD>

namespace sinew {
namespace {

std::vector<int> parents_of(const GltfDocument& document) {
  std::vector<int> parents(document.nodes.size(), -1);
  for (std::size_t i = 0; i < document.nodes.size(); ++i)
    for (const int child : document.nodes[i].children)
      parents[static_cast<std::size_t>(child)] = static_cast<int>(i);
  return parents;
}

/// Without recursion; children in the file's order.
std::vector<int> depth_first(const GltfDocument& document, const std::vector<int>& parents) {
  std::vector<int> order, waiting;
  for (std::size_t i = parents.size(); i-- > 0;)
    if (parents[i] < 0) waiting.push_back(static_cast<int>(i));
  while (!waiting.empty()) {
    order.push_back(waiting.back());
    waiting.pop_back();
    const auto& children = document.nodes[static_cast<std::size_t>(order.back())].children;
    waiting.insert(waiting.end(), children.rbegin(), children.rend());
  }
  return order;
}

}  // namespace

GltfTree gltf_tree(const GltfDocument& document) {
  GltfTree tree{parents_of(document), {}};
  tree.order = depth_first(document, tree.parents);
  return tree;
}

Affine GltfPlace::affine() const {
  Affine affine = Affine::Identity();
  affine.translation() = translation;
  affine.linear() = whole ? linear : Mat3(rotation.toRotationMatrix() * scale.asDiagonal());
  return affine;
}

GltfPlace place_of(const GltfNode& node) {
  GltfPlace place;
  if (const auto& t = node.translation; !t.empty()) place.translation = Vec3(t.data());
  if (const auto& q = node.rotation; !q.empty()) place.rotation = Quat(q[3], q[0], q[1], q[2]);
  if (const auto& s = node.scale; !s.empty()) place.scale = Vec3(s.data());
  if (!node.matrix.empty()) {
    const Eigen::Map<const Eigen::Matrix4d> matrix(node.matrix.data());
    place.translation = matrix.col(3).head<3>();
    place.linear = matrix.topLeftCorner<3, 3>();
    place.whole = true;
  }
  return place;
}

std::vector<Affine> global_places(const GltfTree& tree, const std::vector<Affine>& local) {
  std::vector<Affine> global(local.size());
  for (const int node : tree.order) {
    const auto at = static_cast<std::size_t>(node);
    const int parent = tree.parents[at];
    global[at] = parent < 0 ? local[at] : global[static_cast<std::size_t>(parent)] * local[at];
  }
  return global;
}

double even_scale(const Mat3& matrix, double tolerance) {
  if (!matrix.allFinite() || !(matrix.determinant() > 0)) return 0;
  const Vec3 scales = Eigen::JacobiSVD<Mat3>(matrix).singularValues();  // the largest first
  return scales[2] >= (1 - tolerance) * scales[0] ? std::cbrt(scales.prod()) : 0;
}

Mat3 nearest_rotation(const Mat3& matrix) {
  const Eigen::JacobiSVD<Mat3> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Mat3 rotation = svd.matrixU() * svd.matrixV().transpose();
  return rotation.determinant() < 0 ? Mat3(-rotation) : rotation;
}

}  // namespace sinew
