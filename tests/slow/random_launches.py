#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Kills every process of renders at random moments, but treefarm launch, which goes on with them.

usage: random_launches.py TREEFARM SCENE [--count N] [--seed S] [--kills K] [--part] [--interval S] [--spp N] [--deadline S]

Each of N renders is killed 1 to K times: all its processes at once, or with --part one of them, or mpirun. Passes if each ends with
exit code 0 and the bits of the render that never stopped, and leaves no process, no shared memory and no temporary folder; with --interval,
if a death of all costs no more than these seconds between two checkpoints, and those in which results come and one is written. Prints a
line per render.
"""
import argparse
import json
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

from launched_render import DEADLINE, command, environment, faults_of, hashes, kill, started

GUIDES = ("auto", "view", "ppg", "none", "grid")
UPDATE = 0.1   # seconds between a worker's results: a checkpoint without a new one would be in vain, and waits for it
WRITING = 1.0  # seconds at most: a checkpoint that is not yet whole does not count


def rendered(folder):
    """Number of the attempt that is at work and its seconds of rendering by now, those that it went on from included."""
    try:
        file = folder / "status.json"
        status = json.loads(file.read_text())
        return int(status["attempt"].split(".")[1]), status["elapsed_seconds"] + time.time() - file.stat().st_mtime
    except (OSError, ValueError, KeyError):
        return 0, 0.0


def kept(folder):
    """Seconds of rendering with which each attempt of a launch began, in turn; None where it died before it said so."""
    def begun(attempt):
        resumed = re.search(r"([\d.]+) s of rendering", attempt)
        return float(resumed[1]) if resumed else 0.0 if re.search("^rendering ", attempt, re.MULTILINE) else None

    return [begun(attempt) for attempt in (folder / "launch" / "log").read_text().split("launch: attempt ")[1:]]


def longest_loss(behind, folder):
    """Seconds of rendering that a death cost. `behind`: by attempt, what it had rendered when all were killed."""
    begun = kept(folder)
    later = {attempt: next((seconds for seconds in begun[attempt:] if seconds is not None), None) for attempt in behind}
    return max((seconds - later[a] for a, seconds in behind.items() if a > 0 and later[a] is not None), default=0.0)


def one(arguments, work, random, truths):
    guide, ranks, kills = random.choice(GUIDES), random.choice((1, 2, 2, 3)), random.randint(1, arguments.kills)
    name = f"{guide} ranks {ranks} kills {kills}"
    if guide not in truths:
        truth = work / f"truth-{guide}"
        subprocess.run(command(arguments.treefarm, arguments.scene, truth, guide, spp=arguments.spp), check=True, env=environment())
        truths[guide] = hashes(truth)
    folder = work / "run"
    shutil.rmtree(folder, ignore_errors=True)
    begin = time.monotonic()
    words = command(arguments.treefarm, arguments.scene, folder, guide, ranks, arguments.spp)
    if arguments.interval:
        words = command(arguments.treefarm, arguments.scene, folder, guide, ranks, arguments.spp, arguments.interval, UPDATE)
        words.remove("--quiet")  # each attempt says from where it goes on
    process = subprocess.Popen(words, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    done, behind = 0, {}
    for _ in range(kills):
        time.sleep(random.uniform(0.1, 4.0))
        victims = started(folder)
        if process.poll() is not None:
            break
        attempt, seconds = rendered(folder)
        kill([random.choice(victims)] if arguments.part and victims else victims)
        done += bool(victims)
        behind.setdefault(attempt, seconds)  # where it is killed before it begins, the status is that of the one before
    try:
        output, _ = process.communicate(timeout=arguments.deadline)
    except subprocess.TimeoutExpired:
        kill([*started(folder), process.pid])
        return name, f"hangs: {process.communicate()[0]}", "", done
    faults, outcome = faults_of(process, output, folder, truths[guide]), f"same bits after {time.monotonic() - begin:.1f} s"
    if arguments.interval and not arguments.part and not faults:
        loss = longest_loss(behind, folder)
        outcome += f", {loss:.2f} s of rendering lost at most"
        if loss > arguments.interval + UPDATE + WRITING:
            faults = f"a death cost {loss:.2f} s of rendering"
    return name, faults, outcome, done


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("treefarm")
    parser.add_argument("scene")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kills", type=int, default=3)
    parser.add_argument("--part", action="store_true", help="one process at a time")
    parser.add_argument("--interval", type=float, default=0, help="seconds between two checkpoints; 0: as often as it may be")
    parser.add_argument("--spp", type=int, default=255)
    parser.add_argument("--deadline", type=float, default=DEADLINE, help="seconds for each; more where the machine is busy")
    arguments = parser.parse_args()
    if shutil.which("mpirun") is None:
        print("skipped: there is no mpirun")
        sys.exit(77)
    failed, kills, truths = 0, 0, {}
    with tempfile.TemporaryDirectory() as work:
        for k in range(arguments.count):
            name, failure, outcome, done = one(arguments, pathlib.Path(work), random.Random(arguments.seed * 1000 + k), truths)
            failed += bool(failure)
            kills += done
            print(f"{k:3} {name}: {failure or outcome}", flush=True)
    print(f"{arguments.count} renders, {kills} times killed, {failed} failed")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
