#!/usr/bin/env python3
"""`hemirad solve`: the dial of accuracy. HEMIRAD names the binary."""
import json
import math
import pathlib
import sys
import unittest

from cli_test import CommandLine

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"


class Accuracy(CommandLine):
    def solved(self, *arguments, scene=SCENES / "cornell.gltf"):
        """The report, as JSON."""
        result = self.run_hemirad("solve", str(scene), "--patch-size", "0.25", "--report", "r.json",
                                  "-o", "out.exr", *arguments)
        self.assert_done(result)
        self.words = result.stderr
        return json.loads((self.folder / "r.json").read_text())

    def irradiances(self):
        lines = (self.folder / "f.csv").read_text().splitlines()
        column = lines[0].split(",").index("irradiance.G")
        return [float(line.split(",")[column]) for line in lines[1:] if line.split(",")[column]]

    def channels(self):
        return (self.folder / "out.exr").read_bytes()[:4000]

    def test_qualities_are_steps_of_one_dial(self):
        found = [self.solved("--quality", quality, "--max-shots", "3")["settings"]
                 for quality in ("draft", "medium", "high", "ultra")]

        for coarser, finer in zip(found, found[1:]):
            self.assertLessEqual(coarser["resolution"], finer["resolution"])
            self.assertLess(coarser["shooter_samples"], finer["shooter_samples"])
            self.assertGreater(coarser["sampling_error"], finer["sampling_error"])
        self.assertEqual(found[1], self.solved("--max-shots", "3")["settings"])

    def test_what_is_given_beside_a_quality_counts(self):
        found = self.solved("--resolution", "64", "--quality", "high", "--max-shots", "3")

        self.assertEqual(64, found["settings"]["resolution"])
        self.assertEqual(4, found["settings"]["shooter_samples"])

    def test_a_target_is_met(self):
        report = self.solved("--target-error", "0.02", "--faces", "f.csv")
        reached = self.irradiances()
        self.solved("--resolution", "256", "--shooter-samples", "16", "--sampling-error", "1e-7",
                    "--tolerance", "1e-4", "--faces", "f.csv")
        truth = self.irradiances()

        self.assertLessEqual(report["error"]["relative_rms"], 0.02)
        mean = sum(truth) / len(truth)
        rms = math.sqrt(sum((a - b) ** 2 for a, b in zip(reached, truth)) / len(truth))
        self.assertLess(rms / mean, 0.02)

    def test_a_target_sets_what_it_needs_itself(self):
        for option in (["--quality", "draft"], ["--resolution", "64"], ["--shooter-samples", "2"]):
            result = self.run_hemirad("solve", "scene.obj", "--target-error", "0.1", *option)
            self.assert_refused(result, "hemirad:", says=option[0])
        for target in ("0", "-1", "nan", "much"):
            result = self.run_hemirad("solve", "scene.obj", "--target-error", target)
            self.assert_refused(result, "hemirad:", says="--target-error")

    def test_an_estimate_goes_into_report_and_picture(self):
        report = self.solved("--quality", "draft", "--estimate-error")

        self.assertGreater(report["error"]["relative_rms"], 1e-3)
        self.assertGreater(report["error"]["largest"], 0)
        self.assertIn(b"error.G", self.channels())
        self.assertIn("error about", self.words)

    def test_an_estimate_that_was_stopped_is_told(self):
        report = self.solved("--quality", "draft", "--max-shots", "3", "--estimate-error")

        self.assertIsNone(report["error"])
        self.assertIn("--estimate-error: stopped before it was known", report["warnings"])
        self.assertIn("warning: --estimate-error: stopped", self.words)

    def test_no_estimate_where_none_is_asked_for(self):
        self.assertIsNone(self.solved("--quality", "draft", "--max-shots", "3")["error"])
        self.assertNotIn(b"error.G", self.channels())

    def test_counting_is_still_there(self):
        analytic = self.solved("--max-shots", "30")
        counted = self.solved("--max-shots", "30", "--form-factor", "count")

        self.assertEqual("analytic", analytic["settings"]["form_factor"])
        self.assertEqual("count", counted["settings"]["form_factor"])
        self.assertEqual("auto", counted["settings"]["shooter_samples"])
        self.assertEqual({"min": 1.0, "max": 1.0}, counted["closure"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
