#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The section "Machines with ssh" of docs/use/cluster.md, word for word, on virtual hosts (tests/support/virtual_hosts.py): its hostfile, its
commands, the ports that it names. What stands for a real cluster: node1 is entered by nsenter, and ssh is a script that enters the others.

usage: cluster_page.py TREEFARM SCENE

Passes if the picture has the bits of one process alone. Skips where virtual hosts are not permitted.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from launched_render import environment, hashes
from virtual_hosts import NETWORK, VirtualHosts, why_not

DEADLINE = 240

# A port of Open MPI's messages, or its daemons', by the ranges that the page exports.
RANGES = [range(46000, 46004), range(46100, 46200)]

SSH = """#!/bin/sh
# ssh [-x] [-o OPTION]... HOST COMMAND...
while :; do case $1 in -o) shift 2;; -*) shift;; *) break;; esac; done
exec {agent} "$@"
"""


def section(text, title):
    return re.search(rf"^## {title}\n(.*?)(?=^## |\Z)", text, re.M | re.S).group(1)


def blocks(text):
    """Indented blocks: each a list of lines."""
    found = re.findall(r"(?:^    .*\n)+", text, re.M)
    return [[line[4:] for line in block.splitlines()] for block in found]


def one_of(all_blocks, start):
    return next(block for block in all_blocks if block[0].startswith(start))


def listening(hosts, k):
    """IPv4 ports where somebody listens on host k beyond its loopback."""
    out = subprocess.run(hosts.words(k, ["ss", "-Hltn4"]), capture_output=True, text=True, check=True).stdout
    places = [line.split()[3] for line in out.splitlines()]
    return {int(place.rsplit(":", 1)[1]) for place in places if not place.startswith("127.")}


def main():
    treefarm, scene = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    reason = why_not() or ("" if shutil.which("mpirun") else "there is no mpirun")
    if reason:
        print(f"skipped: {reason}")
        sys.exit(77)
    page = (ROOT / "docs" / "use" / "cluster.md").read_text()
    commands = blocks(section(page, "Machines with ssh"))
    hostfile, versions, picture = (one_of(commands, start) for start in ("node1", "treefarm --version", "treefarm launch"))
    ports = one_of(blocks(section(page, "Which network, which ports")), "export OMPI")
    assert NETWORK in picture[0], f"the page's network is not {NETWORK}"
    names = [line.split()[0] for line in hostfile]
    with tempfile.TemporaryDirectory(dir="/var/tmp") as folder:
        work = pathlib.Path(folder)
        (work / "scene.xml").write_text(re.sub(r'(<default name="size" value=)"\d+"', r'\1"64"', scene.read_text()))
        (work / "hosts").write_text("\n".join(hostfile) + "\n")
        place = work / "network"
        place.mkdir()
        with VirtualHosts(place, len(names), names) as hosts:
            (work / "bin").mkdir()
            (work / "bin" / "ssh").write_text(SSH.format(agent=hosts.agent))
            (work / "bin" / "ssh").chmod(0o755)
            (work / "bin" / "treefarm").symlink_to(treefarm)
            variables = {**environment(), "PATH": f"{work}/bin:{os.environ['PATH']}"}
            hosts.environment.update(variables)

            def shell(lines):
                return subprocess.Popen(hosts.words(0, ["sh", "-ec", "\n".join(lines)], work), env=variables, stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, text=True)

            said = shell(versions).communicate()[0].split("treefarm ")
            assert len(said) == 3 and said[1] == said[2], f"{versions} say {said}"
            begin = time.monotonic()
            process = shell([*ports, *picture])
            seen, limit = set(), begin + DEADLINE
            while process.poll() is None:
                if time.monotonic() > limit:
                    process.kill()
                    sys.exit(f"FAILED: no picture within {DEADLINE} s: {process.communicate()[0]}")
                for k in range(len(names)):
                    seen |= listening(hosts, k)
                time.sleep(0.5)
            output = process.communicate()[0]
            assert process.returncode == 0, f"exit code {process.returncode}: {output}"
            seconds = time.monotonic() - begin
        workers = {name for name in names if f"on {name} " in (work / "picture" / "log.txt").read_text()}
        assert workers == set(names), f"only {workers} took part"
        strangers = {port for port in seen if not any(port in one for one in RANGES)}
        alone = picture[0].split(" -- ")[1].replace("--run-dir picture", "--run-dir alone").split()
        subprocess.run([str(treefarm), *alone], check=True, cwd=work, env=environment(), capture_output=True)
        assert hashes(work / "picture") == hashes(work / "alone"), f"{hashes(work / 'picture')} != {hashes(work / 'alone')}"
        print(f"the page's picture after {seconds:.1f} s on {len(names)} hosts, same bits as alone; ports {sorted(seen)}")
        if strangers:
            print(f"FAILED: the page knows nothing of ports {sorted(strangers)}")
            sys.exit(1)


if __name__ == "__main__":
    main()
