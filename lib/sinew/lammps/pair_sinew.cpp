// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lammps/pair_sinew.h>

#include <algorithm>
#include <cmath>

namespace sinew {

PairSinew::PairSinew(LAMMPS_NS::LAMMPS* lammps) : Pair(lammps) {
  single_enable = 0;
  restartinfo = 0;
  one_coeff = 1;
  no_virial_fdotr_compute = 1;
  comm_forward = 9;  // at most: a thrust
}

PairSinew::~PairSinew() {
  if (allocated == 0) return;
  memory->destroy(setflag);
  memory->destroy(cutsq);
}

void PairSinew::attach(LocalBody& body) {
  const Material& material = body.setup.material;
  body_ = &body;
  law_ = &law_of(material);
  range_ = law_->has_bonds ? 2 * material.pair.r : material.pair.b;
}

void PairSinew::coeff(int, char**) {
  if (allocated == 0) {
    memory->create(setflag, 2, 2, "pair:setflag");
    memory->create(cutsq, 2, 2, "pair:cutsq");
    allocated = 1;
  }
  setflag[1][1] = 1;
}

double PairSinew::init_one(int, int) { return range_; }

/// All pairs in range that are not bonded.
template <class Visit>
void PairSinew::for_each_pair(Visit&& visit) const {
  const Material& material = body_->setup.material;
  const double contact = 2 * material.pair.r, squared_range = range_ * range_;
  for (int n = 0; n < list->inum; ++n) {
    const int i = list->ilist[n];
    const Vec3 here = position(i);
    for (int k = 0; k < list->numneigh[i]; ++k) {
      const int j = list->firstneigh[i][k] & NEIGHMASK;
      const Vec3 offset = here - position(j);
      const double squared = offset.squaredNorm();
      if (squared >= squared_range) continue;
      const double d = std::sqrt(squared);
      double push = 0;
      if (!law_->has_memory) {
        push = material.pair.force(d);
      } else if (body_->row(i).is_nearest(id_of(atom->tag[j]))) {
        if (law_->has_bonds) continue;
        push = law_->bond_force(material, {}, d);
      } else {
        if (d >= contact) continue;
        push = law_->force(material, d);
      }
      visit(Meeting{i, j, offset, d, push, j < atom->nlocal, true});
    }
  }
}

/// Visits bonds from both sides: each of the two does it for itself.
template <class Visit>
void PairSinew::for_each_bond(Visit&& visit) const {
  if (!law_->has_bonds) return;
  const Material& material = body_->setup.material;
  const int* partner = partners_.data();
  for (int i = 0; i < atom->nlocal; ++i) {
    const ParticleRow row = body_->row(i);
    const Vec3 here = position(i);
    for (int k = 0; k < row.bonds(); ++k) {
      const int j = *partner++;
      const Vec3 offset = here - position(j);
      const double d = offset.norm();
      visit(Meeting{i, j, offset, d, law_->bond_force(material, row.bond(k).spring, d), false,
                    k < row.nearest()});
    }
  }
}

template <class Visit>
void PairSinew::for_each_meeting(Visit&& visit) const {
  for_each_pair(visit);
  for_each_bond(visit);
}

/// Where the partners of bonds are, until the lists are made again.
void PairSinew::find_partners() {
  partners_.clear();
  if (!law_->has_bonds) return;
  for (int i = 0; i < atom->nlocal; ++i) {
    const ParticleRow row = body_->row(i);
    for (int k = 0; k < row.bonds(); ++k) {
      const int j = atom->map(tag_of(row.bond(k).partner));
      if (j < 0) error->one(FLERR, std::string("a bond reaches beyond the ghosts of a rank"));
      partners_.push_back(j);
    }
  }
}

void PairSinew::compute(int energies, int virials) {
  ev_init(energies, virials);
  if (neighbor->ago == 0) find_partners();
  const auto own = static_cast<std::size_t>(atom->nlocal);
  Points velocities(own, Vec3::Zero());
  body_->pair.assign(own, Vec3::Zero());
  body_->damping.assign(own, Vec3::Zero());
  body_->neighbors.assign(own + static_cast<std::size_t>(atom->nghost), 0);
  const auto meet = [&](int i, int j, const Vec3& push, bool partners) {
    const auto at = static_cast<std::size_t>(i);
    body_->pair[at] += push;
    if (!partners) return;
    velocities[at] += velocity(j);
    body_->neighbors[at] += 1;
  };
  double longest = 0;
  for_each_meeting([&](const Meeting& pair) {
    const Vec3 push = pair.force * direction(pair);
    meet(pair.i, pair.j, push, pair.partners);
    if (pair.of_both) meet(pair.j, pair.i, -push, pair.partners);
    longest = std::max(longest, pair.d);
  });
  body_->longest_bond = longest;
  add_volume_forces();
  if (body_->setup.material.damping > 0) {
    if (body_->setup.material.damping_form == DampingForm::paper)
      mean_damping(velocities);
    else
      pairwise_damping();
  }
  for (int i = 0; i < atom->nlocal; ++i)
    Eigen::Map<Vec3>(atom->f[i]) +=
        body_->pair[static_cast<std::size_t>(i)] + body_->damping[static_cast<std::size_t>(i)];
}

/// Eq. 2: towards the partners' mean velocity.
void PairSinew::mean_damping(const Points& velocities) {
  for (std::size_t i = 0; i < velocities.size(); ++i)
    if (body_->neighbors[i] > 0)
      body_->damping[i] = -body_->setup.material.damping *
                          (velocity(static_cast<int>(i)) - velocities[i] / body_->neighbors[i]);
}

/// With the mean of both counts, and central: only along the pair.
void PairSinew::pairwise_damping() {
  const Material& material = body_->setup.material;
  const bool central = acts_along_pairs(material.damping_form);
  send(Sent::counts);
  for_each_meeting([&](const Meeting& pair) {
    if (!pair.partners) return;
    const auto i = static_cast<std::size_t>(pair.i), j = static_cast<std::size_t>(pair.j);
    const double weight = (1 / body_->neighbors[i] + 1 / body_->neighbors[j]) / 2;
    const Vec3 approach = velocity(pair.i) - velocity(pair.j), along = direction(pair);
    const Vec3 drag =
        -material.damping * weight * (central ? Vec3(approach.dot(along) * along) : approach);
    body_->damping[i] += drag;
    if (pair.of_both) body_->damping[j] -= drag;
  });
}

}  // namespace sinew
