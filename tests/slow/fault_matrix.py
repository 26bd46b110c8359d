#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Faults x moments x transports: does each in turn to a small render of four ranks under treefarm launch.

usage: fault_matrix.py TREEFARM SCENE [--fault NAME] [--moments N] [--transport NAME] [--seed S] [--deadline S]

Passes if each render ends with exit code 0 and the bits of the undisturbed one, within the deadline, and leaves no process, no shared
memory and no temporary folder. Prints a line per failure and a table.
"""
import argparse
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from launched_render import DEADLINE, command, environment, faults_of, hashes, kill, ranks, send, started

MPIRUN, COORDINATOR, WORKERS = -1, 0, (1, 2, 3)


def stop(seconds):
    """A process stands still for so long."""
    def act(pids):
        send(signal.SIGSTOP, pids)
        time.sleep(seconds)
        send(signal.SIGCONT, pids)
    return act


def give(number):
    return lambda pids: send(number, pids)


# Who is hit, and how.
FAULTS = {
    "worker killed": ([2], give(signal.SIGKILL)),
    "worker crashes": ([2], give(signal.SIGSEGV)),
    "worker stands still for ever": ([2], give(signal.SIGSTOP)),
    "worker stands still 3 s": ([2], stop(3.0)),
    "worker told to leave": ([2], give(signal.SIGTERM)),
    "head of the chain killed": ([1], give(signal.SIGKILL)),
    "two workers killed": ([1, 3], give(signal.SIGKILL)),
    "all workers killed": (WORKERS, give(signal.SIGKILL)),
    "coordinator killed": ([COORDINATOR], give(signal.SIGKILL)),
    "coordinator stands still 3 s": ([COORDINATOR], stop(3.0)),
    "coordinator told to stop": ([COORDINATOR], give(signal.SIGTERM)),
    "mpirun killed": ([MPIRUN], give(signal.SIGKILL)),
    "mpirun told to stop": ([MPIRUN], give(signal.SIGTERM)),
    "mpirun stands still 3 s": ([MPIRUN], stop(3.0)),
    "all killed": ((MPIRUN, COORDINATOR, *WORKERS), give(signal.SIGKILL)),
}
# These end the render as asked, with exit code 3; it is gone on with.
ASKED = {"coordinator told to stop"}
TRANSPORTS = {"vader": None, "tcp": "tcp,self"}
# As FAULTS.md has them: while MPI starts, at the hellos, at boundaries of passes, anywhere, and at the end.
MOMENTS = ["start"] * 2 + ["hello"] * 2 + ["boundary"] * 3 + ["anywhere"] * 4 + ["end"]


LONG = 60  # seconds, after which one wants to know what took them


def launch_log(folder):
    """What launch noted."""
    try:
        lines = (folder / "launch" / "log").read_text(errors="replace").splitlines()
    except OSError:
        return "no log"
    return " | ".join(line for line in lines if line.startswith("launch:"))


def passes_done(folder):
    try:
        return len((folder / "passes.csv").read_text().splitlines()) - 1
    except OSError:
        return 0


def wait_for(moment, folder, process, dice):
    def wait_until(condition):
        while process.poll() is None and not condition():
            time.sleep(0.002)
    if moment == "start":
        wait_until(lambda: started(folder))
        time.sleep(dice.uniform(0, 0.3))
    elif moment == "hello":
        wait_until((folder / "status.json").exists)
        time.sleep(dice.uniform(0, 0.05))
    elif moment == "boundary":
        wanted = dice.randint(1, 6)
        wait_until(lambda: passes_done(folder) >= wanted)
    elif moment == "anywhere":
        wait_until((folder / "passes.csv").exists)
        time.sleep(dice.uniform(0, 2.5))
    else:
        wait_until(lambda: passes_done(folder) >= 8)


def one(arguments, folder, fault, moment, transport, truth, dice):
    victims, act = FAULTS[fault]
    shutil.rmtree(folder, ignore_errors=True)
    process = subprocess.Popen(command(arguments.treefarm, arguments.scene, folder, "auto", 4), stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, env=environment(TRANSPORTS[transport]))
    begin = time.monotonic()
    wait_for(moment, folder, process, dice)
    there = ranks(folder)
    hit = [there[victim] for victim in victims if victim in there]
    act(hit)
    try:
        output, _ = process.communicate(timeout=arguments.deadline)
    except subprocess.TimeoutExpired:
        kill([*started(folder), process.pid])
        return f"hangs: {process.communicate()[0]}", arguments.deadline, bool(hit)
    seconds = time.monotonic() - begin
    if fault in ASKED and process.returncode == 3:
        if any((folder / "checkpoint").glob("?.tfc")):
            subprocess.run([arguments.treefarm, "resume", str(folder), "--quiet"], check=False, env=environment())
        else:
            subprocess.run(command(arguments.treefarm, arguments.scene, folder, "auto"), check=False, env=environment())
        process.returncode = 0
    return faults_of(process, output, folder, truth), seconds, bool(hit)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("treefarm")
    parser.add_argument("scene")
    parser.add_argument("--fault", choices=FAULTS, action="append", help="only this one; may be given again")
    parser.add_argument("--moments", type=int, default=len(MOMENTS), help="of each fault, spread over all")
    parser.add_argument("--transport", choices=TRANSPORTS, action="append")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--deadline", type=float, default=DEADLINE, help="seconds for each; more where the machine is busy")
    arguments = parser.parse_args()
    if shutil.which("mpirun") is None:
        print("skipped: there is no mpirun")
        sys.exit(77)
    failed = done = 0
    begin = time.monotonic()
    with tempfile.TemporaryDirectory() as work:
        truth_folder, folder = pathlib.Path(work) / "truth", pathlib.Path(work) / "run"
        subprocess.run(command(arguments.treefarm, arguments.scene, truth_folder, "auto"), check=True, env=environment())
        truth = hashes(truth_folder)
        for fault in arguments.fault or FAULTS:
            for transport in arguments.transport or TRANSPORTS:
                longest = right = hits = 0
                count = min(arguments.moments, len(MOMENTS))
                for k in range(count):
                    moment = MOMENTS[k * len(MOMENTS) // count]
                    dice = random.Random(f"{arguments.seed} {fault} {transport} {k}")
                    failure, seconds, hit = one(arguments, folder, fault, moment, transport, truth, dice)
                    if failure:
                        print(f"{fault}, {moment}, {transport}: {failure}", flush=True)
                    if failure or seconds > LONG:
                        print(f"{fault}, {moment}, {transport}: {seconds:.1f} s: {launch_log(folder)}", flush=True)
                    right += not failure
                    hits += hit
                    longest = max(longest, seconds)
                print(f"{fault:32} {transport:6} {right:2} of {count:2} right, {hits:2} hit, longest {longest:5.1f} s", flush=True)
                failed += count - right
                done += hits
    print(f"{done} faults, {failed} failures, {time.monotonic() - begin:.0f} s")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
