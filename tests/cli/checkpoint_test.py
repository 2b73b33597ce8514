#!/usr/bin/env python3
"""`hemirad solve`: stopped, killed, on a full disk, and going on. HEMIRAD names the binary."""
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest

import scenes
from cli_test import LONG, CommandLine
from exr import Exr

KERNELS = pathlib.Path(__file__).resolve().parents[2] / "kernels"
KEPT = ("shots", "ledger", "closure", "unshot_fraction", "lights", "error", "settings", "outputs")


class Checkpoints(CommandLine):
    def report(self):
        return json.loads((self.folder / "r.json").read_text())

    def bytes_of(self, name):
        return (self.folder / name).read_bytes()

    def stop_early(self, *arguments, shots="5"):
        self.assert_done(self.solve("--max-shots", shots, "--checkpoint", "c.ckpt", *arguments))

    def assert_nothing_half_written(self):
        self.assertEqual([], [p.name for p in self.folder.iterdir() if p.name.startswith(".")])


class Resume(Checkpoints):
    def assert_same_end(self, *arguments):
        outputs = ("-o", "a.exr", "--faces", "a.csv", "--report", "r.json", *arguments)
        self.assert_done(self.solve(*outputs))
        whole, report = (self.bytes_of("a.exr"), self.bytes_of("a.csv")), self.report()
        self.stop_early(*outputs)
        self.assertLess(self.report()["shots"], report["shots"])

        result = self.solve(*outputs, "--resume", "c.ckpt")

        self.assert_done(result)
        self.assertIn("c.ckpt: goes on after 5 shots", result.stderr)
        self.assertEqual(whole, (self.bytes_of("a.exr"), self.bytes_of("a.csv")))
        self.assertEqual(5, self.report()["resumed_shots"])
        for key in KEPT:
            self.assertEqual(report[key], self.report()[key])

    def test_ends_with_the_bytes_of_a_whole_solve(self):
        self.assert_same_end()

    def test_ends_with_the_same_bytes_where_light_splits_elements(self):
        self.write("scene.obj", scenes.obj(faces=scenes.FACES + "usemtl white\nf 1 2 6 5\n"))
        self.assert_same_end("--split", "1", "--element-size", "0.125", "--backfaces", "cull")

    def test_goes_on_from_a_converged_solve(self):
        self.assert_done(self.solve("--checkpoint", "c.ckpt"))
        whole = self.bytes_of("scene.exr")
        self.assert_done(self.solve("--checkpoint", "c.ckpt", "--resume", "c.ckpt"))
        self.assertEqual(whole, self.bytes_of("scene.exr"))
        self.assert_done(self.solve("--resume", "c.ckpt", "--tolerance", "1e-4", "-o", "a.exr"))
        self.assert_done(self.solve("--tolerance", "1e-4", "-o", "b.exr"))
        self.assertEqual(self.bytes_of("a.exr"), self.bytes_of("b.exr"))

    def test_may_go_on_with_other_outputs_limits_and_machines(self):
        self.stop_early("--lanes", "1", "--pe", "8x8")
        self.assert_done(self.solve("--resume", "c.ckpt", "-o", "a.exr", "--preview", "a.png",
                                    "--row-memory", "0", "--time-limit", "100", "--compute-units",
                                    "1", "--quantity", "radiosity"))
        self.assert_done(self.solve("-o", "b.exr", "--quantity", "radiosity", "--time-limit",
                                    "100"))
        self.assertEqual(self.bytes_of("b.exr"), self.bytes_of("a.exr"))

    def test_goes_on_wherever_the_same_kernels_lie(self):
        shutil.copytree(KERNELS, self.folder / "kk")
        self.stop_early("--kernels", "kk")
        for folder in (("--kernels", "./kk"), ("--kernels", str(self.folder / "kk")), ()):
            with self.subTest(folder):
                self.assert_done(self.solve("--resume", "c.ckpt", "-o", "a.exr", *folder))

    def test_is_none_where_the_time_is_over_before_the_second_split(self):
        """Less than a solve takes to begin, more than it then takes to end."""
        self.write("scene.obj", scenes.obj(faces=scenes.FACES + "usemtl white\nf 1 2 6 5\n"))
        result = self.solve("--split", "2", "--backfaces", "cull", "--checkpoint", "c.ckpt",
                            "--time-limit", "0.03")
        self.assertEqual(1, result.returncode, result.stderr)
        self.assertIn("scene.exr: stopped before --split was done; nothing is written",
                      result.stderr)
        self.assertFalse((self.folder / "c.ckpt").exists())

    def test_of_the_same_solve_is_not_replaced_by_one_with_fewer_shots(self):
        self.stop_early()
        left = self.bytes_of("c.ckpt")
        result = self.solve("--max-shots", "2", "--checkpoint", "c.ckpt")
        self.assert_done(result)
        self.assertIn("c.ckpt: holds this solve after 5 shots, and stays", result.stderr)
        self.assertEqual(left, self.bytes_of("c.ckpt"))
        self.assert_done(self.solve("--max-shots", "6", "--checkpoint", "c.ckpt"))
        self.assertNotEqual(left, self.bytes_of("c.ckpt"))

    def test_and_pictures_are_not_replaced_where_no_shot_was_made(self):
        self.stop_early()
        before = (self.bytes_of("scene.exr"), self.bytes_of("c.ckpt"))
        result = self.solve("--time-limit", "1e-9", "--checkpoint", "c.ckpt", "--weld", "0.001")
        self.assertEqual(1, result.returncode, result.stderr)
        self.assertIn("scene.exr: stopped before the first shot; nothing is written", result.stderr)
        self.assertEqual(before, (self.bytes_of("scene.exr"), self.bytes_of("c.ckpt")))

    def test_counts_what_was_done_again_as_one(self):
        self.stop_early()
        first = self.bytes_of("c.ckpt")
        self.stop_early("--resume", "c.ckpt")
        self.assertEqual(first, self.bytes_of("c.ckpt"))


class BadCheckpoints(Checkpoints):
    def assert_not_resumed(self, says, *arguments):
        checkpoint = self.bytes_of("c.ckpt")
        result = self.solve("--quiet", "-o", "a.exr", "--checkpoint", "c.ckpt", "--resume",
                            "c.ckpt", *arguments)
        self.assertEqual(1, result.returncode, result.stderr)
        self.assertEqual("c.ckpt: " + says + "\n", result.stderr)
        self.assertEqual(checkpoint, self.bytes_of("c.ckpt"))
        self.assertFalse((self.folder / "a.exr").exists())

    def test_of_other_settings_names_the_difference(self):
        self.stop_early()
        for option, value, says in (
                ("--patch-size", "0.5", "with --patch-size 0.25, not 0.5"),
                ("--resolution", "128", "with --resolution 64, not 128"),
                ("--shooter-samples", "3", "with --shooter-samples 2, not 3"),
                ("--form-factor", "count", "with --form-factor analytic, not count"),
                ("--salvo", "8", "with --salvo 1, not 8"),
                ("--lights", "separate", "with --lights together, not separate"),
                ("--split", "1", "with --split 0, not 1"),
                ("--tolerance", "0.01", "with --tolerance 0.001, not as much as 0.01"),
                ("--max-shots", "4", "after 5 shots, more than --max-shots 4")):
            options = {"--resolution": "64", "--patch-size": "0.25", option: value}
            with self.subTest(option):
                result = self.run_hemirad("solve", "scene.obj", "--quiet", "--resume", "c.ckpt",
                                          "-o", "a.exr", *sum(options.items(), ()))
                self.assertEqual(1, result.returncode, result.stderr)
                self.assertEqual("c.ckpt: made " + says + "\n", result.stderr)
                self.assertFalse((self.folder / "a.exr").exists())

    def test_of_a_scene_that_was_changed_since(self):
        self.stop_early()
        says = "made from another scene, or before this one was changed"
        for name, old, new in (("scene.mtl", b"Ke 1 1 1", b"Ke 2 1 1"),
                               ("scene.mtl", b"Kd 0.5 0.5", b"Kd 0.5 0.4"),
                               ("scene.obj", b"v 1 1 1", b"v 1 1 0.9")):
            before = self.bytes_of(name)
            self.write(name, before.replace(old, new))
            with self.subTest(new):
                self.assertNotEqual(before, self.bytes_of(name))
                self.assert_not_resumed(says)
            self.write(name, before)

    def test_of_other_kernels(self):
        shutil.copytree(KERNELS, self.folder / "kk")
        self.stop_early("--kernels", "kk")
        kernel = self.folder / "kk" / "choose_shooter.cl"
        kernel.write_text(kernel.read_text(encoding="ascii") + "// and more\n", encoding="ascii")
        self.assert_not_resumed("made with other kernels", "--kernels", "kk")

    def test_torn(self):
        self.stop_early()
        whole = self.bytes_of("c.ckpt")
        self.write("c.ckpt", whole[:-1])
        self.assert_not_resumed("damaged or cut short: its checksum does not fit")
        self.write("c.ckpt", whole[:-100] + b"x" + whole[-99:])
        self.assert_not_resumed("damaged or cut short: its checksum does not fit")

    def test_missing(self):
        self.assert_refused(self.solve("--resume", "c.ckpt"),
                            "c.ckpt: No such file or directory")

    @unittest.skipIf(os.geteuid() == 0, "root may search every folder")
    def test_in_a_folder_that_may_not_be_searched(self):
        (self.folder / "no").mkdir()
        self.write("no/c.ckpt", "")
        (self.folder / "no").chmod(0o600)
        self.addCleanup((self.folder / "no").chmod, 0o700)
        self.assert_refused(self.solve("--resume", "no/c.ckpt"),
                            "no/c.ckpt: Permission denied")

    def test_where_something_else_is(self):
        before = self.bytes_of("scene.mtl")
        self.assert_refused(self.solve("--checkpoint", "scene.mtl"),
                            "hemirad: --checkpoint scene.mtl: would overwrite what is no checkpoint")
        self.assertEqual(before, self.bytes_of("scene.mtl"))
        self.assert_refused(self.solve("--checkpoint", "scene.obj"), "hemirad: scene.obj: ")

    def test_that_an_output_would_overwrite(self):
        self.write("c.ckpt", "hours of work")
        (self.folder / "a.exr").symlink_to("c.ckpt")
        result = self.solve("--resume", "c.ckpt", "--checkpoint", "new.ckpt", "-o", "a.exr")
        self.assertEqual((1, "hemirad: a.exr: would overwrite the checkpoint of --resume\n"),
                         (result.returncode, result.stderr))
        self.assertEqual(b"hours of work", self.bytes_of("c.ckpt"))

    def test_with_options_that_do_not_go_together(self):
        for arguments in (("--checkpoint", "c.ckpt", "--target-error", "0.1"),
                          ("--resume", "c.ckpt", "--target-error", "0.1"),
                          ("--checkpoint-every", "5s")):
            result = self.run_hemirad("solve", "scene.obj", *arguments)
            self.assert_refused(result, "hemirad: ", says=arguments[0])

    def test_in_a_folder_that_cannot_be_written(self):
        self.assert_refused(self.solve("--checkpoint", "no/c.ckpt"), "no/c.ckpt: ", exit_code=3)

    def test_on_a_full_disk_leaves_the_picture(self):
        result = self.solve("--checkpoint", "/dev/full", "--checkpoint-every", "1", "-o", "a.exr")
        self.assertEqual(3, result.returncode, result.stderr)
        self.assertEqual("/dev/full: No space left on device", result.stderr.splitlines()[-1])
        self.assertEqual(1, result.stderr.count("is tried again"))
        Exr(self.folder / "a.exr")


class Interruption(Checkpoints):
    ARGUMENTS = (*LONG, "-o", "a.exr", "--checkpoint", "c.ckpt", "--checkpoint-every", "1",
                 "--report", "r.json")

    def start(self):
        return self.solve_until("c.ckpt", *self.ARGUMENTS)

    def test_writes_what_was_asked_for_and_goes_on(self):
        for stop in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            process = self.start()
            process.send_signal(stop)
            self.assertEqual(130, process.wait(60))
            Exr(self.folder / "a.exr")
            shots = self.report()["shots"]

            more = self.run_hemirad("solve", "scene.obj", *self.ARGUMENTS, "--resume", "c.ckpt",
                                    "--max-shots", str(shots + 20))

            self.assert_done(more)
            self.assertEqual((shots, shots + 20),
                             (self.report()["resumed_shots"], self.report()["shots"]))
            for name in ("a.exr", "c.ckpt", "r.json"):
                (self.folder / name).unlink()

    def test_ignored_from_the_beginning_stays_ignored(self):
        before = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
        try:
            process = self.start()
        finally:
            signal.signal(signal.SIGHUP, before)
        process.send_signal(signal.SIGHUP)
        with self.assertRaises(subprocess.TimeoutExpired):
            process.wait(1)

    def test_on_a_full_disk_leaves_the_files_from_before(self):
        self.write("a.exr", "older")
        process = self.start()
        resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (1024, 1024))
        time.sleep(0.5)  # one may have been under way
        before = self.bytes_of("c.ckpt")
        process.send_signal(signal.SIGINT)
        self.assertEqual(3, process.wait(60))
        self.assertEqual("a.exr: File too large", process.stderr.read().splitlines()[-1])
        self.assertEqual((b"older", before), (self.bytes_of("a.exr"), self.bytes_of("c.ckpt")))
        self.assert_nothing_half_written()

    def test_twice_within_a_second_is_once(self):
        process = self.start()
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGTERM)  # as timeout does: the program, then its group
        self.assertEqual(130, process.wait(60))
        Exr(self.folder / "a.exr")
        self.assertGreater(self.report()["shots"], 0)

    def start_that_cannot_end(self):
        """Its picture is a pipe that nobody reads."""
        os.mkfifo(self.folder / "a.exr")
        return self.start()

    def test_a_second_one_leaves_at_once_and_nothing_half_written(self):
        process = self.start_that_cannot_end()
        process.send_signal(signal.SIGINT)
        time.sleep(1.2)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        self.assertEqual(130, process.wait(10))
        self.assertFalse((self.folder / "r.json").exists())
        self.assert_nothing_half_written()
        (self.folder / "a.exr").unlink()
        self.assertEqual(0, self.run_hemirad("solve", "scene.obj", *self.ARGUMENTS,
                                             "--resume", "c.ckpt",
                                             "--time-limit", "0.01").returncode)

    def test_a_terminal_that_closes_never_leaves_at_once(self):
        process = self.start_that_cannot_end()
        process.send_signal(signal.SIGINT)
        time.sleep(1.2)
        process.send_signal(signal.SIGHUP)
        with self.assertRaises(subprocess.TimeoutExpired):
            process.wait(0.3)

    def test_reaches_no_program_that_a_compiler_starts(self):
        process = self.start()
        meant = sum(1 << (number - 1) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP))
        open_to_them = 0
        for status in pathlib.Path(f"/proc/{process.pid}/task").glob("*/status"):
            blocked = re.search(r"SigBlk:\s*(\w+)", status.read_text())[1]
            open_to_them += int(blocked, 16) & meant != meant
        self.assertEqual(1, open_to_them)  # the thread that waits for them; it starts no program

    def test_a_reader_of_messages_who_goes_ends_no_solve(self):
        process = self.start()
        process.stderr.close()
        process.send_signal(signal.SIGINT)
        self.assertEqual(130, process.wait(60))
        Exr(self.folder / "a.exr")

    def test_killed_leaves_a_checkpoint_to_go_on_from(self):
        process = self.start()
        process.kill()
        process.wait(60)
        self.assertFalse((self.folder / "a.exr").exists())
        self.assert_done(self.run_hemirad("solve", "scene.obj", *self.ARGUMENTS,
                                          "--resume", "c.ckpt", "--time-limit", "0.01"))
        self.assertGreater(self.report()["resumed_shots"], 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
