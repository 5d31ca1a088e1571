"""Luminaires in a scene file: closed forms, the balance of their light, and paths of light."""

import math
import unittest

from fluxel_job import MATRIX, SCENES, JobTest, line_of, start

import fluxel
from result_files import read_exr

FLUX = 10000  # [lm], of an isotropic point in the middle of a cube of 4 m
DIRECT = FLUX / 96  # mean of the walls
CUBE = SCENES / "cie171" / "5.8-point-source.toml"
RHO = (0.1, 0.5, 0.9)


class LuminairesTest(JobTest):
    method = ()

    def scene(self, name, text):
        """A scene file of the repository with more text before its camera."""
        file = SCENES / name
        return self.write(file.name, file.read_text().replace('file = "', f'file = "{file.parent}/').replace(
            "[camera]", text + "\n[camera]", 1))

    def meters(self, folder=None):
        """Mean illuminance of each receiver."""
        receivers = fluxel.read_receivers((folder or self.out) / "receivers.csv")
        return {name: receiver.values.mean(axis=(0, 1)) for name, receiver in receivers.items()}

    def test_direct_light_of_a_point_is_exact(self):
        """CIE 171:2006, case 5.8, between walls that are nearly black."""
        self.assert_done(self.solve(self.scene(CUBE.relative_to(SCENES), "[materials.wall]\nrho = 0.0001\n"),
                                    "--resolution", "16x16"))
        found = self.meters()
        for name, exact in (("middle", FLUX / (4 * math.pi) / 4), ("corner", FLUX / (4 * math.pi) / (12 * math.sqrt(3)))):
            for channel in range(3):
                self.assertAlmostEqual(found[name][channel] / exact, 1, delta=1e-3, msg=name)
        energy = self.report()["energy"]
        self.assertAlmostEqual(energy["emitted"][0], FLUX, delta=1e-6 * FLUX)
        self.assertEqual(energy["escaped"], [0, 0, 0])

    def test_black_walls_end(self):
        """Nothing is sent on: the picture is black without an error, and so says the run."""
        job = self.solve(self.scene(CUBE.relative_to(SCENES), "[materials.wall]\nrho = 0\n"), "--resolution", "16x16",
                         limit=60)
        self.assert_done(job)
        self.assertEqual(job.warnings, [])
        self.assertEqual(self.report()["stated_error"], 0)
        self.assertEqual([of["leaves"] for of in self.report()["hierarchy"]["rounds"]], [6])
        self.assertAlmostEqual(self.meters()["middle"][0], FLUX / (4 * math.pi) / 4, delta=0.2)

    def test_an_opening_lets_links_converge(self):
        """Noise of its rays would be a residual that no splitting makes less: it took five million links and more."""
        scene = self.work / "opening.toml"
        scene.write_text(CUBE.read_text().replace('file = "', f'file = "{CUBE.parent}/').replace(
            "position = [0, 0, 0]", "position = [0.3, 0.2, 1.8]\naim = [0, 0, -1]\nsize = [1.2, 0.3]"))
        self.assert_done(self.solve(scene, "--exchange", "links", "--error-of", "surfaces", "--target-error", 0.03,
                                    "--resolution", "8x8", limit=100))
        hierarchy = self.report()["hierarchy"]
        self.assertLess(hierarchy["rounds"][-1]["links"], 100000)
        self.assertLess(self.report()["stated_error"], 0.03)

    def test_info_names_them(self):
        job = start(["info", CUBE], ranks=1)
        self.assert_done(job)
        self.assertIn("photometric", job.out)
        self.assertRegex(job.out, r"source +1e\+04 lm at 0,0,0")

    def test_reflected_light_of_a_point(self):
        """CIE 171:2006, case 5.8: in a closed room (1 - rho) S <H> is the flux."""
        for method in ((), (*MATRIX, "--subdivision", "uniform", "--max-edge", "0.251")):
            self.assert_done(self.solve(CUBE, *method, "--resolution", "16x16", "--tolerance", 1e-5))
            elements = fluxel.read_elements(self.out / "solution.ply")
            means = elements.areas @ elements.radiosity / elements.areas.sum()
            for channel, rho in enumerate(RHO):
                with self.subTest(method=method, rho=rho):
                    exact = DIRECT * rho / (1 - rho)
                    self.assertAlmostEqual((means[channel] / rho - DIRECT) / exact, 1, delta=1e-3)

    def test_energy_is_kept(self):
        """Of lamps that shine up and down in a room without a roof: emitted = absorbed + escaped."""
        lamps = "".join(f'[[luminaires]]\nname = "lamp {k}"\nfile = "{SCENES}/luminaires/ledalite-apex55.ies"\n'
                        f"position = [{0.15 + 0.1 * k}, 0.4, 0.3]\nsize = [0.1, 0.05]\n" for k in range(3))
        scene = self.scene("cornell-box/cornell-box.toml", lamps + "[materials.light]\nE = 0\n")
        scene.write_text(scene.read_text().replace('title', 'units = "photometric"\ntitle', 1))
        for method in (("--target-error", 0.03), MATRIX):
            with self.subTest(method=method):
                self.assert_done(self.solve(scene, *method, "--resolution", "32x32"))
                report = self.report()
                energy = report["energy"]
                emitted = energy["emitted"][0]
                self.assertAlmostEqual(emitted, 3 * 5296.65, delta=1)
                self.assertGreater(energy["escaped"][0], 0.05 * emitted)
                off = emitted - energy["absorbed"][0] - energy["escaped"][0] - energy["dark"][0]
                self.assertLess(abs(off), report["stated_error"] * emitted + 3 * energy["sampling_error"][0])

    def two_lamps(self):
        return self.write("two.toml", f"""[[geometry]]
file = "{SCENES}/cornell-box/cornell-box.obj"
metres_per_unit = 0.001
[materials.light]
E = 0
[[luminaires]]
name = "opening"
intensity = 1.0
position = [0.278, 0.5, 0.279]
size = [0.2, 0.1]
[[luminaires]]
name = "point"
intensity = 0.5
position = [0.45, 0.3, 0.1]
[camera]
eye = [0.278, 0.273, -0.8]
look_at = [0.278, 0.273, 0]
fov = 39.3
resolution = [24, 24]
""")

    def test_pictures_agree_with_paths_of_light(self):
        scene = self.two_lamps()
        truth = self.work / "truth"
        self.assert_done(start(["reference", scene, "--target-error", 0.02, "--supersample", 1, "--out", truth]))
        for exchange in ("links", "rays"):
            with self.subTest(exchange=exchange):
                self.assert_done(self.solve(scene, "--exchange", exchange, "--supersample", 1, "--target-error", 0.03))
                self.assert_done(start(["compare", self.out / "image.exr", truth / "reference.exr", "--fail-above", 0.04]))
                self.assertLess(self.report()["stated_error"], 0.04)
        # Elements near a lamp are large for what they reflect: their means alone are compared.
        self.assert_done(self.solve(scene, *MATRIX))
        self.assert_done(start(["reference", scene, "--elements", self.out / "solution.ply", "--only", "elements",
                                "--target-error", 0.03, "--out", truth]))
        self.assert_done(start(["compare", self.out / "solution.ply", truth / "reference.ply", "--fail-above", 0.08]))

    def test_every_number_of_ranks_gives_the_same_bytes(self):
        scene = self.two_lamps()
        for exchange in ("links", "rays"):
            of_ranks = []
            for ranks, threads in ((1, 2), (3, 1)):
                job = self.solve(scene, "--target-error", 0.1, "--resolution", "16x12", "--exchange", exchange,
                                 "--threads", threads, ranks=ranks)
                self.assert_done(job)
                image = read_exr(self.out / "image.exr")
                of_ranks.append(((self.out / "solution.ply").read_bytes(), image))
            self.assertEqual(of_ranks[0], of_ranks[1])

    def test_a_view_has_their_light(self):
        self.assert_done(self.solve(CUBE, "--resolution", "16x16"))
        direct = self.work / "view"
        self.assert_done(start(["view", CUBE, "--solution", self.out / "solution.ply", "--resolution", "16x16",
                                "--target-error", 0.05, "--out", direct]))
        for name, of_solve in self.meters().items():
            for a, b in zip(of_solve, self.meters(direct)[name], strict=True):
                self.assertAlmostEqual(a / b, 1, delta=0.05)

    def test_units_are_not_mixed_unasked(self):
        lamp = f'[[luminaires]]\nname = "lamp"\nfile = "{SCENES}/luminaires/ledalite-apex55.ies"\nposition = [0.3, 0.4, 0.3]\n'
        scene = self.scene("cornell-box/cornell-box.toml", lamp)
        text = scene.read_text()
        scene.write_text('units = "radiometric"\n' + text)
        self.assert_refused(self.solve(scene), "photometric", "luminous_efficacy", file=scene,
                            line=line_of(scene.read_text(), ".ies"))
        scene.write_text('units = "radiometric"\nluminous_efficacy = 179\n' + text)
        self.assert_done(self.solve(scene, "--dry-run"))
        self.assertAlmostEqual(self.report()["scene"]["luminaire_power"][0], 5296.65 / 179, delta=0.01)


if __name__ == "__main__":
    unittest.main()
