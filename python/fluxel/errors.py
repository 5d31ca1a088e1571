"""What goes wrong in runs and files."""

from __future__ import annotations

import os


class FluxelError(Exception):
    """The base of all errors of this package."""


class InputError(FluxelError):
    """Fluxel has refused its input or an option (exit code 2); the text is its own message."""


class RunError(FluxelError):
    """There is no program to run, or it has ended with a code that no run should have.

    `code` is the exit code, below 0 where a signal has ended the process, None where none was started.
    """

    def __init__(self, message: str, code: int | None = None):
        super().__init__(message)
        self.code = code


class FormatError(FluxelError):
    """A file is torn, or not of the format that Fluxel writes; `file` is its name."""

    def __init__(self, file: str | os.PathLike[str], what: str):
        super().__init__(f"{os.fspath(file)}: {what}")
        self.file = file


class NotReachedWarning(UserWarning):
    """A run has written all of its files without convergence or without the error that was asked for (exit code 3)."""
