#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Kills processes of a small farm at random moments of start-up, passes and end, over shared memory and TCP.

usage: random_kills.py TREEFARM SCENE [--count N] [--seed S] [--set KEY=VALUE]...

Passes if no render hangs: one whose process died inside MPI_Init ends with the message that says so, any other gives the
bits of the undisturbed render. Prints a line per kill that went otherwise, and a table. One after the other: a kill is
only at a moment of the render if that render has the machine.
"""
import argparse
import collections
import glob
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

START_SECONDS = 8  # all processes together, here
HANG_SECONDS = 30  # without a sign of life: a word, a file of the run directory, the end
WORKERS = {"a worker": [2], "two workers": [1, 3], "the head of the chain": [1]}
TRANSPORTS = {"vader": [], "tcp": ["--mca", "btl", "tcp,self"]}


def environment():
    return {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            "OMPI_MCA_oob_tcp_if_include": "lo", "OMPI_MCA_btl_tcp_if_include": "lo"}


def command(arguments, folder, transport):
    return ["mpirun", "--oversubscribe", "--bind-to", "none", "--enable-recovery", "--mca", "mpi_yield_when_idle", "1",
            "-n", "4", *TRANSPORTS[transport], arguments.treefarm, "render", arguments.scene, "-D", "size=64",
            "--spp", "508", "--threads", "1", "--run-dir", folder, "--start-seconds", str(START_SECONDS)] + [
            word for key in ("farm.heartbeat_seconds=0.2", "farm.update_seconds=0.05", "farm.tile_size=16", *arguments.set)
            for word in ("--set", key)]


def ranks_of(mpirun):
    """Processes by rank, as soon as they run this program."""
    found = {}
    try:
        children = open(f"/proc/{mpirun}/task/{mpirun}/children").read().split()
    except OSError:
        return found
    for child in children:
        try:
            variables = open(f"/proc/{child}/environ", "rb").read().split(b"\0")
        except OSError:
            continue
        for variable in variables:
            if variable.startswith(b"OMPI_COMM_WORLD_RANK="):
                found[int(variable.split(b"=")[1])] = int(child)
    return found


def summary_of(folder):
    try:
        return json.load(open(os.path.join(folder, "summary.json")))
    except (OSError, ValueError):
        return {}


def sweep():
    """What killed processes of Open MPI leave behind, of those that are gone."""
    for path in glob.glob("/dev/shm/vader_segment.*"):
        name = os.path.basename(path).split(".")
        if not any(part.isdigit() and os.path.exists(f"/proc/{part}") for part in name):
            os.remove(path)


def hashes(summary):
    return tuple(summary.get(name) for name in ("image_hash", "tree_hash", "aov_hash"))


def last_sign_of_life(folder, began):
    """When something was last written, in seconds since 1970."""
    times = [began]
    for path in [folder + ".txt", *glob.glob(os.path.join(folder, "*"))]:
        try:
            times.append(os.stat(path).st_mtime)
        except OSError:
            pass  # replaced just now
    return max(times)


def run(arguments, folder, transport, victims, delay):
    """Outcome of one render, and what it printed."""
    log = open(os.path.join(folder + ".txt"), "w+")
    process = subprocess.Popen(command(arguments, folder, transport), stdout=log, stderr=log, stdin=subprocess.DEVNULL,
                               env=environment(), start_new_session=True)
    began, began_at = time.monotonic(), time.time()
    killed = []
    if victims:
        while process.poll() is None and len(ranks_of(process.pid)) < 4 and time.monotonic() - began < 20:
            time.sleep(0.002)
        time.sleep(delay)
        ranks = ranks_of(process.pid)
        for victim in victims:
            try:
                os.kill(ranks[victim], signal.SIGKILL)
                killed.append(victim)
            except (KeyError, ProcessLookupError):
                pass  # it had already left
    hung = False
    while process.poll() is None and not hung:
        time.sleep(0.05)
        hung = time.time() - last_sign_of_life(folder, began_at) > HANG_SECONDS
    if hung:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    log.seek(0)
    return hung, killed, log.read()


def judge(folder, truth, hung, killed, text):
    if hung:
        return "HANGS"
    summary = summary_of(folder)
    if summary.get("state") == "done":
        same = hashes(summary) == truth
        return ("same bits" if killed else "same bits, nobody killed") if same else "OTHER BITS"
    if "did not come together" in text:
        return "told of a death in MPI_Init"
    return "ENDS WITHOUT AN IMAGE: " + summary.get("error", "no summary")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("treefarm")
    parser.add_argument("scene")
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--set", action="append", default=[], help="of the renders: output.aovs=..., integrator.type=...")
    arguments = parser.parse_args()
    if not shutil.which("mpirun"):
        print("skipped: no mpirun")
        return 77
    home = tempfile.mkdtemp(prefix="treefarm-kills-")
    began = time.monotonic()
    folder = os.path.join(home, "calm")
    hung, _, text = run(arguments, folder, "vader", [], 0)
    arguments.calm = time.monotonic() - began
    summary = summary_of(folder)
    if hung or summary.get("state") != "done":
        print(f"the undisturbed render failed:\n{text}")
        return 1
    truth = hashes(summary)
    print(f"undisturbed: {arguments.calm:.1f} s, image {truth[0]}, tree {truth[1]}, layers {truth[2]}", flush=True)

    draw = random.Random(arguments.seed)
    table = collections.Counter()
    bad = 0
    for number in range(arguments.count):
        who, transport = draw.choice(list(WORKERS)), draw.choice(list(TRANSPORTS))
        start_up = draw.random() < 0.4  # half a second holds MPI_Init, hellos, scene and first tree
        delay = draw.uniform(0, 0.5) if start_up else draw.uniform(0.5, arguments.calm)
        folder = os.path.join(home, str(number))
        outcome = judge(folder, truth, *run(arguments, folder, transport, WORKERS[who], delay))
        table[(who, transport, "start-up" if start_up else "later", outcome)] += 1
        if outcome.isupper() or outcome.split(":")[0].isupper():
            bad += 1
            print(f"{number}: {who}, {transport}, after {delay:.3f} s: {outcome}; see {folder}.txt", flush=True)
        else:
            shutil.rmtree(folder, ignore_errors=True)
        sweep()
    for (who, transport, moment, outcome), count in sorted(table.items()):
        print(f"{count:4}  {who:22}  {transport:5}  {moment:8}  {outcome}")
    print(f"{arguments.count - bad} passed, {bad} failed")
    if bad == 0:
        shutil.rmtree(home, ignore_errors=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
