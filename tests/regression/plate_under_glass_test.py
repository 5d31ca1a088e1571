"""The exact light of scenes/plate-under-glass, by bench/photons/plate_under_glass.py, against rays that are traced here."""

import sys
import unittest

from fluxel_job import SCENES

sys.path.append(str(SCENES.parent / "bench/photons"))

import numpy as np
import plate_under_glass as exact
from scene_parts import plate_under_glass as scene

CELLS = 8


def traced(count, seed):
    """Illuminance of CELLS x CELLS squares by random rays through the slab, and its standard errors [lx]. Each ray is
    followed from face to face by the laws as vectors, and carries on with the part that goes on."""
    random = np.random.default_rng(seed)
    table = exact.scene_table()
    # Even over the cone to the last angle.
    cosine = 1 - random.random(count) * (1 - np.cos(table.gamma[-1]))
    C = 2 * np.pi * random.random(count)
    gamma = np.arccos(cosine)
    planes = np.array([np.interp(gamma, table.gamma, row) for row in table.intensity])
    step = table.C[1] - table.C[0]
    plane = np.minimum((C / step).astype(int), table.C.size - 2)
    part = C / step - plane
    rays = np.arange(count)
    I = (1 - part) * planes[plane, rays] + part * planes[plane + 1, rays]
    power = I * 2 * np.pi * (1 - np.cos(table.gamma[-1])) / count
    n = scene.REFRACTION_INDEX
    direction = np.stack([np.sin(gamma) * np.cos(C), np.sin(gamma) * np.sin(C), -cosine])
    inside = np.stack([direction[0] / n, direction[1] / n, np.zeros(count)])
    inside[2] = -np.sqrt(1 - inside[0] ** 2 - inside[1] ** 2)
    # Brewster's form of Fresnel's equations, by the angles themselves.
    behind = np.arcsin(np.sin(gamma) / n)
    R = 0.5 * (np.sin(gamma - behind) ** 2 / np.sin(gamma + behind) ** 2
               + np.tan(gamma - behind) ** 2 / np.tan(gamma + behind) ** 2)
    place = direction[:2] / cosine * (scene.SOURCE_HEIGHT - scene.SLAB_HIGH)
    power = power * (1 - R)
    across = inside[:2] / -inside[2] * (scene.SLAB_HIGH - scene.SLAB_LOW)
    half = 0.5 * scene.PLATE_EDGE
    sums, squares = np.zeros((CELLS, CELLS)), np.zeros((CELLS, CELLS))
    for _ in range(4):
        place = place + across
        x, y = place + direction[:2] / cosine * scene.SLAB_LOW
        edges = np.linspace(-half, half, CELLS + 1)
        arrived = power * (1 - R)
        sums += np.histogram2d(y, x, bins=(edges, edges), weights=arrived)[0]
        squares += np.histogram2d(y, x, bins=(edges, edges), weights=arrived**2)[0]
        place, power = place + across, power * R * R
    area = (scene.PLATE_EDGE / CELLS) ** 2
    return sums / area, np.sqrt(squares - sums**2 / count) / area


class PlateUnderGlassTest(unittest.TestCase):
    def test_traced_rays_agree(self):
        means, error = exact.cell_means(CELLS)
        self.assertLess(error, 1e-9)
        found, noise = traced(2_000_000, 3)
        self.assertLess(np.max(noise / found), 0.02)
        off = (found - means) / noise
        # 64 normal deviates: beyond 4.5 once in 2,000 seeds.
        self.assertLess(np.max(np.abs(off)), 4.5)
        self.assertLess(abs(np.mean(off**2) - 1), 0.6)

    def test_cells_add_up(self):
        fine, _ = exact.cell_means(32)
        coarse, _ = exact.cell_means(8)
        mean = fine.reshape(8, 4, 8, 4).mean(axis=(1, 3))
        self.assertLess(np.max(np.abs(mean / coarse - 1)), 1e-12)

    def test_all_light_of_a_slab_that_hides_nothing(self):
        """All light that the faces let through, over a plate that all of it reaches; without glass I cos^3 / h^2."""
        slab = exact.Slab()
        means, _ = exact.cell_means(2, edge=16.0)
        F = exact.PlaneFlux(slab, exact.scene_table())
        # All pairs of reflections: (1 - R)^2 (1 + R^2 + R^4 ...) = (1 - R) / (1 + R), with the mean over C, a trapezoid.
        table = exact.scene_table()
        nodes, weights = exact.unit_rule(12)
        whole = 0.0
        for g in range(table.gamma.size - 1):
            width = table.gamma[g + 1] - table.gamma[g]
            gamma = table.gamma[g] + width * nodes
            R = slab.reflectance(gamma)
            mean = table.intensity[:-1].mean(axis=0)
            I = mean[g] + nodes * (mean[g + 1] - mean[g])
            whole += 2 * np.pi * np.sum(weights * width * np.sin(gamma) * I * (1 - R) / (1 + R))
        self.assertLess(abs(means.sum() * 64 / whole - 1), 1e-12)
        bare = exact.PlaneFlux(exact.Slab(index=1.0), table)
        x, y = np.array([0.3, -0.2]), np.array([0.1, 0.7])
        gamma = np.arctan(np.hypot(x, y) / scene.SOURCE_HEIGHT)
        C = np.arctan2(y, x)
        I = [np.interp(c, table.C, [np.interp(g, table.gamma, row) for row in table.intensity]) for g, c in zip(gamma, C)]
        self.assertLess(np.max(np.abs(bare.illuminance(x, y) / (I * np.cos(gamma) ** 3 / scene.SOURCE_HEIGHT**2) - 1)), 1e-12)
        self.assertEqual(len(F.orders), 6)

    def test_nothing_comes_by_the_sides(self):
        self.assertLess(exact.side_share(), 1e-9)


if __name__ == "__main__":
    unittest.main()
