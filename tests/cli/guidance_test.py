#!/usr/bin/env python3
"""What the program says to those who expect something else of it. HEMIRAD names the binary."""
import json
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
        self.write("lit.gltf", with_lights(["Sun"], {"name": "white"}))
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


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
