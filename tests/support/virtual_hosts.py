# SPDX-License-Identifier: Apache-2.0
"""Hosts that are namespaces of this machine: each with a network card of its own, its own /tmp, /dev/shm, process numbers and name.

They hang on one switch, 10.78.0.0/24, host k at 10.78.0.(10 + k), the switch itself at 10.78.0.1. Needs root, iproute2
and util-linux; why_not() says what is missing. Files outside /tmp and /dev/shm are shared, as by a network disk. A host ends with the
object, or when it is crashed.
"""
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time

NETWORK = "10.78.0.0/24"

AGENT = """#!{python} -IS
# usage: agent HOST COMMAND...: as ssh would, but into a virtual host
import json, os, socket, sys
door = socket.socket(socket.AF_UNIX)
door.connect("{door}")
place = os.getcwd()
socket.send_fds(door, [json.dumps([sys.argv[1], place, " ".join(sys.argv[2:])]).encode()], [0, 1, 2])
sys.exit((door.recv(1) or bytes([255]))[0])
"""


def why_not():
    """Why there can be no virtual hosts here; empty: there can."""
    for program in ("ip", "unshare", "nsenter"):
        if shutil.which(program) is None:
            return f"there is no program {program}"
    if os.geteuid() != 0:
        return "only root may make network namespaces"
    name = f"tfprobe{os.getpid()}"
    made = subprocess.run(["ip", "netns", "add", name], capture_output=True, text=True)
    if made.returncode != 0:
        return f"network namespaces are not permitted: {made.stderr.strip()}"
    subprocess.run(["ip", "netns", "del", name], check=True)
    return ""


def run(*words):
    subprocess.run(words, check=True, capture_output=True)


class VirtualHosts:
    def __init__(self, folder, count, names=None):
        """`folder`: outside /tmp, for a hosts file and the agent that Open MPI and launch use in place of ssh."""
        self.folder = pathlib.Path(folder)
        self.names = names or [f"vh{k}" for k in range(count)]
        self.prefix = f"tf{os.getpid()}"
        self.switch = f"{self.prefix}sw"
        self.keepers, self.inits, self.cables = [], [], []
        self.door = None
        self.environment = dict(os.environ)  # of what the agent starts, as a login would have it
        self.hosts_file = self.folder / "etc-hosts"
        self.hosts_file.write_text("127.0.0.1 localhost\n" + "".join(
            f"{self.address(k)} {name}\n" for k, name in enumerate(self.names)))
        self.agent = self.folder / "agent"
        try:
            self._make_switch()
            for k in range(count):
                self._make_host(k)
            self._write_agent()
        except BaseException:
            self.close()
            raise

    def _make_switch(self):
        run("ip", "netns", "add", self.switch)
        run("ip", "-n", self.switch, "link", "add", "br0", "type", "bridge")
        run("ip", "-n", self.switch, "link", "set", "br0", "up")
        run("ip", "-n", self.switch, "link", "set", "lo", "up")
        run("ip", "-n", self.switch, "addr", "add", f"{self.at_switch()}/24", "dev", "br0")

    def _make_host(self, k):
        space = f"{self.prefix}h{k}"
        run("ip", "netns", "add", space)
        run("ip", "-n", self.switch, "link", "add", f"port{k}", "type", "veth", "peer", "name", "eth0", "netns", space)
        run("ip", "-n", self.switch, "link", "set", f"port{k}", "master", "br0", "up")
        run("ip", "-n", space, "link", "set", "lo", "up")
        run("ip", "-n", space, "addr", "add", f"{self.address(k)}/24", "dev", "eth0")
        run("ip", "-n", space, "link", "set", "eth0", "up")
        first = (f"hostname {self.names[k]} && mount -t tmpfs none /tmp && mount -t tmpfs none /dev/shm && "
                 f"mount --bind {self.hosts_file} /etc/hosts && mount -t proc none /proc && echo ready && exec sleep infinity")
        # Not by ip netns exec: that mounts a /sys without control groups.
        keeper = subprocess.Popen(["nsenter", f"--net=/run/netns/{space}", "unshare", "--uts", "--mount", "--pid", "--fork",
                                   "--kill-child", "sh", "-c", first], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                                  start_new_session=True)
        self.keepers.append(keeper)
        if keeper.stdout.readline() != "ready\n":
            raise RuntimeError(f"host {self.names[k]} does not come up")
        self.inits.append(int(pathlib.Path(f"/proc/{keeper.pid}/task/{keeper.pid}/children").read_text().split()[0]))

    def _write_agent(self):
        """A process of one host cannot see those of another: who asks for a host is let in from outside."""
        self.door = socket.socket(socket.AF_UNIX)
        self.door.bind(str(self.folder / "door"))
        self.door.listen(64)
        threading.Thread(target=self._let_in, daemon=True).start()
        self.agent.write_text(AGENT.format(python=sys.executable, door=self.folder / "door"))
        self.agent.chmod(0o755)

    def _let_in(self):
        while True:
            try:
                visitor, _ = self.door.accept()
            except OSError:
                return
            threading.Thread(target=self._serve, args=(visitor,), daemon=True).start()

    def _serve(self, visitor):
        """Runs what a visitor asks for, with its input and output; it ends where the visitor does."""
        with visitor:
            text, files, _, _ = socket.recv_fds(visitor, 1 << 20, 3)
            name, place, command = json.loads(text)
            code = 255
            if name in self.names and self.is_up(self.names.index(name)):
                process = subprocess.Popen(self.words(self.names.index(name), ["/bin/sh", "-c", command], place), env=self.environment,
                                           stdin=files[0], stdout=files[1], stderr=files[2])
                threading.Thread(target=self._watch, args=(visitor, process), daemon=True).start()
                code = process.wait()
            for file in files:
                os.close(file)
            try:
                visitor.sendall(bytes([code % 256]))
            except OSError:
                pass

    @staticmethod
    def _watch(visitor, process):
        try:
            if visitor.recv(1) == b"":
                process.terminate()
        except OSError:
            pass

    def is_up(self, k):
        return self.keepers[k].poll() is None

    def hostfile(self, hosts=None):
        path = self.folder / "hostfile"
        path.write_text("".join(f"{name} slots=2\n" for name in hosts or self.names))
        return path

    def words(self, k, command, place=None):
        """The command line that runs a command on host k, in this folder or `place`."""
        return ["nsenter", "-t", str(self.inits[k]), "-n", "-u", "-m", "-p", f"--wd={place or os.getcwd()}", "--", *command]

    @staticmethod
    def address(k):
        return f"10.78.0.{10 + k}"

    @staticmethod
    def at_switch():
        """Address of the switch itself, where a service for all hosts may listen."""
        return "10.78.0.1"

    def words_at_switch(self):
        """What runs a command with the network of the switch, and all else as this process has it."""
        return ["nsenter", f"--net=/run/netns/{self.switch}", "--"]

    def cut(self, k):
        """Pulls the cable at the switch."""
        run("ip", "-n", self.switch, "link", "set", f"port{k}", "down")

    def plug(self, k):
        run("ip", "-n", self.switch, "link", "set", f"port{k}", "up")

    def shape(self, k, *discipline):
        """Slows a host's link in both directions: ("tbf", "rate", "10mbit", ...) or ("netem", "delay", "20ms"). False where the kernel has
        no such discipline."""
        ends = (("-n", self.switch, f"port{k}"), ("-n", f"{self.prefix}h{k}", "eth0"))
        return all(subprocess.run(["tc", flag, space, "qdisc", "replace", "dev", card, "root", *discipline],
                                  capture_output=True).returncode == 0 for flag, space, card in ends)

    def lengthen(self, k, seconds):
        """Gives a host a cable on which everything takes so much longer; by the kernel where it can do that. False: it cannot be done."""
        if self.shape(k, "netem", "delay", f"{round(1000 * seconds)}ms"):
            return True
        if not pathlib.Path("/dev/net/tun").exists():
            return False
        space, port = f"{self.prefix}h{k}", f"port{k}"
        facts = json.loads(subprocess.run(["ip", "-n", space, "-j", "link", "show", "eth0"], check=True, capture_output=True).stdout)
        run("ip", "-n", space, "link", "del", "eth0")  # and the other end with it
        program = pathlib.Path(__file__).with_name("long_cable.py")
        cable = subprocess.Popen([sys.executable, str(program), self.switch, port, space, "eth0", str(seconds)],
                                 stdout=subprocess.PIPE, text=True)
        self.cables.append(cable)
        if cable.stdout.readline() != "ready\n":
            return False
        # Others know the host by its card's address.
        run("ip", "-n", space, "link", "set", "eth0", "address", facts[0]["address"])
        run("ip", "-n", self.switch, "link", "set", port, "master", "br0", "up")
        run("ip", "-n", space, "link", "set", "eth0", "up")
        run("ip", "-n", space, "addr", "add", f"{self.address(k)}/24", "dev", "eth0")
        return True

    def crash(self, k):
        """All processes of the host end at once, and its network with them."""
        self.cut(k)
        os.kill(self.inits[k], signal.SIGKILL)
        self.keepers[k].wait()

    def close(self):
        if self.door:
            self.door.shutdown(socket.SHUT_RDWR)
            self.door.close()
            (self.folder / "door").unlink(missing_ok=True)
        for init in self.inits:
            try:
                os.kill(init, signal.SIGKILL)
            except ProcessLookupError:
                pass
        for keeper in [*self.cables, *self.keepers]:
            keeper.kill()
            keeper.wait()
        time.sleep(0.1)
        for space in [self.switch, *(f"{self.prefix}h{k}" for k in range(len(self.names)))]:
            subprocess.run(["ip", "netns", "del", space], capture_output=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
