#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the cases of cases.py at several radii, and writes what comes out beside what should.

usage: validate.py BIN OUT [--case NAME ...] [--quick]     writes OUT/results.json, and folders of the runs
       validate.py --page RESULTS README.md [--check]      puts the table into the page, or compares
"""
import argparse
import json
import re
import subprocess
import sys
import time
from pathlib import Path

from cases import cases

MARK = re.compile(r"(<!-- results -->\n).*?(<!-- /results -->)", re.S)


def converged(binaries, case, folder, layers):
    scene = case.write(folder)
    radii = case.radii(layers)
    begun = time.time()
    subprocess.run([binaries / "sinew", "converge", scene, "--radii", ",".join(map(repr, radii)), "-o", folder / "runs",
                    "--quiet", "--force"], check=True, stdout=subprocess.DEVNULL)
    study = json.loads((folder / "runs" / "study.json").read_text())
    return study, time.time() - begun


def found(study, name, kind):
    return next(one for one in study["results"] if (one["name"], one["kind"]) == (name, kind))


def results_of(binaries, case, folder, quick):
    layers = case.quick if quick else case.layers
    study, seconds = converged(binaries, case, folder, layers)
    for (name, kind), (expected, unit) in case.expected.items():
        one = found(study, name, kind)
        yield {"case": case.name, "title": case.title, "result": name, "unit": unit, "expected": expected,
               "source": case.source, "within": case.within, "layers": layers, "values": one["values"],
               "limit": one["limit"], "error": one["error"], "order": one["order"],
               "particles": [run["particles"] for run in study["runs"]], "seconds": seconds}


def holds(one):
    """Within its share of the expected value."""
    return abs(one["limit"] - one["expected"]) <= one["within"] * abs(one["expected"])


def percent(value):
    return f"{100 * value:+.1f} %"


def table(results):
    lines = ["| body | result | expected | layers: off by | limit | off by | order |", "| --- | --- | --: | --- | --: | --: | --: |"]
    for one in results:
        expected = one["expected"]
        off = [f"{n}: {percent(value / expected - 1)}" for n, value in zip(one["layers"], one["values"])]
        order = "–" if one["order"] is None else f"{one['order']:.1f}"
        lines.append(f"| {one['title']} | `{one['result']}` | {expected:.4g} {one['unit']} | {', '.join(off)} | "
                     f"{one['limit']:.4g} ± {abs(one['error']):.2g} | {percent(one['limit'] / expected - 1)} | {order} |")
    lines.append("")
    lines += [f"- {title}: {source}." for title, source in dict((one["title"], one["source"]) for one in results).items()]
    return "\n".join(lines) + "\n"


def page(results_file, readme, check):
    text = table(json.loads(results_file.read_text()))
    before = readme.read_text()
    after = MARK.sub(lambda match: match.group(1) + text + match.group(2), before)
    if check:
        if before != after:
            sys.exit("the page does not show these results; write it with tests/validation/run.sh")
    else:
        readme.write_text(after)


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
    binaries, out = options.places
    results, failed = [], 0
    for case in cases():
        if (options.case and case.name not in options.case) or (options.quick and not case.quick):
            continue
        for one in results_of(binaries, case, out / case.name, options.quick):
            results.append(one)
            kept = holds(one)
            failed += not kept
            print(f"{case.name}, {one['result']}: {one['limit']:.6g} ± {abs(one['error']):.2g} for {one['expected']:.6g} "
                  f"{one['unit']}, {percent(one['limit'] / one['expected'] - 1)}{'' if kept else ': NOT WITHIN'} "
                  f"{'' if kept else percent(one['within'])} ({one['seconds']:.0f} s)", flush=True)
    (out / "results.json").write_text(json.dumps(results, indent=1) + "\n")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
