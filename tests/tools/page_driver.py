# SPDX-License-Identifier: GPL-3.0-or-later
"""A browser without a screen, driven by WebDriver (chromedriver): real pointer events, scripts, pictures."""
import base64
import json
import re
import subprocess
import urllib.request

OPTIONS = ["--headless=new", "--no-sandbox", "--no-first-run", "--disable-background-networking", "--disable-component-update",
           "--disable-sync", "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1, EXCLUDE localhost"]
SOFTWARE_GL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


class Browser:
    def __init__(self, width=1400, height=900, webgl=True):
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, text=True)
        for line in self.driver.stdout:
            if found := re.search(r"successfully on port (\d+)", line):
                self.address = f"http://127.0.0.1:{found[1]}/session"
                break
        gl = SOFTWARE_GL if webgl else ["--disable-gpu", "--disable-3d-apis"]
        words = [*OPTIONS, *gl, f"--window-size={width},{height}"]
        options = {"goog:chromeOptions": {"args": words}, "goog:loggingPrefs": {"browser": "ALL"}}
        try:
            session = self._ask("", {"capabilities": {"alwaysMatch": {"browserName": "chrome", **options}}})["sessionId"]
        except BaseException:
            self.driver.kill()
            raise
        self.address += "/" + session
        self._ask("/timeouts", {"script": 120_000})
        self.resize(width, height)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self._ask("", method="DELETE")
        finally:
            self.driver.kill()
            self.driver.wait()
            self.driver.stdout.close()

    def _ask(self, path, body=None, method=None):
        data = json.dumps(body).encode() if body is not None else None
        request = urllib.request.Request(self.address + path, data, {"Content-Type": "application/json"},
                                         method=method or ("POST" if data else "GET"))
        try:
            with urllib.request.urlopen(request, timeout=180) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            told = json.load(error)["value"]
            raise AssertionError(f"{told['error']}: {told['message'].splitlines()[0]}") from None

    def resize(self, width, height):
        """Of the page itself; windows are no narrower than 500 pixels."""
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self._ask("/goog/cdp/execute", {"cmd": "Emulation.setDeviceMetricsOverride", "params": metrics})

    def open(self, address):
        self._ask("/url", {"url": address})

    def run(self, script, *values):
        """The value of an expression that may be a promise; its error is raised."""
        wrapped = ("const done = arguments[arguments.length - 1], values = [...arguments].slice(0, -1);"
                   f"(async () => ({script}))().then((value) => done([value ?? null]), (error) => done([null, String(error)]));")
        value, *error = self._ask("/execute/async", {"script": wrapped, "args": list(values)})
        if error:
            raise RuntimeError(error[0])
        return value

    def drag(self, way, keys="", seconds=0.5, release=True):
        """Presses at the first place of the window (pixels), moves along the others, and releases, unless it holds."""
        (x, y), *rest = way
        move = lambda x, y, ms: {"type": "pointerMove", "duration": ms, "x": round(x), "y": round(y)}
        each = int(1000 * seconds / max(len(rest), 1))
        pointer = [move(x, y, 0), {"type": "pointerDown", "button": 0}, *(move(*to, each) for to in rest),
                   {"type": "pointerUp", "button": 0}]
        actions = [{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": pointer}]
        if keys:
            wait = [{"type": "pause"}] * (len(pointer) - 1)
            actions.append({"type": "key", "id": "keys", "actions": [{"type": "keyDown", "value": keys}, *wait,
                                                                     {"type": "keyUp", "value": keys}]})
        if not release:
            pointer.pop()
        self._ask("/actions", {"actions": actions})
        if release:
            self._ask("/actions", method="DELETE")

    def picture(self, path):
        path.write_bytes(base64.b64decode(self._ask("/screenshot")))

    def errors(self):
        """What the console says that is no note of the graphics driver."""
        return [one["message"] for one in self._ask("/se/log", {"type": "browser"})
                if one["level"] in ("SEVERE", "WARNING") and "GL Driver Message" not in one["message"]
                and "GPU stall" not in one["message"]]
