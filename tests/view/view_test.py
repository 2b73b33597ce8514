#!/usr/bin/env python3
"""Pages and pictures of solved scenes, by the program that HEMIRAD names."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))
import scenes  # noqa: E402
from exr import Exr  # noqa: E402
from png import read_png  # noqa: E402

HEMIRAD = os.environ["HEMIRAD"]
CORNELL = HERE.parents[1] / "scenes" / "cornell.gltf"


class Solved(scenes.InFolder):
    """A folder with a solved Cornell box, made once a class."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.solved = pathlib.Path(folder.name)
        cls.prepare()

    @classmethod
    def prepare(cls):
        cls.solve(str(CORNELL), "-o", "box.glb", "--patch-size", "0.1", "--max-shots", "60",
                  "--snapshot-every", "20", "--keep-snapshots")

    @classmethod
    def solve(cls, *arguments):
        result = cls.call(cls.solved, "solve", *arguments, "--quality", "draft", "--quiet")
        assert result.returncode == 0, result.stderr

    @staticmethod
    def call(folder, *arguments):
        return subprocess.run([HEMIRAD, *arguments], cwd=folder, text=True, capture_output=True,
                              timeout=120, check=False)

    def setUp(self):
        super().setUp()
        for file in self.solved.iterdir():
            shutil.copy(file, self.folder)

    def hemirad(self, *arguments):
        return self.run_hemirad(*arguments)

    def assert_done(self, result):
        self.assertEqual(0, result.returncode, result.stderr)

    def assert_refused(self, result, says):
        self.assertEqual(1, result.returncode, result.stderr)
        self.assertEqual(1, result.stderr.count("\n"), result.stderr)
        self.assertIn(says, result.stderr)


    def page(self, *arguments, scene="box.glb"):
        self.assert_done(self.hemirad("view", scene, "-o", "page.html", *arguments))
        return (self.folder / "page.html").read_text(encoding="utf-8")

    def lit_scene(self, page):
        return json.loads(re.search(r'id="lit-scene">(.*?)</script>', page, re.S)[1])


class View(Solved):
    def test_a_page_needs_nothing_but_itself(self):
        page = self.page()

        self.assertIn("THREE.OrbitControls", page)
        self.assertIn("default-src 'none'", page)
        self.assertEqual([], re.findall(r'(?:src|href)="', page))

    def test_a_page_holds_the_scene_its_cameras_and_its_light(self):
        lit = self.lit_scene(self.page())

        self.assertEqual(["front"], [camera["name"] for camera in lit["cameras"]])
        self.assertEqual(["all"], [layer["name"] for layer in lit["layers"]])
        self.assertEqual(4, len(lit["materials"]))
        self.assertGreater(lit["exposure"], 0)

    def test_snapshots_are_played_in_the_order_of_their_shots(self):
        self.assertEqual([20, 40, 60],
                         [snapshot["shots"] for snapshot in self.lit_scene(self.page())["snapshots"]])

    def test_snapshots_of_another_solve_are_left_out(self):
        self.assert_done(self.hemirad("solve", str(CORNELL), "-o", "other.glb", "--patch-size",
                                      "0.1", "--max-shots", "3", "--quality", "draft", "--quiet"))
        shutil.copy(self.folder / "other.exr", self.folder / "box-30.exr")
        (self.folder / "box-31.exr").write_bytes(b"no picture")

        self.assertEqual([20, 40, 60],
                         [snapshot["shots"] for snapshot in self.lit_scene(self.page())["snapshots"]])

    def test_names_do_not_become_markup(self):
        name = "<script>alert(1)<!--.glb"
        shutil.copy(self.folder / "box.glb", self.folder / name)

        page = self.page(scene=name)

        self.assertNotIn("<script>alert", page)
        self.assertEqual(name, self.lit_scene(page)["name"])

    def test_what_is_not_solved_is_refused(self):
        shutil.copy(CORNELL, self.folder)
        self.assert_refused(self.hemirad("view", "cornell.gltf"), "is not solved")

    def test_a_missing_lightmap_is_named(self):
        (self.folder / "box.exr").unlink()
        self.assert_refused(self.hemirad("view", "box.glb"), "box.exr: no such file")

    def test_a_lightmap_out_of_the_folder_is_taken_only_where_the_user_says_so(self):
        glb = (self.folder / "box.glb").read_bytes()
        (self.folder / "box.glb").write_bytes(glb.replace(b'"box.exr"', b'"../x.ex"'))
        self.assert_refused(self.hemirad("view", "box.glb"), "is not in its folder")
        self.page("--lightmap", "box.exr")

    def test_no_link_leads_to_a_lightmap_above_where_it_leads(self):
        (self.folder / "out/deep").mkdir(parents=True)
        (self.folder / "scene").mkdir()
        (self.folder / "scene/l").symlink_to("../out/deep")
        shutil.copy(self.folder / "box.exr", self.folder / "out/ab")
        glb = (self.folder / "box.glb").read_bytes()
        (self.folder / "scene/box.glb").write_bytes(glb.replace(b'"box.exr"', b'"l/../ab"'))
        self.assert_refused(self.hemirad("view", "scene/box.glb"), "ab: no such file")

    def test_lightmaps_that_are_none_are_refused(self):
        exr = (self.folder / "box.exr").read_bytes()
        for bad in (b"", b"no picture", exr[:200], exr[:-500]):
            (self.folder / "box.exr").write_bytes(bad)
            self.assert_refused(self.hemirad("view", "box.glb"), "box.exr: ")

    def test_the_solved_scene_is_not_overwritten(self):
        self.assert_refused(self.hemirad("view", "box.glb", "-o", "box.glb"), ".html")


class Render(Solved):
    def picture(self, *arguments):
        self.assert_done(self.hemirad("render", "box.glb", "-o", "a.png", *arguments))
        return read_png((self.folder / "a.png").read_bytes())

    def test_the_box_is_seen_by_its_camera(self):
        rows = self.picture("--camera", "front", "--size", "90x90")

        red, green, blue = rows[45][3]
        self.assertGreater(red, 2 * green)  # the left wall
        red, green, blue = rows[45][86]
        self.assertGreater(green, 1.2 * red)  # the right one
        self.assertGreater(min(rows[12][45]), 200)  # the lamp in the ceiling

    def test_the_only_camera_needs_no_name_and_gives_the_picture_its_shape(self):
        rows = self.picture()

        self.assertEqual((600, 600), (len(rows), len(rows[0])))

    def test_a_camera_of_ones_own_sees_the_same(self):
        asked = self.picture("--eye", "0.278,0.273,-0.8", "--look-at", "0.278,0.273,0", "--fov",
                             "39.3078", "--size", "60x60", "--exposure", "2")
        named = self.picture("--size", "60x60", "--exposure", "2")

        far = max(abs(a - b) for x, y in zip(asked, named) for p, q in zip(x, y)
                  for a, b in zip(p, q))
        self.assertLessEqual(far, 2)

    def test_the_exposure_that_was_chosen_is_told(self):
        told = self.hemirad("render", "box.glb", "-o", "a.png", "--size", "50x50")
        exposure = re.search(r"--exposure (\S+)", told.stderr)[1]
        chosen = (self.folder / "a.png").read_bytes()

        self.picture("--size", "50x50", "--exposure", exposure)
        self.assertEqual(chosen, (self.folder / "a.png").read_bytes())

    def test_more_exposure_is_brighter(self):
        dark, bright = (self.picture("--size", "9x9", "--exposure", x)[4][4] for x in ("0.1", "5"))
        self.assertLess(max(dark), min(bright))

    def test_false_colours_come_with_a_scale(self):
        for arguments in (("--false-colour",), ("--false-colour", "40")):
            rows = self.picture("--size", "200x100", *arguments)
            self.assertGreater(len(rows), 100)
            self.assertIn((255, 255, 255), [p for row in rows[120:] for p in row])

    def test_radiance_goes_into_an_exr(self):
        self.assert_done(self.hemirad("render", "box.glb", "-o", "a.exr", "--size", "20x20"))
        data = (self.folder / "a.exr").read_bytes()
        self.assertIn(b"W/(m^2 sr)", data)
        self.assert_refused(self.hemirad("render", "box.glb", "-o", "a.exr", "--false-colour"),
                            "an .exr holds radiance")

    def test_the_size_that_is_told_is_the_picture_s(self):
        told = self.hemirad("render", "box.glb", "-o", "a.png", "--size", "64x48", "--false-colour")
        rows = read_png((self.folder / "a.png").read_bytes())
        self.assertIn(f": 64 x {len(rows)} from front, its scale included\n", told.stderr)
        self.assertGreater(len(rows), 48)

    def test_a_lightmap_of_another_size_is_refused(self):
        self.assert_done(self.hemirad("solve", "scene.obj", "-o", "other.exr", "--patch-size", "0.5",
                                      "--resolution", "32", "--quiet"))
        self.assert_refused(self.hemirad("render", "box.glb", "--lightmap", "other.exr"),
                            "other.exr: has ")

    def test_a_view_of_nothing_is_warned_of(self):
        result = self.hemirad("render", "box.glb", "-o", "a.png", "--quiet", "--size", "9x9",
                              "--eye", "9,9,9", "--look-at", "20,20,9")
        self.assert_done(result)
        self.assertEqual("warning: a.png: the camera sees nothing of the scene\n", result.stderr)

    def test_doubtful_views_are_refused_in_one_line(self):
        for arguments, says in {
                ("--camera", "back"): "it has the cameras front",
                ("--eye", "0,0"): "three numbers",
                ("--eye", "0,0,x"): "three numbers",
                ("--eye", "0,5,0", "--look-at", "0,0,0"): "looks along --up",
                ("--eye", "0,0,0", "--fov", "180"): "below 180",
                ("--eye", "0,0,0", "--camera", "front"): "excludes",
                ("--look-at", "0,0,0"): "--eye",
                ("--layer", "lamp"): "it has none",
                ("--size", "0x9"): "WIDTHxHEIGHT",
                ("--exposure", "-1"): "above 0",
                ("--false-colour", "-1"): "above 0",
        }.items():
            with self.subTest(arguments=arguments):
                self.assert_refused(self.hemirad("render", "box.glb", "-o", "a.png", *arguments),
                                    says)
                self.assertFalse((self.folder / "a.png").exists())

    def test_a_scene_without_cameras_says_what_to_do(self):
        self.assert_done(self.hemirad("solve", "scene.obj", "-o", "s.glb", "--quality", "draft",
                                      "--quiet"))
        self.assert_refused(self.hemirad("render", "s.glb"), "has no cameras; --eye X,Y,Z needs none")
        self.assert_refused(self.hemirad("render", "s.glb", "--camera", "foo"),
                            "s.glb: has no cameras; --eye X,Y,Z needs none")


class Room(Solved):
    """Solved with a chart an atlas, box.glb, and with all in one, one.glb."""
    @classmethod
    def prepare(cls):
        (cls.solved / "scene.mtl").write_text(scenes.MATERIALS, encoding="utf-8")
        (cls.solved / "scene.obj").write_bytes(scenes.obj(faces=scenes.ROOM))
        alike = ("--patch-size", "0.25", "--texel-size", "0.1", "--padding", "3", "--layers",
                 "emission", "--max-shots", "40")
        cls.solve("scene.obj", "-o", "box.glb", *alike, "--atlas-size", "16", "--snapshot-every",
                  "20", "--keep-snapshots")
        cls.solve("scene.obj", "-o", "one.glb", *alike)


class SeveralAtlases(Room):
    SEEN = ("--size", "40x40", "--eye", "0.9,0.6,0.5", "--look-at", "0,0.4,0.5", "--fov", "90")

    def rendered(self, scene):
        self.assert_done(self.hemirad("render", scene, "-o", "a.exr", *self.SEEN))
        return Exr(self.folder / "a.exr").channels()

    def test_a_picture_is_that_of_one_atlas(self):
        self.assertTrue((self.folder / "box.2.exr").is_file())
        self.assertFalse((self.folder / "one.1.exr").is_file())

        several, one = self.rendered("box.glb"), self.rendered("one.glb")
        for name, values in one.items():
            for a, b in zip(several[name], values):
                self.assertAlmostEqual(a, b, delta=1e-4)
        self.assertGreater(max(one["R"]), 0.5)

    def test_false_colours_also_of_a_layer_are_those_of_one_atlas(self):
        for choice in ((), ("--layer", "emission")):
            pictures = []
            for scene in ("box.glb", "one.glb"):
                self.assert_done(self.hemirad("render", scene, "-o", "a.png", *self.SEEN,
                                              "--false-colour", *choice))
                pictures.append(read_png((self.folder / "a.png").read_bytes()))
            self.assertGreater(len({pixel for row in pictures[1][:40] for pixel in row}), 2)
            far = max(abs(a - b) for x, y in zip(*pictures) for p, q in zip(x, y)
                      for a, b in zip(p, q))
            self.assertLessEqual(far, 1)

    def test_a_view_without_light_is_warned_of(self):
        down = ("--eye", "0.5,0.5,0.5", "--look-at", "0.5,0,0.5", "--up", "1,0,0", "--size", "9x9")
        for layer, says in ((("--layer", "emission"),
                             "warning: a.png: nothing that the camera sees is lit\n"), ((), "")):
            result = self.hemirad("render", "one.glb", "-o", "a.png", "--quiet", *down, *layer)
            self.assert_done(result)
            self.assertEqual(says, result.stderr)

    def test_a_page_holds_all_of_them_in_every_layer_and_snapshot(self):
        lit = self.lit_scene(self.page())

        self.assertEqual([{"width": 16, "height": 16}] * 3, lit["atlases"])
        self.assertEqual([0, 1, 2], [material["atlas"] for material in lit["materials"]])
        self.assertEqual(["all", "emission"], [layer["name"] for layer in lit["layers"]])
        self.assertEqual([20, 40], [snapshot["shots"] for snapshot in lit["snapshots"]])
        for picture in lit["layers"] + lit["snapshots"]:
            self.assertEqual(3, len(picture["texels"]))
        self.assertEqual(3, len(set(lit["layers"][0]["texels"])))
        one = self.lit_scene(self.page(scene="one.glb"))
        for name in ("exposure", "largest"):
            self.assertAlmostEqual(one[name], lit[name])

    def test_a_snapshot_that_lacks_an_atlas_is_left_out(self):
        (self.folder / "box.1-20.exr").unlink()

        lit = self.lit_scene(self.page())

        self.assertEqual([40], [snapshot["shots"] for snapshot in lit["snapshots"]])

    def test_an_atlas_that_is_missing_or_of_another_solve_is_named(self):
        (self.folder / "box.1.exr").unlink()
        self.assert_refused(self.hemirad("view", "box.glb"), "box.1.exr: no such file")
        shutil.copy(self.folder / "one.exr", self.folder / "box.1.exr")
        self.assert_refused(self.hemirad("view", "box.glb"),
                            "box.1.exr: is not of the solve that box.exr is of")

    def test_a_material_of_no_atlas_is_refused(self):
        glb = (self.folder / "box.glb").read_bytes()
        (self.folder / "box.glb").write_bytes(glb.replace(b'"index":2', b'"index":3'))
        self.assert_refused(self.hemirad("view", "box.glb"),
                            "materials/2: its MOZ_lightmap is none of the atlases")
        (self.folder / "box.glb").write_bytes(glb.replace(b'"atlases":3', b'"atlases":4'))
        self.assert_refused(self.hemirad("view", "box.glb"), "no number of its textures")


if __name__ == "__main__":
    unittest.main()
