"""Scenes of heat for `fluxel solve --thermal`, and the table of a run."""

import csv

from fluxel_job import JobTest
from radiation import inward, wall_grid

HEADER = "group,side,area_m2,temperature_K,emissivity,emitted_W,absorbed_W,net_W,error_W,convected_W,reached"
TIGHT = ("--tolerance", "3e-5", "--form-factor-tolerance", "1e-5")


def heated(eps, T):
    return f"emissivity {eps}\ntemperature {T}\n"


def fluxed(q, eps=None):
    return (f"emissivity {eps}\n" if eps else "") + f"heat_flux {q}\n"


def convected(h, air):
    return f"convection_coefficient {h}\nair_temperature {air}\n"


def statements(surface):
    if surface.T is not None:
        return heated(surface.eps, surface.T)
    return fluxed(surface.q, surface.eps) + (convected(surface.h, surface.air) if surface.h else "")


class HeatTest(JobTest):
    def scene(self, materials, faces, name="heat"):
        """An OBJ of [(group, material, corners)] with {material: MTL statements}."""
        self.write(f"{name}.mtl", "".join(f"newmtl {key}\nKd 0.5\n{text}" for key, text in materials.items()))
        lines, count = [f"mtllib {name}.mtl"], 0
        for group, material, corners in faces:
            lines += [f"g {group}", f"usemtl {material}"]
            lines += ["v {:.17g} {:.17g} {:.17g}".format(*corner) for corner in corners]
            lines.append("f " + " ".join(str(count + k) for k in range(1, len(corners) + 1)))
            count += len(corners)
        return self.write(f"{name}.obj", "\n".join(lines) + "\n")

    def box(self, surfaces, materials, count=1, low=(0, 0, 0), high=(1, 1, 1)):
        """A box seen from inside; `materials` tells the surface of every face, which is also its group."""
        cells = wall_grid(low, high, count)
        scene = self.scene({name: statements(surface) for name, surface in surfaces.items()},
                           [(materials[face], materials[face], inward(face, cell)) for face, cell in cells])
        return scene, [materials[face] for face, _ in cells], [cell for _, cell in cells]

    def heat(self, scene, *arguments, code=0, **settings):
        """{(group, side): row} of the table of a run."""
        # Without paths errors are those of the solver alone.
        job = self.solve(scene, "--thermal", "--audit", 0, *arguments, **settings)
        self.assert_done(job, code)
        return self.table()

    def table(self, unit="K"):
        with (self.out / "thermal.csv").open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        header = HEADER.replace("_K", f"_{unit}")
        self.assertEqual((self.out / "thermal.csv").read_text().splitlines()[0], header)
        numbers = lambda row: {key: float(row[key] or "nan") for key in header.split(",")[2:-1]}
        found = {(row["group"], row["side"]): numbers(row) for row in rows}
        self.assertEqual(len(found), len(rows))
        return found

    def assert_close(self, value, expected, relative):
        self.assertAlmostEqual(value, expected, delta=relative * abs(expected))

    def assert_net(self, row, expected, form_factors=1e-5):
        self.assertAlmostEqual(row["net_W"], expected, delta=row["error_W"] + form_factors * abs(expected))
        self.assertLess(row["error_W"], 1e-4 * abs(expected))
