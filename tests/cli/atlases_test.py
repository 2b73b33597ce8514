#!/usr/bin/env python3
"""Charts of the scene's own, several atlases, and what is said of those that do not fit."""
import base64
import json
import struct
import unittest

import scenes
from exr import Exr

QUICK = ("--resolution", "64", "--patch-size", "0.25", "-q")

SQUARE = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0))
UPRIGHT = ((0, 1), (1, 1), (1, 0), (0, 0))


def size_of(path):
    """Width and height by the EXR's dataWindow."""
    head = path.read_bytes()
    at = head.index(b"dataWindow\0box2i\0") + len(b"dataWindow\0box2i\0") + 4
    left, top, right, bottom = struct.unpack_from("<4i", head, at)
    return right - left + 1, bottom - top + 1


def gltf(uvs, nodes=({"mesh": 0, "name": "sheet"},)):
    """A square lamp with TEXCOORD_1."""
    parts = [b"".join(struct.pack("<3f", *p) for p in SQUARE),
             b"".join(struct.pack("<2f", *uv) for uv in uvs),
             struct.pack("<6I", 0, 1, 2, 0, 2, 3)]
    views, offset = [], 0
    for part in parts:
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(part)})
        offset += len(part)
    document = json.loads(scenes.gltf())
    document["nodes"] = list(nodes)
    document["scenes"] = [{"nodes": list(range(len(nodes)))}]
    document["bufferViews"] = views
    document["buffers"] = [{"byteLength": offset, "uri": "data:application/octet-stream;base64,"
                            + base64.b64encode(b"".join(parts)).decode()}]
    document["accessors"] = [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0],
         "max": [1, 1, 0]},
        {"bufferView": 1, "componentType": 5126, "count": len(uvs), "type": "VEC2"},
        {"bufferView": 2, "componentType": 5125, "count": 6, "type": "SCALAR"}]
    document["meshes"] = [{"primitives": [
        {"attributes": {"POSITION": 0, "TEXCOORD_1": 1}, "indices": 2, "material": 0}]}]
    return json.dumps(document)


QUADS = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def lamp_in_double_sided_room():
    """Corners of a box are counted in binary, x last; the room's fronts are inside."""
    positions = [(side * x + at, side * y + at, side * z + at)
                 for side, at in ((1, 0), (0.25, 0.5)) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    room = [i for a, b, c, d in QUADS for i in (a, c, b, a, d, c)]
    lamp = [8 + i for a, b, c, d in QUADS for i in (a, b, c, a, c, d)]
    document = json.loads(scenes.gltf(positions, room + lamp))
    document["accessors"][1]["count"] = len(room)
    document["accessors"].append({**document["accessors"][1], "byteOffset": 4 * len(room)})
    document["materials"].append({"name": "wall", "doubleSided": True,
                                  "pbrMetallicRoughness": {"baseColorFactor": [.5, .5, .5, 1]}})
    document["meshes"][0]["primitives"] = [
        {"attributes": {"POSITION": 0}, "indices": indices, "material": material}
        for indices, material in ((1, 1), (2, 0))]
    return json.dumps(document)


class Atlases(scenes.InFolder):
    def solve(self, *arguments, scene="scene.obj"):
        return self.run_hemirad("solve", scene, *QUICK, *arguments)

    def solve_gltf(self, *arguments, **content):
        self.write("sheet.gltf", gltf(**content))
        return self.solve(*arguments, scene="sheet.gltf")

    def written(self):
        return sorted(p.name for p in self.folder.iterdir() if p.suffix in (".exr", ".png"))

    def test_charts_that_one_does_not_hold_go_to_a_second(self):
        result = self.solve("-o", "out.exr", "--preview", "out.png", "--report", "r.json",
                            "--texel-size", "0.1", "--padding", "3", "--atlas-size", "16")

        self.assertEqual((0, ""), (result.returncode, result.stderr))
        self.assertEqual(["out.1.exr", "out.1.png", "out.exr", "out.png"], self.written())
        self.assertEqual((16, 16), size_of(self.folder / "out.1.exr"))
        report = json.loads((self.folder / "r.json").read_text(encoding="utf-8"))
        self.assertEqual(["out.exr", "out.png", "out.1.exr", "out.1.png"],
                         [output["file"] for output in report["outputs"]])

    def test_the_report_lists_every_lightmap_with_all_that_lies_in_it(self):
        result = self.solve("-o", "out.exr", "--report", "r.json", "--texel-size", "0.1",
                            "--padding", "3", "--atlas-size", "16")

        self.assertEqual((0, ""), (result.returncode, result.stderr))
        report = json.loads((self.folder / "r.json").read_text(encoding="utf-8"))
        for lightmap, file, name in zip(report["lightmaps"], ("out.exr", "out.1.exr"),
                                        ("floor", "ceiling"), strict=True):
            covered = sum(part > 0 for part in Exr(self.folder / file).channels()["coverage"])
            self.assertAlmostEqual(0.1, lightmap.pop("texel_size"))
            self.assertEqual({"file": file, "width": 16, "height": 16, "charts": 1,
                              "covered_texels": covered, "objects": [name]}, lightmap)
            self.assertEqual(100, covered)

    def test_info_lists_the_lightmaps_and_a_few_of_their_objects(self):
        self.write("sheet.gltf", gltf(uvs=UPRIGHT, nodes=[
            {"mesh": 0, "name": f"n{i}", "translation": [2 * i, 0, 0]} for i in range(12)]))
        lines = self.run_hemirad("info", "sheet.gltf", "--atlas-size", "8").stdout.splitlines()
        at = lines.index("lightmaps    12")
        self.assertEqual("  sheet.exr: 8 x 8 texels of 0.125 m, 100 % filled, 1 chart: n0",
                         lines[at + 1])
        self.assertTrue(lines[at + 10].startswith("  sheet.9.exr: 8 x 8 texels"), lines[at + 10])
        self.assertEqual("  and 2 more", lines[at + 11])

        generated = self.run_hemirad("info", "sheet.gltf", "--charts", "generated").stdout
        self.assertRegex(generated, r"lightmaps    1\n  sheet\.exr: \d+ x \d+ texels of 0\.\d+ m, "
                                    r"[\d.]+ % filled, 12 charts: n0, n1, n2 and 9 more\n")

    def test_backs_that_no_light_comes_to_are_left_out_on_request(self):
        self.write("room.gltf", lamp_in_double_sided_room())
        reports = []
        for backs in ((), ("--backs", "lit")):
            result = self.solve("-o", "a.glb", "--report", "r.json", "--backfaces", "block", *backs,
                                scene="room.gltf")
            self.assertEqual((0, ""), (result.returncode, result.stderr))
            reports.append(json.loads((self.folder / "r.json").read_text(encoding="utf-8")))
        full, lit = reports

        self.assertEqual([18, 12], [report["lightmaps"][0]["charts"] for report in reports])
        self.assertEqual("lit", lit["settings"]["backs"])
        self.assertEqual(full["ledger"], lit["ledger"])
        self.assertIn(", 12 charts: ", self.run_hemirad("info", "room.gltf", "--backfaces", "block",
                                                        "--backs", "lit").stdout)

    def test_a_second_atlas_does_not_overwrite_another_output(self):
        (self.folder / "out.1.exr").mkdir()

        result = self.solve("-o", "out.exr", "--texel-size", "0.1", "--atlas-size", "24")

        self.assertEqual(3, result.returncode, result.stderr)
        self.assertIn("out.1.exr", result.stderr)
        self.assertEqual(["out.1.exr"], self.written())

    def test_a_chart_larger_than_the_atlas_is_refused_by_name(self):
        result = self.solve("--texel-size", "0.01", "--atlas-size", "64")

        self.assertEqual(1, result.returncode)
        self.assertIn('the chart of "floor" takes 100 x 100 texels', result.stderr)
        self.assertEqual(1, result.stderr.count("\n"))
        self.assertEqual([], self.written())

    def test_the_scenes_own_uvs_fill_the_atlas_that_was_asked_for(self):
        result = self.solve_gltf("-o", "out.exr", "--atlas-size", "32", uvs=UPRIGHT)

        self.assertEqual((0, ""), (result.returncode, result.stderr))
        self.assertEqual((32, 32), size_of(self.folder / "out.exr"))

    def test_the_scenes_own_uvs_are_ignored_on_request(self):
        result = self.solve_gltf("-o", "out.exr", "--texel-size", "0.1", "--charts", "generated",
                                 "--padding", "1", "--backfaces", "cull", uvs=UPRIGHT)

        self.assertEqual((0, ""), (result.returncode, result.stderr))
        self.assertEqual((12, 12), size_of(self.folder / "out.exr"))

    def test_two_instances_get_an_atlas_each(self):
        result = self.solve_gltf("-o", "out.exr", "--atlas-size", "32", uvs=UPRIGHT, nodes=[
            {"mesh": 0, "name": "left"}, {"mesh": 0, "name": "right", "translation": [2, 0, 0]}])

        self.assertEqual(0, result.returncode)
        self.assertIn('"right": its TEXCOORD_1 claim texels of "left"', result.stderr)
        self.assertEqual(["out.1.exr", "out.exr"], self.written())

    def test_many_instances_are_told_in_one_line_and_reported_in_full(self):
        result = self.solve_gltf("-o", "out.exr", "--atlas-size", "8", "--report", "r.json",
                                 uvs=UPRIGHT, nodes=[
            {"mesh": 0, "name": f"n{i}", "translation": [2 * i, 0, 0]} for i in range(6)])

        self.assertEqual(0, result.returncode, result.stderr)
        told = [line for line in result.stderr.splitlines() if "claim texels" in line]
        self.assertEqual(1, len(told), told)
        self.assertTrue(told[0].startswith("warning: 5 objects: "), told)
        self.assertTrue(told[0].endswith("; and 2 more, which --report lists"), told)
        warnings = json.loads((self.folder / "r.json").read_text())["warnings"]
        self.assertEqual([f'"n{i}"' in warning for i, warning in enumerate(warnings, 1)], [True] * 5)

    def test_uvs_that_make_no_lightmap_are_refused_by_the_nodes_name(self):
        for uvs, says in [(((0, 1), (2, 1), (2, 0), (0, 0)), "outside of 0 to 1"),
                          (((0, 1), (1, 1), (1, 0), (1, 1)), "overlap in TEXCOORD_1"),
                          (UPRIGHT[:3], "has 3 TEXCOORD_1 for 4 positions")]:
            result = self.solve_gltf(uvs=uvs)

            self.assertEqual(1, result.returncode, result.stderr)
            self.assertIn(says, result.stderr)
            self.assertIn("meshes/0" if "positions" in says else '"sheet"', result.stderr)
            self.assertEqual([], self.written())


if __name__ == "__main__":
    unittest.main()
