#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How long tests take: what takes long starts first, so that no core waits for it at the end.

usage: costs.py renew BUILD     after a whole run of ctest: writes costs.txt
       costs.py tell BUILD      gives a build that has run no test what costs.txt says
"""
import sys
from pathlib import Path

TABLE = Path(__file__).with_name("costs.txt")
SHORTEST = 2  # s: those below fill the gaps


def renew(measured):
    """ctest writes a line per test, `name runs seconds`, and after a line of dashes those that failed."""
    lines = measured.read_text().split("\n---")[0].splitlines()
    costs = sorted((name, float(seconds)) for name, _, seconds in map(str.split, lines))
    TABLE.write_text("".join(f"{name} 1 {seconds:.0f}\n" for name, seconds in costs if seconds >= SHORTEST))


def tell(measured):
    if measured.exists():
        return
    measured.parent.mkdir(parents=True, exist_ok=True)
    measured.write_text(TABLE.read_text() + "---\n")


def main():
    jobs = {"renew": renew, "tell": tell}
    if len(sys.argv) != 3 or sys.argv[1] not in jobs:
        return __doc__
    jobs[sys.argv[1]](Path(sys.argv[2]) / "Testing/Temporary/CTestCostData.txt")
    return 0


if __name__ == "__main__":
    sys.exit(main())
