"""Reads what hemirad writes, to the last number: EXR, CSV, JSON and PNG, without their libraries."""
import array
import csv
import json
import math
import struct
import zlib

ZIP_LINES = 16  # of a ZIP_COMPRESSION block
FLOAT, HALF = 2, 1
CODES = {FLOAT: "f", HALF: "e"}


def _c_string(content, at):
    end = content.index(b"\0", at)
    return content[at:end].decode(), end + 1


def _attributes(content, at):
    found = {}
    while content[at] != 0:
        name, at = _c_string(content, at)
        kind, at = _c_string(content, at)
        size = struct.unpack_from("<i", content, at)[0]
        found[name] = (kind, content[at + 4:at + 4 + size])
        at += 4 + size
    return found, at + 1


def _channels(text):
    found, at = [], 0
    while text[at] != 0:
        name, at = _c_string(text, at)
        found.append((name, struct.unpack_from("<i", text, at)[0]))
        at += 16
    return found


def _unzipped(block, size):
    """OpenEXR's ZIP: bytes as differences to the one before, even ones first."""
    if len(block) == size:
        return block
    raw = bytearray(zlib.decompress(block))
    for i in range(1, len(raw)):
        raw[i] = (raw[i - 1] + raw[i] - 128) & 255
    half = (len(raw) + 1) // 2
    whole = bytearray(len(raw))
    whole[0::2], whole[1::2] = raw[:half], raw[half:]
    return bytes(whole)


def read_exr(path):
    """Channels by name, as lists of all texels; and the attributes of hemirad."""
    content = path.read_bytes()
    assert content[:4] == b"\x76\x2f\x31\x01", path
    attributes, at = _attributes(content, 8)
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"][1])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels = _channels(attributes["channels"][1])
    line = sum(width * struct.calcsize(CODES[kind]) for _, kind in channels)
    values = {name: array.array("d") for name, _ in channels}
    for block in range(-(-height // ZIP_LINES)):
        offset = struct.unpack_from("<Q", content, at + 8 * block)[0]
        first, size = struct.unpack_from("<2i", content, offset)
        lines = min(ZIP_LINES, height - first)
        raw = _unzipped(content[offset + 8:offset + 8 + size], line * lines)
        place = 0
        for _ in range(lines):
            for name, kind in channels:
                values[name].extend(struct.unpack_from(f"<{width}{CODES[kind]}", raw, place))
                place += width * struct.calcsize(CODES[kind])
    texts = {name: (text.decode() if kind == "string" else struct.unpack("<d", text)[0])
             for name, (kind, text) in attributes.items() if name.startswith("hemirad.")}
    return values, texts


def read_faces(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def numbers_of(node, place=""):
    """(place, value) of every number and null of a JSON document."""
    if isinstance(node, dict):
        for key, value in node.items():
            yield from numbers_of(value, f"{place}.{key}")
    elif isinstance(node, list):
        for i, value in enumerate(node):
            yield from numbers_of(value, f"{place}[{i}]")
    elif node is None or isinstance(node, (int, float)):
        yield place, node


def faults_of_exr(path):
    values, texts = read_exr(path)
    numbers = [(name, min(channel), max(channel), sum(channel)) for name, channel in values.items()]
    faults = [f"{path.name}: {name} holds {low} to {high}" for name, low, high, total in numbers
              if not (math.isfinite(total) and low >= 0 and math.isfinite(high))]
    return faults + [f"{path.name}: {name} is {value}" for name, value in texts.items()
                     if isinstance(value, float) and not math.isfinite(value)]


def faults_of_faces(path):
    faults = []
    for row in read_faces(path):
        for name, text in row.items():
            if name in ("object", "material") or text == "":
                continue
            value = float(text)
            if not math.isfinite(value) or (value < 0 and name not in ("cx", "cy", "cz")):
                faults.append(f"{path.name}: {name} of face {row['face']} is {text}")
    return faults


def faults_of_report(path):
    """What is no number becomes null in JSON; only what nobody asked for is null, and what was not
    foretold of a short solve."""
    report = json.loads(path.read_text(), parse_constant=float)
    may_be_null = (".error", ".gather", ".estimate.shots", ".estimate.seconds")
    unfit = [f"{path.name}: {place} is {value}" for place, value in numbers_of(report)
             if place not in may_be_null and (value is None or not math.isfinite(value))]
    return unfit + [f"{path.name}: {place} is {value}" for place, value in numbers_of(report)
                    if isinstance(value, float) and value < 0 and ".ledger" in place]


def faults_of_preview(path):
    return [] if path.read_bytes().startswith(b"\x89PNG\r\n\x1a\n") else [f"{path.name}: no PNG"]


CHECKS = {".exr": faults_of_exr, ".csv": faults_of_faces, ".json": faults_of_report,
          ".png": faults_of_preview}


def faults_of_folder(folder):
    """A line for each value in the folder's results that is no number or out of its range."""
    return [fault for path in sorted(folder.iterdir()) if path.suffix in CHECKS
            for fault in CHECKS[path.suffix](path)]
