"""What runs have written, read when it is asked for."""

from __future__ import annotations

import os
import shutil
import weakref
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from .elements import Elements, read_elements
from .grid import Grid, read_grid
from .light_map import LightMap, read_light_map
from .picture import Picture, read_picture
from .report import read_report
from .tables import Receiver, read_receivers, read_table


class Result:
    """The folder of a run; also of one that was made elsewhere: `Solution("out/room")`.

    out: the folder; where it is a temporary one, it is removed when the result is no longer used
    stopped: whether a signal has ended the run early (exit code 75), so that files may be missing
    messages: what the program has said on standard error

    What is read is kept. Reading what the run has not written raises FileNotFoundError, and a damaged file FormatError.
    """

    def __init__(self, out: str | os.PathLike[str], *, temporary: bool = False):
        self.out = Path(out)
        self.stopped = False
        self.messages = ""
        if temporary:
            weakref.finalize(self, shutil.rmtree, self.out, ignore_errors=True)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({os.fspath(self.out)!r})"


class _Lit(Result):
    """A run with a report of Fluxel's own error, and pictures."""

    @cached_property
    def report(self) -> dict[str, Any]:
        """report.json; docs/report.md describes its keys."""
        return read_report(self.out / "report.json")

    @property
    def stated_error(self) -> float | None:
        """Relative error (rms over the mean) that nine of ten errors are below; None where nothing is known."""
        return self.report.get("stated_error")

    @property
    def reached(self) -> bool | None:
        """Whether the target error is reached; None where that cannot be told, or there is no target."""
        return self.report.get("hierarchy", {}).get("reached")

    @property
    def warnings(self) -> list[str]:
        """What looks suspicious, in plain text."""
        return self.report["warnings"]

    @cached_property
    def picture(self) -> Picture:
        """image.exr: radiance and layers. Of scenes without a camera there is none."""
        return read_picture(self.out / "image.exr")

    @cached_property
    def light_map(self) -> LightMap:
        """lightmap.glb and lightmap.exr, with write="lightmap"."""
        return read_light_map(self.out / "lightmap.glb")

    @cached_property
    def receivers(self) -> dict[str, Receiver]:
        """receivers.csv, by the names of the receivers; none in scenes without them."""
        file = self.out / "receivers.csv"
        return read_receivers(file) if file.exists() else {}

    @cached_property
    def tasks(self) -> dict[str, np.ndarray]:
        """tasks.csv: a row a criterion of EN 12464-1, with what was found and its verdict; none in scenes without tasks."""
        file = self.out / "tasks.csv"
        return read_table(file) if file.exists() else {}


class Solution(_Lit):
    """What `fluxel solve` has written."""

    @property
    def converged(self) -> bool:
        """Whether the solver has converged."""
        return self.report["solve"]["converged"]

    @cached_property
    def elements(self) -> Elements:
        """solution.ply: radiosity of every element."""
        return read_elements(self.out / "solution.ply")

    @cached_property
    def grid(self) -> Grid:
        """solution.vtu, with write="vtu": all values of every element."""
        return read_grid(self.out / "solution.vtu")

    @cached_property
    def thermal(self) -> dict[str, np.ndarray]:
        """thermal.csv, of heat runs: columns by their names."""
        return read_table(self.out / "thermal.csv")

    @cached_property
    def convergence(self) -> dict[str, np.ndarray]:
        """convergence.csv: columns by their names."""
        return read_table(self.out / "convergence.csv")


class View(_Lit):
    """What `fluxel view` has written."""


class _Measured(Result):
    """What measures sensors one by one."""

    @property
    def reached(self) -> bool:
        """Whether everything that was measured is at its target error, or no other limit has come first."""
        return all(of["reached"] for of in self.report["measured"].values())

    @cached_property
    def receivers(self) -> dict[str, Picture]:
        """receiver-NAME.exr of each receiver that was measured, one pixel a cell."""
        names = [what.partition(" ")[2] for what in self.report["measured"] if what.startswith("receiver ")]
        return {name: read_picture(self.out / f"receiver-{name}.exr") for name in names}


class Reference(_Measured):
    """What `fluxel reference` has written: values with standard errors."""

    @cached_property
    def report(self) -> dict[str, Any]:
        """reference.json; docs/file-formats.md describes its keys."""
        return read_report(self.out / "reference.json")

    @cached_property
    def elements(self) -> Elements:
        """reference.ply, where elements were given."""
        return read_elements(self.out / "reference.ply")

    @cached_property
    def picture(self) -> Picture:
        """reference.exr: radiance, "error", "half_a", "half_b"."""
        return read_picture(self.out / "reference.exr")


class Photons(_Measured):
    """What `fluxel photons` has written: values with halves that tell their errors."""

    @cached_property
    def report(self) -> dict[str, Any]:
        """photons.json; docs/file-formats.md describes its keys."""
        return read_report(self.out / "photons.json")

    @cached_property
    def elements(self) -> Elements:
        """photons.ply: "radiosity" and "irradiance", where elements were measured."""
        return read_elements(self.out / "photons.ply")


class ViewFactors(Result):
    """What `fluxel viewfactors` has written: as a table, or above 500 groups as a sparse matrix."""

    @cached_property
    def table(self) -> dict[str, np.ndarray]:
        """view-factors.csv, where it was written: columns by their names, a row for each pair of surfaces with a factor above 0."""
        return read_table(self.out / "view-factors.csv")

    @cached_property
    def surfaces(self) -> list[tuple[str, str]]:
        """Group and side ("front", "back") of the surfaces that the matrix has rows of: of view-factors.npz those that have an area, of
        view-factors.csv those that see something."""
        if (self.out / "surfaces.csv").exists():
            table = read_table(self.out / "surfaces.csv")
            return list(zip(table["group"].tolist(), table["side"].tolist()))
        return list(dict.fromkeys(zip(self.table["from"].tolist(), self.table["from_side"].tolist())))

    @cached_property
    def matrix(self) -> np.ndarray:
        """(surfaces, surfaces) float64: the share of what leaves the surface of the row that reaches that of the column. Of many surfaces
        `scipy.sparse.load_npz` of view-factors.npz takes less memory."""
        place = {surface: k for k, surface in enumerate(self.surfaces)}
        factors = np.zeros((len(place), len(place)))
        if (self.out / "view-factors.npz").exists():
            with np.load(self.out / "view-factors.npz") as sparse:
                rows = np.repeat(np.arange(len(place)), np.diff(sparse["indptr"]))
                factors[rows, sparse["indices"]] = sparse["data"]
            return factors
        for row in zip(*(self.table[name].tolist() for name in ("from", "from_side", "to", "to_side", "view_factor"))):
            factors[place[row[:2]], place[row[2:4]]] = row[4]
        return factors


class Comparison(Result):
    """What `fluxel compare` has written."""

    @cached_property
    def report(self) -> dict[str, Any]:
        """compare.json; docs/file-formats.md describes its keys."""
        return read_report(self.out / "compare.json")
