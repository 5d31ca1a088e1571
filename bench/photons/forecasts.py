#!/usr/bin/env python3
"""How well photons forecast their end: runs to a target error, what each said after a tenth of its time, and when it ended.

  bench/photons/forecasts.py [--fluxel build/unity/app/fluxel] [--target-scale X]

One rank and all threads; the machine should do nothing else. A line a run: seconds, the forecast at a tenth, their ratio.
"""

import argparse
import csv
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"
RUNS = [(SCENES / "cornell-box/cornell-box.toml", "0.05", "sobol", 0.012), (SCENES / "cornell-box/cornell-box.toml", "0.05", "halton", 0.012),
        (SCENES / "cornell-box/cornell-box.toml", "0.05", "scrambled", 0.012), (SCENES / "cornell-box/cornell-box.toml", "0.05", "random", 0.012),
        (SCENES / "construction-in-wood/construction-in-wood.toml", "0.5", "sobol", 0.01),
        (SCENES / "construction-in-wood/construction-in-wood.toml", "0.5", "random", 0.01),
        (SCENES / "corridor/corridor.toml", "0.5", "sobol", 0.01), (SCENES / "corridor/corridor.toml", "0.5", "scrambled", 0.01),
        (SCENES / "office-luminaires/office-luminaires.toml", "0.3", "sobol", 0.01),
        (SCENES / "plates/plates.toml", "0.5", "halton", 0.004)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--fluxel", default=str(ROOT / "build/unity/app/fluxel"))
    parser.add_argument("--target-scale", type=float, default=1.0)
    options = parser.parse_args()
    good = 0
    for scene, edge, sequence, target in RUNS:
        with tempfile.TemporaryDirectory() as out:
            subprocess.run([options.fluxel, "photons", scene, "--max-edge", edge, "--sequence", sequence, "--target-error",
                            f"{target * options.target_scale}", "--quiet", "--out", out], check=True)
            with open(Path(out) / "convergence.csv") as file:
                rows = [row for row in csv.DictReader(file) if row["phase"] == "photons"]
        end = float(rows[-1]["seconds"])
        early = next(row for row in rows if float(row["seconds"]) >= 0.1 * end)
        forecast = float(early["forecast_s"] or "nan")
        good += abs(forecast / end - 1) <= 0.05
        print(f"{scene.stem:22} {sequence:10} {end:7.1f} s, said {forecast:7.1f} s after {float(early['seconds']):.1f} s: "
              f"{100 * (forecast / end - 1):+.1f} %", flush=True)
    print(f"{good} of {len(RUNS)} within 5 %")


if __name__ == "__main__":
    main()
