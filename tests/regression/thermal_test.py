"""Heat between grey surfaces, `fluxel solve --thermal`, against networks, closed forms and dense elimination.

With TIGHT both sides solve the same linear system and differ by --tolerance, whose bound for a row is its
error_W, and by the form factors' last digits (1e-5); 1e-3 is what the default rule promises of a row of form
factors.
"""

import itertools
import math
import unittest

from fluxel_job import OUTPUTS, SCENES
from heat_job import TIGHT, HeatTest, fluxed, heated
from radiation import ADJACENT, OPPOSED, SIGMA, Surface, area_of, box_factors, net_fluxes, wall_grid
from rooms import INSIDE, ROOM, MTL

FLOOR_CEILING_WALLS = {"z0": "floor", "z1": "ceiling", "x0": "wall", "x1": "wall", "y0": "wall", "y1": "wall"}
HOT_FLOOR = {name: "hot" if name == "z0" else "cold" for name in FLOOR_CEILING_WALLS}
HEATED_ROOM = MTL.replace("newmtl light", "heat_flux 0\nnewmtl light") + "emissivity 0.5\ntemperature 600\n"
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"


def square(z, up, half=0.5):
    corners = [(-half, -half, z), (half, -half, z), (half, half, z), (-half, half, z)]
    return corners if up else corners[::-1]


def icosphere(radius, splits, outward):
    """An icosahedron whose triangles are split in four, corners on the sphere."""
    golden = (1 + math.sqrt(5)) / 2
    corners = [(a, b * golden, 0.0) for a in (-1, 1) for b in (-1, 1)]
    corners = [tuple(p[(k + shift) % 3] for k in range(3)) for p in corners for shift in range(3)]
    triangles = [triple for triple in itertools.combinations(corners, 3)
                 if max(math.dist(p, q) for p, q in itertools.combinations(triple, 2)) < 2.1]
    for _ in range(splits):
        middle = lambda p, q: tuple((a + b) / 2 for a, b in zip(p, q))
        triangles = [part for p, q, r in triangles for part in (
            (p, middle(p, q), middle(p, r)), (q, middle(q, r), middle(q, p)), (r, middle(r, p), middle(r, q)),
            (middle(p, q), middle(q, r), middle(r, p)))]
    faces = []
    for triangle in triangles:
        p, q, r = (tuple(radius * a / math.hypot(*corner) for a in corner) for corner in triangle)
        faces.append((p, q, r) if (dot(normal(p, q, r), p) > 0) == outward else (p, r, q))
    return faces


def normal(p, q, r):
    """Twice as long as the area."""
    a, b = ([x - y for x, y in zip(corner, p)] for corner in (q, r))
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(p, q):
    return sum(a * b for a, b in zip(p, q))


PLATES = [("a", "a", square(0, True)), ("b", "b", square(1, False))]


class ThermalTest(HeatTest):
    def assert_dense(self, found, surfaces, names, F, areas, relative):
        """Net powers and temperatures of all groups as elimination finds them."""
        of_elements = net_fluxes([surfaces[name] for name in names], F)
        scale = max(abs(q) * area for (q, _), area in zip(of_elements, areas))
        for group in surfaces:
            rows = [(q, T, A) for name, (q, T), A in zip(names, of_elements, areas) if name == group]
            area = sum(A for *_, A in rows)
            row = found[group, "front"]
            self.assert_close(row["area_m2"], area, 1e-7)
            net, fourth_power = sum(q * A for q, _, A in rows), sum(T**4 * A for _, T, A in rows) / area
            self.assertAlmostEqual(row["net_W"], net, delta=relative * scale * len(rows))
            self.assert_close(row["temperature_K"], fourth_power**0.25, relative)
            self.assert_close(row["emissivity"], surfaces[group].eps, 1e-9)

    # Networks: what one element a surface must give exactly

    def test_an_enclosure_of_two_surfaces(self):
        """Floor and ceiling against four walls: by symmetry each set has one radiosity."""
        hot, cold = Surface(0.8, T=1000.0), Surface(0.3, T=400.0)
        sets = {face: "hot" if face[0] == "z" else "cold" for face in HOT_FLOOR}
        scene, _, _ = self.box({"hot": hot, "cold": cold}, sets)
        found = self.heat(scene, "--sides", "one", *TIGHT)
        resistance = (1 - 0.8) / (2 * 0.8) + 1 / (2 * 4 * ADJACENT) + (1 - 0.3) / (4 * 0.3)
        net = SIGMA * (1000.0**4 - 400.0**4) / resistance
        self.assert_net(found["hot", "front"], net)
        self.assert_net(found["cold", "front"], -net)
        self.assertEqual(found["hot", "front"]["temperature_K"], 1000)
        self.assert_close(found["hot", "front"]["emitted_W"], 2 * 0.8 * SIGMA * 1000.0**4, 1e-9)
        for row in found.values():
            self.assertAlmostEqual(row["emitted_W"] - row["absorbed_W"], row["net_W"], delta=1e-6)

    def test_concentric_spheres(self):
        """F_12 = 1 for the polyhedra too, and --closure makes it so; B varies over their triangles by what they
        are off spheres."""
        inner, outer = icosphere(1.0, 2, True), icosphere(2.0, 2, False)
        areas = [sum(math.hypot(*normal(*face)) / 2 for face in faces) for faces in (inner, outer)]
        faces = [("inner", "inner", face) for face in inner] + [("outer", "outer", face) for face in outer]
        scene = self.scene({"inner": heated(0.7, 900.0), "outer": heated(0.4, 300.0)}, faces)
        found = self.heat(scene, "--sides", "one", "--closure", "--tolerance", "1e-4")
        resistance = (1 - 0.7) / (areas[0] * 0.7) + 1 / areas[0] + (1 - 0.4) / (areas[1] * 0.4)
        net = SIGMA * (900.0**4 - 300.0**4) / resistance
        self.assert_close(found["inner", "front"]["net_W"], net, 2e-4)
        self.assert_close(found["outer", "front"]["net_W"], -net, 2e-4)
        self.assert_close(found["outer", "front"]["area_m2"], areas[1], 1e-6)

    def test_reradiating_walls(self):
        """The series-parallel network: floor to ceiling directly, and by the walls, which float."""
        surfaces = {"floor": Surface(0.9, T=1200.0), "ceiling": Surface(0.6, T=500.0),
                    "wall": Surface(0.5, q=0.0)}
        scene, _, _ = self.box(surfaces, FLOOR_CEILING_WALLS)
        found = self.heat(scene, "--sides", "one", *TIGHT)
        conductance = OPPOSED + 1 / (2 / (4 * ADJACENT))
        net = SIGMA * (1200.0**4 - 500.0**4) / (0.1 / 0.9 + 1 / conductance + 0.4 / 0.6)
        self.assert_net(found["floor", "front"], net)
        self.assert_net(found["ceiling", "front"], -net)
        self.assertAlmostEqual(found["wall", "front"]["net_W"], 0, delta=1e-9 * net)
        # The walls' node floats half-way between both radiosities.
        B_floor = SIGMA * 1200.0**4 - net * 0.1 / 0.9
        B_ceiling = SIGMA * 500.0**4 + net * 0.4 / 0.6
        wall = ((B_floor + B_ceiling) / 2 / SIGMA) ** 0.25
        self.assert_close(found["wall", "front"]["temperature_K"], wall, 3e-5)
        self.assertEqual(found["wall", "front"]["error_W"], 0)
        self.assertGreater(found["floor", "front"]["error_W"], 0)

    # Dense elimination, with view factors in closed form

    def test_fine_walls_with_fluxes_both_ways(self):
        surfaces = {"heater": Surface(0.85, q=20e3), "load": Surface(0.7, T=700.0),
                    "wall": Surface(0.5, q=0.0), "drain": Surface(0.6, q=-1500.0),
                    "door": Surface(1.0, T=300.0)}
        faces = {"z0": "load", "z1": "heater", "x0": "door", "x1": "drain", "y0": "wall", "y1": "wall"}
        scene, names, cells = self.box(surfaces, faces, count=3, high=(3, 2, 1))
        found = self.heat(scene, "--sides", "one", *TIGHT)
        self.assert_dense(found, surfaces, names, box_factors(cells), [area_of(cell) for cell in cells], 3e-5)
        self.assert_close(found["drain", "front"]["net_W"], -1500.0 * 2, 1e-7)
        self.assertAlmostEqual(sum(row["net_W"] for row in found.values()), 0, delta=2e-5 * 20e3 * 6)
        energy = self.report()["energy"]
        self.assertGreater(energy["emitted"][0], 0)
        self.assertLess(energy["defect_relative"], 2e-5)

    def test_uniform_elements_tend_to_the_same_limit(self):
        """--max-edge alone makes uniform elements: 4 x 4 a face, as in the elimination."""
        surfaces = {"floor": Surface(0.9, T=1200.0), "ceiling": Surface(0.6, T=500.0),
                    "wall": Surface(0.5, q=0.0)}
        scene, _, _ = self.box(surfaces, FLOOR_CEILING_WALLS)
        found = self.heat(scene, "--sides", "one", "--max-edge", "0.25")
        self.assertEqual(self.report()["elements"], 96)
        self.assertEqual(self.report()["options"]["subdivision"], "uniform")
        cells = wall_grid((0, 0, 0), (1, 1, 1), 4)
        names, rectangles = [FLOOR_CEILING_WALLS[face] for face, _ in cells], [cell for _, cell in cells]
        areas = [area_of(cell) for cell in rectangles]
        self.assert_dense(found, surfaces, names, box_factors(rectangles), areas, 1e-3)

    # Two sides

    def sheet(self, *texts):
        hot, cold = (0.8, 1000.0), (0.5, 300.0)
        return self.scene({"hot": heated(*hot), "cold": heated(*cold), "sheet": "".join(texts)},
                          [("bottom", "hot", square(0, True)), ("sheet", "sheet", square(1, True)),
                           ("top", "cold", square(2, False))])

    def of_sheet(self, sheet):
        """(q, T) of bottom, sheet's back, sheet's front, top: the sheet hides the plates from each other. All
        else is open, a black surface at 0 K."""
        F = [[0, OPPOSED, 0, 0], [OPPOSED, 0, 0, 0], [0, 0, 0, OPPOSED], [0, 0, OPPOSED, 0]]
        for row in F:
            row.append(1 - OPPOSED)
        F.append([0.0] * 5)
        return net_fluxes([Surface(0.8, T=1000.0), sheet, sheet, Surface(0.5, T=300.0), Surface(1.0, T=0.0)], F)

    def assert_sheet(self, found, sheet):
        rows = [("bottom", "front"), ("sheet", "back"), ("sheet", "front"), ("top", "front")]
        self.assertLessEqual(set(rows), set(found))
        scale = SIGMA * 1000.0**4
        for key, (q, T) in zip(rows, self.of_sheet(sheet)):
            self.assertAlmostEqual(found[key]["net_W"], q, delta=1e-5 * scale, msg=key)
            # H is within --tolerance times the mean of B, which is below that of the hot plate, and the form
            # factors' last digits.
            self.assertAlmostEqual(SIGMA * found[key]["temperature_K"]**4, SIGMA * T**4, delta=4e-5 * scale, msg=key)

    def test_a_sheet_sends_from_both_sides(self):
        found = self.heat(self.sheet(heated(0.3, 600.0)), *TIGHT)
        self.assert_sheet(found, Surface(0.3, T=600.0))
        # The plates' outer sides see nothing but the open.
        self.assert_close(found["bottom", "back"]["net_W"], 0.8 * SIGMA * 1000.0**4, 1e-9)
        self.assertEqual(found["bottom", "back"]["absorbed_W"], 0)
        escaped = self.report()["energy"]["escaped"][0]
        net = sum(row["net_W"] for row in found.values())
        self.assertAlmostEqual(net, escaped, delta=4 * self.report()["energy"]["sampling_error"][0])

    def test_the_sides_of_an_adiabatic_sheet_are_alone(self):
        """Zero net flux on each side: an insulating sheet, not one that conducts and has one temperature."""
        found = self.heat(self.sheet(fluxed(0)), *TIGHT)
        self.assert_sheet(found, Surface(1.0, q=0.0))
        below, above = (found["sheet", side]["temperature_K"] for side in ("back", "front"))
        self.assertGreater(below, 2 * above)

    def test_a_one_sided_sheet_has_one_row(self):
        found = self.heat(self.sheet(heated(0.3, 600.0)), "--sides", "one")
        self.assertEqual(set(found), {("bottom", "front"), ("sheet", "front"), ("top", "front")})

    # The table

    def test_names_and_mixed_groups(self):
        name = 'slab, "left"'
        scene = self.scene({"a": heated(0.5, 800.0), "b": heated(1.0, 400.0)},
                           [(name, "a", square(0, True)), (name, "b", square(1, False, half=1.0))])
        found = self.heat(scene, "--sides", "one")
        self.assertIn('"slab, ""left""",front,5,', (self.out / "thermal.csv").read_text())
        row = found[name, "front"]
        self.assert_close(row["emissivity"], (0.5 + 4) / 5, 1e-9)
        self.assert_close(row["temperature_K"], ((800.0**4 + 4 * 400.0**4) / 5) ** 0.25, 1e-8)
        self.assert_close(row["emitted_W"], SIGMA * (0.5 * 800.0**4 + 4 * 400.0**4), 1e-9)

    def test_the_report_and_what_is_printed(self):
        scene, _, _ = self.box({"hot": Surface(0.8, T=1000.0), "cold": Surface(0.3, T=400.0)}, HOT_FLOOR)
        job = self.solve(scene, "--thermal", "--sides", "one")
        self.assert_done(job)
        report = self.report()
        self.assertEqual(report["options"]["thermal"], True)
        self.assertEqual(report["options"]["subdivision"], "none")
        for row in report["thermal"]:
            for key, value in self.table()[row["group"], row["side"]].items():
                self.assertAlmostEqual(row[key.lower()], value, delta=(0.05 if key == "error_W" else 1e-8) * abs(value))
        self.assertIn("thermal power: ", job.out)
        self.assertNotIn("Ke", job.out)
        self.assertIn("heat balance: net ", job.out)
        self.assertRegex(job.out, r"(?m)^hot +front +1 +1000\.00 ")
        quiet = self.solve(scene, "--thermal", "--sides", "one", "--quiet")
        self.assertEqual((quiet.out, quiet.err), ("", ""))

    def test_many_groups_are_printed_in_part(self):
        faces = [(f"g{k}", "a", [(3 * k, 0, 0), (3 * k + 1, 0, 0), (3 * k, 1, 0)]) for k in range(25)]
        scene = self.scene({"a": heated(0.5, 800.0)}, faces)
        job = self.solve(scene, "--thermal", "--sides", "one")
        self.assert_done(job)
        self.assertIn("g19 ", job.out)
        self.assertNotIn("g20 ", job.out)
        self.assertIn("... and 5 more rows in thermal.csv", job.out)
        self.assertEqual(len(self.table()), 25)

    def test_errors_are_bounded(self):
        surfaces = {"floor": Surface(0.3, T=1200.0), "ceiling": Surface(0.2, T=500.0),
                    "wall": Surface(0.1, T=300.0)}
        scene, _, _ = self.box(surfaces, FLOOR_CEILING_WALLS)
        exact = self.heat(scene, "--sides", "one", "--tolerance", "2e-5")
        # Conjugate gradients would be better than their bound.
        rough = self.heat(scene, "--sides", "one", "--tolerance", "0.05", "--solver", "jacobi")
        for key, row in rough.items():
            other = exact[key]
            self.assertLessEqual(abs(row["net_W"] - other["net_W"]), row["error_W"] + other["error_W"])
            self.assertLess(other["error_W"], 0.01 * row["error_W"])
        floor = "floor", "front"
        self.assertGreater(abs(rough[floor]["net_W"] - exact[floor]["net_W"]), 1)

    def test_the_same_bytes_for_every_number_of_ranks(self):
        surfaces = {"hot": Surface(0.8, T=1000.0), "cold": Surface(0.3, q=0.0)}
        scene, _, _ = self.box(surfaces, HOT_FLOOR, count=4)
        tables = set()
        for ranks in (1, 2, 3):
            self.assert_done(self.solve(scene, "--thermal", "--sides", "one", "--threads", "1", ranks=ranks))
            tables.add((self.out / "thermal.csv").read_bytes())
        self.assertEqual(len(tables), 1)

    def test_a_table_of_an_earlier_run_goes(self):
        self.write("room.mtl", HEATED_ROOM)
        room = self.write("room.obj", ROOM)
        self.assert_done(self.solve(room, "--thermal", "--sides", "one"))
        self.assertEqual(self.written(), ["convergence.csv", "report.html", "report.json", "solution.ply", "thermal.csv"])
        dry = self.solve(room, "--thermal", "--sides", "one", "--dry-run")
        self.assertEqual(sum("thermal.csv" in line for line in dry.warnings), 1, str(dry))
        self.assert_done(self.solve(room, "--sides", "one", "--subdivision", "none"))
        self.assertEqual(self.written(), ["convergence.csv", "report.html", "report.json", "solution.ply"])
        self.assertNotIn("thermal", self.report())

    def test_a_camera_shows_exitance(self):
        self.write("room.mtl", HEATED_ROOM)
        self.assert_done(self.solve(self.write("room.obj", ROOM), "--thermal", "--sides", "one", *INSIDE,
                                    "--resolution", "16x16"))
        self.assertEqual(self.written(), sorted((*OUTPUTS, "thermal.csv")))
        self.assertEqual(self.report()["options"]["subdivision"], "camera")
        self.assertGreater(self.report()["elements"], 6)

    # Scene files, and what is refused or warned of

    def test_a_scene_file_says_it_all(self):
        self.scene({"a": "", "b": fluxed(5)}, PLATES, "plates")
        scene = self.write("plates.toml", '[[geometry]]\nfile = "plates.obj"\n'
                                          "[materials.a]\nemissivity = 0.5\ntemperature = 900\n"
                                          "[materials.b]\nemissivity = 0.25\ntemperature = 300.0\n"
                                          '[options]\nthermal = true\nsides = "one"\n')
        self.assert_done(self.solve(scene, *TIGHT))
        F = [[0, OPPOSED, 1 - OPPOSED], [OPPOSED, 0, 1 - OPPOSED], [0, 0, 0]]
        expected = net_fluxes([Surface(0.5, T=900.0), Surface(0.25, T=300.0), Surface(1, T=0.0)], F)
        for group, (q, _) in zip("ab", expected):
            self.assertAlmostEqual(self.table()[group, "front"]["net_W"], q, delta=1e-5 * SIGMA * 900.0**4)

    def test_a_used_material_must_say_enough(self):
        scene = self.scene({"a": heated(0.5, 900), "b": "temperature 300\n", "c": ""}, PLATES)
        self.assert_refused(self.solve(scene, "--thermal"), "material 'b' has no emissivity", "--thermal",
                            file=scene)
        text = (self.work / "heat.mtl").read_text()
        (self.work / "heat.mtl").write_text(text.replace("temperature 300", "emissivity 0.5"))
        self.assert_refused(self.solve(scene, "--thermal", ranks=2),
                            "material 'b' has no temperature and no heat_flux", file=scene)
        (self.work / "heat.mtl").write_text(text.replace("temperature 300", "heat_flux 0"))
        self.assert_done(self.solve(scene, "--thermal"))

    def test_enclosures_without_a_solution(self):
        for surfaces, text in (((fluxed(10), fluxed(-5)), "no surface has a temperature"),
                               ((heated(0.5, 0), fluxed(0)), "no surface emits heat"),
                               ((heated(0.5, 300), fluxed(-1000)), "the prescribed fluxes draw 2000 W")):
            with self.subTest(text):
                scene = self.scene(dict(zip("ab", surfaces)), PLATES)
                self.assert_refused(self.solve(scene, "--thermal"), text)

    def test_more_is_drawn_than_arrives(self):
        """Less than all that is emitted, but more than reaches the surface: no temperature gives that."""
        scene = self.scene({"a": heated(0.9, 400), "b": fluxed(-1000, 0.9)}, PLATES)
        job = self.solve(scene, "--thermal", "--sides", "one")
        self.assert_done(job)
        warnings = [line for line in job.warnings if "more heat is drawn" in line]
        self.assertEqual(len(warnings), 1, str(job))
        self.assertIn("in b:", warnings[0])
        row = self.table()["b", "front"]
        self.assertTrue(math.isnan(row["temperature_K"]))
        self.assertEqual(row["net_W"], -1000)
        self.assertNotIn("temperature_k", self.report()["thermal"][1])

    def test_bad_values_are_refused_without_thermal_too(self):
        scene = self.write("bad.obj", "mtllib bad.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3\n")
        library = self.write("bad.mtl", "newmtl a\nKd 0.5\nKe 1\nemissivity 0\n")
        self.assert_refused(self.solve(scene, "--subdivision", "none"), "emissivity 0 of material 'a'",
                            file=library, line=4)

    # The example

    def test_the_heating_chamber(self):
        """The values that the scene states, of squares of 0.5 m and of 0.25 m."""
        scene = SCENES / "heating-chamber" / "heating-chamber.toml"
        coarse = {"heaters": 222616, "load": -178773, "opening": -37843, "end-wall": -6000, "refractory": 0}
        fine = {"heaters": 221108, "load": -177819, "opening": -37289, "end-wall": -6000, "refractory": 0}
        refined = ("--subdivision", "uniform", "--max-edge", "0.25", "--tolerance", "1e-4")
        for arguments, net, refractory, end_wall in ((TIGHT, coarse, 1096.388, 1087.496),
                                                     (refined, fine, 1095.766, 1086.659)):
            with self.subTest(arguments):
                self.assert_done(self.solve(scene, *arguments))
                found = self.table()
                relative = 3e-5 if arguments is TIGHT else 1e-3
                for group, watts in net.items():
                    power = found[group, "front"]["net_W"]
                    self.assertAlmostEqual(power, watts, delta=0.5 + relative * 222616)
                self.assert_close(found["refractory", "front"]["temperature_K"], refractory, relative)
                self.assert_close(found["end-wall", "front"]["temperature_K"], end_wall, relative)


if __name__ == "__main__":
    unittest.main()
