"""The table of times to an error, as Markdown."""

from pathlib import Path

from curves import read, slope, time_to

ERRORS = (0.05, 0.02, 0.01, 0.005)
FARTHEST = 1e6  # [s]: what is fitted beyond is no forecast


def cell(points, error):
    seconds, how = time_to(points, error)
    if how == "measured":
        return f"{seconds:.2g} s"
    if how == "fitted" and seconds < FARTHEST:
        return f"not reached ({seconds:.2g} s fitted)"
    return "not reached"


def write_table(folder):
    """FOLDER/table.md: for each scene and method the wall-clock time to an error, its best error and its slope."""
    lines = ["| scene | method | " + " | ".join(f"{100 * error:g} %" for error in ERRORS) + " | best | slope |",
             "| --- " * (len(ERRORS) + 4) + "|"]
    for scene, methods in read(folder, "wall").items():
        for method, points in methods.items():
            best = min(points, key=lambda point: point.error)
            power = slope(points)
            lines.append(f"| {scene} | {method} | " + " | ".join(cell(points, error) for error in ERRORS) +
                         f" | {100 * best.error:.2g} % in {best.seconds:.2g} s | "
                         f"{'-' if power is None else format(power, '.2f')} |")
    (Path(folder) / "table.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
