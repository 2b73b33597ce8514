#!/usr/bin/env python3
"""tools/faces_diff on solutions that a pencil can compare: faces_diff_test.py TOOL."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOOL = sys.argv.pop(1)
HEADER = "face,object,material,area,cx,cy,cz,irradiance.R,radiosity.R\n"


def solution(*radiosities, areas=(1, 3)):
    return HEADER + "".join(f"{face},wall,white,{area},0,0,0,7,{radiosity}\n"
                            for face, (area, radiosity) in enumerate(zip(areas, radiosities)))


class FacesDiff(unittest.TestCase):
    def compare(self, faces, reference, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            files = [pathlib.Path(folder) / name for name in ("a.csv", "b.csv")]
            for file, text in zip(files, (faces, reference)):
                file.write_text(text, encoding="utf-8")
            return subprocess.run([sys.executable, TOOL, *files, *arguments], capture_output=True,
                                  text=True, check=False)

    def test_equal_solutions_do_not_differ(self):
        done = self.compare(solution(2, 5), solution(2, 5), "--at-most", "0")

        self.assertEqual(done.returncode, 0)
        self.assertTrue(done.stdout.startswith("rms 0 rms_by_area 0 most 0 "), done.stdout)

    def test_differences_are_relative_to_each_face_and_by_area_to_the_mean(self):
        # Off by 0.3 and 0.4 of their own; by 0.3 and 0.8 where the mean is (1 * 1 + 3 * 2) / 4.
        done = self.compare(solution(1.3, 2.8), solution(1, 2))

        words = done.stdout.split()
        self.assertAlmostEqual(float(words[1]), (0.25 / 2) ** 0.5, 5)
        self.assertAlmostEqual(float(words[3]), ((0.09 + 3 * 0.64) / 4) ** 0.5 / 1.75, 5)
        self.assertEqual(words[4:], ["most", "0.4", "face", "1"])

    def test_faces_that_a_mesher_dropped_do_not_count(self):
        dropped = HEADER + "0,wall,white,1,0,0,0,7,2\n1,wall,white,,,,,,\n"

        self.assertTrue(self.compare(dropped, dropped).stdout.startswith("rms 0 "))

    def test_a_difference_above_at_most_is_a_failure(self):
        self.assertEqual(self.compare(solution(1.1, 2), solution(1, 2), "--at-most", "0.08")
                         .returncode, 0)
        self.assertEqual(self.compare(solution(1.1, 2), solution(1, 2), "--at-most", "0.07")
                         .returncode, 1)

    def test_other_scenes_are_refused(self):
        done = self.compare(solution(1, areas=(1,)), solution(1, 2))

        self.assertIn("other faces", done.stderr)
        self.assertEqual(done.returncode, 2)


if __name__ == "__main__":
    unittest.main()
