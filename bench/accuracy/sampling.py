#!/usr/bin/env python3
"""Rays of `fluxel reference --sampling blocks` over those of `--sampling even` to the same stated error, as a Markdown table.

    bench/accuracy/sampling.py [--fluxel PROGRAM] [--scenes NAME ...] [--resolution N] [--rays N]
                               [--target-error E]

Measured are the pictures of the scenes in scenes/. `even` takes that many rays, or goes to that error; `blocks` ends where it
states the same. A pass adds up to a quarter, so that a ratio is known to about a tenth.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def measured(fluxel, scene, size, *options):
    """Of the picture, as reference.json has it; none of a scene without a camera."""
    with tempfile.TemporaryDirectory() as out:
        command = [fluxel, "reference", scene, "--only", "picture", "--resolution", f"{size}x{size}", "--out", out,
                   "--quiet", *map(str, options)]
        done = subprocess.run(command, check=False, capture_output=True, text=True)
        if "nothing to measure" in done.stderr:
            return None
        if done.returncode:
            raise SystemExit(f"{command}\nended with {done.returncode}:\n{done.stderr}")
        return json.loads((Path(out) / "reference.json").read_text())["measured"]["picture"]


def error(of):
    return max(of["relative_error_rgb"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fluxel", default=ROOT / "build/release/app/fluxel")
    parser.add_argument("--scenes", nargs="+", help="by name; default: all")
    parser.add_argument("--resolution", type=int, default=64)
    limit = parser.add_mutually_exclusive_group()
    limit.add_argument("--rays", type=float, default=1.5e7)
    limit.add_argument("--target-error", type=float)
    arguments = parser.parse_args()
    goal = ("--target-error", arguments.target_error) if arguments.target_error else ("--rays", int(arguments.rays))
    print("| scene | error | even: samples | rays | blocks: samples, least to most | rays | ratio |\n" + "| --- " * 7 + "|")
    for scene in sorted((ROOT / "scenes").glob("*/*.toml")):
        if arguments.scenes and scene.stem not in arguments.scenes:
            continue
        even = measured(arguments.fluxel, scene, arguments.resolution, "--sampling", "even", *goal)
        if even is None:
            continue
        # A hair more, as the figure is rounded where it is written.
        target = arguments.target_error or 1.000001 * error(even)
        blocks = measured(arguments.fluxel, scene, arguments.resolution, "--sampling", "blocks", "--target-error", target)
        print(f"| {scene.stem} | {100 * target:.3g} % | {even['samples']} | {even['rays']:.3g} | "
              f"{blocks['samples']}, {blocks['samples_min']} to {blocks['samples_max']} | {blocks['rays']:.3g} | "
              f"{blocks['rays'] / even['rays']:.2f} |", flush=True)


if __name__ == "__main__":
    main()
