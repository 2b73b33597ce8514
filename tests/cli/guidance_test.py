#!/usr/bin/env python3
"""What the program says to those who expect something else of it. HEMIRAD names the binary."""
import json
import os
import sys
import unittest

import scenes

QUICK = ("--resolution", "32", "--patch-size", "0.5")


class Guidance(scenes.InFolder):
    def solve(self, *arguments, scene="scene.obj"):
        return self.run_hemirad("solve", scene, *QUICK, *arguments)

    def assert_done(self, result):
        self.assertEqual(0, result.returncode, result.stderr)

    def refusal(self, *arguments):
        """The one line that a refusal is."""
        result = self.run_hemirad(*arguments)
        self.assertEqual(1, result.returncode, result.stderr)
        self.assertEqual(1, result.stderr.count("\n"), result.stderr)
        return result.stderr[:-1]


def with_lights(names, material=None):
    """A sheet, and a node for each light: Blender names nodes, lights themselves are nameless."""
    def light(index):
        return {"extensions": {"KHR_lights_punctual": {"light": index}}}
    return scenes.gltf(
        material=material,
        nodes=[{"mesh": 0, "name": "sheet"}] + [
            light(i) | ({"name": name} if name else {}) for i, name in enumerate(names)],
        scenes=[{"nodes": list(range(1 + len(names)))}],
        extensionsUsed=["KHR_lights_punctual"],
        extensions={"KHR_lights_punctual": {
            "lights": [{"type": "point", "name": f"own {i}"} for i in range(len(names))]}})


class Lights(Guidance):
    WARNING = "warning: lit.gltf: KHR_lights_punctual: "

    def test_lights_without_faces_are_told_by_name(self):
        self.write("lit.gltf", with_lights(["Point", "S\x1bun"]))
        result = self.solve("--report", "r.json", scene="lit.gltf")
        self.assert_done(result)
        says = (self.WARNING + '2 lights ("Point", "S\\x1bun") are not taken: '
                "light comes from emissive faces")
        self.assertIn(says, result.stderr.splitlines())
        warnings = json.loads((self.folder / "r.json").read_text())["warnings"]
        self.assertEqual([says.removeprefix("warning: ")], warnings)

    def test_many_are_counted(self):
        self.write("lit.gltf", with_lights(["", "b", "c", "d", "e"]))
        self.assertIn('5 lights ("own 0", "b", "c" and 2 more) are not taken',
                      self.run_hemirad("info", "lit.gltf").stdout)

    def test_where_nothing_else_emits_the_refusal_says_so(self):
        self.write("lit.gltf", with_lights(["Sun"], scenes.lamp() | {"emissiveFactor": [0, 0, 0]}))
        result = self.solve(scene="lit.gltf")
        self.assertEqual(1, result.returncode)
        self.assertEqual(
            [self.WARNING + 'a light ("Sun") is not taken: light comes from emissive faces',
             "lit.gltf: nothing emits light, so there is nothing to solve: lights of "
             "KHR_lights_punctual are not taken, emissive faces are"],
            result.stderr.splitlines())

    def test_extensions_in_another_shape_are_no_lights(self):
        for extension in (3, {}, {"light": "a"}, {"light": -1}, []):
            self.write("lit.gltf", scenes.gltf(
                nodes=[{"mesh": 0, "extensions": {"KHR_lights_punctual": extension}}]))
            self.assertNotIn("not taken", self.run_hemirad("info", "lit.gltf").stdout)


class Unshot(Guidance):
    def test_a_picture_that_lacks_much_of_the_light_says_so(self):
        result = self.solve("--max-shots", "1", "--salvo", "1", "-o", "dark.exr", "--report",
                            "r.json")
        self.assert_done(result)
        says = r"dark\.exr: \d\d\.?\d? % of the light is still to be shot, the picture is darker"
        self.assertRegex(result.stderr, "(?m)^warning: " + says)
        self.assertRegex(json.loads((self.folder / "r.json").read_text())["warnings"][0], says)

    def test_one_that_has_nearly_all_does_not(self):
        result = self.solve("--tolerance", "0.09", "--quiet")
        self.assert_done(result)
        self.assertEqual("", result.stderr)


class Words(Guidance):
    def test_a_misspelt_option_or_command_is_answered_with_the_nearest(self):
        for arguments, says in {
                ("solve", "scene.obj", "--qualty", "high"):
                    '"--qualty" (did you mean --quality?); see hemirad solve --help',
                ("solve", "scene.obj", "--pad=3"): '"--pad=3" (did you mean --padding?)',
                ("solv", "scene.obj"): 'unknown command "solv" (did you mean solve?); see',
                ("solve", "scene.obj", "--zzz"): 'unknown option "--zzz"; see hemirad solve --help',
        }.items():
            with self.subTest(arguments=arguments):
                self.assertIn(says, self.refusal(*arguments))

    def test_values_are_refused_with_what_is_taken_instead(self):
        for arguments, says in {
                ("-o", "out.png"): "a name ending in .exr, .glb or .gltf",
                ("-o", "out.png", "--gltf", "a.glb"): "expected a name ending in .exr",
                ("--snapshot-every", "x"): "a number of shots, such as 100, or of seconds, such as "
                                           "10s",
        }.items():
            with self.subTest(arguments=arguments):
                self.assertTrue(self.refusal("solve", "scene.obj", *QUICK, *arguments).endswith(says))

    @unittest.skipIf("ASAN_OPTIONS" in os.environ, "a sanitizer takes more than all else")
    def test_memory_that_no_option_lowers_is_told(self):
        self.assertTrue(self.refusal("solve", "scene.obj", *QUICK, "--memory-limit", "50M").endswith(
            "no option gets below the 243 MiB of the program and its compiler"))

    def test_a_folder_is_called_one(self):
        (self.folder / "out").mkdir()
        result = self.solve("-o", "out")
        self.assertEqual((3, "out: is a folder\n"), (result.returncode, result.stderr))

    def test_what_is_no_gltf_at_all_is_told_so(self):
        self.write("a.glb", "\x7fELF")
        self.assertEqual("a.glb: glTF: starts neither as GLB nor as JSON",
                         self.refusal("info", "a.glb"))

    def test_elements_above_patches_are_warned_of(self):
        self.assertIn("warning: --element-size 1 is above --patch-size 0.5: a patch is its own "
                      "element", self.solve("--element-size", "1").stderr)
        self.assertNotIn("warning", self.solve("--element-size", "0.5").stderr)

    def test_extents_tell_millimetres_from_metres(self):
        self.write("big.obj", scenes.obj(vertices="".join(
            f"v {4000 * x} {2700 * y} {5000 * z}\n" for y in (0, 1)
            for x, z in ((0, 0), (1, 0), (1, 1), (0, 1)))))
        self.assertIn("\nextent       4000 x 2700 x 5000 m\n",
                      self.run_hemirad("info", "big.obj").stdout)
        self.assertIn(", open, 1 x 1 x 1 m\n", self.solve().stderr)

    def test_info_has_readable_numbers_and_names_what_solve_would_refuse(self):
        told = self.run_hemirad("info", "scene.obj", "--memory-limit", "1G").stdout
        self.assertIn("R: emits 3.141593 W", told)
        self.assertIn("; limit 1.0 GiB\n", told)
        self.write("scene.mtl", scenes.MATERIALS.replace("Ke 1 1 1", ""))
        self.assertIn("\nlights       0: nothing emits light, solve will refuse\n",
                      self.run_hemirad("info", "scene.obj").stdout)

    def test_help_lists_options_under_headings(self):
        for command, headings in (("solve", ("Output", "Accuracy", "Mesh", "Lightmap", "Machine")),
                                  ("info", ("Accuracy", "Mesh", "Lightmap", "Machine"))):
            told = self.run_hemirad(command, "--help").stdout
            for heading in headings:
                self.assertEqual(1, told.count(f"\n{heading}:\n"), heading)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
