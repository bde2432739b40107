// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lammps/lammps_run.h>

#include <mpi.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <thread>

#include <sinew/io/series.h>
#include <sinew/lammps/fix_sinew.h>
#include <sinew/lammps/frame_piece.h>
#include <sinew/lammps/pair_sinew.h>

namespace sinew {
namespace {

constexpr std::size_t created_at_once = 1 << 16;
constexpr double skin = 0.6;       // skin of neighbor lists, in radii
constexpr double bond_growth = 2;  // multiple of the longest bond until it is measured
// LAMMPS refuses boxes much thinner than the range of forces. That of a thin body never shrinks.
constexpr double thin = 12;  // in radii
constexpr std::size_t max_unread = 3;

LAMMPS_NS::Pair* make_pair(LAMMPS_NS::LAMMPS* lammps) { return new PairSinew(lammps); }
LAMMPS_NS::Fix* make_fix(LAMMPS_NS::LAMMPS* lammps, int words, char** word) {
  return new FixSinew(lammps, words, word);
}

/// What LAMMPS takes for its command line.
class Words {
 public:
  explicit Words(const std::filesystem::path& log)
      : words_{"sinew-lammps", "-screen", "none", "-nocite", "-log", log.string()} {
    for (std::string& word : words_) pointers_.push_back(word.data());
  }
  int count() const { return static_cast<int>(pointers_.size()); }
  char** data() { return pointers_.data(); }

 private:
  std::vector<std::string> words_;
  std::vector<char*> pointers_;
};

Box box_of_particles(const EngineFolder& folder, const EngineSetup& setup) {
  Box box;
  for_each_engine_particle(folder, setup,
                           [&](const EngineParticle& one) { box.extend(one.position); });
  const Vec3 margin = Vec3::Constant(setup.material.pair.r);
  return Box(box.min() - margin, box.max() + margin);
}

/// The particles of a file, handed to LAMMPS many at a time; each rank keeps its own.
class Creation {
 public:
  explicit Creation(LAMMPS_NS::LAMMPS* lammps) : lammps_(lammps) {}

  void add(const EngineParticle& one) {
    tags_.push_back(tag_of(one.id));
    x_.insert(x_.end(), one.position.begin(), one.position.end());
    v_.insert(v_.end(), one.velocity.begin(), one.velocity.end());
    if (tags_.size() == created_at_once) flush();
  }
  void flush() {
    const std::vector<int> types(tags_.size(), 1);
    lammps_create_atoms(lammps_, static_cast<int>(tags_.size()), tags_.data(), types.data(),
                        x_.data(), v_.data(), nullptr, 0);
    tags_.clear(), x_.clear(), v_.clear();
  }

 private:
  LAMMPS_NS::LAMMPS* lammps_;
  std::vector<int> tags_;
  std::vector<double> x_, v_;
};

class LammpsRun {
 public:
  LammpsRun(const EngineFolder& folder, const LammpsTalk& talk)
      : folder_(folder),
        talk_(talk),
        body_(read_engine_setup(folder)),
        plan_(body_.setup.plan()),
        words_(folder.log()),
        lammps_(words_.count(), words_.data(), MPI_COMM_WORLD) {
    (*lammps_.force->pair_map)["sinew"] = make_pair;
    (*lammps_.modify->fix_map)["sinew/body"] = make_fix;
    describe();
    create_particles();
  }

  Exit to_end() {
    const EngineSetup& setup = body_.setup;
    if (setup.frames > 0) reported_ = setup.start.steps;
    if (setup.frames == 0) {
      run(0);
      tell_state();
      return Exit::done;
    }
    for (int frame = plan_.intervals_begun(setup.start.steps + 1); frame <= setup.frames; ++frame) {
      const std::int64_t end = plan_.steps_until(frame);
      while (fix_->steps() < end)
        if (const Exit exit = stretch(end); exit != Exit::done) return exit;
    }
    return Exit::done;
  }

 private:
  void order(const std::string& command) { lammps_.input->one(command); }

  void describe() {
    const Material& material = body_.setup.material;
    for (const char* command : {"units lj", "atom_style atomic", "atom_modify map yes",
                                "newton off", "comm_style tiled", "comm_modify vel yes"})
      order(command);
    const Box box = box_of_particles(folder_, body_.setup);
    const bool is_thin = box.sizes().minCoeff() < thin * material.pair.r;
    order(is_thin ? "boundary m m m" : "boundary s s s");
    std::string region = "region all block";
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {box.min()[axis], box.max()[axis]}) region += ' ' + exact(side);
    order(region + " units box");
    order("create_box 1 all");
    order("mass 1 " + exact(material.mass));
    order("pair_style sinew");
    pair_ = dynamic_cast<PairSinew*>(lammps_.force->pair);
    pair_->attach(body_);
    order("pair_coeff * *");
    order("neighbor " + exact(skin * material.pair.r) + " bin");
    order("neigh_modify every 1 delay 0 check yes");
    order("thermo_style custom step");
    order("thermo_modify lost error");
    order("fix body all sinew/body");
    fix_ = dynamic_cast<FixSinew*>(lammps_.modify->fix[lammps_.modify->find_fix("body")]);
    fix_->attach(body_, talk_.interruption);
    fix_->surround(folder_.poses());
  }

  static std::string exact(double value) { return fmt::format("{:.17g}", value); }

  /// In two passes over the file: LAMMPS distributes positions evenly, then ranks take the rows of
  /// their particles.
  void create_particles() {
    Creation creation(&lammps_);
    for_each_engine_particle(folder_, body_.setup,
                             [&](const EngineParticle& one) { creation.add(one); });
    creation.flush();
    order("balance 1.02 rcb");
    order("fix balance all balance 100 1.02 rcb");
    const LAMMPS_NS::Atom& atoms = *lammps_.atom;
    double longest = 0;
    for_each_engine_particle(folder_, body_.setup, [&](const EngineParticle& one) {
      const int i = lammps_.atom->map(tag_of(one.id));
      if (i < 0 || i >= atoms.nlocal) return;
      std::copy_n(one.row, body_.width, body_.numbers(i));
      const ParticleRow row = body_.row(i);
      for (int k = 0; k < row.bonds(); ++k) longest = std::max(longest, row.bond(k).spring.length);
    });
    body_.longest_bond = bond_growth * longest;
    fix_->hold();
  }

  void run(std::int64_t steps) {
    lammps_.timer->reset_timeout();  // interruptions end a run by it
    order("run " + std::to_string(steps));
  }

  /// Steps to `end` or the next interruption, and writes the state there.
  Exit stretch(std::int64_t end) {
    if (const double next = plan_.step(fix_->steps()); next != fix_->step()) {
      run(0);
      fix_->change_step(next);
    }
    fix_->go_on();
    run(end - fix_->steps());
    tell_state();
    if (fix_->interrupted() == Interruption::stop) return Exit::interrupted;
    return fix_->interrupted() == Interruption::unstable ? Exit::unstable : Exit::done;
  }

  /// Writes the state, unless it is there already or was the beginning, and says so.
  void tell_state() {
    if (Ranks::first()) wait_for_reader();
    if (fix_->steps() != reported_) write_state();
    reported_ = fix_->steps();
    unread_.push_back(reported_);
    if (Ranks::first() && talk_.news)
      talk_.news({reported_, fix_->interrupted() == Interruption::unstable});
  }

  /// Who reads the states removes them: there are never many, and the others wait as well.
  void wait_for_reader() {
    const auto is_read = [&](std::int64_t steps) {
      return !std::filesystem::exists(folder_.state(steps));
    };
    while (true) {
      std::erase_if(unread_, is_read);
      if (unread_.size() < max_unread || talk_.interruption() == Interruption::stop) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  void write_state() {
    int me = 0, count = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    write_engine_piece(folder_.piece("state", fix_->steps(), me), state_rows());
    if (body_.setup.with_forces)
      write_engine_piece(folder_.piece("forces", fix_->steps(), me), force_rows());
    EngineMoment moment = fix_->moment();
    moment.in_frame = write_piece();
    moment.engine = std::string("LAMMPS ") + lammps_.version;
    const std::uint64_t own = static_cast<std::uint64_t>(lammps_.atom->nlocal);
    moment.particles.resize(static_cast<std::size_t>(count));
    MPI_Gather(&own, 1, MPI_UINT64_T, moment.particles.data(), 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
    add_up(moment, me);
    if (me > 0) return;
    write_engine_moment(folder_, moment);
    if (talk_.news) talk_.news({moment.steps, fix_->interrupted() == Interruption::unstable});
  }

  /// The particles of the frame of this moment, if there is one and it is to contain them.
  bool write_piece() {
    const auto& pieces = body_.setup.pieces;
    const int frame = plan_.intervals_begun(fix_->steps());
    if (!pieces || fix_->steps() != plan_.steps_until(frame) || frame % pieces->every != 0)
      return false;
    const auto number = static_cast<std::size_t>(frame / pieces->every);
    write_frame_piece(std::filesystem::path(pieces->folder) / frame_name("particles", number),
                      body_.setup, rows_of_piece(),
                      {plan_.time(fix_->steps()), static_cast<std::int32_t>(fix_->steps())});
    return true;
  }

  /// Collects rows as write_frame_piece() takes them.
  std::vector<PieceRow> rows_of_piece() const {
    const LAMMPS_NS::Atom& atoms = *lammps_.atom;
    std::vector<PieceRow> rows(static_cast<std::size_t>(atoms.nlocal));
    for (int i = 0; i < atoms.nlocal; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const ParticleRow row = body_.row(i);
      PieceRow& one = rows[at];
      one.id = id_of(atoms.tag[i]);
      one.bone = row.bones() > 0 ? row.influence(0).bone : no_bone;
      one.weight = row.bones() > 0 ? row.influence(0).weight : 0;
      one.rest = row.rest();
      one.position = Vec3(atoms.x[i][0], atoms.x[i][1], atoms.x[i][2]);
      one.velocity = fix_->velocity_of(i);
      one.pair = body_.pair[at];
      one.damping = body_.damping[at];
      one.on_bones = body_.bone[at];
      one.world = body_.world.empty() ? Vec3(Vec3::Zero()) : body_.world[at];
      one.neighbors = static_cast<std::int32_t>(body_.neighbors[at]);
    }
    return rows;
  }

  /// The energies of all ranks, on the first.
  static void add_up(EngineMoment& moment, int me) {
    for (double* value : {&moment.ledgers.of_bones.work, &moment.ledgers.of_bones.dissipation,
                          &moment.ledgers.of_bones.power, &moment.ledgers.of_world.work,
                          &moment.ledgers.of_world.dissipation, &moment.ledgers.of_world.power,
                          &moment.ledgers.held_at_start})
      MPI_Reduce(me == 0 ? MPI_IN_PLACE : value, value, 1, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
  }

  std::vector<double> state_rows() const {
    std::vector<double> rows;
    const LAMMPS_NS::Atom& atoms = *lammps_.atom;
    rows.reserve(static_cast<std::size_t>(atoms.nlocal) * state_width);
    for (int i = 0; i < atoms.nlocal; ++i) {
      rows.push_back(id_of(atoms.tag[i]));
      rows.insert(rows.end(), atoms.x[i], atoms.x[i] + 3);
      rows.insert(rows.end(), atoms.v[i], atoms.v[i] + 3);
    }
    return rows;
  }

  std::vector<double> force_rows() const {
    std::vector<double> rows;
    for (std::size_t i = 0; i < body_.pair.size(); ++i) {
      rows.push_back(id_of(lammps_.atom->tag[i]));
      for (const Points* forces : {&body_.pair, &body_.damping, &body_.bone})
        rows.insert(rows.end(), (*forces)[i].begin(), (*forces)[i].end());
      const Vec3 world = body_.world.empty() ? Vec3(Vec3::Zero()) : body_.world[i];
      rows.insert(rows.end(), world.begin(), world.end());
      rows.push_back(body_.neighbors[i]);
    }
    return rows;
  }

  const EngineFolder& folder_;
  const LammpsTalk& talk_;
  LocalBody body_;
  StepPlan plan_;
  Words words_;
  LAMMPS_NS::LAMMPS lammps_;
  PairSinew* pair_ = nullptr;  ///< LAMMPS's, as the fix
  FixSinew* fix_ = nullptr;
  std::int64_t reported_ = -1;        ///< the step of the last state
  std::vector<std::int64_t> unread_;  ///< states
};

}  // namespace

Ranks::Ranks(int argc, char** argv) { MPI_Init(&argc, &argv); }
Ranks::~Ranks() { MPI_Finalize(); }

bool Ranks::first() {
  int me = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &me);
  return me == 0;
}

void Ranks::abort(int code) const {
  MPI_Abort(MPI_COMM_WORLD, code);
  std::abort();  // MPI does not return
}

Exit step_on_lammps(const EngineFolder& folder, const LammpsTalk& talk) {
  return LammpsRun(folder, talk).to_end();
}

}  // namespace sinew
