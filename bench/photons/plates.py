#!/usr/bin/env python3
"""Stated and true errors of photons on the plates of Dmitriev 2002, figure 2: his three sweeps.

  bench/photons/plates.py [--bench build/unity/bench/photons/photons_bench] [--out DIR] [--quick]

In a shaft of mirrors every plate's irradiance is exactly that of the lid where all light is passed on, so that what cells
differ from it is the true error. Writes plates.csv (a line a sequence, setting and plate) and, with matplotlib, plates-*.png;
prints what it came to. --quick: a sixteenth of the photons, to see that it runs.
"""

import argparse
import csv
import io
import math
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from scene_parts.plates import EDGE, PLATES, irradiance, write_plates  # noqa: E402

CELLS = 32
SEQUENCES = ("sobol", "halton", "random")
MOST = 1 << 24  # the paper has about 18 million
LEAST = 1 << 18


def cells(bench, scene, variant, photons):
    """{photons: {plate: [(mean, half_a, half_b)]}} of the cells of each plate."""
    job = subprocess.run([bench, "cells", scene, str(EDGE / CELLS), variant, *map(str, photons)], check=True,
                         capture_output=True, text=True)
    found = defaultdict(lambda: defaultdict(list))
    for row in csv.DictReader(io.StringIO(job.stdout)):
        x, y, z = (float(row[axis]) for axis in "xyz")
        if max(abs(x), abs(y)) > EDGE / 2 - 1e-6 or z > -1e-6:
            continue  # of walls and lid
        found[int(row["photons"])][z].append(tuple(float(row[key]) for key in ("irradiance", "half_a", "half_b")))
    return {count: {k + 1: of for k, (_, of) in enumerate(sorted(plates.items(), reverse=True))}
            for count, plates in found.items()}


def errors(values, exact):
    """The true error and that stated by half the difference of both halves, over the mean of all cells."""
    assert len(values) == CELLS * CELLS, len(values)
    root = lambda squares: math.sqrt(sum(squares) / len(values)) / exact
    return (root((mean - exact)**2 for mean, *_ in values), root((0.5 * (a - b))**2 for _, a, b in values))


def settings(most, others):
    """(sweep, value, parameters, photons) of each setting."""
    counts = []
    count = LEAST
    while count < most:
        counts += [count, count + count // 2]
        count *= 2
    yield "photons", None, {"straight": 0.8, "diffuse": 0.2, "distance": 0.1}, counts + [most]
    for diffuse in (0.0, 0.2, 0.4, 0.6, 0.8):
        yield "diffuse", diffuse, {"straight": round(1 - diffuse, 3), "diffuse": diffuse, "distance": 0.1}, [others]
    for distance in (0.1, 0.2, 0.4, 0.8):
        yield "distance", distance, {"straight": 0.8, "diffuse": 0.2, "distance": distance}, [others]
    yield "dim", 0.7, {"straight": 0.5, "diffuse": 0.2, "distance": 0.1}, [others]


def slope(rows):
    """Of the logarithm of the error over that of the photons, by least squares."""
    points = [(math.log(row["photons"]), math.log(row["true"])) for row in rows]
    x, y = (sum(p[k] for p in points) / len(points) for k in (0, 1))
    return sum((a - x) * (b - y) for a, b in points) / sum((a - x)**2 for a, _ in points)


def measure(bench, most, others):
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for number, (sweep, value, parameters, photons) in enumerate(settings(most, others)):
            scene = write_plates(Path(folder) / str(number), **parameters)
            others = ("random", "sobol-even-odd", "halton-even-odd") if sweep == "photons" else ()
            for variant in ("sobol", "halton", *others):
                print(f"{sweep} {value if value is not None else ''} {variant}", file=sys.stderr)
                for count, plates in cells(bench, scene, variant, photons).items():
                    assert len(plates) == PLATES, plates.keys()
                    for plate, values in plates.items():
                        exact = irradiance(plate, parameters["straight"], parameters["diffuse"])
                        true, stated = errors(values, exact)
                        mean = sum(v for v, *_ in values) / len(values)
                        rows.append({"sweep": sweep, "value": value if value is not None else count, "points": variant,
                                     "photons": count, "plate": plate, "mean": mean / exact, "true": true, "stated": stated})
    return rows


def summarise(rows, most):
    of = lambda **keys: [row for row in rows if all(row[key] == value for key, value in keys.items())]
    plain = [row for row in rows if row["points"] in SEQUENCES and row["sweep"] != "dim"]
    print("stated over true error within 0.8..1.2:")
    for points in (*SEQUENCES, "sobol and halton"):
        ratios = sorted(row["stated"] / row["true"] for row in plain if row["points"] in points)
        within = sum(0.8 <= r <= 1.2 for r in ratios) / len(ratios)
        print(f"  {points:16} {100 * within:5.1f} % of {len(ratios)} plates and settings; {ratios[0]:.2f} to {ratios[-1]:.2f}")
    for points in ("sobol-even-odd", "halton-even-odd"):
        ratios = [row["stated"] / row["true"] for row in rows if row["points"] == points]
        print(f"  {points}: {min(ratios):.0f} to {max(ratios):.0f}")
    print("true error, % of the mean, by photons (k_td = 0.2, L = 0.1):")
    for points in SEQUENCES:
        for plate in (1, 5):
            some = of(sweep="photons", points=points, plate=plate)
            ends = " ".join(f"{100 * row['true']:.3f}" for row in some)
            print(f"  {points:8} plate {plate}: slope {slope(some):.2f}; {ends}")
    print(f"random over Sobol at {most} photons:", " ".join(
        f"{of(sweep='photons', points='random', plate=k, photons=most)[0]['true'] / of(sweep='photons', points='sobol', plate=k, photons=most)[0]['true']:.2f}"
        for k in range(1, PLATES + 1)))
    print("k_td = 0.2, k_ts = 0.5: mean of plates over E 0.7^(k-1), less 1, over its error:")
    for row in of(sweep="dim"):
        error = row["stated"] / math.sqrt(CELLS * CELLS)
        print(f"  {row['points']:8} plate {row['plate']}: {(row['mean'] - 1) / error:+.2f} errors of {100 * error:.4f} %")


def draw(rows, folder):
    try:
        import matplotlib
    except ImportError:
        return
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import matplotlib.ticker
    colours = {"sobol": "tab:blue", "halton": "tab:green", "random": "tab:red"}
    for sweep, label in (("photons", "photons"), ("diffuse", "diffuse transmission k_td (k_ts = 1 - k_td)"),
                         ("distance", "distance of plates L [m]")):
        figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), sharey=True)
        for axis, plate in zip(axes, (1, PLATES)):
            for points in SEQUENCES if sweep == "photons" else SEQUENCES[:2]:
                some = [r for r in rows if r["sweep"] == sweep and r["points"] == points and r["plate"] == plate]
                x = [row["value"] for row in some]
                axis.plot(x, [100 * r["true"] for r in some], "-", color=colours[points], label=f"{points}, true")
                axis.plot(x, [100 * r["stated"] for r in some], "o", ms=4, mfc="none", color=colours[points],
                          label=f"{points}, stated")
            axis.set(title=f"plate {plate}", xlabel=label, yscale="log", xscale="log" if sweep == "photons" else "linear")
            axis.yaxis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
            axis.yaxis.set_major_formatter("{x:g}")
            axis.yaxis.set_minor_formatter("")
            axis.grid(True, which="both", alpha=0.3)
        axes[0].set_ylabel("error of 32 x 32 cells [% of the mean]")
        axes[0].legend(fontsize=8)
        figure.tight_layout()
        figure.savefig(folder / f"plates-{sweep}.png", dpi=110)
        plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--bench", default=str(ROOT / "build/unity/bench/photons/photons_bench"))
    parser.add_argument("--out", type=Path, default=Path("photons-plates"))
    parser.add_argument("--others", type=int, default=MOST, help="photons of the sweeps over k_td and L")
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    most = MOST // 16 if options.quick else MOST
    options.out.mkdir(parents=True, exist_ok=True)
    rows = measure(options.bench, most, min(most, options.others))
    with open(options.out / "plates.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows({key: f"{v:.6g}" if isinstance(v, float) else v for key, v in row.items()} for row in rows)
    draw(rows, options.out)
    summarise(rows, most)


if __name__ == "__main__":
    main()
