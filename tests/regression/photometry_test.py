"""Illuminance of luminaires from files in a black room: against the closed sum of points, and Radiance for openings."""

import csv
import importlib.util
import math
import os
import subprocess
import unittest
from pathlib import Path

from fluxel_job import SCENES, JobTest

LEDALITE = SCENES / "luminaires" / "ledalite-apex55.ies"
RADIANCE = importlib.util.find_spec("pyradiance")
LUMENS_A_WATT = 179  # of Radiance

# Of a black room of 10 x 10 x 4 m, z up.
VERTICES = "".join(f"v {x} {y} {z}\n" for z in (0, 4) for x, y in ((-5, -5), (5, -5), (5, 5), (-5, 5)))
ROOM = f"mtllib black.mtl\nusemtl black\n{VERTICES}f 1 2 3 4\nf 8 7 6 5\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n"
POINTS = [(x, y, 0.8) for x in (-2.5, -1.5, -0.5, 0.5, 1.5, 2.5) for y in (-1.8, -0.6, 0.7, 1.9)]


def read_ies(text):
    """(C, gamma [degrees], rows of intensities [cd]) of a file without a tilt, its planes up to 360 degrees."""
    numbers = [float(word) for word in text.split("TILT=NONE")[1].split()]
    factor, vertical, horizontal = numbers[2] * numbers[10] * numbers[11], int(numbers[3]), int(numbers[4])
    gamma, rest = numbers[13:13 + vertical], numbers[13 + vertical:]
    C, rest = rest[:horizontal], rest[horizontal:]
    rows = [[factor * x for x in rest[k * vertical:(k + 1) * vertical]] for k in range(horizontal)]
    while C[-1] not in (0, 360):  # symmetries of 90 and 180 degrees
        last = C[-1]
        C, rows = C + [2 * last - c for c in C[-2::-1]], rows + rows[-2::-1]
    return C, gamma, rows


def between(angles, angle):
    """The place of an angle: the interval's number and how far in it."""
    k = max(n for n in range(len(angles) - 1) if angles[n] <= angle)
    return k, (angle - angles[k]) / (angles[k + 1] - angles[k])


def unit(v):
    return tuple(x / math.hypot(*v) for x in v)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def illuminance(photometry, position, aim, towards, point):
    """I cos / r^2 [lx] of a point luminaire on a face that looks up."""
    C, gamma, rows = photometry
    aim = unit(aim)
    ahead = unit(tuple(t - dot(towards, aim) * a for t, a in zip(towards, aim, strict=True)))
    way = tuple(p - q for p, q in zip(point, position, strict=True))
    distance = math.hypot(*way)
    way = unit(way)
    g, along_g = between(gamma, math.degrees(math.acos(dot(way, aim))))
    c, along_c = between(C, math.degrees(math.atan2(dot(way, cross(ahead, aim)), dot(way, ahead))) % 360)
    of_planes = [row[g] + along_g * (row[g + 1] - row[g]) for row in rows[c:c + 2]]
    return (of_planes[0] + along_c * (of_planes[1] - of_planes[0])) * -way[2] / distance**2


class PhotometryTest(JobTest):
    method = ()

    def meters(self, luminaires):
        """Illuminance of the points; no luminaire's size matters for cells of 1 mm."""
        self.write("black.mtl", "newmtl black\nKd 0 0 0\n")
        self.write("room.obj", ROOM)
        scene = 'units = "photometric"\n[[geometry]]\nfile = "room.obj"\nmetres_per_unit = 1\n' + luminaires
        for k, (x, y, z) in enumerate(POINTS):
            scene += (f'[[receivers]]\nname = "p{k}"\norigin = [{x - 5e-4}, {y - 5e-4}, {z}]\nu = [1e-3, 0, 0]\n'
                      "v = [0, 1e-3, 0]\ncells = [1, 1]\n")
        self.assert_done(self.solve(self.write("room.toml", scene)))
        with open(self.out / "receivers.csv", newline="", encoding="utf-8") as file:
            return [float(row["value_g"]) for row in csv.DictReader(file)]

    def assert_near(self, found, exact, error):
        self.assertEqual(len(found), len(exact))
        for point, a, b in zip(POINTS, found, exact, strict=True):
            self.assertAlmostEqual(a / b, 1, delta=error, msg=point)

    def test_points_are_the_closed_sum(self):
        photometry = read_ies(LEDALITE.read_text())
        lamps = [((-1.1, 0.3, 2.7), (0, 0, -1), (1, 0, 0)), ((1.4, -0.6, 2.9), (0.3, 0.1, -1), (0.5, 1, 0)),
                 ((0.2, 1.2, 2.4), (-0.2, 0.4, -1), (-1, 0.3, 0))]
        found = self.meters("".join(
            f'[[luminaires]]\nname = "{k}"\nfile = "{LEDALITE}"\nposition = {list(position)}\naim = {list(aim)}\n'
            f"turn = {list(towards)}\nsize = 0\nmaintenance_factor = 0.8\n" for k, (position, aim, towards) in enumerate(lamps)))
        exact = [0.8 * sum(illuminance(photometry, *lamp, point) for lamp in lamps) for point in POINTS]
        self.assert_near(found, exact, 0.0005)

    @unittest.skipUnless(RADIANCE, "there is no pyradiance")
    def test_openings_are_those_of_radiance(self):
        # Without the height of the opening, which Radiance has and Fluxel leaves out.
        flat = self.write("flat.ies", LEDALITE.read_text().replace("0.85 4.04 .292", "0.85 4.04 0"))
        self.assertNotEqual(flat.read_text(), LEDALITE.read_text())
        found = self.meters(f'[[luminaires]]\nname = "lamp"\nfile = "{flat}"\nposition = [0, 0, 3]\naim = [0, 0, -1]\n')
        package = Path(RADIANCE.origin).parent
        environment = {**os.environ, "PATH": f"{package / 'bin'}:{os.environ['PATH']}", "RAYPATH": f".:{package / 'lib'}"}

        def run(*command, **settings):
            return subprocess.run(command, cwd=self.work, env=environment, check=True, capture_output=True, **settings).stdout

        run("ies2rad", "-t", "default", "-c", "1", "1", "1", "-o", "lamp", "-p", ".", flat)
        (self.work / "hung.rad").write_bytes(run("xform", "-t", "0", "0", "3", "lamp.rad"))
        (self.work / "hung.oct").write_bytes(run("oconv", "hung.rad"))
        traced = run("rtrace", "-h", "-I", "-ab", "0", "-dj", "0", "-ds", "0.01", "-dt", "0", "-dc", "1", "hung.oct", text=True,
                     input="".join("{} {} {} 0 0 1\n".format(*point) for point in POINTS))
        self.assert_near(found, [LUMENS_A_WATT * float(line.split()[1]) for line in traced.splitlines()], 0.01)


if __name__ == "__main__":
    unittest.main()
