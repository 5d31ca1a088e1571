"""The command line of a job: which program, which options, how many ranks."""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .errors import RunError

BUILT = Path(__file__).resolve().parents[2] / "build/release/app/fluxel"
SEPARATORS = {"resolution": "x"}  # of lists; others have commas


def find_executable(executable: str | os.PathLike[str] | None) -> str:
    """What is given, else what the environment variable FLUXEL names, else `fluxel` on PATH, else the release build of the
    checkout that this package lies in. Raises RunError where there is none."""
    given = executable or os.environ.get("FLUXEL")
    found = shutil.which(os.fspath(given or "fluxel")) or (None if given or not BUILT.exists() else str(BUILT))
    if found is None:
        raise RunError(f"there is no program {os.fspath(given) if given else 'fluxel'}: build it (scripts/build), then give "
                       "executable=, set the environment variable FLUXEL or have it on PATH")
    return found


def option_words(options: dict[str, Any]) -> list[str]:
    """As the command line has them: target_error=0.02 is --target-error=0.02, quiet=True is --quiet; options that are False
    or None are left out."""
    words = []
    for name, value in options.items():
        if hasattr(value, "tolist"):  # of NumPy
            value = value.tolist()
        option = "--" + name.replace("_", "-")
        if value is True:
            words.append(option)
        elif value is not None and value is not False:
            words.append(f"{option}={_text(value, SEPARATORS.get(name, ','))}")
    return words


def _text(value: Any, separator: str) -> str:
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if hasattr(value, "tolist"):  # of NumPy: with it or without, numbers are Python's
        value = value.tolist()
    if isinstance(value, (Sequence, range)):
        return separator.join(_text(part, separator) for part in value)
    return str(value)


def command_line(command: str, arguments: Sequence[str | os.PathLike[str]], options: dict[str, Any], ranks: int | None,
                 executable: str | os.PathLike[str] | None) -> list[str]:
    """`ranks` processes are started by mpirun, or by what the environment variable FLUXEL_MPIEXEC names."""
    launcher = [] if ranks is None else [os.environ.get("FLUXEL_MPIEXEC", "mpirun"), "--bind-to", "none", "-n", str(ranks)]
    return [*launcher, find_executable(executable), command, *option_words(options), "--", *map(os.fspath, arguments)]


def mpi_environment(ranks: int | None) -> dict[str, str]:
    """The environment with what Open MPI 4 and 5 need where they refuse by default, as scripts/mpi-env.sh has it."""
    needed = {}
    if os.geteuid() == 0:
        needed.update(dict.fromkeys(("OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "PRTE_ALLOW_RUN_AS_ROOT",
                                     "PRTE_ALLOW_RUN_AS_ROOT_CONFIRM"), "1"))
    # More ranks than cores: permit it and let waiting ranks give the core away.
    needed.update(OMPI_MCA_rmaps_base_oversubscribe="1", PRTE_MCA_rmaps_default_mapping_policy=":oversubscribe")
    if (ranks or 1) > (os.cpu_count() or 1):
        needed["OMPI_MCA_mpi_yield_when_idle"] = "1"
    if in_container():
        # Containers forbid process_vm_readv, by which ranks of one host read from each other.
        needed["OMPI_MCA_btl_vader_single_copy_mechanism"] = "none"
    return {**needed, **os.environ}


def in_container() -> bool:
    if "container" in os.environ or any(Path(mark).exists() for mark in ("/.dockerenv", "/run/.containerenv")):
        return True
    try:
        groups = Path("/proc/1/cgroup").read_text()
    except OSError:
        return False
    return any(name in groups for name in ("docker", "kubepods", "containerd", "lxc"))
