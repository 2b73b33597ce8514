#!/usr/bin/env python3
"""`hemirad formfactors`, and View3D's files. HEMIRAD names the binary."""
import csv
import json
import signal
import subprocess
import sys
import time
import unittest

from cli_test import HEMIRAD, CommandLine

CORNERS = "".join(f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (0, 1))
# Fronts inwards.
WALLS = {"x0": (1, 3, 4, 2), "x1": (5, 6, 8, 7), "floor": (1, 2, 6, 5), "ceiling": (3, 7, 8, 4),
         "z0": (1, 5, 7, 3), "z1": (2, 4, 8, 6)}
CUBE = "mtllib scene.mtl\nusemtl white\n" + CORNERS + "".join(f"o {name}\nf {' '.join(map(str, corners))}\n"
                         for name, corners in WALLS.items())
OPPOSITE = 0.199824896  # of a cube's walls, View3D user manual

# Unit squares at distance 1 and a screen of 0.5 x 0.5 between them.
SQUARES = """\
T two squares and what stands between
F 3
V 1 0 0 0
V 2 1 0 0
V 3 1 1 0
V 4 0 1 0
V 5 0 0 1
V 6 1 0 1
V 7 1 1 1
V 8 0 1 1
V 9 0 0 .5
V 10 .5 0 .5
V 11 .5 .5 .5
V 12 0 .5 .5
S 1 1 2 3 4 0 0 0.9 lower
S 2 7 6 5 8 0 0 0.5 upper
"""
SCREEN = "O 3 9 10 11 12\n"


class FormFactorsCase(CommandLine):
    def setUp(self):
        super().setUp()
        self.write("cube.obj", CUBE)
        self.write("squares.vs3", SQUARES + SCREEN + "End\n")

    def factors(self, *arguments, scene="cube.obj"):
        """{(from, to): value} as written to standard output."""
        result = self.run_hemirad("formfactors", scene, "--quiet", *arguments)
        self.assert_done(result)
        lines = list(csv.reader(result.stdout.splitlines()))
        self.assertEqual(["from", "to", "form_factor"], lines[0])
        pairs = {(row[0], row[1]): float(row[2]) for row in lines[1:]}
        self.assertEqual(len(lines) - 1, len(pairs))
        return pairs


class FormFactors(FormFactorsCase):
    def test_rows_of_a_cube_sum_to_1(self):
        factors = self.factors()
        for name in WALLS:
            self.assertAlmostEqual(1, sum(f for (a, _), f in factors.items() if a == name), 8)
            self.assertAlmostEqual(0, factors[name, "outside"], 3)
        self.assertEqual(6 * 5 + 6, len(factors))
        for a, b in (("x0", "x1"), ("floor", "ceiling"), ("z1", "z0")):
            self.assertAlmostEqual(OPPOSITE, factors[a, b], delta=0.01)

    def test_pairs_come_first_in_file_order_then_the_outside(self):
        names = list(self.factors())
        self.assertEqual([("x0", "x1"), ("x0", "floor")], names[:2])
        self.assertEqual([(name, "outside") for name in WALLS], names[-6:])

    def test_from_lists_each_pair_of_the_row(self):
        whole = self.factors()
        row = self.factors("--from", "floor")
        self.assertEqual([("floor", name) for name in (*WALLS, "outside")], list(row))
        self.assertEqual(0, row["floor", "floor"])
        for pair, value in row.items():
            self.assertAlmostEqual(whole.get(pair, 0), value, 8)

    def test_from_may_be_repeated(self):
        self.assertEqual({"floor", "x1"},
                         {a for a, _ in self.factors("--from", "floor", "--from", "x1")})

    def test_receivers_only_leaves_columns_out_and_their_light_too(self):
        pairs = self.factors("--from", "floor", "--receivers-only", "ceiling")
        self.assertEqual([("floor", "ceiling"), ("floor", "outside")], list(pairs))
        self.assertEqual(self.factors()["floor", "ceiling"], pairs["floor", "ceiling"])

    def test_blockers_only_hide_and_are_not_listed(self):
        pairs = self.factors("--blockers-only", "ceiling")
        self.assertNotIn("ceiling", {name for pair in pairs for name in pair})
        self.assertAlmostEqual(0, pairs["floor", "outside"], 3)

    def test_surfaces_of_one_name_are_one(self):
        self.write("rooms.obj", CUBE.replace("o z0", "o end").replace("o z1", "o end"))
        factors = self.factors(scene="rooms.obj")
        self.assertAlmostEqual(OPPOSITE, factors["end", "end"], delta=0.01)
        self.assertAlmostEqual(2 * factors["end", "floor"], factors["floor", "end"], delta=0.01)

    def test_names_are_quoted_as_csv_asks(self):
        self.write("odd.obj", CUBE.replace("o floor", 'o floor, "new"'))
        self.assertIn(('floor, "new"', "x0"), self.factors(scene="odd.obj"))

    def test_per_patch(self):
        pairs = self.factors("--per-patch")
        self.assertEqual({f"#{i}" for i in range(6)}, {a for a, _ in pairs})
        self.assertEqual({"#2"}, {a for a, _ in self.factors("--per-patch", "--from", "#2")})

    def test_patches_of_a_surface_are_gathered(self):
        coarse, fine = self.factors(), self.factors("--patch-size", "0.5")
        self.assertEqual(coarse.keys(), fine.keys())
        self.assertAlmostEqual(OPPOSITE, fine["x0", "x1"], delta=0.01)

    def test_one_hemisphere_sees_the_scene_from_the_centroid(self):
        pairs = self.factors("--from", "floor", "--patch-size", "inf", "--shooter-samples", "1")
        # Four quarters, each a corner's factor with sides of 1/2 at distance 1 (Siegel, Howell).
        self.assertAlmostEqual(0.2394, pairs["floor", "ceiling"], delta=0.002)

    def test_enforce_holds_both_laws(self):
        result = self.run_hemirad("formfactors", "cube.obj", "--enforce", "-o", "f.csv",
                                  "--report", "r.json", "--resolution", "64")
        self.assert_done(result)
        self.assertIn("enforced", result.stderr)
        after = json.loads((self.folder / "r.json").read_text())["enforce"]["after"]
        self.assertLess(after["closure"], 1e-12)
        self.assertLess(after["reciprocity"], 1e-12)

    def test_same_numbers_for_every_machine(self):
        self.assertEqual(self.factors(), self.factors("--lanes", "1", "--pe", "8x8"))

    def test_an_open_scene_loses_what_it_must(self):
        self.write("two.obj", CORNERS + "o floor\nf 1 2 6 5\no ceiling\nf 3 7 8 4\n")
        pairs = self.factors(scene="two.obj")
        self.assertEqual([("floor", "ceiling"), ("ceiling", "floor"), ("floor", "outside"),
                          ("ceiling", "outside")], list(pairs))
        self.assertAlmostEqual(1 - OPPOSITE, pairs["floor", "outside"], delta=0.01)

    def test_backs_that_are_seen_have_names_of_their_own(self):
        self.write("turned.obj", CORNERS + "o floor\nf 1 2 6 5\no ceiling\nf 4 8 7 3\n")
        pairs = self.factors(scene="turned.obj")
        self.assertAlmostEqual(OPPOSITE, pairs["floor", "ceiling (back)"], delta=0.01)
        self.assertEqual({"floor", "ceiling"}, {a for a, _ in pairs})


class View3d(FormFactorsCase):
    def text(self, *arguments, scene="squares.vs3"):
        result = self.run_hemirad("formfactors", scene, "--quiet", *arguments)
        self.assert_done(result)
        return result.stdout.splitlines()

    def test_surfaces_are_rows_and_obstructions_only_hide(self):
        hidden = self.factors(scene="squares.vs3")
        self.write("free.vs3", SQUARES)
        free = self.factors(scene="free.vs3")
        self.assertEqual({("lower", "upper"), ("upper", "lower"), ("lower", "outside"),
                          ("upper", "outside")}, set(hidden))
        self.assertAlmostEqual(OPPOSITE, free["lower", "upper"], delta=0.01)
        self.assertLess(hidden["lower", "upper"], 0.9 * free["lower", "upper"])
        self.assertAlmostEqual(free["lower", "outside"], 1 - free["lower", "upper"], 8)

    def test_dense(self):
        lines = self.text("--format", "view3d")
        self.assertEqual(["View3D", "3.3.1", "0", "0", "0", "2"], lines[0].split())
        self.assertEqual("1 1", lines[1])
        self.assertEqual("0", lines[2].split()[0])
        self.assertEqual("0", lines[3].split()[1])
        self.assertAlmostEqual(float(lines[2].split()[1]), float(lines[3].split()[0]), delta=1e-4)
        self.assertEqual("0.9 0.5", lines[4])
        self.assertEqual(5, len(lines))

    def test_sparse(self):
        dense = self.text("--format", "view3d")
        sparse = self.text("--format", "view3d-sparse")
        self.assertEqual(["1 2 " + dense[2].split()[1], "2 1 " + dense[3].split()[0]], sparse[2:4])
        self.assertEqual([dense[1], dense[-1]], [sparse[1], sparse[-1]])

    def test_an_enclosure_says_so(self):
        self.assertEqual("1", self.text("--format", "view3d", scene="cube.obj")[0].split()[3])

    def test_info_reads_it_and_solve_finds_no_light(self):
        result = self.run_hemirad("info", "squares.vs3")
        self.assert_done(result)
        self.assertIn("obstruction#3: 1 face", result.stdout)
        result = self.run_hemirad("solve", "squares.vs3")
        self.assertEqual(1, result.returncode)
        self.assertEqual("squares.vs3: nothing emits light, so there is nothing to solve\n",
                         result.stderr)

    def test_a_malformed_line_is_told(self):
        self.write("bad.vs3", SQUARES + "S 3 1 2 3 4 0 0 high name\n")
        result = self.run_hemirad("formfactors", "bad.vs3")
        self.assertEqual(1, result.returncode)
        self.assertEqual('bad.vs3: line 17: "high" is no number\n', result.stderr)


class FormFactorsTalk(FormFactorsCase):
    def test_summary_goes_to_standard_error(self):
        result = self.run_hemirad("formfactors", "cube.obj")
        self.assert_done(result)
        for words in ("cube.obj: 6 patches of 6 surfaces, closed", "row sums ", "reciprocity ",
                      "30 factors"):
            self.assertIn(words, result.stderr)
        self.assertNotIn("row sums", result.stdout)

    def test_a_file_holds_what_standard_output_would(self):
        self.assert_done(self.run_hemirad("formfactors", "cube.obj", "-o", "f.csv", "--quiet"))
        result = self.run_hemirad("formfactors", "cube.obj", "--quiet")
        self.assertEqual(result.stdout, (self.folder / "f.csv").read_text())
        self.assertEqual("", result.stderr)

    def test_report(self):
        self.assert_done(self.run_hemirad("formfactors", "cube.obj", "-o", "f.csv", "--report",
                                          "r.json", "--resolution", "64", "--from", "x0"))
        report = json.loads((self.folder / "r.json").read_text())
        self.assertEqual({"patches": 6, "surfaces": 6, "closed": True}, report["scene"])
        self.assertEqual(64, report["settings"]["resolution"])
        self.assertEqual(["x0"], report["settings"]["from"])
        self.assertEqual("f.csv", report["outputs"][0]["file"])
        self.assertIsNone(report["reciprocity"])
        self.assertEqual(1, report["rows"])
        self.assertGreater(report["seconds"]["total"], report["seconds"]["factors"])

    def test_quality_is_a_target_unless_hemispheres_are_chosen_by_hand(self):
        by_hand = ("--resolution", "64")
        for arguments, target in (((), 1e-3), (("--quality", "draft"), None),
                                  (("--quality", "high"), 1e-4), (by_hand, None),
                                  (("--quality", "medium", *by_hand), 1e-3)):
            self.assert_done(self.run_hemirad("formfactors", "cube.obj", "-o", "f.csv", "--report",
                                              "r.json", "--from", "x0", *arguments))
            settings = json.loads((self.folder / "r.json").read_text())["settings"]
            self.assertEqual(target, settings.get("target_error"), arguments)

    def test_first_interrupt_leaves_nothing(self):
        process = subprocess.Popen(
            [HEMIRAD, "formfactors", "cube.obj", "-o", "f.csv", "--patch-size", "0.02",
             "--resolution", "1024", "--enforce"],
            cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        process.stderr.readline()  # the plan: the rows come next
        process.stderr.readline()
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        self.assertEqual(130, process.wait(60))
        self.assertIn("interrupted: nothing is written", process.stderr.read())
        self.assertEqual([], [p.name for p in self.folder.iterdir() if p.suffix == ".csv"
                              or p.name.startswith(".hemirad")])

    def test_progress_on_a_pipe_is_lines_without_a_bar(self):
        self.assertNotIn("\r", self.run_hemirad("formfactors", "cube.obj").stderr)


class BadFormFactors(FormFactorsCase):
    def assert_rejected(self, *arguments, begins="hemirad: ", says="", exit_code=1):
        (self.folder / "squares.vs3").unlink(missing_ok=True)
        with self.subTest(arguments=arguments):
            self.assert_refused(self.run_hemirad("formfactors", "cube.obj", *arguments), begins,
                                exit_code, says)

    def test_unknown_names_with_those_near_them(self):
        for option in ("--from", "--receivers-only", "--blockers-only"):
            self.assert_rejected(option, "flor", begins=f'cube.obj: {option} "flor": ',
                                 says='near it: "floor", ')
        self.assert_rejected("--per-patch", "--from", "#6", begins='cube.obj: --from "#6": ')

    def test_a_row_of_what_only_blocks(self):
        self.assert_rejected("--from", "x0", "--blockers-only", "x0", begins="cube.obj: --from",
                             says="only hides others")

    def test_nothing_left(self):
        blockers = [word for name in WALLS for word in ("--blockers-only", name)]
        self.assert_rejected(*blockers, begins="cube.obj: ", says="every surface only hides")

    def test_formats_that_need_all_rows(self):
        for option in ("--from", "--receivers-only"):
            self.assert_rejected("--format", "view3d", option, "x0", says="--format view3d")
        self.assert_rejected("--enforce", "--from", "x0", says="--enforce")

    def test_values_out_of_range(self):
        for option, value in (("--format", "json"), ("--target-error", "0"),
                              ("--target-error", "-1"), ("--shooter-samples", "0"),
                              ("--resolution", "8"), ("--patch-size", "0")):
            self.assert_rejected(option, value, says=option)

    def test_outputs(self):
        self.assert_rejected("-o", "no/f.csv", begins="no/f.csv: ", exit_code=3)
        self.assert_rejected("-o", "f.txt", says="a name ending in .csv")
        self.assert_rejected("--report", "r.txt", says="a name ending in .json")
        self.assert_rejected("--format", "view3d", "-o", "cube.obj", says="no scene's ending")

    def test_output_over_the_scene(self):
        (self.folder / "f.csv").symlink_to("cube.obj")
        result = self.run_hemirad("formfactors", "cube.obj", "-o", "f.csv")
        self.assertEqual(1, result.returncode)
        self.assertIn("would overwrite the scene", result.stderr)
        self.assertEqual(CUBE, (self.folder / "cube.obj").read_text())

    def test_standard_output_on_a_full_disk(self):
        with open("/dev/full", "w", encoding="ascii") as full:
            result = subprocess.run([HEMIRAD, "formfactors", "cube.obj"], cwd=self.folder,
                                    stdout=full, stderr=subprocess.PIPE, check=False)
        self.assertEqual(3, result.returncode)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
