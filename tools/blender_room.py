"""A room in Blender (3.4), with Suzanne and other meshes of Blender's own, and a look at what hemirad
makes of it; tools/check-blender runs both:

    blender -b --factory-startup --python-exit-code 1 -P tools/blender_room.py -- make ROOM.glb
    blender -b --factory-startup --python-exit-code 1 -P tools/blender_room.py -- look ROOM.glb \
        SOLVED.glb LIGHTMAP.exr PICTURE.exr
"""
import argparse
import math
import pathlib
import sys

import numpy

numpy.bool = bool  # Blender 3.4 imports glTF by that name, which Debian 12's NumPy has dropped

import bpy

LIGHTMAP_UV = "Lightmap"
SIZE = 160, 120  # of the picture that is compared
TRACED_SAMPLES = 128  # paths a pixel
# Of the mean radiance, over pixels averaged in squares of 10: the light that hemirad's mesh and
# hemispheres misplace, and the noise of so few paths.
MOST_OFF_TRACED, MOST_OFF_SHOWN = 0.05, 0.01


# -- make ---------------------------------------------------------------------------------------


def material_of(name, colour, strength=0.0):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = (*colour, 1.0)
    if strength:
        inputs["Emission"].default_value = (1.0, 0.9, 0.75, 1.0)
        inputs["Emission Strength"].default_value = strength
    return material


def named(name, *materials):
    """Of the object that was added last."""
    made = bpy.context.object
    made.name = made.data.name = name
    for material in materials:
        made.data.materials.append(material)
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    return made


def add_room():
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 1.25), scale=(4, 4, 2.5))
    room = named("Room", material_of("White", (0.75, 0.75, 0.75)),
                 material_of("Red", (0.6, 0.08, 0.06)), material_of("Green", (0.1, 0.45, 0.12)))
    room.data.flip_normals()
    room.data.update()
    for face in room.data.polygons:
        side = face.normal.x
        face.material_index = 1 if side > 0.5 else 2 if side < -0.5 else 0


def add_furniture():
    grey = material_of("Grey", (0.5, 0.5, 0.5))
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0.3, 0.3), scale=(0.8, 0.8, 0.6))
    named("Pedestal", grey)
    bpy.ops.mesh.primitive_monkey_add(size=1, location=(0, 0.3, 1.12), rotation=(-0.3, 0, 0.35))
    named("Suzanne", material_of("Clay", (0.65, 0.42, 0.25)))
    bpy.ops.mesh.primitive_torus_add(location=(1.1, 0.8, 0.13), major_radius=0.4,
                                     minor_radius=0.12, major_segments=24, minor_segments=12)
    named("Torus", material_of("Blue", (0.12, 0.2, 0.6)))
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=0.35, location=(-1.1, 0.7, 0.36))
    named("Icosphere", material_of("Yellow", (0.7, 0.6, 0.1)))
    bpy.ops.mesh.primitive_plane_add(size=1.2, location=(0, 0, 2.3), rotation=(math.pi, 0, 0))
    named("Panel", material_of("Lamp", (0.5, 0.5, 0.5), 12.0))


def add_camera():
    bpy.ops.object.camera_add(location=(0, -1.9, 1.5), rotation=(math.radians(76), 0, 0))
    bpy.context.object.data.angle = math.radians(75)
    bpy.context.object.name = bpy.context.object.data.name = "Eye"


def unwrap(how):
    """A second UV map; of all objects together, as Blender's users do it."""
    meshes = [o for o in bpy.data.objects if o.type == "MESH"]
    bpy.ops.object.select_all(action="DESELECT")
    for made in meshes:
        made.select_set(True)
        made.data.uv_layers.active = made.data.uv_layers.new(name=LIGHTMAP_UV)
    bpy.context.view_layer.objects.active = meshes[0]
    if how == "pack":
        bpy.ops.uv.lightmap_pack(PREF_CONTEXT="ALL_FACES", PREF_MARGIN_DIV=0.3)
        return
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project(island_margin=0.02)
    bpy.ops.object.mode_set(mode="OBJECT")


def make(options):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    add_room()
    add_furniture()
    unwrap(options.unwrap)
    add_camera()
    bpy.ops.export_scene.gltf(filepath=str(options.room), export_format="GLB",
                              export_cameras=True)


# -- look ---------------------------------------------------------------------------------------


def require(holds, what):
    if not holds:
        sys.exit(f"blender_room: {what}")


def pixels_of(path):
    """[row][column][red, green, blue, alpha]; Blender's first row is the lowest."""
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    require(width > 0 and image.channels == 4 and image.is_float,
            f"{path}: {width} x {height}, {image.channels} channels")
    values = numpy.empty(width * height * 4, dtype=numpy.float32)
    image.pixels.foreach_get(values)
    return image, values.reshape(height, width, 4)


def check_lightmap(path):
    image, values = pixels_of(path)
    light = values[:, :, :3]
    require(numpy.isfinite(light).all(), f"{path}: not finite")
    require(light.min() >= 0 and light.mean() > 0, f"{path}: mean {light.mean()}")
    print(f"{path.name}: {image.size[0]} x {image.size[1]}, {image.channels} channels, mean "
          f"{light.mean():.3f}, most {light.max():.3f} W/m^2")
    return image


def imported(path):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.import_scene.gltf(filepath=str(path))
    return [o for o in bpy.data.objects if o.type == "MESH"]


def check_solved(path):
    meshes = imported(path)
    for made in meshes:
        require(len(made.data.uv_layers) == 2, f"{made.name}: {len(made.data.uv_layers)} UV maps")
    require({"Room", "Suzanne", "Torus", "Icosphere", "Panel", "Pedestal"} <=
            {made.name for made in meshes}, f"objects {[made.name for made in meshes]}")
    return meshes


def colour_and_emission(material):
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    strength = inputs["Emission Strength"].default_value
    return (list(inputs["Base Color"].default_value),
            [strength * c for c in inputs["Emission"].default_value][:3])


def make_diffuse(material, lightmap=None):
    """What it reflects is traced or, with a lightmap, colour / pi times irradiance."""
    colour, emission = colour_and_emission(material)
    tree = material.node_tree
    tree.nodes.clear()
    own = tree.nodes.new("ShaderNodeEmission")
    own.inputs["Color"].default_value = (*emission, 1)
    reflected = tree.nodes.new("ShaderNodeEmission" if lightmap else "ShaderNodeBsdfDiffuse")
    reflected.inputs["Color"].default_value = colour
    if lightmap:
        uv = tree.nodes.new("ShaderNodeUVMap")
        uv.uv_map = "UVMap.001"
        image = tree.nodes.new("ShaderNodeTexImage")
        image.image = lightmap
        image.extension = "EXTEND"
        scaled = tree.nodes.new("ShaderNodeVectorMath")
        scaled.operation = "MULTIPLY"
        scaled.inputs[1].default_value = [c / math.pi for c in colour[:3]]
        tree.links.new(uv.outputs["UV"], image.inputs["Vector"])
        tree.links.new(image.outputs["Color"], scaled.inputs[0])
        tree.links.new(scaled.outputs["Vector"], reflected.inputs["Color"])
    both = tree.nodes.new("ShaderNodeAddShader")
    out = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(own.outputs[0], both.inputs[0])
    tree.links.new(reflected.outputs[0], both.inputs[1])
    tree.links.new(both.outputs[0], out.inputs["Surface"])


def picture(meshes, path, samples, bounces, lightmap=None):
    for material in {slot.material for made in meshes for slot in made.material_slots}:
        make_diffuse(material, lightmap)
    scene = bpy.context.scene
    scene.camera = next(o for o in bpy.data.objects if o.type == "CAMERA")
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.filepath = str(path)
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.cycles.samples = samples
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = bounces
    scene.cycles.sample_clamp_indirect = 0
    scene.cycles.pixel_filter_type = "BOX"
    bpy.ops.render.render(write_still=True)
    return pixels_of(path)[1][:, :, :3]


def squares(values, side=10):
    height, width, bands = values.shape
    return values.reshape(height // side, side, width // side, side, bands).mean(axis=(1, 3))


def compare(what, of_hemirad, of_blender, most):
    off = numpy.sqrt(((squares(of_hemirad) - squares(of_blender)) ** 2).mean()) / of_blender.mean()
    print(f"{what}: means {of_hemirad.mean():.4f} and {of_blender.mean():.4f}, RMS {off:.2%}")
    return off < most


def look(options):
    of_hemirad = pixels_of(options.picture)[1][:, :, :3]
    meshes = check_solved(options.solved)
    lightmap = check_lightmap(options.lightmap)
    shown = picture(meshes, options.picture.with_name("shown.exr"), 16, 0, lightmap)
    fits = compare("the lightmap in Blender", of_hemirad, shown, MOST_OFF_SHOWN)
    # Where the solved scene has fronts and backs, the room has a double-sided face.
    traced = picture(imported(options.room), options.picture.with_name("traced.exr"),
                     TRACED_SAMPLES, 64)
    fits &= compare("paths of Cycles", of_hemirad, traced, MOST_OFF_TRACED)
    require(fits, "these pictures differ")


def parse_arguments():
    parser = argparse.ArgumentParser(prog="blender_room", description=__doc__.split("\n", 1)[0])
    commands = parser.add_subparsers(required=True)
    made = commands.add_parser("make")
    made.add_argument("room", type=pathlib.Path)
    made.add_argument("--unwrap", choices=("smart", "pack"), default="smart",
                      help="Smart UV Project, or Lightmap Pack")
    made.set_defaults(run=make)
    seen = commands.add_parser("look")
    for name in ("room", "solved", "lightmap", "picture"):
        seen.add_argument(name, type=pathlib.Path)
    seen.set_defaults(run=look)
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


if __name__ == "__main__":
    OPTIONS = parse_arguments()
    OPTIONS.run(OPTIONS)
