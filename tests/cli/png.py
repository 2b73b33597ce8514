"""PNGs of ours, read by the format's description: 8 bits a channel, red, green and blue."""
import struct
import zlib


def read_png(data):
    """As rows of (r, g, b)."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    width, height, depth, kind = struct.unpack_from(">IIBB", data, 16)
    assert (depth, kind) == (8, 2)
    at, packed = 8, b""
    while at < len(data):
        length, = struct.unpack_from(">I", data, at)
        if data[at + 4:at + 8] == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    return unfiltered(zlib.decompress(packed), width, height)


def unfiltered(raw, width, height):
    rows, above, stride = [], bytes(3 * width), 3 * width + 1
    for y in range(height):
        kind, line = raw[y * stride], bytearray(raw[y * stride + 1:(y + 1) * stride])
        for i in range(len(line)):
            left, up = (line[i - 3] if i >= 3 else 0), above[i]
            corner = above[i - 3] if i >= 3 else 0
            line[i] = (line[i] + (0, left, up, (left + up) // 2,
                                  paeth(left, up, corner))[kind]) & 255
        rows.append([tuple(line[i:i + 3]) for i in range(0, len(line), 3)])
        above = bytes(line)
    return rows


def paeth(left, up, corner):
    guess = left + up - corner
    return min((left, up, corner), key=lambda value: abs(guess - value))
