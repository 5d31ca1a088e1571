"""Starts Fluxel: solve, view, reference, photons, viewfactors, compare."""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
import warnings
from typing import Any, TypeVar, Union

from .command import command_line, mpi_environment
from .errors import InputError, NotReachedWarning, RunError
from .results import Comparison, Photons, Reference, Result, Solution, View, ViewFactors

PathText = Union[str, "os.PathLike[str]"]
Kind = TypeVar("Kind", bound=Result)

DONE, REFUSED, NOT_REACHED, STOPPED = 0, 2, 3, 75  # exit codes of the program
TAIL = 30  # lines of a message that are worth repeating


def solve(scene: PathText, *, out: PathText | None = None, ranks: int | None = None, executable: PathText | None = None,
          **options: Any) -> Solution:
    """Solves a scene: `fluxel solve SCENE`.

    Options are those of the command line (`fluxel solve --help-all`), with underscores in place of hyphens: numbers, texts,
    paths; True for an option without a value; sequences for lists, as eye=(1, 1.6, 4), resolution=(320, 240),
    write=["vtu", "glb"]. The run is quiet; with quiet=False its progress is printed.

    out: the folder of the files; none: a temporary one, which is removed with the result
    ranks: processes, by mpirun; none: a single one, which uses all cores. Of several ranks on one machine give each its
        share of the cores: threads=...
    executable: the program; see docs/python.md where it is looked for otherwise

    Raises InputError where the program refuses the scene or an option, and RunError where it is not found or fails. Where
    the solver has not converged, or the error that was asked for is not reached, there is a NotReachedWarning.
    """
    return _run(Solution, "solve", [scene], out, ranks, executable, options)


def view(scene: PathText, solution: Solution | PathText, *, out: PathText | None = None, ranks: int | None = None,
         executable: PathText | None = None, **options: Any) -> View:
    """Shows a solution of the scene, or the solution.ply of one, from another eye, with other pixels or at other receivers:
    `fluxel view SCENE --solution FILE`. Parameters and errors are those of `solve`."""
    file = solution.out / "solution.ply" if isinstance(solution, Solution) else solution
    return _run(View, "view", [scene], out, ranks, executable, {"solution": file, **options})


def reference(scene: PathText, *, out: PathText | None = None, ranks: int | None = None, executable: PathText | None = None,
              **options: Any) -> Reference:
    """Measures a scene by paths of light, with standard errors: `fluxel reference SCENE`. Parameters and errors are those of
    `solve`."""
    return _run(Reference, "reference", [scene], out, ranks, executable, options)


def photons(scene: PathText, *, out: PathText | None = None, ranks: int | None = None, executable: PathText | None = None,
            **options: Any) -> Photons:
    """Follows light from what emits it, by mirrors and glass too: `fluxel photons SCENE`. Parameters and errors are those of
    `solve`."""
    return _run(Photons, "photons", [scene], out, ranks, executable, options)


def viewfactors(scene: PathText, *, out: PathText | None = None, ranks: int | None = None, executable: PathText | None = None,
                **options: Any) -> ViewFactors:
    """View factors between the groups of a scene: `fluxel viewfactors SCENE`. Parameters and errors are those of `solve`."""
    return _run(ViewFactors, "viewfactors", [scene], out, ranks, executable, options)


def compare(judged: PathText, truth: PathText, *, out: PathText | None = None, executable: PathText | None = None,
            **options: Any) -> Comparison:
    """How far a picture, a receiver or a file of elements is off another: `fluxel compare A B`. Parameters and errors are
    those of `solve`; a NotReachedWarning where the error is above `fail_above`."""
    return _run(Comparison, "compare", [judged, truth], out, None, executable, options)


def _run(kind: type[Kind], command: str, arguments: list[PathText], out: PathText | None, ranks: int | None,
         executable: PathText | None, options: dict[str, Any]) -> Kind:
    folder = tempfile.mkdtemp(prefix="fluxel-") if out is None else out
    result = kind(folder, temporary=out is None)
    line = command_line(command, arguments, {"quiet": True, **options, "out": folder}, ranks, executable)
    code, said = _finished(line, mpi_environment(ranks), options.get("quiet", True))
    if code == REFUSED:
        raise InputError(_said_by_fluxel(said, "fluxel: ") or _tail(said))
    if code not in (DONE, NOT_REACHED, STOPPED):
        raise RunError(f"{' '.join(line)}\nended with {_name(code)}:\n{_tail(said)}", code)
    if code == NOT_REACHED:
        # At the line that has called one of the functions above.
        warnings.warn(NotReachedWarning(_said_by_fluxel(said, "warning: ") or "see the report"), stacklevel=3)
    result.stopped, result.messages = code == STOPPED, said
    return result


def _finished(line: list[str], environment: dict[str, str], quiet: bool) -> tuple[int, str]:
    """Exit code and what was said on standard error."""
    try:
        process = subprocess.Popen(line, env=environment, stdin=subprocess.DEVNULL, text=True, errors="replace",
                                   stdout=subprocess.DEVNULL if quiet else None, stderr=subprocess.PIPE)
    except OSError as error:
        raise RunError(f"{line[0]} cannot be started: {error.strerror}") from error
    try:
        _, said = process.communicate()
    except BaseException:
        process.terminate()  # a launcher then ends its ranks
        process.wait()
        raise
    return process.returncode, said


def _said_by_fluxel(said: str, beginning: str) -> str:
    """The program's own lines that begin so, without that; a launcher has lines of its own."""
    return "\n".join(line[len(beginning):] for line in said.splitlines() if line.startswith(beginning))


def _tail(said: str) -> str:
    return "\n".join(said.strip().splitlines()[-TAIL:])


def _name(code: int) -> str:
    return f"exit code {code}" if code >= 0 else f"signal {signal.Signals(-code).name}"
