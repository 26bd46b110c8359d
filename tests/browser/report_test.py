#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Looks at a study's report in headless Chromium: no errors on its console, slider and zoom work.

usage: report_test.py TREEFARM STUDY.toml [SCREENSHOT.png]
Exit codes: 0 all is well, 1 it is not, 77 there is no Chromium (ctest: skipped). Speaks WebDriver by itself: nothing
but Python is needed.
"""

import base64
import json
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request

SKIPPED = 77
# Sum of the bytes of the big picture, left and right half: changes whenever the picture does.
SUMS = """
const canvas = document.querySelector('.viewer').viewer.big, context = canvas.getContext('2d');
const half = (x, w) => context.getImageData(x, 0, w, canvas.height).data.reduce((a, b) => a + b, 0);
const middle = canvas.width / 2 - 4;
return [half(0, middle), half(middle + 8, middle)];
"""
OPEN_ALL = "document.querySelectorAll('details').forEach(part => { part.open = true; });"
SET = """
const input = document.querySelector('.viewer ' + arguments[0]);
if (input.type === 'checkbox') input.checked = arguments[1]; else input.value = arguments[1];
input.dispatchEvent(new Event('input'));
"""


class Browser:
    def __init__(self, driver):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.process = subprocess.Popen([driver, f"--port={self.port}"], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        options = {"args": ["--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1200,1000"]}
        wanted = {"browserName": "chrome", "goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}
        self.base = ""
        for _ in range(100):
            try:
                answer = self.call("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})
                break
            except OSError:
                time.sleep(0.1)
        else:
            raise RuntimeError("chromedriver does not answer")
        self.base = "/session/" + answer["sessionId"]

    def call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{self.base}{path}", data, method=method,
                                         headers={"Content-Type": "application/json"})
        with urllib.request.urlopen(request, timeout=60) as answer:
            return json.load(answer)["value"]

    def run(self, script, *arguments):
        return self.call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def close(self):
        try:
            self.call("DELETE", "")
        finally:
            self.process.terminate()
            self.process.wait()


def check(truth, message):
    if not truth:
        raise AssertionError(message)


def wheel(browser):
    """A turn of the wheel over the middle of the big picture."""
    box = browser.run("const r = document.querySelector('.big canvas').getBoundingClientRect();"
                      "return [Math.round(r.x + r.width / 2), Math.round(r.y + r.height / 2)];")
    scroll = {"type": "scroll", "x": box[0], "y": box[1], "deltaX": 0, "deltaY": -500, "duration": 0}
    browser.call("POST", "/actions", {"actions": [{"type": "wheel", "id": "wheel", "actions": [scroll]}]})


def fits(browser, page):
    """The page is as wide as its window, tables scroll in their own boxes, and letters of charts can be read."""
    for width in (400, 800, 1280):
        browser.call("POST", "/goog/cdp/execute", {"cmd": "Emulation.setDeviceMetricsOverride", "params": {
            "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False}})
        browser.call("POST", "/url", {"url": "file://" + page})
        browser.run(OPEN_ALL)
        check(browser.run("return document.documentElement.scrollWidth <= innerWidth"), f"wider than {width} px")
        letters = browser.run("return Math.min(...[...document.querySelectorAll('svg text')]"
                              ".map(t => t.getBoundingClientRect().height).filter(h => h > 0))")
        check(letters >= 9, f"letters of {letters} px in charts at {width} px")
        if width == 1280:
            wide = browser.run("return [...document.querySelectorAll('.wide')].filter(d => d.scrollWidth > d.clientWidth)"
                               ".map(d => d.textContent.slice(0, 60))")
            check(not wide, f"tables are cut at {width} px: {wide}")
    browser.call("POST", "/goog/cdp/execute", {"cmd": "Emulation.clearDeviceMetricsOverride", "params": {}})


def folds(browser, page):
    """Until a reader opens more, a scene has one chart and one table of its error."""
    browser.call("POST", "/url", {"url": "file://" + page})
    shown = browser.run("return ['svg', 'table'].map(kind => [...document.querySelectorAll('h2 ~ * ' + kind)]"
                        ".filter(part => part.checkVisibility({contentVisibilityAuto: true})).length)")
    check(shown == [1, 1], f"visible charts and tables of the scene: {shown}")


def switches(browser, page):
    """One of the two clocks is shown, charts and tables alike, and the other on demand."""
    browser.call("POST", "/url", {"url": "file://" + page})
    browser.run(OPEN_ALL)
    shown = ("return ['seconds', 'core_seconds'].map(key => [...document.querySelectorAll('.of-' + key)]"
             ".filter(d => d.clientHeight > 0).length)")
    for key, at in (("seconds", 0), ("core_seconds", 1)):
        browser.run(f"document.querySelector('label[for=by-{key}]').click();")
        counts = browser.run(shown)
        check(counts[at] >= 4 and counts[1 - at] == 0, f"by {key} the page shows {counts}")
    first = browser.run("return document.querySelector('.answer').textContent")
    check("who won" in first or " won" in first, f"the page begins with {first}")


def look_at(browser, page, screenshot):
    fits(browser, page)
    folds(browser, page)
    switches(browser, page)
    browser.call("POST", "/url", {"url": "file://" + page})
    check(browser.run("return document.querySelectorAll('svg').length") >= 5, "charts are missing")
    check(browser.run("return performance.getEntriesByType('resource').length") == 0, "the page loads something")
    browser.run("document.querySelector('.viewer').scrollIntoView({block: 'start'});")
    before = browser.run(SUMS)

    browser.run(SET, "input.split", 0)
    left_of_slider = browser.run(SUMS)
    check(left_of_slider[0] != before[0], "the slider moves nothing on its left")
    check(left_of_slider[1] == before[1], "the slider changes what is on its right")
    browser.run(SET, "input.split", 0.5)
    check(browser.run(SUMS) == before, "the slider does not come back")

    wheel(browser)
    check(float(browser.run("return document.querySelector('.viewer').dataset.zoom")) > 2, "the wheel does not zoom")
    zoomed = browser.run(SUMS)
    check(zoomed != before, "zoom changes no picture")
    browser.run("document.querySelector('.viewer .reset').click();")
    check(browser.run(SUMS) == before, "the whole image does not come back")

    browser.run(SET, "input.exposure", 2)
    check(sum(browser.run(SUMS)) > sum(before), "exposure does not brighten")
    browser.run(SET, "input.exposure", 0)
    browser.run(SET, "input.errors", True)
    check(browser.run(SUMS) != before, "false colour changes nothing")
    browser.run("const s = document.querySelectorAll('.viewer select')[1]; s.value = s.options.length - 1;"
                "s.dispatchEvent(new Event('input'));")
    black = browser.run("const c = document.querySelector('.viewer').viewer.big;"
                        "return [...c.getContext('2d').getImageData(c.width - 40, 10, 30, 30).data]"
                        ".every((v, k) => k % 4 === 3 || v === 0);")
    check(black, "the reference differs from itself")
    browser.run(SET, "input.errors", False)

    if screenshot:
        with open(screenshot, "wb") as file:
            file.write(base64.b64decode(browser.call("GET", "/screenshot")))
    log = browser.call("POST", "/se/log", {"type": "browser"})
    messages = [entry for entry in log if entry["level"] == "SEVERE"]  # reading canvases back is warned of, and ours
    check(not messages, f"the console says: {messages}")


def main():
    driver = shutil.which("chromedriver")
    if driver is None or shutil.which("chromium") is None:
        print("skipped: chromium and chromedriver are not installed (deploy/install installs both)")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.argv[1], "study", sys.argv[2], "--dir", folder, "--quiet"], check=True, timeout=300)
        browser = Browser(driver)
        try:
            look_at(browser, folder + "/report.html", sys.argv[3] if len(sys.argv) > 3 else None)
        except AssertionError as problem:
            print(f"failed: {problem}")
            return 1
        finally:
            browser.close()
    print("all is well")
    return 0


if __name__ == "__main__":
    sys.exit(main())
