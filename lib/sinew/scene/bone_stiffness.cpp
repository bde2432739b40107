// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/bone_stiffness.h>

#include <cmath>

#include <sinew/core/particles.h>

namespace sinew {

std::vector<BoneStiffness> stiffness_along_bones(const Body& body) {
  const Material& material = body.material;
  std::vector<BoneStiffness> all;
  for (std::size_t b = 0; b < body.skeleton.size(); ++b) {
    const Bone& bone = body.skeleton.bones[b];
    const double planes =
        std::sqrt(body.binding.cross_section[b]) / half_plane_spacing(material.pair.r);
    if (!(planes > 0)) continue;
    const Vec3 along = body.lattice.transpose() * bone.rest.rotation.col(0);
    all.push_back({bone.name, material.constants().young_modulus(along), planes,
                   lack_of_bending_stiffness(planes, material.bond.second > 0)});
  }
  return all;
}

}  // namespace sinew
