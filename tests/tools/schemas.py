#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The JSON Schemas that are installed, and files checked against them.

usage: schemas.py FOLDER...      checks all files below folders that have a schema
"""
import functools
import json
import sys
from pathlib import Path

import jsonschema

SCHEMAS = Path(__file__).resolve().parents[2] / "tools/packaging/schema"


@functools.cache
def schema_named(name):
    schema = json.loads((SCHEMAS / f"{name}.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def check(value, name):
    """Raises where the value is not as the schema NAME.schema.json has it."""
    schema_named(name).validate(value)


def name_of(path):
    """The schema of a file of a run, a study or a sweep; None of others, as comparisons."""
    has_run = (path.parent / "run.json").exists()
    if path.name == "sweep.json":
        return "sweep_run" if has_run or path.parent.parent.name == "runs" else "sweep"
    return {"run.json": "run", "study.json": "study", "metrics.json": "metrics" if has_run else None}.get(path.name)


def check_file(path):
    try:
        check(json.loads(path.read_text(encoding="utf-8")), name_of(path))
    except jsonschema.ValidationError as error:
        raise AssertionError(f"{path} is not as its schema says: {error.json_path}: {error.message}") from None


def check_written(folder, since=0):
    """Checks what was written below a folder since a time (s); returns the number of files."""
    files = [path for path in folder.rglob("*.json") if name_of(path) and path.stat().st_mtime >= since]
    for path in files:
        check_file(path)
    return len(files)


if __name__ == "__main__":
    counts = [check_written(Path(folder)) for folder in sys.argv[1:]]
    print(f"{sum(counts)} files are as their schemas say")
    sys.exit(0 if all(counts) else "a folder has no such file")
