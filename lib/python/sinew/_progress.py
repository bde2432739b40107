# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress of long work, as a callback or a bar, and its threads."""
import contextlib
import sys
import time

from . import _sinew
from ._error import Error

MOST_THREADS = 1024


def with_threads(threads, job):
    """What job() returns, within so many threads; 0: one per core."""
    if not 0 <= threads <= MOST_THREADS:
        raise Error(f"threads is {threads}; give a number from 0 (one per core) to {MOST_THREADS}")
    return _sinew._with_threads(threads, job) if threads else job()


def _in_notebook():
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    return type(shell).__name__ == "ZMQInteractiveShell"


class _Bar:
    """"simulating [######      ] 45 %  0:05 left": one line that is rewritten, on a terminal or in a notebook."""

    def __init__(self, what):
        self.what, self.begun, self.first, self.shown, self.width = what, time.monotonic(), None, None, 0
        self.cell = None

    def __call__(self, done, of):
        now = time.monotonic()
        if self.first is None:
            self.first, self.begun = done, now
        if not of or (done < of and self.shown is not None and now - self.shown < 0.1):
            return
        self.shown = now
        left = (now - self.begun) * (of - done) / max(1, done - self.first)
        words = f"  {int(left) // 60}:{int(left) % 60:02} left" if self.first < done < of else ""
        filled = 24 * done // of
        self.show(f"{self.what} [{'#' * filled}{' ' * (24 - filled)}] {100 * done // of} %{words}")

    def show(self, line):
        if _in_notebook():
            from IPython.display import display
            self.cell = self.cell or display({"text/plain": ""}, raw=True, display_id=True)
            self.cell.update({"text/plain": line}, raw=True)
        else:
            self.width = max(self.width, len(line))
            print("\r" + line.ljust(self.width), end="", file=sys.stderr, flush=True)

    def end(self):
        if self.width:
            print(file=sys.stderr)


@contextlib.contextmanager
def shown_progress(progress, what):
    """The callback of progress that a caller asks for; None: none."""
    is_asked = progress is True or progress is None and (_in_notebook() or bool(sys.stderr and sys.stderr.isatty()))
    bar = _Bar(what) if is_asked else None
    try:
        yield bar or progress or None
    finally:
        if bar:
            bar.end()
