#!/usr/bin/env python3
"""The program as its users meet it: exit codes, messages, files. HEMIRAD names the binary."""
import base64
import hashlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest

import scenes

HEMIRAD = os.environ["HEMIRAD"]
QUICK = ("--resolution", "64", "--patch-size", "0.25")
LONG = ("--resolution", "1024", "--patch-size", "0.02", "--tolerance", "1e-9")


class CommandLine(scenes.InFolder):
    def solve(self, *arguments, scene="scene.obj", **options):
        return self.run_hemirad("solve", scene, *QUICK, *arguments, **options)

    def solve_until(self, appears, *arguments):
        """A solve that takes far longer than the test, and has begun to leave a file."""
        process = subprocess.Popen([HEMIRAD, "solve", "scene.obj", *arguments], cwd=self.folder,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 60
        while not (self.folder / appears).exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        return process

    def assert_done(self, result):
        self.assertEqual(0, result.returncode, result.stderr)

    def assert_refused(self, result, begins, exit_code=1, says=""):
        """One line that tells whose fault it is, nothing written, nothing half written."""
        self.assertEqual(exit_code, result.returncode, result.stderr)
        self.assertEqual("", result.stdout)
        self.assertEqual(1, result.stderr.count("\n"), result.stderr)
        self.assertTrue(result.stderr.startswith(begins), result.stderr)
        self.assertIn(says, result.stderr)
        self.assertTrue(result.stderr[:-1].isprintable(), ascii(result.stderr))
        inputs = (".obj", ".mtl", ".gltf", ".glb", ".bin", ".txt")
        left = [p.name for p in self.folder.iterdir() if p.is_file() and p.suffix not in inputs]
        self.assertEqual([], left)


class BadScenes(CommandLine):
    def assert_scene_refused(self, name, content, says=""):
        if content is not None:
            self.write(name, content)
        for command in (("solve", name, *QUICK), ("info", name)):
            if command[0] == "info" and says == "emits":
                continue  # a scene without light is still a scene
            with self.subTest(command=command[0]):
                self.assert_refused(self.run_hemirad(*command), name + ": ", says=says)

    def test_missing_file(self):
        self.assert_scene_refused("nowhere.gltf", None)

    def test_folder(self):
        (self.folder / "folder.obj").mkdir()
        self.assert_scene_refused("folder.obj", None)

    def test_device_without_end(self):
        (self.folder / "zero.obj").symlink_to("/dev/zero")
        self.assert_scene_refused("zero.obj", None, says="not a regular file")

    def test_empty_file(self):
        for name in ("empty.obj", "empty.gltf", "empty.glb"):
            self.assert_scene_refused(name, b"")

    def test_unknown_format(self):
        self.assert_scene_refused("scene.txt", "v 0 0 0\n")

    def test_not_gltf(self):
        for content in (b"hello", b"{}", b"[]", b"null", b'{"asset": 3}', b"\xff\xfe\x00{"):
            self.assert_scene_refused("bad.gltf", content)

    def test_glb_truncated_anywhere(self):
        whole = scenes.glb()
        for length in (1, 4, 11, 12, 19, 20, 40, len(whole) - 1):
            self.assert_scene_refused("bad.glb", whole[:length])

    def test_glb_that_promises_too_much(self):
        whole = scenes.glb()
        self.assert_scene_refused("bad.glb", whole[:12] + b"\xff\xff\xff\x7f" + whole[16:])

    def test_index_out_of_range(self):
        self.assert_scene_refused("bad.gltf", scenes.gltf(indices=(0, 1, 9)))
        self.assert_scene_refused("bad.obj", scenes.obj(faces="f 1 2 99\n"))
        self.assert_scene_refused("bad.obj", scenes.obj(faces="f 1 2 -99\n"))

    def test_member_out_of_range(self):
        for member in ({"nodes": [{"mesh": 7}]}, {"scenes": [{"nodes": [7]}]}, {"scene": 7},
                       {"buffers": []}, {"bufferViews": []}, {"accessors": []}):
            self.assert_scene_refused("bad.gltf", scenes.gltf(**member))

    def test_node_that_is_its_own_child(self):
        self.assert_scene_refused("bad.gltf", scenes.gltf(nodes=[{"mesh": 0, "children": [0]}]))

    def test_coordinates_that_are_no_numbers(self):
        for x in (float("nan"), float("inf"), float("-inf")):
            self.assert_scene_refused(
                "bad.gltf", scenes.gltf(positions=((x, 0, 0), (1, 0, 0), (0, 1, 0))))
        for x in ("nan", "inf", "1e999", "one"):
            self.assert_scene_refused(
                "bad.obj", scenes.obj(vertices=f"v {x} 0 0\nv 1 0 0\nv 1 1 0\n", faces="f 1 2 3\n"))

    def test_reflectance_out_of_range(self):
        for reflectance in (-0.1, 1.2):
            self.assert_scene_refused(
                "bad.gltf", scenes.gltf(material=scenes.lamp(reflectance)), "lamp")
            self.write("scene.mtl", f"newmtl white\nKd {reflectance} 0 0\nnewmtl lamp\nKe 1 1 1\n")
            self.assert_scene_refused("bad.obj", scenes.obj(), "white")

    def test_negative_emission(self):
        self.write("scene.mtl", "newmtl white\nKd 0 0 0\nnewmtl lamp\nKe -1 1 1\n")
        self.assert_scene_refused("bad.obj", scenes.obj(), "lamp")

    def test_no_emitter(self):
        self.write("scene.mtl", "newmtl white\nKd .5 .5 .5\nnewmtl lamp\nKd .5 .5 .5\n")
        self.assert_scene_refused("dark.obj", scenes.obj(), "emits")

    def test_no_geometry(self):
        self.assert_scene_refused("bare.obj", scenes.obj(faces=""))
        self.assert_scene_refused("bare.gltf", scenes.gltf(meshes=None, nodes=[{"name": "a"}]))
        self.assert_scene_refused("bare.gltf", scenes.gltf(scenes=None, nodes=None, meshes=None,
                                                           scene=None))

    def test_only_faces_without_area(self):
        self.assert_scene_refused("thin.obj", scenes.obj(faces="usemtl lamp\nf 1 2 2\nf 1 1 1\n"))

    def test_name_that_would_steer_a_terminal(self):
        name = "red\x1b[31m\n.obj"
        self.assert_refused(self.run_hemirad("solve", name), "red\\x1b[31m")


class DoubtfulScenes(CommandLine):
    def test_degenerate_and_duplicate_faces_are_skipped_with_a_warning(self):
        extra = "usemtl white\nf 1 4 3 2\nf 1 2 2\n"
        self.write("scene.obj", scenes.obj(faces=scenes.FACES + extra))

        result = self.solve()

        self.assert_done(result)
        self.assertIn("warning: scene.obj: ", result.stderr)
        self.assertIn("(1 degenerate and 1 duplicate ones dropped)",
                      self.run_hemirad("info", "scene.obj").stdout)

    def test_reflectance_of_one_is_limited_with_one_warning_that_names_the_material(self):
        self.write("scene.mtl", "newmtl white\nKd 1 1 1\nnewmtl lamp\nKe 1 1 1\n")

        result = self.solve("--quiet")

        self.assert_done(result)
        self.assertEqual(1, result.stderr.count("\n"), result.stderr)
        self.assertIn("white", result.stderr)

    def test_light_without_receiver_ends(self):
        self.write("scene.obj", scenes.obj(faces="usemtl lamp\nf 5 6 7 8\n"))

        result = self.solve()

        self.assert_done(result)
        self.assertIn("converged", result.stderr)


class BadOptions(CommandLine):
    def assert_rejected(self, *arguments, says):
        with self.subTest(arguments=arguments):
            self.assert_refused(self.solve(*arguments), "hemirad: ", says=says)

    def test_values_out_of_range(self):
        for option, values in {
                "--shooter-samples": ("0", "-1", "many", "65"),
                "--patch-size": ("0", "-1", "nan", "1m", ""),
                "--element-size": ("0", "inf", "x"),
                "--split": ("-1", "9", "x"),
                "--texel-size": ("0", "inf", "x"),
                "--atlas-size": ("0", "16385", "1.5"),
                "--padding": ("-1", "257", "x"),
                "--charts": ("new",),
                "--max-reflectance": ("1", "0", "-0.5", "nan"),
                "--backfaces": ("none",),
                "--tolerance": ("0", "1", "-1e-3", "nan"),
                "--max-shots": ("0", "-1", "1.5", "99999999999999999999"),
                "--time-limit": ("0", "-3", "inf"),
                "--row-memory": ("-1", "1.5", "1G"),
                "--memory-limit": ("0", "-1G", "8X", "G", "1e40T", "nan"),
                "--salvo": ("0", "16", "1.5", "all"),
                "--quantity": ("light",),
                "--compute-units": ("0", "100000"),
                "--pe": ("4", "4x", "x4", "0x4", "4x4x4", "-4x4", "9999x9999"),
                "--lanes": ("0", "2", "32"),
                "--tile": ("64", "0x0"),
                "--snapshot-every": ("0", "0s", "s", "-1s", "1m"),
                "--checkpoint-every": ("0", "0s", "1m"),
        }.items():
            for value in values:
                self.assert_rejected(f"{option}={value}", says=option)

    def test_resolution_out_of_range(self):
        for value in ("0", "15", "8193", "-64", "64.5", "1e3", "", " 64"):
            with self.subTest(value=value):
                self.assert_refused(
                    self.run_hemirad("solve", "scene.obj", "--resolution", value),
                    f'hemirad: --resolution "{value}": expected a whole number from 16 to 8192')

    def test_unknown_device(self):
        self.assert_rejected("--device", "abacus", says="--device")
        self.assert_rejected("--device", "99", says="--device")

    def test_more_compute_units_than_there_are(self):
        self.assert_rejected("--compute-units", "60000", says="--compute-units 60000")

    def test_pe_array_larger_than_the_device_allows(self):
        self.assert_rejected("--pe", "8192x8192", says="--pe 8192x8192")

    def test_unknown_option(self):
        self.assert_rejected("--colour", "red", says='unknown option "--colour"')

    def test_option_without_value(self):
        self.assert_rejected("--tolerance", says="--tolerance")

    def test_option_given_twice(self):
        self.assert_rejected("--tolerance", "0.1", "--tolerance", "0.2", says="--tolerance")

    def test_quiet_and_verbose(self):
        self.assert_rejected("--quiet", "--verbose", says="--verbose")

    def test_second_scene(self):
        self.assert_rejected("other.obj", says="other.obj")

    def test_missing_kernels(self):
        result = self.solve("--kernels", "nowhere")
        self.assert_refused(result, "nowhere")

    def test_commands(self):
        for arguments, says in (((), "--help"), (("bake",), "bake"), (("solve",), "SCENE"),
                                (("info",), "SCENE"), (("devices", "all"), "all"),
                                (("--loud",), "--loud"), (("solve", ""), "SCENE"),
                                (("solve", "--x\x1b[1m\n", "scene.obj"), "\\x1b[1m\\x0a")):
            with self.subTest(arguments=arguments):
                self.assert_refused(self.run_hemirad(*arguments), "hemirad: ", says=says)

    def test_more_proxels_than_can_be_counted(self):
        self.assert_refused_at_once("--resolution", "8192", "--shooter-samples", "16")

    def test_an_index_is_no_part_of_a_name(self):
        self.assert_refused_at_once("--device", "512")

    def assert_refused_at_once(self, *arguments):
        result = self.solve(*arguments)
        self.assertEqual(1, result.returncode, result.stderr)
        self.assertIn(arguments[0], result.stderr.splitlines()[-1])
        self.assertFalse((self.folder / "scene.exr").exists())


class BadOutputs(CommandLine):
    def test_folder_that_does_not_exist(self):
        for option, name in (("-o", "no/a.exr"), ("--preview", "no/a.png"),
                             ("--faces", "no/a.csv"), ("--report", "no/a.json")):
            with self.subTest(option=option):
                self.assert_refused(self.solve(option, name), name + ": ", exit_code=3)

    def test_folder_in_the_place_of_the_file(self):
        (self.folder / "taken.exr").mkdir()
        self.assert_refused(self.solve("-o", "taken.exr"), "taken.exr: ", exit_code=3)

    def test_folder_without_write_permission(self):
        (self.folder / "shut").mkdir(mode=0o555)
        self.folder.chmod(0o755)
        somebody = {"user": 65534} if os.geteuid() == 0 else {}  # root may write everywhere
        self.assert_refused(self.solve("-o", "shut/a.exr", **somebody), "shut/a.exr: ",
                            exit_code=3)

    def test_full_disk(self):
        result = self.solve("-o", "/dev/full")
        self.assert_refused_after_start(result, "/dev/full: ")

    def assert_refused_after_start(self, result, begins):
        self.assertEqual(3, result.returncode, result.stderr)
        self.assertTrue(result.stderr.splitlines()[-1].startswith(begins), result.stderr)

    def test_standard_output_on_a_full_disk(self):
        for arguments in (("devices",), ("info", "scene.obj"), ("--help",), ("--version",)):
            with open("/dev/full", "w", encoding="ascii") as full:
                result = subprocess.run([HEMIRAD, *arguments], cwd=self.folder, stdout=full,
                                        stderr=subprocess.PIPE, check=False)
            self.assertEqual(3, result.returncode, arguments)

    def test_told_before_the_solve(self):
        self.write("broken.obj", "not a scene")
        self.assert_refused(self.solve("-o", "no/a.exr", scene="broken.obj"), "no/a.exr: ",
                            exit_code=3)

    def test_light_beyond_what_a_float_holds(self):
        self.write("scene.mtl", scenes.MATERIALS.replace("Ke", "Ke 1e200 1e200 1e200 #"))
        result = self.solve("-o", "a.exr", "--faces", "a.csv")
        self.assert_refused_after_start(result, "a.exr: values are beyond the range of float")
        self.assertFalse((self.folder / "a.exr").exists())
        self.assertIn("e+200", (self.folder / "a.csv").read_text())

    def test_names_with_an_unfitting_ending(self):
        self.assert_refused(self.solve("-o", "a.png"), 'hemirad: --output "a.png": ')
        self.assert_refused(self.solve("--preview", "a.exr"), 'hemirad: --preview "a.exr": ')

    def test_names_of_results_with_an_unfitting_ending(self):
        self.assert_refused(self.solve("--faces", "scene.mtl"), 'hemirad: --faces "scene.mtl": ')
        self.assert_refused(self.solve("--report", "scene.obj"),
                            'hemirad: --report "scene.obj": ')

    def test_two_outputs_in_one_file(self):
        self.write("a.txt", "older")
        for name in ("a.csv", "a.json"):
            (self.folder / name).symlink_to("a.txt")
        result = self.solve("--faces", "a.csv", "--report", "./a.json")
        for name in ("a.csv", "a.json"):
            (self.folder / name).unlink()
        self.assert_refused(result, "hemirad: ./a.json: ")
        self.assertEqual("older", (self.folder / "a.txt").read_text())

    def test_that_a_kept_snapshot_could_overwrite(self):
        snapshots = ("-o", "a.exr", "--snapshot-every", "20", "--keep-snapshots")
        (self.folder / "b.txt").symlink_to("a-40.exr")
        for arguments, name in ((("--checkpoint", "a-20.exr"), "a-20.exr"),
                                (("--checkpoint", "./a-7.exr"), "./a-7.exr"),
                                (("--checkpoint", "b.txt"), "b.txt"),
                                (("--resume", "a-40.exr"), "a-40.exr")):
            with self.subTest(arguments):
                self.assert_refused(self.solve(*snapshots, *arguments), f"hemirad: {name}: ",
                                    says="could be overwritten by a snapshot of --keep-snapshots")
        self.assert_done(self.solve(*snapshots, "--checkpoint", "a-x.exr", "--max-shots", "30"))

    def test_in_a_current_folder_that_was_removed(self):
        def remove_folder():
            gone = self.folder / "gone"
            gone.mkdir()
            os.chdir(gone)
            gone.rmdir()

        result = subprocess.run([HEMIRAD, "solve", self.folder / "scene.obj", *QUICK, "-o", "a.exr"],
                                preexec_fn=remove_folder, cwd=self.folder, text=True, timeout=60,
                                capture_output=True, check=False)
        self.assert_refused(result, "a.exr: no current folder: No such file or directory",
                            exit_code=3)

    def test_link_to_another_output_that_is_not_there_yet(self):
        (self.folder / "b.csv").symlink_to("a.exr")
        for link in ("b.csv", "c.csv"):
            if link == "c.csv":
                (self.folder / link).symlink_to("b.csv")
            result = self.solve("-o", "a.exr", "--faces", link)
            self.assert_refused(result, f"hemirad: {link}: ", says="would overwrite another output")

    def test_output_over_the_scene(self):
        before = (self.folder / "scene.obj").read_bytes()
        (self.folder / "a.csv").symlink_to("scene.obj")
        result = self.solve("--faces", "a.csv")
        (self.folder / "a.csv").unlink()
        self.assert_refused(result, "hemirad: a.csv: ")
        self.assertEqual(before, (self.folder / "scene.obj").read_bytes())


class SideFiles(CommandLine):
    """No output replaces a file that belongs to the scene, however its name is spelled."""

    def files(self):
        return {path.name: path.read_bytes() for path in self.folder.iterdir() if path.is_file()}

    def assert_kept(self, scene, *arguments, command="solve", named=None):
        before = self.files()
        result = self.run_hemirad(command, scene, *arguments)
        line = f"hemirad: {named or arguments[-1]}: would overwrite a file of the scene\n"
        self.assertEqual((1, line), (result.returncode, result.stderr))
        self.assertEqual(before, self.files())

    def link(self, name, target):
        (self.folder / name).symlink_to(target)
        return name

    def write_textured_obj(self, texture="wood.png"):
        self.write("scene.mtl", scenes.MATERIALS + f"map_Kd {texture}\n")
        self.write(texture, "wood")

    def write_textured_gltf(self):
        document = json.loads(scenes.gltf())
        uri = document["buffers"][0]["uri"]
        self.write("sheet.bin", base64.b64decode(uri.partition(",")[2]))
        self.write("old wood.png", "wood")
        self.write("sheet.gltf", scenes.gltf(
            buffers=[{**document["buffers"][0], "uri": "sheet.bin"}],
            images=[{"uri": "old%20wood.png"}]))

    def test_the_materials_of_an_obj(self):
        for option, name in (("--faces", "a.csv"), ("--report", "a.json"), ("--preview", "a.png"),
                             ("-o", "a.exr"), ("--gltf", "a.glb")):
            with self.subTest(option=option):
                self.assert_kept("scene.obj", option, self.link(name, "scene.mtl"))
                (self.folder / name).unlink()

    def test_the_textures_that_materials_name(self):
        self.write_textured_obj()
        (self.folder / "folder").mkdir()
        for name in ("wood.png", "./wood.png", "folder/../wood.png", str(self.folder / "wood.png"),
                     self.link("a.png", "wood.png"), self.link("folder/b.png", "../wood.png")):
            with self.subTest(name=name):
                self.assert_kept("scene.obj", "--preview", name)
                self.assert_kept("folder/../scene.obj", "--preview", name)

    def test_the_buffers_and_pictures_of_a_gltf(self):
        self.write_textured_gltf()
        self.assert_kept("sheet.gltf", "--preview", "old wood.png")
        self.assert_kept("sheet.gltf", "--preview", self.link("a.png", "old wood.png"))
        self.assert_kept("sheet.gltf", "--faces", self.link("a.csv", "sheet.bin"))

    def test_a_picture_that_a_kept_snapshot_would_replace(self):
        self.write_textured_obj("sky-100.exr")
        self.assert_kept("scene.obj", "--snapshot-every", "50", "--keep-snapshots", "-o",
                         "sky.exr", named="sky-100.exr")

    def test_checkpoints_replace_none_either(self):
        result = self.solve("--checkpoint", "scene.mtl")
        self.assertEqual(1, result.returncode, result.stderr)
        self.assertEqual(scenes.MATERIALS, (self.folder / "scene.mtl").read_text())

    def test_other_commands_keep_them_too(self):
        self.assert_kept("scene.obj", "-o", self.link("a.csv", "scene.mtl"), command="formfactors")
        self.assert_done(self.solve("-o", "solved.glb"))
        self.assert_kept("solved.glb", "--eye", "1,1,1", "-o", "solved.exr", command="render")
        self.assert_kept("solved.glb", "-o", self.link("a.html", "solved.exr"), command="view")

    def test_a_texture_that_is_missing_is_no_file_of_the_scene(self):
        self.write_textured_obj()
        (self.folder / "wood.png").unlink()
        self.assert_done(self.solve("--max-shots", "1", "--preview", "wood.png"))


class Solve(CommandLine):
    def test_writes_the_lightmap_beside_the_caller_by_default(self):
        self.assert_done(self.solve())
        self.assertEqual(b"\x76\x2f\x31\x01", (self.folder / "scene.exr").read_bytes()[:4])

    def test_keeps_standard_output_clean(self):
        self.assertEqual("", self.solve("--verbose").stdout)

    def test_quiet_says_nothing(self):
        self.assertEqual("", self.solve("--quiet").stderr)

    def test_prints_the_ledger_of_every_band(self):
        lines = self.solve().stderr.splitlines()
        for band in "RGB":
            self.assertTrue(any(line.split()[0] == band for line in lines), lines)

    def test_writes_preview_and_faces(self):
        self.assert_done(self.solve("-o", "a.exr", "--preview", "a.png", "--faces", "a.csv"))
        self.assertEqual(b"\x89PNG", (self.folder / "a.png").read_bytes()[:4])
        lines = (self.folder / "a.csv").read_text().splitlines()
        self.assertEqual("face,object,material,area,cx,cy,cz,irradiance.R,irradiance.G,irradiance.B"
                         ",radiosity.R,radiosity.G,radiosity.B", lines[0])
        self.assertEqual(1 + 2, len(lines))

    def test_gives_the_same_bytes_for_every_machine(self):
        pictures = set()
        for machine in ((), ("--lanes", "1", "--pe", "32x32"), ("--lanes", "4", "--pe", "8x8"),
                        ("--tile", "128x32"), ("--compute-units", "1")):
            self.assert_done(self.solve(*machine))
            pictures.add((self.folder / "scene.exr").read_bytes())
        self.assertEqual(1, len(pictures))

    def test_what_replaces_an_older_file_has_its_mode(self):
        self.write("a.exr", "older")
        (self.folder / "a.exr").chmod(0o600)
        self.assert_done(self.solve("-o", "a.exr", "--faces", "a.csv"))
        modes = [(self.folder / name).stat().st_mode & 0o777 for name in ("a.exr", "a.csv")]
        umask = os.umask(0)
        os.umask(umask)
        self.assertEqual([0o600, 0o666 & ~umask], modes)

    def test_half_is_smaller(self):
        self.assert_done(self.solve("-o", "float.exr"))
        self.assert_done(self.solve("-o", "half.exr", "--half"))
        self.assertLess((self.folder / "half.exr").stat().st_size,
                        (self.folder / "float.exr").stat().st_size)

    def test_stops_at_max_shots(self):
        result = self.solve("--max-shots", "3", "--report", "r.json")
        self.assert_done(result)
        self.assertIn("stopped by --max-shots 3: 3 shots", result.stderr)
        self.assertEqual(3, json.loads((self.folder / "r.json").read_text())["shots"])

    def test_row_memory_spares_work_and_changes_no_bit(self):
        box = str(pathlib.Path(__file__).resolve().parents[2] / "scenes" / "furnace.obj")
        self.assert_done(self.solve("-o", "a.exr", "--report", "a.json", scene=box))
        self.assert_done(self.solve("-o", "b.exr", "--report", "b.json", "--row-memory", "0",
                                    scene=box))
        self.assertEqual((self.folder / "a.exr").read_bytes(),
                         (self.folder / "b.exr").read_bytes())
        repeated = [json.loads((self.folder / name).read_text())["repeated_shots"]
                    for name in ("a.json", "b.json")]
        self.assertGreater(repeated[0], 0)
        self.assertEqual(0, repeated[1])

    def test_reads_kernels_from_a_folder(self):
        kernels = pathlib.Path(__file__).resolve().parents[2] / "kernels"
        self.assert_done(self.solve("-o", "a.exr"))
        self.assert_done(self.solve("-o", "b.exr", "--kernels", str(kernels)))
        self.assertEqual((self.folder / "a.exr").read_bytes(),
                         (self.folder / "b.exr").read_bytes())

    def test_kernel_that_does_not_compile_is_the_device_s_fault(self):
        kernels = pathlib.Path(__file__).resolve().parents[2] / "kernels"
        (self.folder / "kernels").mkdir()
        for file in kernels.iterdir():
            (self.folder / "kernels" / file.name).write_bytes(file.read_bytes())
        with open(self.folder / "kernels/cull_patches.cl", "a", encoding="ascii") as kernel:
            kernel.write("\noops;\n")
        result = self.solve("--kernels", "kernels")
        self.assertEqual(2, result.returncode, result.stderr)
        self.assertIn("hemirad: ", result.stderr)
        self.assertIn("kernels/cull_patches.cl:", result.stderr)
        self.assertFalse((self.folder / "scene.exr").exists())


class Report(CommandLine):
    def test_holds_what_the_interface_promises(self):
        self.assert_done(self.solve("--report", "r.json", "--preview", "p.png"))
        report = json.loads((self.folder / "r.json").read_text())
        for key, members in {
                "scene": ("patches", "elements", "bands", "closed"),
                "device": ("name", "compute_units", "pe", "lanes"),
                "closure": ("min", "max"),
                "seconds": ("total", "prepare", "build_kernels", "solve", "gather", "lightmap",
                            "per_shot_median", "per_stage"),
        }.items():
            for member in members:
                self.assertIn(member, report[key])
        self.assertEqual(["R", "G", "B"], list(report["ledger"]))
        self.assertLess(report["ledger"]["R"]["residual"], 1e-5)
        self.assertEqual({"min": 1, "max": 1}, report["closure"])
        self.assertLess(report["unshot_fraction"], 1e-3)
        self.assertGreater(report["peak_memory_bytes"], 1 << 20)
        self.assertEqual(64, report["settings"]["resolution"])
        self.assertEqual([], report["warnings"])
        self.assertEqual(["scene.exr"], [lightmap["file"] for lightmap in report["lightmaps"]])
        self.assertIn("project_patches", report["seconds"]["per_stage"])

    def test_counts_patches_and_their_elements(self):
        counts = []
        for sizes in ((), ("--element-size", "0.25"), ("--element-size", "0.1")):
            self.assert_done(self.solve("--report", "r.json", "--backfaces", "cull", *sizes))
            report = json.loads((self.folder / "r.json").read_text())
            counts.append((report["scene"]["patches"], report["scene"]["elements"]))
            self.assertEqual(float(sizes[1]) if sizes else None,
                             report["settings"].get("element_size"))
        patches = counts[0][0]
        self.assertEqual([(patches, patches), (patches, patches), (patches, 9 * patches)], counts)

    def test_counts_the_elements_that_light_splits(self):
        def elements(*arguments):
            self.assert_done(self.solve("--report", "r.json", "--backfaces", "cull", *arguments))
            return json.loads((self.folder / "r.json").read_text())["scene"]["elements"]
        once = elements("--split", "1", "--texel-size", "0.1", "-o", "a.exr")
        twice = elements("--split", "2", "--texel-size", "0.1", "-o", "b.exr")
        self.assertTrue(32 < once < twice < 16 * 32, (once, twice))
        self.assertEqual(twice, elements("--split", "2", "--texel-size", "0.1", "-o", "c.exr",
                                         "--compute-units", "1"))
        self.assertEqual((self.folder / "b.exr").read_bytes(),
                         (self.folder / "c.exr").read_bytes())

    def test_counts_the_patches_that_their_elements_split(self):
        self.write("corner.obj", scenes.obj(faces=scenes.FACES + "usemtl white\nf 1 2 6 5\n"))
        def patches(levels):
            self.assert_done(self.solve("--report", "r.json", "--backfaces", "cull", "--split", levels,
                                        "--element-size", "0.125", scene="corner.obj"))
            return json.loads((self.folder / "r.json").read_text())["scene"]["patches"]
        whole, once = patches("0"), patches("1")
        self.assertTrue(whole < once < 4 * whole, (whole, once))

    def test_sums_up_the_files(self):
        self.assert_done(self.solve("--report", "r.json", "--preview", "p.png"))
        outputs = json.loads((self.folder / "r.json").read_text())["outputs"]
        self.assertEqual(["scene.exr", "p.png"], [output["file"] for output in outputs])
        for output in outputs:
            bytes_written = (self.folder / output["file"]).read_bytes()
            self.assertEqual(hashlib.sha256(bytes_written).hexdigest(), output["sha256"])


class Interrupt(CommandLine):
    def start(self, *arguments):
        return self.solve_until("a.exr", *LONG, "--snapshot-every", "1", "-o", "a.exr", *arguments)

    def test_snapshot_appears_while_the_solve_goes_on(self):
        process = self.start()
        self.assertTrue((self.folder / "a.exr").exists())
        self.assertIsNone(process.poll())

    def test_only_interim_pictures_hold_an_ambient_term(self):
        process = self.start()
        self.assertIn(b"hemirad.ambient", (self.folder / "a.exr").read_bytes())
        process.send_signal(signal.SIGINT)
        process.wait(60)
        self.assertNotIn(b"hemirad.ambient", (self.folder / "a.exr").read_bytes())

    def test_snapshots_leave_the_final_picture_as_it_is(self):
        pictures = []
        for arguments in ((), ("--snapshot-every", "3")):
            self.assert_done(self.solve("-o", "a.exr", *arguments))
            pictures.append((self.folder / "a.exr").read_bytes())
        self.assertEqual(*pictures)

    def test_first_one_writes_the_picture_so_far(self):
        process = self.start("--report", "r.json")
        (self.folder / "a.exr").unlink()
        process.send_signal(signal.SIGINT)
        self.assertEqual(130, process.wait(60))
        self.assertIn("interrupted", process.stderr.read())
        self.assertEqual(b"\x76\x2f\x31\x01", (self.folder / "a.exr").read_bytes()[:4])
        self.assertGreater(json.loads((self.folder / "r.json").read_text())["shots"], 0)


class Environment(CommandLine):
    def variables(self, **changes):
        kept = {k: v for k, v in os.environ.items()
                if k not in ("HOME", "XDG_CACHE_HOME", "POCL_CACHE_DIR")}
        return kept | {"TMPDIR": str(self.folder)} | changes

    def test_home_that_cannot_be_written(self):
        self.assert_done(self.solve(env=self.variables(HOME="/dev/null")))

    def test_no_home(self):
        self.assert_done(self.solve(env=self.variables()))

    def test_empty_home_variable(self):
        self.assert_done(self.solve(env=self.variables(HOME="")))

    def test_home_in_use(self):
        self.assert_done(self.solve(env=self.variables(HOME=str(self.folder))))
        self.assertTrue((self.folder / ".cache/pocl").is_dir())

    def test_locale_with_decimal_commas(self):
        self.assert_done(self.solve(env=os.environ | {"LC_ALL": "de_DE.UTF-8"}))


class Questions(CommandLine):
    def test_help_goes_to_standard_output(self):
        for command in ((), ("solve",), ("info",), ("devices",)):
            result = self.run_hemirad(*command, "--help")
            self.assert_done(result)
            self.assertIn("Usage: hemirad", result.stdout)
            self.assertEqual("", result.stderr)

    def test_version(self):
        self.assertRegex(self.run_hemirad("--version").stdout, r"^hemirad \d+\.\d+\.\d+\n$")

    def test_info(self):
        result = self.run_hemirad("info", "scene.obj", "--patch-size", "0.5")
        self.assert_done(result)
        for line in ("faces        2 ", "patches ", "parts        2", "floor: 1 face, open",
                     "solved: 1", "memory "):
            self.assertIn(line, result.stdout)

    def test_info_counts_the_backs_that_the_option_asks_for(self):
        blocked = self.run_hemirad("info", "scene.obj", "--backfaces", "block").stdout
        culled = self.run_hemirad("info", "scene.obj", "--backfaces", "cull").stdout
        self.assertIn("floor: 1 face, open, 1 back", blocked)
        self.assertIn("floor: 1 face, open, no backs", culled)

    def test_info_without_a_lightmap_tells_the_rest(self):
        self.write("scene.obj", scenes.obj(faces=scenes.FACES + "f 1 1 2\n"))
        result = self.run_hemirad("info", "scene.obj", "--texel-size", "1e-9")
        self.assert_done(result)
        self.assertRegex(result.stdout, r"\nmemory       none, no lightmap: --texel-size 1e-0?9: the"
                                        r" .*\nwarnings     1\n  scene\.obj: .*\n$")

    def test_info_solves_three_bands_where_colours_differ(self):
        self.write("scene.mtl", "newmtl white\nKd .1 .2 .3\nnewmtl lamp\nKe 1 1 1\n")
        self.assertIn("solved: 3", self.run_hemirad("info", "scene.obj").stdout)

    def test_devices(self):
        result = self.run_hemirad("devices")
        self.assert_done(result)
        for word in ("0: ", "platform", "compute units", "max work-group", "local memory",
                     "--pe ", "--lanes ", "--tile "):
            self.assertIn(word, result.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
