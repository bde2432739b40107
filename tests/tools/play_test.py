#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses a body in a real browser without a screen: the recording runs to the same bits, nobody else gets in, nothing is
lost.

usage: play_test.py BIN SOURCE [PICTURE_DIR]     needs chromium-driver; with PICTURE_DIR it leaves screenshots there
"""
import base64
import contextlib
import json
import os
import random
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PICTURES = Path(sys.argv.pop(3)) if len(sys.argv) > 3 and Path(sys.argv[3]).is_dir() else None

from page_driver import Browser  # noqa: E402
from small_run import BIN, SOURCE, sinew  # noqa: E402

needs_browser = unittest.skipUnless(shutil.which("chromedriver"), "chromium-driver is not installed: "
                                     "tools/install_packages.sh test")
SCENE = f"""
body: {{mesh: {SOURCE}/data/meshes/box.obj, radius: 0.02}}
material: {{model: bonded, damping_ratio: 0.1}}
skeleton:
  bones:
    - {{name: lower, head: [0, 0, 0], tail: [0, 0, 0.34648232]}}
    - {{name: upper, parent: lower, tail: [0, 0, 0.69296465]}}
loads: [{{name: tip, force: [0.2, 0, 0], low: [-1, -1, 0.6], high: [1, 1, 1]}}]
output: {{interval: 0.1}}
"""


class Played:
    """sinew play of a scene at work."""

    def __init__(self, scene, folder, *words):
        self.folder = folder
        self.errors = open(folder.parent / "errors.txt", "w+")
        self.program = subprocess.Popen([BIN / "sinew", "play", scene, "-o", folder, "--no-browser", *words],
                                        stdout=subprocess.PIPE, stderr=self.errors, text=True)
        line = self.program.stdout.readline()
        found = re.fullmatch(r"address: (http://127\.0\.0\.1:(\d+)/#([A-Za-z0-9_-]{32}))\n", line)
        if not found:
            self.errors.seek(0)
            raise AssertionError(line + self.errors.read())
        self.address, self.port, self.token = found[1], int(found[2]), found[3]

    def end(self, by=signal.SIGINT):
        self.program.send_signal(by)
        code = self.program.wait(timeout=30)
        self.program.stdout.close()
        self.errors.close()
        return code


class Client:
    """A WebSocket of our own, to say what a browser would not. Raises ConnectionError where it is not let in."""

    def __init__(self, port, path, **headers):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=20)
        fields = {"Host": f"127.0.0.1:{port}", "Origin": f"http://127.0.0.1:{port}", "Upgrade": "websocket",
                  "Connection": "Upgrade", "Sec-WebSocket-Key": base64.b64encode(os.urandom(16)).decode(),
                  "Sec-WebSocket-Version": "13", **{key.replace("_", "-"): value for key, value in headers.items()}}
        lines = [f"GET {path} HTTP/1.1", *(f"{key}: {value}" for key, value in fields.items() if value), "", ""]
        self.socket.sendall("\r\n".join(lines).encode())
        self.stream = self.socket.makefile("rb")
        self.status = int(self.stream.readline().split()[1])
        while self.stream.readline().strip():
            pass
        if self.status != 101:
            self.close()
            raise ConnectionError(self.status)

    def close(self):
        self.stream.close()
        self.socket.close()

    def send(self, message, kind=1, length=None):
        data = message.encode() if isinstance(message, str) else message
        size = len(data) if length is None else length
        head = bytes([128 | kind]) + (bytes([128 | size]) if size < 126 else
                                      struct.pack(">BH", 254, size) if size < 65536 else struct.pack(">BQ", 255, size))
        self.socket.sendall(head + bytes(4) + data)

    def read(self):
        """Kind and bytes of the next frame of the protocol."""
        first, second = self.stream.read(2)
        size = second & 127
        if size >= 126:
            size = int.from_bytes(self.stream.read(2 if size == 126 else 8), "big")
        return first & 15, self.stream.read(size)

    def answer(self, message):
        self.send(json.dumps({**message, "id": 1}))
        while True:
            kind, data = self.read()
            if kind == 1 and (told := json.loads(data)).get("id") == 1:
                return told


class Plays(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.root = Path(self.temporary.name)
        self.scene = self.root / "scene.yaml"
        self.scene.write_text(SCENE)
        self.played = Played(self.scene, self.root / "out")

    def tearDown(self):
        if self.played.program.poll() is None:
            self.played.program.kill()
            self.played.end()
        self.temporary.cleanup()

    def client(self, **headers):
        client = Client(self.played.port, f"/live?token={self.played.token}", **headers)
        self.addCleanup(client.close)
        return client

    def hash_of_run(self, scene, threads):
        out = self.root / f"run_{scene.stem}_{threads}"
        sinew("simulate", scene, "-o", out, "--threads", threads, check=0)
        return json.loads((out / "run.json").read_text())["state_hash"]

    @needs_browser
    def test_what_a_hand_did_runs_to_the_same_bits(self):
        with Browser() as page:
            page.open(self.played.address)
            page.run("sinew.ready")
            self.assertEqual(page.run("sinew.bones()"), ["lower", "upper"])
            page.run("sinew.rotate('upper', [0, 1, 0], 40)")
            where = """(() => { const [x, y] = pixelsOf(live.view, live.view.handles[2].position);
                       const box = byId('stage').getBoundingClientRect(); return [x + box.left, y + box.top]; })()"""
            x, y = page.run(where)
            before = page.run("[...live.view.playback.bones]")
            page.drag([(x, y), (x - 60, y + 40), (x - 120, y + 100)])
            time.sleep(1.5)
            after = page.run("[...live.view.playback.bones]")
            self.assertGreater(max(abs(a - b) for a, b in zip(before, after)), 0.05)
            middle = page.run("""(() => { const [x, y] = pixelsOf(live.view, new THREE.Vector3().fromArray(live.view.playback.surface, 0));
                              return [x, y]; })()""")
            self.assertEqual(len(middle), 2)
            page.run("sinew.pull(40, [0.05, 0, 0])")
            page.run("sinew.set('solver.gravity', [0, 0, -2])")
            page.run("sinew.set('tip', 1.5)")
            time.sleep(1)
            if PICTURES:
                page.picture(PICTURES / "play.png")
            page.run("sinew.pull(40, null)")
            page.run("sinew.rewind(0.6)")
            page.run("sinew.rotate(0, [1, 0, 0], -20)")
            with self.assertRaisesRegex(RuntimeError, "no bone|nearest|take"):
                page.run("sinew.rotate('hand', [1, 0, 0], 20)")
            page.run("sinew.save('take_1')")
            state = page.run("sinew.state()")
            time.sleep(0.5)
            self.assertEqual(page.run("sinew.state()"), state)
            self.assertEqual(page.errors(), [])
        self.assertEqual(self.played.end(), 0)
        for threads in (1, 2):
            self.assertEqual(self.hash_of_run(self.root / "out/take_1.yaml", threads), state["hash"])

    @needs_browser
    def test_without_webgl_scripts_still_pose(self):
        with Browser(420, 900, webgl=False) as page:
            page.open(self.played.address)
            page.run("sinew.ready")
            page.run("sinew.rotate('upper', [0, 1, 0], 10)")
            page.run("sinew.save('blind')")
            self.assertLessEqual(page.run("document.documentElement.scrollWidth - innerWidth"), 0)
            state = page.run("sinew.state()")
        self.assertEqual(self.hash_of_run(self.root / "out/blind.yaml", 2), state["hash"])

    def test_killed_the_recording_is_on_disk(self):
        client = self.client()
        client.send(json.dumps({"do": "turn", "bone": "upper", "axis": [0, 1, 0], "degrees": 60}))
        time.sleep(3)
        went = client.answer({"do": "rewind", "seconds": 0})["time"]
        client.send(json.dumps({"do": "seek", "time": 0.3}))  # whatever is looked at
        time.sleep(1.5)
        self.assertEqual(self.played.end(signal.SIGKILL), -9)
        self.assertGreater(len((self.root / "out/session.keys.csv").read_text().splitlines()), 60)
        out = self.root / "run"
        sinew("simulate", self.root / "out/session.yaml", "-o", out, check=0)
        times = json.loads((out / "run.json").read_text())
        self.assertEqual(times["status"], "finished")
        self.assertGreater(times["steps"] * times["time_step"], went - 1.2)
        again = Played(self.scene, self.root / "out")  # the older recording is kept
        again.end()
        self.assertTrue((self.root / "out/session_2.yaml").exists())

    def test_nobody_else_gets_in(self):
        port, token = self.played.port, self.played.token
        wrong = [("/live?token=" + "0" * 32, {}), ("/live", {}), (f"/live?token={token}x", {}), (f"/?token={token}", {}),
                 (f"/live?token={token}", {"Origin": "http://example.org"}), (f"/live?token={token}", {"Origin": ""}),
                 (f"/live?token={token}", {"Origin": "null"}), (f"/live?token={token}", {"Host": f"example.org:{port}"}),
                 (f"/live?token={token}", {"Host": f"example.org:{port}", "Origin": f"http://example.org:{port}"})]
        for path, headers in wrong:
            with self.subTest(path=path, headers=headers), self.assertRaises(ConnectionError) as raised:
                Client(port, path, **headers)
            self.assertEqual(raised.exception.args[0], 403)
        with socket.create_connection(("127.0.0.1", port)) as plain:
            plain.sendall(f"GET /etc/passwd HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
            self.assertIn(b"404", plain.recv(1000))
        with self.assertRaises(OSError):
            socket.create_connection(("127.0.0.2", port), timeout=2)

    def test_a_second_page_takes_over_after_asking(self):
        first = self.client()
        second = self.client()
        self.assertEqual(json.loads(second.read()[1]), {"busy": True})
        third = Client(self.played.port, f"/live?token={self.played.token}&take=1")
        self.addCleanup(third.close)
        while (told := first.read()) != (1, b'{"taken":true}'):
            self.assertNotEqual(told[0], 8)
        self.assertTrue(third.answer({"do": "rewind", "seconds": 1})["done"])

    def test_wrong_messages_are_refused_and_survived(self):
        client = self.client()
        for wrong in ({}, {"do": "fly"}, {"do": "turn"}, {"do": "turn", "bone": 9, "axis": [0, 0, 1], "degrees": 1},
                      {"do": "turn", "bone": -1, "axis": [0, 0, 1], "degrees": 1}, {"do": "aim", "bone": 0, "to": [1]},
                      {"do": "turn", "bone": 0, "axis": [0, 0, 0], "degrees": 1}, {"do": "move", "bone": 1, "to": [0, 0, 0]},
                      {"do": "pull", "particle": 10 ** 9, "to": [0, 0, 0]}, {"do": "pull", "particle": -1, "to": [0, 0, 0]},
                      {"do": "pull", "particle": 1, "to": [1e300, 0, 0]}, {"do": "pull", "particle": 1, "to": [0, 0, 0], "stiffness": 1e9},
                      {"do": "set", "key": "body.mesh", "value": "/etc/passwd"}, {"do": "set", "key": "none", "value": 1},
                      {"do": "set", "key": "material.young_modulus", "value": -1}, {"do": "set", "key": "tip", "value": "x"},
                      {"do": "save", "name": "../x"}, {"do": "save", "name": "session"}, {"do": "save", "name": ""}, {"do": "save", "name": 3}, {"do": "pace", "value": 0},
                      {"do": "show", "field": 7}, {"do": ["x"]}, {"do": "rewind", "seconds": "x"}):
            with self.subTest(wrong=wrong):
                self.assertIn("failed", client.answer(wrong))
        for text in ("", "x", "[1]", "[" * 5000, '"' + "\\u0000" * 100 + '"', "\x00" * 10):
            client.send(text)
        self.assertTrue(client.answer({"do": "rewind", "seconds": 0})["done"])
        client.send("x" * 17_000)  # larger than any message
        with self.assertRaises((ConnectionError, TypeError, ValueError)):
            while client.read()[0] != 8:
                pass
            raise ConnectionError
        silent = self.client()  # never reads
        with contextlib.suppress(ConnectionError):  # it is left
            for _ in range(3000):
                silent.send(json.dumps({"do": "fly", "id": 1}))
        self.assertIsNone(self.played.program.poll())
        self.assertFalse((self.root / "x.yaml").exists())

    def test_random_messages_are_survived(self):
        client, chance = self.client(), random.Random(7)
        seeds = [{"do": "turn", "bone": 1, "axis": [0, 1, 0], "degrees": 10}, {"do": "pull", "particle": 3, "to": [0.1, 0, 0.2]},
                 {"do": "aim", "bone": 0, "to": [1, 0, 1]}, {"do": "set", "key": "tip", "value": 2}, {"do": "seek", "time": 0.1},
                 {"do": "show", "field": "J", "particles": True}, {"do": "reach", "bone": 1, "to": [0, 1, 1]}, {"do": "grab", "bone": 1},
                 {"do": "set", "key": "solver.gravity", "value": [0, 0, -1]}, {"do": "save", "name": "x"}, {"do": "undo"},
                 {"do": "play"}, {"do": "reset"}, {"do": "step"}, {"do": "pace", "value": 0.5}, {"do": "rewind", "seconds": 0.3}]
        odd = [None, -1, 1e308, 10 ** 30, "", "x" * 300, [], {}, [[]], True, 0.1, "\u0000", [1, 2], {"a": 1}, -0.0]
        for _ in range(1500):
            message = json.loads(json.dumps(chance.choice(seeds)))
            if chance.random() < 0.6:
                key = chance.choice([*message, "id", "relative", "stiffness", "settings"])
                message[key] = chance.choice([*odd, *(value for seed in seeds for value in seed.values())])
            text = json.dumps(message)
            if chance.random() < 0.2:
                at = chance.randrange(len(text))
                text = text[:at] + chance.choice(["", "\"", "}", "\\", "9"]) + text[at + chance.randrange(3):]
            client.send(chance.choice(["more", text, text]))
            client.socket.settimeout(0.001)
            try:
                while client.socket.recv(1 << 20):
                    pass
            except (TimeoutError, BlockingIOError):
                pass
        client.socket.settimeout(20)
        again = Client(self.played.port, f"/live?token={self.played.token}&take=1")
        self.addCleanup(again.close)
        self.assertTrue(again.answer({"do": "rewind", "seconds": 0})["done"])
        self.assertEqual(sorted({one.suffix for one in (self.root / "out").glob("[!.]*")}), [".csv", ".yaml"])

    def test_other_settings_begin_anew_in_the_same_pose(self):
        client = self.client()
        client.answer({"do": "turn", "bone": "upper", "axis": [0, 1, 0], "degrees": 30})
        self.assertEqual(client.answer({"do": "set", "key": "material.young_modulus", "value": 20000}),
                         {"done": True, "began_anew": True, "id": 1})
        time.sleep(1)
        saved = client.answer({"do": "save", "name": "stiff"})
        self.assertIn("young_modulus: 20000", (self.root / "out/stiff.yaml").read_text())
        self.assertEqual(self.hash_of_run(self.root / "out/stiff.yaml", 1), saved["hash"])

    def test_scenes_that_cannot_be_played_are_refused(self):
        for more, words in (("solver: {method: static}", "solver.method to dynamic"),
                            ("hierarchy: {enabled: true}\nmaterial: {model: bonded}", "hierarchy.enabled to false")):
            scene = self.root / "refused.yaml"
            scene.write_text(re.sub("material:.*\n", "", SCENE) + more)
            done = sinew("play", scene, "-o", self.root / "refused", "--no-browser")
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)
        taken = sinew("play", self.scene, "-o", self.root / "taken", "--no-browser", "--port", self.played.port)
        self.assertEqual(taken.returncode, 4, taken.stderr)
        self.assertIn("--port", taken.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
