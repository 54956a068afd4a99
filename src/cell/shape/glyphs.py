"""Prints glyphs.rs: how much of each part of a cell the printable characters of ASCII cover, in DejaVu Sans Mono.

usage: python3 glyphs.py [DejaVuSansMono.ttf] >glyphs.rs    (needs Pillow)

A cell is as wide as the font's characters and as high as its lines (ascent and descent); the characters are drawn large,
so that no hinting of a size shows.
"""

import sys
from PIL import Image, ImageDraw, ImageFont

ACROSS, DOWN = 2, 4
SIZE = 512

path = sys.argv[1] if len(sys.argv) > 1 else "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf"
font = ImageFont.truetype(path, SIZE)
width = round(font.getlength("M"))
ascent, descent = font.getmetrics()
height = ascent + descent


def ink(character):
    """The coverage of each part, row by row from the top, 255 for all of it."""
    cell = Image.new("L", (width, height))
    ImageDraw.Draw(cell).text((0, 0), character, font=font, fill=255)
    return list(cell.resize((ACROSS, DOWN), Image.Resampling.BOX).tobytes())


print("//! Made by `glyphs.py` beside this file: the ink of the printable characters of ASCII in `DejaVu` Sans Mono.")
print()
print("/// Parts of a cell, from left to right.")
print(f"pub(super) const SAMPLE_COLUMNS: usize = {ACROSS};")
print("/// Parts of a cell, from top to bottom.")
print(f"pub(super) const SAMPLE_ROWS: usize = {DOWN};")
print()
print("/// How much of each part the characters from space on cover, row by row from the top; 255 is all of it.")
print("#[rustfmt::skip]")
print("pub(super) const INK: [[u8; SAMPLE_COLUMNS * SAMPLE_ROWS]; 95] = [")
for code in range(32, 127):
    numbers = ", ".join(f"{part:3}" for part in ink(chr(code)))
    print(f"    [{numbers}], // {chr(code) if code > 32 else 'space'}")
print("];")
