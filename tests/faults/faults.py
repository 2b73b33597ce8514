"""Makes calls of the program fail, one in each run, and looks at what is left. HEMIRAD names the
binary, INJECT_FAULTS the library that is preloaded (inject_faults.cpp)."""
import dataclasses
import errno
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
# Of each kind of output, and of atlases two; one snapshot, kept, and checkpoints on the way.
EACH = (*QUICK, "--max-shots", "5", "--texel-size", "0.125", "--atlas-size", "20",
        "-o", "a.exr", "--gltf", "a.glb", "--preview", "a.png", "--faces", "a.csv",
        "--report", "r.json", "--checkpoint", "c.ckpt", "--checkpoint-every", "2",
        "--snapshot-every", "3", "--keep-snapshots")
# Rows of form factors as large as what is mapped, and no other kernels than the others have.
MAPPED = (*QUICK[:-1], "0.03", "--salvo", "1", "--row-memory", "64", "--compute-units", "1",
          "--max-shots", "2", "-o", "a.exr")
FACTORS = ("formfactors", "scene.obj", "--quiet", "--resolution", "64", "-o", "f.csv")
INPUTS = {"scene.obj", "scene.mtl"}
# What a solve of a few shots says of its picture, whatever else happens.
STOPPED_EARLY = re.compile(r"^warning: .* of the light is still to be shot")
# What a user meets: a disk or quota that is full, a broken one, read-only, forbidden; a signal.
ERRORS = {"open": (errno.EROFS, errno.EACCES, errno.ENOSPC, errno.EMFILE),
          "fopen64": (errno.EMFILE, errno.EACCES),
          "write": ("full", "short", errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EINTR),
          "writev": ("short", errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EINTR),
          "fclose": (errno.EIO, errno.ENOSPC, errno.EDQUOT),
          "fsync": (errno.EIO, errno.ENOSPC, errno.EINTR),
          "linkat": (errno.ENOSPC, errno.EACCES, errno.EROFS, errno.EIO),
          "rename": (errno.EACCES, errno.EROFS, errno.ENOSPC, errno.EIO),
          "read": (errno.EIO,), "flock": (errno.ENOLCK,), "faccessat": (errno.EACCES,),
          "fstat": (errno.EIO,), "close": (errno.EIO,)}
HARMLESS, READING = ("flock", "faccessat", "fstat", "close"), ("read", "fopen64")
ANY = "an output"


class Wrong(Exception):
    pass


@dataclasses.dataclass
class Run:
    code: int
    stderr: str
    stdout: str
    calls: dict  # function -> how often it was called
    failed: int  # calls that were made to fail
    trace: list  # [function, number, what for] of each call, where it was asked for

    @property
    def last_line(self):
        return self.stderr.splitlines()[-1] if self.stderr else ""


def run(arguments, folder, fail="", error="", callers="", device="", timeout=120, traced=False,
        **environment):
    """`fail`: FUNCTION:N[+], `error`: what with, `device`: {number of a question: answer}."""
    calls, trace = (pathlib.Path(folder) / name for name in ("calls.txt", "trace.txt"))
    answers = ",".join(f"{question:x}={answer}" for question, answer in (device or {}).items())
    variables = {"LD_PRELOAD": os.environ["INJECT_FAULTS"], "HEMI_FAIL": fail,
                 "HEMI_FAIL_WITH": str(error), "HEMI_FAIL_IN": callers, "HEMI_DEVICE": answers,
                 "HEMI_CALLS": str(calls), "HEMI_TRACE": str(trace) if traced else ""}
    done = subprocess.run([os.environ["HEMIRAD"], *arguments], cwd=folder, check=False, text=True,
                          capture_output=True, timeout=timeout, errors="replace",
                          env=os.environ | variables | environment)
    lines = [line.split() for line in calls.read_text().splitlines()] if calls.exists() else []
    traces = trace.read_text(errors="replace").splitlines() if traced else []
    calls.unlink(missing_ok=True)
    trace.unlink(missing_ok=True)
    told = "".join(line for line in done.stderr.splitlines(keepends=True)
                   if not STOPPED_EARLY.search(line))
    return Run(done.returncode, told, done.stdout,
               {name: int(count) for name, count, _ in lines},
               sum(int(failed) for _, _, failed in lines),
               [line.split(" ", 2) for line in traces])


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
    """One line that says what failed, after one of snapshots and one of checkpoints; a solve that
    came to its end may warn of something."""
    lines = done.stderr.splitlines()
    if done.code == 0 and len(lines) <= 1:
        return
    if not 1 <= len(lines) <= 3 or not all(line.startswith("warning: ") for line in lines[:-1]):
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


@dataclasses.dataclass
class Call:
    """One of a traced run."""
    function: str
    number: int
    what: str
    target: str = ""  # the output that is written by it
    is_final: bool = False  # written behind the last shot
    is_found: bool = False  # in a folder that is searched for what was left
    written: frozenset = frozenset()  # outputs that have been written before

    def __str__(self):
        return f"{self.function}:{self.number}"


def is_temporary(what):
    return what.startswith("/proc/self/fd/") or pathlib.Path(what).name.startswith(".hemirad-")


def first_of(calls, rename):
    """A file is opened, locked, opened by its name, filled, synced and renamed."""
    filled = max(i for i in range(rename) if calls[i].function == "fopen64" and
                 is_temporary(calls[i].what))
    return max(i for i in range(filled) if calls[i].function == "open")


def with_targets(trace):
    """The calls of a traced run; those between files are for none. Of what is written behind the
    last shot, the checkpoint comes first."""
    calls = [Call(function, int(number), what) for function, number, what in trace]
    renames = [i for i, call in enumerate(calls) if call.function == "rename"]
    names = [pathlib.Path(calls[i].what).name for i in renames]
    first_final = len(names) - 1 - names[::-1].index("c.ckpt")
    for index, (rename, name) in enumerate(zip(renames, names)):
        for call in calls[first_of(calls, rename):rename + 1]:
            call.target, call.is_final = name, index >= first_final
    for index, call in enumerate(calls):
        call.is_found = index > 0 and calls[index - 1].function == "readdir"
        call.written = frozenset(name for i, name in zip(renames, names) if i < index)
    return calls


class Each:
    """Every single call of one solve: `calls`. Files from before are of another solve."""

    def __init__(self, arguments, folder, **environment):
        self.arguments, self.folder, self.environment = arguments, folder, environment
        put(folder, {})
        self.run_whole(["0.5" if one == "0.25" else one for one in arguments])
        self.before = files(folder)
        self.run_whole(arguments)  # its kernels are compiled then
        put(folder, self.before)
        self.calls = with_targets(self.run_whole(arguments, traced=True).trace)
        self.whole = files(folder)
        if equal := [name for name, content in self.whole.items()
                     if content == self.before[name] and not name.endswith(".png")]:
            raise Wrong(f"{equal} do not tell whether they are new")

    def run_whole(self, arguments, **options):
        done = run(arguments, self.folder, **options, **self.environment)
        if (done.code, done.stderr) != (0, ""):
            raise Wrong(f"{done.code}: {done.stderr}")
        return done

    def arguments_of_kernels(self):
        """The first call of each argument of each kernel."""
        calls = [call for call in self.calls if call.function == "clSetKernelArg"]
        return list({call.what: call for call in reversed(calls)}.values())[::-1]

    def check_argument(self, call):
        put(self.folder, self.before)
        done = run(self.arguments, self.folder, str(call), **self.environment)
        check(done, self.folder, self.before, {2})
        # Where a gather fails, the lightmap of the patches is written: the solve was the longer part.
        if not self.is_gathering(call):
            self.check_older(call.written)

    def is_gathering(self, call):
        """Behind the checkpoint of the solve's end."""
        last = max(i for i, other in enumerate(self.calls)
                   if other.function == "rename" and other.target == "c.ckpt")
        return self.calls.index(call) > last

    def check_file(self, call, error):
        """The exit code, one line that names the file, and every file the one that it has to be."""
        # Of a file that cannot be opened without name, one with a name is tried; a disk that takes
        # half of what it is to write is asked again.
        stays = error == "full" or (call.function == "open" and not self.environment)
        put(self.folder, self.before)
        done = run(self.arguments, self.folder, f"{call}{'+' * stays}",
                   "short" if error == "full" else error, **self.environment)
        if done.failed == 0:
            raise Wrong("was not called")
        code, name = self.fate_of(call, error, stays)
        check(done, self.folder, self.before, {code})
        self.check_name(done, name)
        if code == 0:
            self.check_newer(self.whole)
        elif code == 3 and call.target == name:  # which leaves the others to be written
            self.check_newer(set(self.whole) - self.left_with(name))
        else:
            self.check_older(call.written)
        if call.target == name and code == 3 and self.holds(self.whole, name):
            raise Wrong(f"{name} was written all the same")

    def left_with(self, name):
        """Pictures and previews of all atlases are one output; a report tells of all."""
        pictures = {other for other in self.whole if other.endswith((".exr", ".png"))}
        return {name, "r.json"} | (pictures if name in pictures else set())

    def fate_of(self, call, error, stays):
        """The exit code, and which file is told of: ANY, or none."""
        if stays:
            more = any(other.target and other.number >= call.number for other in self.calls
                       if other.function == call.function)
            return (3, ANY) if more else (0, "")
        if call.function in READING and not is_temporary(call.what):
            return self.fate_of_reading(call)
        if call.function == "open" and is_temporary(call.what) and not call.target:
            return (0, "") if call.is_found else (3, ANY)  # before the work begins
        if not call.target or error in (errno.EINTR, "short") or call.function in HARMLESS:
            return 0, ""
        return 3 if call.is_final else 0, call.target

    def fate_of_reading(self, call):
        name = pathlib.Path(call.what).name
        if name == "c.ckpt":  # which is asked whether it is one, and at last what is in it
            last = max(i for i, other in enumerate(self.calls)
                       if other.function == "fopen64" and other.what.endswith(name))
            return (1, name) if self.calls.index(call) < last else (0, "")
        if name in INPUTS:
            return 1, name
        return (3, name) if name in self.whole else (0, "")

    def check_name(self, done, name):
        if not name and done.stderr:
            raise Wrong(f"says {done.stderr!r}")
        names = self.whole if name == ANY else [name] if name else []
        if names and not any(f"{one}: " in done.last_line for one in names):
            raise Wrong(f"does not name {name}: {done.stderr!r}")

    def holds(self, contents, name):
        return (self.folder / name).read_bytes() == contents[name]

    def check_newer(self, names):
        """The report has times, and a kept snapshot may be what was not written."""
        for name in set(names) - {"r.json"}:
            if not (self.holds(self.whole, name) or re.search(r"-\d+\.exr", name)):
                raise Wrong(f"{name} is not what it is to be")

    def check_older(self, written):
        for name in set(self.before) - written:
            if not self.holds(self.before, name):
                raise Wrong(f"{name} is not as it was")
