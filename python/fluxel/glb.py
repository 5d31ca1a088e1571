"""Binary glTF 2.0, as far as Fluxel writes it."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from typing import Any

import numpy as np

from .cursor import Cursor

COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
KINDS = {5123: "<u2", 5125: "<u4", 5126: "<f4"}


class GlbFile:
    """
    model: what the file says of itself, as the specification of glTF names it
    """

    model: dict[str, Any]

    def __init__(self, file: str | os.PathLike[str]):
        self._cursor = Cursor.of_file(file)
        magic, version, length = self._cursor.unpack("<4sII", "its header")
        if magic != b"glTF" or version != 2 or length != len(self._cursor.data):
            raise self._cursor.fail("is no binary glTF file of version 2, or not a whole one")
        try:
            self.model = json.loads(self._chunk(b"JSON"))
        except ValueError as error:
            raise self._cursor.fail(f"its JSON is damaged: {error}") from None
        self._binary = self._chunk(b"BIN\0")

    def _chunk(self, name: bytes) -> bytes:
        size, kind = self._cursor.unpack("<I4s", "the head of a chunk")
        if kind != name:
            raise self._cursor.fail(f"has a chunk {kind!r} where {name!r} was to follow")
        return self._cursor.take(size, f"the chunk {name!r}")

    def bytes_of(self, view: int) -> bytes:
        """Of a view of the buffer."""
        try:
            start, length = (self.model["bufferViews"][view][key] for key in ("byteOffset", "byteLength"))
        except (LookupError, TypeError):
            raise self._cursor.fail(f"has no buffer view {view}, or none with an offset and a length") from None
        if not 0 <= start <= start + length <= len(self._binary):
            raise self._cursor.fail(f"its buffer view {view} lies outside of the buffer")
        return self._binary[start:start + length]

    def values(self, accessor: int) -> np.ndarray:
        """(count, components), of scalars (count,)."""
        try:
            about = self.model["accessors"][accessor]
            components, kind = COUNTS[about["type"]], np.dtype(KINDS[about["componentType"]])
            data = self.bytes_of(about["bufferView"])
            stride = self.model["bufferViews"][about["bufferView"]].get("byteStride", kind.itemsize * components)
            rows = np.frombuffer(data, kind).reshape(about["count"], stride // kind.itemsize)
        except (LookupError, TypeError, ValueError):
            raise self._cursor.fail(f"its accessor {accessor} is damaged, or of another type than Fluxel writes") from None
        return rows[:, 0] if components == 1 else rows[:, :components]

    def nodes(self) -> Iterator[tuple[dict[str, Any], list[dict[str, Any]]]]:
        """Those with a mesh: the node, and its primitives."""
        for node in self.model["nodes"]:
            if "mesh" in node:
                yield node, self.model["meshes"][node["mesh"]]["primitives"]
