#!/usr/bin/env python3
"""Writes hemirad's scenes: python3 generate.py OUTDIR [NAME...] [options], see README.md.

Metres, y up, counter-clockwise is the front. The same arguments give the same bytes.
"""

import argparse
import base64
import json
import math
import os
import struct
import sys

# --- A scene is a list of polygons; points are welded when it is written ------------------------


class Scene:
    def __init__(self, materials):
        self.materials = materials  # name -> (reflectance RGB, radiance RGB)
        self.faces = []  # (object, material, [(x, y, z), ...])
        self.camera = None  # (name, eye, glTF's rotation, yfov), 1:1

    def add(self, name, material, points):
        self.faces.append((name, material, [tuple(map(micrometres, p)) for p in points]))

    def objects(self):
        """Object -> its faces, in order of first appearance."""
        groups = {}
        for face in self.faces:
            groups.setdefault(face[0], []).append(face)
        return groups


def micrometres(x):
    """Rounded, so that sums which mean the same point are the same number; no -0."""
    return round(x, 6) + 0.0


BLACK = (0.0, 0.0, 0.0)


def grey(value):
    return (value, value, value)


def text_of(values):
    return " ".join(f"{v:.9g}" for v in values)


def write_mtl(scene, path):
    with open(path, "w", encoding="ascii", newline="\n") as out:
        for name, (reflectance, radiance) in scene.materials.items():
            out.write(f"newmtl {name}\nKd {text_of(reflectance)}\nKe {text_of(radiance)}\n")


def write_obj(scene, folder, name, comment):
    write_mtl(scene, os.path.join(folder, name + ".mtl"))
    index = {}
    for _, _, points in scene.faces:
        for point in points:
            index.setdefault(point, len(index) + 1)
    with open(os.path.join(folder, name + ".obj"), "w", encoding="ascii", newline="\n") as out:
        out.write(f"# {comment}\nmtllib {name}.mtl\n")
        out.writelines(f"v {text_of(point)}\n" for point in index)
        for group, faces in scene.objects().items():
            out.write(f"o {group}\n")
            material = None
            for _, face_material, points in faces:
                if face_material != material:
                    material = face_material
                    out.write(f"usemtl {material}\n")
                out.write("f " + " ".join(str(index[p]) for p in points) + "\n")


# --- View3D: triangles and quads; emittance is 1 - reflectance, "obstruction" a material ----------


def write_vs3(scene, folder, name, comment):
    index = {}
    for _, _, points in scene.faces:
        for point in points:
            index.setdefault(point, len(index) + 1)
    faces = sorted(scene.faces, key=lambda face: face[1] == "obstruction")
    with open(os.path.join(folder, name + ".vs3"), "w", encoding="ascii", newline="\n") as out:
        out.write(f"T {comment}\nF 3\n! # x y z\n")
        out.writelines(f"V {i} {text_of(point)}\n" for point, i in index.items())
        out.write("! # v1 v2 v3 v4 base cmb emit name\n")
        for number, (group, material, points) in enumerate(faces, 1):
            corners = [index[p] for p in points] + [0] * (4 - len(points))
            out.write(("O" if material == "obstruction" else "S") + f" {number} {text_of(corners)}")
            if material != "obstruction":
                out.write(f" 0 0 {text_of([1 - scene.materials[material][0][0]])} {group}")
            out.write("\n")
        out.write("End of data\n")


# --- glTF: a node and a mesh an object, a primitive a material, polygons as fans -----------------


def primitive_arrays(faces):
    index, triangles = {}, []
    for _, _, points in faces:
        corners = [index.setdefault(p, len(index)) for p in points]
        for i in range(1, len(corners) - 1):
            triangles += [corners[0], corners[i], corners[i + 1]]
    return list(index), triangles


class GltfBuffer:
    def __init__(self):
        self.bytes, self.views, self.accessors = b"", [], []

    def add(self, content, target, accessor):
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(content),
                           "target": target})
        self.bytes += content + b"\0" * (-len(content) % 4)
        self.accessors.append({"bufferView": len(self.views) - 1, **accessor})
        return len(self.accessors) - 1

    def add_positions(self, points):
        content = struct.pack(f"<{3 * len(points)}f", *(x for p in points for x in p))
        stored = list(struct.iter_unpack("<3f", content))
        bounds = {"min": [min(axis) for axis in zip(*stored)],
                  "max": [max(axis) for axis in zip(*stored)]}
        return self.add(content, 34962, {"componentType": 5126, "count": len(points),
                                         "type": "VEC3", **bounds})

    def add_indices(self, indices):
        content = struct.pack(f"<{len(indices)}I", *indices)
        return self.add(content, 34963, {"componentType": 5125, "count": len(indices),
                                         "type": "SCALAR"})


def gltf_material(name, reflectance, radiance):
    strength = max(*radiance, 1.0)
    material = {"name": name,
                "pbrMetallicRoughness": {"baseColorFactor": [*reflectance, 1.0],
                                         "metallicFactor": 0.0, "roughnessFactor": 1.0}}
    if any(radiance):
        material["emissiveFactor"] = [r / strength for r in radiance]
        material["extensions"] = {"KHR_materials_emissive_strength":
                                  {"emissiveStrength": strength}}
    return material


def gltf_mesh(scene, buffer, name, faces):
    names = list(scene.materials)
    primitives = []
    for material in dict.fromkeys(face[1] for face in faces):
        points, indices = primitive_arrays([f for f in faces if f[1] == material])
        primitives.append({"attributes": {"POSITION": buffer.add_positions(points)},
                           "indices": buffer.add_indices(indices),
                           "material": names.index(material)})
    return {"name": name, "primitives": primitives}


def add_camera(document, name, eye, rotation, yfov):
    document["cameras"] = [{"name": name, "type": "perspective",
                            "perspective": {"aspectRatio": 1.0, "yfov": yfov, "znear": 0.01}}]
    document["scenes"][0]["nodes"].append(len(document["nodes"]))
    document["nodes"].append({"name": name, "translation": eye, "rotation": rotation,
                              "camera": 0})


def write_gltf(scene, folder, name, comment):
    buffer = GltfBuffer()
    meshes = [gltf_mesh(scene, buffer, o, faces) for o, faces in scene.objects().items()]
    uri = "data:application/octet-stream;base64," + base64.b64encode(buffer.bytes).decode("ascii")
    document = {
        "asset": {"version": "2.0", "generator": "hemirad scenes/generate.py",
                  "extras": {"comment": comment}},
        "extensionsUsed": ["KHR_materials_emissive_strength"],
        "scene": 0,
        "scenes": [{"name": name, "nodes": list(range(len(meshes)))}],
        "nodes": [{"name": mesh["name"], "mesh": i} for i, mesh in enumerate(meshes)],
        "meshes": meshes,
        "materials": [gltf_material(m, *v) for m, v in scene.materials.items()],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.bytes), "uri": uri}],
    }
    if scene.camera:
        add_camera(document, *scene.camera)
    path = os.path.join(folder, name + ".gltf")
    with open(path, "w", encoding="ascii", newline="\n") as out:
        json.dump(document, out, indent=1)
        out.write("\n")


# --- Cornell box: graphics.cornell.edu/online/box/data.html --------------------------------------

# Reflectance from 400 to 700 nm in steps of 4 nm, in thousandths.
CORNELL_SPECTRA = {
    "white": """343 445 551 624 665 687 708 723 715 710 745 758 739 767 777 765 751 745 748
        729 745 757 753 750 746 747 735 732 739 734 725 721 733 725 732 743 744 748 728 716 733
        726 713 740 754 764 752 736 734 741 740 732 745 755 751 744 731 733 744 731 712 708 729
        730 727 707 703 729 750 760 751 739 724 730 740 737""",
    "green": """92 96 98 97 98 95 95 97 95 94 97 98 96 101 103 104 107 109 112 115 125 140 160
        187 229 285 343 390 435 464 472 476 481 462 447 441 426 406 373 347 337 314 285 277 266
        250 230 207 186 171 160 148 141 136 130 126 123 121 122 119 114 115 117 117 118 120 122
        128 132 139 144 146 150 152 157 159""",
    "red": """40 46 48 53 49 50 53 55 57 56 59 57 61 61 60 62 62 62 61 62 60 59 57 58 58 58 56
        55 56 59 57 55 59 59 58 59 61 61 63 63 67 68 72 80 90 99 124 154 192 255 287 349 402 443
        487 513 558 584 620 606 609 651 612 610 650 638 627 620 630 628 642 639 657 639 635
        642""",
}
# Radiance of the light at 400, 500, 600 and 700 nm, linear between; its unit is not published.
CORNELL_LIGHT = (0.0, 8.0, 15.6, 18.4)
CORNELL_LIGHT_REFLECTANCE = 0.78

CORNELL_FACES = [  # millimetres
    ("floor", "white", [(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)]),
    ("back_wall", "white",
     [(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)]),
    ("right_wall", "green", [(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]),
    ("left_wall", "red", [(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)]),
    ("light", "light", [(343, 548.8, 227), (343, 548.8, 332), (213, 548.8, 332), (213, 548.8, 227)]),
]
CORNELL_CEILING = [(556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)]
CORNELL_BLOCKS = {  # top, counter-clockwise from above
    "short_block": [(130, 165, 65), (82, 165, 225), (240, 165, 272), (290, 165, 114)],
    "tall_block": [(423, 330, 247), (265, 330, 296), (314, 330, 456), (472, 330, 406)],
}


def mean_over_thirds(spectrum):
    """Red, green, blue: means over 600-700, 500-600 and 400-500 nm, trapezoidal."""
    last = len(spectrum) - 1
    blue_end, green_end = last // 3, 2 * last // 3

    def mean(begin, end):
        part = spectrum[begin:end + 1]
        return (sum(part) - (part[0] + part[-1]) / 2) / (end - begin)

    return tuple(round(mean(*band), 6) + 0.0
                 for band in ((green_end, last), (blue_end, green_end), (0, blue_end)))


def ring(outer, inner):
    """The quads between two polygons of equal corner count."""
    n = len(outer)
    return [[outer[i], outer[(i + 1) % n], inner[(i + 1) % n], inner[i]] for i in range(n)]


def block_faces(top):
    sides = []
    for i, (x, y, z) in enumerate(top):
        u, _, w = top[(i + 1) % len(top)]
        sides.append([(x, 0, z), (u, 0, w), (u, y, w), (x, y, z)])
    return [top] + sides


def cornell(_):
    materials = {name: (mean_over_thirds([float(v) / 1000 for v in values.split()]), BLACK)
                 for name, values in CORNELL_SPECTRA.items()}
    materials["light"] = (grey(CORNELL_LIGHT_REFLECTANCE), mean_over_thirds(CORNELL_LIGHT))
    scene = Scene(materials)

    def add(name, material, points):
        scene.add(name, material, [[x / 1000 for x in p] for p in points])

    for face in CORNELL_FACES:
        add(*face)
    light = CORNELL_FACES[-1][2]
    for quad in ring(CORNELL_CEILING, light):
        add("ceiling", "white", quad)
    for name, top in CORNELL_BLOCKS.items():
        for points in block_faces(top):
            add(name, "white", points)
    # Focal length 0.035, 0.025 x 0.025; looks along +z: half a turn about y.
    scene.camera = ("front", [0.278, 0.273, -0.8], [0.0, 1.0, 0.0, 0.0],
                    round(2 * math.atan(0.025 / 2 / 0.035), 6))
    return scene


# --- Rooms carved out of a grid: watertight and welded by construction ---------------------------


def carve(scene, grid, is_air, label):
    """Walls between air and solid, fronts towards the air; a quad a grid face, no T-junctions.

    label(axis, side, centre) names (object, material); side is +1 where the air lies above.
    """
    cells = [range(len(c) - 1) for c in grid]

    def air(cell):
        inside = all(0 <= i < len(c) - 1 for i, c in zip(cell, grid))
        return inside and is_air(*((c[i] + c[i + 1]) / 2 for i, c in zip(cell, grid)))

    for i in cells[0]:
        for j in cells[1]:
            for k in cells[2]:
                if air((i, j, k)):
                    add_cell_walls(scene, grid, (i, j, k), air, label)


def add_cell_walls(scene, grid, cell, air, label):
    for axis in range(3):
        for side in (1, -1):
            neighbour = list(cell)
            neighbour[axis] -= side
            if air(tuple(neighbour)):
                continue
            points = cell_face(grid, cell, axis, side)
            centre = [sum(x) / 4 for x in zip(*points)]
            scene.add(*label(axis, side, centre), points)


def cell_face(grid, cell, axis, side):
    """The face of a cell at its lower (side 1) or upper end of an axis, facing into the cell."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    points = []
    for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
        point = [0.0, 0.0, 0.0]
        point[axis] = grid[axis][cell[axis] + (side < 0)]
        point[u] = grid[u][cell[u] + du]
        point[v] = grid[v][cell[v] + dv]
        points.append(tuple(point))
    return points if side > 0 else points[::-1]


def refined(coordinates, step):
    """Every interval cut into equal parts no longer than step."""
    result = [coordinates[0]]
    for a, b in zip(coordinates, coordinates[1:]):
        count = max(1, math.ceil((b - a) / step - 1e-9)) if math.isfinite(step) else 1
        result += [a + (b - a) * (i + 1) / count for i in range(count)]
    return result


def box_faces(grid):
    """(axis, side, points) of the surface of a grid of cells, fronts outwards."""
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (1, -1):
            cell = [0, 0, 0]
            cell[axis] = len(grid[axis]) - 2 if side > 0 else 0
            for cell[u] in range(len(grid[u]) - 1):
                for cell[v] in range(len(grid[v]) - 1):
                    yield axis, side, cell_face(grid, cell, axis, -side)[::-1]


def add_box(scene, name, material, low, high, step=math.inf):
    """A closed box, fronts outwards."""
    for _, _, points in box_faces([refined(ends, step) for ends in zip(low, high)]):
        scene.add(name, material, points)


# --- Test rooms ----------------------------------------------------------------------------------

WALL_NAMES = {(0, 1): "wall_x0", (0, -1): "wall_x1", (1, 1): "floor", (1, -1): "ceiling",
              (2, 1): "wall_z0", (2, -1): "wall_z1"}


def furnace(options):
    scene = Scene({"wall": (grey(options.rho), grey(1.0))})
    for axis, side, points in box_faces([[0, 1]] * 3):
        scene.add(WALL_NAMES[axis, -side], "wall", points[::-1])
    return scene


def squares(_):
    scene = Scene({"lamp": (BLACK, grey(1.0)), "grey": (grey(0.5), BLACK)})
    lower = [(0, 0, 0), (0, 0, 1), (1, 0, 1), (1, 0, 0)]
    scene.add("lower", "lamp", lower)
    scene.add("upper", "grey", [(x, 1, z) for x, _, z in lower[::-1]])
    return scene


def screen(options):
    scene = squares(options)
    quarter = [(0, 0.5, 0), (0, 0.5, 0.5), (0.5, 0.5, 0.5), (0.5, 0.5, 0)]
    scene.add("screen", "obstruction", quarter)
    return scene


def lroom(_):
    """Two rooms around a corner; the lamp of the first lights the second through a doorway."""
    scene = Scene({"plaster": ((0.75, 0.73, 0.7), BLACK), "boards": ((0.45, 0.3, 0.18), BLACK),
                   "blue": ((0.2, 0.3, 0.6), BLACK), "lamp": (grey(0.8), (20.0, 18.0, 15.0))})
    grid = [0, 1, 1.9, 2.4, 3, 3.6, 5], [0, 2.1, 2.6], [0, 1.2, 1.8, 3, 3.2, 7]

    def is_air(x, y, z):
        first = z < 3
        second = z > 3.2 and x < 3
        doorway = 1 < x < 1.9 and y < 2.1
        return first or second or doorway

    def label(axis, side, centre):
        x, _, z = centre
        room = "first" if z < 3 else "second" if z > 3.2 else "doorway"
        if (axis, side) == (1, -1) and 2.4 < x < 3.6 and 1.2 < z < 1.8:
            return "lamp", "lamp"
        if (axis, side) == (1, 1):
            return f"{room}_floor", "boards"
        return f"{room}_{WALL_NAMES[axis, side]}", "blue" if room == "second" else "plaster"

    carve(scene, grid, is_air, label)
    return scene


# --- Furnished halls -----------------------------------------------------------------------------

BAY = (9.0, 6.0)  # a hall is a grid of bays, each with its lamps and its furniture
HALL_HEIGHT = 3.0
LAMPS = [((1.5, 3.0), (1.2, 1.8)), ((1.5, 3.0), (4.2, 4.8)),
         ((6.0, 7.5), (1.2, 1.8)), ((6.0, 7.5), (4.2, 4.8))]  # x and z in a bay
HALL_MATERIALS = {
    "plaster": ((0.8, 0.78, 0.74), BLACK),
    "ceiling": ((0.85, 0.85, 0.85), BLACK),
    "carpet": ((0.25, 0.3, 0.22), BLACK),
    "oak": ((0.5, 0.34, 0.2), BLACK),
    "steel": ((0.55, 0.56, 0.58), BLACK),
    "red": ((0.6, 0.1, 0.08), BLACK),
    "blue": ((0.12, 0.2, 0.5), BLACK),
    "lamp": ((0.8, 0.8, 0.8), (30.0, 28.0, 24.0)),
}


def table(name, x, z):
    width, depth, inset, leg = 2.0, 0.9, 0.06, 0.06
    yield name + "_top", "oak", (x, 0.7, z), (x + width, 0.74, z + depth)
    for i, (u, w) in enumerate([(0, 0), (1, 0), (0, 1), (1, 1)]):
        a = x + inset + u * (width - 2 * inset - leg)
        c = z + inset + w * (depth - 2 * inset - leg)
        yield f"{name}_leg{i}", "steel", (a, 0, c), (a + leg, 0.7, c + leg)


def chair(name, x, z, back, colour):
    """A block and, 5 mm above it, a back at its lower (-1) or upper (1) z."""
    yield name + "_seat", colour, (x, 0, z), (x + 0.42, 0.45, z + 0.42)
    c = z + 0.02 if back < 0 else z + 0.36
    yield name + "_back", colour, (x + 0.01, 0.455, c), (x + 0.41, 0.9, c + 0.04)


def shelf(name, x, z):
    """Boards between two sides, 5 mm clear of each other and of the floor."""
    width, height, depth, gap, side = 1.4, 1.9, 0.35, 0.005, 0.03
    for i, a in enumerate((x, x + width - side)):
        yield f"{name}_side{i}", "oak", (a, gap, z), (a + side, height, z + depth)
    for i in range(5):
        y = 0.1 + 0.42 * i
        yield (f"{name}_board{i}", "oak", (x + side + gap, y, z),
               (x + width - side - gap, y + 0.03, z + depth))


def furniture(prefix, x, z):
    """The boxes (name, material, low, high) of a bay with its corner at (x, z)."""
    for i, (a, c) in enumerate([(1.2, 1.4), (5.8, 1.4), (1.2, 3.8), (5.8, 3.8)]):
        yield from table(f"{prefix}table{i}", x + a, z + c)
        for j, b in enumerate((0.25, 1.3)):
            yield from chair(f"{prefix}chair{i}{j}n", x + a + b, z + c - 0.5, -1, "red")
            yield from chair(f"{prefix}chair{i}{j}s", x + a + b, z + c + 0.98, 1, "blue")
    yield from shelf(prefix + "shelf", x + 3.8, z + 0.1)
    yield prefix + "crate", "blue", (x + 4.1, 0, z + 4.9), (x + 4.9, 0.8, z + 5.7)


def hall_grid(bays, step):
    """The walls' coordinates, cut at the lamps."""
    xs = {0, BAY[0] * bays, *(BAY[0] * i + x for i in range(bays) for lamp in LAMPS
                              for x in lamp[0])}
    zs = {0, BAY[1] * bays, *(BAY[1] * i + z for i in range(bays) for lamp in LAMPS
                              for z in lamp[1])}
    return [refined(ends, step) for ends in (sorted(xs), [0, HALL_HEIGHT], sorted(zs))]


def hall_label(axis, side, centre):
    x, z = centre[0] % BAY[0], centre[2] % BAY[1]
    if (axis, side) != (1, -1):
        return WALL_NAMES[axis, side], "carpet" if axis == 1 else "plaster"
    is_lamp = any(a < x < b and c < z < d for (a, b), (c, d) in LAMPS)
    return ("lamps", "lamp") if is_lamp else ("ceiling", "ceiling")


def hall(bays, step=math.inf):
    """bays x bays bays in one room."""
    scene = Scene(HALL_MATERIALS)
    for axis, side, points in box_faces(hall_grid(bays, step)):
        centre = [sum(x) / 4 for x in zip(*points)]
        scene.add(*hall_label(axis, -side, centre), points[::-1])
    for i in range(bays):
        for j in range(bays):
            for box in furniture(f"bay{i}{j}_", BAY[0] * i, BAY[1] * j):
                add_box(scene, *box, step)
    return scene


# --- The same hall in as many quads as a benchmark asks for --------------------------------------

QUADS_A_BAY = 1600  # about the patches of hall2k and hall14k


def grid_quads(grid):
    a, b, c = (len(ends) - 1 for ends in grid)
    return 2 * (a * b + b * c + c * a)


def hall_quads(bays, step):
    """What hall(bays, step) holds, without building it."""
    boxes = sum(grid_quads([refined(ends, step) for ends in zip(low, high)])
                for _, _, low, high in furniture("", 0, 0))
    return boxes * bays ** 2 + grid_quads(hall_grid(bays, step))


def furnished(options):
    bays = max(1, min(3, round(math.sqrt(options.quads / QUADS_A_BAY))))
    if options.quads < hall_quads(bays, math.inf):
        sys.exit(f"--quads: the smallest hall has {hall_quads(1, math.inf)}")
    fine, coarse = 1e-3, 10.0
    for _ in range(50):
        step = math.sqrt(fine * coarse)
        if hall_quads(bays, step) > options.quads:
            fine = step
        else:
            coarse = step
    return hall(bays, coarse)


# --- Command line --------------------------------------------------------------------------------

SCENES = {  # name -> (make, write, comment)
    "cornell": (cornell, write_gltf, "Cornell box, graphics.cornell.edu/online/box/data.html"),
    "furnace": (furnace, write_obj, "Unit cube, fronts inwards, every wall alike"),
    "squares": (squares, write_obj, "Two unit squares that face each other at distance 1"),
    "screen": (screen, write_vs3, "Two unit squares at distance 1 and a screen halfway"),
    "lroom": (lroom, write_obj, "Two rooms and a doorway, the lamp in the first"),
    "hall2k": (lambda _: hall(1), write_obj, "Furnished hall, 9 x 6 x 3 m"),
    "hall14k": (lambda _: hall(3), write_obj, "Furnished hall, 27 x 18 x 3 m"),
    "furnished": (furnished, write_obj, "Furnished hall for --patch-size inf"),
}


def parse_arguments():
    parser = argparse.ArgumentParser(description="Writes hemirad's scenes, see README.md.")
    parser.add_argument("outdir")
    parser.add_argument("names", nargs="*", metavar="NAME",
                        help=f"of {', '.join(SCENES)}; default: all but furnished")
    parser.add_argument("--rho", type=float, default=0.5, help="reflectance of furnace's walls")
    parser.add_argument("--quads", type=int, default=15000, help="of furnished, at most")
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in SCENES]
    if unknown:
        parser.error(f"no scene {unknown[0]!r}")
    return options


def main():
    options = parse_arguments()
    os.makedirs(options.outdir, exist_ok=True)
    for name in options.names or [n for n in SCENES if n != "furnished"]:
        make, write, comment = SCENES[name]
        write(make(options), options.outdir, name, comment)


if __name__ == "__main__":
    main()
