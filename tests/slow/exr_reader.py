# SPDX-License-Identifier: Apache-2.0
"""A reader of scan-line OpenEXR files without anything but Python: uncompressed, RLE, ZIPS, ZIP and PIZ; half and float.

The layout is that of "Technical Introduction to OpenEXR" and, for PIZ (Haar wavelets in integers, then Huffman codes),
of ImfPizCompressor.cpp, ImfWav.cpp and ImfHuf.cpp of OpenEXR 2. What such a file may not say raises ValueError or IndexError.
"""
import struct
import zlib

LINES = {0: 1, 1: 1, 2: 1, 3: 16, 4: 32}  # of a chunk, by compression: none, RLE, ZIPS, ZIP, PIZ
SHORT_ZERO_RUN, LONG_ZERO_RUN = 59, 63  # lengths of codes from here on are runs of unused symbols


def read(path):
    """Width, height and the channels by name: lists of width * height numbers, row by row."""
    data = open(path, "rb").read()
    if data[:4] != b"\x76\x2f\x31\x01" or data[5] & 0x1a:
        raise ValueError(f"{path}: no scan-line OpenEXR file of one part")
    header, at = _header(data)
    channels = _channels(header["channels"])
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height, compression = x1 - x0 + 1, y1 - y0 + 1, header["compression"][0]
    if compression not in LINES:
        raise ValueError(f"{path}: compression {compression} is not read here")
    lines = LINES[compression]
    pixels = {name: [] for name, _ in channels}
    chunks = sorted(struct.unpack_from("<ii", data, o) + (o,)
                    for o in struct.unpack_from(f"<{-(-height // lines)}Q", data, at))
    for y, size, offset in chunks:
        rows = min(lines, y1 - y + 1)
        block = _unpacked(data[offset + 8:offset + 8 + size], compression, channels, width, rows)
        place = 0
        for _ in range(rows):
            for name, kind in channels:
                pixels[name] += struct.unpack_from(f"<{width}{kind}", block, place)
                place += width * struct.calcsize(kind)
    return width, height, pixels


def _text(data, at):
    end = data.index(0, at)
    return data[at:end].decode(), end + 1


def _header(data):
    at, header = 8, {}
    while data[at]:
        name, at = _text(data, at)
        _, at = _text(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return header, at + 1


def _channels(table):
    at, channels = 0, []
    while table[at]:
        name, at = _text(table, at)
        channels.append((name, "Ief"[struct.unpack_from("<i", table, at)[0]]))
        at += 16
    return channels


def _unpacked(packed, compression, channels, width, rows):
    full = rows * width * sum(struct.calcsize(kind) for _, kind in channels)
    if compression == 0 or len(packed) >= full:  # what does not shrink is stored as it is
        return packed
    if compression == 4:
        return _piz(packed, channels, width, rows)
    data = bytearray(zlib.decompress(packed) if compression > 1 else _run_lengths(packed))
    for i in range(1, len(data)):
        data[i] = data[i - 1] + data[i] - 128 & 255
    half = (len(data) + 1) // 2
    whole = bytearray(len(data))
    whole[0::2], whole[1::2] = data[:half], data[half:]
    return whole


def _run_lengths(packed):
    out, at = bytearray(), 0
    while at < len(packed):
        count = packed[at] - 256 if packed[at] > 127 else packed[at]
        out += packed[at + 1:at + 1 - count] if count < 0 else packed[at + 1:at + 2] * (count + 1)
        at += 1 - count if count < 0 else 2
    return out


def _piz(packed, channels, width, rows):
    first, last = struct.unpack_from("<HH", packed)
    used = bytes(first) + packed[4:4 + max(last - first + 1, 0)]  # one bit per 16-bit value that occurs
    values = [0] + [i for i in range(1, 8 * len(used)) if used[i >> 3] >> (i & 7) & 1]
    at = 4 + max(last - first + 1, 0)
    (size,) = struct.unpack_from("<i", packed, at)
    words = [struct.calcsize(kind) // 2 for _, kind in channels]
    numbers = _huffman(packed[at + 4:at + 4 + size], width * rows * sum(words))
    planes, start = [], 0
    for count in words:
        plane = numbers[start:start + width * rows * count]
        for word in range(count):
            _wavelet(plane, word, width, count, rows, width * count, len(values) - 1)
        planes.append(plane)
        start += len(plane)
    out = []
    for y in range(rows):
        for plane, count in zip(planes, words):
            out += [values[v] for v in plane[y * width * count:(y + 1) * width * count]]
    return struct.pack(f"<{len(out)}H", *out)


def _huffman(data, count):
    first, last, _, bits, _ = struct.unpack_from("<5I", data)
    stream, total = int.from_bytes(data, "big"), 8 * len(data)
    at = 160

    def take(n):
        nonlocal at
        at += n
        return stream >> (total - at) & (1 << n) - 1

    lengths, symbol = {}, first
    while symbol <= last:
        length = take(6)
        if length == LONG_ZERO_RUN:
            symbol += take(8) + 6
        elif length >= SHORT_ZERO_RUN:
            symbol += length - SHORT_ZERO_RUN + 2
        else:
            if length:
                lengths[symbol] = length
            symbol += 1
    of_length = [0] * 60
    for length in lengths.values():
        of_length[length] += 1
    code = 0
    for length in range(58, 0, -1):  # the canonical code: the longest ones count from 0
        of_length[length], code = code, (code + of_length[length]) >> 1
    symbols = {}
    for symbol in sorted(lengths):
        symbols[lengths[symbol], of_length[lengths[symbol]]] = symbol
        of_length[lengths[symbol]] += 1

    text = format(stream, f"0{total}b")[-(-at // 8) * 8:][:bits]
    out, code, length, at = [], 0, 0, 0
    while at < len(text) and len(out) < count:
        code, length, at = code << 1 | (text[at] == "1"), length + 1, at + 1
        symbol = symbols.get((length, code))
        if symbol is None:
            continue
        if symbol == last:  # the greatest one says: the number before, so many times more
            out += out[-1:] * int(text[at:at + 8], 2)
            at += 8
        else:
            out.append(symbol)
        code = length = 0
    if len(out) != count:
        raise ValueError("Huffman codes of another length than the chunk")
    return out


def _wavelet(a, start, nx, ox, ny, oy, greatest):
    def pair(low, high):
        if greatest < 1 << 14:
            low, high = low - (low >> 15 << 16), high - (high >> 15 << 16)
            first = low + (high & 1) + (high >> 1)
            return first & 0xffff, first - high & 0xffff
        second = low - (high >> 1) & 0xffff
        return high + second - 0x8000 & 0xffff, second

    def join(i, j):
        a[i], a[j] = pair(a[i], a[j])

    step = 1
    while 2 * step <= min(nx, ny):
        step *= 2
    while step > 1:
        half = step // 2
        wide, tall = nx - nx % step, ny - ny % step
        for y in range(0, tall, step):
            row = start + y * oy
            for x in range(0, wide, step):
                p = row + x * ox
                join(p, p + half * oy)
                join(p + half * ox, p + half * oy + half * ox)
                join(p, p + half * ox)
                join(p + half * oy, p + half * oy + half * ox)
            if nx & half:
                join(row + wide * ox, row + wide * ox + half * oy)
        if ny & half:
            for x in range(0, wide, step):
                p = start + tall * oy + x * ox
                join(p, p + half * ox)
        step = half
