// SPDX-License-Identifier: GPL-3.0-or-later
// The volumes that particles keep (bonded_volume), by the formulas of body/solid.h: each rank
// finds J and the thrust of its own particles, ghosts are sent theirs, and each particle sums.
#include <sinew/lammps/pair_sinew.h>

#include <algorithm>
#include <utility>

#include <sinew/body/solid.h>

namespace sinew {
namespace {

/// Row by row the cross products of the others.
Mat3 cofactors_of(const Mat3& F) {
  Mat3 cofactors;
  for (int row = 0; row < 3; ++row)
    cofactors.row(row) = F.row((row + 1) % 3).cross(F.row((row + 2) % 3));
  return cofactors;
}

/// LAMMPS has named this differently since 2022.
template <class Comm>
void send_to_ghosts(Comm* comm, LAMMPS_NS::Pair* pair) {
  if constexpr (requires { comm->forward_comm_pair(pair); })
    comm->forward_comm_pair(pair);
  else
    comm->forward_comm(pair);
}

}  // namespace

/// Calls visit(i, j) for the nearest neighbors at rest of all own particles.
template <class Visit>
void PairSinew::for_each_nearest(Visit&& visit) const {
  const int* partners = partners_.data();
  for (int i = 0; i < atom->nlocal; ++i) {
    const ParticleRow row = body_->row(i);
    for (int k = 0; k < row.nearest(); ++k) visit(static_cast<std::size_t>(i), partners[k]);
    partners += row.bonds();
  }
}

void PairSinew::send(Sent what) {
  sent_ = what;
  send_to_ghosts(comm, this);
}

/// What is constant of the particles that are here, until the lists are made again.
void PairSinew::find_rest_shapes() {
  const auto own = static_cast<std::size_t>(atom->nlocal);
  rest_.assign(own + static_cast<std::size_t>(atom->nghost), Vec3::Zero());
  for (int i = 0; i < atom->nlocal; ++i) rest_[static_cast<std::size_t>(i)] = body_->row(i).rest();
  send(Sent::rest);
  inverse_.assign(own, Mat3::Zero());
  for_each_nearest([&](std::size_t i, int j) {
    const Vec3 apart = rest_[static_cast<std::size_t>(j)] - rest_[i];
    inverse_[i] += apart * apart.transpose();
  });
  weight_.resize(own);
  for (std::size_t i = 0; i < own; ++i) {
    weight_[i] = body_->row(static_cast<int>(i)).volume_weight();
    inverse_[i] = weight_[i] > 0 ? Mat3(inverse_[i].inverse()) : Mat3(Mat3::Zero());
  }
}

void PairSinew::find_thrusts() {
  const Material& material = body_->setup.material;
  const double stiffness = material.volume_stiffness * volume_per_particle(material.pair.r);
  thrust_.assign(rest_.size(), Mat3::Zero());
  for_each_nearest([&](std::size_t i, int j) {
    thrust_[i] += (position(j) - position(static_cast<int>(i))) *
                  (rest_[static_cast<std::size_t>(j)] - rest_[i]).transpose();
  });
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    const Mat3 F = thrust_[i] * inverse_[i], cofactors = cofactors_of(F);
    const double growth = F.row(0).dot(cofactors.row(0)) - 1;
    thrust_[i] = stiffness * weight_[i] * growth * (cofactors * inverse_[i]);
  }
  send(Sent::thrust);
}

void PairSinew::add_volume_forces() {
  if (body_->setup.material.volume_stiffness <= 0 || !law_->has_bonds) return;
  if (neighbor->ago == 0) find_rest_shapes();
  find_thrusts();
  for_each_nearest([&](std::size_t i, int j) {
    const auto other = static_cast<std::size_t>(j);
    body_->pair[i] += (thrust_[i] + thrust_[other]) * (rest_[other] - rest_[i]);
  });
}

int PairSinew::pack_forward_comm(int count, int* which, double* to, int, int*) {
  const double* begin = to;
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(which[k]);
    if (sent_ == Sent::counts) *to++ = body_->neighbors[i];
    if (sent_ == Sent::rest) to = std::copy_n(rest_[i].data(), 3, to);
    if (sent_ == Sent::thrust) to = std::copy_n(thrust_[i].data(), 9, to);
  }
  return static_cast<int>(to - begin);
}

void PairSinew::unpack_forward_comm(int count, int first, double* from) {
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(first + k);
    if (sent_ == Sent::counts) body_->neighbors[i] = *from++;
    if (sent_ == Sent::rest) rest_[i] = Eigen::Map<const Vec3>(std::exchange(from, from + 3));
    if (sent_ == Sent::thrust) thrust_[i] = Eigen::Map<const Mat3>(std::exchange(from, from + 9));
  }
}

}  // namespace sinew
