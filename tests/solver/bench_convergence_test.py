#!/usr/bin/env python3
"""tools/bench_convergence on a small scene: bench_convergence_test.py TOOL SCENE."""
import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCENE = sys.argv.pop()
TOOL = sys.argv.pop()


def curve(*arguments):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "curve.csv"
        subprocess.run([TOOL, SCENE, "--patch-size", "0.25", "--csv", file, *arguments],
                       capture_output=True, text=True, check=True)
        with open(file, encoding="utf-8") as lines:
            return [{name: float(value) for name, value in row.items()}
                    for row in csv.DictReader(lines)]


class BenchConvergence(unittest.TestCase):
    def test_what_is_unshot_falls_to_the_tolerance(self):
        rows = curve("--tolerance", "1e-2")

        self.assertEqual(list(rows[0]), ["shots", "repeated_shots", "seconds", "unshot_fraction",
                                         "rms_to_end"])
        self.assertGreater(len(rows), 2)
        for before, after in zip(rows, rows[1:]):
            self.assertGreater(after["shots"], before["shots"])
            self.assertGreater(after["seconds"], before["seconds"])
            self.assertLess(after["unshot_fraction"], before["unshot_fraction"])
        self.assertLess(rows[-1]["unshot_fraction"], 1e-2)
        self.assertGreater(rows[0]["rms_to_end"], 0)
        self.assertEqual(rows[-1]["rms_to_end"], 0)

    def test_rows_are_kept_only_where_there_is_memory(self):
        kept, projected = curve()[-1], curve("--row-memory", "0")[-1]

        self.assertGreater(kept["repeated_shots"], 0)
        self.assertEqual(projected["repeated_shots"], 0)
        self.assertEqual(projected["shots"], kept["shots"])


if __name__ == "__main__":
    unittest.main()
