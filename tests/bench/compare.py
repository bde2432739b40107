#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the speed of stepping: sinew in single and double precision, the paper's cells, all pairs, LAMMPS.

usage: compare.py PROGRAMS OUT [--quick] [--update-readme]

PROGRAMS holds step_bench and make_state. Writes speed.md, speed.svg and speed.json to OUT; --update-readme also
puts the table into tests/bench/README.md and the plot into data/pictures. Candidates take turns, round by round, so
that other load on the machine meets them all; ratios are taken within a round. Exit code 1 when the bits depend on the number of threads.
"""
import argparse
import json
import re
import sys
import tempfile
from pathlib import Path

import speed_plot
import speed_tables
from speed_runs import Runs

SOURCE = Path(__file__).resolve().parents[2]
README = SOURCE / "tests/bench/README.md"
MARKED = re.compile(r"(<!-- speed -->\n).*?(<!-- /speed -->)", re.S)
STATES = ("rest", "bent", "twisted", "crushed", "flowed")
LAMMPS_STATES = ("rest", "flowed")  # nothing holds the others there: they would spring back
WITH_CELLS = 300_000  # particles; cells take as long per particle beyond
WITH_ALL_PAIRS = 3_000

SCENES = ("box_bend", "arm_bend", "creature_walk")
LAWS = 30_000  # particles of bodies that are not the paper's
LAW_ROUNDS, QUICK_LAW_ROUNDS = 4, 1

# particles -> (states, rounds)
FULL = {3_000: (STATES, 5), 30_000: (STATES, 5), 300_000: (STATES, 4), 3_000_000: (LAMMPS_STATES, 3)}
QUICK = {3_000: (LAMMPS_STATES, 3), 30_000: (LAMMPS_STATES, 2)}


def kinds_for(count):
    return (["single", "double"] + ["cells"] * (count <= WITH_CELLS) + ["all_pairs"] * (count <= WITH_ALL_PAIRS))


def measure_laws(runs, rounds):
    """What is not the paper's, beside the paper's law at rest."""
    for number in range(rounds):
        print(f"laws, {LAWS:,} particles: round {number + 1} of {rounds}", file=sys.stderr, flush=True)
        runs.laws(LAWS, ["single", "double"] + ["cells"] * (number == 0 and rounds > 1))
        if number == 0:
            runs.prepare_bonded(LAWS)
        runs.lammps_bonded(LAWS)
    runs.discard("rest", LAWS)


def measure_scenes(runs, sinew):
    for name in SCENES:
        print(f"{name}, whole", file=sys.stderr, flush=True)
        runs.scene(sinew, SOURCE / "configs" / f"{name}.yaml")


def measure(runs, plan):
    """One state at a time, its candidates in turn; the machine's limits before every size."""
    for count, (states, rounds) in plan.items():
        runs.limits()
        for state in states:
            with_lammps = state in LAMMPS_STATES
            runs.prepare(state, count, with_lammps)
            for number in range(rounds):
                print(f"{state}, {count:,} particles: round {number + 1} of {rounds}", file=sys.stderr, flush=True)
                turns = [lambda: runs.sinew(state, count, kinds_for(count))]
                if with_lammps:
                    turns.append(lambda: runs.lammps(state, count))
                for turn in turns if number % 2 == 0 else reversed(turns):
                    turn()
            runs.discard(state, count)
    runs.limits()
    runs.memory()


def readme_text():
    text = README.read_text(encoding="utf-8")
    if not MARKED.search(text):
        sys.exit("compare.py: tests/bench/README.md has no lines <!-- speed --> and <!-- /speed -->; add them")
    return text


def update_readme(table, plot):
    README.write_text(MARKED.sub(lambda match: match[1] + table + match[2], readme_text()), encoding="utf-8")
    (SOURCE / "data/pictures/speed.svg").write_text(plot, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--quick", action="store_true", help="small bodies only, one minute")
    parser.add_argument("--update-readme", action="store_true")
    options = parser.parse_args()
    if options.update_readme:
        readme_text()  # better told before ten minutes than after
    options.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=options.out) as scratch:
        runs = Runs(options.programs.resolve(), Path(scratch))
        measure_laws(runs, QUICK_LAW_ROUNDS if options.quick else LAW_ROUNDS)
        if not options.quick:
            measure_scenes(runs, options.programs.parent / "bin/sinew")
        measure(runs, QUICK if options.quick else FULL)
    results = runs.results()
    table, plot = speed_tables.markdown(results), speed_plot.svg(results)
    (options.out / "speed.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    (options.out / "speed.md").write_text(table, encoding="utf-8")
    (options.out / "speed.svg").write_text(plot, encoding="utf-8")
    print(table)
    if options.update_readme:
        update_readme(table, plot)
    for name in results["changed_bits"]:
        print(f"compare.py: the state of {name} differs between runs or numbers of threads", file=sys.stderr)
    return 1 if results["changed_bits"] else 0


if __name__ == "__main__":
    sys.exit(main())
