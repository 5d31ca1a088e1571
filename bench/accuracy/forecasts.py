#!/usr/bin/env python3
"""How far the recorded forecasts were from the end, after parts of each long phase, as a Markdown table.

    source scripts/mpi-env.sh; bench/accuracy/forecasts.py OUT ...           # folders of finished runs
    bench/accuracy/forecasts.py --run build/release/app/fluxel               # or makes runs of its own, in turn

A forecast is that of the first sample after the part; "-" says that there was none yet. Phases below --shortest seconds
are left out.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PARTS = (0.05, 0.1, 0.2, 0.5)
# Name, scene and options.
RUNS = (
    ("Cornell box, 128x128", "cornell-box/cornell-box.toml", "--resolution", "128x128"),
    ("office, 64x48", "office-2391/office-2391.toml", "--resolution", "64x48"),
    ("180 boxes, 64x48", "room-of-boxes/room-of-180-boxes.toml", "--resolution", "64x48"),
    ("wood, 96x72", "construction-in-wood/construction-in-wood.toml", "--resolution", "96x72"),
    # Visibility alone, of enough elements that it takes seconds.
    ("Cornell box, 256x256", "cornell-box/cornell-box.toml", "--resolution", "256x256", "--form-factor", "disc"),
    ("office, 128x96", "office-2391/office-2391.toml", "--resolution", "128x96", "--form-factor", "disc"),
    ("180 boxes, 128x96", "room-of-boxes/room-of-180-boxes.toml", "--resolution", "128x96", "--form-factor", "disc"),
    ("wood, 256x192", "construction-in-wood/construction-in-wood.toml", "--resolution", "256x192", "--form-factor", "disc"),
    # Many iterations.
    ("Cornell box, 96x96, Jacobi to 1e-4", "cornell-box/cornell-box.toml", "--resolution", "96x96", "--form-factor", "disc",
     "--solver", "jacobi", "--tolerance", "1e-4"),
    ("furnace, Jacobi to 1e-4", "furnace/furnace-0.9.toml", "--max-edge", "0.05", "--form-factor", "disc", "--closure",
     "--solver", "jacobi", "--tolerance", "1e-4"),
)

# References to a target error.
REFERENCES = (
    ("Cornell box, 64x64, to 1 %", "cornell-box/cornell-box.toml", "--resolution", "64x64", "--target-error", "0.01"),
    ("emitting wall, 64x64, to 0.7 %", "emitting-wall/emitting-wall.toml", "--resolution", "64x64", "--target-error",
     "0.007"),
    ("wood, 48x48, to 5 %", "construction-in-wood/construction-in-wood.toml", "--resolution", "48x48", "--target-error",
     "0.05"),
    ("courtyard, 64x48, to 2 %", "courtyard/courtyard.toml", "--resolution", "64x48", "--target-error", "0.02"),
)

# Photons to a target error.
PHOTONS = tuple(
    (f"{name}, {sequence}, to {100 * target:g} %", scene, "--max-edge", edge, "--sequence", sequence, "--target-error", str(target))
    for name, scene, edge, target, sequences in (
        ("Cornell box", "cornell-box/cornell-box.toml", "0.05", 0.012, ("sobol", "halton", "scrambled", "random")),
        ("wood", "construction-in-wood/construction-in-wood.toml", "0.5", 0.01, ("sobol", "random")),
        ("corridor", "corridor/corridor.toml", "0.5", 0.01, ("sobol", "scrambled")),
        ("office", "office-luminaires/office-luminaires.toml", "0.3", 0.01, ("sobol",)),
        ("plates", "plates/plates.toml", "0.5", 0.004, ("halton",)))
    for sequence in sequences)


def miss(record, part):
    """Of the forecast after that part, relative to the end; None where there was none."""
    end = record["final_s"]
    forecast = next(sample.get("forecast_s") for sample in record["samples"] if sample["time_s"] >= part * end)
    return None if forecast is None else forecast / end - 1


def rows_of(name, report, shortest):
    for phase, record in report["progress"].items():
        if record["final_s"] < shortest:
            continue
        misses = [miss(record, part) for part in PARTS]
        texts = ["-" if value is None else f"{100 * value:+.1f} %" for value in misses]
        yield f"| {name} | {phase} | {record['final_s']:.2f} | " + " | ".join(texts) + " |"


def reports(arguments):
    """Name and report of each run."""
    for folder in arguments.out:
        for file in (*folder.glob("re*.json"), *folder.glob("photons.json")):  # report.json, reference.json
            yield folder.name, json.loads(file.read_text())
    if not arguments.run:
        return
    for command, runs in ((("solve", "--method", "matrix"), RUNS), (("reference",), REFERENCES), (("photons",), PHOTONS)):
        if arguments.only and arguments.only != command[0]:
            continue
        for name, scene, *options in runs:
            with tempfile.TemporaryDirectory() as folder:
                subprocess.run([arguments.run, *command, ROOT / "scenes" / scene, *options, "--threads", "1", "--quiet",
                                "--out", folder], check=True)
                file = "report.json" if runs is RUNS else f"{command[0]}.json"
                yield name, json.loads((Path(folder) / file).read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", nargs="*", type=Path, metavar="OUT", help="folders of finished runs")
    parser.add_argument("--run", metavar="FLUXEL", help="the program, for runs of its own")
    parser.add_argument("--only", choices=("solve", "reference", "photons"), help="runs of this command alone")
    parser.add_argument("--shortest", type=float, default=0.5, help="phases below these seconds are left out")
    arguments = parser.parse_args()
    heads = ["run", "phase", "s", *(f"after {100 * part:g} %" for part in PARTS)]
    print("| " + " | ".join(heads) + " |\n" + "| --- " * len(heads) + "|", flush=True)
    for name, report in reports(arguments):
        for row in rows_of(name, report, arguments.shortest):
            print(row, flush=True)


if __name__ == "__main__":
    main()
