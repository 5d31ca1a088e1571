"""Reads binary glTF files, after the glTF 2.0 specification."""

import json
import struct

import numpy as np

COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
KINDS = {5123: "<u2", 5125: "<u4", 5126: "<f4"}


class GlbFile:
    def __init__(self, file):
        data = file.read_bytes()
        magic, version, length, text = struct.unpack_from("<4sIII", data)
        assert (magic, version, length, data[16:20]) == (b"glTF", 2, len(data), b"JSON")
        self.model, self.binary = json.loads(data[20:20 + text]), data[20 + text + 8:]

    def bytes_of(self, number):
        """Of a view of the buffer."""
        view = self.model["bufferViews"][number]
        return self.binary[view["byteOffset"]:view["byteOffset"] + view["byteLength"]]

    def values(self, number):
        """Of an accessor: (count, components), of scalars (count,)."""
        accessor = self.model["accessors"][number]
        count, kind = COUNTS[accessor["type"]], np.dtype(KINDS[accessor["componentType"]])
        view = self.model["bufferViews"][accessor["bufferView"]]
        size = view.get("byteStride", kind.itemsize * count)
        assert view["byteOffset"] % 4 == 0 and view["byteLength"] == size * accessor["count"]
        rows = np.frombuffer(self.bytes_of(accessor["bufferView"]), kind).reshape(accessor["count"], size // kind.itemsize)
        return rows[:, 0] if count == 1 else rows[:, :count]

    def nodes(self):
        """Those with a mesh: the node, and its primitives."""
        for node in self.model["nodes"]:
            if "mesh" in node:
                yield node, self.model["meshes"][node["mesh"]]["primitives"]
