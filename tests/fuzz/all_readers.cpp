// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets.h"

namespace sinew::fuzz {

std::vector<Target> tried_targets() {
  return {{"bvh", bvh},     {"checkpoint", checkpoint},
          {"frd", frd},     {"gltf", gltf},
          {"obj", obj},     {"off", off},
          {"play", play},   {"ply", ply},
          {"pvd", pvd},     {"record", record},
          {"scene", scene}, {"stl", stl},
          {"vtk", vtk},     {"vtu", vtu}};
}

}  // namespace sinew::fuzz
