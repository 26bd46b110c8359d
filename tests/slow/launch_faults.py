#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Takes disks and folders away from renders under treefarm launch at random, and gives them back.

usage: launch_faults.py TREEFARM SCENE [--count N] [--first K] [--seed S] [--deadline S]

Each of N renders meets one to three faults: its disk (a small tmpfs) is full for 5 to 90 s, its run directory is removed, its folder in
/dev/shm is removed, or another treefarm launch works in a pid namespace of its own; after each of them some or all processes may be
killed. Passes if every render ends with exit code 0 and the bits of one that was left alone, and leaves no process, shared memory or
temporary folder. Needs root, for mount and unshare; skipped (77) otherwise. Prints a line per render; --first K --count 1 repeats one.
"""
import argparse
import contextlib
import glob
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

from launched_render import command, environment, faults_of, hashes, kill, ranks, started

GUIDES = ("auto", "none", "grid")
DISK = 24 << 20  # bytes
NAMESPACE = ["unshare", "--pid", "--fork", "--mount-proc"]


def works(words):
    return shutil.which(words[0]) is not None and subprocess.run(words, capture_output=True, check=False).returncode == 0


@contextlib.contextmanager
def small_disk(place):
    place.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={DISK}", "none", str(place)], check=True)
    try:
        yield place
    finally:
        subprocess.run(["umount", "-l", str(place)], check=False)


def fill(ballast):
    """Takes what is free on a disk."""
    with contextlib.suppress(OSError), open(ballast, "ab", buffering=0) as file:
        while file.write(bytes(4096)) == 4096:
            pass


class Harm:
    """Faults of one render."""

    def __init__(self, arguments, random_numbers, disk, process):
        self.arguments, self.random, self.disk, self.process = arguments, random_numbers, disk, process
        self.folder = disk / "run"
        self.said = []

    def wait(self, seconds, act=lambda: None):
        end = time.monotonic() + seconds
        while time.monotonic() < end and self.process.poll() is None:
            act()
            time.sleep(0.1)

    def disk_is_full(self):
        seconds, ballast = self.random.uniform(5, 90), self.disk / "ballast"
        self.said.append(f"disk full {seconds:.0f} s")
        if self.random.random() < 0.3:
            fill(ballast)
            self.kill_some()
        self.wait(seconds, lambda: fill(ballast))
        ballast.unlink(missing_ok=True)

    def folder_is_gone(self):
        self.said.append("folder gone")
        shutil.rmtree(self.folder, ignore_errors=True)

    def shared_memory_is_gone(self):
        self.said.append("shm gone")
        for name in glob.glob(f"/dev/shm/treefarm-launch-{self.process.pid}-*"):
            shutil.rmtree(name, ignore_errors=True)

    def another_launches(self):
        self.said.append("another namespace")
        other = self.disk.parent / "other"
        words = [*NAMESPACE, self.arguments.treefarm, "launch", "-n", "2", "--", "render", self.arguments.scene, "-D", "size=8",
                 "--spp", "4", "--threads", "1", "--quiet", "--overwrite", "--run-dir", str(other)]
        ended = subprocess.run(words, env=environment(), capture_output=True, text=True, check=False)
        if ended.returncode != 0:
            self.said.append(f"WHICH FAILED: {ended.stderr}")

    def kill_some(self):
        victims = ranks(self.folder)
        which = self.random.choice(("none", "coordinator", "one", "all"))
        chosen = {"none": [], "coordinator": [victims[0]] if 0 in victims else [], "all": list(victims.values()),
                  "one": [self.random.choice(list(victims.values()))] if victims else []}[which]
        if chosen:
            self.said.append(f"{which} killed")
            kill(chosen)

    def do(self):
        for _ in range(self.random.randint(1, 3)):
            self.wait(self.random.uniform(0.3, 4.0))
            if self.process.poll() is not None:
                break
            self.random.choice((self.disk_is_full, self.folder_is_gone, self.shared_memory_is_gone, self.another_launches))()
            self.kill_some()


def render(arguments, folder, guide, count=None, spp=255):
    return command(arguments.treefarm, arguments.scene, folder, guide, count, spp=spp, interval=0.5, update=0.1)


def one(arguments, work, disk, number, truths):
    numbers = random.Random(number)
    guide, count, spp = numbers.choice(GUIDES), numbers.choice((1, 2, 2, 3)), numbers.choice((255, 1023, 4095))
    if (guide, spp) not in truths:
        truth = work / f"truth-{guide}-{spp}"
        subprocess.run(render(arguments, truth, guide, spp=spp), check=True, env=environment())
        truths[guide, spp] = hashes(truth)
    folder = disk / "run"
    for left in disk.iterdir():
        shutil.rmtree(left) if left.is_dir() else left.unlink()
    begin = time.monotonic()
    with open(work / "output", "w+", encoding="utf-8", errors="replace") as output:
        process = subprocess.Popen(render(arguments, folder, guide, count, spp), env=environment(), stdout=output,
                                   stderr=subprocess.STDOUT)
        harm = Harm(arguments, numbers, disk, process)
        harm.do()
        try:
            process.wait(timeout=arguments.deadline)
        except subprocess.TimeoutExpired:
            kill([*started(folder), process.pid])
        process.wait()
        output.seek(0)
        text = output.read()
    name = f"seed {number} {guide} {spp} spp ranks {count}: {', '.join(harm.said) or 'nothing'}"
    faults = faults_of(process, text, folder, truths[guide, spp])
    if any("FAILED" in said for said in harm.said):
        faults += " the other launch failed"
    return name, faults, time.monotonic() - begin


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("treefarm")
    parser.add_argument("scene")
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--deadline", type=float, default=600, help="seconds for each; more where the machine is busy")
    arguments = parser.parse_args()
    if shutil.which("mpirun") is None:
        print("skipped: there is no mpirun")
        sys.exit(77)
    failed, truths = 0, {}
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        work = pathlib.Path(folder)
        try:
            disk = stack.enter_context(small_disk(work / "disk"))
        except (OSError, subprocess.CalledProcessError):
            print("skipped: a small disk cannot be mounted here, which needs root")
            sys.exit(77)
        if not works([*NAMESPACE, "true"]):
            print("skipped: there are no pid namespaces here, which need root and util-linux")
            sys.exit(77)
        for k in range(arguments.first, arguments.first + arguments.count):
            name, faults, seconds = one(arguments, work, disk, arguments.seed * 1000 + k, truths)
            failed += bool(faults)
            print(f"{k:3} {name}: {faults or f'same bits after {seconds:.0f} s'}", flush=True)
    print(f"{arguments.count} renders, {failed} failed")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
