"""Binary data that is read from its beginning to its end."""

from __future__ import annotations

import os
import struct
from pathlib import Path

import numpy as np

from .errors import FormatError


class Cursor:
    """Bytes of a file, and how far they have been read; reading beyond their end is a FormatError."""

    def __init__(self, file: str | os.PathLike[str], data: bytes, place: int = 0):
        self.file, self.data, self.place = file, data, place

    @classmethod
    def of_file(cls, file: str | os.PathLike[str]) -> Cursor:
        return cls(file, Path(file).read_bytes())

    def fail(self, what: str) -> FormatError:
        return FormatError(self.file, what)

    def take(self, count: int, what: str) -> bytes:
        """The next bytes; `what` they are stands in the error where the file has fewer."""
        left = len(self.data) - self.place
        if not 0 <= count <= left:
            raise self.fail(f"the file ends within {what}: {count} bytes were to follow, and {left} do")
        self.place += count
        return self.data[self.place - count:self.place]

    def unpack(self, form: str, what: str) -> tuple:
        return struct.unpack(form, self.take(struct.calcsize(form), what))

    def array(self, dtype: np.dtype | str, count: int, what: str) -> np.ndarray:
        """The next `count` values, a copy that may be written to."""
        dtype = np.dtype(dtype)
        return np.frombuffer(self.take(count * dtype.itemsize, what), dtype).copy()

    def text(self, end: bytes, what: str) -> str:
        """Up to `end`, which is passed over."""
        found = self.data.find(end, self.place)
        if found < 0:
            raise self.fail(f"the file ends within {what}")
        text, self.place = self.data[self.place:found], found + len(end)
        return text.decode("utf-8", "replace")
