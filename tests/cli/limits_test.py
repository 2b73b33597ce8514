"""Memory and time told before the work, refusals, and what large work takes; see Load for the long
ones. Not for doubtful numbers: a quarter of what happens is the promise."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

from cli_test import HEMIRAD, CommandLine

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"
MIB = 1 << 20


def resident_bytes(pid):
    try:
        status = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="ascii")
    except OSError:
        return 0
    found = re.search(r"VmRSS:\s+(\d+) kB", status)
    return 1024 * int(found.group(1)) if found else 0


class LimitsTest(CommandLine):
    def report_of(self, scene, *options):
        result = self.run_hemirad("solve", SCENES / scene, "-o", "a.exr", "--report", "a.json",
                                  "--no-progress", *options, timeout=2500)
        self.assert_done(result)
        return json.loads((self.folder / "a.json").read_text()), result.stderr


@unittest.skipIf("ASAN_OPTIONS" in os.environ, "a sanitizer takes more than all else")
class Memory(LimitsTest):
    def assert_estimated(self, scene, *options):
        # Whether kernels had to be compiled is not for the test to say: first they are not to be.
        self.report_of(scene, *options)
        self.assert_near(scene, *options)

    def assert_near(self, scene, *options):
        report, _ = self.report_of(scene, *options)
        estimate, peak = report["estimate"]["memory_bytes"], report["peak_memory_bytes"]
        self.assertLess(abs(estimate / peak - 1), 0.25, f"{scene} {options}: {estimate} {peak}")

    def test_what_a_solve_takes_is_estimated_within_a_quarter(self):
        self.assert_estimated("cornell.gltf", "--quality", "draft")

    def test_large_lightmaps_are_estimated_too(self):
        self.assert_estimated("lroom.obj", "--quality", "draft", "--max-shots", "3", "--texel-size",
                              "0.01", "--layers", "normal,position")

    def test_pairs_of_near_patches_are_estimated_too(self):
        self.assert_estimated("cornell.gltf", "--quality", "draft", "--max-shots", "3",
                              "--sampling-error", "1e-9")

    def test_what_a_gather_takes_is_estimated_too(self):
        options = ("--quality", "draft", "--max-shots", "3", "--patch-size", "2", "--gather", "16")
        self.report_of("cornell.gltf", *options)  # its kernels, for fewer texels
        for error in "0.02", "0":
            self.assert_near("cornell.gltf", *options, "--texel-size", "0.0025", "--gather-error", error)

    def test_a_compiler_that_was_needed_for_splits_is_not_counted_twice(self):
        with tempfile.TemporaryDirectory() as cache:
            self.assert_done(self.run_hemirad(
                "solve", SCENES / "cornell.gltf", "-o", "a.exr", "--quality", "draft", "--split",
                "1", "--max-shots", "5", "--memory-limit", "350M",
                env=os.environ | {"POCL_CACHE_DIR": cache}))

    def test_info_and_report_tell_the_same(self):
        options = ("--quality", "draft", "--row-memory", "1", "--layers", "shots")
        report, told = self.report_of("cornell.gltf", *options, "--max-shots", "3")
        info = self.run_hemirad("info", SCENES / "cornell.gltf", *options, "--max-shots", "3")
        self.assert_done(info)
        in_info = re.search(r"^memory +(about .*?);", info.stdout, re.M).group(1)
        self.assertIn("memory " + in_info, told)
        self.assertEqual(report["estimate"]["memory_bytes"],
                         sum(report["estimate"]["memory_parts"].values()))

    def test_quiet_says_nothing_of_it(self):
        _, told = self.report_of("cornell.gltf", "--quality", "draft", "--patch-size", "0.2",
                                 "--quiet")
        self.assertEqual("", told)

    def refused(self, *options):
        result = self.run_hemirad("solve", SCENES / "cornell.gltf", "-o", "a.exr", *options)
        self.assertEqual(1, result.returncode, result.stderr)
        self.assertEqual(1, len(result.stderr.splitlines()), result.stderr)
        self.assertFalse((self.folder / "a.exr").exists())
        return result.stderr

    def test_a_limit_refuses_before_the_work_with_numbers_and_advice(self):
        started = time.monotonic()
        line = self.refused("--memory-limit", "250M")
        self.assertRegex(line, r"cornell\.gltf: needs about \d+ MiB, --memory-limit is 250 MiB; "
                               r"\d.* for rows of form factors: lower --row-memory")
        self.assertLess(time.monotonic() - started, 10)

    def test_the_advice_is_for_the_largest_part(self):
        self.assertIn("raise --texel-size",
                      self.refused("--memory-limit", "0.3G", "--texel-size", "0.0005"))
        self.assertIn("--patch-size", self.refused("--memory-limit", "250M", "--row-memory", "0"))

    def test_a_mesh_too_large_is_refused_before_it_is_made(self):
        for command in (("solve", "-o", "a.exr"), ("info",)):
            result = self.run_hemirad(command[0], SCENES / "cornell.gltf", *command[1:],
                                      "--patch-size", "0.0005", "--memory-limit", "1G", timeout=10)
            self.assertEqual(1, result.returncode)
            self.assertRegex(result.stderr, r"^cornell\.gltf: needs about [\d.]+ GiB, --memory-limit "
                                            r"is 1\.0 GiB; [\d.]+ GiB for \d+ patches: raise "
                                            r"--patch-size\n$")
        self.assertIn("raise --element-size", self.refused("--element-size", "0.0005",
                                                           "--memory-limit", "1G"))

    def test_a_mesh_larger_than_what_is_free_is_refused_before_it_is_made(self):
        """Some 40 GiB."""
        free = pathlib.Path("/proc/meminfo").read_text(encoding="ascii")
        if int(re.search(r"MemAvailable: +(\d+) kB", free).group(1)) > 32 * MIB:
            self.skipTest("there is room for it")
        for command in ("sweep", "formfactors"):
            result = self.run_hemirad(command, SCENES / "cornell.gltf", "-o", "a.csv",
                                      "--patch-size", "0.00014", timeout=10)
            self.assertEqual(1, result.returncode)
            self.assertRegex(result.stderr, r"^cornell\.gltf: needs about .* are free; ")

    def test_info_reckons_with_all_that_takes_memory(self):
        options = ("--texel-size", "0.002", "--row-memory", "0", "--memory-limit", "50M")
        told = []
        for more in ((), ("--preview", "a.png"), ("--snapshot-every", "9")):
            info = self.run_hemirad("info", SCENES / "cornell.gltf", *options, *more)
            self.assert_done(info)
            told.append(float(re.search(r"^memory +about ([\d.]+) MiB", info.stdout, re.M).group(1)))
        self.assertGreater(told[1], told[0])
        self.assertGreater(told[2], told[0])
        self.assertFalse((self.folder / "a.png").exists())

    def test_a_target_reckons_with_the_near_pairs_of_its_solves(self):
        told = self.run_hemirad("info", SCENES / "cornell.gltf", "--target-error", "0.001",
                                "--row-memory", "0")
        self.assertRegex(told.stdout, r"\nmemory .*pairs of near patches [0-9.]+ MiB")

    def test_what_fits_the_limit_is_solved(self):
        self.report_of("cornell.gltf", "--quality", "draft", "--max-shots", "1", "--memory-limit",
                       "1.5G")


class Foretold(LimitsTest):
    def time_line(self, *options):
        info = self.run_hemirad("info", SCENES / "cornell.gltf", "--quality", "draft", *options)
        self.assert_done(info)
        return re.search(r"^time +(.*)$", info.stdout, re.M).group(1)

    def test_info_tells_time_and_shots(self):
        line = self.time_line("--patch-size", "0.1")
        self.assertRegex(line, r"^about \d.* m?s for \d+ shots, \d+ of them with a look; \d.* before$")
        report, _ = self.report_of("cornell.gltf", "--quality", "draft", "--patch-size", "0.1")
        told = int(re.search(r"for (\d+) shots", line).group(1))
        self.assertLess(abs(told / report["shots"] - 1), 0.1)

    def test_a_solve_of_a_second_is_not_foretold(self):
        report, told = self.report_of("cornell.gltf", "--quality", "draft", "--patch-size", "0.2")
        self.assertIsNone(report["estimate"]["seconds"])
        self.assertIsNone(report["estimate"]["shots"])
        self.assertNotIn("\ntime ", told)

    def test_nothing_is_foretold_where_that_takes_too_long(self):
        options = ("--resolution", "4096", "--shooter-samples", "4", "--patch-size", "0.5")
        begin = time.monotonic()
        line = self.time_line(*options)
        self.assertLess(time.monotonic() - begin, 30)
        self.assertRegex(line, r"^unknown: to find out takes more than 20 s; \d.* before$")

    def test_info_says_why_it_tells_no_time(self):
        info = self.run_hemirad("info", SCENES / "cornell.gltf", "--target-error", "0.1")
        self.assertRegex(info.stdout, r"\ntime +--target-error")
        self.assertIn("--split", self.time_line("--split", "1"))
        self.assertIn("memory", self.time_line("--memory-limit", "50M"))


class Time(LimitsTest):
    """On a machine that does nothing else."""

    def assert_foretold(self, scene, *options):
        self.report_of(scene, *options, "--max-shots", "1")  # kernels are compiled
        info = self.run_hemirad("info", SCENES / scene, *options)
        told = re.search(r"^time +about ([\d.]+) (ms|s|min) (?:(\d+) s )?for", info.stdout, re.M)
        seconds = float(told.group(1)) * {"ms": 1e-3, "s": 1, "min": 60}[told.group(2)]
        seconds += float(told.group(3) or 0)
        report, _ = self.report_of(scene, *options)
        took = report["seconds"]["solve"]
        print(f"{scene} {' '.join(options)}: {seconds:.2f} s told, {took:.2f} s", file=sys.stderr)
        self.assertLess(abs(seconds - took), max(took / 4, 0.35))  # below a second launches decide

    def test_seconds_are_foretold_within_a_quarter(self):
        for scene in ("cornell.gltf", "furnace.obj", "squares.obj", "lroom.obj", "hall2k.obj",
                      "hall14k.obj"):
            for quality in ("draft", "medium"):
                with self.subTest(scene=scene, quality=quality):
                    self.assert_foretold(scene, "--quality", quality)


class Load(LimitsTest):
    def test_two_million_patches_fit_24_gib(self):
        report, _ = self.report_of("hall14k.obj", "--patch-size", "0.0298", "--quality", "draft",
                                   "--max-shots", "3", "--memory-limit", "24G")
        self.assertGreaterEqual(report["scene"]["patches"], 2_000_000)
        self.assertLess(report["peak_memory_bytes"], 24 << 30)
        print("peak", report["peak_memory_bytes"] / MIB, "MiB, estimated",
              report["estimate"]["memory_bytes"] / MIB, file=sys.stderr)

    def test_a_plane_of_8192_squared_proxels(self):
        report, _ = self.report_of("hall2k.obj", "--resolution", "8192", "--max-shots", "3")
        self.assertEqual(3, report["shots"])
        self.assertEqual(1, report["closure"]["min"])
        self.assertEqual(1, report["closure"]["max"])
        print("peak", report["peak_memory_bytes"] / MIB, "MiB", file=sys.stderr)


class Soak(LimitsTest):
    def test_memory_stays_flat_over_a_million_shots(self):
        subprocess.run([sys.executable, SCENES / "generate.py", self.folder, "furnace", "--rho",
                        "0.98"], check=True)
        command = [HEMIRAD, "solve", "furnace.obj", "-o", "a.exr", "--report", "a.json", "--quiet",
                   "--quality", "draft", "--max-shots", "1000000", "--tolerance", "1e-12"]
        samples = []
        with subprocess.Popen(command, cwd=self.folder) as process:
            while process.poll() is None:
                samples.append(resident_bytes(process.pid))
                time.sleep(0.1)
        self.assertEqual(0, process.returncode)
        report = json.loads((self.folder / "a.json").read_text())
        self.assertGreaterEqual(report["shots"], 1_000_000)
        # Rows are taken as shooters come; by a third of the time each has one.
        solving = [sample for sample in samples[:-2] if sample > 0]
        later = solving[len(solving) // 3:]
        self.assertGreater(len(later), 10)
        self.assertLess(max(later) - min(later), 4 * MIB, later)
        print(f"{report['seconds']['solve']:.0f} s, {min(later) / MIB:.1f} to "
              f"{max(later) / MIB:.1f} MiB", file=sys.stderr)


if __name__ == "__main__":
    unittest.main()
