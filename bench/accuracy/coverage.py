#!/usr/bin/env python3
"""How often the true value lies within one and two stated errors of `fluxel reference`, as a Markdown table.

    bench/accuracy/coverage.py SCENE (--exact B | --long-error E) [--fluxel PROGRAM] [--resolution N] [--seeds N]
                               [--target-error E ...]

The truth is a radiance, or a reference of another seed to a smaller error, whose own error is taken into account. Counted
are all pixels and channels that vary, of all seeds together; beside the shares stands one standard error of them between
the seeds, and the mean of all values less the truth over its own error. Student's t of 15 degrees of freedom has
66.7 % and 93.6 % (`even`), of 14 degrees 66.6 % and 93.5 % (`blocks`).
"""

import argparse
import math
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from reference_files import read_exr

CHANNELS = ("R", "G", "B")


def values(fluxel, scene, size, *options):
    """[(value, standard error)] of all pixels, channel by channel."""
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([fluxel, "reference", scene, "--only", "picture", "--resolution", f"{size}x{size}", "--out", out, "--quiet",
                        *map(str, options)], check=True)
        image = read_exr(Path(out) / "reference.exr")
    flat = {name: [x for row in rows for x in row] for name, rows in image.items()}
    return [pair for c in CHANNELS for pair in zip(flat[c], flat[f"error.{c}"])]


def spread(shares):
    return f"{100 * statistics.mean(shares):.1f} +- {100 * statistics.stdev(shares) / math.sqrt(len(shares)):.1f} %"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    truth = parser.add_mutually_exclusive_group(required=True)
    truth.add_argument("--exact", type=float, help="radiosity of all that is seen")
    truth.add_argument("--long-error", type=float)
    parser.add_argument("--fluxel", default=ROOT / "build/release/app/fluxel")
    parser.add_argument("--resolution", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=12)
    parser.add_argument("--target-error", type=float, nargs="+", default=[0.05, 0.03])
    arguments = parser.parse_args()
    run = lambda *options: values(arguments.fluxel, arguments.scene, arguments.resolution, *options)
    exact = run("--target-error", arguments.long_error, "--sampling", "even", "--seed", 10**6) if arguments.long_error else None
    print("| sampling | target | within one error | within two | bias over its error |\n" + "| --- " * 5 + "|")
    for sampling in ("even", "blocks"):
        for target in arguments.target_error:
            within, biases = {1: [], 2: []}, []
            for seed in range(1, arguments.seeds + 1):
                found = run("--target-error", target, "--sampling", sampling, "--seed", seed)
                truths = exact or [(arguments.exact / math.pi, 0)] * len(found)
                off = [(value - true, error, noise) for (value, error), (true, noise) in zip(found, truths) if error > 0]
                for errors, shares in within.items():
                    shares.append(sum(abs(d) < errors * math.hypot(e, n) for d, e, n in off) / len(off))
                biases.append(sum(d for d, *_ in off) / len(off))
            bias = statistics.mean(biases) / (statistics.stdev(biases) / math.sqrt(len(biases)))
            print(f"| {sampling} | {100 * target:g} % | {spread(within[1])} | {spread(within[2])} | {bias:.1f} |", flush=True)


if __name__ == "__main__":
    main()
