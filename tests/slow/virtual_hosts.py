#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders under treefarm launch over four virtual hosts (tests/support/virtual_hosts.py), whose cables are cut, replugged, slowed, and one
of which crashes.

usage: virtual_hosts.py TREEFARM SCENE [--only NAME] [--deadline S]

Passes if each ends with exit code 0 and the bits of one process alone, and leaves no process. Skips where virtual hosts are not permitted.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from cases import parser_of, run_cases, skip_for
from launched_render import command, environment, hashes, kill, started
from virtual_hosts import NETWORK, VirtualHosts, why_not

HOSTS, SPP, DEADLINE = 4, 1020, 120


def after(seconds, *acts):
    """Does one thing after the other, that many seconds apart."""
    def harm(hosts):
        for act in acts:
            time.sleep(seconds)
            act(hosts)
    return harm


# What befalls the hosts once the first pass is done.
HARMS = {
    "calm": lambda hosts: None,
    "cable of a worker cut for good": lambda hosts: hosts.cut(2),
    "cable cut for 1 s": after(0.0, lambda hosts: (hosts.cut(2), time.sleep(1.0), hosts.plug(2))),
    "cable cut for 5 s": after(0.0, lambda hosts: (hosts.cut(3), time.sleep(5.0), hosts.plug(3))),
    "link of 10 Mbit/s": lambda hosts: hosts.shape(1, "tbf", "rate", "10mbit", "burst", "64kb", "latency", "100ms"),
    "link with a delay of 20 ms": lambda hosts: hosts.lengthen(1, 0.02),
    "host crashes": lambda hosts: hosts.crash(3),
    "two hosts crash": after(1.0, lambda hosts: hosts.crash(3), lambda hosts: hosts.crash(1)),
}


APART = "run directory on the first host alone"


def launch(arguments, hosts, folder):
    words = command(arguments.treefarm, arguments.scene, folder, "auto", spp=SPP)
    words[1:1] = ["launch", "--hostfile", str(hosts.hostfile()), "--network", NETWORK, "--"]
    variables = {**environment(), "OMPI_MCA_plm": "rsh", "OMPI_MCA_plm_rsh_agent": str(hosts.agent)}
    return subprocess.Popen(hosts.words(0, words), env=variables, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def one(arguments, name, work, truth):
    folder = work / "run"
    shutil.rmtree(folder, ignore_errors=True)
    place = work / "hosts"
    place.mkdir(exist_ok=True)
    with VirtualHosts(place, HOSTS) as hosts:
        begin = time.monotonic()
        process = launch(arguments, hosts, folder)
        passes = folder / "passes.csv"
        while process.poll() is None and not (passes.exists() and len(passes.read_text().splitlines()) > 1):
            time.sleep(0.01)
        if HARMS[name](hosts) is False:
            kill([process.pid, *started(folder)])
            process.communicate()
            return "skipped: this kernel cannot slow a link so"
        try:
            output, _ = process.communicate(timeout=arguments.deadline)
        except subprocess.TimeoutExpired:
            kill([*started(folder), process.pid])
            return f"hangs: {process.communicate()[0]}"
        seconds = time.monotonic() - begin
        if process.returncode != 0:
            return f"exit code {process.returncode}: {output}"
        if hashes(folder) != truth:
            return f"{hashes(folder)} instead of {truth}"
        # Whoever lies behind a cut cable leaves by itself, after its own limit of silence.
        limit = time.monotonic() + 40
        while started(folder) and time.monotonic() < limit:
            time.sleep(0.2)
        if started(folder):
            return f"processes {started(folder)} stay"
        attempts = sum("attempt" in line for line in (folder / "launch" / "log").read_text().splitlines())
        return f"same bits after {seconds:.1f} s ({attempts} lines of attempts)"


def apart(arguments, work):
    """A run directory that the first host alone sees: the others get the secret, and nothing of it stays."""
    place = work / "hosts"
    place.mkdir(exist_ok=True)
    with VirtualHosts(place, HOSTS) as hosts:
        process = launch(arguments, hosts, pathlib.Path("/tmp/apart"))  # each host has a /tmp of its own
        try:
            output, _ = process.communicate(timeout=arguments.deadline)
        except subprocess.TimeoutExpired:
            process.kill()
            return f"hangs: {process.communicate()[0]}"
        left = [k for k in range(HOSTS) if subprocess.run(
            hosts.words(k, ["sh", "-c", "ls /tmp | grep treefarm-key"]), capture_output=True).returncode == 0]
    if process.returncode != 0 or "authenticated" in output or "cannot be read" in output:
        return f"exit code {process.returncode}: {output}"
    return f"keys stay on hosts {left}" if left else "same bits: all hosts had the secret, and none has it still"


def main():
    parser = parser_of(__doc__, [*HARMS, APART])
    parser.add_argument("--deadline", type=float, default=DEADLINE, help="seconds for each; more where the machine is busy")
    arguments = parser.parse_args()
    arguments.treefarm = str(pathlib.Path(arguments.treefarm).resolve())
    arguments.scene = str(pathlib.Path(arguments.scene).resolve())
    skip_for(why_not() or ("" if shutil.which("mpirun") else "there is no mpirun"))
    with tempfile.TemporaryDirectory(dir="/var/tmp") as folder:
        work = pathlib.Path(folder)
        subprocess.run(command(arguments.treefarm, arguments.scene, work / "truth", "auto", spp=SPP), check=True,
                       env=environment())
        truth = hashes(work / "truth")
        failed = run_cases(arguments.only or [*HARMS, APART], lambda name: apart(arguments, work) if name == APART else
                           one(arguments, name, work, truth))
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
