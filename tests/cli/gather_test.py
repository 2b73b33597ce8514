#!/usr/bin/env python3
"""`hemirad solve --gather`: options, report, layers and the glTF's picture. HEMIRAD names the
binary."""
import json
import pathlib
import signal
import subprocess
import sys
import unittest

from cli_test import HEMIRAD, CommandLine
from exr import Exr
from exr_layers_test import BOX, FLOAT, MATERIALS

QUICK = ("--resolution", "64", "--patch-size", "0.5", "--quality", "draft", "--texel-size", "0.125")
GATHER = ("--gather", "64")
MEASURE_GATHER = pathlib.Path(__file__).resolve().parents[2] / "tools/measure-gather"


class Gather(CommandLine):
    def setUp(self):
        super().setUp()
        self.write("scene.mtl", MATERIALS)
        self.write("scene.obj", BOX.replace("{left}", "left").replace("{right}", "right"))

    def run_to(self, output, *arguments):
        self.assert_done(self.run_hemirad("solve", "scene.obj", "-o", output, *QUICK, *arguments))

    def channels(self, *arguments):
        self.run_to("a.exr", *arguments)
        return Exr(self.folder / "a.exr").channels()

    def report(self, *arguments):
        self.run_to("a.exr", "--report", "a.json", *arguments)
        return json.loads((self.folder / "a.json").read_text())

    def test_the_report_counts_texels_and_seconds(self):
        every = self.report(*GATHER, "--gather-error", "0")
        some = self.report(*GATHER, "--gather-error", "0.3")
        none = self.report()

        self.assertEqual(0, every["gather"]["texels_interpolated"])
        self.assertGreater(some["gather"]["texels_interpolated"], 0)
        self.assertEqual(every["gather"]["texels_gathered"],
                         sum(some["gather"].values()))
        self.assertGreater(every["seconds"]["gather"], 0)
        self.assertEqual(64, every["settings"]["gather"])
        self.assertEqual(0, every["settings"]["gather_error"])
        self.assertIsNone(none["gather"])
        self.assertEqual(0, none["seconds"]["gather"])
        self.assertNotIn("gather", none["settings"])

    def measured(self, *arguments):
        done = subprocess.run(
            [sys.executable, MEASURE_GATHER, "scene.obj", "reference.exr", "--texel-size", "0.125",
             "--hemirad", HEMIRAD, *arguments], cwd=self.folder, text=True, capture_output=True,
            check=False)
        return done.stderr or [[cell.strip() for cell in row.split("|")[1:-1]]
                               for row in done.stdout.splitlines()[2:]]

    def test_what_a_gather_buys_is_measured_against_a_reference(self):
        self.assert_done(self.run_hemirad(
            "solve", "scene.obj", "-o", "reference.exr", *QUICK[2:], *GATHER, "--gather-error", "0"))

        rows = self.measured("--patch-size", "0.5", "--gather", "64/0")

        self.assertEqual(["from patches", "`--gather 64 --gather-error 0`"], [row[2] for row in rows])
        self.assertEqual(["0.00 %", "0.0 %"], rows[1][5:])
        self.assertGreater(float(rows[0][5].split()[0]), 0.1)
        self.assertIn("the reference has other charts",
                      self.measured("--patch-size", "0.5", "--texel-size", "0.25"))

    def test_lights_and_direct_and_indirect_light_add_up_to_what_is_gathered(self):
        for quantity in ("irradiance", "radiosity"):
            with self.subTest(quantity=quantity):
                channels = self.channels(*GATHER, "--gather-error", "0", "--quantity", quantity,
                                         "--lights", "separate", "--layers", "direct,indirect")
                for parts in (("light.left", "light.right"), ("direct", "indirect")):
                    for band in "RGB":
                        split = [channels[f"{part}.{band}"] for part in parts]
                        for whole, *each in zip(channels[band], *split):
                            self.assertAlmostEqual(whole, sum(each), delta=4 * FLOAT * whole)
                self.assertGreater(max(channels["direct.G"]), 0)

    def test_gathered_light_is_near_to_that_of_the_patches_but_is_not_the_same(self):
        coarse = self.channels()
        fine = self.channels(*GATHER)

        mean = sum(coarse["G"]) / len(coarse["G"])
        error = sum(abs(a - b) for a, b in zip(coarse["G"], fine["G"])) / len(coarse["G"])
        self.assertGreater(error, 1e-4 * mean)
        self.assertLess(error, 0.2 * mean)
        self.assertEqual(coarse["coverage"], fine["coverage"])

    def test_the_scene_for_engines_has_the_gathered_light(self):
        pictures = []
        for arguments in ((), GATHER):
            self.run_to("a.glb", *arguments)
            pictures.append((self.folder / "a.glb").read_bytes())

        self.assertNotEqual(*pictures)

    def test_a_time_limit_ends_the_gather_and_the_picture_is_that_of_the_patches(self):
        endless = ("--gather", "2048", "--gather-error", "0", "--texel-size", "0.01")
        result = self.run_hemirad("solve", "scene.obj", "-o", "a.exr", "--report", "a.json",
                                  *QUICK[:-2], *endless, "--time-limit", "2")
        self.assertEqual(0, result.returncode, result.stderr)
        self.assertIn("--gather: stopped by --time-limit 2", result.stderr)
        report = json.loads((self.folder / "a.json").read_text())
        self.assertIsNone(report["gather"])
        self.assertNotIn("gather", report["settings"])
        self.assertNotIn("--gather", Exr(self.folder / "a.exr").text("settings"))

    def test_a_signal_leaves_the_gather_out_and_is_named(self):
        process = self.solve_until("c.ckpt", "-o", "a.exr", "--report", "a.json", *QUICK[:-2],
                                   "--gather", "2048", "--gather-error", "0", "--texel-size",
                                   "0.01", "--checkpoint", "c.ckpt", "--checkpoint-every", "1")
        process.send_signal(signal.SIGTERM)
        self.assertEqual(130, process.wait(60))
        says = "--gather: stopped by a signal; the lightmap is that of the patches"
        self.assertIn(says, process.stderr.read())
        report = json.loads((self.folder / "a.json").read_text())
        self.assertIn(says, report["warnings"])
        self.assertNotIn("gather", report["settings"])

    def test_only_a_gathered_picture_names_it_in_its_settings(self):
        self.run_to("a.exr", *GATHER, "--snapshot-every", "2", "--keep-snapshots",
                    "--max-shots", "4")
        pictures = {file.name: "--gather 64" in Exr(file).text("settings")
                    for file in self.folder.glob("*.exr")}
        self.assertTrue(pictures.pop("a.exr"))
        self.assertEqual({False}, set(pictures.values()))

    def test_bad_values(self):
        for arguments, says in ((("--gather", "8"), "--gather"), (("--gather", "x"), "--gather"),
                                ((*GATHER, "--gather-error", "-1"), "--gather-error"),
                                ((*GATHER, "--gather-error", "1"), "--gather-error"),
                                (("--gather-error", "0.1"), "--gather")):
            with self.subTest(arguments=arguments):
                self.assert_refused(self.run_hemirad("solve", "scene.obj", *arguments), "hemirad: ",
                                    says=says)


if __name__ == "__main__":
    unittest.main()
