#!/usr/bin/env python3
"""Whether two builds of Fluxel give the same bytes: solution.ply and the hashes of every scene, by both methods.

    source scripts/mpi-env.sh; bench/same_results.py OLD NEW [--ranks 1 2 3 7]

OLD and NEW are programs `fluxel`. OLD runs on one rank, NEW on each number of ranks; ends with 1 where any differ.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
METHODS = {"matrix": ("--no-error-estimate",), "hierarchical": ("--block-error", "1e-3", "--subdivision", "transport")}


def result(program, ranks, scene, method, folder):
    """What may not differ: bytes of the solution, hashes of elements and visibility."""
    command = ["mpirun", "-np", str(ranks), "--oversubscribe", "--bind-to", "none", program, "solve", scene, "--method", method,
               *METHODS[method], "--resolution", "24x24", "--threads", "1", "--quiet", "--out", folder]
    if scene.stem == "heating-chamber":
        command.append("--thermal")
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3):  # 3: not converged, but written
        sys.exit(f"{' '.join(map(str, command))}\nended with {done.returncode}:\n{done.stderr}")
    return (folder / "solution.ply").read_bytes(), json.loads((folder / "report.json").read_text())["hash"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2, 3, 7])
    arguments = parser.parse_args()
    different = 0
    for scene in sorted((ROOT / "scenes").glob("*/*.toml")):
        for method in METHODS:
            with tempfile.TemporaryDirectory() as work:
                old = result(arguments.old, 1, scene, method, Path(work) / "old")
                wrong = [ranks for ranks in arguments.ranks
                         if result(arguments.new, ranks, scene, method, Path(work) / f"new-{ranks}") != old]
            different += len(wrong)
            print(f"{scene.stem}, {method}: {'differs on ' + str(wrong) + ' ranks' if wrong else 'the same'}", flush=True)
    sys.exit(1 if different else 0)


if __name__ == "__main__":
    main()
