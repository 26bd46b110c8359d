#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Takes the texts out of the headers of OpenEXR files (one part, scan lines), in place: they name paths of a machine.

usage: strip_header.py FILE..."""
import struct
import sys


def stripped(data):
    """The file without attributes of type string."""
    at, kept, window, compression = 8, data[:8], None, 0
    while data[at]:
        begin = at
        name_end = data.index(b"\0", at)
        type_end = data.index(b"\0", name_end + 1)
        size = struct.unpack_from("<i", data, type_end + 1)[0]
        value = type_end + 5
        at = value + size
        name = data[begin:name_end]
        if name == b"dataWindow":
            window = struct.unpack_from("<4i", data, value)
        if name == b"compression":
            compression = data[value]
        if data[name_end + 1:type_end] != b"string":
            kept += data[begin:at]
    kept += b"\0"
    rows = {0: 1, 1: 1, 2: 1, 3: 16, 4: 32}[compression]  # of a chunk: none, RLE, ZIPS, ZIP, PIZ
    chunks = -(-(window[3] - window[1] + 1) // rows)
    offsets = struct.unpack_from(f"<{chunks}Q", data, at + 1)
    shift = at + 1 - len(kept)
    return kept + struct.pack(f"<{chunks}Q", *(offset - shift for offset in offsets)) + data[at + 1 + 8 * chunks:]


for path in sys.argv[1:]:
    with open(path, "rb") as file:
        content = stripped(file.read())
    with open(path, "wb") as file:
        file.write(content)
