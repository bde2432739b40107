# SPDX-License-Identifier: GPL-3.0-or-later
"""Markdown tables of the figures of compare.py."""
from statistics import median

FLOP = 420  # per particle-step: 12 pairs of 35
BYTES = {"single": 72, "double": 144}  # per particle-step: 6 numbers read, written, and read before writing
NONE = "–"


def rounded(value):
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


class Figures:
    def __init__(self, results):
        self.rounds = results["figures"]

    def of(self, state, count, kind, threads=1):
        return self.rounds.get(f"{state}/{count}/{kind}/{threads}", [])

    def speed(self, state, count, kind, threads=1):
        rounds = self.of(state, count, kind, threads)
        return median(rounds) if rounds else None

    def cell(self, state, count, kind, threads=(1,)):
        speeds = [self.speed(state, count, kind, number) for number in threads]
        return NONE if None in speeds else " / ".join(map(rounded, speeds))

    def ratio(self, state, count, kind, other):
        """Within rounds: median and range."""
        pairs = list(zip(self.of(state, count, kind), self.of(state, count, other)))
        if not pairs:
            return NONE
        ratios = [a / b for a, b in pairs]
        return f"{rounded(median(ratios))} ({rounded(min(ratios))} to {rounded(max(ratios))})"


def table(head, rows):
    lines = [head, ["---"] + ["--:"] * (len(head) - 1), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def row(figures, name, state, count):
    return [name, figures.cell(state, count, "single", (1, 2)), figures.cell(state, count, "double", (1, 2)),
            figures.cell(state, count, "cells"), figures.cell(state, count, "lammps"),
            figures.ratio(state, count, "single", "lammps"), figures.ratio(state, count, "double", "lammps")]


def head(first):
    return [first, "single, 1 / 2 threads", "double, 1 / 2 threads", "the paper's cells", "LAMMPS, eq. 1 alone",
            "single : LAMMPS", "double : LAMMPS"]


def counts_of(results, state=None):
    """Requested numbers of particles with figures, ascending."""
    keys = (key.split("/") for key in results["figures"] if ", " not in key)
    return sorted({int(count) for name, count, *_ in keys if state in (None, name)})


def states_of(results, count):
    names = (key.split("/") for key in results["figures"] if ", " not in key)
    return list(dict.fromkeys(state for state, number, *_ in names if int(number) == count))


def largest_with_all_states(results):
    return max(counts_of(results), key=lambda count: (len(states_of(results, count)), count))


def shares_of(figures, name, count, kind, rest_count):
    """Of the paper's law at rest: median of the rounds."""
    mine, rest = figures.of(name, count, kind), figures.of("paper, rest", rest_count, kind)
    if len(mine) != len(rest):
        return f"{median(mine) / median(rest):.2f}"
    return f"{median(a / b for a, b in zip(mine, rest)):.2f}"


def law_table(results, figures, whole):
    """Speeds of what is not the paper's at rest, beside it: other laws, or shipped scenes as a whole."""
    keys = [key.split("/") for key in results["figures"] if ", " in key]
    rest_count = next(count for name, count, *_ in keys if name == "paper, rest")
    names = list(dict.fromkeys((name, count) for name, count, *_ in keys if name.endswith(", whole") == whole))
    rows = [[name.removesuffix(", whole") + f" ({int(count):,})" * whole]
            + [cell for kind in ("single", "double")
               for cell in (figures.cell(name, count, kind, (1, 2)), shares_of(figures, name, count, kind, rest_count))]
            for name, count in names]
    head = ["scene (particles)" if whole else "body, state"]
    for kind in ("single", "double"):
        head += [f"{kind}, 1 / 2 threads", "to the paper's at rest"]
    if not whole:
        head += ["the paper's cells", "LAMMPS, harmonic bonds alone"]
        for row_of, (name, count) in zip(rows, names):
            row_of += [figures.cell(name, count, "cells"), figures.cell(name, count, "lammps")]
    return table(head, rows) if rows else ""


def limits(results):
    """Name, what was measured, and the Mps it allows: per precision, on one thread."""
    highest = {name: max(values) for name, values in results["limits"].items()}
    traffic = highest["triad/threads:1 traffic"]
    for kind in ("single", "double"):
        peak = highest[f"peak/{kind} GFLOP/s"]
        yield kind, "arithmetic", f"{rounded(peak)} GFLOP/s", 1e3 * peak / FLOP
        yield kind, "memory", f"{rounded(traffic)} GB/s", 1e3 * traffic / BYTES[kind]


def limit_table(results, figures):
    count = counts_of(results, "rest")[-1]
    found = list(limits(results))
    rows = []
    for kind, name, measured, allowed in found:
        tighter = allowed == min(limit for other, *_, limit in found if other == kind)
        share = figures.speed("rest", count, kind) / allowed
        rows.append([f"{kind}, {name}" + (" (the tighter)" if tighter else ""), measured, rounded(allowed),
                     f"{100 * share:.0f} %"])
    return table(["limit, one thread", "measured", "Mps it allows", f"reached at rest, {count:,} particles"], rows)


def remarks(results, figures):
    count = counts_of(results, "rest")[0]
    if figures.of("rest", count, "all_pairs"):
        yield (f"All pairs, {results['particles'][count]:,} particles: {figures.cell('rest', count, 'all_pairs')} Mps; "
               f"the paper's cells are {figures.ratio('rest', count, 'cells', 'all_pairs')} times as fast.")
    late = [f"{lists['dangerous']:.0f} of {lists['builds']:.0f} times ({state}, {int(number):,})"
            for (state, number), lists in ((key.split("/"), value) for key, value in results["lammps_lists"].items())
            if lists["dangerous"] > 0]
    if late:
        yield f"LAMMPS checked its lists too late, and missed pairs: {', '.join(late)}."
    if results["bytes_per_particle"]:
        sizes = ", ".join(f"{value:.0f} ({kind})" for kind, value in results["bytes_per_particle"].items())
        yield f"Bytes per particle at the peak, the body's description included: {sizes}."


def markdown(results):
    figures = Figures(results)
    by_count = [row(figures, f"{results['particles'][count]:,}", "rest", count) for count in counts_of(results, "rest")]
    count = largest_with_all_states(results)
    by_state = [row(figures, state, state, count) for state in states_of(results, count)]
    parts = [f"Million particle-steps per second, at rest, on {results['processor']}, {results['cores']} cores; "
             "medians, and ranges of the ratios within rounds:\n",
             table(head("particles"), by_count),
             f"The states, {results['particles'][count]:,} particles:\n", table(head("state"), by_state),
             "What is not the paper's law, 30,000 particles:\n", law_table(results, figures, False),
             f"The limits, at {FLOP} floating-point operations and {BYTES['single']} bytes (double: {BYTES['double']}) "
             "per particle-step (memory: for bodies beyond the caches):\n",
             limit_table(results, figures), "\n".join(remarks(results, figures)) + "\n"]
    if scenes := law_table(results, figures, True):
        parts[6:6] = ["Shipped scenes as a whole, stepping alone:\n", scenes]
    return "\n".join(parts)
