#!/usr/bin/env python3
"""Scenes whose names mean something to a terminal, a spreadsheet, a browser or a file system, by the
program that HEMIRAD names: what it writes, and that it writes nothing else."""
import csv
import json
import os
import re
import unittest

import scenes

HEMIRAD = os.environ["HEMIRAD"]
NAMES = [
    "../../escape", "/tmp/escape.exr", "a\nb", "\x1b]0;title\x07\x1b[31m", "say \"hi\", you", "=1+2",
    "@SUM(A1)", "-2+3|cmd", "</script><script>alert(1)", "%2e%2e/x", "\u202ereversed", "x" * 1000,
    "nul\0byte", "",
]


def scene(names):
    """Lamps above each other, an object and a material each; the last name the camera's."""
    text = json.loads(scenes.gltf())
    text["materials"] = [{"name": name, "emissiveFactor": [1, 1, 1], "pbrMetallicRoughness": {
        "baseColorFactor": [0.5, 0.5, 0.5, 1]}} for name in names]
    primitive = text["meshes"][0]["primitives"][0]
    text["meshes"] = [{"name": name, "primitives": [{**primitive, "material": i}]}
                      for i, name in enumerate(names)]
    text["nodes"] = [{"name": name, "mesh": i, "translation": [0, 0, i]}
                     for i, name in enumerate(names)]
    text.pop("scenes", None), text.pop("scene", None)
    return json.dumps(text).encode()


class HostileNames(scenes.InFolder):
    def tree(self):
        root = self.folder
        return {p.relative_to(root).as_posix(): p.read_bytes() for p in root.rglob("*") if p.is_file()}

    def setUp(self):
        super().setUp()
        (self.folder / "deep/er").mkdir(parents=True)
        self.write("deep/er/scene.gltf", scene(NAMES))
        self.before = self.tree()

    def run_there(self, *arguments):
        result = self.run_hemirad(*arguments)
        self.assertEqual(0, result.returncode, result.stderr[:2000])
        lines = (result.stdout + result.stderr).split("\n")
        self.assertTrue(all(line.isprintable() for line in lines), [ascii(x)[:99] for x in lines])
        return result

    def assert_written(self, *names):
        """These, and nothing else is there or was changed."""
        after = self.tree()
        self.assertEqual(sorted([*self.before, *names]), sorted(after))
        self.assertEqual(self.before, {name: after[name] for name in self.before})

    def test_solve_writes_where_it_is_told_and_nowhere_else(self):
        self.run_there("solve", "deep/er/scene.gltf", "-o", "deep/a.exr", "--gltf", "deep/a.glb",
                       "--faces", "deep/a.csv", "--report", "deep/a.json", "--quality", "draft",
                       "--patch-size", "inf", "--max-shots", "3", "--resolution", "32",
                       "--lights", "separate")
        self.run_there("view", "deep/a.glb", "-o", "deep/a.html")

        self.assert_written(*(f"deep/a.{e}" for e in ("exr", "glb", "csv", "json", "html")))
        self.check_csv((self.folder / "deep/a.csv").read_text(encoding="utf-8"))
        self.check_page((self.folder / "deep/a.html").read_text(encoding="utf-8"))
        json.loads((self.folder / "deep/a.json").read_text(encoding="utf-8"))

    def check_csv(self, text):
        rows = list(csv.reader(text.splitlines()))
        self.assertEqual(1 + len(NAMES), len(rows))
        self.assertEqual({len(rows[0])}, {len(row) for row in rows})
        cells = [cell for row in rows for cell in row[1:3]]
        self.assertEqual([], [cell for cell in cells if cell.startswith(("=", "@", "-2"))])
        self.assertIn("'=1+2", cells)
        self.assertIn("../../escape", cells)

    def check_page(self, page):
        self.assertNotIn("<script>alert", page)
        json.loads(re.search(r'id="lit-scene">(.*?)</script>', page, re.S)[1])

    def test_form_factors_write_where_they_are_told_and_nowhere_else(self):
        self.run_there("formfactors", "deep/er/scene.gltf", "-o", "deep/f.csv", "--quality", "draft",
                       "--resolution", "32")

        self.assert_written("deep/f.csv")
        rows = list(csv.reader((self.folder / "deep/f.csv").read_text(encoding="utf-8").splitlines()))
        self.assertEqual({3}, {len(row) for row in rows})
        self.assertFalse([row for row in rows if row[0].startswith(("=", "@", "-2"))])


if __name__ == "__main__":
    unittest.main()
