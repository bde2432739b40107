#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the cases of cases.py at several radii, and writes what comes out beside what should; those that have finite
elements beside them also through CalculiX (ccx), point by point.

usage: validate.py BIN OUT [--case NAME ...] [--quick]     writes OUT/results.json, and folders of the runs; with
                                                           --case the results of others stay
       validate.py --page RESULTS README.md [--check]      puts the table into the page, or compares
"""
import argparse
import json
import math
import os
import re
import shutil
import subprocess
import sys
import textwrap
import time
from pathlib import Path

from cases import WITHIN, cases

MARK = re.compile(r"(<!-- results -->\n).*?(<!-- /results -->)", re.S)


def timed(words, folder):
    """Seconds and the most memory, MB, of a command and those that it starts."""
    begun = time.time()
    with (folder / "log.txt").open("a") as log:
        child = subprocess.Popen(list(map(str, words)), cwd=folder, stdout=log, stderr=log)
        _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(map(str, words))}\nfailed; see {folder / 'log.txt'}")
    return time.time() - begun, usage.ru_maxrss / 1024


def converged(binaries, case, folder, layers):
    scene = case.write(folder)
    seconds, memory = timed([binaries / "sinew", "converge", scene, "--radii", ",".join(map(repr, case.radii(layers))),
                             "-o", folder / "runs", "--quiet", "--force"], folder)
    study = json.loads((folder / "runs" / "study.json").read_text())
    return study, seconds, memory


def about(case, study, seconds, layers):
    return {"case": case.name, "title": case.title, "source": case.source, "within": case.within,
            "layers": layers or case.layers, "particles": [run["particles"] for run in study["runs"]], "seconds": seconds}


def found(study, name, kind):
    return next(one for one in study["results"] if (one["name"], one["kind"]) == (name, kind))


def values_of(one):
    return {key: one[key] for key in ("values", "limit", "error", "order")}


def beside_elements(binaries, case, folder, study, seconds, memory, layers):
    """The finest run and CalculiX's result of the same scene, in each frame: the largest distance."""
    radius = min(case.radii(layers))
    finest = min(study["runs"], key=lambda run: run["radius"])
    run = folder / "runs" / finest["name"]
    export, _ = timed([binaries / "sinew", "export", run / "scene.yaml", "--to", "calculix", "-o", "elements.inp",
                       "--size", repr(case.elements * radius)], folder)
    solve, needs = timed(["ccx", "-i", "elements"], folder)
    timed([binaries / "sinew", "measure", run, "--reference", "elements.frd", "-o", folder / "compared", "--quiet"], folder)
    compared = json.loads((folder / "compared" / "reference.json").read_text())
    worst = max(compared["frames"], key=lambda frame: frame["max_relative"])
    for name in case.by_elements:
        probe, axis = name[:-2], "xyz".index(name[-1])
        yield {**about(case, study, seconds, layers), "title": case.title + ", by elements", "result": name,
               "source": "CalculiX, in the same run", "within": WITHIN, "unit": "m",
               "expected": compared["frames"][-1][probe + " by elements"][axis], **values_of(found(study, name, "final"))}
    yield {"case": case.name, "title": case.title, "layers": (layers or case.layers)[-1], "within": WITHIN,
            "particles": compared["particles"], "elements": compared["elements"], "nodes": compared["nodes"],
            "rms": worst["rms_relative"], "max": worst["max_relative"], "largest": worst["largest_elements"],
            "seconds": finest["seconds"], "memory": memory, "ccx_seconds": export + solve, "ccx_memory": needs}


def at_zero(radii, values):
    """The limit by up to three radii, as sinew converge has it: that of the polynomial through them; and how far the
    line through the finest two is off."""
    def through(count):
        x, y = radii[-count:], values[-count:]
        return sum(y[i] * math.prod(x[j] / (x[j] - x[i]) for j in range(count) if j != i) for i in range(count))
    limit = through(min(3, len(radii)))
    return limit, abs(limit - through(2)) if len(radii) > 2 else None


def results_of(case, study, seconds, layers, folder):
    shared = about(case, study, seconds, layers)
    for name, (of_run, expected, unit) in case.measured.items():
        values = [of_run(folder / "runs" / run["name"]) for run in study["runs"]]
        limit, error = at_zero([run["radius"] for run in study["runs"]], values)
        yield {**shared, "result": name, "unit": unit, "expected": expected, "values": values, "limit": limit,
               "error": error, "order": None}
    for (name, kind), (expected, unit) in case.expected.items():
        yield {**shared, "result": name, "unit": unit, "expected": expected, **values_of(found(study, name, kind))}


def holds(one):
    """Within its share of the expected value; every particle within that of the largest displacement."""
    if "max" in one:
        return one["max"] <= one["within"]
    if one["expected"] == 0:
        return not any(one["values"])
    return abs(one["limit"] - one["expected"]) <= one["within"] * abs(one["expected"])


def percent(value):
    return f"{100 * value:+.1f} %"


def number(value, digits=4):
    return f"{value:.{digits}g}" if value is not None else "–"


def limit_text(one, digits=4):
    """With its error, where there is one."""
    text = number(one["limit"], digits)
    return f"{text} ± {number(abs(one['error']), 2)}" if one["error"] else text


def marked(text, one):
    return text if holds(one) else f"**{text}**"


def off(value, expected):
    if value is None:
        return "–"
    return percent(value / expected - 1) if expected else f"{value:.3g}"


def table(results):
    lines = ["| body | result | expected | layers: off by | limit | off by | order |", "| --- | --- | --: | --- | --: | --: | --: |"]
    for one in results:
        expected = one["expected"]
        each = [f"{n}: {off(value, expected)}" for n, value in zip(one["layers"], one["values"])]
        order = "–" if one["order"] is None else f"{one['order']:.1f}"
        lines.append(f"| {one['title']} | `{one['result']}` | {expected:.4g} {one['unit']} | {', '.join(each)} | "
                     f"{limit_text(one)} | {marked(off(one['limit'], expected), one)} | {order} |")
    lines.append("")
    lines += [f"- {title}: {source}." for title, source in dict((one["title"], one["source"]) for one in results).items()]
    return "\n".join(lines) + "\n"


def element_table(results):
    lines = ["", "| body beside finite elements | largest displacement | particles: layers, time, memory | "
             "elements: nodes, time, memory | rms | largest |", "| --- | --: | --: | --: | --: | --: |"]
    for one in results:
        lines.append(f"| {one['title']} | {one['largest']:.3g} m | {one['particles']}: {one['layers']}, "
                     f"{one['seconds']:.1f} s, {one['memory']:.0f} MB | {one['elements']}: {one['nodes']}, "
                     f"{one['ccx_seconds']:.1f} s, {one['ccx_memory']:.0f} MB | {percent(one['rms'])[1:]} | "
                     f"{marked(percent(one['max'])[1:], one)} |")
    return "\n".join(lines) + "\n"


def paper_text(file):
    """What paper_figure.py has found."""
    one = json.loads(file.read_text())
    text = (f"The paper's bar pulls with {100 * one['modulus']:.0f} % of E times the strain at a strain of "
            f"{100 * one['at']:.1f} %, is a tenth below it from {100 * one['leaves']:.1f} % on, and tears at "
            f"{100 * one['peak']:.1f} %, near the greatest load that its lattice bears in uniform strain. Released, it "
            f"does not return; the bonded bar does, but for a load of {100 * one['bonded']:.2g} % of E and its section.")
    return ("\n![The load of a pulled and released bar: bonded, paper, and theory]"
            "(../../data/pictures/paper_and_elasticity.png)\n\n" + textwrap.fill(text, 118) + "\n")


def untimed(text):
    """Without what differs from machine to machine."""
    return re.sub(r"[\d.]+ s, \d+ MB", "", text)


def page(results_file, readme, check):
    results = json.loads(results_file.read_text())
    text = table([one for one in results if "max" not in one]) + element_table([one for one in results if "max" in one])
    paper = results_file.parent / "paper.json"
    text += paper_text(paper) if paper.exists() else ""
    before = readme.read_text()
    after = MARK.sub(lambda match: match.group(1) + text + match.group(2), before)
    if check:
        if untimed(before) != untimed(after):
            sys.exit("the page does not show these results; write it with tests/validation/run.sh")
    else:
        readme.write_text(after)


def keep(results, file):
    """Beside those of cases that were not run this time, in the order of cases."""
    run = {one["case"] for one in results}
    before = json.loads(file.read_text()) if file.exists() else []
    order = [case.name for case in cases()]
    kept = results + [one for one in before if one["case"] not in run and one["case"] in order]
    kept.sort(key=lambda one: order.index(one["case"]))
    file.write_text(json.dumps(kept, indent=1) + "\n")


def run_case(binaries, case, folder, quick):
    layers = case.quick if quick else case.layers
    study, seconds, memory = converged(binaries, case, folder, layers)
    yield from results_of(case, study, seconds, layers, folder)
    if case.elements and quick:
        return
    if case.elements and shutil.which("ccx"):
        yield from beside_elements(binaries, case, folder, study, seconds, memory, layers)
    elif case.elements:
        print(f"{case.name}: ccx is not installed (tools/install_packages.sh test)")


def line_of(one):
    not_within = "" if holds(one) else f": NOT WITHIN {percent(one['within'])}"
    if "max" in one:
        return (f"{one['case']} beside {one['elements']} elements: {percent(one['rms'])} rms, {percent(one['max'])} at most"
                f"{not_within} ({one['seconds']:.1f} and {one['ccx_seconds']:.1f} s)")
    return (f"{one['case']}, {one['result']}: {limit_text(one, 6)} for {one['expected']:.6g} "
            f"{one['unit']}, {off(one['limit'], one['expected'])}{not_within} ({one['seconds']:.0f} s)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("places", nargs=2, type=Path)
    parser.add_argument("--case", action="append")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--page", action="store_true")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    if options.page:
        return page(*options.places, options.check)
    binaries, out = (place.resolve() for place in options.places)
    results = []
    for case in cases():
        if (options.case and case.name not in options.case) or (options.quick and not case.quick):
            continue
        for one in run_case(binaries, case, out / case.name, options.quick):
            results.append(one)
            print(line_of(one), flush=True)
        keep(results, out / "results.json")
    return not all(map(holds, results))


if __name__ == "__main__":
    sys.exit(main())
