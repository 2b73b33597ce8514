#!/usr/bin/env python3
"""Calls that fail, devices that vanish or are small: exit codes, messages, files. HEMIRAD and
INJECT_FAULTS as in faults.py."""
import json
import pathlib
import re
import sys
import tempfile
import unittest

import faults

# Numbers of clGetDeviceInfo's questions.
TYPE, GROUP, ALLOCATION, LOCAL = 0x1000, 0x1004, 0x1010, 0x1023
AVAILABLE, COMPILER, VERSION, EXTENSIONS = 0x1027, 0x1028, 0x102F, 0x1030
GPU = 4


class Faults(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        faults.write_scene(self.folder)

    def run_whole(self, arguments, **options):
        done = faults.run(arguments, self.folder, **options)
        self.assertEqual((0, ""), (done.code, done.stderr))
        return done

    def assert_harmless(self, arguments, before, function, fail, codes=None, **options):
        """Whatever fails, there is one line, and files are the older or the newer ones."""
        faults.put(self.folder, before)
        with self.subTest(fail, **options):
            done = faults.run(arguments, self.folder, fail, **options)
            self.assertGreater(done.failed, 0, "was not called")
            faults.check(done, self.folder, before, codes or faults.codes_of(function))
        return done


class Injected(Faults):
    def test_every_call_of_a_device_may_fail_for_ever(self):
        whole = self.run_whole(faults.EVERYTHING)
        before = faults.files(self.folder)
        names = [name for name in whole.calls if re.match("cl(?!Release)[A-Z]", name)]
        self.assertGreater(len(names), 15)
        for name in names:
            self.assert_harmless(faults.EVERYTHING, before, name, name + ":1+", {2})

    def test_only_what_is_timed_is_waited_for(self):
        """What is read is waited for anyway; seconds are foretold, too."""
        arguments = [argument for argument in faults.QUICK if argument != "--quiet"]
        done = faults.run(arguments, self.folder)
        self.assertEqual((0, 0), (done.code, done.calls.get("clFinish", 0)))
        done = faults.run([*arguments, "--report", "r.json"], self.folder)
        self.assertGreater(done.calls["clFinish"], 0)

    def test_every_call_for_a_file_may_fail(self):
        closed = self.run_whole(faults.QUICK).calls["fclose"]  # the last of which is written
        before = faults.files(self.folder)
        for fail in ("open:1+", "write:1", "fsync:1", "linkat:1", "rename:1", f"fclose:{closed}"):
            self.assert_harmless(faults.QUICK, before, "file", fail, {3})
        for fail in ("flock:1+", "faccessat:1+", "open:1"):  # there is another way
            self.assert_harmless(faults.QUICK, before, "file", fail, {0})
        self.assert_harmless(faults.QUICK, before, "write", "write:1+", {3}, error="short")

    def test_a_disk_that_stays_full_is_told_once_for_the_checkpoint_and_once_for_the_rest(self):
        self.run_whole(faults.EVERYTHING)
        before = faults.files(self.folder)
        self.assert_harmless(faults.EVERYTHING, before, "write", "write:1+", {3}, error="short")

    def test_what_was_solved_is_written_where_a_second_solution_fails(self):
        solve = ("solve", "scene.obj", "--quiet", "--patch-size", "0.25", "-o", "a.exr")
        for second in (("--resolution", "64", "--estimate-error"), ("--target-error", "0.05")):
            with self.subTest(second):
                faults.put(self.folder, {})
                done = faults.run((*solve, *second), self.folder, "clBuildProgram:2+", -6)
                self.assertEqual((2, 1), (done.code, done.stderr.count("\n")), done.stderr)
                self.assertTrue((self.folder / "a.exr").exists())

    def test_interrupted_calls_are_repeated(self):
        self.run_whole(faults.QUICK)
        before = faults.files(self.folder)
        for name in ("write", "fsync"):
            self.assert_harmless(faults.QUICK, before, name, name + ":1", {0}, error=4)

    def test_each_output_may_be_the_one_that_fails(self):
        """When it is written last, at one call and with one error after the other."""
        each = faults.Each(faults.EACH, self.folder)
        kinds = ("write", "rename", "fclose", "linkat", "fsync", "writev")
        last = {(call.target, call.function): call for call in each.calls if call.target}
        targets = sorted({target for target, _ in last})
        self.assertEqual(10, len(targets))
        for index, target in enumerate(targets):
            function = next(kind for kind in (*kinds[index % 5:], *kinds) if (target, kind) in last)
            error = faults.ERRORS[function][index // 5]
            with self.subTest(target, function=function, error=error):
                each.check_file(last[target, function], error)
        reads = {pathlib.Path(call.what).name: call for call in reversed(each.calls)
                 if call.function == "read"}
        for name in ("scene.obj", "scene.mtl", "a.exr", "c.ckpt"):
            with self.subTest("read", name=name):
                each.check_file(reads[name], 5)

    def test_a_snapshot_that_cannot_be_written_is_told_once_and_ends_no_solve(self):
        arguments = (*faults.QUICK, "-o", "a.exr", "--report", "r.json", "--snapshot-every", "2")
        self.run_whole(arguments)
        whole = (self.folder / "a.exr").read_bytes()
        warning = "a.exr: No space left on device; the solve goes on, and the next snapshot is tried"

        done = faults.run(arguments, self.folder, "rename:1", 28)
        self.assertEqual((0, f"warning: {warning}\n"), (done.code, done.stderr))
        self.assertEqual(whole, (self.folder / "a.exr").read_bytes())
        report = json.loads((self.folder / "r.json").read_text())
        self.assertEqual([warning], report["warnings"])

        faults.put(self.folder, {})
        done = faults.run(arguments, self.folder, "rename:1+", 28)
        self.assertEqual(3, done.code)
        self.assertEqual([f"warning: {warning}", "a.exr: No space left on device"],
                         done.stderr.splitlines())
        self.assertEqual({}, faults.files(self.folder))

    def test_a_checkpoint_that_cannot_be_read_to_its_end_is_told(self):
        self.run_whole(faults.EACH)
        arguments = (*faults.EACH, "--resume", "c.ckpt")
        trace = self.run_whole(arguments, traced=True).trace
        before = faults.files(self.folder)
        for number in (number for function, number, what in trace
                       if function == "read" and what.endswith("/c.ckpt")):
            done = self.assert_harmless(arguments, before, "read", f"read:{number}", {1}, error=5)
            self.assertTrue(done.stderr.startswith("c.ckpt: cannot be read"), done.stderr)

    def test_an_output_that_cannot_be_asked_for_is_tried(self):
        """Whether it is another's, or a pipe: where a folder may not be looked into, for one."""
        arguments = (*faults.QUICK, "-o", "a.exr")
        self.run_whole(arguments)
        trace = self.run_whole(arguments, traced=True).trace
        before = faults.files(self.folder)
        for name in ("stat", "realpath"):
            number = next(number for function, number, what in trace
                          if function == name and what.endswith("/a.exr"))
            self.assert_harmless(arguments, before, name, f"{name}:{number}", {0}, error=13)

    def test_a_part_of_a_device_and_mapped_memory_may_be_refused(self):
        whole = self.run_whole(faults.MAPPED)
        before = faults.files(self.folder)
        for name in ("clCreateSubDevices", "clEnqueueMapBuffer", "clEnqueueUnmapMemObject"):
            last = f"{name}:{whole.calls[name]}"
            self.assert_harmless(faults.MAPPED, before, name, last, {2})

    def test_memory_may_be_out(self):
        """The report's JSON asks for memory when it is taken apart, too."""
        arguments = (*faults.QUICK, "--report", "r.json")
        # How many passes are sent off between two looks is the clock's to say.
        allocations = min(self.run_whole(arguments).calls["new"] for _ in range(4)) - 10
        before = faults.files(self.folder)
        late = (allocations - i for i in range(3, 60, 10))
        for fail in ("new:1", "new:2000", "new:2000+", *(f"new:{number}" for number in late)):
            self.assert_harmless(arguments, before, "new", fail, {1})

    def test_the_program_calls_nothing_newer_than_opencl_1_2(self):
        binary = pathlib.Path(faults.os.environ["HEMIRAD"]).read_bytes()
        self.assertNotEqual([], re.findall(rb"OPENCL_1\.\d", binary))
        self.assertEqual([], re.findall(rb"OPENCL_[2-9]\.\d", binary))


class Vanished(Faults):
    def test_device_leaves_files_and_a_checkpoint_to_go_on_from(self):
        self.run_whole(faults.EVERYTHING)
        whole = faults.files(self.folder)
        for name in ("clFinish", "clEnqueueReadBuffer", "clEnqueueNDRangeKernel"):
            with self.subTest(name):
                self.check_vanishing(name, whole)

    def check_vanishing(self, name, whole):
        before = {file: content for file, content in whole.items() if file != "c.ckpt"}
        faults.put(self.folder, before)
        arguments = [*faults.EVERYTHING, "--checkpoint-every", "1"]
        arguments = [a for a in arguments if a not in ("--snapshot-every", "5")]
        arguments.remove("--checkpoint-every")
        moment = {"clFinish": 2, "clEnqueueReadBuffer": 60, "clEnqueueNDRangeKernel": 400}[name]

        done = faults.run(arguments, self.folder, f"{name}:{moment}+")

        self.assertEqual((2, 1), (done.code, done.stderr.count("\n")), done.stderr)
        self.assertIn("out of resources", done.stderr)
        left = faults.files(self.folder)
        self.assertTrue(faults.is_whole("c.ckpt", left.pop("c.ckpt")))
        self.assertEqual(before, left)
        self.run_whole([*faults.EVERYTHING, "--resume", "c.ckpt"])
        for file in ("a.exr", "a.csv", "a.glb", "a.png"):
            self.assertEqual(whole[file], (self.folder / file).read_bytes(), file)


class SmallDevices(Faults):
    def picture_on(self, device, *arguments, **environment):
        self.run_whole((*faults.QUICK, "-o", "a.exr", *arguments), device=device, **environment)
        return (self.folder / "a.exr").read_bytes()

    def test_give_the_same_bytes(self):
        whole = self.picture_on({})
        for device in ({LOCAL: 32768, ALLOCATION: 128 << 20, GROUP: 64, EXTENSIONS: ""},
                       {TYPE: GPU, GROUP: 1024, LOCAL: 32768}):
            with self.subTest(device):
                self.assertEqual(whole, self.picture_on(device))
        with self.subTest("limits of PoCL"):
            self.assertEqual(whole, self.picture_on({}, POCL_MAX_WORK_GROUP_SIZE="64",
                                                    POCL_MEMORY_LIMIT="1",
                                                    POCL_MAX_PTHREAD_COUNT="1"))

    def test_say_what_is_missing(self):
        for device, says in (({VERSION: "OpenCL 1.1 old"}, "is of OpenCL 1.1 old; it takes 1.2"),
                             ({COMPILER: 0}, "has no compiler"),
                             ({AVAILABLE: 0}, "is not available"),
                             ({GROUP: 1}, "takes 1 work-items a group; it takes 64"),
                             ({GROUP: 16}, "takes 16 work-items a group; it takes 64")):
            with self.subTest(says):
                done = faults.run(faults.QUICK, self.folder, device=device)
                self.assertEqual((2, 1), (done.code, done.stderr.count("\n")), done.stderr)
                self.assertIn(says, done.stderr)
                self.assertEqual({}, faults.files(self.folder))
                listed = faults.run(["devices"], self.folder, device=device)
                self.assertEqual((0, ""), (listed.code, listed.stderr))
                self.assertIn("none: the device " + says, listed.stdout)

    def test_tell_of_too_little_local_memory(self):
        done = faults.run(faults.QUICK, self.folder, device={LOCAL: 8192})
        self.assertEqual((1, 1), (done.code, done.stderr.count("\n")), done.stderr)
        self.assertIn("bytes of local memory", done.stderr)

    def test_what_a_device_cannot_hold_is_told(self):
        for call, error, says in (("clCreateBuffer:5", -4, "out of memory"),
                                  ("clCreateBuffer:5", -61, "out of memory for one buffer"),
                                  ("clEnqueueNDRangeKernel:9", -4, "out of memory"),
                                  ("clEnqueueNDRangeKernel:1", -54, "lower --pe"),
                                  ("clBuildProgram:1", -11, "do not compile"),
                                  ("clBuildProgram:1", -6, "out of memory"),
                                  ("clCreateKernel:2", -6, "kernel ")):
            with self.subTest(call, error=error):
                done = faults.run(faults.QUICK, self.folder, call, error)
                self.assertEqual((2, 1), (done.code, done.stderr.count("\n")), done.stderr)
                self.assertIn(says, done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
