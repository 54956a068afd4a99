"""Prints glyphs.rs: the coverage of 8x16 samples of a cell by the characters of outlines, in DejaVu Sans Mono.

usage: python3 glyphs.py [DejaVuSansMono.ttf] >glyphs.rs    (needs Pillow)
"""

import sys
from PIL import Image, ImageDraw, ImageFont

path = sys.argv[1] if len(sys.argv) > 1 else "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf"
font = ImageFont.truetype(path, 512)
size = round(font.getlength("M")), sum(font.getmetrics())
# A character that matches as well as another one is chosen if its penalty is less: unusual ones distract.
penalties = {'(': .004, ')': .004, '"': .004, '^': .006, '~': .012, ':': .012, ';': .014, '<': .02, '>': .02}

print("//! The ink of the characters of outlines in `DejaVu` Sans Mono, made by `glyphs.py`.")
print()
print("/// Each character, its penalty, and its rows from the top, with a digit of 0 to 15 for each of 8 samples.")
print("#[rustfmt::skip]")
print("#[allow(clippy::unreadable_literal, reason = \"a digit for each sample\")]")
print("pub(super) const GLYPHS: [(u8, f32, [u32; 16]); 18] = [")
for character in "/\\|-_'.,`()\"^~:;<>":
    cell = Image.new("L", size)
    ImageDraw.Draw(cell).text((0, 0), character, font=font, fill=255)
    samples = [round(15 * sample / 255) for sample in cell.resize((8, 16), Image.Resampling.BOX).tobytes()]
    rows = ["".join(f"{sample:x}" for sample in samples[at:at + 8]) for at in range(0, 128, 8)]
    quoted = {"\\": "\\\\", "'": "\\'"}.get(character, character)
    print(f"    (b'{quoted}', {penalties.get(character, 0.0)}, [")
    for half in rows[:8], rows[8:]:
        print("        " + ", ".join(f"0x{row}" for row in half) + ",")
    print("    ]),")
print("];")
