"""Heat of faces with convection, `fluxel solve --thermal --method matrix`, against networks whose one unknown is found
by bisection, and against dense elimination.

In a cube within a cube all faces of each have one radiosity by symmetry, and F from the inner one to the outer is 1, as
between infinite plates: the flux is sigma (T_1^4 - T_2^4) / (1 / eps_1 + A_1 / A_2 (1 / eps_2 - 1)).
"""

import unittest

from heat_job import TIGHT, HeatTest, convected, fluxed, heated
from radiation import (ADJACENT, OPPOSED, SIGMA, Surface, area_of, bisect, box_factors, inward, net_fluxes_with_convection,
                       wall_grid)

# What is asked of temperatures and powers.
CLOSE = 1e-4


def cube(group, side, outward):
    """[(group, material, corners)] of a cube around the origin, of one face a side."""
    half = side / 2
    return [(group, group, inward(name, cell)[::-1 if outward else 1])
            for name, cell in wall_grid((-half,) * 3, (half,) * 3, 1)]


def facing(T_1, eps_1, T_2, eps_2, ratio):
    """Flux [W/m2] from a cube to the one around it; ratio = A_1 / A_2."""
    return SIGMA * (T_1**4 - T_2**4) / (1 / eps_1 + ratio * (1 / eps_2 - 1))


class ConvectionTest(HeatTest):
    def cubes(self, inner, outer, sides=(1, 1.25)):
        return self.scene({"inner": inner, "outer": outer},
                          cube("inner", sides[0], True) + cube("outer", sides[1], False))

    def heat_exactly(self, scene, *arguments, **settings):
        """With --closure, which makes row sums 1: then the symmetric factors are exact."""
        return self.heat(scene, "--sides", "one", "--closure", *TIGHT, *arguments, **settings)

    def convection(self):
        return self.report()["solve"]["convection"]

    # Networks

    def test_plates_one_of_which_is_cooled_by_air(self):
        found = self.heat_exactly(self.cubes(heated(0.8, 900), "emissivity 0.6\n" + convected(25, 300)))
        ratio, area = 1 / 1.25**2, 6 * 1.25**2
        T = bisect(lambda x: 25 * (x - 300) * area - 6 * facing(900, 0.8, x, 0.6, ratio), 300, 900)
        taken = 25 * (T - 300) * area
        self.assertGreater(T, 500)
        inner, outer = found["inner", "front"], found["outer", "front"]
        self.assert_close(outer["temperature_K"], T, CLOSE)
        self.assert_close(inner["net_W"], taken, CLOSE)
        self.assert_close(outer["net_W"], -taken, CLOSE)
        self.assert_close(outer["convected_W"], taken, CLOSE)
        self.assertEqual(inner["convected_W"], 0)
        self.assert_close(outer["emitted_W"], 0.6 * SIGMA * T**4 * area, 4 * CLOSE)
        energy = self.report()["energy"]
        self.assert_close(energy["convected"][0], taken, CLOSE)
        self.assertLess(energy["defect_relative"], 1e-5)
        steps = self.convection()
        self.assertIn(steps["steps"], range(3, 8))
        self.assertLessEqual(steps["error_bound"], steps["tolerance"])
        self.assertLess(steps["last_change_k"], 1)

    def test_a_plate_that_air_heats(self):
        """What the air gives is emitted: there is no other source."""
        found = self.heat_exactly(self.cubes("emissivity 0.8\n" + convected(40, 800), heated(0.5, 0)))
        T = bisect(lambda x: facing(x, 0.8, 0, 0.5, 1 / 1.25**2) - 40 * (800 - x), 0, 800)
        given = 6 * 40 * (800 - T)
        self.assert_close(found["inner", "front"]["temperature_K"], T, CLOSE)
        self.assert_close(found["inner", "front"]["convected_W"], -given, CLOSE)
        energy = self.report()["energy"]
        self.assert_close(energy["emitted"][0], given, CLOSE)
        self.assertEqual(energy["convected"][0], 0)
        self.assertLess(energy["defect_relative"], 1e-5)

    def test_a_flux_and_convection_on_one_face(self):
        """A heater of 5 kW/m2, which the air around it cools."""
        found = self.heat_exactly(self.cubes(fluxed(5000, 0.8) + convected(15, 350), heated(0.5, 400)))
        T = bisect(lambda x: facing(x, 0.8, 400, 0.5, 1 / 1.25**2) - 5000 - 15 * (350 - x), 0, 3000)
        row = found["inner", "front"]
        self.assert_close(row["temperature_K"], T, CLOSE)
        self.assert_close(row["net_W"], 6 * (5000 - 15 * (T - 350)), CLOSE)
        self.assert_close(row["net_W"] + row["convected_W"], 6 * 5000, 1e-9)

    def test_a_shield_between_two_plates(self):
        """It conducts, so that both of its sides have the temperature at which they lose nothing together; the plate
        behind it is cooled by air."""
        def flux(T):
            """From the hot plate's 6 m2 to a shield of that temperature."""
            return 6 * facing(1000, 0.8, T, 0.1, 1 / 4)

        def behind(T):
            """The outer plate's temperature where it and the shield exchange what the shield gets."""
            return bisect(lambda x: 24 * facing(T, 0.1, x, 0.5, 4 / 9) - flux(T), 0, T)

        shield = bisect(lambda T: 8 * (behind(T) - 290) * 54 - flux(T), 700, 1000)
        scene = self.scene({"hot": heated(0.8, 1000), "shield": heated(0.1, shield),
                            "plate": "emissivity 0.5\n" + convected(8, 290)},
                           cube("hot", 1, True) + [("inside", "shield", c) for *_, c in cube("", 2, False)]
                           + [("outside", "shield", c) for *_, c in cube("", 2, True)] + [
                               ("plate", "plate", c) for *_, c in cube("", 3, False)])
        found = self.heat_exactly(scene)
        self.assert_close(found["inside", "front"]["net_W"], -flux(shield), CLOSE)
        self.assert_close(found["outside", "front"]["net_W"], flux(shield), CLOSE)
        self.assert_close(found["plate", "front"]["temperature_K"], behind(shield), CLOSE)
        self.assert_close(found["plate", "front"]["convected_W"], flux(shield), CLOSE)

    def test_a_furnace_of_three_zones(self):
        """Source, load in air and walls that radiate back: floor to ceiling directly, and by the walls, which float."""
        surfaces = {"source": Surface(0.9, T=1300.0), "load": Surface(0.6, q=0.0, h=60.0, air=400.0),
                    "wall": Surface(0.5, q=0.0)}
        sets = {"z0": "load", "z1": "source", "x0": "wall", "x1": "wall", "y0": "wall", "y1": "wall"}
        scene, _, _ = self.box(surfaces, sets)
        found = self.heat(scene, "--sides", "one", *TIGHT)
        conductance = OPPOSED + 1 / (2 / (4 * ADJACENT))
        resistance = 0.1 / 0.9 + 1 / conductance + 0.4 / 0.6
        net = lambda T: SIGMA * (1300.0**4 - T**4) / resistance
        T = bisect(lambda x: 60 * (x - 400) - net(x), 400, 1300)
        self.assert_close(found["load", "front"]["temperature_K"], T, CLOSE)
        self.assert_close(found["load", "front"]["convected_W"], net(T), CLOSE)
        self.assert_close(found["source", "front"]["net_W"], net(T), CLOSE)
        wall = SIGMA * (1300.0**4 + T**4) / 2 + net(T) * (0.4 / 0.6 - 0.1 / 0.9) / 2
        self.assert_close(found["wall", "front"]["temperature_K"], (wall / SIGMA) ** 0.25, CLOSE)
        self.assertAlmostEqual(found["wall", "front"]["net_W"], 0, delta=1e-6 * net(T))

    # Elements of one material with temperatures of their own

    def test_fine_walls(self):
        surfaces = {"heater": Surface(0.85, T=1100.0), "wall": Surface(0.7, q=200.0, h=20.0, air=300.0),
                    "back": Surface(0.5, q=0.0)}
        faces = {"z0": "heater", "z1": "wall", "x0": "wall", "x1": "back", "y0": "wall", "y1": "wall"}
        scene, names, cells = self.box(surfaces, faces, count=2, high=(3, 2, 1))
        found = self.heat(scene, "--sides", "one", *TIGHT)
        exact = net_fluxes_with_convection([surfaces[name] for name in names], box_factors(cells))
        temperatures = [T for name, (_, T) in zip(names, exact) if name == "wall"]
        self.assertGreater(max(temperatures), min(temperatures) + 30)
        for group in surfaces:
            rows = [(q, T, area_of(cell)) for name, cell, (q, T) in zip(names, cells, exact) if name == group]
            area = sum(A for *_, A in rows)
            self.assert_close(found[group, "front"]["temperature_K"],
                              (sum(A * T**4 for _, T, A in rows) / area) ** 0.25, CLOSE)
            net = sum(A * q for q, _, A in rows)
            self.assertAlmostEqual(found[group, "front"]["net_W"], net, delta=CLOSE * SIGMA * 1100.0**4 * 6)
            if group == "wall":
                self.assert_close(found[group, "front"]["convected_W"], 200 * area - net, CLOSE)

    def test_the_same_bytes_for_every_number_of_ranks(self):
        surfaces = {"hot": Surface(0.8, T=1000.0), "cold": Surface(0.3, q=0.0, h=30.0, air=280.0)}
        sets = {name: "hot" if name == "z0" else "cold" for name in ("x0", "x1", "y0", "y1", "z0", "z1")}
        scene, _, _ = self.box(surfaces, sets, count=4)
        tables = set()
        for ranks in (1, 2, 3):
            self.assert_done(self.solve(scene, "--thermal", "--sides", "one", "--threads", "1", ranks=ranks))
            tables.add((self.out / "thermal.csv").read_bytes())
        self.assertEqual(len(tables), 1)

    def test_both_sides_of_a_sheet_have_convection(self):
        """Far from all, in the open: each side radiates to 0 K."""
        square = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        scene = self.scene({"a": "emissivity 0.9\n" + convected(10, 300)}, [("a", "a", square)])
        found = self.heat(scene)
        T = bisect(lambda x: 0.9 * SIGMA * x**4 - 10 * (300 - x), 0, 300)
        for side in ("front", "back"):
            self.assert_close(found["a", side]["temperature_K"], T, 1e-8)

    # Emissivity by temperature

    def by_table(self, outer, *lines):
        """The cubes of a scene file whose inner one has an emissivity that falls from 0.9 at 400 to 0.3 at 1000 K."""
        self.cubes("", outer)
        return self.write("heat.toml", '[[geometry]]\nfile = "heat.obj"\n[options]\nthermal = true\n'
                                       "[materials.inner]\nemissivity = [[400, 0.9], [1000, 0.3]]\n" + "".join(lines))

    @staticmethod
    def eps(T):
        return 0.9 - 0.6 * min(max(T - 400, 0), 600) / 600

    def assert_inner(self, found, T, net):
        self.assert_close(found["inner", "front"]["temperature_K"], T, CLOSE)
        self.assert_close(found["inner", "front"]["emissivity"], self.eps(T), 3 * CLOSE)
        self.assert_close(found["inner", "front"]["net_W"], net, 3 * CLOSE)

    def test_emissivity_of_a_given_temperature(self):
        for T in (300, 700, 1300):
            with self.subTest(T=T):
                found = self.heat_exactly(self.by_table(heated(0.5, 350), f"temperature = {T}\n"))
                self.assert_inner(found, T, 6 * facing(T, self.eps(T), 350, 0.5, 1 / 1.25**2))

    def test_emissivity_of_a_given_flux(self):
        found = self.heat_exactly(self.by_table(heated(0.5, 350), "heat_flux = 4000\n"))
        T = bisect(lambda x: facing(x, self.eps(x), 350, 0.5, 1 / 1.25**2) - 4000, 350, 1500)
        self.assertTrue(400 < T < 1000, T)
        self.assert_inner(found, T, 6 * 4000)
        self.assertNotIn("convection", self.report()["solve"], "the system is linear")

    def test_emissivity_with_convection(self):
        """The outer one is cooled by air too: two unknown temperatures."""
        outer = "emissivity 0.5\n" + convected(20, 300)
        found = self.heat_exactly(self.by_table(outer, "heat_flux = 9000\nconvection_coefficient = 10\n"
                                                       "air_temperature = 350\n"))
        ratio = 1 / 1.25**2
        outside = lambda x: bisect(lambda y: 20 * (y - 300) - ratio * facing(x, self.eps(x), y, 0.5, ratio), 300, x)
        flux = lambda x: facing(x, self.eps(x), outside(x), 0.5, ratio)
        T = bisect(lambda x: flux(x) - 9000 - 10 * (350 - x), 400, 1500)
        self.assertTrue(400 < T < 1000, T)
        self.assert_inner(found, T, 6 * flux(T))
        self.assert_close(found["outer", "front"]["temperature_K"], outside(T), CLOSE)
        self.assertLess(self.report()["energy"]["defect_relative"], 1e-5)

    def test_an_emissivity_that_jumps_does_not_converge(self):
        """Cold faces hardly take in heat, and once they are hot much: both would balance."""
        surfaces = {"hot": Surface(0.9, T=900.0), "cold": Surface(0.5, q=0.0)}
        self.box(surfaces, {name: "hot" if name == "z0" else "cold" for name in ("x0", "x1", "y0", "y1", "z0", "z1")})
        self.write("heat.mtl", "newmtl hot\nKd 0\n" + heated(0.9, 900) + "newmtl cold\nKd 0\n" + convected(5, 300))
        scene = self.write("heat.toml", '[[geometry]]\nfile = "heat.obj"\n'
                                        "[materials.cold]\nemissivity = [[500, 0.02], [500.001, 0.95]]\n")
        job = self.solve(scene, "--thermal", "--sides", "one")
        self.assert_done(job, 3)
        self.assertEqual(len([line for line in job.warnings if "temperatures of faces with convection still change" in line]),
                         1, str(job))
        self.assertFalse(self.report()["solve"]["converged"])
        self.assertEqual(self.convection()["steps"], 50)
        self.assertGreater(self.convection()["last_change_k"], 1)

    # Degrees Celsius

    def test_celsius_in_and_out(self):
        self.cubes("emissivity 0.8\n", "emissivity 0.6\n")
        materials = ("[materials.inner]\nemissivity = [[{0}, 0.9], [{1}, 0.5]]\ntemperature = {1}\n"
                     "[materials.outer]\nconvection_coefficient = 25\nair_temperature = {2}\n")
        tables = []
        for unit, temperatures in (("kelvin", (273.15, 873.15, 293.15)), ("celsius", (0, 600, 20))):
            scene = self.write("heat.toml", f'temperature_unit = "{unit}"\n[[geometry]]\nfile = "heat.obj"\n'
                                            + materials.format(*temperatures))
            job = self.solve(scene, "--thermal", "--sides", "one", *TIGHT)
            self.assert_done(job)
            symbol = {"kelvin": "K", "celsius": "C"}[unit]
            self.assertRegex(job.out, rf"(?m)^group +side +area m2 +{symbol} +net W +error W$")
            tables.append(self.table(symbol))
            for row in self.report()["thermal"]:
                of_table = tables[-1][row["group"], row["side"]][f"temperature_{symbol}"]
                self.assertAlmostEqual(row[f"temperature_{symbol.lower()}"], of_table, delta=1e-5)
        kelvin, celsius = tables
        self.assertEqual(celsius["inner", "front"]["temperature_C"], 600)
        for key, row in kelvin.items():
            self.assertAlmostEqual(row["temperature_K"] - 273.15, celsius[key]["temperature_C"], delta=1e-5)
            self.assert_close(row["net_W"], celsius[key]["net_W"], 1e-9)

    # What is said, and refused

    def test_what_is_said(self):
        job = self.solve(self.cubes(heated(0.8, 900), "emissivity 0.6\n" + convected(25, 300)), "--thermal",
                         "--sides", "one")
        self.assert_done(job)
        self.assertRegex(job.out, r"(?m)^convection: \d+ steps; the last one changed temperatures by up to \S+ K")
        self.assertRegex(job.out, r"(?m)^convection: the air takes \S+ W from faces")
        self.assertEqual(job.warnings, [])
        self.assertNotIn("audit", self.report())

    def test_what_is_gathered_does_not_know_it(self):
        self.cubes("emissivity 0.3\n" + convected(5, 500), heated(0.5, 400), (1, 3))
        text = '[[geometry]]\nfile = "heat.obj"\n[options]\nthermal = true\nsides = "one"\n'
        receiver = '[[receivers]]\nname = "r"\norigin = [-0.2, -0.2, 1.0]\nu = [0.4, 0, 0]\nv = [0, 0.4, 0]\ncells = [2, 2]\n'
        self.assert_refused(self.solve(self.write("heat.toml", receiver + text), *TIGHT, ranks=2), "leave [[receivers]] out")
        camera = ("--eye", "0,0,1.2", "--look-at", "1,0.3,1.4", "--up", "0,0,1", "--resolution", "16x16", "--subdivision", "uniform",
                  "--max-edge", 1)
        scene = self.write("heat.toml", text)
        self.assert_refused(self.solve(scene, *camera, ranks=2), "add --picture elements")
        self.assert_refused(self.solve(scene, "--write", "vtu", "--mesh-max-edge", 0.5, ranks=2), "leave --mesh-max-edge and --write lightmap out")
        self.assert_refused(self.solve(scene, "--write", "lightmap", ranks=1), "leave --mesh-max-edge and --write lightmap out")
        self.assert_done(self.solve(scene, *camera, "--picture", "elements"))

    def test_other_methods_refuse_it(self):
        scene = self.cubes(heated(0.8, 900), "emissivity 0.6\n" + convected(25, 300))
        self.method = ("--method", "hierarchical")
        self.assert_refused(self.solve(scene, "--thermal", ranks=2), "material 'outer' has a convection_coefficient",
                            "--method matrix")

    def test_bad_values(self):
        triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"
        for text, line, words in (("convection_coefficient -1\n", 3, "convection_coefficient -1 of material 'a' is negative"),
                                  ("air_temperature -3\n", 3, "air_temperature -3 of material 'a' is below 0 kelvin"),
                                  ("temperature 300\nconvection_coefficient 5\n", 4, "either a temperature or convection"),
                                  ("convection_coefficient 5\ntemperature 300\n", 4, "either a temperature or convection")):
            with self.subTest(text):
                scene = self.write("bad.obj", "mtllib bad.mtl\n" + triangle)
                library = self.write("bad.mtl", "newmtl a\nKd 0.5\n" + text)
                self.assert_refused(self.solve(scene, "--subdivision", "none"), words, file=library, line=line)

    def test_no_air_temperature(self):
        scene = self.cubes(heated(0.8, 900), "emissivity 0.6\nconvection_coefficient 5\n")
        self.assert_refused(self.solve(scene, "--thermal"),
                            "material 'outer' has no air_temperature to its convection_coefficient", file=scene)


if __name__ == "__main__":
    unittest.main()
