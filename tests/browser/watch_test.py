#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Looks at a running farm through treefarm serve: by HTTP, and in headless Chromium at desktop and phone width.

usage: watch_test.py TREEFARM SCENE.xml [FOLDER_FOR_SCREENSHOTS]
Exit codes: 0 all is well, 1 it is not, 77 there is no Chromium or no mpirun (ctest: skipped), the rest is well.
"""

import base64
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import urllib.error
import urllib.request

from report_test import SKIPPED, Browser, check

PATIENCE = 90  # seconds; nothing is measured by it
DESKTOP, PHONE = 1280, 360
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_oob_tcp_if_include": "lo",
       "OMPI_MCA_btl_tcp_if_include": "lo", "OMPI_MCA_mpi_yield_when_idle": "1"}


def wait_for(condition, what):
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        found = condition()
        if found:
            return found
        time.sleep(0.1)
    raise AssertionError(f"in {PATIENCE} s not seen: {what}")


class Server:
    """A `treefarm serve` that says its URL."""

    def __init__(self, program, *arguments):
        self.process = subprocess.Popen([program, "serve", *arguments], stdout=subprocess.PIPE, text=True)
        line = self.process.stdout.readline()
        found = re.search(r"http://([^/]+)(/\S*)", line)
        check(found, f"treefarm serve says {line!r}")
        self.port = int(found[1].rsplit(":", 1)[1])
        self.query = found[2]

    def url(self, path="/"):
        return f"http://127.0.0.1:{self.port}{path}"

    def ask(self, path, method="GET", headers=None):
        """Status, headers and body of a response."""
        request = urllib.request.Request(self.url(path), method=method, headers=headers or {})
        try:
            with urllib.request.urlopen(request, timeout=30) as answer:
                return answer.status, answer.headers, answer.read()
        except urllib.error.HTTPError as error:
            return error.code, error.headers, error.read()

    def end(self):
        self.process.send_signal(signal.SIGINT)
        check(self.process.wait(30) == 0, f"treefarm serve ends with {self.process.returncode}")


class Viewer(threading.Thread):
    """Takes a connection as tev does, and takes its packets apart: length, operation, name."""

    def __init__(self):
        super().__init__(daemon=True)
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.operations = []
        self.wrong = ""

    def run(self):
        stream = self.listener.accept()[0].makefile("rb")
        while head := stream.read(4):
            packet = stream.read(int.from_bytes(head, "little") - 4)
            if len(packet) < 3 or packet[0] not in (4, 6) or not packet[2:].startswith(b"treefarm run\0"):
                self.wrong = f"packet {packet[:40]}"
                return
            self.operations.append(packet[0])


def rank_process(mpirun, rank):
    children = pathlib.Path(f"/proc/{mpirun}/task/{mpirun}/children").read_text().split()
    for child in children:
        if f"OMPI_COMM_WORLD_RANK={rank}".encode() in pathlib.Path(f"/proc/{child}/environ").read_bytes().split(b"\0"):
            return int(child)
    return 0


def check_metrics(text):
    """Each line is a comment or a sample; python3-prometheus-client reads all of them, where it is installed."""
    check("treefarm_run_state" in text and "treefarm_worker_up" in text, "metrics are missing")
    for line in text.splitlines():
        check(re.fullmatch(r'# (HELP|TYPE) \w+ .+|\w+\{(\w+="([^"\\]|\\["\\n])*",?)*\} [-+.0-9e]+', line), f"metrics: {line}")
    try:
        from prometheus_client.parser import text_string_to_metric_families
    except ImportError:
        print("python3-prometheus-client is not installed: metrics are read by this test's own pattern alone")
        return
    check(len(list(text_string_to_metric_families(text))) > 8, "prometheus_client reads too few families")


def check_http(program, server):
    answer = json.loads(wait_for(lambda: server.ask("/status.json")[2], "an answer"))
    check(answer["kind"] == "runs", f"the list is {answer}")
    wait_for(lambda: json.loads(server.ask("/status.json")[2])["runs"], "the run in the list")
    wait_for(lambda: (json.loads(server.ask("/status.json?run=run")[2]).get("farm") or {}).get("workers"), "workers")
    status, headers, body = server.ask("/metrics")
    check(status == 200 and headers["Content-Type"].startswith("text/plain; version=0.0.4"), f"metrics: {headers}")
    check_metrics(body.decode())
    status, headers, body = server.ask("/", "HEAD")
    check(status == 200 and body == b"", "HEAD has a body")
    check("default-src 'none'" in headers["Content-Security-Policy"], "no policy for the page's content")
    check(server.ask("/", "POST")[0] == 405, "POST is answered")
    for path in ("/status.json?run=../run", "/preview.png?run=..%2f..%2fetc", "/../etc/passwd", "/run/preview.png"):
        check(server.ask(path)[0] in (400, 404), f"{path} is answered")
    check(server.ask("/", headers={"Host": "evil.example"})[0] == 403, "a foreign name is answered")
    second = subprocess.run([program, "serve", ".", "--port", str(server.port)], capture_output=True, text=True, timeout=60)
    check(second.returncode == 2 and "in use" in second.stderr and second.stderr.count("\n") == 1, f"a taken port: {second}")


def set_width(browser, width, dark=False):
    browser.call("POST", "/goog/cdp/execute", {"cmd": "Emulation.setDeviceMetricsOverride", "params": {
        "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width == PHONE}})
    browser.call("POST", "/goog/cdp/execute", {"cmd": "Emulation.setEmulatedMedia", "params": {
        "features": [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]}})


def screenshot(browser, folder, name):
    if folder:
        picture = browser.call("POST", "/goog/cdp/execute", {"cmd": "Page.captureScreenshot", "params": {
            "captureBeyondViewport": True}})["data"]
        pathlib.Path(folder, name + ".png").write_bytes(base64.b64decode(picture))


def check_fit(browser, url, name, folder):
    for width, dark in ((DESKTOP, False), (DESKTOP, True), (PHONE, False), (PHONE, True)):
        set_width(browser, width, dark)
        browser.call("POST", "/url", {"url": url})
        wait_for(lambda: browser.run("return document.querySelector('progress') && document.querySelector('img')"
                                     " && document.querySelector('img').complete"), "the page's picture")
        wide = browser.run("return [document.documentElement.scrollWidth, innerWidth]")
        check(wide[0] <= wide[1], f"{name} is {wide[0]} px wide in a window of {wide[1]}")
        small = browser.run("return [...document.querySelectorAll('svg text')].map(t => t.getBoundingClientRect().height)"
                            ".filter(h => h > 0 && h < 9).length")
        check(small == 0, f"{name}: letters in the chart too small to read at {width} px")
        screenshot(browser, folder, f"{name}-{width}-{'dark' if dark else 'light'}")
    set_width(browser, DESKTOP)


def cell_texts(browser):
    return browser.run("return [...document.querySelectorAll('#workers tbody tr')].map(r => [...r.cells].map(c => c.textContent))")


def look_at(browser, server, mpirun, folder):
    browser.call("POST", "/url", {"url": server.url()})
    wait_for(lambda: browser.run("return document.querySelector('a.card')"), "the run among all")
    check_fit(browser, server.url(), "list", folder)
    browser.call("POST", "/url", {"url": server.url()})
    wait_for(lambda: browser.run("return document.querySelector('a.card')"), "the run among all")
    browser.run("document.querySelector('a.card').click()")
    source = "const i = document.querySelector('.picture img'); return i && i.naturalWidth > 0 ? i.src : ''"
    first = wait_for(lambda: browser.run(source), "a picture")
    second = wait_for(lambda: (new := browser.run(source)) != first and new, "another picture, without a reload")
    wait_for(lambda: browser.run(source) not in (first, second, ""), "a third picture")
    wait_for(lambda: browser.run("return document.querySelectorAll('#chart .dot').length") > 1, "two errors in the chart")
    wait_for(lambda: len(cell_texts(browser)) == 2, "two workers")
    check(all(row[1] == "present" for row in cell_texts(browser)), f"workers: {cell_texts(browser)}")
    check(browser.run("return document.querySelector('#log').textContent.length") > 20, "the log is empty")
    names = browser.run("return performance.getEntriesByType('resource').map(e => e.name)")
    check(all(name.startswith(server.url()) for name in names), f"the page loads from elsewhere: {names}")

    os.kill(rank_process(mpirun, 2), signal.SIGKILL)
    wait_for(lambda: any(row[1] == "lost" and row[5] == "1" for row in cell_texts(browser)), "the lost worker")
    check(any(row[1] == "present" for row in cell_texts(browser)), f"the other one: {cell_texts(browser)}")
    metrics = server.ask("/metrics")[2].decode()
    check(re.search(r'treefarm_worker_up\{run="run",worker="2",host="[^"]*"\} 0\n', metrics), "metrics do not tell of it")
    before = browser.run(source)
    wait_for(lambda: browser.run(source) not in (before, ""), "a picture after the loss")
    check_fit(browser, server.url("/?run=run"), "run", folder)


def check_token(program, browser, folder):
    server = Server(program, folder, "--address", "0.0.0.0", "--port", "0")
    check("token=" in server.query, "no token is made")
    check(server.ask("/status.json")[0] == 401, "without the token something is told")
    token = server.query.split("token=")[1]
    check(server.ask("/status.json", headers={"Authorization": "Bearer " + token})[0] == 200, "the token is refused")
    if browser:
        browser.call("POST", "/url", {"url": server.url(server.query)})
        wait_for(lambda: browser.run("return document.querySelector('a.card')"), "the page with its token")
        check("token" not in browser.run("return location.href"), "the token stays in the address bar")
    server.end()


def check_console(browser):
    log = browser.call("POST", "/se/log", {"type": "browser"})
    check(not log, f"the console says: {log}")


def main():
    program, scene = sys.argv[1], sys.argv[2]
    folder_of_pictures = sys.argv[3] if len(sys.argv) > 3 else None
    driver = shutil.which("chromedriver") if shutil.which("chromium") else None
    if shutil.which("mpirun") is None:
        print("skipped: mpirun is not installed")
        return SKIPPED
    browser = server = farm = None
    with tempfile.TemporaryDirectory() as folder:
        try:
            viewer = Viewer()
            viewer.start()
            farm = subprocess.Popen(
                ["mpirun", "--oversubscribe", "--bind-to", "none", "--enable-recovery", "-n", "3", program, "render", scene,
                 "--spp", "1000000", "--threads", "1", "--set", "image.width=200", "--set", "image.height=200",
                 "--run-dir", folder + "/run", "--quiet", "--display-server", f"localhost:{viewer.port}"],
                env={**os.environ, **MPI}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            server = Server(program, folder, "--port", "0")
            check_http(program, server)
            wait_for(lambda: viewer.wrong or viewer.operations.count(6) > 2, "images at the display server")
            check(not viewer.wrong and viewer.operations[0] == 4, f"the display server got {viewer.wrong or viewer.operations}")
            if driver:
                browser = Browser(driver)
                look_at(browser, server, farm.pid, folder_of_pictures)
            check_token(program, browser, folder)
            if browser:
                check_console(browser)
            server.end()
        except AssertionError as problem:
            print(f"failed: {problem}")
            if browser and folder_of_pictures:
                screenshot(browser, folder_of_pictures, "failed")
            return 1
        finally:
            if browser:
                browser.close()
            for process in (farm, server and server.process):
                if process and process.poll() is None:
                    process.terminate()
                    try:
                        process.wait(30)
                    except subprocess.TimeoutExpired:
                        process.kill()
    if driver is None:
        print("all is well; skipped: what the page looks like, since chromium and chromedriver are not installed")
        return SKIPPED
    print("all is well")
    return 0


if __name__ == "__main__":
    sys.exit(main())
