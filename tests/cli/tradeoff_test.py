#!/usr/bin/env python3
"""`hemirad tradeoff`: error against time and samples. HEMIRAD names the binary."""
import csv
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import scenes

HEMIRAD = os.environ["HEMIRAD"]
CORNELL = pathlib.Path(__file__).resolve().parents[2] / "scenes" / "cornell.gltf"
NUMBERS = ("patch_size", "patches", "samples", "seconds", "rms_error", "largest_error")


def write_scene(folder, materials=scenes.MATERIALS):
    """A lamp near the floor, so that points on the shooter matter."""
    near = scenes.LIGHT_AND_FLOOR.replace(" 1 0\n", " 0.3 0\n").replace(" 1 1\n", " 0.3 1\n")
    (folder / "scene.mtl").write_text(materials, encoding="utf-8")
    (folder / "scene.obj").write_bytes(scenes.obj(vertices=near))


def run_hemirad(folder, *arguments):
    return subprocess.run([HEMIRAD, "tradeoff", *arguments], cwd=folder, text=True,
                          capture_output=True, timeout=250, check=False)


def read_rows(file):
    with open(file, encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(lines))


def chosen(rows, **settings):
    return [row for row in rows if all(row[name] == value for name, value in settings.items())]


def error(rows, column="rms_error", **settings):
    (row,) = chosen(rows, **settings)
    return float(row[column])


def dominated(row, rows, column):
    """Another is no slower and no farther off, and better in one of the two."""
    mine = float(row["seconds"]), float(row[column])
    others = ((float(other["seconds"]), float(other[column])) for other in rows)
    return any(x <= mine[0] and y <= mine[1] and (x, y) != mine for x, y in others)


class Tradeoff(unittest.TestCase):
    """One run, looked at from all sides."""

    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write_scene(folder)
            cls.result = run_hemirad(folder, "scene.obj", "--quick", "--patch-size", "0.25",
                                     "-o", "out.csv")
            if cls.result.returncode != 0:
                raise AssertionError(cls.result.stderr)
            cls.rows = read_rows(folder / "out.csv")
        cls.factors = chosen(cls.rows, kind="factors")
        cls.solves = chosen(cls.rows, kind="solve")

    def factor(self, method, resolution, points, runs_on="host", column="rms_error"):
        return error(self.factors, column, method=method, runs_on=runs_on,
                     resolution=resolution, shooter_samples=points)

    def solve(self, size, resolution, points, column="rms_error"):
        return error(self.solves, column, method="count", patch_size=size, resolution=resolution,
                     shooter_samples=points)

    def test_every_row_is_whole_and_was_announced(self):
        self.assertEqual(len(self.rows), self.result.stderr.count(" rms, "))
        for row in self.rows:
            for name in NUMBERS:
                self.assertGreater(float(row[name]), 0, row)

    def test_all_methods_are_there(self):
        on_device = {"count", "analytic", "constant_distance"}
        self.assertEqual(on_device | {"hemicube", "single_plane", "monte_carlo"},
                         {row["method"] for row in self.factors})
        self.assertEqual(on_device, {row["method"] for row in self.solves})

    def test_samples_are_what_the_methods_take(self):
        for method, samples in ("count", 812), ("hemicube", 3 * 32**2), ("single_plane", 32**2):
            self.assertEqual(samples, self.factor(method, "32", "1", column="samples"))
            self.assertEqual(4 * samples, self.factor(method, "32", "2", column="samples"))
        for row in self.solves:
            in_disk = {"32": 812, "128": 12892}[row["resolution"]]
            points = int(row["shooter_samples"]) ** 2
            self.assertEqual(int(row["shots"]) * points * in_disk, float(row["samples"]))

    def test_points_proxels_and_rays_bring_factors_nearer(self):
        for method, runs_on in ("count", "device"), ("count", "host"), ("hemicube", "host"):
            fine = self.factor(method, "128", "2", runs_on)
            self.assertLess(fine, 0.5 * self.factor(method, "128", "1", runs_on))
            if runs_on == "host":  # the device turns the disk from point to point
                self.assertLess(fine, 0.9 * self.factor(method, "32", "2"))
        rays = [float(row["rms_error"]) for row in chosen(self.factors, method="monte_carlo")]
        self.assertLess(rays[-1], 0.4 * rays[0])

    def test_analytic_factors_of_near_patches_need_no_points(self):
        for points in "1", "2":
            self.assertLess(self.factor("analytic", "32", points, "device"),
                            0.5 * self.factor("count", "128", "2", "device"))

    def test_device_and_host_count_alike(self):
        for points in "1", "2":
            device = self.factor("count", "128", points, "device")
            host = self.factor("count", "128", points, "host")
            self.assertLess(abs(device - host), 0.15 * host)

    def test_single_plane_is_farther_off_than_hemicube(self):
        self.assertGreater(self.factor("single_plane", "128", "2"),
                           2 * self.factor("hemicube", "128", "2"))

    def test_row_sums_and_what_leaves_make_one_but_for_the_single_plane(self):
        self.assertLess(self.factor("count", "128", "2", column="row_sum_error"), 0.01)
        self.assertLess(self.factor("hemicube", "128", "2", column="row_sum_error"), 0.01)
        self.assertGreater(self.factor("single_plane", "32", "2", column="row_sum_error"), 0.03)

    def test_finer_solves_are_nearer_and_coarser_patches_farther(self):
        fine, coarse = sorted({row["patch_size"] for row in self.solves}, key=float)
        for size in fine, coarse:
            self.assertLess(self.solve(size, "128", "2"), 0.5 * self.solve(size, "32", "1"))
        self.assertLess(self.solve(fine, "128", "2", "faces_rms_error"),
                        0.5 * self.solve(coarse, "128", "2", "faces_rms_error"))

    def test_pareto_front_is_what_no_other_row_beats(self):
        for rows, column in (self.factors, "rms_error"), (self.solves, "faces_rms_error"):
            for row in rows:
                self.assertEqual("0" if dominated(row, rows, column) else "1", row["pareto"], row)
            self.assertEqual({"0", "1"}, {row["pareto"] for row in rows})


class OddScenes(scenes.InFolder):
    def test_dark_scene_has_factors_only(self):
        write_scene(self.folder, "newmtl white\nKd 1 1 1\nnewmtl lamp\nKd 1 1 1\n")

        result = run_hemirad(self.folder, "scene.obj", "--quick", "--patch-size", "0.5")

        self.assertEqual(0, result.returncode, result.stderr)
        self.assertIn("nothing emits light", result.stderr)
        rows = read_rows(self.folder / "tradeoff.csv")
        self.assertEqual({"factors"}, {row["kind"] for row in rows})

    def test_constant_distance_loses_what_stands_before_a_ramp(self):
        # A small sheet under a ramp whose middle is nearer to the floor.
        write_scene(self.folder, "newmtl white\nKd 1 1 1\n")
        corners = ((-.3, -.3, 0), (.3, -.3, 0), (.3, .3, 0), (-.3, .3, 0),
                   (-3, -1, .2), (-3, 1, .2), (3, 1, 2.2), (3, -1, 2.2),
                   (1.1, -.4, 1.4), (1.1, .4, 1.4), (1.9, .4, 1.4), (1.9, -.4, 1.4))
        vertices = "".join("v {} {} {}\n".format(*corner) for corner in corners)
        faces = "usemtl white\nf 1 2 3 4\nf 5 6 7 8\nf 9 10 11 12\n"
        (self.folder / "scene.obj").write_bytes(scenes.obj(vertices, faces))

        result = run_hemirad(self.folder, "scene.obj", "--quick", "--patch-size", "inf")

        self.assertEqual(0, result.returncode, result.stderr)
        rows = read_rows(self.folder / "tradeoff.csv")
        settings = {"runs_on": "device", "resolution": "128", "shooter_samples": "2"}
        self.assertGreater(error(rows, method="constant_distance", **settings),
                           1.05 * error(rows, method="count", **settings))

    def test_stopped_before_the_first_row_leaves_the_older_table(self):
        """Of patches whose factors take minutes to integrate."""
        self.write("out.csv", "older")
        process = subprocess.Popen([HEMIRAD, "tradeoff", CORNELL, "--patch-size", "0.02", "-o",
                                    "out.csv"], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.kill)
        self.assertIn("true factors", process.stderr.readline())
        time.sleep(2)

        process.send_signal(signal.SIGINT)

        self.assertEqual(130, process.wait(90))  # kernels may be under way, which no signal stops
        self.assertEqual("older", (self.folder / "out.csv").read_text(encoding="utf-8"))

    def test_wrong_files_are_refused_before_the_work(self):
        write_scene(self.folder)
        for scene, output, says in (("scene.obj", "out.exr", ".csv"),
                                    ("nowhere.obj", "out.csv", "nowhere.obj: ")):
            result = run_hemirad(self.folder, scene, "-o", output)

            self.assertEqual(1, result.returncode, result.stderr)
            self.assertEqual(1, result.stderr.count("\n"), result.stderr)
            self.assertIn(says, result.stderr)
            self.assertFalse((self.folder / output).exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
