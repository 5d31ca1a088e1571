"""`fluxel reference` against exact solutions, and as a command.

Means are asked to be right within three standard errors. Of honest ones 1 in 111 is not (Student's t of 15 degrees of
freedom); seeds are fixed, so that what passes goes on to.
"""

import json
import math
import os
import signal
import sys
import time
import unittest

from fluxel_job import MATRIX, SCENES, JobTest, finish, launch, start
from result_files import read_elements, read_exr
from rooms import INSIDE, MTL, ROOM, VERTICES, scene_file

sys.path.insert(0, str(SCENES.parent / "scripts"))
from scene_parts.mesh import point_factor

CORNELL = SCENES / "cornell-box" / "cornell-box.toml"
WALL = SCENES / "emitting-wall" / "emitting-wall.toml"
FURNACE = SCENES / "furnace" / "furnace.toml"
OPPOSED = 0.199824895698387  # F of opposed faces of a cube
RANDOMISATIONS = 16
CHANNELS = ("R", "G", "B")
WALLS = {"floor": [1, 2, 3, 4], "front": [1, 5, 6, 2], "right": [2, 6, 7, 3], "back": [3, 7, 8, 4],
         "left": [4, 8, 5, 1], "ceiling": [5, 8, 7, 6]}


def coverage(t, freedom=RANDOMISATIONS - 1, steps=2000):
    """Probability of |Student's t| below t."""
    density = lambda x: (1 + x * x / freedom)**(-(freedom + 1) / 2)
    scale = math.gamma((freedom + 1) / 2) / math.gamma(freedom / 2) / math.sqrt(math.pi * freedom)
    weights = [1, *([4, 2] * (steps // 2))[:steps - 1], 1]
    return 2 * scale * t / (3 * steps) * sum(w * density(t * k / steps) for k, w in enumerate(weights))


def area(corners):
    (a, b, c), rest = corners[:3], corners[3:]
    u, v = ([q - p for p, q in zip(a, of)] for of in (b, c))
    cross = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    return math.hypot(*cross) * (1 if rest else 0.5)


def box(low, high, outward):
    """OBJ vertices of a cube from low to high, and its faces as numbers of them from 1."""
    vertices = [[low + (high - low) * float(word) for word in line.split()[1:]] for line in VERTICES.splitlines()]
    return vertices, [face[::-1] if outward else face for face in WALLS.values()]


def obj(parts):
    """An OBJ of [(material, vertices, faces)]."""
    lines, count = ["mtllib scene.mtl"], 0
    for material, vertices, faces in parts:
        lines += ["v " + " ".join(f"{x:.17g}" for x in vertex) for vertex in vertices]
        lines += [f"usemtl {material}"]
        lines += ["f " + " ".join(str(k + count) for k in face) for face in faces]
        count += len(vertices)
    return "\n".join(lines) + "\n"


def rectangle(x, y, z, up):
    corners = [(x[0], y[0], z), (x[1], y[0], z), (x[1], y[1], z), (x[0], y[1], z)]
    return corners, [[1, 2, 3, 4] if up else [4, 3, 2, 1]]


def receiver(name, origin, u, v, cells=(1, 1)):
    text = f'[[receivers]]\nname = "{name}"\norigin = {list(origin)}\nu = {list(u)}\nv = {list(v)}\n'
    return text + f"cells = {list(cells)}\n"


class ReferenceTest(JobTest):
    def reference(self, scene, *arguments, out=None, **settings):
        settings.setdefault("ranks", 1)
        return start(["reference", scene, *arguments, "--out", out or self.out], **settings)

    def measure(self, scene, *arguments, code=0, **settings):
        """reference.json of a run that ends well."""
        job = self.reference(scene, *arguments, "--threads", 2, **settings)
        self.assert_done(job, code)
        return json.loads((self.out / "reference.json").read_text())

    def elements(self, scene, *arguments):
        """The file of the elements of a solve that does little else."""
        folder = self.work / "solved"
        self.assert_done(start(["solve", *MATRIX, scene, "--resolution", "4x4", *arguments, "--out", folder], ranks=1))
        return folder / "solution.ply"

    def measured_elements(self, scene, solved, *arguments, **settings):
        self.measure(scene, "--elements", solved, "--only", "elements", *arguments, **settings)
        return read_elements(self.out / "reference.ply")

    def measured_receiver(self, name):
        """Mean over the cells and its standard error, red channel."""
        image = read_exr(self.out / f"receiver-{name}.exr")
        values, errors = ([x for row in image[channel] for x in row] for channel in ("R", "error.R"))
        return sum(values) / len(values), math.sqrt(sum(e * e for e in errors)) / len(values)

    def scene(self, name, parts, materials, receivers="", options='ke = "exitance"\nsides = "one"\nsubdivision = "none"\n'):
        """A scene file of [(material, vertices, faces)]; `materials` is {name: (rho, E)}."""
        self.write(f"{name}.obj", obj(parts).replace("scene.mtl", f"{name}.mtl"))
        self.write(f"{name}.mtl", "".join(
            f"newmtl {key}\nKd {rho} {rho} {rho}\nKe {E} {E} {E}\n" for key, (rho, E) in materials.items()))
        return self.write(f"{name}.toml", f'[[geometry]]\nfile = "{name}.obj"\n{receivers}[options]\n{options}')

    def assert_z(self, value, error, exact):
        self.assertLess(abs(value - exact), 3 * error, f"{value} +- {error} for {exact}")

    def assert_right(self, values, exact):
        """[(area, value, error)]: the mean, and how often the values are within one and two of their errors."""
        surface = sum(A for A, *_ in values)
        mean = sum(A * value for A, value, _ in values) / surface
        self.assert_z(mean, math.sqrt(sum((A * error)**2 for A, _, error in values)) / surface, exact)
        uncertain = [abs(value - exact) / error for _, value, error in values if error > 0]
        self.assertGreater(len(uncertain), 500)
        for errors in (1, 2):
            share = sum(z < errors for z in uncertain) / len(uncertain)
            self.assertAlmostEqual(share, coverage(errors), delta=0.03, msg=f"{errors} errors")

    def test_the_coverage_is_students(self):
        self.assertAlmostEqual(coverage(2.131449545559323), 0.95, places=9)  # a table's 97.5 % of 15 degrees
        self.assertAlmostEqual(coverage(1), 0.66685, places=4)

    # Exact solutions

    def test_furnace(self):
        elements = self.measured_elements(FURNACE, self.elements(FURNACE), "--rays", 1200000)
        self.assert_right([(area(e["corners"]), e["radiosity"][0], e["error"][0]) for e in elements], 1)
        exact = [e["radiosity"] for e in elements if e["error"] == (0, 0, 0)]
        self.assertGreater(len(exact), 5, "elements of reflectance 0")
        self.assertEqual(set(exact), {(1, 1, 1)})
        for element in elements:
            for c in range(3):
                self.assertAlmostEqual((element["half_a"][c] + element["half_b"][c]) / 2, element["radiosity"][c], 6)

    def test_emitting_wall(self):
        """Averages over the walls; one element a wall instead gives 1.0909 0.1817 0.1818 (rho 0.5)."""
        text = (WALL.parent / "emitting-wall.mtl").read_text()
        names = [line.split()[1] for line in text.splitlines() if line.startswith("newmtl")]
        for rho, rays, most_error, exact in ((0.5, 3000000, 1e-3, (1.104362, 0.181105, 0.171216)),
                                             (0.9, 5000000, 1e-2, (2.419372, 1.523185, 1.487885))):
            materials = "".join(f"[materials.{name}]\nrho = {rho}\n" for name in names)
            scene = self.write("wall.toml", f'[[geometry]]\nfile = "{WALL.parent}/emitting-wall.obj"\n{materials}'
                               '[options]\nke = "exitance"\nsides = "one"\nsubdivision = "none"\n')
            walls = {}
            for element in self.measured_elements(scene, self.elements(scene), "--rays", rays, "--seed", 2):
                height = sum(z for _, _, z in element["corners"]) / 4
                walls.setdefault(height, []).append((element["radiosity"][0], element["error"][0]))
            self.assertEqual({height: len(of) for height, of in walls.items()}, {0: 1, 0.5: 4, 1: 1})
            for expected, (height, of) in zip(exact, sorted(walls.items())):
                with self.subTest(rho=rho, height=height):
                    error = math.sqrt(sum(e * e for _, e in of)) / len(of)
                    self.assertLess(error, most_error)
                    self.assert_z(sum(value for value, _ in of) / len(of), error, expected)

    def cube_in_cube(self, shell, body):
        vertices, faces = box(0, 3, False)
        grid = [(vertices, faces), box(1, 2, True)]
        walls = [receiver("floor", (0, 0, 0), (3, 0, 0), (0, 3, 0)),
                 receiver("ceiling", (0, 0, 3), (0, 3, 0), (3, 0, 0)),
                 receiver("front", (0, 0, 0), (0, 0, 3), (3, 0, 0)), receiver("back", (0, 3, 0), (3, 0, 0), (0, 0, 3)),
                 receiver("left", (0, 0, 0), (0, 3, 0), (0, 0, 3)), receiver("right", (3, 0, 0), (0, 0, 3), (0, 3, 0))]
        return self.scene("cubes", [("shell", *grid[0]), ("body", *grid[1])], {"shell": shell, "body": body},
                          "".join(walls))

    def test_a_body_in_a_shell_that_shines(self):
        scene = self.cube_in_cube((0, 1), (0.6, 0))
        solved = self.elements(scene, "--subdivision", "uniform", "--max-edge", "0.12")
        elements = self.measured_elements(scene, solved, "--rays", 1000000)
        body = [e for e in elements if all(0.9 < x < 2.1 for corner in e["corners"] for x in corner)]
        # From the body the shell alone is seen: each path's light is exact, but for how it was found.
        self.assert_right([(area(e["corners"]), e["radiosity"][0], e["error"][0]) for e in body], 0.6)
        self.assertEqual({e["radiosity"] for e in elements if e not in body}, {(1, 1, 1)})

    def test_a_shell_about_a_body_that_shines(self):
        self.measure(self.cube_in_cube((0, 0), (0, 1)), "--only", "receivers", "--target-error", 5e-4)
        found = [self.measured_receiver(name) for name in ("floor", "ceiling", "front", "back", "left", "right")]
        error = math.sqrt(sum(e * e for _, e in found)) / 6
        self.assertLess(error, 1e-4)
        self.assert_z(sum(value for value, _ in found) / 6, error, 1 / 9)

    def test_blockers_half_way_between_squares(self):
        """F is a fraction of that without a blocker by symmetry, or (centred) the integral of closed point factors."""
        unit, black = (0, 1), (0, 0)
        for name, x, y, F in (("half", (0, 0.5), unit, OPPOSED / 2), ("quadrant", (0, 0.5), (0, 0.5), 0.75 * OPPOSED),
                              ("small", (0.375, 0.625), (0.375, 0.625), 0.169474204911786),
                              ("large", (0.25, 0.75), (0.25, 0.75), 0.0995062945989844)):
            parts = [("light", *rectangle(unit, unit, 0, True)), ("black", *rectangle(x, y, 0.5, True))]
            scene = self.scene(name, parts, {"light": (0, 1), "black": black},
                               receiver("top", (0, 0, 1), (0, 1, 0), (1, 0, 0)))
            with self.subTest(blocker=name):
                self.measure(scene, "--target-error", 5e-4)
                value, error = self.measured_receiver("top")
                self.assertLess(error / F, 1e-3)
                self.assert_z(value, error, F)

    def test_direct_light_in_the_cornell_box(self):
        """At points that see the whole lamp, of exitance 1; nothing reflects."""
        up, right, forward = (0, 1e-6, 0), (1e-6, 0, 0), (0, 0, 1e-6)
        points = {"floor_1": ((40, 0, 300), forward, right), "floor_2": ((60, 0, 500), forward, right),
                  "back": ((278, 450, 559.2), up, right), "green": ((0, 274.4, 279.6), up, forward),
                  "short": ((186, 165, 170), forward, right), "tall": ((368, 330, 351), forward, right)}
        materials = "".join(f"[materials.{name}]\nrho = 0\nE = {int(name == 'light')}\n"
                            for name in ("white", "red", "green", "light"))
        places = {name: [x / 1000 for x in point] for name, (point, _, _) in points.items()}
        receivers = "".join(receiver(name, places[name], u, v) for name, (_, u, v) in points.items())
        scene = self.write("direct.toml", f'[[geometry]]\nfile = "{CORNELL.parent}/cornell-box.obj"\n'
                           f'metres_per_unit = 0.001\n{materials}{receivers}[options]\nsides = "one"\n')
        self.measure(scene, "--target-error", 3e-5)
        lamp = [(0.343, 0.5488, 0.227), (0.343, 0.5488, 0.332), (0.213, 0.5488, 0.332), (0.213, 0.5488, 0.227)]
        for name, (_, u, v) in points.items():
            normal = [1e12 * (u[k - 2] * v[k - 1] - u[k - 1] * v[k - 2]) for k in range(3)]
            F = point_factor(places[name], normal, lamp)
            with self.subTest(point=name):
                self.assertGreater(F, 0.008)
                value, error = self.measured_receiver(name)
                self.assert_z(value, error, F)

    def test_sides(self):
        """A plate in a black shell that shines has both sides lit alike, where both count."""
        plate = rectangle((0.3, 0.6), (0.2, 0.7), 0.5, True)
        scene = self.scene("plate", [("light", *box(0, 1, False)), ("plate", *plate)],
                           {"light": (0, 1), "plate": (0.3, 0)})
        for sides in ("one", "two"):
            solved = self.elements(scene, "--sides", sides)
            elements = self.measured_elements(scene, solved, "--sides", sides, "--rays", 10000)
            (of_plate,) = (e for e in elements if e["patch"] == 6)
            self.assert_z(of_plate["radiosity"][0], of_plate["error"][0], 0.3)
            self.assertEqual("radiosity_back" in of_plate, sides == "two")
            if sides == "two":
                self.assert_z(of_plate["radiosity_back"][0], of_plate["error_back"][0], 0.3)
                self.assertEqual({"half_a_back", "half_b_back"} - set(of_plate), set())

    def test_heat(self):
        """Where all has one temperature, all radiosities are sigma T^4, whatever the emissivities."""
        self.write("scene.mtl", "newmtl light\nemissivity 0.3\ntemperature 500\n"
                                "newmtl white\nemissivity 0.8\ntemperature 500\n")
        walls, faces = box(0, 1, False)
        scene = self.write("heat.obj", obj([("light", walls, faces), ("white", *box(0.4, 0.7, True))]))
        common = ("--thermal", "--sides", "one")
        solved = self.elements(scene, *common, "--subdivision", "uniform", "--max-edge", "0.2")
        elements = self.measured_elements(scene, solved, *common, "--rays", 100000)
        exact = 5.670374419e-8 * 500**4
        mean = sum(e["radiosity"][0] for e in elements) / len(elements)
        error = math.sqrt(sum(e["error"][0]**2 for e in elements)) / len(elements)
        self.assertLess(error, 0.01 * exact)
        self.assert_z(mean, error, exact)

    def test_far_from_the_origin(self):
        self.write("room.obj", ROOM)
        self.write("room.mtl", MTL)
        found = []
        for shift in ((0, 0, 0), (1e5, -2e5, 3e4)):
            at = [shift[0] + 0.25, shift[1] + 0.25, shift[2] + 0.5]
            text = scene_file().replace('"room.obj"', f'"room.obj"\ntranslate = {list(shift)}')
            scene = self.write("far.toml", text + receiver("in", at, (0.5, 0, 0), (0, 0.5, 0)))
            solved = self.elements(scene, "--sides", "one", "--subdivision", "none", *INSIDE, "--eye",
                                   ",".join(map(str, at)), "--look-at", ",".join(str(x + 0.1) for x in at))
            elements = self.measured_elements(scene, solved, "--sides", "one", "--rays", 400000)
            values = [(e["radiosity"][0], e["error"][0]) for e in elements]
            self.measure(scene, "--sides", "one", "--only", "receivers", "--rays", 400000)
            found.append([*values, self.measured_receiver("in")])
        for (near, error), (far, error_far) in zip(*found):
            self.assertLess(error / near, 0.01)
            self.assert_z(far, math.hypot(error, error_far), near)

    # Pictures

    def test_a_picture_is_that_of_a_fine_solution(self):
        """But for what the elements' size costs, which is a part of a hundred and without noise."""
        self.assert_done(self.solve(WALL, "--resolution", "16x16", "--supersample", 1, "--max-edge", "0.05", ranks=2))
        solved = read_exr(self.out / "image.exr")
        json_of = self.measure(WALL, "--resolution", "16x16", "--supersample", 1, "--rays", 1000000)
        self.assertEqual(json_of["measured"]["picture"]["sensors"], 256)
        measured = read_exr(self.out / "reference.exr")
        largest, squares, count = 0, 0, 0
        for channel in CHANNELS:
            for row, exact, errors in zip(measured[channel], solved[channel], measured["error." + channel]):
                for value, expected, error in zip(row, exact, errors):
                    self.assertLess(abs(value - expected), 4 * error + 0.03 * expected)
                    squares += ((value - expected)**2 - error**2) / expected**2
                    count += 1
        self.assertLess(math.sqrt(squares / count), 0.015)

    def test_nothing_is_black(self):
        self.measure(CORNELL, "--fov", 60, "--resolution", "24x24", "--rays", 100000)
        image = read_exr(self.out / "reference.exr")
        self.assertEqual(set(image), {layer + c for layer in ("", "error.", "half_a.", "half_b.") for c in CHANNELS})
        corner = [image[channel][0][0] for channel in image]
        self.assertEqual(corner, [0] * 12)
        self.assertGreater(image["R"][12][12], 0)
        self.assertTrue((self.out / "reference.png").is_file())

    # How long, how exact

    def test_the_error_falls_as_the_root_of_the_rays_or_faster(self):
        text = CORNELL.read_text().replace("cornell-box.obj", f"{CORNELL.parent}/cornell-box.obj")
        scene = self.write("box.toml", text + receiver("floor", (0.1, 0.001, 0.1), (0, 0, 0.3), (0.3, 0, 0), (4, 4)))
        solved = self.elements(scene, "--subdivision", "uniform", "--max-edge", "0.3")
        points = {}
        for rays in (200000, 400000, 800000, 1600000):
            measured = self.measure(scene, "--elements", solved, "--resolution", "16x16", "--rays", rays)["measured"]
            for name, of in measured.items():
                self.assertLess(of["rays"], 1.1 * rays)
                self.assertGreater(of["rays"], 0.8 * rays)
                points.setdefault(name, []).append((math.log(of["rays"]), math.log(of["relative_error_rgb"][1])))
        self.assertEqual(set(points), {"elements", "picture", "receiver floor"})
        for name, of in points.items():
            x, y = (sum(values) / len(of) for values in zip(*of))
            slope = sum((a - x) * (b - y) for a, b in of) / sum((a - x)**2 for a, _ in of)
            with self.subTest(what=name):
                self.assertLess(slope, -0.45)

    def test_target_error(self):
        scene = self.room()
        measured = self.measure(scene, *INSIDE, "--resolution", "8x8", "--target-error", 0.02)["measured"]["picture"]
        self.assertTrue(measured["reached"])
        self.assertIn("target error", measured["ended_by"])
        self.assertLessEqual(max(measured["relative_error_rgb"]), 0.02)
        job = self.reference(scene, *INSIDE, "--resolution", "8x8", "--target-error", 1e-6, "--rays", 200000)
        self.assertEqual(job.code, 3, str(job))
        self.assertEqual(len(job.warnings), 1, str(job))
        self.assertIn("not reached: so many rays", job.warnings[0])
        measured = json.loads((self.out / "reference.json").read_text())["measured"]["picture"]
        self.assertFalse(measured["reached"])
        self.assertIn("rays", measured["ended_by"])

    def test_samples_dealt_to_blocks(self):
        scene = self.room()
        told = {}
        for sampling in ("even", "blocks"):
            measured = self.measure(scene, *INSIDE, "--resolution", "40x30", "--rays", 3000000, "--sampling", sampling)
            self.assertEqual(measured["options"]["sampling"], sampling)
            of = told[sampling] = measured["measured"]["picture"]
            self.assertLessEqual(of["samples_min"], of["samples"])
            self.assertLessEqual(of["samples"], of["samples_max"])
        self.assertEqual(told["even"]["samples_min"], told["even"]["samples_max"])
        self.assertLess(told["blocks"]["samples_min"], told["blocks"]["samples_max"])
        for even, blocks in zip(told["even"]["mean_rgb"], told["blocks"]["mean_rgb"]):
            # Both are off by their errors over the root of 1200 pixels.
            error = max(told["even"]["relative_error_rgb"]) / math.sqrt(1200) * even
            self.assertLess(abs(even - blocks), 3 * math.sqrt(2) * error)

    def test_pictures_of_one_pixel_and_of_nothing(self):
        scene = self.room()
        measured = self.measure(scene, *INSIDE, "--resolution", "1x1", "--target-error", 0.05)["measured"]["picture"]
        self.assertTrue(measured["reached"])
        self.assertEqual(measured["samples_min"], measured["samples_max"])
        away = ("--eye", "5,5,5", "--look-at", "9,9,9", "--up", "0,0,1", "--fov", 20)
        measured = self.measure(scene, *away, "--resolution", "20x20")["measured"]["picture"]
        self.assertEqual(measured["mean_rgb"], [0, 0, 0])
        self.assertTrue(measured["reached"])

    def test_time(self):
        measured = self.measure(self.room(), *INSIDE, "--resolution", "16x16", "--time", 1)["measured"]["picture"]
        self.assertGreater(measured["seconds"], 0.4)
        self.assertLess(measured["seconds"], 4)

    def test_usr2_ends_it_with_what_there_is(self):
        scene = self.room()
        solved = self.elements(scene, "--sides", "one", "--subdivision", "none")
        process = launch(["reference", scene, "--sides", "one", *INSIDE, "--resolution", "8x8", "--elements", solved,
                          "--time", 50, "--threads", 1, "--out", self.out])
        # Kept every 5 seconds: by then the elements have been measured for a while.
        self.wait_for((self.out / "convergence.csv").exists, process)
        begin = time.monotonic()
        process.send_signal(signal.SIGUSR2)
        job = finish(process, begin)
        self.assertEqual(job.code, 75, str(job))
        self.assertLess(job.seconds, 25)
        self.assertEqual(self.written(), ["convergence.csv", "reference.html", "reference.json", "reference.ply"])
        self.assertEqual(len(read_elements(self.out / "reference.ply")), 6)
        measured = json.loads((self.out / "reference.json").read_text())["measured"]
        self.assertEqual(list(measured), ["elements"])
        self.assertIn("signal", measured["elements"]["ended_by"])

    def room(self):
        self.write("room.obj", ROOM)
        self.write("room.mtl", MTL)
        return self.work / "room.obj"

    def test_the_same_from_every_number_of_ranks_and_threads(self):
        scene = self.write("room.toml", scene_file(receiver("in", (0.2, 0.2, 0.3), (0.5, 0, 0), (0, 0.5, 0), (9, 9))))
        self.room()
        solved = self.elements(scene, "--subdivision", "uniform", "--max-edge", "0.2")
        names = ("reference.ply", "reference.exr", "receiver-in.exr")
        for limit in (("--rays", "1e5"), ("--target-error", 0.05)):
            found = {}
            for ranks, threads in ((1, 1), (1, 2), (2, 1), (3, 2)):
                out = self.work / f"{limit[0]}-{ranks}-{threads}"
                self.assert_done(self.reference(scene, "--elements", solved, *limit, "--threads", threads, ranks=ranks,
                                                out=out))
                found[ranks, threads] = [(out / name).read_bytes() for name in names]
            for key, files in found.items():
                for name, file, first in zip(names, files, found[1, 1]):
                    self.assertEqual(file, first, f"{name} of {key} with {limit}")

    # Bad input

    def assert_bad(self, *arguments, texts=(), **place):
        job = start(["reference", *arguments, "--out", self.out], ranks=2)
        self.assert_refused(job, *texts, **place)

    def test_options_that_are_refused(self):
        scene = self.room()
        self.assert_bad(scene, texts=["nothing to measure", "--eye", "--elements", "[[receivers]]"])
        self.assert_bad(scene, *INSIDE, "--only", "receivers", texts=["nothing to measure"])
        for option, value in (("--target-error", 0), ("--target-error", "nan"), ("--time", -1), ("--rays", 0),
                              ("--rays", "1.5"), ("--supersample", 0), ("--only", "all-of-it"),
                              ("--sampling", "adaptive"), ("--verify-device", 2), ("--device", "gpu")):
            with self.subTest(option=option, value=value):
                self.assert_bad(scene, *INSIDE, option, value, texts=[option])

    def test_options_without_effect_are_said(self):
        scene = self.room()
        self.write("point.toml", f'[[geometry]]\nfile = "{scene.name}"\n' + receiver("in", (0, 0, 0.5), (1, 0, 0), (0, 1, 0)))
        for given, idle in (([scene, *INSIDE, "--only", "picture", "--elements", "none.ply"], "--elements"),
                            ([self.work / "point.toml", "--resolution", "8x8", "--exposure", 1], "--resolution, --exposure")):
            with self.subTest(idle):
                job = start(["reference", *given, "--rays", 1000, "--out", self.out])
                self.assertTrue(any(f"{idle} has no effect" in line for line in job.warnings), job)

    def test_the_report_has_the_options_in_force(self):
        self.room()
        scene = self.write("room.toml", scene_file("[options]\nsides = \"one\"\nsupersample = 4\nform-factor = \"disc\"\n"))
        job = self.reference(scene, "--rays", 1000, "--seed", 7)
        self.assert_done(job)
        self.assertTrue(any("--supersample 4" in line for line in job.warnings), job)
        options = json.loads((self.out / "reference.json").read_text())["options"]
        self.assertEqual((options["rays"], options["seed"], options["sides"], options["resolution"]), (1000, 7, "one", [16, 16]))
        for name in ("target-error", "supersample", "form-factor", "method", "elements"):
            self.assertNotIn(name, options)
        job = self.reference(scene, "--supersample", 2, "--target-error", 0.5, "--only", "picture")
        self.assert_done(job)
        self.assertEqual(job.warnings, [], job)
        options = json.loads((self.out / "reference.json").read_text())["options"]
        self.assertEqual((options["supersample"], options["target_error"], options["only"]), (2, 0.5, "picture"))

    def test_a_name_that_is_no_text_loses_no_report(self):
        self.room()
        scene = os.fsencode(self.work) + b"/r\xe9.obj"
        with open(scene, "wb") as file:
            file.write(ROOM.encode())
        job = start(["reference", os.fsdecode(scene), *INSIDE, "--rays", 1000, "--resolution", "8x8", "--out", self.out])
        self.assertIn(job.code, (0, 3), job)
        self.assertIn("measured", json.loads((self.out / "reference.json").read_text(encoding="utf-8")))

    def test_elements_that_are_refused(self):
        scene = self.room()
        gone = self.work / "gone.ply"
        self.assert_bad(scene, "--elements", gone, texts=["gone.ply"], file=gone)
        self.assert_bad(scene, "--elements", scene, file=scene, line=1)
        higher = ROOM.replace(VERTICES, VERTICES.replace(" 1\n", " 1.1\n"))
        wider = VERTICES + "v 0 0 0\nv 1.5 0 0\nv 1.5 1 0\nv 0 1 0\n"
        for name, other, sides in (("higher", higher, "one"), ("more", ROOM + "f 1 2 7\n", "one"),
                                   ("wider", ROOM.replace(VERTICES, wider).replace("f 1 2 3 4", "f 9 10 11 12"), "one"),
                                   ("backs", ROOM, "two")):
            self.write("other.obj", other)
            solved = self.elements(self.work / "other.obj", "--subdivision", "none", "--sides", sides)
            with self.subTest(elements=name):
                self.assert_bad(scene, "--sides", "one", "--elements", solved, texts=["of another scene"], file=solved)

    def test_receivers_that_are_refused(self):
        self.room()
        good = receiver("in", (0, 0, 0.5), (1, 0, 0), (0, 1, 0))
        for text, message in ((good + "size = 3\n", "'size'"), (good.replace("u = [1", "u = [0"), "no area"),
                              (good + good, "a second receiver 'in'"), (good.replace("[1, 1]", "[0, 1]"), "whole")):
            scene = self.write("bad.toml", scene_file(text))
            with self.subTest(message=message):
                job = start(["reference", scene, "--out", self.out], ranks=2)
                self.assert_refused(job, message)
                self.assertTrue(job.said[0].startswith(f"fluxel: {scene}:"), str(job))


if __name__ == "__main__":
    unittest.main()
