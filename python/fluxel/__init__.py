"""Runs the radiosity solver Fluxel, and reads what it writes into NumPy arrays.

    import fluxel

    solution = fluxel.solve("room.obj", target_error=0.02, eye=(3.7, 1.6, 2.8), look_at=(1.2, 0.8, 0.8), fov=60)
    print(solution.stated_error, solution.reached)
    power = solution.elements.areas @ solution.elements.radiosity     # [W] of each colour

The formats of all files, and what their values mean, are described in docs/file-formats.md and docs/report.md.
"""

from .elements import Elements, read_elements
from .errors import FluxelError, FormatError, InputError, NotReachedWarning, RunError
from .grid import Grid, read_grid
from .glb import GlbFile
from .jobs import compare, photons, reference, solve, view, viewfactors
from .light_map import LightMap, read_light_map
from .picture import Picture, read_picture
from .report import read_report
from .results import Comparison, Photons, Reference, Result, Solution, View, ViewFactors
from .tables import Receiver, read_receivers, read_table

__all__ = [
    "Comparison", "Elements", "FluxelError", "FormatError", "GlbFile", "Grid", "InputError", "LightMap", "NotReachedWarning", "Photons", "Picture", "Receiver",
    "Reference", "Result", "RunError", "Solution", "View", "ViewFactors", "compare", "photons", "read_elements", "read_grid",
    "read_light_map", "read_picture", "read_receivers", "read_report", "read_table", "reference", "solve", "view", "viewfactors",
]
