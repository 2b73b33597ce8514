#!/usr/bin/env python3
"""The layers of CONTRIBUTING.md, checked in the source text.

Who may include whom, and who may name OpenCL and OpenEXR: rules a compiler does not know.
"""
import pathlib
import re
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("src", "mp1map", "kernels", "tools", "tests")
SUFFIXES = {".h", ".cpp", ".cl", ".clh"}

# Pattern of a line -> the files in which it may stand.
NAMES = {
    r"CL/\w*cl\w*\.h": r"mp1map/opencl\.h",
    r"\bcl::|\bcl_\w+\b|\bCL_[A-Z]\w+": r"mp1map/.*",
    r"\bImf::|OpenEXR/": r"src/lightmap/[^/]*exr[^/]*|tools/exr_diff\.cpp|tests/.*exr.*",
    r"embree3/|\brtc[A-Z]|\bRTC": r"src/reference/embree/.*|tools/packet_caster\.cpp",
    r"CLI/CLI\.hpp": r"src/cli/(options\.cpp|command_line\.h)|tools/.*",
    r"enqueueNDRangeKernel": r"mp1map/acu\.cpp",
}

# Files -> what their quoted includes may name. The first row that fits counts.
INCLUDES = [
    (r"mp1map/.*\.clh", r"(mp1map/)?\w+\.clh"),
    (r"mp1map/.*", r"mp1map/.*"),
    (r"kernels/shared\.h", r"(?!)"),
    (r"kernels/.*", r"(kernels/)?(\w+\.clh|shared\.h)|mp1map/\w+\.clh"),
    (r"src/errors\.h", r"(?!)"),
    (r"src/scene/.*", r"scene/.*|errors\.h"),
    (r"src/formfactor/.*", r"formfactor/.*|scene/.*|errors\.h"),
    (r"src/reference/.*", r"reference/.*|scene/.*|errors\.h"),
    (r"src/lightmap/.*", r"lightmap/.*|scene/.*|solver/solution\.h|errors\.h"),
    (r"src/view/.*", r"(view|lightmap|scene)/.*|errors\.h"),
    (r"src/solver/.*", r"(solver|formfactor|scene)/.*|mp1map/\w+\.h|kernels/shared\.h|errors\.h"),
    (r"src/cli/tradeoff.*",
     r"(cli|solver|lightmap|formfactor|scene|reference)/.*|mp1map/(device|pe_array)\.h|errors\.h"),
    (r"src/cli/.*|src/main\.cpp",
     r"(cli|solver|view|lightmap|formfactor|scene)/.*|mp1map/(device|pe_array)\.h|errors\.h"),
    (r"src/.*", r"(?!)"),
]


def sources(root):
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in SUFFIXES:
                yield path.relative_to(root).as_posix(), path.read_text(encoding="utf-8")


def code_lines(text):
    """Lines with their comments taken out; a name in a comment does no harm."""
    text = re.sub(r"/\*.*?\*/", lambda m: "\n" * m.group().count("\n"), text, flags=re.S)
    for number, line in enumerate(text.split("\n"), 1):
        yield number, re.sub(r"//.*", "", line)


def stray_names(root):
    for file, text in sources(root):
        for number, line in code_lines(text):
            for pattern, where in NAMES.items():
                if re.search(pattern, line) and not re.fullmatch(where, file):
                    yield f"{file}:{number}: belongs into {where}: {line.strip()}"


def stray_includes(root):
    kernel_headers = {p.name for p in (root / "kernels").glob("*")}
    for file, text in sources(root):
        allowed = next((a for pattern, a in INCLUDES if re.fullmatch(pattern, file)), r".*")
        for number, line in code_lines(text):
            found = re.match(r'\s*#\s*include\s*"([^"]+)"', line)
            if not found:
                continue
            of_kernels = file.startswith("mp1map/") and found[1] in kernel_headers
            if of_kernels or not re.fullmatch(allowed, found[1]):
                yield f"{file}:{number}: may not include {found[1]}"


def launches(root):
    return [file for file, text in sources(root) for _, line in code_lines(text)
            if "enqueueNDRangeKernel" in line]


class Layers(unittest.TestCase):
    def test_libraries_are_named_in_their_own_layer_only(self):
        self.assertEqual([], list(stray_names(ROOT)))

    def test_includes_follow_the_arrows(self):
        self.assertEqual([], list(stray_includes(ROOT)))

    def test_one_line_launches_kernels(self):
        self.assertEqual(["mp1map/acu.cpp"], launches(ROOT))

    def test_there_is_something_to_check(self):
        self.assertGreater(len(list(sources(ROOT))), 50)


class TheRulesThemselves(unittest.TestCase):
    def breaches(self, file, text, rule):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "kernels").mkdir()
            (root / "kernels/clip.clh").write_text("")
            (root / file).parent.mkdir(parents=True, exist_ok=True)
            (root / file).write_text(text)
            return list(rule(root))

    def test_notice_names_out_of_place(self):
        for file, line in [
            ("src/solver/a.cpp", "cl::Buffer buffer;"),
            ("src/solver/a.cpp", "#include <CL/cl.h>"),
            ("mp1map/acu.h", "#include <CL/opencl.hpp>"),
            ("src/cli/a.cpp", "const int e = CL_SUCCESS;"),
            ("src/lightmap/rasterize.cpp", "Imf::FrameBuffer buffer;"),
            ("src/reference/ray_caster.cpp", "RTCScene scene;"),
            ("src/cli/view.cpp", "#include <CLI/CLI.hpp>"),
            ("mp1map/device.cpp", "queue.enqueueNDRangeKernel(kernel);"),
        ]:
            self.assertTrue(self.breaches(file, line, stray_names), (file, line))

    def test_notice_includes_against_the_arrows(self):
        for file, name in [
            ("src/scene/a.cpp", "solver/solver.h"),
            ("src/lightmap/a.cpp", "solver/solver.h"),
            ("src/solver/a.cpp", "lightmap/lightmap.h"),
            ("src/cli/a.cpp", "mp1map/acu.h"),
            ("src/cli/a.cpp", "reference/projector.h"),
            ("mp1map/a.cpp", "scene/scene.h"),
            ("mp1map/a.clh", "clip.clh"),
            ("kernels/shared.h", "clip.clh"),
        ]:
            self.assertTrue(self.breaches(file, f'#include "{name}"\n', stray_includes),
                            (file, name))

    def test_let_comments_be(self):
        self.assertEqual([], self.breaches("src/cli/a.cpp", "// not cl::Buffer\n", stray_names))


if __name__ == "__main__":
    unittest.main()
