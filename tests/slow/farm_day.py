#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A farm's day: a shot of 24 frames as an array of Slurm's jobs on three virtual hosts, each a node with a network card of its own. One
host is slowed to a fifth, one is lost for good, one frame is preempted by an urgent job, and `treefarm serve` shows the shot all the while.

usage: farm_day.py TREEFARM [--seconds S] [--patience P] [--picture FILE.png]

Passes if all frames arrive with the bits of a quiet day, which is one process that renders them one after the other, and the page answered
each second. Prints the day's log. Skips where there can be no Slurm, or no virtual hosts.
"""
import argparse
import base64
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "support"), str(ROOT / "tests" / "browser")]
import local_slurm
import virtual_hosts
from cases import skip_for
from launched_render import environment, hashes
from report_test import Browser

SCRIPT = ROOT / "deploy" / "slurm" / "render.sbatch"
SCENE = ROOT / "configs" / "scenes" / "door-ajar.xml"
FRAMES = range(1, 25)
RANGE = f"{FRAMES[0]}-{FRAMES[-1]}"
HOSTS = ["node1", "node2", "node3"]
SLOW, LOST = "node3", "node2"


def name_of(frame):
    return f"frame.{frame:04d}"


class Listener(threading.Thread):
    """Asks the page's questions, each second as the page does: for the list, and for a run in turn and its picture."""

    def __init__(self, program, folder):
        super().__init__(daemon=True)
        self.server = subprocess.Popen([program, "serve", str(folder), "--port", "0"], stdout=subprocess.PIPE, text=True)
        self.url = re.search(r"http://\S+", self.server.stdout.readline())[0].rstrip("/")
        self.ended = threading.Event()
        self.answers, self.longest, self.wrong, self.seen = 0, 0.0, [], set()

    def ask(self, path):
        begin = time.monotonic()
        with urllib.request.urlopen(self.url + path, timeout=30) as answer:
            body = answer.read()
        self.longest = max(self.longest, time.monotonic() - begin)
        self.answers += 1
        return body

    def run(self):
        while not self.ended.wait(1.0):
            try:
                runs = json.loads(self.ask("/status.json"))["runs"]
                self.seen |= {(run["run"], run["state"]) for run in runs}
                for run in [run for run in runs if run["state"] == "running"][:1]:
                    json.loads(self.ask(f"/status.json?run={run['run']}"))
            except (OSError, ValueError, KeyError) as problem:
                self.wrong.append(str(problem))

    def end(self):
        self.ended.set()
        self.join()
        self.server.send_signal(signal.SIGINT)
        if self.server.wait(30) != 0:
            self.wrong.append(f"treefarm serve ends with {self.server.returncode}")


class Slowness(threading.Thread):
    """Lets the renders of a node run for a fifth of each second."""

    def __init__(self, slurm, name):
        super().__init__(daemon=True)
        self.slurm, self.name, self.ended = slurm, name, threading.Event()

    def renders(self):
        for pid in self.slurm.processes(self.name):
            try:
                if pathlib.Path(f"/proc/{pid}/comm").read_text().strip() == "treefarm":
                    yield pid
            except OSError:
                pass

    def run(self):
        while not self.ended.is_set():
            for number, seconds in ((signal.SIGSTOP, 0.8), (signal.SIGCONT, 0.2)):
                for pid in self.renders():
                    try:
                        os.kill(pid, number)
                    except ProcessLookupError:
                        pass
                time.sleep(seconds)

    def end(self):
        self.ended.set()
        self.join()


class Day:
    def __init__(self, arguments, work):
        self.patience = arguments.patience
        self.program = str(pathlib.Path(arguments.treefarm).resolve())
        self.work = work
        self.shot = work / "runs" / "shot"
        self.shot.mkdir(parents=True)
        self.spp = self._samples_of(arguments.seconds)
        self.alone(self.words("%d"), "--frames", RANGE, folder=work / "quiet")
        (work / "hosts").mkdir()

    def words(self, frame, spp=None):
        return [str(SCENE), "-D", f"open={frame}", "--spp", str(spp or self.spp), "--set", "image.width=96", "--set", "image.height=64",
                "--set", "farm.checkpoint_seconds=1"]

    def _samples_of(self, seconds):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.alone(self.words(FRAMES[-1], 64), folder=self.work / "speed")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return max(64, int(64 * seconds / (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)))

    def alone(self, words, *options, folder):
        subprocess.run([self.program, "render", *words, *options, "--run-dir", str(folder), "--quiet"], check=True, env=environment())

    def say(self, text):
        print(f"{time.monotonic() - self.begin:6.0f} s  {text}", flush=True)

    def frames(self):
        """What Slurm says of each frame that has begun."""
        return {int(facts["ArrayTaskId"]): facts for facts in self.slurm.facts(self.job) if facts["ArrayTaskId"].isdigit()}

    def done(self):
        return sum(facts["JobState"] == "COMPLETED" for facts in self.frames().values())

    def in_hand(self):
        """Frames that are being rendered and have a checkpoint, with their nodes."""
        return {frame: facts["NodeList"] for frame, facts in self.frames().items()
                if facts["JobState"] == "RUNNING" and any((self.shot / name_of(frame) / "checkpoint").glob("?.tfc"))}

    def wait_for(self, condition, what):
        limit = time.monotonic() + self.patience
        while not (found := condition()):
            if time.monotonic() > limit:
                raise AssertionError(f"in {self.patience} s not seen: {what}; Slurm says {self.slurm.facts(self.job)}")
            self.slurm.hurry(self.job)
            time.sleep(0.2)
        return found

    def restarts(self):
        return {frame: int(facts["Restarts"]) for frame, facts in self.frames().items()}

    def lose_host(self):
        frame = self.wait_for(lambda: next((frame for frame, node in self.in_hand().items() if node == LOST), None),
                              f"a frame on {LOST}")
        self.slurm.crash(LOST)
        self.say(f"{LOST} is lost, with frame {frame} in hand")
        self.wait_for(lambda: self.restarts()[frame] > 0, f"frame {frame} is begun again")
        self.say(f"frame {frame} waits for another node")

    def young(self):
        """Frames in hand that have most of their way before them, with their nodes."""
        return {frame: node for frame, node in self.in_hand().items() if self.fraction(frame) < 0.4}

    def fraction(self, frame):
        try:
            return json.loads((self.shot / name_of(frame) / "status.json").read_text())["fraction"]
        except (OSError, ValueError, KeyError):
            return 1.0

    def told(self):
        """Frames that were told to give up their node and have not yet done so."""
        return [frame for frame, facts in self.frames().items()
                if facts["JobState"] == "RUNNING" and facts.get("PreemptTime", "None") != "None"]

    def preempt(self):
        """An urgent job takes a node, all of which are busy then. Where a frame is done before it has to go, the next one is tried."""
        left = set(HOSTS) - {LOST}
        for _ in range(8):
            self.wait_for(lambda: set(self.young().values()) == left or self.done() == len(FRAMES), f"frames on {sorted(left)}")
            if self.done() == len(FRAMES):
                break
            before = self.restarts()
            urgent = self.slurm.submit("--partition=urgent", "--nodes=1", "--exclusive", "--output=/dev/null", "--wrap", "sleep 3")
            self.wait_for(lambda: self.slurm.states(urgent) == ["COMPLETED"], "the urgent job's end")
            self.wait_for(lambda: not self.told(), "the end of a frame that was preempted")
            for frame, count in self.restarts().items():
                if count > before.get(frame, 0):
                    return self.say(f"an urgent job took a node from frame {frame}, which waits for its turn")
        raise AssertionError("no urgent job preempted a frame")

    def live(self, slurm, browser, picture):
        self.slurm = slurm
        self.begin = time.monotonic()
        self.job = slurm.submit("--nodes=1", f"--array={RANGE}", f"--output={self.work}/log-%a", str(SCRIPT), str(self.shot),
                                *self.words("%d"))
        self.say(f"{len(FRAMES)} frames are queued for {', '.join(HOSTS)}")
        slowness = Slowness(slurm, SLOW)
        try:
            self.wait_for(lambda: self.done() >= 2, "two frames")
            slowness.start()
            self.say(f"{SLOW} has a fifth of its speed from now on; {self.done()} frames are done")
            self.wait_for(lambda: self.done() >= 4, "four frames")
            self.lose_host()
            self.preempt()
            if browser:
                take(browser, picture)
            self.say(f"{self.done()} frames are done")
            states = slurm.wait(self.job, self.patience)
            assert states and set(states) == {"COMPLETED"}, f"jobs end as {states}: {slurm.facts(self.job)}"
            self.say(f"{len(FRAMES)} frames are done; begun again: {sum(self.restarts().values())}")
        finally:
            if slowness.is_alive():
                slowness.end()

    def check(self, listener):
        for frame in FRAMES:
            got, wanted = (hashes(folder / name_of(frame)) for folder in (self.shot, self.work / "quiet"))
            assert got == wanted, f"frame {frame} has {got}, on a quiet day {wanted}"
        after = subprocess.run([self.program, "render", *self.words("%d"), "--frames", RANGE, "--run-dir", str(self.shot)],
                               capture_output=True, text=True, env=environment())
        kept = after.stderr.count("kept: it was done before")
        assert after.returncode == 0 and kept == len(FRAMES), f"the shot's own command: {after.returncode}, {kept} kept: {after.stderr}"
        runs = json.loads(listener.ask("/status.json"))["runs"]
        assert len(runs) == len(FRAMES) and all(run["state"] == "done" for run in runs), f"the page lists {runs}"
        listener.end()
        assert not listener.wrong, f"the page: {listener.wrong}"
        self.say(f"all with the bits of a quiet day; the page answered {listener.answers} times, after {listener.longest:.2f} s at most")


def look(url):
    """A browser that has the page open, where there is one."""
    driver = shutil.which("chromedriver") if shutil.which("chromium") else None
    if not driver:
        return None
    browser = Browser(driver)
    browser.call("POST", "/goog/cdp/execute", {"cmd": "Emulation.setDeviceMetricsOverride", "params": {
        "width": 1000, "height": 720, "deviceScaleFactor": 1, "mobile": False}})
    browser.call("POST", "/url", {"url": url})
    return browser


def take(browser, file):
    if file:
        shown = browser.call("POST", "/goog/cdp/execute", {"cmd": "Page.captureScreenshot", "params": {}})["data"]
        pathlib.Path(file).write_bytes(base64.b64decode(shown))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("treefarm")
    parser.add_argument("--seconds", type=float, default=12, help="of a core that a frame takes")
    parser.add_argument("--patience", type=float, default=1200, help="seconds to wait for anything; more where the machine is busy")
    parser.add_argument("--picture", help="of the page, in the middle of the day")
    arguments = parser.parse_args()
    skip_for(local_slurm.why_not() or virtual_hosts.why_not())
    with tempfile.TemporaryDirectory(dir="/var/tmp") as folder:
        work = pathlib.Path(folder)
        day = Day(arguments, work)
        listener = Listener(day.program, work / "runs")
        listener.start()
        browser = look(listener.url)
        try:
            with virtual_hosts.VirtualHosts(work / "hosts", len(HOSTS), HOSTS) as hosts, \
                    local_slurm.LocalSlurm(work / "slurm", hosts=hosts, told_early=True) as slurm:
                slurm.environment.update({**environment(), "PATH": f"{pathlib.Path(day.program).parent}:{os.environ['PATH']}"})
                day.live(slurm, browser, arguments.picture)
            day.check(listener)
            if browser:
                said = browser.call("POST", "/se/log", {"type": "browser"})
                assert not said, f"the page's console says {said}"
        except AssertionError as problem:
            print(f"FAILED: {problem}")
            for log in sorted(work.glob("log-*")):
                if " image " not in (text := log.read_text()):  # not done
                    print(f"{log.name}: {text}")
            sys.exit(1)
        finally:
            listener.server.kill()
            if browser:
                browser.close()


if __name__ == "__main__":
    main()
