#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens a run's report.html in a real browser without a screen, works its controls, and looks at what happened.

usage: report_test.py RUN_DIR [PICTURE_DIR]     needs chromium; with PICTURE_DIR it leaves screenshots there
"""
import base64
import html
import json
import re
import shutil
import struct
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
const firstChart = () => document.querySelector("#charts canvas");
const drawn = () => new Promise((done) => setTimeout(done, 200));
/** Events at a share of the first chart's width, and of its height. */
function point(kinds, across, up) {
  const box = firstChart().getBoundingClientRect();
  firstChart().setPointerCapture = () => {};
  for (const kind of kinds)
    firstChart().dispatchEvent(new PointerEvent(kind, { button: 0, pointerId: 1,
      clientX: box.left + across * box.width, clientY: box.top + up * box.height }));
}
const click = ["pointerdown", "pointerup", "click"];
async function visit() {
  keep("start");
  states.start.controls = ["play", "scale"].map((id) => document.getElementById(id).getBoundingClientRect())
    .map((box) => box.width > 0 && box.bottom + scrollY);
  if (states.start.webgl) {
    const last = document.getElementById("time").max;
    set("time", (states.start.snapshot + Math.floor(last / 2)) % (Number(last) + 1), "input"); keep("middle");
    if (document.querySelector('#field option[value="-1"]')) set("field", "-1", "change");
    keep("named");
    set("field", "0", "change"); keep("colored");
    set("cut", true, "change"); keep("cut"); set("cut", false, "change");
    document.querySelector("#worst button").click(); keep("worst");
    point(click, 0.3, 0.4); keep("early"); point(click, 0.99, 0.4); keep("clicked");
  }
  point(["mousemove"], 0.5, 0.4); await drawn(); keep("pointed");
  point(click, 0.1, 0.04); await drawn(); keep("hidden");
  point(["pointerdown"], 0.4, 0.4); point(["pointermove", "pointerup"], 0.7, 0.4); keep("dragged");
  point(["dblclick"], 0.5, 0.4); keep("whole");
  states.requests = performance.getEntriesByType("resource").map((entry) => entry.name);
  states.message = document.querySelector(".message")?.hidden === false;
  states.overflow = document.documentElement.scrollWidth - innerWidth;
}
setTimeout(() => visit().catch((error) => { states.error = String(error); }).then(() =>
  document.body.append(Object.assign(document.createElement("pre"),
    { id: "states", textContent: JSON.stringify(states) }))), 500);
</script>
"""
# What of a page lies beyond its right edge, and how its cards and charts lie. A browser's window is at least 500
# pixels wide: a narrower page is in a frame, and tells the page around it.
NARROW = """
<script>
setTimeout(() => {
  const edge = document.documentElement.clientWidth, boxes = (query) => [...document.querySelectorAll(query)]
    .map((one) => one.getBoundingClientRect()).filter((box) => box.width > 0);
  const beyond = [...document.body.querySelectorAll("*")].filter((one) => !one.closest("table, pre, script") &&
    one.getBoundingClientRect().right > edge + 1).map((one) => `${one.tagName}.${one.className}#${one.id}`);
  parent.postMessage({ edge, beyond, overflow: document.documentElement.scrollWidth - edge,
    cards: [...document.querySelectorAll(".cards")].map((one) => [...one.children]
      .map((card) => card.getBoundingClientRect().left)), plots: boxes("#charts .plot").map((box) => [box.width, box.height]),
    stages: boxes(".stage").map((box) => [box.width, box.height]),
    tables: [...document.querySelectorAll(".scrolls")].map((one) => [one.clientWidth, one.scrollWidth]) }, "*");
}, 1500);
</script>
"""
FRAME = """<!DOCTYPE html><body style="margin: 0"><iframe src="{source}" width="{width}" height="900" style="border: 0"></iframe>
<script>
addEventListener("message", ({{ data }}) => document.body.append(Object.assign(document.createElement("pre"),
  {{ id: "states", textContent: JSON.stringify(data) }})));
</script>"""
# A browser that only dumps its page paints too seldom: the page's frames come by the clock.
FRAMES = "<script>window.requestAnimationFrame = (job) => setTimeout(() => job(performance.now()), 16);</script>"
PLAYBACK = re.compile(r'(?<=id="playback">).*?(?=</script>)', re.DOTALL)
DATA = re.compile(r'(?<=id="data">).*?(?=</script>)', re.DOTALL)


def browse(page, *options):
    with tempfile.TemporaryDirectory() as profile:
        return subprocess.run(BROWSER + [f"--user-data-dir={profile}", *options, page.as_uri()],
                              capture_output=True, text=True, timeout=400)


def console_errors(talk):
    return [line for line in talk.splitlines() if "CONSOLE" in line and "GL Driver Message" not in line]


def data_of(text):
    return json.loads(DATA.search(text)[0])


def visit(*options, change=None):
    """The states the visit leaves, and what the console said. change: of the charts' data beforehand."""
    page = RUN / "report_visit.html"
    text = (RUN / "report.html").read_text()
    if change:
        data = data_of(text)
        change(data)
        text = DATA.sub(lambda _: json.dumps(data).replace("<", "\\u003c"), text)
    page.write_text(text.replace("<head>", "<head>" + FRAMES).replace("</body>", VISIT + "</body>"))
    try:
        done = browse(page, "--dump-dom", "--window-size=1280,900", *options)
    finally:
        page.unlink()
    found = re.search(r'<pre id="states">(.*?)</pre>', done.stdout, re.DOTALL)
    assert found, done.stderr[-3000:]
    return json.loads(html.unescape(found.group(1))), console_errors(done.stderr)


def framed(width):
    """How the page lies in a frame of that width, in pixels; without WebGL, which takes a frame long to begin."""
    inner, outer = RUN / "report_inner.html", RUN / "report_framed.html"
    inner.write_text((RUN / "report.html").read_text().replace("<head>", "<head>" + FRAMES)
                     .replace("</body>", NARROW + "</body>"))
    outer.write_text(FRAME.format(source=inner.name, width=width))
    try:
        done = browse(outer, "--dump-dom", "--hide-scrollbars", "--disable-gpu", "--disable-3d-apis")
    finally:
        inner.unlink()
        outer.unlink()
    found = re.search(r'<pre id="states">(.*?)</pre>', done.stdout, re.DOTALL)
    assert found, done.stderr[-3000:]
    return json.loads(html.unescape(found.group(1)))


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
        data = data_of((RUN / "report.html").read_text())
        self.assertGreaterEqual(len(data["charts"]), 10)
        self.assertEqual(self.states["start"]["charts"], len(data["charts"]) + len(data["curves"]))

    def test_charts_are_as_high_as_their_lines_and_show_their_baselines(self):
        data = data_of((RUN / "report.html").read_text())
        for chart, (low, high) in zip(data["charts"], self.states["start"]["heights"]):
            values = [y for line in chart["lines"] for _, y in line["points"] if y is not None]
            values += chart["baselines"]
            self.assertTrue(low <= min(values) and max(values) <= high, chart["title"])
            self.assertLessEqual(high - low, max(4 * (max(values) - min(values)), 2, 1.5 * chart["span"]), chart["title"])

    def test_trifles_are_folded_away_and_come_last(self):
        folded = [chart["folded"] for chart in data_of((RUN / "report.html").read_text())["charts"]]
        self.assertEqual(folded, sorted(folded))
        self.assertFalse(folded[0])

    def test_ticks_can_be_told_apart_and_have_as_many_decimals(self):
        for ticks in self.states["start"]["ticks"]:
            self.assertGreaterEqual(len(ticks), 2)
            self.assertEqual(len(set(ticks)), len(ticks), ticks)
            decimals = {len(tick.split("e")[0].partition(".")[2]) for tick in ticks if tick != "0"}
            self.assertEqual(len(decimals), 1, ticks)

    def test_the_strip_of_angles_is_as_high_as_the_largest(self):
        angles = [angle for _, angle in data_of((RUN / "report.html").read_text())["angles"]]
        if angles:
            self.assertGreater(max(angles), 0)
        for ticks in self.states["start"]["angleTicks"]:
            self.assertEqual(ticks, [f"bones {float(f'{max(angles):.4g}'):g}°"] if angles else None)

    def test_gaps_stay_gaps_and_what_is_flat_looks_flat(self):
        def change(data):
            gap, flat = data["charts"][0]["lines"][0]["points"], data["charts"][1]
            for point in gap[3:5]:
                point[1] = None
            flat["baselines"] = []
            for line in flat["lines"]:
                for i, point in enumerate(line["points"]):
                    point[1] = 2e5 + 1e-6 * (i % 2)
        states, errors = visit("--disable-gpu", "--disable-3d-apis", change=change)
        self.assertEqual(errors, [])
        self.assertEqual(self.states["start"]["gaps"][0], 0)
        self.assertEqual(states["start"]["gaps"][0], 2)
        low, high = states["start"]["heights"][1]
        self.assertGreaterEqual(high - low, 199)
        self.assertTrue(low < 2e5 < high, (low, high))
        self.assertEqual(len(set(states["start"]["ticks"][1])), len(states["start"]["ticks"][1]))

    def test_the_pointer_shows_the_values_of_one_time(self):
        chart = data_of((RUN / "report.html").read_text())["charts"][0]
        pointed = self.states["pointed"]["pointed"]
        times = {time for _, time, _ in pointed}
        self.assertEqual(len(times), 1, pointed)
        low, high = self.states["start"]["timeRange"]
        self.assertTrue(low + 0.3 * (high - low) < times.pop() < low + 0.7 * (high - low), pointed)
        held = {(line["name"], *point) for line in chart["lines"] for point in line["points"]}
        values = [tuple(value) for value in pointed if value[0] != "bones"]
        self.assertEqual(len(values), len(chart["lines"]))
        self.assertLessEqual(set(values), held)

    def test_a_click_leads_to_its_time_but_one_on_a_name_hides_its_line(self):
        self.assertNotEqual(self.states["clicked"]["snapshot"], self.states["early"]["snapshot"])
        self.assertFalse(self.states["pointed"]["hidden"])
        self.assertTrue(self.states["hidden"]["hidden"])
        self.assertEqual(self.states["hidden"]["snapshot"], self.states["clicked"]["snapshot"])

    def test_the_slider_moves_the_particles(self):
        start, middle = self.states["start"], self.states["middle"]
        self.assertTrue(start["webgl"])
        self.assertNotEqual(start["snapshot"], middle["snapshot"])
        self.assertNotEqual(start["places"], middle["places"])

    def test_the_color_changes_and_the_places_do_not(self):
        middle, colored = self.states["named"], self.states["colored"]
        self.assertNotEqual(middle["tints"], colored["tints"])
        self.assertEqual(middle["places"], colored["places"])

    def test_particles_have_the_color_of_their_bones_name(self):
        packed = json.loads(PLAYBACK.search((RUN / "report.html").read_text())[0])
        bones = [bone for bone, in struct.iter_unpack("<h", base64.b64decode(packed["bone"]))]
        tints, colors = self.states["named"]["tints"], {}
        if self.states["named"]["field"] is None:
            for i, bone in enumerate(bones):
                name = packed["boneNames"][bone] if bone >= 0 else None
                colors.setdefault(name, set()).add(tuple(tints[3 * i:3 * i + 3]))
        self.assertTrue(all(len(some) == 1 for some in colors.values()), colors)
        self.assertEqual(self.states["named"]["legend"], list(dict.fromkeys(packed["boneNames"])))

    def test_the_motion_plays_by_itself_until_the_reader_looks_for_a_moment(self):
        start = self.states["start"]
        self.assertEqual(start["field"], "strain")
        self.assertTrue(start["playing"])
        self.assertGreater(start["triangles"], 0)  # the skin
        self.assertFalse(self.states["middle"]["playing"])

    def test_cutting_takes_about_half_of_the_skin_away_and_shows_the_layer_behind_it(self):
        """Particles deeper than the layer are within the skin that is left."""
        xs = self.states["cut"]["places"][::3]
        gone = sum(x > 1e8 for x in xs) / len(xs)
        self.assertTrue(0.3 < gone < 0.95, gone)
        whole, cut = self.states["colored"]["corners"], self.states["cut"]["corners"]
        self.assertTrue(0.25 < cut / whole < 0.75, (cut, whole))

    def test_the_skin_has_the_colors_of_the_particles_beside_it(self):
        """Means of the colors of the scale: no part is darker or lighter than the particles' extremes."""
        middle = self.states["middle"]
        for part in range(3):
            tints, skin = middle["tints"][part::3], middle["skin"][part::3]
            self.assertGreaterEqual(min(skin), min(tints) - 0.02)
            self.assertLessEqual(max(skin), max(tints) + 0.02)
        self.assertNotEqual(middle["skin"], self.states["named"]["skin"])
        self.assertGreater(len(set(middle["skin"])), 1)

    def test_play_and_colors_are_above_the_fold_of_a_desk(self):
        for bottom in self.states["start"]["controls"]:
            self.assertTrue(0 < bottom < 900, self.states["start"]["controls"])

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

    def test_on_a_phone_nothing_overflows_and_cards_form_one_column(self):
        page = framed(420)
        self.assertEqual(page["edge"], 420)
        self.assertLessEqual(page["overflow"], 0)
        self.assertEqual(page["beyond"], [])
        for lefts in page["cards"]:
            self.assertEqual(len(set(lefts)), 1)
        for width, height in page["plots"]:
            self.assertGreater(width, 340)
            self.assertGreater(height, 200)
        for width, _ in page["stages"]:
            self.assertGreater(width, 340)
        self.assertTrue(any(inner > outer for outer, inner in page["tables"]))  # they scroll within themselves

    def test_on_a_desk_no_row_of_cards_or_charts_is_half_empty(self):
        page = framed(1400)
        self.assertEqual(page["beyond"], [])
        for lefts in page["cards"]:
            self.assertEqual(len(set(lefts)), len(lefts))  # one row
        widths = [width for width, _ in page["plots"]]
        self.assertTrue(all(abs(width - widths[0]) < 2 for width in widths[:-1]), widths)
        self.assertEqual(widths[-1] > 1.5 * widths[0], len(widths) % 2 == 1 and len(widths) > 1, widths)

    def test_the_scale_of_colors_says_which_percentiles_it_ends_at(self):
        self.assertRegex(self.states["start"]["scale"], r"\(0\.5th to 99\.5th percentile\)")

    def test_every_metric_is_in_a_table_that_is_open_and_can_be_folded(self):
        text = (RUN / "report.html").read_text()
        part = re.search(r'<details class="part" open>(.*?)</details>', text, re.DOTALL)[1]
        self.assertGreater(part.count("<tr>"), 30)


def take_pictures():
    """The page as wide and narrow screens show it, and as it prints."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    page = RUN / "report.html"
    for shape, size in {"wide": "1200,4200", "narrow": "420,6000"}.items():
        browse(page, *SOFTWARE_GL, f"--window-size={size}", f"--screenshot={PICTURES}/report_{shape}.png")
    browse(page, *SOFTWARE_GL, f"--print-to-pdf={PICTURES}/report.pdf")
    print(PICTURES)


if __name__ == "__main__":
    RUN = Path(sys.argv[1]).resolve()
    if not shutil.which("chromium"):
        sys.exit("report_test.py: chromium is not installed; apt-get install chromium")
    if len(sys.argv) > 2:
        PICTURES = Path(sys.argv[2])
        take_pictures()
    unittest.main(argv=sys.argv[:1])
