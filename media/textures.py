#!/usr/bin/env python3
"""Writes the pictures that the scenes of `scenes/` lay on shapes: a map, planks, and leaves with holes between them."""

import math
import pathlib
import struct
import zlib

FOLDER = pathlib.Path(__file__).parent.parent / "scenes"


def chunk(kind, data):
    body = kind + data
    return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))


def write(name, width, height, palette, at):
    """Writes a PNG file of up to 16 colours (red, green, blue, opacity); `at` gives the colour's number at a pixel."""
    rows = b""
    for y in range(height):
        numbers = [at(x, y) for x in range(width)]
        rows += b"\0" + bytes(numbers[x] << 4 | numbers[x + 1] for x in range(0, width, 2))
    head = struct.pack(">IIBBBBB", width, height, 4, 3, 0, 0, 0)
    parts = chunk(b"IHDR", head) + chunk(b"PLTE", b"".join(bytes(color[:3]) for color in palette))
    if any(len(color) == 4 for color in palette):
        parts += chunk(b"tRNS", bytes((*color, 255)[3] for color in palette))
    parts += chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
    (FOLDER / name).write_bytes(b"\x89PNG\r\n\x1a\n" + parts)


def is_inside(polygon, x, y):
    inside = False
    for (x0, y0), (x1, y1) in zip(polygon, polygon[1:] + polygon[:1]):
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * (x1 - x0):
            inside = not inside
    return inside


# Outlines of land as (longitude, latitude), drawn by hand.
LAND = [
    [(-168, 66), (-156, 71), (-128, 70), (-95, 72), (-82, 68), (-94, 60), (-80, 52), (-78, 62), (-64, 58), (-56, 52),
     (-66, 45), (-76, 36), (-81, 26), (-84, 30), (-97, 27), (-97, 19), (-88, 21), (-84, 11), (-78, 8), (-95, 15),
     (-106, 22), (-115, 31), (-124, 41), (-126, 50), (-140, 59), (-154, 58), (-164, 61)],
    [(-80, 9), (-62, 10), (-50, 0), (-35, -6), (-40, -20), (-48, -27), (-58, -37), (-66, -46), (-70, -54), (-75, -48),
     (-71, -20), (-81, -5)],
    [(-17, 21), (-6, 35), (10, 37), (20, 32), (32, 31), (43, 12), (51, 11), (40, -8), (34, -25), (20, -34), (12, -18),
     (9, 3), (-8, 5), (-17, 14)],
    [(-9, 37), (-9, 43), (-1, 46), (3, 51), (9, 57), (5, 61), (16, 69), (40, 66), (60, 69), (80, 73), (105, 77),
     (130, 72), (160, 70), (179, 66), (163, 58), (156, 52), (155, 60), (140, 54), (128, 42), (127, 36), (118, 38),
     (121, 30), (108, 20), (107, 11), (103, 2), (99, 10), (94, 17), (88, 22), (80, 15), (77, 8), (72, 20), (66, 25),
     (56, 26), (52, 16), (44, 13), (35, 29), (36, 36), (28, 37), (23, 38), (18, 40), (12, 45), (16, 39), (8, 44),
     (0, 39)],
    [(114, -22), (122, -17), (131, -12), (137, -12), (142, -11), (153, -26), (149, -38), (138, -34), (129, -32),
     (115, -34)],
    [(-54, 60), (-44, 60), (-22, 70), (-20, 80), (-40, 83), (-68, 78)],
    [(-180, -90), (-180, -76), (-120, -73), (-62, -66), (-60, -75), (0, -70), (60, -67), (140, -66), (180, -76),
     (180, -90)],
    [(131, 31), (136, 34), (140, 36), (142, 43), (139, 39), (133, 35)],
    [(-5, 50), (1, 52), (-3, 58), (-6, 57)],
    [(44, -25), (50, -15), (47, -25)],
    [(95, 5), (106, -6), (103, -6)],
    [(109, 1), (117, 6), (116, -4)],
    [(131, -1), (147, -6), (140, -8)],
    [(167, -46), (174, -41), (178, -38), (175, -36), (173, -40)],
]


def world(x, y):
    longitude, latitude = (x + 0.5) / 160 * 360 - 180, 90 - (y + 0.5) / 80 * 180
    is_land = any(is_inside(polygon, longitude, latitude) for polygon in LAND)
    if is_land and (latitude < -66 or (longitude < -18 and longitude > -70 and latitude > 59) or latitude > 74):
        return 4
    if is_land:
        sahara = 13 < latitude < 32 and -20 < longitude < 72
        australia = -31 < latitude < -18 and 118 < longitude < 143
        kalahari = -27 < latitude < -18 and 10 < longitude < 24
        return 3 if sahara or australia or kalahari else 2
    is_grid = x % 20 == 0 or y % 20 == 0
    return 1 if is_grid else 0


def noise(x, y):
    """Returns a number from 0 to 1 that looks random."""
    bits = (x * 374761393 + y * 668265263) & 0xFFFFFFFF
    bits = (bits ^ bits >> 13) * 1274126177 & 0xFFFFFFFF
    return (bits ^ bits >> 16) / 2**32


def planks(x, y):
    plank, across = y // 16, y % 16
    if across == 0 or x == (plank * 23 + 9) % 64:
        return 0
    grain = math.sin(0.9 * across + 1.6 * math.sin(x / 64 * 2 * math.pi + plank * 2) + plank)
    return 1 + min(4, int(2.2 + 1.3 * grain + 0.9 * noise(plank, (x - plank * 23 - 9) % 64 // 64)))


LEAVES = [(noise(leaf, 1) * 64, noise(leaf, 2) * 64, noise(leaf, 3) * math.pi, leaf % 3) for leaf in range(46)]


def leaves(x, y):
    found = 0
    for middle_x, middle_y, turn, shade in LEAVES:
        # The picture repeats without a seam.
        dx, dy = (x - middle_x + 32) % 64 - 32, (y - middle_y + 32) % 64 - 32
        along, across = dx * math.cos(turn) + dy * math.sin(turn), dy * math.cos(turn) - dx * math.sin(turn)
        width = 2.6 * (1 - (along / 7) ** 2)
        if abs(along) < 7 and abs(across) < width:
            found = 4 if abs(across) < 0.4 else 1 + shade
    return found


SEA, LINE, GREEN, SAND, ICE = (44, 96, 138), (70, 122, 160), (104, 138, 74), (200, 174, 118), (236, 240, 240)
write("world.png", 160, 80, [SEA, LINE, GREEN, SAND, ICE], world)
write("planks.png", 64, 64, [(70, 42, 24), (120, 76, 44), (134, 86, 50), (148, 97, 58), (160, 107, 66), (172, 118, 75)], planks)
write("leaves.png", 64, 64, [(74, 104, 40, 0), (74, 122, 44), (98, 146, 52), (128, 168, 66), (168, 190, 104)], leaves)
