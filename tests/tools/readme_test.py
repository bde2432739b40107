#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The README's tables are those of the code, and what it links to exists.

usage: readme_test.py SINEW_TABLES README.md [--update]     --update writes the tables into the README
"""
import re
import subprocess
import sys
from pathlib import Path

TABLE = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end of table -->)", re.S)


def main():
    tables, readme = sys.argv[1], Path(sys.argv[2])
    text = readme.read_text(encoding="utf-8")

    def printed(match):
        table = subprocess.run([tables, match[2]], check=True, capture_output=True, text=True).stdout
        return match[1] + table + match[3]

    true_text = TABLE.sub(printed, text)
    if "--update" in sys.argv:
        readme.write_text(true_text, encoding="utf-8")
        return 0
    failed = 0
    if {match[2] for match in TABLE.finditer(text)} != {"settings", "arrays", "metrics", "bones", "sections"}:
        print("the README lacks a table")
        failed = 1
    if true_text != text:
        print("the README's tables differ from the code's; run this with --update")
        failed = 1
    for link in re.findall(r"\]\(([^)#]+)\)|src=\"([^\"]+)\"", text):
        target = link[0] or link[1]
        if "://" not in target and not (readme.parent / target).exists():
            print(f"the README links to {target}, which does not exist")
            failed = 1
    return failed


sys.exit(main())
