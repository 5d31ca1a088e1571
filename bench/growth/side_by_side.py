#!/usr/bin/env python3
"""Copies of an OBJ scene side by side along x: rooms that do not see each other, of the same materials.

    bench/growth/side_by_side.py room.obj four.obj --copies 4

The MTL file has to stand beside the new file too. Texture coordinates and normals are left out.
"""

import argparse

GAP = 0.05  # of the width


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source")
    parser.add_argument("target")
    parser.add_argument("--copies", type=int, default=4)
    given = parser.parse_args()
    with open(given.source, encoding="utf-8") as file:
        lines = [line.split() for line in file if line.strip()]
    xs = [float(words[1]) for words in lines if words[0] == "v"]
    if not xs:
        parser.error(f"{given.source}: no vertices")
    step = (1 + GAP) * (max(xs) - min(xs))
    with open(given.target, "w", encoding="utf-8") as file:
        for copy in range(given.copies):
            for key, *words in lines:
                if key == "v":
                    words[0] = f"{float(words[0]) + copy * step:.9g}"
                elif key == "f":
                    corners = [int(corner.split("/")[0]) for corner in words]
                    # Negative numbers count from the last vertex.
                    words = [str(k + copy * len(xs) if k > 0 else k) for k in corners]
                elif key in ("g", "o"):
                    key, words = "g", [f"{'_'.join(words)}_{copy}"]
                elif key in ("vt", "vn") or key == "mtllib" and copy > 0:
                    continue
                file.write(" ".join([key, *words]) + "\n")


if __name__ == "__main__":
    main()
