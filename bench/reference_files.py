"""Reads what `fluxel reference` writes: elements with layers (PLY) and layered pictures (OpenEXR, ZIP)."""

import itertools
import struct
import zlib

from solution import layer, read_faces


def read_elements(file):
    """A list of {"corners": [(x, y, z)], "patch": k, "radiosity": (r, g, b), "error": ...}, one an element."""
    return [{"corners": face["corners"], "patch": face["patch"],
             **{name[:-2]: layer(face, name[:-2]) for name in face if name.endswith("_r")}}
            for face in read_faces(file)]


def texts(data, place):
    end = data.index(b"\0", place)
    return data[place:end].decode(), end + 1


def read_exr(file):
    """{channel: [row of values, from the top]}; values are floats or whole numbers of four bytes."""
    data = file.read_bytes()
    assert data[:4] == b"\x76\x2f\x31\x01"
    place, attributes = 8, {}
    while data[place]:
        name, place = texts(data, place)
        _, place = texts(data, place)
        (size,) = struct.unpack_from("<i", data, place)
        attributes[name], place = data[place + 4:place + 4 + size], place + 4 + size
    place += 1
    channels, at = [], 0
    while attributes["channels"][at]:
        name, at = texts(attributes["channels"], at)
        channels.append((name, {0: "I", 2: "f"}[struct.unpack_from("<i", attributes["channels"], at)[0]]))
        at += 16
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    assert attributes["compression"] == b"\x03", "not ZIP"
    width, height = x1 - x0 + 1, y1 - y0 + 1
    rows = {name: [] for name, _ in channels}
    place += 8 * -(-height // 16)
    for first in range(0, height, 16):
        (size,) = struct.unpack_from("<i", data, place + 4)
        lines = min(16, height - first)
        raw = unpacked(data[place + 8:place + 8 + size], 4 * width * len(channels) * lines)
        place += 8 + size
        for line in range(lines):
            for k, (name, kind) in enumerate(channels):
                at = 4 * width * (line * len(channels) + k)
                rows[name].append(struct.unpack_from(f"<{width}{kind}", raw, at))
    return rows


def unpacked(block, size):
    """A block of OpenEXR's ZIP: differences of bytes, those at even places first; as it is where that is shorter."""
    if len(block) == size:
        return block
    steps = itertools.accumulate(zlib.decompress(block), lambda before, step: (before + step - 128) & 255)
    halves = bytes(steps)
    raw = bytearray(size)
    raw[0::2], raw[1::2] = halves[:(size + 1) // 2], halves[(size + 1) // 2:]
    return bytes(raw)
