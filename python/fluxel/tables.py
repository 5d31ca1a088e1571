"""Tables (CSV): receivers.csv, tasks.csv, thermal.csv, view-factors.csv, surfaces.csv, faces.csv, convergence.csv, timeline.csv."""

from __future__ import annotations

import csv
import io
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .errors import FormatError

# Columns of names, which may be digits alone.
TEXTS = {"group", "side", "phase", "receiver", "quantity", "unit", "from", "from_side", "to", "to_side", "kind", "task", "zone",
         "of", "verdict"}
YES_OR_NO = {"true": True, "false": False}


def read_table(file: str | os.PathLike[str]) -> dict[str, np.ndarray]:
    """Each column by its name: names as (rows,) str, numbers as (rows,) float64, not a number where a cell is empty,
    true and false as (rows,) bool.

    Raises FormatError where a row has other columns or a number is none.
    """
    try:
        text = Path(file).read_text(encoding="utf-8")
        header, *rows = csv.reader(io.StringIO(text, newline=""), strict=True)
    except (ValueError, csv.Error) as error:
        raise FormatError(file, f"is no whole table: {error}") from None
    if not text.endswith("\n"):
        raise FormatError(file, f"ends within row {len(rows) + 1}")
    for number, row in enumerate(rows, 2):
        if len(row) != len(header):
            raise FormatError(file, f"row {number} has {len(row)} cells in place of {len(header)}")
    columns = dict(zip(header, zip(*rows))) if rows else dict.fromkeys(header, ())
    return {name: _column(file, name, cells) for name, cells in columns.items()}


def _column(file: str | os.PathLike[str], name: str, cells: tuple[str, ...]) -> np.ndarray:
    if name in TEXTS:
        return np.array(cells, dtype=str)
    if cells and set(cells) <= set(YES_OR_NO):
        return np.array([YES_OR_NO[cell] for cell in cells])
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError as error:
        raise FormatError(file, f"the column {name} holds something other than numbers: {error}") from None


@dataclass
class Receiver:
    """A grid of light meters; row 0 is the top one, at the far end of the receiver's v.

    quantity, unit: of the values, as "irradiance" and "lx"
    centres: (rows, columns, 3) float64, of the cells, in world coordinates [m]
    values: (rows, columns, 3) float64 of red, green, blue, in `unit`
    error: (rows, columns, 3) float64, the estimated error of each value

    Cells that the file leaves out are not numbers.
    """

    name: str
    quantity: str
    unit: str
    centres: np.ndarray
    values: np.ndarray
    error: np.ndarray

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.values.shape[:2]


def read_receivers(file: str | os.PathLike[str]) -> dict[str, Receiver]:
    """The receivers of receivers.csv, by their names. Raises FormatError where the table is another."""
    table = read_table(file)
    try:
        names, place = table["receiver"], (table["row"].astype(int), table["column"].astype(int))
        columns = ["x_m", "y_m", "z_m", *(f"{what}_{colour}" for what in ("value", "error") for colour in "rgb")]
        cells = np.stack([table[name] for name in columns], axis=1)
        quantities, units = table["quantity"], table["unit"]
    except KeyError as error:
        raise FormatError(file, f"is no table of receivers: there is no column {error.args[0]}") from None
    found = {}
    for name in dict.fromkeys(names.tolist()):
        those = names == name
        rows, columns = (of[those] for of in place)
        grid = np.full((rows.max() + 1, columns.max() + 1, 9), np.nan)
        grid[rows, columns] = cells[those]
        first = np.argmax(those)
        found[name] = Receiver(name, str(quantities[first]), str(units[first]), grid[..., :3], grid[..., 3:6], grid[..., 6:])
    return found
