#!/usr/bin/env python3
"""Writes the meshes of this folder: files as other programs write them, valid or nearly so.

`tests/files/odd_meshes.rs` reads each of them, and compares what is left out and what is drawn with `NAME.txt`.
"""

import base64
import json
import pathlib
import struct
import zlib

FOLDER = pathlib.Path(__file__).parent
BESIDE = FOLDER / "beside"
BESIDE.mkdir(exist_ok=True)


def write(name, content):
    (FOLDER / name).write_bytes(content if isinstance(content, bytes) else content.encode())


def beside(name, content):
    write("beside/" + name, content)


def png(rgb):
    """Returns a picture of one pixel: red, green, blue, and its opacity if there is one."""
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    head = struct.pack(">IIBBBBB", 1, 1, 8, 2 if len(rgb) == 3 else 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(b"\0" + bytes(rgb))) + chunk(b"IEND", b"")


RED = (255, 0, 0)
VERTICES = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
SQUARE = VERTICES + "f 1 2 3 4\n"
TEXTURED = VERTICES + "vt 0 0\nusemtl a\nf 1/1 2/1 3/1 4/1\n"


def obj(name, text, **mtl):
    """Writes an OBJ file, and its MTL file if there is one."""
    head = f"mtllib beside/{name}.mtl\n" if mtl else ""
    for content in mtl.values():
        beside(f"{name}.mtl", content)
    write(f"{name}.obj", head + text)


beside("t.png", png(RED))
# A: materials
for name in ["None", "(null)", "null"]:
    obj(f"a1_{name.strip('()')}{len(name)}", VERTICES + f"usemtl {name}\nf 1 2 3\n", mtl=f"newmtl {name}\nKd 1 0 0\n")
obj("a1_undefined", VERTICES + "usemtl None\nf 1 2 3\n", mtl="newmtl x\nKd 1 0 0\n")
obj("a5", VERTICES + "usemtl x\nf 1 2 3\n", mtl="newmtl x\nKd 0 0 0\nKe 1 0 0\nnewmtl unused\nKe 1 1 1\n")
obj("a9", VERTICES + "usemtl x\nf 1 2 3\n", mtl="newmtl x\nKd 0 0 1\nd 0.2\nmap_d t.png\n")
obj("a5_map", TEXTURED, mtl="newmtl a\nKd 0 0 0\nmap_Ke t.png\n")
obj("a5_bright", TEXTURED, mtl="newmtl a\nmap_Ke t.png\nKe 2 1 1\n")
obj("a9_map", TEXTURED, mtl="newmtl a\nmap_d grey.png\n")
obj("a9_whole", TEXTURED, mtl="newmtl a\nmap_d whole.png\n")
obj("a9_zero", TEXTURED, mtl="newmtl a\nd 0\nnewmtl unused\nd 0\n")
beside("grey.png", png((64, 64, 64)))
beside("whole.png", png((64, 64, 64, 255)))
beside("half.png", png((255, 0, 0, 128)))
for name, lines in {"tr": "Tr 0.75", "tr_one": "Tr 1", "d_tr": "d 0.5\nTr 1", "tr_d": "Tr 0.25\nd 1"}.items():
    obj(f"a9_{name}", TEXTURED, mtl=f"newmtl a\n{lines}\n")
obj("a9_gone", TEXTURED, mtl="newmtl a\nKd 0 1 0\nmap_d gone.png\n")
obj("a10", SQUARE + "l 1 2 3\nl 3 4\np 1 2 3\np -1\ncurv 0 1 1 2\n")
obj("a11", VERTICES + "f 1 1 2\nf 3 3 3\n")
# B: what is missing or cannot be read
obj("b1", "mtllib gone.mtl\nusemtl a\n" + SQUARE)
obj("b2", SQUARE + "f 1 2\nf 3\n")
obj("b3", TEXTURED, mtl="newmtl a\nmap_Kd gone.png\n")
obj("b4", VERTICES + "usemtl a\nf 1 2 3\nusemtl zzz\nf 1 3 4\n", mtl="newmtl a\nKd 1 0 0\n")
obj("b5", TEXTURED, mtl="newmtl a\nmap_Kd C:\\art\\t.png\n")
obj("b5_slash", TEXTURED, mtl="newmtl a\nmap_Kd /home/x/art/t.png\n")
obj("b5_gone", TEXTURED, mtl="newmtl a\nmap_Kd C:\\art\\gone.png\n")
obj("b5_folder", TEXTURED, mtl="newmtl a\nmap_Kd textures\\only here.png\n")
write("only here.png", png((0, 0, 255)))
obj("b5_mtl", "mtllib C:\\art\\b5_slash.mtl\nusemtl a\n" + SQUARE)
obj("b6", TEXTURED, mtl="newmtl a\nmap_Kd t.xcf\n")
beside("t.xcf", b"gimp xcf file\0")


# Pictures with a blue upper and a red lower half, and the MTL files that name them. Their lower half is at v = 0.25.
def bits(*numbers):
    """Packs (value, width) pairs, least significant bit first, as WebP does."""
    total, at = 0, 0
    for value, width in numbers:
        total |= value << at
        at += width
    return total.to_bytes(-(-at // 8), "little")


def webp():
    # Lossless, of 1 x 2 pixels, without transforms, a cache of colours, and further codes.
    head = [(0x2F, 8), (0, 14), (1, 14), (0, 1), (0, 3), (0, 1), (0, 1), (0, 1)]
    zero, either, opaque = [(1, 1), (0, 3)], [(1, 1), (1, 1), (1, 1), (0, 8), (255, 8)], [(1, 1), (0, 1), (1, 1), (255, 8)]
    # The codes of green, red, blue, opacity and distance; then a bit of red and one of blue per pixel.
    data = bits(*head, *zero, *either, *either, *opaque, *zero, (0, 1), (1, 1), (1, 1), (0, 1))
    chunk = b"VP8L" + struct.pack("<I", len(data)) + data + bytes(len(data) % 2)
    return b"RIFF" + struct.pack("<I", 4 + len(chunk)) + b"WEBP" + chunk


def tiff():
    pixels = bytes([0, 0, 255, 255, 0, 0])
    tags = [(256, 3, 1, 1), (257, 3, 1, 2), (258, 3, 1, 8), (259, 3, 1, 1), (262, 3, 1, 2), (273, 4, 1, 8)]
    tags += [(277, 3, 1, 3), (278, 3, 1, 2), (279, 4, 1, 6)]
    # Eight bits for each of three channels take more than the four bytes of an entry.
    entries = b"".join(
        struct.pack("<HHII", 258, 3, 3, 14) if tag == 258 else struct.pack("<HHII", *fields)
        for tag, *rest in tags
        for fields in [(tag, *rest)]
    )
    head = b"II*\0" + struct.pack("<I", 20) + pixels + struct.pack("<3H", 8, 8, 8)
    return head + struct.pack("<H", len(tags)) + entries + struct.pack("<I", 0)


def dds(fourcc=b"DXT1"):
    size = struct.pack("<7I", 124, 0x81007, 4, 4, 8, 0, 0) + bytes(44)
    head = b"DDS " + size + struct.pack("<2I4s5I", 32, 4, fourcc, 0, 0, 0, 0, 0) + struct.pack("<5I", 0x1000, 0, 0, 0, 0)
    # Two colours of 5, 6 and 5 bits, blue and red; two bits per pixel choose the first in the upper rows.
    return head + struct.pack("<HH4B", 0x1F, 0xF800, 0, 0, 0x55, 0x55)


PICTURES = {
    # The rows of BMP and TGA go upwards, those of BMP to a multiple of four bytes.
    "bmp": b"BM"
    + struct.pack("<I4xI", 62, 54)
    + struct.pack("<I2i2H6I", 40, 1, 2, 1, 24, 0, 8, 0, 0, 0, 0)
    + bytes([0, 0, 255, 0, 255, 0, 0, 0]),
    "tga": struct.pack("<3B5x4x2H2B", 0, 0, 2, 1, 2, 24, 0) + bytes([0, 0, 255, 255, 0, 0]),
    # Two colours; codes of three bits: clear, 0, 1, end.
    "gif": b"GIF89a\1\0\2\0\x80\0\0\0\0\xff\xff\0\0,\0\0\0\0\1\0\2\0\0\2\2"
    + bits((4, 3), (0, 3), (1, 3), (5, 3))
    + b"\0;",
    "tiff": tiff(),
    "webp": webp(),
    "dds": dds(),
    # With a claim of 65,535 x 65,535 pixels, and one of a kind that is not read.
    "large.bmp": b"BM" + struct.pack("<I4xI", 62, 54) + struct.pack("<I2i2H6I", 40, 65535, 65535, 1, 24, 0, 0, 0, 0, 0, 0),
    "bc7.dds": dds(b"BC7L"),
}
for kind, content in PICTURES.items():
    beside(f"half.{kind}", content)
    lower = TEXTURED.replace("vt 0 0", "vt 0.5 0.25")
    obj(f"b6_{kind.replace('.', '_')}", lower, mtl=f"newmtl a\nmap_Kd half.{kind}\n")
    if kind in ["bmp", "tiff", "gif", "webp", "dds", "tga"]:
        # Without its last bytes, which have pixels.
        beside(f"cut.{kind}", content[: len(content) * 4 // 5])
        obj(f"b6_cut_{kind}", lower, mtl=f"newmtl a\nmap_Kd cut.{kind}\n")

obj("b7", TEXTURED, mtl="newmtl a\nmap_Kd T.PNG\n")
obj("b7_quotes", TEXTURED, mtl='newmtl a\nmap_Kd "t.png"\n')
obj("b7_url", TEXTURED, mtl="newmtl a\nmap_Kd https://example.com/t.png\n")
obj("b7_mtl", TEXTURED, mtl="Kd 1\nnewmtl a\nKd spectral x.rfl\nmap_Kd t.png\n")
obj("b8_vertex", VERTICES + "v nan 0 0\nf 1 2 3 4\n")
obj("b8_used", VERTICES + "v nan 0 0\nf 1 2 3 4\nf 1 2 5\n")
obj("b8_normal", VERTICES + "vn nan nan nan\nvn 0 0 1\nf 1//1 2//2 3//2\n")
obj("b8_texture", VERTICES + "vt nan nan\nf 1/1 2/1 3/1\n")
obj("b9", VERTICES + "f 1// 2// 3//\nvt 0 0\nf 1/ 2/ 4/\nf 1/1/ 3/1/ 4/1/\n")
obj("b9_mixed", VERTICES + "vt 0 0\nf 1/1 2 3/1\n")
obj("b9_rgba", "v 0 0 0 1 0 0 1\nv 1 0 0 1 0 0 1\nv 0 1 0 1 0 0 1\nf 1 2 3\n")
obj("b10_ctrl_z", SQUARE + "\x1a")
obj("b10_nul", SQUARE + "\0\0\0")
wide = "mtllib beside/b14_utf16.mtl\nusemtl röt\n" + SQUARE + "f 1 2 €\n"
write("b14_utf16.obj", b"\xff\xfe" + wide.encode("utf-16-le"))
beside("b14_utf16.mtl", b"\xfe\xff" + "newmtl röt\nKd 1 0 0\n".encode("utf-16-be"))
obj("b13_word", SQUARE + "foo bar\n")
obj("b13_order", "f 1 2 3\n" + SQUARE + "f 1 2 9\n")
obj("c5", VERTICES + "f 1 2 3 4\n" * 700 + "f 1 2 x\nv 1 2\nf 5 1 2\nf 0 1 2\nf 1 2 3 -9\nf -1 -2 -3\n" + "f 1 2 3\n" * 100)
obj("c5_many", VERTICES + "f 1 2 3 4\n" * 100 + "f 1 2\n" * 6)

# Clouds of points, and lines alone; the colours of both.
GRID = [(x, y) for x in range(10) for y in range(10)]
obj("b15", "".join(f"v {x} {y} 0\n" for x, y in GRID))
obj("b15_colors", "".join(f"v {x} {y} 0 0 0 1\n" for x, y in GRID) + "p 1 2 -1\n")
obj("b15_lines", VERTICES + "usemtl x\nl 1/1 2/2 3/3\nl 3 9\nl 4\n", mtl="newmtl x\nKd 1 0 0\n")

# STL
FACET = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
TEXT = "solid x\n" + FACET + "endsolid x\n"
write("b10_nul.stl", TEXT + "\0")
write("b10_ctrl_z.stl", TEXT + "\x1a")
write("b2_loop.stl", TEXT.replace("endsolid", FACET.replace("vertex 1 0 0\n", "") + "endsolid"))
write("c2_comment.stl", "# made by hand\n" + TEXT)
write("c2_word.stl", TEXT.replace("endsolid", "hello\nendsolid"))
write("c5_vertex.stl", TEXT.replace("endsolid", FACET.replace("1 0 0", "1 0") + FACET + "endsolid"))
write("c3_text", TEXT)


def stl(name, count, triangles, tail=b"", header=b"", attribute=0):
    body = b""
    for i in range(triangles):
        corners = [0, 0, i, 1, 0, i, 0, 1, i]
        body += struct.pack("<12fH", 0, 0, 1, *corners, attribute + i if attribute else 0)
    write(name, header.ljust(80) + struct.pack("<I", count) + body + tail)


stl("b11_zero.stl", 0, 3)
stl("b11_low.stl", 2, 3)
stl("b11_high.stl", 9, 3)
stl("b11_bytes.stl", 3, 3, tail=b"\0\0")
stl("c3_binary", 3, 3)
stl("a8_magics.stl", 2, 2, header=b"COLOR=\xff\0\0\xffMATERIAL=", attribute=0x8000)
stl("a8_bits.stl", 2, 2, attribute=0x8000 | 0x7C00)
nan = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, float("nan"), 0, 0, 0, 1, 0, 0)
stl("b8_nan.stl", 2, 1, tail=nan)


# PLY
def ply(name, vertices, faces, vertex="", face="", head="", rows="", body="ascii", more=()):
    text = f"ply\nformat {body} 1.0\n{head}element vertex {len(vertices)}\n"
    text += "".join(f"property float {axis}\n" for axis in "xyz") + vertex
    text += f"element face {len(faces)}\nproperty list uchar int vertex_indices\n{face}{rows}end_header\n"
    write(name, text + "".join(line + "\n" for line in [*vertices, *faces, *more]))


CORNERS = ["0 0 0", "1 0 0", "1 1 0", "0 1 0"]
RGB = "property uchar red\nproperty uchar green\nproperty uchar blue\n"
ply("a6.ply", CORNERS, ["3 0 1 2 255 0 0", "3 0 2 3 0 0 255"], face=RGB)
ST = "property float s\nproperty float t\n"
ply("a7.ply", [c + " 0 0" for c in CORNERS], ["4 0 1 2 3"], vertex=ST, head="comment TextureFile beside/t.png\n")
LISTS = "property list uchar float texcoord\n"
ply("a7_lists.ply", CORNERS, ["3 0 1 2 6 0 0 1 0 1 1"], face=LISTS, head="comment TextureFile beside/t.png\n")
NUMBERS = LISTS + "property int texnumber\n"
two = "comment TextureFile beside/t.png\ncomment TextureFile only here.png\n"
rows = ["3 0 1 2 6 0 0 1 0 1 1 0", "3 0 2 3 6 0 0 1 0 1 1 1"]
ply("a7_two.ply", CORNERS, rows, face=NUMBERS, head=two)
ply("a7_gone.ply", [c + " 0 0" for c in CORNERS], ["4 0 1 2 3"], vertex=ST, head="comment TextureFile gone.png\n")
ply("b2.ply", CORNERS, ["2 0 1", "4 0 1 2 3", "0"])
ply("b2_index.ply", CORNERS, ["3 0 1 9", "4 0 1 2 3"])
ply("b8.ply", CORNERS + ["nan 0 0"], ["4 0 1 2 3"])
NORMALS = "".join(f"property float n{axis}\n" for axis in "xyz")
ply("b8_normals.ply", [c + " nan nan nan" for c in CORNERS], ["4 0 1 2 3"], vertex=NORMALS)
ply("b13.ply", CORNERS, ["4 0 1 2 3"], head="Created by x\n")
ply("c5_row.ply", CORNERS + ["1 x 0"], ["4 0 1 2 3", "3 0 1 4", "3 0 1"])
edges = "element edge 2\nproperty int vertex1\nproperty int vertex2\n"
ply("a10_edges.ply", CORNERS, ["4 0 1 2 3"], rows=edges, more=["0 1", "1 2"])
cloud = [f"{x} {y} 0 0 255 0" for x, y in GRID]
ply("b15.ply", cloud, [], vertex=RGB)
ply("b15_nan.ply", ["nan 0 0", *CORNERS], [])
ply("b15_edges.ply", [c + " 255 0 0" for c in CORNERS], [], vertex=RGB, rows=edges, more=["0 1", "1 2"])
binary = b"".join(struct.pack("<3f", *map(float, c.split())) for c in CORNERS + ["nan 0 0"])
binary += struct.pack("<B2i", 2, 0, 1) + struct.pack("<B3i", 3, 0, 1, 2) + struct.pack("<B3i", 3, 0, 1, 7)
ply("b2_binary.ply", CORNERS + ["0 0 0"], ["", "", ""], body="binary_little_endian")
text = (FOLDER / "b2_binary.ply").read_bytes()
write("b2_binary.ply", text[: text.index(b"end_header\n") + 11] + binary)


# glTF
class Gltf:
    """A document with one triangle or square, whose parts can be changed."""

    def __init__(self):
        self.bytes = b""
        self.views = []
        self.accessors = []
        self.more_buffers = []
        self.primitive = {"attributes": {"POSITION": self.floats("VEC3", [0, 0, 0, 1, 0, 0, 0, 1, 0])}}
        self.json = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [self.primitive]}],
        }

    def view(self, data):
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        self.bytes += data + bytes(-len(data) % 4)
        return len(self.views) - 1

    def accessor(self, kind, component, code, numbers, **more):
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}[kind]
        view = self.view(struct.pack(f"<{len(numbers)}{code}", *numbers))
        accessor = {"bufferView": view, "componentType": component, "type": kind, "count": len(numbers) // width}
        self.accessors.append(accessor | more)
        return len(self.accessors) - 1

    def floats(self, kind, numbers):
        return self.accessor(kind, 5126, "f", numbers)

    def document(self, uri):
        buffer = {"byteLength": len(self.bytes)}
        if uri:
            buffer["uri"] = "data:;base64," + base64.b64encode(self.bytes).decode()
        buffers = [buffer] + self.more_buffers
        return json.dumps(self.json | {"accessors": self.accessors, "bufferViews": self.views, "buffers": buffers})

    def write(self, name):
        write(name, self.document(True) + "\n")

    def write_binary(self, name, fill=b" "):
        text = self.document(False).encode()
        text += fill * (4 - len(text) % 4)
        parts = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(self.bytes), b"BIN\0") + self.bytes
        write(name, struct.pack("<4sII", b"glTF", 2, 12 + len(parts)) + parts)


def skinned():
    mesh = Gltf()
    mesh.primitive["attributes"] |= {
        "JOINTS_0": mesh.accessor("VEC4", 5121, "B", [0, 0, 0, 0] * 3),
        "WEIGHTS_0": mesh.floats("VEC4", [1, 0, 0, 0] * 3),
    }
    mesh.json["nodes"] = [{"mesh": 0, "skin": 0, "scale": [0.01] * 3}, {"scale": [1, 3, 1], "translation": [0, 0, 1]}]
    mesh.json["scenes"] = [{"nodes": [0, 1]}]
    mesh.json["skins"] = [{"joints": [1]}]
    return mesh


skinned().write("a3.gltf")
mesh = skinned()
# The inverse of the joint's own transform: the mesh as it was modelled.
inverse = [1, 0, 0, 0, 0, 1 / 3, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1]
mesh.json["skins"][0]["inverseBindMatrices"] = mesh.floats("MAT4", inverse)
mesh.write("a3_bound.gltf")
mesh = skinned()
mesh.json["skins"] = [{"joints": [7]}]
mesh.write("a3_no_joint.gltf")
mesh = Gltf()
mesh.primitive["targets"] = [{"POSITION": mesh.floats("VEC3", [0, 0, 0, 0, 0, 0, 0, 4, 0])}]
mesh.json["meshes"][0]["weights"] = [1]
mesh.write("a4.gltf")
mesh.json["nodes"][0]["weights"] = [0.5]
mesh.write("a4_node.gltf")
mesh = Gltf()
mesh.primitive["material"] = 0
mesh.json["materials"] = [{"emissiveFactor": [1, 0, 0], "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}}]
mesh.write("a5.gltf")
mesh.json["materials"] = [{"alphaMode": "MASK"}]
mesh.write("a9_mask.gltf")
mesh.json["materials"] = [{"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 0.4]}}]
mesh.write("a9_nowhere.gltf")
mesh.json["materials"] = [{"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 1, 0.2]}}]
mesh.write("a9_blend.gltf")
mesh.primitive["attributes"]["TEXCOORD_0"] = mesh.floats("VEC2", [0, 0] * 3)
mesh.json |= {"images": [{"uri": "beside/half.png"}], "textures": [{"source": 0}]}
color = {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 1, 1, 0.5]}
mesh.json["materials"] = [{"alphaMode": "MASK", "alphaCutoff": 0.3, "pbrMetallicRoughness": color}]
mesh.write("a9_texture.gltf")
mesh.json["materials"] = [{"alphaMode": "OPAQUE", "pbrMetallicRoughness": color}]
mesh.write("a9_opaque.gltf")
strength = {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}
glow = {"emissiveFactor": [0.5, 1, 1], "emissiveTexture": {"index": 0}, "extensions": strength}
mesh.json["materials"] = [glow]
mesh.write("a5_texture.gltf")
mesh.json["materials"] = [glow | {"pbrMetallicRoughness": color, "emissiveTexture": {"index": 0, "texCoord": 1}}]
mesh.write("a5_other_set.gltf")
mesh = Gltf()
mesh.json["meshes"][0]["primitives"] += [dict(mesh.primitive, mode=mode) for mode in range(4)]
mesh.write("a10.gltf")
mesh.json["meshes"][0]["primitives"] = [dict(mesh.primitive, mode=0)]
mesh.primitive["attributes"]["COLOR_0"] = mesh.floats("VEC3", [0, 0, 1] * 3)
mesh.write("b15.gltf")
mesh = Gltf()
mesh.accessors.append({"componentType": 5121, "type": "SCALAR", "count": 3})
mesh.primitive["indices"] = 1
mesh.write("a11.gltf")
mesh = Gltf()
mesh.primitive["material"] = 0
mesh.primitive["attributes"]["TEXCOORD_0"] = mesh.floats("VEC2", [0, 0] * 3)
mesh.json |= {
    "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
    "textures": [{"source": 0}],
    "images": [{"uri": "gone.png"}],
}
mesh.write("b3.gltf")
mesh.json["images"] = [{"uri": "beside/t.xcf"}]
mesh.write("b6.gltf")
mesh.json["images"] = [{"uri": "C:/art/ONLY%20HERE.png"}]
mesh.write("b5.gltf")
# A picture with a blue upper half, at v = 1.25 (or, in the last two, 2.25 and 0.4).
for name, sampler, v in [
    ("repeat", {}, 1.25),
    ("clamp", {"wrapS": 33071, "wrapT": 33071}, 1.25),
    ("mirror", {"wrapT": 33648}, 1.25),
    ("mirror_even", {"wrapT": 33648}, 2.25),
    ("nearest", {"magFilter": 9728}, 0.4),
    ("linear", {"magFilter": 9729}, 0.4),
    ("unknown", {"wrapS": 5}, 0.4),
]:
    sampled = Gltf()
    sampled.primitive["material"] = 0
    sampled.primitive["attributes"]["TEXCOORD_0"] = sampled.floats("VEC2", [0.5, v] * 3)
    sampled.json |= mesh.json | {"meshes": sampled.json["meshes"], "samplers": [sampler]}
    sampled.json |= {"images": [{"uri": "beside/half.bmp"}], "textures": [{"source": 0, "sampler": 0}]}
    sampled.write(f"d3_{name}.gltf")
obj("d3_clamp", TEXTURED.replace("vt 0 0", "vt 0.5 -0.25"), mtl="newmtl a\nmap_Kd -clamp on half.bmp\n")
mesh.json["images"] = [{"uri": "beside/t.png"}]
mesh.json["textures"] = [{"extensions": {"KHR_texture_basisu": {"source": 0}}}]
mesh.json["extensionsUsed"] = mesh.json["extensionsRequired"] = ["KHR_texture_basisu"]
mesh.write("b6_basis.gltf")
mesh = Gltf()
mesh.write_binary("b12.glb", fill=b"\0")
mesh.json["asset"] = {"version": 2.0}
mesh.write("c4_number.gltf")
mesh.json["asset"] = {"version": 2}
mesh.write("c4_integer.gltf")


# meshopt compression: encoders that take any allowed code, and each at least once.
def zigzag(difference):
    return 2 * difference if difference >= 0 else -2 * difference - 1


def varint(number):
    out = b""
    while number > 127:
        out += bytes([number & 127 | 128])
        number >>= 7
    return out + bytes([number])


def meshopt_attributes(data, stride):
    def group(deltas):
        packed = {0: b"", 3: bytes(deltas)} if any(deltas) else {0: b""}
        for mode, width in [(1, 2), (2, 4)]:
            own = 2**width - 1
            codes = [min(delta, own) for delta in deltas]
            per = 8 // width
            rows = [codes[i : i + per] for i in range(0, 16, per)]
            whole = [sum(code << (8 - width * (i + 1)) for i, code in enumerate(row)) for row in rows]
            packed[mode] = bytes(whole) + bytes(delta for delta in deltas if delta >= own)
        if any(deltas):
            del packed[0]
        mode = min(packed, key=lambda mode: len(packed[mode]))
        return mode, packed[mode]

    count = len(data) // stride
    most = min(8192 // stride & ~15, 256)
    first = last = data[:stride]
    out = b"\xa0"
    for start in range(0, count, most):
        rows = [data[i * stride : (i + 1) * stride] for i in range(start, min(start + most, count))]
        for k in range(stride):
            column = [last[k]] + [row[k] for row in rows]
            deltas = [(b - a + 128) % 256 - 128 for a, b in zip(column, column[1:])]
            deltas = [zigzag(delta) for delta in deltas]
            deltas += [0] * (-len(deltas) % 16)
            groups = [group(deltas[i : i + 16]) for i in range(0, len(deltas), 16)]
            modes = [mode for mode, _ in groups] + [0] * (-len(groups) % 4)
            out += bytes(sum(mode << 2 * i for i, mode in enumerate(modes[j : j + 4])) for j in range(0, len(modes), 4))
            out += b"".join(packed for _, packed in groups)
        last = rows[-1]
    return out + first.rjust(32, b"\0")


def meshopt_triangles(indices):
    codes, data, edges, vertices, state = [], b"", [], [], {"next": 0, "last": 0}

    def kind(vertex):
        """A new vertex, one of the last 14, or one of its own: the code, and whether it is pushed."""
        if vertex == state["next"]:
            state["next"] += 1
            return 0
        recent = vertices[::-1][:14]
        return recent.index(vertex) + 1 if vertex in recent else 15

    def own(vertex):
        difference, state["last"] = vertex - state["last"], vertex
        return varint(zigzag(difference))

    table = [0x00, 0x76, 0x87, 0x56, 0x67, 0x78, 0xA9, 0x86, 0x65, 0x89, 0x68, 0x98, 0x01, 0x69, 0, 0]
    for triangle in zip(*[iter(indices)] * 3):
        turned = [triangle[i:] + triangle[:i] for i in range(3)]
        found = [(edges[::-1][:15].index(t[:2]), t) for t in turned if t[:2] in edges[::-1][:15]]
        if found:
            back, (a, b, c) = min(found)
            code = 0
            if c == state["next"]:
                state["next"] += 1
                vertices.append(c)
            elif c in vertices[::-1][:13] and vertices[::-1].index(c) > 0:
                code = vertices[::-1].index(c)
            elif abs(c - state["last"]) == 1:
                code = 13 if c < state["last"] else 14
                state["last"] = c
                vertices.append(c)
            else:
                code = 15
                data += own(c)
                vertices.append(c)
            codes.append(back << 4 | code)
            edges += [(c, b), (a, c)]
            continue
        # A new first vertex has a shorter code.
        a, b, c = next((t for t in turned if t[0] == state["next"]), triangle)
        kinds = [kind(a)]
        if kinds[0] != 0:
            kinds = [15]
        kinds += [kind(b), kind(c)]
        pair = kinds[1] << 4 | kinds[2]
        if kinds[0] == 0 and pair in table[:14]:
            codes.append(0xF0 | table.index(pair))
        else:
            codes.append(0xFE if kinds[0] == 0 else 0xFF)
            data += bytes([pair]) + b"".join(own(v) for v, k in zip((a, b, c), kinds) if k == 15)
        vertices += [v for v, k in zip((a, b, c), kinds) if k in (0, 15)]
        edges += [(b, a), (c, b), (a, c)]
    return b"\xe1" + bytes(codes) + data + bytes(table)


def meshopt_indices(indices):
    last, data = [0, 0], b""
    for index in indices:
        nearer = min((0, 1), key=lambda i: abs(index - last[i]))
        data += varint(zigzag(index - last[nearer]) << 1 | nearer)
        last[nearer] = index
    return b"\xd1" + data + bytes(4)


class Compressed(Gltf):
    """A grid of 20 by 20 vertices, whose buffer views are compressed."""

    def compressed(self, mode, data, raw, stride, filter="NONE"):
        view = self.view(data)
        about = {"buffer": 0, "byteOffset": self.views[view]["byteOffset"], "byteLength": len(data), "mode": mode}
        about |= {"byteStride": stride, "count": len(raw) // stride, "filter": filter}
        self.views[view] = {"buffer": 1, "byteLength": len(raw), "extensions": {"EXT_meshopt_compression": about}}
        if mode == "ATTRIBUTES":
            self.views[view]["byteStride"] = stride
        return view

    def reference(self, view, component, kind, count, **more):
        self.accessors.append({"bufferView": view, "componentType": component, "type": kind, "count": count} | more)
        return len(self.accessors) - 1

    def document(self, uri):
        fallback = {"byteLength": 1 << 20, "extensions": {"EXT_meshopt_compression": {"fallback": True}}}
        document = json.loads(super().document(uri))
        document["buffers"].append(fallback)
        return json.dumps(document)


def grid(mode, filter, quads=19):
    mesh = Compressed()
    side = quads + 1
    places = [(x, y) for y in range(side) for x in range(side)]
    if filter == "EXPONENTIAL":
        # A mantissa of 24 bits and an exponent: x / 4 and y / 4 at z = 3 / 4.
        raw = b"".join(struct.pack("<3I", *(v | (254 << 24) for v in (x, y, 3))) for x, y in places)
        view = mesh.compressed("ATTRIBUTES", meshopt_attributes(raw, 12), raw, 12, filter)
        positions = mesh.reference(view, 5126, "VEC3", side * side)
    else:
        raw = b"".join(struct.pack("<4H", 1000 * x, 1000 * y, (x * y) % 7, 0) for x, y in places)
        view = mesh.compressed("ATTRIBUTES", meshopt_attributes(raw, 8), raw, 8)
        positions = mesh.reference(view, 5123, "VEC3", side * side)
    normals = b"".join(struct.pack("<4b", x, -y, 127, 0) for x, y in places)
    view = mesh.compressed("ATTRIBUTES", meshopt_attributes(normals, 4), normals, 4, "OCTAHEDRAL")
    normals = mesh.reference(view, 5120, "VEC3", side * side, normalized=True)
    indices = []
    for y in range(quads):
        for x in range(quads):
            a = y * side + x
            indices += [a, a + 1, a + side, a + side, a + 1, a + side + 1]
    raw = struct.pack(f"<{len(indices)}H", *indices)
    data = meshopt_triangles(indices) if mode == "TRIANGLES" else meshopt_indices(indices)
    view = mesh.compressed(mode, data, raw, 2)
    indices = mesh.reference(view, 5123, "SCALAR", len(indices))
    mesh.primitive |= {"attributes": {"POSITION": positions, "NORMAL": normals}, "indices": indices}
    mesh.json["extensionsUsed"] = mesh.json["extensionsRequired"] = ["EXT_meshopt_compression", "KHR_mesh_quantization"]
    return mesh


grid("TRIANGLES", "NONE").write("b14_meshopt.gltf")
grid("INDICES", "EXPONENTIAL").write_binary("b14_meshopt.glb")
mesh = grid("TRIANGLES", "NONE")
about = mesh.views[-1]["extensions"]["EXT_meshopt_compression"]
about["byteLength"] -= 1
mesh.write("b14_meshopt_cut.gltf")
about["count"] = 3 << 20
mesh.write("b14_meshopt_claim.gltf")
about["mode"] = "ZIP"
mesh.write("b14_meshopt_mode.gltf")


def staged():
    """A white square from (0, 0, 0) to (1, 1, 0), for cameras and lights."""
    mesh = Gltf()
    mesh.primitive["attributes"]["POSITION"] = mesh.floats("VEC3", [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0])
    mesh.primitive["indices"] = mesh.accessor("SCALAR", 5121, "B", [0, 1, 2, 0, 2, 3])
    mesh.primitive["material"] = 0
    mesh.json["materials"] = [{}]
    return mesh


def place(mesh, **node):
    mesh.json["nodes"].append(node)
    mesh.json["scenes"][0]["nodes"].append(len(mesh.json["nodes"]) - 1)


def shine(mesh, lights):
    mesh.json["extensionsUsed"] = ["KHR_lights_punctual"]
    mesh.json["extensions"] = {"KHR_lights_punctual": {"lights": lights}}


HALF = 0.5**0.5
mesh = staged()
mesh.json["cameras"] = [
    {"name": "Front", "type": "perspective", "perspective": {"yfov": 0.5, "aspectRatio": 1.5, "znear": 0.1}},
    {"type": "perspective", "perspective": {"yfov": 1, "aspectRatio": 0}},
    {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "zfar": 9, "znear": 0}},
    {"name": "no node", "type": "perspective", "perspective": {"yfov": 1}},
]
place(mesh, camera=0, translation=[0.5, 0.5, 3], scale=[2, 2, 2])
# Turned by 90 degrees about y: it looks along -x.
place(mesh, camera=1, name="Side\u0007", translation=[4, 0.5, 0], rotation=[0, HALF, 0, HALF])
place(mesh, camera=2)
place(mesh, camera=1, translation=[0, 2e9, 0])
mesh.write("s2_cameras.gltf")
mesh.json["cameras"][0]["perspective"]["yfov"] = 3.2
mesh.write("s2_wide.gltf")
mesh = staged()
mesh.json["cameras"] = [{"name": "", "type": "perspective", "perspective": {"yfov": 1}}]
place(mesh, camera=0, name="near", translation=[0.5, 0.5, 3])
# It looks away from the mesh, to a point beyond 1e9.
place(mesh, camera=0, name="far", translation=[0.5, 0.5, 1e9], rotation=[0, 1, 0, 0])
mesh.write("s2_range.gltf")
mesh = staged()
mesh.json["cameras"] = {}
shine(mesh, 5)
place(mesh, camera=0, extensions={"KHR_lights_punctual": {"light": 0}})
mesh.write("s2_no_lists.gltf")
mesh = staged()
place(mesh, extensions={"KHR_lights_punctual": {"light": 0}})
mesh.write("s3_no_lights.gltf")
mesh = staged()
mesh.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1}}]
for x in range(11):
    place(mesh, camera=0, name=str(x), translation=[x, 0, 5])
mesh.write("s2_many.gltf")
for name, lights in [
    ("point", [{"type": "point", "intensity": 100, "color": [1, 0.5, 0]}]),
    ("two", [{"type": "directional", "intensity": 300}, {"type": "spot", "intensity": 100, "spot": {}}]),
    ("unused", [{"type": "directional"}, {"type": "point", "name": "no node"}]),
    ("kind", [{"type": "area"}]),
    ("cone", [{"type": "spot", "spot": {"innerConeAngle": 1, "outerConeAngle": 0.5}}]),
    ("negative", [{"type": "point", "intensity": -1}, {"type": "point", "color": [0, 0, 1]}]),
]:
    mesh = staged()
    shine(mesh, lights)
    for i in range(1 if name == "unused" else len(lights)):
        place(mesh, translation=[0.5, 0.5, 2], extensions={"KHR_lights_punctual": {"light": i}})
    mesh.write(f"s3_{name}.gltf")
mesh = staged()
shine(mesh, [{"type": "point"}])
for x in range(65):
    place(mesh, translation=[x, 0, 5], extensions={"KHR_lights_punctual": {"light": 0}})
mesh.write("s3_many.gltf")
LIGHT = [{"KHR_lights_punctual": {"light": i}} for i in range(3)]
# Far away, a point source and a spot that shines away from the mesh; near, a spot.
mesh = staged()
shine(mesh, [{"type": kind, "intensity": candela} for kind, candela in [("point", 1e14), ("spot", 9e14), ("spot", 100)]])
place(mesh, translation=[0.5, 0.5, 2e6], extensions=LIGHT[0])
place(mesh, translation=[0.5, 0.5, 3e6], rotation=[0, 1, 0, 0], extensions=LIGHT[1])
place(mesh, translation=[0.5, 0.5, 2], extensions=LIGHT[2])
mesh.write("s3_far.gltf")
# Two lights with intensities beyond 1e12 in the scene.
mesh = staged()
mesh.json["nodes"][0]["scale"] = [1e6, 1e6, 1e6]
shine(mesh, [{"type": "point", "intensity": 4e12}, {"type": "spot", "intensity": 4e12}])
for i in range(2):
    place(mesh, translation=[5e5, 5e5, 2e6], extensions=LIGHT[i])
mesh.write("s3_huge.gltf")
# A point source needs no direction, a directional light no position, and a spot both.
mesh = staged()
shine(mesh, [{"type": "directional"}, {"type": "point"}, {"type": "spot"}])
for i in range(3):
    place(mesh, translation=[0.5, 0.5, 2], scale=[0, 0, 0], extensions=LIGHT[i])
    place(mesh, translation=[0, 0, 2e9], extensions=LIGHT[i])
mesh.write("s3_places.gltf")

# A grid of 4 by 4 vertices at (x / 3, y / 3, 0.2 sin(3 x) cos(7 y / 3)), compressed by Google's library (DracoPy 2.2.0,
# levels 7 and 0): with colours, texture coordinates and normals, and without.
DRACO = (
    "RFJBQ08CAgEBAAAAEBIDEgMABt/Tp1p9Cv8BEf8Ca0H/AmtB/wJrQQQAAAABAAACAAD/AAABAgIDAQABAQMJAgEBAAEBCQMAAgABAAkDAAMCAQ"
    "EBAQPJAQE4//+frQJVAa0Cb1UBBwCwUel4r4sAAAAA/wAAAKuqKj+rqio/q6qqPquqqj6rqio/q6qqPquqqj4AAAAAAAAAAAAAAAAAAAAAq6qq"
    "Pquqqj6rqio/q6oqPwAAgD8AAIA/AACAPwAAgD+rqio/AACAP6uqqj6rqio/AAAAAAAAgD8AAAAAq6qqPgAAgD8AAAAAq6oqPwAAAAAAAIA/AA"
    "AAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/"
    "AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAI"
    "A/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AQEBAA8jAQQBDAEMARQBBAEMBwB6SIIgbpGr6qrqeaSqqeq0oKoCAHAHAACAAQCAegAAgMMAAGAl"
    "AABAAwIAAGgzAADAiQMAAKQtAACQVAAAAKwjAACAJgIAAPEHAIBwAQAAAAD/PwAAAAAAAAAAAACCNGm9AACAPw4="
)
DRACO_PLAIN = (
    "RFJBQ08CAgEAAAASEAEAAQUABQQBAgYBBgUCAwcCBwYEBQkECQgFBgoFCgkGBwsGCwoICQ0IDQwJCg4JDg0KCw8KDw4BAQAJAwAAAgABAQAMHw"
    "EEBwE8AwAgiwAA6lQFgBysCoCrUBUANhIAVZ9CVQA8waoAcAdVAXAYAVhVHVQFQAGsCgAIUBUAGRAAVSFAVQBYwaoAGAhVAcAaAAAAAP8HAAAA"
    "AAAAAAAAAII0ab0AAIA/Cw=="
)


def draco(data, attributes):
    mesh = Gltf()
    mesh.primitive["material"] = 0
    mesh.json["materials"] = [{}]
    view = mesh.view(data)
    kinds = {"POSITION": ("VEC3", 5126), "NORMAL": ("VEC3", 5126), "TEXCOORD_0": ("VEC2", 5126), "COLOR_0": ("VEC3", 5121)}
    mesh.primitive["attributes"] = {}
    for name in attributes:
        kind, component = kinds[name]
        about = {"componentType": component, "type": kind, "count": 16, "normalized": component == 5121}
        mesh.primitive["attributes"][name] = len(mesh.accessors)
        mesh.accessors.append(about)
    mesh.primitive["indices"] = len(mesh.accessors)
    mesh.accessors.append({"componentType": 5123, "type": "SCALAR", "count": 54})
    mesh.primitive["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": view, "attributes": attributes}}
    mesh.json["extensionsUsed"] = mesh.json["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    return mesh


data = base64.b64decode(DRACO)
attributes = {"COLOR_0": 0, "TEXCOORD_0": 1, "NORMAL": 2, "POSITION": 3}
draco(data, attributes).write("s5_draco.gltf")
draco(base64.b64decode(DRACO_PLAIN), {"POSITION": 0}).write_binary("s5_draco.glb")
draco(data[:-40], attributes).write("s5_cut.gltf")
draco(data, attributes | {"POSITION": 4}).write("s5_id.gltf")
# The texture coordinates have two numbers.
draco(data, {"POSITION": 1}).write("s5_width.gltf")
mesh = draco(data, attributes)
# The positions are floats.
mesh.accessors[mesh.primitive["attributes"]["POSITION"]]["componentType"] = 5125
mesh.write("s5_type.gltf")
mesh = draco(data, attributes)
# Both primitives are the same part of the file.
mesh.json["meshes"][0]["primitives"].append(mesh.primitive)
mesh.write("s5_twice.gltf")
mesh = draco(data, attributes)
mesh.primitive["mode"] = 6
mesh.write("s5_mode.gltf")
mesh = Gltf()
mesh.json["extensionsUsed"] = mesh.json["extensionsRequired"] = ["ACME_wonder"]
mesh.write("b14_unknown.gltf")


# Animations: two seconds, unless they are faulty.
QUARTER = [0, 0, 0, 1, 0, 0, HALF, HALF]


def channel(mesh, path, output, node=0, times=(0, 2), **sampler):
    """Adds a channel to the first animation."""
    animation = mesh.json.setdefault("animations", [{"samplers": [], "channels": []}])[0]
    inputs = mesh.floats("SCALAR", list(times))
    animation["samplers"].append({"input": inputs, "output": output} | sampler)
    animation["channels"].append({"sampler": len(animation["samplers"]) - 1, "target": {"node": node, "path": path}})
    return mesh


def turning():
    """A square that makes a quarter turn about z."""
    mesh = staged()
    return channel(mesh, "rotation", mesh.floats("VEC4", QUARTER))


def rising(**sampler):
    """A square that rises from 0 to 4."""
    mesh = staged()
    return channel(mesh, "translation", mesh.floats("VEC3", [0, 0, 0, 0, 4, 0]), **sampler)


turning().write("s4_turn.gltf")
rising().write("s4_rise.gltf")
mesh = staged()
steps = mesh.floats("VEC3", [0, 0, 0, 0, 2, 0, 0, 4, 0])
channel(mesh, "translation", steps, times=[0, 1, 2], interpolation="STEP").write("s4_step.gltf")
mesh = staged()
spline = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 4, 0, 0, 0, 0]
channel(mesh, "translation", mesh.floats("VEC3", spline), interpolation="CUBICSPLINE").write("s4_spline.gltf")
# Growing from nothing: the other two axes have an extent from the start.
mesh = staged()
channel(mesh, "scale", mesh.floats("VEC3", [1, 0, 1, 1, 2, 1])).write("s4_grow.gltf")
# A still square, a turning one, and one on its corner, which rises in its coordinates.
mesh = turning()
mesh.json["nodes"][0]["children"] = [1]
mesh.json["nodes"] += [{"mesh": 0, "translation": [1, 0, 0]}, {"mesh": 0, "translation": [-3, 0, 0]}]
mesh.json["scenes"][0]["nodes"] = [0, 2]
channel(mesh, "translation", mesh.floats("VEC3", [1, 0, 0, 1, 2, 0]), node=1).write("s4_parts.gltf")
# A turning node above a flat one above a tilted square, and a flat one above a turning square.
mesh = turning()
tilt = [HALF, 0, 0, HALF]
mesh.json["nodes"] = [{"children": [1]}, {"scale": [2, 1, 0], "rotation": [0, HALF, 0, HALF], "children": [2]},
                      {"mesh": 0, "rotation": tilt}, {"scale": [1, 1, 0], "children": [4]}, {"mesh": 0}]
mesh.json["scenes"][0]["nodes"] = [0, 3]
channel(mesh, "rotation", mesh.floats("VEC4", tilt + [0, 0, HALF, HALF]), node=4).write("s4_flat.gltf")
# As numbers that stand for 0 to 1, and with one quaternion of a sparse accessor.
mesh = staged()
values = mesh.accessor("VEC4", 5122, "h", [0, 0, 0, 32767, 0, 0, 23170, 23170], normalized=True)
channel(mesh, "rotation", values).write("s4_normalized.gltf")
mesh = staged()
values = mesh.floats("VEC4", QUARTER[:4] * 2)
sparse = {"indices": {"bufferView": mesh.view(b"\1"), "componentType": 5121}}
sparse["values"] = {"bufferView": mesh.view(struct.pack("<4f", *QUARTER[4:]))}
mesh.accessors[values]["sparse"] = sparse | {"count": 1}
channel(mesh, "rotation", values).write("s4_sparse.gltf")
mesh = staged()
mesh.primitive["mode"] = 2
del mesh.primitive["indices"]
channel(mesh, "translation", mesh.floats("VEC3", [0, 0, 0, 0, 4, 0])).write("s4_lines.gltf")
# There at the start, then not, and the other way round: without an extent when the picture is framed.
for name, scales in [("vanish", [1, 0]), ("appear", [0, 1])]:
    mesh = staged()
    values = mesh.floats("VEC3", [scale for scale in scales + [1] for _ in range(3)])
    channel(mesh, "scale", values, times=[0, 1, 2], interpolation="STEP").write(f"s4_{name}.gltf")
# What is left out: a second animation, what is no node, morph targets, skins, cameras and lights.
mesh = turning()
mesh.json["animations"] *= 3
mesh.write("s4_three.gltf")
mesh = turning()
mesh.json["animations"][0]["channels"][0]["target"] = {"path": "pointer", "extensions": {}}
mesh.write("s4_pointer.gltf")
mesh = Gltf()
mesh.primitive["targets"] = [{"POSITION": mesh.floats("VEC3", [0, 0, 0, 0, 0, 0, 0, 4, 0])}]
channel(mesh, "weights", mesh.floats("SCALAR", [0.5, 1])).write("s4_morph.gltf")
# Weights that stay, and are the last key frame: the square starts to turn again after three seconds.
mesh = turning()
mesh.primitive["targets"] = [{"POSITION": mesh.floats("VEC3", [0, 0, 0] * 3 + [0, 0, 4])}]
still = mesh.floats("SCALAR", [0, 0.5, 0] * 2)
channel(mesh, "weights", still, times=[0, 3], interpolation="CUBICSPLINE").write("s4_weights.gltf")
mesh = skinned()
channel(mesh, "translation", mesh.floats("VEC3", [0, 0, 0, 0, 4, 0]), node=1).write("s4_skin.gltf")
mesh = rising()
mesh.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1}}]
shine(mesh, [{"type": "point"}])
mesh.json["nodes"].append({"camera": 0, "translation": [0, 0, 5], "extensions": LIGHT[0]})
mesh.json["nodes"][0]["children"] = [1]
mesh.write("s4_camera.gltf")
# What does not move: a node without a mesh, one key frame, and two of the same value at another place than the node's.
mesh = rising()
mesh.json["animations"][0]["channels"][0]["target"]["node"] = 1
mesh.json["nodes"].append({})
mesh.write("s4_empty.gltf")
mesh = staged()
channel(mesh, "translation", mesh.floats("VEC3", [0, 4, 0]), times=[1]).write("s4_one.gltf")
mesh = staged()
channel(mesh, "translation", mesh.floats("VEC3", [0, 4, 0] * 2)).write("s4_constant.gltf")
# Faults.
mesh = rising()
mesh.json["animations"][0]["samplers"] = []
mesh.write("s4_no_sampler.gltf")
mesh = rising()
mesh.json["animations"][0]["channels"][0]["target"]["node"] = 7
mesh.write("s4_no_node.gltf")
for name, times in [("unsorted", [2, 0]), ("nan", [0, float("nan")]), ("negative", [-1, 1]), ("count", [0, 1, 2])]:
    rising(times=times).write(f"s4_{name}.gltf")
mesh = rising(interpolation="BEZIER")
mesh.write("s4_bezier.gltf")
mesh = rising()
mesh.accessors[-1]["count"] = 0
mesh.write("s4_none.gltf")
mesh = rising()
mesh.accessors[-1] = {"componentType": 5126, "type": "SCALAR", "count": 4000000000}
mesh.write("s4_huge.gltf")
mesh = rising()
mesh.json["nodes"][0]["matrix"] = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
mesh.write("s4_matrix.gltf")
mesh = staged()
channel(mesh, "rotation", mesh.floats("VEC4", QUARTER[:4] + [0] * 4)).write("s4_no_turn.gltf")
mesh = staged()
values = mesh.floats("VEC4", [0] * 12 + [0] * 4 + QUARTER[4:] + [0] * 4)
channel(mesh, "rotation", values, interpolation="CUBICSPLINE").write("s4_no_turn_spline.gltf")
# Straight, the same values are faulty too; their tangents are 0 as well.
mesh = staged()
values = mesh.floats("VEC4", [0] * 4 + QUARTER[4:] + [0] * 8 + QUARTER[4:] + [0] * 4)
channel(mesh, "rotation", values, interpolation="CUBICSPLINE")
channel(mesh, "rotation", values, node=1, times=range(6))
mesh.json["nodes"].append({})
mesh.write("s4_shared.gltf")
mesh = rising()
mesh.json["animations"][0]["channels"] *= 3
mesh.write("s4_twice.gltf")
mesh = rising()
mesh.json["animations"][0]["channels"] = {}
mesh.write("s4_no_list.gltf")
mesh = rising()
mesh.json["animations"] = 5
mesh.write("s4_number.gltf")

# A buffer of key frames that is missing, after a faulty channel, and of two channels.
mesh = rising(interpolation="BEZIER")
mesh.json["nodes"].append({})
view = mesh.view(b"")
mesh.views[view] = {"buffer": 1, "byteLength": 24}
for node in (0, 1):
    mesh.accessors.append({"bufferView": view, "componentType": 5126, "type": "VEC3", "count": 2})
    channel(mesh, "scale", len(mesh.accessors) - 1, node=node)
mesh.more_buffers = [{"uri": "gone.bin", "byteLength": 24}]
mesh.write("s4_gone.gltf")
# A moving square in coordinates in which no ray is traced: too far, and too small.
for name, factor in [("far", 1e10), ("small", 1e-12)]:
    mesh = staged()
    mesh.primitive["attributes"]["POSITION"] = mesh.floats("VEC3", [factor * x for x in [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]])
    mesh.json["nodes"] = [{"children": [1]}, {"mesh": 0, "scale": [1 / factor] * 3}, {"mesh": 0, "scale": [2 / factor] * 3}]
    mesh.json["scenes"][0]["nodes"] = [0, 2]
    channel(mesh, "translation", mesh.floats("VEC3", [0, 0, 0, 0, 4, 0]))
    mesh.write(f"s4_{name}_part.gltf")
# A part of a mesh with a skin that has no joints, so that its node would move it.
mesh = skinned()
part = {"attributes": {"POSITION": mesh.floats("VEC3", [0, 0, 0, 100, 0, 0, 0, 100, 0])}}
mesh.json["meshes"][0]["primitives"].append(part)
channel(mesh, "translation", mesh.floats("VEC3", [0, 0, 0, 0, 4, 0])).write("s4_no_joints.gltf")

# Extensions that are no objects.
mesh = staged()
mesh.json["nodes"][0]["extensions"] = 5
mesh.json["materials"][0] = {"extensions": [], "emissiveFactor": [1, 0, 0]}
mesh.primitive["extensions"] = "none"
mesh.json["extensions"] = None
mesh.write("s6_extensions.gltf")
mesh = staged()
mesh.json["nodes"][0]["extensions"] = {"KHR_lights_punctual": 5}
mesh.json["materials"][0]["extensions"] = {"KHR_materials_pbrSpecularGlossiness": True}
mesh.write("s6_values.gltf")

# Files as found in other programs' samples: corners without their attributes, extensions of OBJ, whole numbers with a
# point, and bytes behind the end.
obj("e5_points", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nusemtl red\n", mtl="newmtl red\nKd 1 0 0\n")
obj("e5_uncharted", VERTICES + "vt 0 0\nusemtl a\nf 1 2 3 4\n", mtl="newmtl a\nmap_d grey.png\n")
obj("e1_absent", VERTICES + "vn 0 0 1\nf 1/1/1 2/2/1 3/3/1\nf 1/1 3/3 4/4\nf 1//1 3//7 4//1\n")
obj("e2_tags", SQUARE + "t crease 2/1/0 1 2 3.0\nvw 1 0 1\nvw 2 0 1\n")
mesh = Gltf()
mesh.json["scene"] = 0.0
mesh.json["scenes"][0]["nodes"] = [0.0]
mesh.primitive["mode"] = 4.0
mesh.write("e3_point.gltf")
mesh.json["scene"] = 0.5
mesh.write("e3_half.gltf")
text = Gltf().document(True).encode()
text += b" " * (-len(text) % 4)
parts = struct.pack("<I4s", len(text), b"JSON") + text
write("e4_more.glb", struct.pack("<4sII", b"glTF", 2, 12 + len(parts)) + parts + b"more")
