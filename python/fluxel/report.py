"""report.json, reference.json, photons.json, compare.json."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from .errors import FormatError


def read_report(file: str | os.PathLike[str]) -> dict[str, Any]:
    """The keys of a report, which docs/report.md describes. Raises FormatError where the file is torn."""
    try:
        report = json.loads(Path(file).read_text(encoding="utf-8"))
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise FormatError(file, f"is no whole report: {error}") from None
    if not isinstance(report, dict):
        raise FormatError(file, "is no report: an object was to follow")
    return report
