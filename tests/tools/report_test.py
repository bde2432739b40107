#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens a run's report.html in a real browser without a screen, works its controls, and looks at what happened.

usage: report_test.py RUN_DIR [PICTURE_DIR]     needs chromium; with PICTURE_DIR it leaves screenshots there
"""
import html
import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

RUN = PICTURES = None
PAGE_LIMIT = 10_000_000  # bytes
BROWSER = ["chromium", "--headless", "--no-sandbox", "--disable-quic", "--no-first-run",
           "--disable-background-networking", "--disable-component-update", "--disable-sync",
           "--enable-logging=stderr", "--v=0", "--host-resolver-rules=MAP * ~NOTFOUND",
           "--virtual-time-budget=8000"]
SOFTWARE_GL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]

# What a visitor does, one thing after the other; the states it leaves are read back.
VISIT = """
<script>
const states = {};
const keep = (name) => { states[name] = window.sinewState(); };
const set = (id, value, event) => {
  const control = document.getElementById(id);
  if (control.type === "checkbox") control.checked = value; else control.value = value;
  control.dispatchEvent(new Event(event));
};
function drag(from, to) {
  const canvas = document.querySelector("figure.chart canvas");
  const box = canvas.getBoundingClientRect();
  canvas.setPointerCapture = () => {};
  for (const [kind, share] of [["pointerdown", from], ["pointermove", to], ["pointerup", to]])
    canvas.dispatchEvent(new PointerEvent(kind, { button: 0, pointerId: 1,
      clientX: box.left + share * box.width, clientY: box.top + 50 }));
}
setTimeout(() => {
  try {
    keep("start");
    if (states.start.webgl) {
      const last = document.getElementById("time").max;
      set("time", Math.floor(last / 2), "input"); keep("middle");
      set("field", "0", "change"); keep("colored");
      set("cut", true, "change"); keep("cut"); set("cut", false, "change");
      document.querySelector("#worst button").click(); keep("worst");
    }
    drag(0.4, 0.7); keep("dragged");
    document.querySelector("figure.chart canvas").dispatchEvent(new Event("dblclick")); keep("whole");
    states.requests = performance.getEntriesByType("resource").map((entry) => entry.name);
    states.message = document.querySelector(".message")?.hidden === false;
    states.overflow = document.documentElement.scrollWidth - innerWidth;
  } catch (error) { states.error = String(error); }
  document.body.append(Object.assign(document.createElement("pre"),
    { id: "states", textContent: JSON.stringify(states) }));
}, 500);
</script>
"""


def browse(page, *options):
    with tempfile.TemporaryDirectory() as profile:
        return subprocess.run(BROWSER + [f"--user-data-dir={profile}", *options, page.as_uri()],
                              capture_output=True, text=True, timeout=100)


def console_errors(talk):
    return [line for line in talk.splitlines() if "CONSOLE" in line and "GL Driver Message" not in line]


def visit(*options):
    """The states the visit leaves, and what the console said."""
    page = RUN / "report_visit.html"
    page.write_text((RUN / "report.html").read_text().replace("</body>", VISIT + "</body>"))
    try:
        done = browse(page, "--dump-dom", "--window-size=1200,900", *options)
    finally:
        page.unlink()
    found = re.search(r'<pre id="states">(.*?)</pre>', done.stdout, re.DOTALL)
    assert found, done.stderr[-3000:]
    return json.loads(html.unescape(found.group(1))), console_errors(done.stderr)


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.states, cls.errors = visit(*SOFTWARE_GL)

    def test_no_error_and_nothing_asked_of_the_network(self):
        self.assertNotIn("error", self.states, self.states.get("error"))
        self.assertEqual(self.errors, [])
        for name in self.states["requests"]:
            self.assertTrue(name.startswith(RUN.as_uri()), name)

    def test_the_page_is_small_enough(self):
        self.assertLess((RUN / "report.html").stat().st_size, PAGE_LIMIT)

    def test_charts_are_there(self):
        figures = (RUN / "report.html").read_text().count('<figure class="c')
        self.assertGreaterEqual(figures, 10)
        self.assertEqual(self.states["start"]["charts"], figures)

    def test_charts_are_as_high_as_their_lines(self):
        data = json.loads(re.search(r'id="data">(.*?)</script>', (RUN / "report.html").read_text(), re.DOTALL)[1])
        for chart, (low, high) in zip(data["charts"], self.states["start"]["heights"]):
            values = [y for line in chart["lines"] for _, y in line["points"] if y is not None]
            values += chart["baselines"]
            self.assertTrue(low <= min(values) and max(values) <= high, chart["title"])
            self.assertLessEqual(high - low, max(4 * (max(values) - min(values)), 2), chart["title"])

    def test_the_slider_moves_the_particles(self):
        start, middle = self.states["start"], self.states["middle"]
        self.assertTrue(start["webgl"])
        self.assertGreater(start["points"], 0)
        self.assertNotEqual(start["snapshot"], middle["snapshot"])
        self.assertNotEqual(start["places"], middle["places"])

    def test_the_color_changes_and_the_places_do_not(self):
        middle, colored = self.states["middle"], self.states["colored"]
        self.assertNotEqual(middle["tints"], colored["tints"])
        self.assertEqual(middle["places"], colored["places"])

    def test_cutting_takes_about_half_away(self):
        xs = self.states["cut"]["places"][::3]
        gone = sum(x > 1e8 for x in xs) / len(xs)
        self.assertTrue(0.3 < gone < 0.7, gone)

    def test_the_worst_frame_is_a_click_away(self):
        self.assertNotEqual(self.states["worst"]["snapshot"], self.states["cut"]["snapshot"])

    def test_dragging_shows_a_part_of_the_time(self):
        low, high = self.states["whole"]["timeRange"]
        part_low, part_high = self.states["dragged"]["timeRange"]
        self.assertTrue(low < part_low < part_high < high, (part_low, part_high))
        self.assertEqual(self.states["whole"]["timeRange"], self.states["start"]["timeRange"])

    def test_without_webgl_the_rest_works_and_the_page_says_so(self):
        states, errors = visit("--disable-gpu", "--disable-3d-apis")
        self.assertNotIn("error", states)
        self.assertFalse(states["start"]["webgl"])
        self.assertTrue(states["message"])
        self.assertEqual(states["start"]["charts"], self.states["start"]["charts"])
        self.assertEqual(errors, [])

    def test_a_narrow_screen_needs_no_sideways_scrolling(self):
        states, _ = visit(*SOFTWARE_GL, "--window-size=500,900")
        self.assertLessEqual(states["overflow"], 0)


def take_pictures():
    """The page as wide and narrow screens show it, in light and dark."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    for shape, size in {"wide": "1400,4200", "narrow": "500,6000"}.items():
        for light, number in {"light": 1, "dark": 0}.items():
            picture = PICTURES / f"report_{shape}_{light}.png"
            browse(RUN / "report.html", *SOFTWARE_GL, f"--window-size={size}", f"--screenshot={picture}",
                   f"--blink-settings=preferredColorScheme={number}")
            print(picture)


if __name__ == "__main__":
    RUN = Path(sys.argv[1]).resolve()
    if not shutil.which("chromium"):
        sys.exit("report_test.py: chromium is not installed; apt-get install chromium")
    if len(sys.argv) > 2:
        PICTURES = Path(sys.argv[2])
        take_pictures()
    unittest.main(argv=sys.argv[:1])
