#!/usr/bin/env python3
"""Solved scenes as glTF, judged by Khronos's validator. HEMIRAD names the program, GLTF_VALIDATOR
the folder into which npm installs it."""
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))
import scenes  # noqa: E402
from exr import Exr  # noqa: E402
from png import read_png  # noqa: E402

VALIDATOR = pathlib.Path(os.environ["GLTF_VALIDATOR"])
SCENES = HERE.parents[1] / "scenes"
QUICK = ("--quality", "draft", "--quiet", "--max-shots", "20")


def install_validator():
    """Once: the pinned version of tests/gltf/package.json."""
    wanted = (HERE / "package.json").read_text(encoding="utf-8")
    here = VALIDATOR / "package.json"
    if (VALIDATOR / "node_modules").is_dir() and here.read_text(encoding="utf-8") == wanted:
        return
    VALIDATOR.mkdir(parents=True, exist_ok=True)
    shutil.copy(HERE / "package.json", here)
    subprocess.run(["npm", "install", "--silent", "--no-audit", "--no-fund", "--no-package-lock"],
                   cwd=VALIDATOR, check=True, timeout=240)


def faults_of(*files):
    result = subprocess.run(["node", str(HERE / "validate.js"), *map(str, files)], text=True,
                            capture_output=True, timeout=60, check=True,
                            env={**os.environ, "NODE_PATH": str(VALIDATOR / "node_modules")})
    return [fault for faults in json.loads(result.stdout).values() for fault in faults]


class Glb:
    def __init__(self, path):
        data = path.read_bytes()
        length, = struct.unpack_from("<I", data, 12)
        self.json = json.loads(data[20:20 + length])
        self.binary = data[28 + length:]

    def view(self, index):
        view = self.json["bufferViews"][index]
        return self.binary[view["byteOffset"]:view["byteOffset"] + view["byteLength"]]

    def image(self, texture):
        source = self.json["textures"][texture]["source"]
        return self.view(self.json["images"][source]["bufferView"])

    def values(self, accessor, form):
        view = self.json["accessors"][accessor]["bufferView"]
        return list(struct.iter_unpack(form, self.view(view)))

    def primitives_of(self, *meshes):
        return [primitive for mesh in self.json["meshes"] if mesh["name"] in meshes
                for primitive in mesh["primitives"]]

    def material(self, primitive):
        return self.json["materials"][primitive["material"]]

    def triangles(self, primitive):
        """Positions and UVs of each one's corners."""
        positions = self.values(primitive["attributes"]["POSITION"], "<3f")
        uvs = self.values(primitive["attributes"]["TEXCOORD_1"], "<2f")
        for corners in self.values(primitive["indices"], "<3I"):
            yield [positions[i] for i in corners], [uvs[i] for i in corners]


class Gltf(scenes.InFolder):
    @classmethod
    def setUpClass(cls):
        install_validator()

    def solve(self, scene, *arguments):
        return self.run_hemirad("solve", str(scene), *QUICK, *arguments)

    def test_the_cornell_box_is_valid(self):
        result = self.solve(SCENES / "cornell.gltf", "-o", "box.glb", "--patch-size", "0.15")

        self.assertEqual(0, result.returncode, result.stderr)
        self.assertEqual([], faults_of(self.folder / "box.glb"))
        self.assertTrue((self.folder / "box.exr").is_file())
        box = Glb(self.folder / "box.glb").json
        self.assertEqual("box.exr", box["asset"]["extras"]["hemirad"]["exr"])
        self.assertIn("tall_block", [node["name"] for node in box["nodes"]])
        for material in box["materials"]:
            self.assertEqual(1, material["extensions"]["MOZ_lightmap"]["texCoord"])

    def test_polygons_of_obj_are_valid_also_as_text_and_beside_an_exr_elsewhere(self):
        (self.folder / "maps").mkdir()
        result = self.solve("scene.obj", "--gltf", "scene.gltf", "-o", "maps/light.exr")

        self.assertEqual(0, result.returncode, result.stderr)
        self.assertEqual([], faults_of(self.folder / "scene.gltf"))
        text = (self.folder / "scene.gltf").read_text(encoding="utf-8")
        self.assertEqual("maps/light.exr", json.loads(text)["asset"]["extras"]["hemirad"]["exr"])

    def test_bands_and_odd_names_are_valid(self):
        material = scenes.lamp(name='<b>"lamp"\n\\')
        material["extras"] = {"reflectance": {"450nm": 0.2, "nir": 0.5}, "emission": {"nir": 1.5}}
        (self.folder / "bands.gltf").write_bytes(scenes.gltf(material=material))

        result = self.solve("bands.gltf", "-o", "solved.glb")

        self.assertEqual(0, result.returncode, result.stderr)
        self.assertEqual([], faults_of(self.folder / "solved.glb"))

    def test_a_faulty_camera_is_refused_before_the_work_begins(self):
        for camera, says in (({"type": "perspective", "perspective": {"yfov": -1, "znear": 1}},
                              "cameras/0: yfov is no number above 0"),
                             ({"type": "perspective", "perspective": {"yfov": 4, "znear": 1}},
                              "cameras/0: its node or its yfov shows nothing"),
                             (7, "cameras/0: is not an object")):
            (self.folder / "seen.gltf").write_bytes(scenes.gltf(
                nodes=[{"mesh": 0, "camera": 0}], cameras=[camera]))
            result = self.solve("seen.gltf", "-o", "solved.glb")
            self.assertEqual((1, f"seen.gltf: {says}\n"), (result.returncode, result.stderr))
            self.assertFalse((self.folder / "solved.exr").exists())

    def test_a_primitive_leads_into_the_atlas_that_its_triangles_lie_in(self):
        (self.folder / "scene.obj").write_bytes(scenes.obj(faces=scenes.ROOM))
        result = self.solve("scene.obj", "-o", "room.glb", "--patch-size", "0.25", "--texel-size",
                            "0.1", "--padding", "3", "--atlas-size", "16", "--layers", "position")

        self.assertEqual(0, result.returncode, result.stderr)
        self.assertEqual([], faults_of(self.folder / "room.glb"))
        room = Glb(self.folder / "room.glb")
        exrs = [Exr(self.folder / f"room{part}.exr").channels() for part in ("", ".1", ".2")]
        self.assertEqual(["white", "white"],
                         [room.material(p)["name"] for p in room.primitives_of("room")])
        for primitive, atlas in zip(room.primitives_of("room", "ceiling"), (0, 1, 2)):
            lightmap = room.material(primitive)["extensions"]["MOZ_lightmap"]
            self.assertEqual(atlas, lightmap["index"])
            self.assert_lit_alike(room, primitive, lightmap, exrs[atlas])

    def assert_lit_alike(self, glb, primitive, lightmap, exr):
        """At the middle of each triangle: by the place and the light that the EXR has there."""
        rows = read_png(glb.image(lightmap["index"]))
        for places, uvs in glb.triangles(primitive):
            self.assertTrue(all(0 <= x <= 1 for uv in uvs for x in uv), uvs)
            x, y = (int(sum(axis) / 3 * 16) for axis in zip(*uvs))
            for axis, name in zip(zip(*places), "XYZ"):
                self.assertAlmostEqual(sum(axis) / 3, exr["position." + name][16 * y + x], delta=0.1)
            for value, name in zip(rows[y][x], "RGB"):
                self.assertAlmostEqual(value / 255 * lightmap["intensity"], exr[name][16 * y + x],
                                       delta=lightmap["intensity"] / 500)

    def test_the_validator_sees_faults(self):
        self.solve("scene.obj", "-o", "bad.gltf")
        bad = json.loads((self.folder / "bad.gltf").read_text(encoding="utf-8"))
        del bad["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"]
        (self.folder / "bad.gltf").write_text(json.dumps(bad), encoding="utf-8")

        self.assertIn("MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY",
                      [fault["code"] for fault in faults_of(self.folder / "bad.gltf")])

    def test_other_endings_and_the_scene_itself_are_refused(self):
        for arguments in (("--gltf", "a.fbx"), ("-o", "scene.obj")):
            result = self.solve("scene.obj", *arguments)
            self.assertEqual(1, result.returncode)
            self.assertEqual(1, result.stderr.count("\n"), result.stderr)
        shutil.copy(SCENES / "cornell.gltf", self.folder / "box.gltf")
        self.assertIn("would overwrite the scene",
                      self.solve("box.gltf", "-o", "box.gltf").stderr)


if __name__ == "__main__":
    unittest.main()
