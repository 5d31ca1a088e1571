#!/usr/bin/env python3
"""Whether means of `fluxel reference --sampling blocks` are biased: many short runs of a small picture against a long one.

    bench/accuracy/sampling_bias.py [--fluxel PROGRAM] [--scene FILE] [--runs N] [--rays N] [--resolution N]

The scene has a lamp that is seen through an opening, so that short runs often miss its light. The picture's mean over the runs,
less that of a long run with `--sampling even` (rays of 300 short ones), is printed over its standard error, for each channel
with light, as is how far single runs are off in units of their own stated errors (root mean square; 1 where these are right).
"""

import argparse
import json
import math
import statistics
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def measured(arguments, rays, seed, sampling):
    """Means and their standard errors."""
    size = f"{arguments.resolution}x{arguments.resolution}"
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([arguments.fluxel, "reference", arguments.scene, "--only", "picture", "--resolution", size, "--rays",
                        str(int(rays)), "--seed", str(seed), "--sampling", sampling, "--out", out, "--quiet"], check=True)
        of = json.loads((Path(out) / "reference.json").read_text())["measured"]["picture"]
    root = math.sqrt(of["sensors"])
    return [(mean, error * mean / root) for mean, error in zip(of["mean_rgb"], of["relative_error_rgb"])]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fluxel", default=ROOT / "build/release/app/fluxel")
    parser.add_argument("--scene", default=ROOT / "scenes/cie171/5.4-opening-a.toml")
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--rays", type=float, default=1e5)
    parser.add_argument("--resolution", type=int, default=24)
    arguments = parser.parse_args()
    truth = measured(arguments, 300 * arguments.rays, 10**6, "even")
    runs = [measured(arguments, arguments.rays, seed, "blocks") for seed in range(1, arguments.runs + 1)]
    print("| channel | long run | mean of the runs | difference over its error | single runs over their errors |\n" + "| --- " * 5 + "|")
    for name, (exact, noise), values in zip("RGB", truth, zip(*runs)):
        means = [mean for mean, _ in values]
        if exact == 0:
            continue
        mean, own = statistics.mean(means), statistics.stdev(means) / math.sqrt(len(means))
        # Each by the root mean square of what the runs state.
        stated = math.sqrt(statistics.mean(error * error for _, error in values))
        print(f"| {name} | {exact:.6g} +- {noise:.2g} | {mean:.6g} +- {own:.2g} | {(mean - exact) / math.hypot(own, noise):.2f} | "
              f"{statistics.stdev(means) / stated:.2f} |")


if __name__ == "__main__":
    main()
