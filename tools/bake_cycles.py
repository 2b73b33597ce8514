"""Bakes a lightmap of a scene that scenes/generate.py wrote with Blender's Cycles (3.4), and writes the
faces' means as `hemirad solve --faces` does:

    blender -b --factory-startup -P tools/bake_cycles.py -- SCENE.gltf FACES.csv [--samples N] ...

Prints a line of JSON: texels, the seconds that the bake took, and with --noise what a texel is off by
for the samples being few, relative to the mean.
"""
import argparse
import base64
import json
import math
import struct
import sys
import time

import bpy
from mathutils import Vector

PADDING = 2  # texels around a chart
MOST_BOUNCES = 64  # what is left then is below 1e-8 of it


def read_accessor(gltf, blob, index):
    accessor = gltf["accessors"][index]
    view = gltf["bufferViews"][accessor["bufferView"]]
    width, code = (3, "f") if accessor["type"] == "VEC3" else (1, "I")
    count = width * accessor["count"]
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    values = struct.unpack_from(f"<{count}{code}", blob, start)
    return [Vector(values[i:i + 3]) for i in range(0, count, 3)] if width == 3 else values


def read_triangles(gltf):
    """(object, material index, three corners), in file order."""
    blob = base64.b64decode(gltf["buffers"][0]["uri"].split(",", 1)[1])
    for node in (n for n in gltf["nodes"] if "mesh" in n):  # others hold cameras
        for primitive in gltf["meshes"][node["mesh"]]["primitives"]:
            points = read_accessor(gltf, blob, primitive["attributes"]["POSITION"])
            indices = read_accessor(gltf, blob, primitive["indices"])
            for i in range(0, len(indices), 3):
                yield node["name"], primitive["material"], [points[k] for k in indices[i:i + 3]]


def normal_of(corners):
    return (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized()


def area_of(corners):
    return (corners[1] - corners[0]).cross(corners[2] - corners[0]).length / 2


def charts_of(triangles):
    """Coplanar triangles of an object share a chart: lists of indices."""
    charts = {}
    for i, (name, _, corners) in enumerate(triangles):
        normal = normal_of(corners)
        plane = tuple(round(x, 4) for x in (*normal, normal.dot(corners[0])))
        charts.setdefault((name, plane), []).append(i)
    return list(charts.values())


def flatten(triangles, chart, texel):
    """The chart's triangles in its plane, in texels, from (0, 0) on."""
    first = triangles[chart[0]][2]
    u_axis = (first[1] - first[0]).normalized()
    v_axis = normal_of(first).cross(u_axis)
    flat = [[(p.dot(u_axis) / texel, p.dot(v_axis) / texel) for p in triangles[i][2]]
            for i in chart]
    least = [min(p[axis] for t in flat for p in t) for axis in (0, 1)]
    return [[(p[0] - least[0], p[1] - least[1]) for p in t] for t in flat]


def pack(flats):
    """Shelves by falling height: (side of the square, offset of each chart)."""
    sizes = [[math.ceil(max(p[axis] for t in flat for p in t)) + 2 * PADDING for axis in (0, 1)]
             for flat in flats]
    side = math.ceil(math.sqrt(sum(w * h for w, h in sizes)))
    while True:
        offsets, x, y, shelf = [None] * len(flats), 0, 0, 0
        for i in sorted(range(len(flats)), key=lambda i: -sizes[i][1]):
            width, height = sizes[i]
            if x + width > side:
                x, y, shelf = 0, y + shelf, 0
            offsets[i] = (x + PADDING, y + PADDING)
            x, shelf = x + width, max(shelf, height)
        if y + shelf <= side and max(w for w, _ in sizes) <= side:
            return side, offsets
        side += 8


def lay_out(triangles, texel_count):
    """Each triangle's corners on a square image, in texels, equally dense: (side, corners)."""
    texel = math.sqrt(sum(area_of(t[2]) for t in triangles) / texel_count)
    charts = charts_of(triangles)
    flats = [flatten(triangles, chart, texel) for chart in charts]
    side, offsets = pack(flats)
    placed = [None] * len(triangles)
    for chart, flat, (x, y) in zip(charts, flats, offsets):
        for i, corners in zip(chart, flat):
            placed[i] = [(x + u, y + v) for u, v in corners]
    return side, placed


def texels_within(corners):
    """(column, row) of the texels whose centres lie in a triangle."""
    (ax, ay), (bx, by), (cx, cy) = corners
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    for row in range(int(min(ay, by, cy)), math.ceil(max(ay, by, cy))):
        for column in range(int(min(ax, bx, cx)), math.ceil(max(ax, bx, cx))):
            x, y = column + 0.5, row + 0.5
            b = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area
            c = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area
            if b > 0 and c > 0 and b + c < 1:
                yield column, row


def make_material(material, image):
    """Diffuse reflection, emission, and the image to bake to."""
    made = bpy.data.materials.new(material["name"])
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    diffuse.inputs["Color"].default_value = material["pbrMetallicRoughness"]["baseColorFactor"]
    surface = diffuse.outputs[0]
    if "emissiveFactor" in material:
        emission, both = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeAddShader")
        emission.inputs["Color"].default_value = (*material["emissiveFactor"], 1)
        emission.inputs["Strength"].default_value = strength_of(material)
        links.new(surface, both.inputs[0])
        links.new(emission.outputs[0], both.inputs[1])
        surface = both.outputs[0]
    links.new(surface, output.inputs["Surface"])
    target = nodes.new("ShaderNodeTexImage")
    target.image = image
    nodes.active = target
    return made


def strength_of(material):
    strength = material.get("extensions", {}).get("KHR_materials_emissive_strength", {})
    return strength.get("emissiveStrength", 1)


def make_object(triangles, materials, side, placed):
    mesh = bpy.data.meshes.new("scene")
    mesh.from_pydata([p for _, _, corners in triangles for p in corners], [],
                     [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(len(triangles))])
    for material in materials:
        mesh.materials.append(material)
    mesh.polygons.foreach_set("material_index", [material for _, material, _ in triangles])
    uv = mesh.uv_layers.new()
    uv.data.foreach_set("uv", [x / side for corners in placed for p in corners for x in p])
    made = bpy.data.objects.new("scene", mesh)
    bpy.context.collection.objects.link(made)
    bpy.context.view_layer.objects.active = made
    made.select_set(True)


def set_up_cycles(samples):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.world.use_nodes = False
    scene.world.color = (0, 0, 0)
    scene.view_settings.view_transform = "Raw"
    cycles = scene.cycles
    cycles.samples = samples
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.max_bounces = cycles.diffuse_bounces = MOST_BOUNCES
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0


def bake(image, seed):
    """Seconds, and the image's values, four a texel."""
    bpy.context.scene.cycles.seed = seed
    start = time.perf_counter()
    bpy.ops.object.bake(type="DIFFUSE", pass_filter={"DIRECT", "INDIRECT"}, margin=0)
    seconds = time.perf_counter() - start
    values = [0.0] * (4 * image.size[0] * image.size[1])
    image.pixels.foreach_get(values)
    return seconds, values


def write_faces(file, gltf, triangles, means):
    with open(file, "w", encoding="utf-8") as out:
        print("face,object,material,area,cx,cy,cz,irradiance.R,irradiance.G,irradiance.B,"
              "radiosity.R,radiosity.G,radiosity.B", file=out)
        for i, ((name, index, corners), mean) in enumerate(zip(triangles, means)):
            material = gltf["materials"][index]
            emission = [math.pi * strength_of(material) * x
                        for x in material.get("emissiveFactor", (0, 0, 0))]
            reflectance = material["pbrMetallicRoughness"]["baseColorFactor"]
            radiosity = [r * e + b for r, e, b in zip(reflectance, mean, emission)]
            numbers = [area_of(corners), *(sum(corners, Vector()) / 3), *mean, *radiosity]
            print(i, name, material["name"], *(f"{x:.9g}" for x in numbers), sep=",", file=out)


def relative_noise(values, others, places):
    """Of one bake: the two differ by root 2 of it."""
    square = sum((values[k] - others[k]) ** 2 / 2 for at in places for k in (at, at + 1, at + 2))
    mean = sum(values[k] for at in places for k in (at, at + 1, at + 2)) / (3 * len(places))
    return math.sqrt(square / (3 * len(places))) / mean


def parse_arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("faces")
    parser.add_argument("--texels", type=int, default=250000)
    parser.add_argument("--samples", type=int, default=16, help="a texel")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--noise", action="store_true", help="bakes once more")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


def main():
    options = parse_arguments()
    with open(options.scene, encoding="utf-8") as file:
        gltf = json.load(file)
    triangles = list(read_triangles(gltf))
    side, placed = lay_out(triangles, options.texels)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.world = bpy.data.worlds.new("black")
    image = bpy.data.images.new("lightmap", side, side, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    make_object(triangles, [make_material(m, image) for m in gltf["materials"]], side, placed)
    set_up_cycles(options.samples)
    seconds, values = bake(image, options.seed)

    places = [[4 * (row * side + column) for column, row in texels_within(corners)]
              for corners in placed]
    # What Cycles divides the colour out of is radiance: pi of it are the irradiance.
    means = [[math.pi * sum(values[at + band] for at in inside) / len(inside)
              for band in range(3)] for inside in places]
    write_faces(options.faces, gltf, triangles, means)
    result = {"texels": sum(map(len, places)), "seconds": seconds}
    if options.noise:
        others = bake(image, options.seed + 1)[1]
        result["noise"] = relative_noise(values, others, [at for inside in places for at in inside])
    print(json.dumps(result))


if __name__ == "__main__":
    main()
