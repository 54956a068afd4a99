"""Prints glyphs.rs: the coverage of the samples of a cell by the printable ASCII characters in DejaVu Sans Mono.

usage: python3 glyphs.py [DejaVuSansMono.ttf] >glyphs.rs    (needs Pillow)

A cell is as wide as the font's characters and as high as its lines (ascent and descent). The characters are drawn
large, so that hinting has no effect.
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
    """Returns the coverage of each sample, row by row from the top; 255 is full."""
    cell = Image.new("L", (width, height))
    ImageDraw.Draw(cell).text((0, 0), character, font=font, fill=255)
    return list(cell.resize((ACROSS, DOWN), Image.Resampling.BOX).tobytes())


print("//! The ink of the printable ASCII characters in `DejaVu` Sans Mono, made by `glyphs.py`.")
print()
print("/// Columns of samples in a cell.")
print(f"pub(super) const SAMPLE_COLUMNS: usize = {ACROSS};")
print("/// Rows of samples in a cell.")
print(f"pub(super) const SAMPLE_ROWS: usize = {DOWN};")
print()
print("/// Coverage of each sample by the characters from space on, row by row from the top; 255 is full.")
print("#[rustfmt::skip]")
print("pub(super) const INK: [[u8; SAMPLE_COLUMNS * SAMPLE_ROWS]; 95] = [")
for code in range(32, 127):
    numbers = ", ".join(f"{part:3}" for part in ink(chr(code)))
    print(f"    [{numbers}], // {chr(code) if code > 32 else 'space'}")
print("];")
