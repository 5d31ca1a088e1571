"""Pictures with layers: image.exr, reference.exr, receiver-NAME.exr."""

from __future__ import annotations

import os
import struct
import zlib
from dataclasses import dataclass

import numpy as np

from .cursor import Cursor

MAGIC = b"\x76\x2f\x31\x01"
TYPES = ("<u4", "<f2", "<f4")  # by their numbers in OpenEXR
# Of its compressions those that differ in the rows of a block only: name, rows.
COMPRESSIONS = {0: 1, 2: 1, 3: 16}  # none, ZIPS, ZIP
NAMES = ("none", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB")
DENSEST = 1100  # bytes that ZIP can put into one, at most, with room to spare
LETTERS = ("RGB", "XYZ")


@dataclass
class Picture:
    """
    channels: name, as "R", "error.R" or "depth.Z" -> (rows, columns) float32 (float16 or uint32 where the file has it so);
        row 0 is the top one
    attributes: name -> text: the run's options, units, versions and times, under names that begin with "fluxel."
    """

    channels: dict[str, np.ndarray]
    attributes: dict[str, str]

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return next(iter(self.channels.values())).shape

    @property
    def layers(self) -> list[str]:
        """Names of the layers; "" is the main one, of the channels R, G, B."""
        return sorted({name.rpartition(".")[0] for name in self.channels})

    def __getitem__(self, layer: str) -> np.ndarray:
        """(rows, columns, 3) of a layer with the channels R, G, B or X, Y, Z, "" being the main one; (rows, columns) of one
        with a single channel, as "depth" [m] and "element". Raises KeyError where there is no such layer."""
        prefix = f"{layer}." if layer else ""
        for letters in LETTERS:
            if all(prefix + letter in self.channels for letter in letters):
                return np.stack([self.channels[prefix + letter] for letter in letters], axis=-1)
        alone = [name for name in self.channels if name.rpartition(".")[0] == layer]
        if len(alone) != 1:
            raise KeyError(layer)
        return self.channels[alone[0]]

    @property
    def values(self) -> np.ndarray:
        """(rows, columns, 3): radiance [W/(m2 sr)], of receivers irradiance [W/m2]; photometric where the scene is."""
        return self[""]

    @property
    def error(self) -> np.ndarray:
        """(rows, columns, 3): standard errors of a reference, estimated errors of a receiver. Raises KeyError where the
        picture has none."""
        return self["error"]


def read_picture(file: str | os.PathLike[str]) -> Picture:
    """Reads an OpenEXR file as Fluxel writes it: scan lines, without compression or by ZIP, half, float or whole numbers.
    Raises FormatError where it is another, damaged, or ends too early."""
    cursor = Cursor.of_file(file)
    if cursor.data[:4] != MAGIC:
        raise cursor.fail("is no OpenEXR file")
    cursor.place = 4
    (version,) = cursor.unpack("<I", "its header")
    if version & 0x1A00:  # tiles, deep pixels, several parts
        raise cursor.fail("is an OpenEXR file of tiles, of several parts or of deep pixels, which is not read")
    header = _read_attributes(cursor)
    types = _read_channel_list(cursor, header)
    x0, y0, x1, y1 = struct.unpack("<4i", _attribute(cursor, header, "dataWindow", 16))
    columns, rows = x1 - x0 + 1, y1 - y0 + 1
    (compression,) = _attribute(cursor, header, "compression", 1)
    if compression not in COMPRESSIONS:
        name = NAMES[compression] if compression < len(NAMES) else compression
        raise cursor.fail(f"is compressed by {name}; none, ZIPS and ZIP are read")
    if min(columns, rows) < 1:
        raise cursor.fail(f"has {columns} x {rows} pixels")
    if rows * columns * sum(np.dtype(kind).itemsize for kind in types.values()) > DENSEST * len(cursor.data):
        raise cursor.fail(f"has fewer bytes than {columns} x {rows} pixels can have")
    row = np.dtype([(name, kind, (columns,)) for name, kind in types.items()])
    lines = COMPRESSIONS[compression]
    blocks = cursor.array("<u8", -(-rows // lines), "its table of blocks")
    pixels = np.empty(rows, row)
    for place in blocks:
        cursor.place = int(place)
        y, size = cursor.unpack("<ii", "a block of pixels")
        first = y - y0
        if not 0 <= first < rows or first % lines:
            raise cursor.fail(f"a block has the row {y}, which is none of its picture")
        count = min(lines, rows - first)
        block = cursor.take(size, f"the block of row {y}")
        pixels[first:first + count] = np.frombuffer(_unpacked(cursor, block, count * row.itemsize), row)
    texts = {name: value.decode("utf-8", "replace") for name, (kind, value) in header.items() if kind == "string"}
    return Picture({name: np.ascontiguousarray(pixels[name]) for name in types}, texts)


def _read_attributes(cursor: Cursor) -> dict[str, tuple[str, bytes]]:
    """Name -> type and value."""
    found = {}
    while name := cursor.text(b"\0", "its header"):
        kind = cursor.text(b"\0", "its header")
        (size,) = cursor.unpack("<i", "its header")
        found[name] = kind, cursor.take(size, f"the attribute {name}")
    return found


def _attribute(cursor: Cursor, header: dict[str, tuple[str, bytes]], name: str, size: int) -> bytes:
    _, value = header.get(name, ("", b""))
    if len(value) != size:
        raise cursor.fail(f"its attribute {name} is missing or damaged")
    return value


def _read_channel_list(cursor: Cursor, header: dict[str, tuple[str, bytes]]) -> dict[str, str]:
    """Name -> type, in the order of the file."""
    channels = Cursor(cursor.file, header.get("channels", ("", b""))[1])
    types = {}
    while name := channels.text(b"\0", "its list of channels"):
        kind, _, across, down = channels.unpack("<iIii", "its list of channels")
        if not 0 <= kind < len(TYPES) or (across, down) != (1, 1):
            raise cursor.fail(f"its channel {name} is of another type, or not there for every pixel")
        types[name] = TYPES[kind]
    if not types:
        raise cursor.fail("has no channels")
    return types


def _unpacked(cursor: Cursor, block: bytes, size: int) -> bytes:
    """A block of OpenEXR's ZIP: differences of bytes plus 128, those at even places first; as it is where that is shorter."""
    if len(block) == size:
        return block
    try:
        packed = zlib.decompress(block)
    except zlib.error as error:
        raise cursor.fail(f"a block of pixels is damaged: {error}") from None
    if len(packed) != size:
        raise cursor.fail(f"a block of pixels has {len(packed)} bytes in place of {size}")
    steps = np.cumsum(np.frombuffer(packed, np.uint8), dtype=np.uint8)
    steps[1::2] += 128  # -128 k, modulo 256
    half = (size + 1) // 2
    raw = np.empty(size, np.uint8)
    raw[0::2], raw[1::2] = steps[:half], steps[half:]
    return raw.tobytes()
