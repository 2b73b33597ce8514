"""Makes calls of the program fail, one in each run, and looks at what is left. HEMIRAD names the
binary, INJECT_FAULTS the library that is preloaded (inject_faults.cpp)."""
import dataclasses
import hashlib
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import zlib

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
import scenes  # noqa: E402
from exr import Exr  # noqa: E402

QUICK = ("solve", "scene.obj", "--quiet", "--resolution", "64", "--patch-size", "0.25")
EVERYTHING = (*QUICK, "-o", "a.exr", "--gltf", "a.glb", "--preview", "a.png", "--faces", "a.csv",
              "--report", "r.json", "--checkpoint", "c.ckpt", "--checkpoint-every", "5",
              "--snapshot-every", "5")
# Buffers large enough to be mapped, some of the device's units, and a gather.
LARGE = ("solve", "scene.obj", "--quiet", "--resolution", "2048", "--patch-size", "0.5",
         "--max-shots", "1", "--compute-units", "1", "--gather", "16", "--texel-size", "0.5",
         "-o", "a.exr", "--gltf", "a.gltf")
FACTORS = ("formfactors", "scene.obj", "--quiet", "--resolution", "64", "-o", "f.csv")
INPUTS = {"scene.obj", "scene.mtl"}


class Wrong(Exception):
    pass


@dataclasses.dataclass
class Run:
    code: int
    stderr: str
    stdout: str
    calls: dict  # function -> how often it was called
    failed: int  # calls that were made to fail

    @property
    def last_line(self):
        return self.stderr.splitlines()[-1] if self.stderr else ""


def run(arguments, folder, fail="", error="", callers="", device="", timeout=120, **environment):
    """`fail`: FUNCTION:N[+], `error`: what with, `device`: {number of a question: answer}."""
    calls = pathlib.Path(folder) / "calls.txt"
    answers = ",".join(f"{question:x}={answer}" for question, answer in (device or {}).items())
    variables = {"LD_PRELOAD": os.environ["INJECT_FAULTS"], "HEMI_FAIL": fail,
                 "HEMI_FAIL_WITH": str(error), "HEMI_FAIL_IN": callers, "HEMI_DEVICE": answers,
                 "HEMI_CALLS": str(calls)}
    done = subprocess.run([os.environ["HEMIRAD"], *arguments], cwd=folder, check=False, text=True,
                          capture_output=True, timeout=timeout, errors="replace",
                          env=os.environ | variables | environment)
    lines = [line.split() for line in calls.read_text().splitlines()] if calls.exists() else []
    calls.unlink(missing_ok=True)
    return Run(done.returncode, done.stderr, done.stdout,
               {name: int(count) for name, count, _ in lines},
               sum(int(failed) for _, _, failed in lines))


def write_scene(folder):
    (folder / "scene.mtl").write_text(scenes.MATERIALS)
    (folder / "scene.obj").write_bytes(scenes.obj())


def files(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.name not in INPUTS}


def is_whole(name, content):
    """As far as a file alone tells: interim pictures are whole files, too."""
    if name.endswith(".ckpt"):
        return hashlib.sha256(content[:-64]).hexdigest().encode() == content[-64:]
    if name.endswith(".glb"):
        return int.from_bytes(content[8:12], "little") == len(content)
    if name.endswith(".png"):
        return content[-8:-4] == b"IEND"
    if name.endswith((".json", ".gltf")):
        return bool(json.loads(content))
    return content.endswith(b"\n")  # CSV


def check_files(folder, before):
    """Each older and untouched, or new and whole; no other."""
    for name, content in files(folder).items():
        if name not in before:
            raise Wrong(f"{name} is left")
        if content == before[name]:
            continue
        try:
            if name.endswith(".exr"):
                Exr(folder / name).channels()
            elif not is_whole(name, content):
                raise Wrong(f"{name} is torn")
        except (ValueError, AssertionError, IndexError, zlib.error) as fault:
            raise Wrong(f"{name} is torn: {fault!r}") from fault
    if lost := set(before) - set(files(folder)):
        raise Wrong(f"{lost} are lost")


def check_words(done):
    """One line that says what failed; a solve that came to its end may warn of something."""
    lines = done.stderr.splitlines()
    if done.code == 0 and len(lines) <= 1:
        return
    if len(lines) != 1 and not (len(lines) == 2 and lines[0].startswith("warning: ")):
        raise Wrong(f"{len(lines)} lines: {done.stderr[:500]!r}")
    if len(lines[-1]) < 20 or not lines[-1].isprintable() or ": " not in lines[-1]:
        raise Wrong(f"says nothing: {lines[-1]!r}")


def check(done, folder, before, codes):
    if done.code < 0:
        raise Wrong(f"ended by {signal.Signals(-done.code).name}: {done.stderr[-300:]!r}")
    if done.code not in codes:
        raise Wrong(f"exit code {done.code}: {done.stderr!r}")
    check_words(done)
    check_files(folder, before)
    if done.code == 0 and done.stdout:
        raise Wrong(f"standard output: {done.stdout[:80]!r}")


def put(folder, contents):
    for path in folder.iterdir():
        if path.name not in INPUTS:
            path.unlink()
    for name, content in contents.items():
        (folder / name).write_bytes(content)


def codes_of(function):
    """Exit codes that may follow: 0 where nothing is lost by it, or it is tried again."""
    if re.match("cl[A-Z]", function):
        return {0, 2}
    return {"malloc": {0, 1}, "new": {0, 1, 2}, "read": {0, 1, 3}}.get(function, {0, 1, 3})


def moments(count, most=3):
    """The first call, the last, and some between."""
    if count <= most:
        return list(range(1, count + 1))
    return sorted({1 + (count - 1) * i // (most - 1) for i in range(most)})
