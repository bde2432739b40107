// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-lammps FOLDER: steps a run that sinew simulate --engine lammps has prepared, under mpirun.
// SIGUSR1 ends it with a state after the step, SIGUSR2 requests one.
#include <csignal>
#include <string>

#include <sinew/lammps/lammps_run.h>

#include "command/command.h"
#include "command/results.h"

namespace {

using namespace sinew;

volatile std::sig_atomic_t stop = 0, state = 0;

void remember(int signal) { (signal == SIGUSR1 ? stop : state) = 1; }

Interruption take_interruption() {
  if (stop != 0) return Interruption::stop;
  if (state == 0) return Interruption::none;
  state = 0;
  return Interruption::state;
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();  // before those of MPI
  std::signal(SIGUSR1, remember);
  std::signal(SIGUSR2, remember);
  const Ranks ranks(argc, argv);
  const int code = run_reporting_errors([&] {
    if (argc != 2)
      throw bad_input("sinew-lammps needs the folder of a prepared run",
                      "start it by sinew simulate SCENE --engine lammps --ranks N");
    if (Ranks::first()) print_out(std::string(engine_begins) + '\n');
    return step_on_lammps({argv[1]}, {take_interruption, [](const EngineStatus& news) {
                                        print_out(text_of(news) + '\n');
                                      }});
  });
  const bool ended = code == static_cast<int>(Exit::done) ||
                     code == static_cast<int>(Exit::interrupted) ||
                     code == static_cast<int>(Exit::unstable);
  if (!ended) ranks.abort(code);  // the others may be at work
  return code;
}
