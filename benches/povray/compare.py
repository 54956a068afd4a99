#!/usr/bin/env python3
"""Compares pictures with those of POV-Ray, pixel by pixel.

usage: compare.py TERMTRACE [SCENE...]

Each scene is written for both programs from one description, and traced with one ray through the centre of each pixel.
Needs `povray` 3.7 on the path (Debian: apt-get install povray) and Python's standard library.
"""
import math, os, re, struct, subprocess, sys, tempfile, zlib

WIDTH, HEIGHT = 320, 240
# A grey pixel may differ by so many steps of 8 bits.
TOLERANCE = 2


def vector(v):
    return ', '.join(f'{x:.9g}' for x in v)


def ron(v):
    return f'({vector(v)})'


def pov(v):
    return f'<{vector(v)}>'


class Scene:
    """A scene that is written down twice."""

    def __init__(self, eye=(0, 2, 7), target=(0, 0.9, 0), fov=40, background=(0.2, 0.3, 0.45), ambient=0.1):
        self.eye, self.target, self.fov, self.background, self.ambient = eye, target, fov, background, ambient
        self.lights, self.objects, self.fields, self.extra, self.shadowless = [], [], [], [], ''

    def without_shadows(self):
        self.fields.append('shadows: false')
        self.shadowless = ' shadowless'
        return self

    def point(self, position, intensity, color=(1, 1, 1), falloff=True):
        light = [intensity * c for c in color]
        self.lights.append(f'Point(position: {ron(position)}, color: {ron(light)}'
                           + ('' if falloff else ', falloff: None') + ')')
        # POV-Ray's falloff is 2 / (1 + (d / f)^2), which is 2 f^2 / d^2 for a small f.
        f = 1e-3
        if falloff:
            light = [c / (2 * f * f) for c in light]
        fade = f' fade_distance {f} fade_power 2' if falloff else ''
        self.extra.append(f'light_source {{ {pov(position)} rgb {pov(light)}{fade}{self.shadowless} }}')
        return self

    def sun(self, direction, intensity):
        self.lights.append(f'Sun(direction: {ron(direction)}, intensity: {intensity})')
        far = [1e3 * x for x in direction]
        self.extra.append(f'light_source {{ {pov(far)} rgb {intensity} parallel point_at <0, 0, 0> }}')
        return self

    def fog(self, color, distance):
        self.fields.append(f'fog: (color: {ron(color)}, distance: {distance})')
        self.extra.append(f'fog {{ fog_type 1 distance {distance} rgb {pov(color)} }}')
        return self

    def add(self, shape, color=(0.7, 0.7, 0.7), finish=None, opacity=1, place=''):
        ron_shape, pov_shape = shape
        r_finish, p_finish, interior, transmit, diffuse = '', '', '', 1 - opacity, 1
        kind, *numbers = finish or ('matte',)
        if kind == 'shiny':
            r_finish = f'finish: Shiny(exponent: {numbers[0]}, strength: {numbers[1]})'
            p_finish = f'specular {numbers[1]} roughness {1 / numbers[0]:.12g}'
        elif kind == 'mirror':
            r_finish, diffuse = 'finish: Metal', 0
            p_finish = f'reflection {{ rgb {pov(color)} }}'
        elif kind == 'glass':
            r_finish, diffuse, transmit = f'finish: Glass(index: {numbers[0]})', 0, 1
            p_finish = 'reflection { 0, 1 fresnel on } conserve_energy'
            interior = f'interior {{ ior {numbers[0]} }}'
        ambient = self.ambient if diffuse else 0
        fields = [f'material: Diffuse({ron(color)})', r_finish, place and place[0]]
        if opacity < 1:
            fields.append(f'opacity: {opacity}')
        fields = ', '.join(field for field in fields if field)
        self.objects.append(f'{ron_shape[:-1]}, {fields})')
        texture = (f'texture {{ pigment {{ rgb {pov(color)} transmit {transmit} }} '
                   f'finish {{ ambient {ambient} diffuse {diffuse} {p_finish} }} }} {interior}')
        self.extra.append(f'{pov_shape[:-1]} {place and place[1]} {texture} }}')
        return self

    def as_ron(self):
        fields = ''.join(f'    {field},\n' for field in self.fields)
        lights = ''.join(f'        {light},\n' for light in self.lights)
        objects = ''.join(f'        {item},\n' for item in self.objects)
        return (f'(\n    camera: (eye: {ron(self.eye)}, target: {ron(self.target)}, vertical_fov: {self.fov}),\n'
                f'    background: {ron(self.background)},\n    ambient: {self.ambient},\n    bounces: 16,\n{fields}'
                f'    lights: [\n{lights}    ],\n    objects: [\n{objects}    ],\n)\n')

    def as_pov(self):
        ratio = WIDTH / HEIGHT
        angle = math.degrees(2 * math.atan(math.tan(math.radians(self.fov) / 2) * ratio))
        # POV-Ray's coordinates are left-handed; a negative `right` mirrors the picture back.
        camera = (f'camera {{ location {pov(self.eye)} sky <0, 1, 0> right -{ratio}*x up y '
                  f'angle {angle:.12g} look_at {pov(self.target)} }}')
        head = '#version 3.7;\nglobal_settings { assumed_gamma 1.0 max_trace_level 20 ambient_light rgb 1 }\n'
        return head + '\n'.join([f'background {{ rgb {pov(self.background)} }}', camera, *self.extra]) + '\n'


def sphere(c, r):
    return f'Sphere(center: {ron(c)}, radius: {r})', f'sphere {{ {pov(c)}, {r} }}'


def plane(p, n):
    d = sum(a * b for a, b in zip(p, n)) / math.sqrt(sum(a * a for a in n))
    return f'Plane(point: {ron(p)}, normal: {ron(n)})', f'plane {{ {pov(n)}, {d:.12g} }}'


def box(a, b):
    return f'Box(min: {ron(a)}, max: {ron(b)})', f'box {{ {pov(a)}, {pov(b)} }}'


def cylinder(a, b, r):
    return f'Cylinder(from: {ron(a)}, to: {ron(b)}, radius: {r})', f'cylinder {{ {pov(a)}, {pov(b)}, {r} }}'


def cone(a, b, r, s):
    return (f'Cone(from: {ron(a)}, to: {ron(b)}, radius: {r}, to_radius: {s})',
            f'cone {{ {pov(a)}, {r}, {pov(b)}, {s} }}')


def disk(c, n, r):
    return f'Disk(center: {ron(c)}, normal: {ron(n)}, radius: {r})', f'disc {{ {pov(c)}, {pov(n)}, {r} }}'


def torus(r, s, place):
    return f'Torus(center: (0, 0, 0), axis: (0, 1, 0), radius: {r}, tube_radius: {s})', f'torus {{ {r}, {s} {place} }}'


def triangle(a, b, c):
    return f'Triangle(corners: [{ron(a)}, {ron(b)}, {ron(c)}])', f'triangle {{ {pov(a)}, {pov(b)}, {pov(c)} }}'


def ellipsoid(c, r):
    return (f'Ellipsoid(center: {ron(c)}, radii: {ron(r)})',
            f'sphere {{ <0, 0, 0>, 1 scale {pov(r)} translate {pov(c)} }}')


def solid(operation, *parts):
    return (f'Solid({operation}: [{", ".join(part[0] for part in parts)}])',
            f'{operation} {{ {" ".join(part[1] for part in parts)} }}')


def moved(by):
    return f'translate: {ron(by)}', f'translate {pov(by)}'


FLOOR = plane((0, 0, 0), (0, 1, 0))
RED, GREEN, BLUE, GOLD = (0.8, 0.1, 0.08), (0.1, 0.6, 0.2), (0.15, 0.25, 0.8), (0.9, 0.6, 0.15)


def scenes():
    lamp = lambda: Scene().point((4, 6, 5), 45).point((-5, 4, 3), 12, (0.6, 0.7, 1)).add(FLOOR)
    yield 'spheres', lamp().add(sphere((-1.2, 1, 0), 1), RED).add(sphere((1, 0.7, 0.5), 0.7), GREEN)
    yield 'boxes_and_disks', (lamp().add(box((-2, 0, -1), (-0.5, 1.5, 0.5)), BLUE)
                              .add(disk((1.2, 1, 0), (1, 1, 2), 0.9), GOLD).add(box((0.3, 0, 1), (0.9, 0.5, 1.5)), RED))
    yield 'cylinders_and_cones', (lamp().add(cylinder((-1.5, 0, 0), (-1.2, 1.8, 0.3), 0.6), GREEN)
                                  .add(cone((0.8, 0, 0), (0.8, 1.7, 0), 0.9, 0), RED)
                                  .add(cone((2, 0, 1.2), (2.2, 0.9, 1.2), 0.4, 0.15), GOLD))
    yield 'rings', (lamp().add(torus(1, 0.35, ''), GOLD, place=moved((-1.2, 0.35, 0)))
                    .add(ellipsoid((1.3, 0.8, 0), (0.9, 0.8, 0.5)), BLUE)
                    .add(triangle((-0.5, 0, 1.5), (0.6, 0, 1.7), (0, 1.2, 1)), RED))
    yield 'sun', (Scene().sun((3, 5, 2), 0.9).add(FLOOR).add(sphere((-1, 1, 0), 1), RED)
                  .add(box((0.6, 0, -0.5), (1.8, 1.6, 0.7)), GOLD))
    yield 'highlights', (lamp().add(sphere((-1.2, 1, 0), 1), RED, ('shiny', 20, 0.5))
                         .add(sphere((1.2, 1, 0), 1), BLUE, ('shiny', 150, 0.9)))
    yield 'mirrors', (lamp().add(sphere((-1.1, 1, 0), 1), (0.9, 0.85, 0.8), ('mirror',))
                      .add(sphere((1.2, 0.8, 0.4), 0.8), (0.7, 0.75, 0.9), ('mirror',))
                      .add(box((-0.3, 0, 1.4), (0.3, 0.6, 2)), RED))
    yield 'transparent', (lamp().add(sphere((0, 1, -0.8), 1), RED)
                          .add(box((-1.4, 0, 0.6), (0.2, 1.2, 0.9)), BLUE, opacity=0.4)
                          .add(disk((1, 0.8, 1), (0, 0.2, 1), 0.7), GREEN, opacity=0.7))
    yield 'fog', (lamp().fog((0.5, 0.55, 0.6), 9).add(sphere((-1, 1, 0), 1), RED).add(sphere((1.5, 1, -3), 1), GREEN)
                  .add(sphere((-2, 1, -8), 1), GOLD))
    yield 'solids', (lamp()
                     .add(solid('difference', box((-2.2, 0, -0.8), (-0.6, 1.6, 0.8)), sphere((-0.7, 1.5, 0.7), 0.8)),
                          GOLD)
                     .add(solid('intersection', sphere((0.9, 0.8, 0), 0.8), sphere((1.5, 0.8, 0.2), 0.8)), BLUE)
                     .add(solid('union', cylinder((2.2, 0, 1), (2.2, 1, 1), 0.2), sphere((2.2, 1.1, 1), 0.35)), RED))
    # Without shadows, because glass throws that of a solid here.
    yield 'glass', (Scene(ambient=0.15).without_shadows().point((4, 6, 5), 60).add(FLOOR)
                    .add(sphere((0, 1, 1), 1), (1, 1, 1), ('glass', 1.5)).add(box((-2, 0, -3), (-0.8, 1.6, -2)), RED)
                    .add(box((0.6, 0, -3), (2, 1, -2)), GREEN))


def read_png(path):
    """Returns width, height and bytes of an 8-bit RGB PNG."""
    data, at, packed = open(path, 'rb').read(), 8, b''
    while at < len(data):
        size, kind = struct.unpack('>I4s', data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b'IHDR':
            width, height, depth, color = struct.unpack('>IIBB', body[:10])
            assert (depth, color) == (8, 2), f'{path}: not 8-bit RGB'
        packed += body if kind == b'IDAT' else b''
        at += size + 12
    raw, stride, rows, above = zlib.decompress(packed), 3 * width, [], bytes(3 * width)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            left, up, corner = (line[x - 3] if x > 2 else 0), above[x], (above[x - 3] if x > 2 else 0)
            p = left + up - corner
            paeth = min((abs(p - left), 0, left), (abs(p - up), 1, up), (abs(p - corner), 2, corner))[2]
            line[x] = line[x] + (0, left, up, (left + up) // 2, paeth)[kind] & 255
        rows.append(bytes(line))
        above = line
    return width, height, rows


def edges(rows):
    """Returns for each pixel whether a neighbour shows something else in a map of objects or of shadows."""
    at = lambda x, y: rows[y][3 * x:3 * x + 3]
    columns = [range(max(x - 1, 0), min(x + 2, WIDTH)) for x in range(WIDTH)]
    lines = [range(max(y - 1, 0), min(y + 2, HEIGHT)) for y in range(HEIGHT)]
    near = lambda x, y: {at(i, j) for i in columns[x] for j in lines[y]}
    return [[len(near(x, y)) > 1 for x in range(WIDTH)] for y in range(HEIGHT)]


def main():
    termtrace, *wanted = sys.argv[1:]
    failed = False
    for name, scene in scenes():
        if wanted and name not in wanted:
            continue
        with tempfile.TemporaryDirectory() as folder:
            path = lambda ending: os.path.join(folder, name + ending)
            open(path('.ron'), 'w').write(scene.as_ron())
            open(path('.pov'), 'w').write(scene.as_pov())
            size = ['--pixels', f'{WIDTH}x{HEIGHT}', '--samples', '1']
            frame = lambda ending, *more: subprocess.run(
                [termtrace, 'frame', path('.ron'), *size, *more, '-o', path(ending)], check=True)
            frame('.ours.png')
            frame('.object.png', '--map', 'object')
            frame('.shadow.png', '--map', 'shadow')
            flags = [f'+W{WIDTH}', f'+H{HEIGHT}', '-D', '-A', '+FN8', 'File_Gamma=srgb']
            done = subprocess.run(
                ['povray', f'+I{path(".pov")}', f'+O{path(".png")}', *flags], capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f'{name}: {done.stderr[-2000:]}')
            keep = os.environ.get('KEEP')
            if keep:
                for ending in ('.ron', '.pov', '.ours.png', '.png'):
                    open(os.path.join(keep, name + ending), 'wb').write(open(path(ending), 'rb').read())
            ours, theirs = read_png(path('.ours.png'))[2], read_png(path('.png'))[2]
            at_edge = [edges(read_png(path(ending))[2]) for ending in ('.object.png', '.shadow.png')]
        counted = wrong = largest = 0
        for y in range(HEIGHT):
            for x in range(WIDTH):
                if any(edge[y][x] for edge in at_edge):
                    continue
                off = max(abs(a - b) for a, b in zip(ours[y][3 * x:3 * x + 3], theirs[y][3 * x:3 * x + 3]))
                counted, wrong, largest = counted + 1, wrong + (off > TOLERANCE), max(largest, off)
        failed |= wrong > 0.01 * counted
        share = 100 * wrong / counted
        print(f'{name:20} {counted:6} pixels, {share:6.2f} % off by more than {TOLERANCE}, at most {largest}')
    sys.exit(failed)


if __name__ == '__main__':
    main()
