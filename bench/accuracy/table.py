"""The table of times to an error, as Markdown."""

from pathlib import Path

from curves import REFERENCES, read, slope, time_to
from settings import METHODS

ERRORS = (0.05, 0.02, 0.01, 0.005)
FARTHEST = 1e6  # [s]: what is fitted beyond is no forecast


def plain(value):
    """Two digits, without an exponent."""
    return f"{value:.0f}" if value >= 100 else f"{value:.2g}"


def duration(seconds):
    return f"{seconds / 3600:.0f} h" if seconds >= 2 * 3600 else f"{plain(seconds)} s"


def cell(points, error):
    seconds, how = time_to(points, error)
    if how == "measured":
        return duration(seconds)
    if how == "fitted" and seconds < FARTHEST:
        return f"not reached (fitted: {duration(seconds)})"
    return "not reached"


def write_table(folder):
    """FOLDER/table.md: for each scene and method the wall-clock time to an error, its best error and its slope."""
    lines = ["| scene | method | " + " | ".join(f"{100 * error:g} %" for error in ERRORS) + " | best | slope |",
             "| --- " * (len(ERRORS) + 4) + "|"]
    for scene, methods in read(folder, "wall").items():
        for method in (*(method.label for method in METHODS), *REFERENCES.values()):
            points = methods.get(method)
            if not points:
                continue
            best = min(points, key=lambda point: point.error)
            power = slope(points)
            lines.append(f"| {scene} | {method} | " + " | ".join(cell(points, error) for error in ERRORS) +
                         f" | {plain(100 * best.error)} % in {duration(best.seconds)} | "
                         f"{'-' if power is None else format(power, '.2f')} |")
    (Path(folder) / "table.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
