#!/usr/bin/env python3
"""Draws icon.png, the picture of icon.svg in 64 x 64 pixels: python3 draw.py"""

import pathlib
import struct
import zlib

SIDE, FINE = 64, 4
WHITE, WATER, SEABED, HULL, LINE = (255, 255, 255), (86, 140, 190), (139, 110, 70), (48, 48, 48), (0, 114, 178)
ENDS = (46, 20), (42, 40), (30, 54), (6, 56)


def curve(t):
    weights = (1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3
    return tuple(sum(w * p[axis] for w, p in zip(weights, ENDS)) for axis in (0, 1))


POINTS = [curve(k / 200) for k in range(201)]


def colour(x, y):
    if min((x - px) ** 2 + (y - py) ** 2 for px, py in POINTS) < 1.5**2:
        return LINE
    if 40 <= x < 60 and 8 <= y < 20:
        return HULL
    if y >= 56:
        return SEABED
    return WATER if 14 <= y < 17 else WHITE


def pixel(i, j):
    parts = [colour(i + (k + 0.5) / FINE, j + (m + 0.5) / FINE) for k in range(FINE) for m in range(FINE)]
    return bytes(round(sum(part[channel] for part in parts) / len(parts)) for channel in range(3))


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


rows = b"".join(b"\0" + b"".join(pixel(i, j) for i in range(SIDE)) for j in range(SIDE))
head = struct.pack(">IIBBBBB", SIDE, SIDE, 8, 2, 0, 0, 0)
png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
pathlib.Path(__file__).with_name("icon.png").write_bytes(png)
