#!/usr/bin/env python3
"""The program at the extremes: whatever it is given, it says what is wrong or writes numbers.
HEMIRAD names the binary."""
import json
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

import outputs

HEMIRAD = os.environ["HEMIRAD"]
LEAST_FLOAT, LEAST_HALF = 2.0**-126, 2.0**-14  # normal ones


def box(low, high):
    """Six quads, fronts outside."""
    def at(x, y, z):
        return ((low, high)[x][0], (low, high)[y][1], (low, high)[z][2])
    return [[at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)],
            [at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)],
            [at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)],
            [at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0)],
            [at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)],
            [at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)]]


def turned_over(faces):
    return [face[::-1] for face in faces]


ROOM = turned_over(box((0, 0, 0), (1, 1, 1)))
LAMP = [[(.4, .4, .99), (.4, .6, .99), (.6, .6, .99), (.6, .4, .99)]]
PLAIN = (("room", "white", ROOM), ("lamp", "lamp", LAMP))


def mapped(parts, change):
    return [(name, material, [[tuple(change(x) for x in corner) for corner in face]
                              for face in faces]) for name, material, faces in parts]


def obj(parts):
    lines, first = ["mtllib scene.mtl"], 1
    for name, material, faces in parts:
        lines += [f"o {name}", f"usemtl {material}"]
        for face in faces:
            lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in face]
            lines.append("f " + " ".join(str(first + i) for i in range(len(face))))
            first += len(face)
    return "\n".join(lines) + "\n"


class Extremes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.materials()

    def materials(self, emission="1 1 1", reflectance=".5 .5 .5"):
        self.write("scene.mtl", f"newmtl white\nKd {reflectance}\n"
                   f"newmtl lamp\nKd 0 0 0\nKe {emission}\n")

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="ascii")

    def solve(self, parts, *arguments, patch_size=0.25):
        for old in self.folder.iterdir():
            if old.suffix in outputs.CHECKS:
                old.unlink()
        self.write("scene.obj", obj(parts))
        return subprocess.run(
            [HEMIRAD, "solve", "scene.obj", "--resolution", "64", "--patch-size", repr(patch_size),
             "--texel-size", repr(patch_size / 2), "-o", "a.exr", "--preview", "a.png", "--faces",
             "a.csv", "--report", "a.json", "--no-progress", *arguments],
            cwd=self.folder, text=True, capture_output=True, timeout=120, check=False)

    def assert_numbers(self, result):
        """Done, all files are there, and all they hold are numbers; the ledger closes."""
        self.assertEqual(0, result.returncode, result.stderr)
        self.assertEqual(sorted(outputs.CHECKS), sorted(
            path.suffix for path in self.folder.iterdir() if path.suffix in outputs.CHECKS))
        self.assertEqual([], outputs.faults_of_folder(self.folder))
        for band, ledger in self.report()["ledger"].items():
            self.assertLess(ledger["residual"], 1e-6, band)

    def assert_refused(self, result, *says, exit_code=1):
        self.assertEqual(exit_code, result.returncode, result.stderr)
        last = result.stderr.splitlines()[-1]
        for words in says:
            self.assertIn(words, last)
        self.assertLess(len(last), 250)
        self.assertEqual([], [path.name for path in self.folder.iterdir()
                              if path.suffix in outputs.CHECKS])

    def report(self):
        return json.loads((self.folder / "a.json").read_text())

    def picture(self):
        return outputs.read_exr(self.folder / "a.exr")[0]

    def faces(self, name="irradiance.R"):
        return [float(row[name]) for row in outputs.read_faces(self.folder / "a.csv") if row[name]]


class Checker(Extremes):
    """What all the others rely on."""

    def test_sees_a_value_that_is_no_number_wherever_it_stands(self):
        self.assert_numbers(self.solve(PLAIN))
        for change in (lambda: self.spoil("a.csv", "0.5,", "nan,"),
                       lambda: self.spoil("a.json", '"residual": ', '"residual": -'),
                       lambda: self.spoil("a.json", '"min": 1.0', '"min": null')):
            self.solve(PLAIN)
            change()
            self.assertEqual(1, len(outputs.faults_of_folder(self.folder)))

    def spoil(self, name, old, new):
        text = (self.folder / name).read_text()
        self.assertIn(old, text)
        self.write(name, text.replace(old, new, 1))

    def test_sees_an_infinity_in_the_pixels(self):
        for code, infinity in (("f", math.inf), ("f", math.nan), ("e", math.inf), ("f", -1.0)):
            self.write_exr(code, infinity)
            self.assertEqual(1, len(outputs.faults_of_exr(self.folder / "spoilt.exr")), infinity)
        self.write_exr("f", 1.0)
        self.assertEqual([], outputs.faults_of_exr(self.folder / "spoilt.exr"))

    def write_exr(self, code, value):
        """One texel, uncompressed, which a block that does not shrink is."""
        def attribute(name, kind, content):
            return f"{name}\0{kind}\0".encode() + struct.pack("<i", len(content)) + content
        kind = {"f": outputs.FLOAT, "e": outputs.HALF}[code]
        header = b"\x76\x2f\x31\x01\x02\0\0\0" + attribute(
            "channels", "chlist", b"R\0" + struct.pack("<4i", kind, 0, 1, 1) + b"\0") + attribute(
                "dataWindow", "box2i", struct.pack("<4i", 0, 0, 0, 0)) + b"\0"
        texel = struct.pack("<" + code, value)
        (self.folder / "spoilt.exr").write_bytes(
            header + struct.pack("<Q2i", len(header) + 8, 0, len(texel)) + texel)

    def test_reads_what_the_faces_say(self):
        self.assert_numbers(self.solve(PLAIN, "--quantity", "radiosity", patch_size=1.0))
        texels = set(self.picture()["R"])
        for value in self.faces("radiosity.R"):
            self.assertTrue(any(math.isclose(value, texel, rel_tol=1e-7) for texel in texels))


class Sizes(Extremes):
    def test_of_powers_of_two_change_no_bit(self):
        for mode in ("count", "analytic"):
            self.assert_numbers(self.solve(PLAIN, "--form-factor", mode))
            metres = self.picture()
            for power in (-20, -1, 20):
                factor = 2.0**power
                parts = mapped(PLAIN, lambda x, factor=factor: x * factor)
                self.assert_numbers(self.solve(parts, "--form-factor", mode,
                                               patch_size=0.25 * factor))
                self.assertEqual(metres, self.picture(), (mode, power))

    def test_far_from_the_origin_change_neither_light_nor_walls(self):
        self.assert_numbers(self.solve(PLAIN))
        here = self.report()["ledger"]["R"]["emitted"]
        # Nine digits could be those of a float; a file in doubles shows more.
        for away in (1234.567891, 1e7 + 0.123456, -1e7 - 0.123456):
            parts = mapped(PLAIN, lambda x, away=away: round(x + away, 6))
            self.assert_numbers(self.solve(parts))
            ledger = self.report()["ledger"]["R"]
            self.assertEqual(0, ledger["escaped"])
            # An ulp of the corners, 2^-29 m at 1e7, of a lamp of 0.2 m.
            self.assertAlmostEqual(1, ledger["emitted"] / here, delta=4 * 2.0**-29 / 0.2)

    def test_beyond_what_squares_of_doubles_hold_are_refused(self):
        for size in (1e-160, 1e160):
            parts = mapped(PLAIN, lambda x, size=size: x * size)
            result = self.solve(parts, patch_size=0.25 * size)
            self.assertEqual(1, result.returncode, result.stderr)
            self.assertTrue(result.stderr.startswith("scene.obj: "), result.stderr)

    def test_as_far_as_they_are_accepted_are_right(self):
        self.assert_numbers(self.solve(PLAIN))
        here = self.faces()
        for size in (1e-60, 1e60):
            parts = mapped(PLAIN, lambda x, size=size: x * size)
            self.assert_numbers(self.solve(parts, patch_size=0.25 * size))
            for value, expected in zip(self.faces(), here, strict=True):
                self.assertAlmostEqual(1, value / expected, delta=1e-3)

    def test_of_signed_zeros_and_subnormal_coordinates_are_those_of_zero(self):
        self.assert_numbers(self.solve(PLAIN))
        plain = self.picture()
        for zero in (-0.0, 1e-320, -1e-310):
            self.assert_numbers(self.solve(mapped(PLAIN, lambda x, zero=zero: x or zero)))
            self.assertEqual(plain, self.picture(), zero)


class Emissions(Extremes):
    def test_scale_the_numbers_and_nothing_else(self):
        self.assert_numbers(self.solve(PLAIN))
        plain = self.faces()
        for emission in (1e-30, 1e30):
            self.materials(f"{emission} {emission} {emission}")
            self.assert_numbers(self.solve(PLAIN))
            for value, expected in zip(self.faces(), plain, strict=True):
                self.assertAlmostEqual(1, value / (emission * expected), delta=1e-8)  # 9 digits

    def test_of_bands_far_apart_are_each_its_own(self):
        self.materials("0 1e-30 1e30", ".5 .25 .75")
        self.assert_numbers(self.solve(PLAIN))
        for band, least, most in (("R", 0, 0), ("G", 1e-33, 1e-29), ("B", 1e27, 1e31)):
            for value in self.faces("irradiance." + band):
                self.assertTrue(least <= value <= most, (band, value))

    def test_that_no_ledger_can_hold_are_refused_before_the_work(self):
        for emission in ("1e308", "1e302", "1e-310", "1e-272"):
            self.materials(f"0 {emission} 0")
            result = self.solve(PLAIN)
            self.assert_refused(result, 'scene.obj: band "G" emits ', "is counted")
            self.assertEqual(1, result.stderr.count("\n"), result.stderr)
            info = subprocess.run([HEMIRAD, "info", "scene.obj"], cwd=self.folder, text=True,
                                  capture_output=True, timeout=120, check=False)
            self.assert_refused(info, 'scene.obj: band "G" emits ', "is counted")

    def test_beyond_floats_leave_the_table(self):
        self.materials("1e41 1 1")
        result = self.solve(PLAIN)
        self.assertEqual(3, result.returncode, result.stderr)
        self.assertIn("a.exr: values are beyond the range of float", result.stderr)
        self.assertFalse((self.folder / "a.exr").exists())
        self.assertGreater(max(self.faces()), 1e39)

    def test_beyond_half_are_floats(self):
        self.materials("1e9 1 1")
        self.assert_numbers(self.solve(PLAIN, "--half"))
        self.assertGreater(max(self.picture()["R"]), 65504)

    def test_below_the_pixels_are_told(self):
        for emission, pixels, least in (("1e-40", (), LEAST_FLOAT),
                                        ("1e-5", ("--half",), LEAST_HALF)):
            self.materials(f"{emission} 1 1")
            result = self.solve(PLAIN, *pixels)
            self.assert_numbers(result)
            told = [line for line in result.stderr.splitlines() if line.startswith("warning: ")]
            self.assertEqual(1, len(told), result.stderr)
            self.assertIn('a.exr: band "R" holds ', told[0])
            self.assertEqual([told[0][len("warning: "):]], self.report()["warnings"])
            self.assertLess(max(self.picture()["R"]), least)

    def test_within_the_pixels_are_told_of_nothing(self):
        for emission, pixels in (("1e-34", ()), ("1e34", ()), ("0.1", ("--half",)),
                                 ("1e3", ("--half",))):
            self.materials(f"{emission} {emission} {emission}")
            result = self.solve(PLAIN, *pixels)
            self.assert_numbers(result)
            self.assertNotIn("warning", result.stderr)


class Lamps(Extremes):
    FLOOR = ("floor", "white", [[(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]])

    def test_that_face_away_light_nothing(self):
        away = ("lamp", "lamp", [[(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]])
        self.assert_numbers(self.solve([self.FLOOR, away], "--estimate-error"))
        self.assertEqual([0, 0], self.faces())
        self.assertEqual(0, self.report()["error"]["relative_rms"])

    def test_within_a_closed_box_light_nothing_where_backs_block(self):
        lamp = ("lamp", "lamp", [[(.4, .4, .5), (.4, .6, .5), (.6, .6, .5), (.6, .4, .5)]])
        crate = ("crate", "white", box((.3, .3, .3), (.7, .7, .7)))
        self.assert_numbers(self.solve([("room", "white", ROOM), crate, lamp],
                                       "--backfaces", "block"))
        self.assertEqual([0] * 13, self.faces())

    def test_that_are_missing_are_missed(self):
        self.assert_refused(self.solve([self.FLOOR]), "scene.obj: nothing emits light")

    def test_of_nearly_white_rooms_keep_the_books(self):
        for most in ("0.999", "0.999999"):
            self.materials(reflectance="1 1 1")
            result = self.solve(PLAIN, "--max-reflectance", most, "--max-shots", "2000")
            self.assert_numbers(result)
            self.assertIn(f"reflectance limited to {most}", result.stderr)


class Faces(Extremes):
    """That no modeller should have let pass."""

    def assert_told(self, result, *warnings):
        self.assert_numbers(result)
        for warning in warnings:
            self.assertIn("warning: scene.obj: " + warning + "\n", result.stderr)

    def test_that_are_twisted_become_triangles(self):
        wall = [(1, 0, 0), (1, 1, .1), (1, 1, 1), (.9, 0, 1)]
        self.assert_told(self.solve([("room", "white", ROOM[:-1] + [wall]), PLAIN[1]]),
                         'face 5 of "room" at (1, 0, 0) is not planar: split into triangles')

    def test_that_cross_themselves_are_dropped(self):
        bow = [(.2, .2, .5), (.8, .8, .5), (.8, .2, .5), (.2, .8, .5)]
        self.assert_told(self.solve([*PLAIN, ("bow", "white", [bow])]),
                         'face 7 of "bow" at (0.2, 0.2, 0.5) crosses itself: dropped')

    def test_without_area_are_dropped(self):
        thin = [[(.2, .2, .5), (.5, .5, .5), (.8, .8, .5)], [(.3, .3, .3)] * 4]
        dropped = "has no area, or is no wider than twice the weld: dropped"
        self.assert_told(self.solve([*PLAIN, ("thin", "white", thin)]),
                         'face 7 of "thin" at (0.2, 0.2, 0.5) ' + dropped,
                         'face 8 of "thin" at (0.3, 0.3, 0.3) ' + dropped)

    def test_of_a_room_given_twice_are_dropped(self):
        self.assert_numbers(self.solve(PLAIN))
        once = self.picture()
        again = self.solve([PLAIN[0], PLAIN[1], ("again", "white", ROOM)])
        self.assert_told(again, 'face 7 of "again" at (1, 0, 0) repeats another face: dropped')
        self.assertEqual(once, self.picture())

    def test_of_a_room_inside_out_receive_nothing(self):
        self.assert_told(self.solve([("room", "white", turned_over(ROOM)), PLAIN[1]]),
                         '"room" encloses everything else, which sees the backs of its faces, such '
                         'as at (0, 0, 0): a room\'s faces have to be turned over')
        self.assertEqual([0] * 7, self.faces())

    def test_that_run_through_each_other_lose_no_light(self):
        boxes = (box((.2, .2, .1), (.6, .6, .5)), box((.4, .4, .2), (.8, .8, .7)))
        self.assert_told(self.solve([*PLAIN, ("a", "white", boxes[0]), ("b", "white", boxes[1])]))
        for ledger in self.report()["ledger"].values():
            self.assertEqual(0, ledger["escaped"])


class Options(Extremes):
    def test_that_are_no_numbers_or_out_of_range_are_refused(self):
        for option in ("--tolerance", "--target-error", "--sampling-error", "--texel-size",
                       "--patch-size", "--max-reflectance", "--time-limit"):
            for value in ("nan", "-nan", "0", "-0.0", "-1e-320", "1e400", "1e-400", "0x1p3", "1,5"):
                result = self.solve(PLAIN, f"{option}={value}")
                self.assert_refused(result, "hemirad: " + option)

    def test_at_the_ends_of_their_range_end(self):
        for arguments in (("--tolerance", "1e-30"), ("--tolerance", "0.999999999999"),
                          ("--sampling-error", "1e-300", "--max-shots", "5"),
                          ("--sampling-error", "1e300"), ("--time-limit", "1e-300"),
                          ("--time-limit", "1e300"), ("--snapshot-every", "1e-300s"),
                          ("--max-shots", "18446744073709551615"), ("--max-reflectance", "1e-300")):
            with self.subTest(arguments=arguments):
                self.assert_numbers(self.solve(PLAIN, *arguments, patch_size=0.5))


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
