#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A cable with a delay, for kernels without netem: a card in each of two network namespaces, and frames of one arrive at the other so much
later. Prints "ready", and goes on until it is ended.

usage: long_cable.py NAMESPACE CARD NAMESPACE CARD SECONDS
"""
import ctypes
import fcntl
import os
import queue
import struct
import sys
import threading
import time

SET_INTERFACE, TAP, NO_INFORMATION = 0x400454CA, 0x0002, 0x1000  # linux/if_tun.h
NETWORK = 0x40000000  # CLONE_NEWNET
LONGEST = 65536


def card(space, name):
    """A new card in a namespace, as a file of frames."""
    with open(f"/run/netns/{space}") as file:
        if ctypes.CDLL(None, use_errno=True).setns(file.fileno(), NETWORK) != 0:
            raise OSError(ctypes.get_errno(), f"cannot enter {space}")
    frames = os.open("/dev/net/tun", os.O_RDWR)
    fcntl.ioctl(frames, SET_INTERFACE, struct.pack("16sH22x", name.encode(), TAP | NO_INFORMATION))
    return frames


def carry(source, sink, seconds):
    """Frames from one end to the other."""
    on_the_way = queue.SimpleQueue()

    def deliver():
        while True:
            due, frame = on_the_way.get()
            time.sleep(max(0.0, due - time.monotonic()))
            try:
                os.write(sink, frame)
            except OSError:  # nobody has brought that card up yet
                pass

    def take():
        while True:
            frame = os.read(source, LONGEST)
            on_the_way.put((time.monotonic() + seconds, frame))

    for act in (deliver, take):
        threading.Thread(target=act, daemon=True).start()


def main():
    first, second = card(sys.argv[1], sys.argv[2]), card(sys.argv[3], sys.argv[4])
    seconds = float(sys.argv[5])
    carry(first, second, seconds)
    carry(second, first, seconds)
    print("ready", flush=True)
    threading.Event().wait()


if __name__ == "__main__":
    main()
