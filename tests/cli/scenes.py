"""Scenes small enough to read, as the bytes of their files, and tests in a folder with one.
HEMIRAD names the binary."""
import base64
import json
import os
import pathlib
import struct
import subprocess
import tempfile
import unittest

LIGHT_AND_FLOOR = """\
v 0 0 0
v 1 0 0
v 1 0 1
v 0 0 1
v 0 1 0
v 1 1 0
v 1 1 1
v 0 1 1
"""

MATERIALS = """\
newmtl white
Kd 0.5 0.5 0.5
newmtl lamp
Kd 0 0 0
Ke 1 1 1
"""

FACES = """\
o floor
usemtl white
f 1 4 3 2
o ceiling
usemtl lamp
f 5 6 7 8
"""

ROOM = """\
o room
usemtl white
f 1 4 3 2
f 1 5 8 4
o ceiling
usemtl lamp
f 5 6 7 8
"""


def obj(vertices=LIGHT_AND_FLOOR, faces=FACES):
    return ("mtllib scene.mtl\n" + vertices + faces).encode()


def gltf(positions=((0, 0, 0), (1, 0, 0), (0, 1, 0)), indices=(0, 1, 2), material=None, **top):
    """One triangle mesh, or what is left of it after `top` replaced top-level members."""
    buffer = b"".join(struct.pack("<3f", *p) for p in positions)
    offset = len(buffer)
    buffer += b"".join(struct.pack("<I", i) for i in indices)
    finite = [p for p in positions if all(abs(x) < 1e30 for x in p)] or [(0, 0, 0)]
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "sheet"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [material if material is not None else lamp()],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3",
             "min": [min(axis) for axis in zip(*finite)],
             "max": [max(axis) for axis in zip(*finite)]},
            {"bufferView": 1, "componentType": 5125, "count": len(indices), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": offset},
                        {"buffer": 0, "byteOffset": offset, "byteLength": len(buffer) - offset}],
        "buffers": [{"byteLength": len(buffer), "uri": "data:application/octet-stream;base64,"
                     + base64.b64encode(buffer).decode()}],
    }
    document.update(top)
    return json.dumps({key: value for key, value in document.items() if value is not None}).encode()


def lamp(reflectance=0.5, name="lamp"):
    return {"name": name, "emissiveFactor": [1, 1, 1],
            "pbrMetallicRoughness": {"baseColorFactor": [reflectance] * 3 + [1]}}


def glb(document=None):
    text = document or gltf()
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sII", b"glTF", 2, 20 + len(text)) + struct.pack(
        "<I4s", len(text), b"JSON") + text


class InFolder(unittest.TestCase):
    """Each test in a folder of its own, with scene.obj and its materials."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write("scene.mtl", MATERIALS)
        self.write("scene.obj", obj())

    def write(self, name, content):
        content = content.encode() if isinstance(content, str) else content
        (self.folder / name).write_bytes(content)

    def run_hemirad(self, *arguments, timeout=120, **options):
        return subprocess.run([os.environ["HEMIRAD"], *arguments], cwd=self.folder, text=True,
                              capture_output=True, timeout=timeout, check=False, **options)
