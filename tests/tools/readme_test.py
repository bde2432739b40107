#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that every generated table stands in one README.md with the text of the code, and that all links work.

usage: readme_test.py SINEW_TABLES SOURCE [--update]     --update writes the tables into the README files
"""
import re
import subprocess
import sys
from pathlib import Path

NAMES = ("settings", "arrays", "series", "metrics", "bones", "sections", "capabilities", "presets")
TABLE = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end of table -->)", re.S)
CODE = re.compile(r"^```.*?^```", re.S | re.M)
LINK = re.compile(r"\]\(([^)\s]+)\)|src=\"([^\"]+)\"")


def pages_of(source):
    yield source / "README.md"
    for folder in ("configs", "data", "lib", "tests", "tools"):
        yield from sorted((source / folder).rglob("README.md"))


def anchors_of(text):
    """The anchors of a page's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.+)$", CODE.sub("", text), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def table_faults(texts, true_texts):
    found = [match[2] for text in texts.values() for match in TABLE.finditer(text)]
    for name in NAMES:
        if found.count(name) != 1:
            yield f"the table '{name}' stands in {found.count(name)} places of the README files; it belongs in one"
    for page, text in texts.items():
        if true_texts[page] != text:
            yield f"the tables of {page} differ from the code's; run this with --update"


def link_faults(texts):
    for page, text in texts.items():
        for link in LINK.findall(CODE.sub("", text)):
            target, _, anchor = (link[0] or link[1]).partition("#")
            if "://" in target:
                continue
            place = (page.parent / target).resolve() if target else page
            if not place.exists():
                yield f"{page} links to {target}, which does not exist"
            elif anchor and place in texts and anchor not in anchors_of(texts[place]):
                yield f"{page} links to {target}#{anchor}, a heading that does not exist"


def main():
    tables, source = sys.argv[1], Path(sys.argv[2]).resolve()

    def printed(match):
        table = subprocess.run([tables, match[2]], check=True, capture_output=True, text=True).stdout
        return match[1] + table + match[3]

    texts = {page: page.read_text(encoding="utf-8") for page in pages_of(source)}
    true_texts = {page: TABLE.sub(printed, text) for page, text in texts.items()}
    if "--update" in sys.argv:
        for page, text in true_texts.items():
            page.write_text(text, encoding="utf-8")
        return 0
    faults = [*table_faults(texts, true_texts), *link_faults(texts)]
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
