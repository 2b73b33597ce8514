"""Scanline OpenEXR files of ours, read by the format's description (openexr.com): no or ZIP
compression, half and float channels."""
import itertools
import pathlib
import struct
import zlib

LINES_A_BLOCK = {0: 1, 2: 1, 3: 16}  # none, ZIPS, ZIP
TYPES = {1: "e", 2: "f"}


class Exr:
    def __init__(self, path):
        self.bytes = pathlib.Path(path).read_bytes()
        assert self.bytes[:4] == b"\x76\x2f\x31\x01", path
        self.at = 8
        self.attributes = dict(self._attributes())
        left, top, right, bottom = struct.unpack("<4i", self.attributes["dataWindow"])
        self.width, self.height = right - left + 1, bottom - top + 1
        self.types = dict(self._channels(self.attributes["channels"]))

    def _text(self):
        end = self.bytes.index(b"\0", self.at)
        text, self.at = self.bytes[self.at:end].decode(), end + 1
        return text

    def _attributes(self):
        while name := self._text():
            self._text()  # its type
            size, = struct.unpack_from("<i", self.bytes, self.at)
            yield name, self.bytes[self.at + 4:self.at + 4 + size]
            self.at += 4 + size

    @staticmethod
    def _channels(listed):
        while listed[0]:
            name, rest = listed.split(b"\0", 1)
            yield name.decode(), TYPES[struct.unpack_from("<i", rest)[0]]
            listed = rest[16:]

    def text(self, name):
        return self.attributes["hemirad." + name].decode()

    def channels(self):
        """Name -> values, row by row from the top."""
        values = {name: [] for name in self.types}
        lines = LINES_A_BLOCK[self.attributes["compression"][0]]
        blocks = -(-self.height // lines)
        for offset in struct.unpack_from(f"<{blocks}Q", self.bytes, self.at):
            first, size = struct.unpack_from("<2i", self.bytes, offset)
            block = self._unpacked(self.bytes[offset + 8:offset + 8 + size],
                                   min(lines, self.height - first))
            at = 0
            for _ in range(min(lines, self.height - first)):
                for name, kind in self.types.items():
                    values[name].extend(struct.unpack_from(f"<{self.width}{kind}", block, at))
                    at += struct.calcsize(kind) * self.width
        return values

    def _unpacked(self, block, lines):
        size = lines * self.width * sum(map(struct.calcsize, self.types.values()))
        if len(block) == size:
            return block
        deltas = zlib.decompress(block)
        parted = bytes(itertools.accumulate(deltas, lambda a, d: (a + d - 128) & 255))
        middle = (size + 1) // 2
        result = bytearray(size)
        result[0::2], result[1::2] = parted[:middle], parted[middle:]
        return bytes(result)
