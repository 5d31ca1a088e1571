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
import sys
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import fluxel
import numpy as np


def values(program, scene, size, **options):
    """Value and standard error of all pixels and channels: (2, pixels, pixels, 3)."""
    picture = fluxel.reference(scene, executable=program, only="picture", resolution=(size, size), **options).picture
    return np.stack([picture.values, picture.error]).astype(float)


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
    run = lambda **options: values(arguments.fluxel, arguments.scene, arguments.resolution, **options)
    if arguments.long_error:
        true, noise = run(target_error=arguments.long_error, sampling="even", seed=10**6)
    else:
        true, noise = arguments.exact / math.pi, 0
    print("| sampling | target | within one error | within two | bias over its error |\n" + "| --- " * 5 + "|")
    for sampling in ("even", "blocks"):
        for target in arguments.target_error:
            within, biases = {1: [], 2: []}, []
            for seed in range(1, arguments.seeds + 1):
                found, error = run(target_error=target, sampling=sampling, seed=seed)
                varies = error > 0
                off = (found - true)[varies]
                for errors, shares in within.items():
                    shares.append((abs(off) < errors * np.hypot(error, noise)[varies]).mean())
                biases.append(off.mean())
            bias = statistics.mean(biases) / (statistics.stdev(biases) / math.sqrt(len(biases)))
            print(f"| {sampling} | {100 * target:g} % | {spread(within[1])} | {spread(within[2])} | {bias:.1f} |", flush=True)


if __name__ == "__main__":
    main()
