#!/usr/bin/env python3
"""`hemirad sweep` and the options of the machine model. HEMIRAD names the binary."""
import csv
import sys
import unittest

import scenes

SETTINGS = 17  # columns that a row is known by


class CommandLine(scenes.InFolder):
    def run_hemirad(self, *arguments):
        return super().run_hemirad(*arguments, timeout=250)

    def sweep(self, *arguments):
        result = self.run_hemirad("sweep", "scene.obj", "--smoke", "--patch-size", "0.5",
                                  *arguments)
        self.assertEqual(0, result.returncode, result.stderr)
        return result

    def rows(self, name="sweep.csv"):
        with open(self.folder / name, encoding="utf-8", newline="") as file:
            return list(csv.reader(file))


class Sweep(CommandLine):
    def files(self):
        return {path.name: path.read_bytes() for path in self.folder.iterdir()}

    def test_smoke_stop_and_resume(self):
        self.sweep()
        file = self.folder / "sweep.csv"
        whole = self.rows()
        self.assertEqual(8, len(whole))  # the header and seven machines
        self.assertEqual({len(whole[0])}, {len(row) for row in whole})
        self.assertEqual(7, len({tuple(row[:SETTINGS]) for row in whole[1:]}))

        counts = [column for column, name in enumerate(whole[0])
                  if name in ("visible_patches", "projected_patches")]
        for column in counts:  # a machine changes no count of patches
            self.assertEqual(1, len({row[column] for row in whole[1:]}))

        with self.subTest("a whole sweep is not made again"):
            before = file.read_bytes()
            self.sweep()
            self.assertEqual(before, file.read_bytes())

        with self.subTest("a torn last line is dropped, and the rest made"):
            text = file.read_text(encoding="utf-8")
            lines = text.splitlines(keepends=True)
            file.write_text("".join(lines[:5]) + lines[5][:40], encoding="utf-8")
            self.sweep()
            self.assertEqual(lines[:5], file.read_text(encoding="utf-8").splitlines(True)[:5])
            self.assertEqual([row[:SETTINGS] for row in whole],
                             [row[:SETTINGS] for row in self.rows()])

    def test_another_file_is_not_touched(self):
        file = self.folder / "sweep.csv"
        for content in ("face,object\n1,wall\n", "a letter without an end"):
            file.write_text(content, encoding="utf-8")
            result = self.run_hemirad("sweep", "scene.obj", "--smoke")
            self.assertEqual(1, result.returncode)
            self.assertTrue(result.stderr.startswith("sweep.csv: "), result.stderr)
            self.assertEqual(content, file.read_text(encoding="utf-8"))

    def test_no_file_of_any_scene_is_taken_for_a_sweep(self):
        self.write("scene.mtl", scenes.MATERIALS + "map_Kd empty.png\n")
        self.write("empty.png", "")
        self.write("other.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        (self.folder / "a.csv").symlink_to("scene.mtl")
        (self.folder / "b.csv").symlink_to("scene.obj")
        for swept in (("scene.obj",), ("other.obj", "scene.obj"), ("scene.obj", "other.obj")):
            for output, what in (("empty.png", "a file of the scene"),
                                 ("a.csv", "a file of the scene"), ("b.csv", "the scene")):
                with self.subTest(swept=swept, output=output):
                    before = self.files()
                    result = self.run_hemirad("sweep", *swept, "--smoke", "-o", output)
                    line = f"hemirad: {output}: would overwrite {what}\n"
                    self.assertEqual((1, line), (result.returncode, result.stderr))
                    self.assertEqual(before, self.files())


class MachineModel(CommandLine):
    QUICK = ("--resolution", "64", "--patch-size", "0.5", "--max-shots", "9", "-q")

    def solve(self, *arguments):
        result = self.run_hemirad("solve", "scene.obj", *self.QUICK, "-o", "out.exr", *arguments)
        self.assertEqual(0, result.returncode, result.stderr)
        return (self.folder / "out.exr").read_bytes()

    def test_layout_broadcast_and_accumulation_change_no_bit_of_the_file(self):
        usual = self.solve()
        for option in (("--layout", "block"), ("--broadcast", "patch"), ("--broadcast", "level"),
                       ("--accumulate", "xnet")):
            self.assertEqual(usual, self.solve(*option), option)

    def test_evaluation_and_distance_are_named_in_the_header(self):
        for option in ("--evaluate", "incremental"), ("--distance", "constant"):
            self.assertNotIn(option[0].encode(), self.solve())
            self.assertIn(" ".join(option).encode(), self.solve(*option))

    def test_other_words_are_refused(self):
        for option in ("--layout", "--broadcast", "--evaluate", "--accumulate", "--distance"):
            result = self.run_hemirad("solve", "scene.obj", option, "other")
            self.assertEqual(1, result.returncode)
            self.assertIn(option + ' "other": expected', result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
