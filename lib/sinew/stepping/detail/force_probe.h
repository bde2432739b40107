// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel's forces in newtons and in the caller's order, piece by piece: no array of all of them
// in the kernel's own order is made.
//
//     resize(forces, layout.size(), false);
//     ForceProbe<Real>(work, job, layout, newtons, false, {})(0, pieces, forces);
#pragma once

#include <cstddef>
#include <functional>

#include <sinew/body/forces.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/particle_layout.h>

namespace sinew {

template <class Real>
class ForceProbe {
 public:
  /// On pieces, with what surrounds the body.
  using Work = std::function<void(const kernel::Step<Real>&, std::size_t, std::size_t)>;
  /// `newtons`: the kernel's unit of force, N; `of_world`: of each particle in the kernel's order,
  /// N, filled by `job` as it reaches them, or none. All must outlive the probe.
  ForceProbe(Work work, const kernel::Step<Real>& job, const ParticleLayout<Real>& layout,
             double newtons, bool muscles, const Points& of_world);

  /// Fills the forces on the pieces [first, last); called from several threads.
  void operator()(std::size_t first, std::size_t last, Forces& forces) const;

 private:
  Work work_;
  const kernel::Step<Real>& job_;
  const ParticleLayout<Real>& layout_;
  double newtons_;
  bool muscles_;
  const Points& of_world_;
};

/// Makes room for the forces on `count` particles; those of a world are zero.
void resize(Forces& forces, std::size_t count, bool with_world);

}  // namespace sinew
