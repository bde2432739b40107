#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random trials of what people, programs and attackers may do to sinew. Each kind (breaker_kinds.py) prepares files
and gives commands; what is seen is told apart: a crash, a hang, a code or message that is none of those promised,
too much memory, files outside of the trial's folder, other bits than an unbroken run has.

usage: breaker.py BIN SOURCE [--trials 2000] [--seed 1] [--jobs 2] [--kinds KIND,...] [--seconds 60]
BIN: folder of the programs; SOURCE: of the project. `--seed S --trials 1` repeats one trial: its seed is printed.
"""
import argparse
import collections
import hashlib
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import breaker_kinds

CODES = {0, 1, 2, 3, 4, 130}
ONE_LINE = re.compile(r"\Asinew: [^\n]*; [^\n]*\Z")
HARMLESS = re.compile(r"[^\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f]*\Z", re.DOTALL)
SPARE = 200e6  # bytes beside those that files of the trial may take


class Broken(Exception):
    """A promise that a trial has seen broken, and its kind."""

    def __init__(self, kind, what):
        super().__init__(what)
        self.kind = kind


class Trial:
    """One trial: a folder of its own, chance by its seed, and what its commands have taken."""

    def __init__(self, campaign, seed, folder):
        self.chance, self.folder = random.Random(seed), folder
        self.bin, self.source, self.samples = campaign.bin, campaign.source, campaign.samples
        self.longest, self.peak, self.commands = campaign.seconds, 0, []
        self.inside, self.outside = folder / "in", folder / "out"
        self.inside.mkdir()
        self.outside.mkdir()
        (self.outside / "precious").write_text("precious")

    def sinew(self, *words, **how):
        return self.run(self.bin / "sinew", *words, **how)

    def run(self, *words, text=0, declared=0, codes=frozenset(CODES), limits=(), environment=None,
            silent=False, before=None, after=None):
        """Runs a command. text, declared: bytes of text files that it reads, and of binary ones, uncompressed;
        silent: nobody hears its messages."""
        self.commands.append(" ".join(map(repr, map(os.fsdecode, words))))

        def prepare():
            os.setpgrp()
            for which, limit in limits:
                resource.setrlimit(which, (limit, limit))
            if before:
                before()
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as errors:
            begun = time.monotonic()
            child = subprocess.Popen(words, stdout=out, stderr=errors, stdin=subprocess.DEVNULL, cwd=self.inside,
                                     preexec_fn=prepare, env={**os.environ, **(environment or {})})
            if after:
                after(child)
            code = self.wait(child, begun)
            out.seek(0), errors.seek(0)
            said, complained = (file.read().decode("utf-8", "replace") for file in (out, errors))
        self.judge(code, said, complained, codes, silent)
        allowed = 30 * text + 12 * declared + SPARE
        if self.used > allowed:
            raise Broken("memory", f"{self.used / 1e6:.0f} MB, {allowed / 1e6:.0f} are allowed")
        return code, said, complained

    def wait(self, child, begun):
        killed = False
        while True:
            done, status, usage = os.wait4(child.pid, os.WNOHANG)
            if done:
                break
            if time.monotonic() - begun > self.longest and not killed:
                os.killpg(child.pid, signal.SIGKILL)
                killed = True
            time.sleep(0.005)
        child.returncode = 0  # it is waited for
        self.used = 1024 * usage.ru_maxrss
        self.peak = max(self.peak, self.used)
        if killed:
            raise Broken("hang", f"over {self.longest} s")
        return os.waitstatus_to_exitcode(status)

    def judge(self, code, said, complained, codes, silent):
        if code < 0 and -code not in codes:
            raise Broken("crash", f"signal {-code}: {complained[-300:]}")
        if code >= 0 and code not in codes:
            raise Broken("code", f"{code}: {complained[-300:]}")
        if not HARMLESS.match(said) or not HARMLESS.match(complained.replace("\r", "")):
            raise Broken("terminal", repr((said + complained)[-300:]))
        if "unforeseen" in complained:
            raise Broken("message", complained[-300:])
        errors = [line for line in complained.splitlines() if line.startswith("sinew: ")
                  and not line.startswith(("sinew: warning: ", "sinew: stopped"))]
        if not silent and code in (2, 4) and (not errors or not ONE_LINE.match(errors[-1])):
            raise Broken("message", complained[-300:])

    def check_outside(self):
        found = {file.relative_to(self.outside): file.read_bytes() for file in self.outside.rglob("*") if file.is_file()}
        if found != {Path("precious"): b"precious"}:
            raise Broken("outside", f"files outside: {sorted(map(str, found))}")

    def small_run(self, name="run"):
        """A copy of a finished run of few particles."""
        return Path(shutil.copytree(self.samples / "run", self.inside / name, symlinks=True))


class Campaign:
    def __init__(self, arguments):
        self.bin, self.source = arguments.bin.resolve(), arguments.source.resolve()
        self.seconds = arguments.seconds
        self.kinds = [getattr(breaker_kinds, name) for name in arguments.kinds] or breaker_kinds.KINDS
        self.counts, self.peaks = collections.Counter(), collections.Counter()
        self.broken, self.lock = [], threading.Lock()
        self.home = Path(tempfile.mkdtemp(prefix="breaker_"))
        self.samples = self.home / "samples"
        self.samples.mkdir()
        breaker_kinds.make_samples(self.bin, self.source, self.samples)

    def one(self, seed):
        kind = self.kinds[seed % len(self.kinds)]
        folder = self.home / f"trial{seed}"
        folder.mkdir()
        trial = Trial(self, seed, folder)
        try:
            kind(trial)
            trial.check_outside()
        except Broken as broken:
            self.report(seed, kind, trial, broken.kind, str(broken))
        except Exception as error:  # of the trial's own preparations
            self.report(seed, kind, trial, "trial", repr(error))
        with self.lock:
            self.counts[kind.__name__] += 1
            self.peaks[kind.__name__] = max(self.peaks[kind.__name__], trial.peak)
        shutil.rmtree(folder, ignore_errors=True)

    def report(self, seed, kind, trial, what, words):
        with self.lock:
            self.broken.append((what, kind.__name__, seed))
            print(f"{what}: {kind.__name__}, --seed {seed}: {words}\n  {trial.commands[-1:] or ''}", flush=True)

    def close(self):
        shutil.rmtree(self.home, ignore_errors=True)
        print(f"{'kind':14} trials  largest memory, MB")
        for kind in sorted(self.counts):
            print(f"{kind:14} {self.counts[kind]:6}  {self.peaks[kind] / 1e6:.0f}")
        kinds = collections.Counter(what for what, _, _ in self.broken)
        print(f"{sum(self.counts.values())} trials, {len(self.broken)} broken promises {dict(kinds) or ''}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=Path)
    parser.add_argument("source", type=Path)
    parser.add_argument("--trials", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--kinds", type=lambda text: text.split(","), default=[])
    arguments = parser.parse_args()
    campaign = Campaign(arguments)
    pool = ThreadPoolExecutor(arguments.jobs)
    try:
        list(pool.map(campaign.one, range(arguments.seed, arguments.seed + arguments.trials)))
    except KeyboardInterrupt:
        print("interrupted: what was tried so far")
    finally:
        pool.shutdown(cancel_futures=True)
        campaign.close()
    return 1 if campaign.broken else 0


if __name__ == "__main__":
    sys.exit(main())
