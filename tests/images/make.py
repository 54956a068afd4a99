#!/usr/bin/env python3
"""Writes the pictures of this folder, which the tests of images lay on shapes, and meshes that name them."""

import pathlib
import struct
import zlib

FOLDER = pathlib.Path(__file__).parent
RGB, RGBA = 2, 6


def chunk(kind, data):
    body = kind + data
    return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))


def png(width, height, kind, rows):
    head = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    data = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows), 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


def texel(column, row):
    return [60 * column + 20, 60 * row + 20, 100]


GRID = png(4, 4, RGB, [sum((texel(c, r) for c in range(4)), []) for r in range(4)])
# Every other texel is a hole.
HOLES = png(4, 4, RGBA, [sum((texel(c, r) + [255 * ((c + r + 1) % 2)] for c in range(4)), []) for r in range(4)])
FILES = {
    "grid.png": GRID,
    "holes.png": HOLES,
    # A picture of 1 GiB, of which there is only the head.
    "giant.png": png(32768, 32768, RGB, []),
    "cut.png": GRID[:-20],
    "nonsense.png": b"This is no picture.\n",
    "square.mtl": b"""newmtl leaf
map_Kd holes.png
map_d holes.png
newmtl veil
Kd 0.5 0.5 0.5
d 0.25
newmtl lamp
Kd 0.5 0.5 0.5
Ke 0.25 0.5 2
""",
}
CORNERS = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
for name in ["leaf", "veil", "lamp"]:
    FILES[f"{name}.obj"] = f"mtllib square.mtl\nusemtl {name}\n{CORNERS}f 1/1 2/2 3/3 4/4\n".encode()
for name, content in FILES.items():
    (FOLDER / name).write_bytes(content)
