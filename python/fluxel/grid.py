"""solution.vtu: all values of the elements, as VTK's unstructured grid."""

from __future__ import annotations

import os
import re
import zlib
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np

from .cursor import Cursor
from .mesh import Mesh, padded

TYPES = {"Float32": "<f4", "Float64": "<f8", "UInt8": "u1", "UInt32": "<u4", "Int64": "<i8"}
END = b"</AppendedData>\n</VTKFile>\n"


@dataclass
class Grid(Mesh):
    """The elements of a solution with all of their values, in the order of solution.ply, or the faces of --mesh-max-edge.

    cell_data: name -> (elements, 3) float32, of red, green, blue: "radiosity", "irradiance", "exitance" [W/m2],
        "reflectance", of faces "noise" and "error" [W/m2] as far as they are known; in heat runs (elements,) float32
        "temperature" [K], "net_flux" [W/m2], "emissivity"; the same with "_back"; (elements,) uint32 "patch", "group", "material", "sides" (1 front, 2 back, 3 both)
    field_data: name -> number, "stated_error" where the run has one
    groups, materials: names, by the numbers in cell_data
    """

    cell_data: dict[str, np.ndarray]
    field_data: dict[str, float]
    groups: list[str]
    materials: list[str]

    def __getitem__(self, name: str) -> np.ndarray:
        """An array of cell_data."""
        return self.cell_data[name]

    def of_group(self, name: str) -> np.ndarray:
        """(elements,) bool: whether an element is of the group of that name. Raises KeyError where there is none."""
        if name not in self.groups:
            raise KeyError(name)
        return self.cell_data["group"] == self.groups.index(name)


def read_grid(file: str | os.PathLike[str]) -> Grid:
    """Reads a VTU file that Fluxel has written (appended raw data, compressed by zlib). Raises FormatError where it is
    another, damaged, or ends too early."""
    cursor = Cursor.of_file(file)
    if not cursor.data.endswith(END):
        raise cursor.fail(f"does not end with {END.decode()!r}, as a whole file does")
    head = cursor.text(b'<AppendedData encoding="raw">\n_', "its header")
    comment = re.search(r"<!--(.*?)-->", head, re.DOTALL)
    about = comment.group(1) if comment else ""
    try:
        # Names in the comment need not be characters that XML has.
        tree = ElementTree.fromstring(re.sub(r"<!--.*?-->", "", head, count=1, flags=re.DOTALL) + "</VTKFile>")
    except ElementTree.ParseError as error:
        raise cursor.fail(f"its header is no XML: {error}") from None
    piece = tree.find("UnstructuredGrid/Piece")
    if piece is None or tree.get("compressor") != "vtkZLibDataCompressor" or tree.get("header_type") != "UInt64":
        raise cursor.fail("is no unstructured grid as Fluxel writes it")
    start = cursor.place
    arrays = {(part.tag, array.get("Name", "")): _read_array(Cursor(file, cursor.data, start), array)
              for part in piece for array in part.iter("DataArray")}
    try:
        points, connectivity, offsets = (arrays[key] for key in (
            ("Points", "Points"), ("Cells", "connectivity"), ("Cells", "offsets")))
    except KeyError as error:
        raise cursor.fail(f"has no array {error.args[0][1]}") from None
    cell_data = {name: values for (part, name), values in arrays.items() if part == "CellData"}
    for name, values in cell_data.items():
        if len(values) != len(offsets):
            raise cursor.fail(f"{name} has {len(values)} values for {len(offsets)} cells")
    fields = {array.get("Name", ""): _number(cursor, array.text) for array in tree.iterfind("UnstructuredGrid/FieldData/DataArray")}
    return Grid(points, _faces(cursor, connectivity, offsets, len(points)), cell_data, fields, _names(about, "groups"),
                _names(about, "materials"))


def _read_array(cursor: Cursor, array: ElementTree.Element) -> np.ndarray:
    """(tuples,) or (tuples, components) of an appended array."""
    name = array.get("Name", "")
    if array.get("format") != "appended" or array.get("type") not in TYPES:
        raise cursor.fail(f"the array {name} is not appended, or of a type that Fluxel does not write")
    cursor.place += int(_number(cursor, array.get("offset")))
    components = int(_number(cursor, array.get("NumberOfComponents")))
    blocks, whole, rest = cursor.unpack("<3Q", f"the array {name}")
    sizes = cursor.array("<u8", blocks, f"the sizes of {name}")
    raw = bytearray()
    for number, size in enumerate(sizes):
        expected = rest if rest and number == blocks - 1 else whole
        block = cursor.take(int(size), f"the array {name}")
        try:
            raw += zlib.decompress(block)
        except zlib.error as error:
            raise cursor.fail(f"the array {name} is damaged: {error}") from None
        if len(raw) != number * whole + expected:
            raise cursor.fail(f"block {number} of the array {name} has not the length that is said")
    values = np.frombuffer(raw, TYPES[array.get("type")])
    if components < 1 or len(values) % components:
        raise cursor.fail(f"the array {name} has {len(values)} numbers, no multiple of {components}")
    return values.reshape(-1, components) if components > 1 else values


def _number(cursor: Cursor, text: str | None) -> float:
    try:
        return float(text or "")
    except ValueError:
        raise cursor.fail(f"its header has '{text}' where a number was to follow") from None


def _faces(cursor: Cursor, connectivity: np.ndarray, offsets: np.ndarray, points: int) -> np.ndarray:
    starts = np.concatenate([[0], offsets])[:len(offsets)]
    counts = offsets - starts
    whole = counts.min(initial=3) >= 3 and offsets[-1:].sum() == len(connectivity)
    if not whole or connectivity.min(initial=0) < 0 or connectivity.max(initial=-1) >= points:
        raise cursor.fail("its cells are damaged")
    most = counts.max(initial=3)
    faces = np.empty((len(offsets), most), np.int64)
    for of in np.unique(counts):
        those = counts == of
        faces[those] = padded(connectivity[starts[those, None] + np.arange(of)], most)
    return faces


def _names(about: str, what: str) -> list[str]:
    """The names of a line "groups: 0 floor, 1 wall" of the comment, which may hold commas themselves."""
    line = re.search(rf"^{what}: 0 (.*)$", about, re.MULTILINE)
    names, rest = [], line.group(1) if line else ""
    while rest:
        name, _, rest = rest.partition(f", {len(names) + 1} ")
        names.append(name)
    return names
