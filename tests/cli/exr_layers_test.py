#!/usr/bin/env python3
"""`hemirad solve --lights, --layers`: what the EXR, the CSV and the report say of parts of the
light. HEMIRAD names the binary."""
import csv
import json
import sys
import unittest

import scenes
from cli_test import CommandLine
from exr import Exr

# A box of coloured walls with two lamps in it, beside each other under the ceiling.
BOX = """\
mtllib scene.mtl
v 0 0 0
v 2 0 0
v 2 0 2
v 0 0 2
v 0 2 0
v 2 2 0
v 2 2 2
v 0 2 2
v 0.2 1.9 0.2
v 0.8 1.9 0.2
v 0.8 1.9 0.8
v 0.2 1.9 0.8
v 1.2 1.9 1.2
v 1.8 1.9 1.2
v 1.8 1.9 1.8
v 1.2 1.9 1.8
o walls
usemtl wall
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
o {left}
usemtl warm
f 9 10 11 12
o {right}
usemtl cold
f 13 14 15 16
"""
MATERIALS = """\
newmtl wall
Kd 0.7 0.5 0.2
newmtl warm
Ke 9 5 1
newmtl cold
Ke 0.1 0.2 0.9
"""
QUICK = ("--resolution", "64", "--patch-size", "0.5", "--quality", "draft")
FLOAT, HALF = 2.0 ** -22, 2.0 ** -9  # some roundings of each
DIMMEST_HALF = 2.0 ** -22  # below 2^-14, half has steps of 2^-24


class Layers(CommandLine):
    def setUp(self):
        super().setUp()
        self.write("scene.mtl", MATERIALS)
        self.place_lamps("left.1", "right")

    def place_lamps(self, left, right):
        self.write("scene.obj", BOX.replace("{left}", left).replace("{right}", right))

    def exr(self, *arguments):
        self.assert_done(self.run_hemirad("solve", "scene.obj", "-o", "a.exr", *QUICK, *arguments))
        return Exr(self.folder / "a.exr")

    def assert_sum(self, channels, layers, relative, absolute=0.0):
        for band in "RGB":
            parts = [channels[f"{layer}.{band}"] for layer in layers]
            self.assertGreater(max(channels[band]), 0)
            for whole, *each in zip(channels[band], *parts):
                self.assertAlmostEqual(whole, sum(each), delta=relative * whole + absolute)

    def test_lights_add_up_to_the_whole(self):
        for arguments, relative, absolute in ((("--lights", "separate"), FLOAT, 0.0),
                                              (("--lights", "separate", "--half"), HALF,
                                               DIMMEST_HALF)):
            channels = self.exr(*arguments).channels()
            self.assert_sum(channels, ("light.left%2E1", "light.right"), relative, absolute)
            for layer in ("light.left%2E1", "light.right"):
                self.assertGreater(max(channels[layer + ".G"]), 0)

    def test_direct_and_indirect_light_add_up_to_the_whole(self):
        for quantity in ("irradiance", "radiosity"):
            channels = self.exr("--layers", "direct,indirect", "--quantity", quantity).channels()
            self.assert_sum(channels, ("direct", "indirect"), FLOAT)
            self.assertGreater(max(channels["direct.R"]), max(channels["indirect.R"]))
            self.assertGreater(max(channels["indirect.R"]), 0)

    def test_direct_light_leaves_the_whole_as_it_is(self):
        plain = self.exr().channels()
        layered = self.exr("--layers", "direct,emission,normal,position").channels()
        for name, values in plain.items():
            self.assertEqual(values, layered[name])

    def test_radiosity_is_what_is_reflected_and_emitted(self):
        irradiance = self.exr().channels()["G"]
        channels = self.exr("--quantity", "radiosity", "--layers", "emission").channels()
        for radiosity, emission, arrives in zip(channels["G"], channels["emission.G"], irradiance):
            reflected = 0.0 if emission else 0.5 * arrives
            self.assertAlmostEqual(radiosity, reflected + emission, delta=1e-5 * radiosity)
        self.assertAlmostEqual(max(channels["emission.R"]), 9 * 3.14159265, delta=1e-4)

    def test_shots_are_those_of_each_patch_and_all_of_them_together(self):
        self.write("scene.mtl", scenes.MATERIALS)
        self.write("scene.obj", scenes.obj())
        exr = self.exr("--layers", "shots", "--half", "--texel-size", "0.25", "--backfaces", "cull",
                       "--report", "r.json")
        self.assertEqual("f", exr.types["shots.Y"])
        channels = exr.channels()
        shots = [s for s, part in zip(channels["shots.Y"], channels["coverage"]) if part == 1]
        report = json.loads((self.folder / "r.json").read_text(encoding="utf-8"))
        self.assertEqual(4 * 8, len(shots))  # of 2 x 2 patches of 2 x 2 texels on either square
        self.assertEqual(4 * report["shots"], sum(shots))
        self.assertGreaterEqual(report["shots"], 4)

    def test_points_and_normals_are_those_of_the_scene(self):
        exr = self.exr("--layers", "normal,position", "--half")
        channels = exr.channels()
        self.assertEqual("f", exr.types["position.X"])
        found = zip(channels["coverage"], *(channels[f"position.{axis}"] for axis in "XYZ"),
                    channels["normal.Y"])
        lamps = walls = 0
        for coverage, x, y, z, up in found:
            if coverage < 1:
                continue
            self.assertTrue(0 <= min(x, y, z) and max(x, y, z) <= 2, (x, y, z))
            lamps += abs(y - 1.9) < 1e-6 and up == -1
            walls += up == 0
        self.assertGreater(lamps, 4)
        self.assertGreater(walls, lamps)

    def test_the_header_says_what_layers_hold(self):
        exr = self.exr("--lights", "separate", "--layers", "direct,error,position")
        self.assertEqual('irradiance of light "left.1", reflections included, W/m^2',
                         exr.text("layer.light.left%2E1"))
        self.assertIn("W/m^2", exr.text("layer.direct"))
        self.assertIn("W/m^2", exr.text("layer.error"))
        self.assertIn(", m", exr.text("layer.position"))
        self.assertIn("--lights separate --layers direct,position", exr.text("settings"))
        self.assertIn("error.G", exr.types)
        self.assertNotIn("indirect.G", exr.types)

    def test_names_cannot_forge_channels_columns_or_json(self):
        self.place_lamps('a,b"/R', "indirect.R\u00fc")
        exr = self.exr("--lights", "separate", "--layers", "indirect", "--faces", "a.csv",
                       "--report", "r.json")
        self.assertIn("light.a%2Cb%22%2FR.G", exr.types)
        self.assertIn("light.indirect%2ER%C3%BC.G", exr.types)
        rows = list(csv.reader((self.folder / "a.csv").read_text().splitlines()))
        self.assertEqual({len(rows[0])}, {len(row) for row in rows})
        self.assertIn("light.a%2Cb%22%2FR.irradiance.G", rows[0])
        lights = json.loads((self.folder / "r.json").read_text())["lights"]
        self.assertEqual(['a,b"/R', "indirect.R\u00fc"], [light["name"] for light in lights])

    def test_the_report_keeps_books_of_each_light(self):
        self.exr("--lights", "separate", "--report", "r.json")
        report = json.loads((self.folder / "r.json").read_text())
        self.assertEqual("separate", report["settings"]["lights"])
        self.assertEqual(["light.left%2E1", "light.right"],
                         [light["layer"] for light in report["lights"]])
        for band, ledger in report["ledger"].items():
            each = [light["ledger"][band] for light in report["lights"]]
            self.assertAlmostEqual(ledger["emitted"], sum(light["emitted"] for light in each))
            for light in each:
                self.assertLess(light["unshot"], 1e-3 * light["emitted"])
                self.assertLess(light["residual"], 1e-5)

    def test_faces_tell_lights_apart(self):
        self.exr("--lights", "separate", "--faces", "a.csv")
        with open(self.folder / "a.csv", encoding="utf-8") as lines:
            rows = list(csv.DictReader(lines))
        for row in rows:
            each = [float(row[f"light.{name}.irradiance.R"]) for name in ("left%2E1", "right")]
            self.assertAlmostEqual(float(row["irradiance.R"]), sum(each), delta=1e-7)

    def test_snapshots_leave_the_layers_as_they_are(self):
        arguments = ("--lights", "separate", "--layers", "direct,indirect")
        plain = self.exr(*arguments).bytes
        self.assertEqual(plain, self.exr(*arguments, "--snapshot-every", "50").bytes)

    def test_lights_add_up_after_any_shot(self):
        arguments = ("--lights", "separate", "--layers", "direct,indirect")
        interim = self.exr(*arguments, "--max-shots", "3").channels()
        self.assert_sum(interim, ("light.left%2E1", "light.right"), FLOAT)

    def test_materials_tell_the_lights_of_one_object_apart(self):
        self.place_lamps("lamps", "lamps")
        for how in ("separate", "by-material"):
            exr = self.exr("--lights", how)
            self.assertIn("light.warm.R", exr.types)
            self.assertIn("light.cold.R", exr.types)

    def test_info_lists_the_lights(self):
        result = self.run_hemirad("info", "scene.obj")
        self.assert_done(result)
        self.assertIn("lights       2; --lights separate solves 6 bands", result.stdout)
        self.assertIn("  left.1: emits ", result.stdout)
        more = self.run_hemirad("info", "scene.obj", "--lights", "by-material")
        self.assertIn("--lights by-material", more.stdout)


class BadLayers(CommandLine):
    def test_words_that_are_not_known(self):
        for arguments in (("--layers", "direct,shade"), ("--layers", ""), ("--layers", "direct,"),
                          ("--lights", "apart")):
            self.assert_refused(self.solve(*arguments), "hemirad: " + arguments[0],
                                says="expected")

    def test_more_lights_than_a_device_takes(self):
        self.write("many.obj", many_lamps(600))
        result = self.run_hemirad("solve", "many.obj", "--lights", "separate", "--patch-size",
                                  "inf")
        self.assert_refused(result, "many.obj: 600 bands to solve at once, ",
                            says="--lights by-material tells 1 instead of 600 lights apart")


def many_lamps(count):
    lines = ["mtllib scene.mtl", "o floor", "usemtl white"]
    lines += ["v 0 0 0", "v 0 0 9", "v 9 0 9", "v 9 0 0", "f -4 -3 -2 -1"]
    for lamp in range(count):
        x, z = lamp % 40 / 5, lamp // 40 / 5
        lines += [f"o lamp{lamp}", "usemtl lamp"]
        lines += [f"v {x + dx} 1 {z + dz}" for dx, dz in ((0, 0), (.1, 0), (.1, .1), (0, .1))]
        lines += ["f -4 -3 -2 -1"]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
