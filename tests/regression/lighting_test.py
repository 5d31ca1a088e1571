"""Light meters of all kinds, glare and lighting tasks against closed forms, by solve, view and reference."""

import collections
import csv
import json
import math
import struct
import unittest
import zlib

from fluxel_job import JobTest, start

import fluxel

# A black box of 8 x 8 x 4 m whose inside is seen.
BOX = [(x, y, z) for z in (0, 4) for y in (0, 8) for x in (0, 8)]
BOX_FACES = ("1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4")
CANDELAS = 100.0
LAMP = (3.0, 5.0, 3.0)
POINTS = [(1.0, 2.0, 0.8), (6.0, 5.5, 1.2), (3.5, 7.0, 2.0)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def irradiance_of_polygon(exitance, corners, point, normal):
    """Of an evenly emitting polygon wholly in front (Lambert 1760): E / (2 pi) sum of angle times cosine."""
    rays = [minus(corner, point) for corner in corners]
    rays = [tuple(x / math.sqrt(dot(ray, ray)) for x in ray) for ray in rays]
    total = 0.0
    for a, b in zip(rays, rays[1:] + rays[:1], strict=True):
        edge = cross(a, b)
        total += math.acos(max(-1.0, min(1.0, dot(a, b)))) * dot(edge, normal) / math.sqrt(dot(edge, edge))
    return abs(exitance * total / (2 * math.pi))


def position_index(way):
    """Of a direction (ahead, aside, up): Levin (1975)."""
    ahead, aside, up = way
    sigma = math.degrees(math.atan2(math.hypot(aside, up), ahead))
    tau = math.degrees(math.atan2(abs(aside), up))
    return math.exp((35.2 - 0.31889 * tau - 1.22 * math.exp(-2 * tau / 9)) * 1e-3 * sigma
                    + (21 + 0.26667 * tau - 0.002963 * tau**2) * 1e-5 * sigma**2)


def png_colours(file):
    """How many pixels have each colour, of a PNG of 8-bit RGB."""
    data = file.read_bytes()
    width, height = struct.unpack_from(">2I", data, 16)
    place, packed = 8, b""
    while place < len(data):
        size, kind = struct.unpack_from(">I4s", data, place)
        packed += data[place + 8:place + 8 + size] if kind == b"IDAT" else b""
        place += 12 + size
    raw, stride = zlib.decompress(packed), 3 * width + 1
    above, counts = bytearray(stride - 1), collections.Counter()
    for row in range(height):
        kind, line = raw[row * stride], bytearray(raw[row * stride + 1:(row + 1) * stride])
        for k, value in enumerate(line):
            a, b, c = (line[k - 3], above[k], above[k - 3]) if k >= 3 else (0, above[k], 0)
            paeth = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            line[k] = (value + (0, a, b, (a + b) // 2, paeth)[kind]) & 0xFF
        above = line
        counts.update(zip(line[::3], line[1::3], line[2::3], strict=True))
    return counts


class LightingTest(JobTest):
    method = ()

    def box(self, extra="", faces="", corners=(), materials=""):
        """A scene file of the black box; `extra` goes after its head."""
        self.write("box.mtl", "newmtl black\nKd 0 0 0\n" + materials)
        vertices = "".join("v {} {} {}\n".format(*corner) for corner in [*BOX, *corners])
        self.write("box.obj", "mtllib box.mtl\n" + vertices + "g walls\nusemtl black\n"
                   + "".join(f"f {face}\n" for face in BOX_FACES) + faces)
        return self.write("box.toml", f'units = "photometric"\n[[geometry]]\nfile = "box.obj"\n{extra}')

    def rows(self, receiver, folder=None):
        with open((folder or self.out) / "receivers.csv", newline="", encoding="utf-8") as file:
            return [row for row in csv.DictReader(file) if row["receiver"] == receiver]

    def bulb(self):
        return f'[[luminaires]]\nname = "bulb"\nintensity = {CANDELAS}\nposition = {list(LAMP)}\n'

    def receiver(self, name, text):
        return f'[[receivers]]\nname = "{name}"\n{text}\n'

    def points(self):
        return f"points = {[list(point) for point in POINTS]}\n"

    def test_points_and_cylinders_are_those_of_the_closed_form(self):
        scene = self.box(self.bulb() + self.receiver("flat", self.points() + "normal = [0, 0, 1]")
                         + self.receiver("round", self.points() + 'quantity = "cylindrical"\naxis = [0, 0, 2]')
                         + self.receiver("half", self.points() + 'quantity = "semicylindrical"\naxis = [0, 0, 1]\nfacing = [1, 0, 0]'))
        self.assert_done(start(["solve", scene, "--target-error", 0.05, "--out", self.out]))
        for k, point in enumerate(POINTS):
            way = minus(LAMP, point)
            squared = dot(way, way)
            aside = math.hypot(way[0], way[1])
            sine = aside / math.sqrt(squared)
            exact = {"flat": CANDELAS * way[2] / squared**1.5,
                     "round": CANDELAS * sine / (math.pi * squared),
                     "half": CANDELAS * sine * (1 + way[0] / aside) / (math.pi * squared)}
            for name, value in exact.items():
                row = self.rows(name)[k]
                self.assertLess(abs(float(row["value"]) - value), 3 * float(row["error"]) + 1e-4 * value, (name, row, value))
                self.assertEqual(row["unit"], "lx")
                self.assertEqual([float(row[f"{axis}_m"]) for axis in "xyz"], list(point))

    def test_in_even_light_all_meters_agree(self):
        """Walls of exitance E and reflectance 1/2 send 2 E / pi to everywhere."""
        self.write("white.mtl", "newmtl white\nKd .5 .5 .5\nKe 1 1 1\n")
        self.write("white.obj", "mtllib white.mtl\nusemtl white\n" + "".join("v {} {} {}\n".format(*corner) for corner in BOX)
                   + "".join(f"f {face}\n" for face in BOX_FACES))
        grid = "origin = [1, 1, 1]\nu = [2, 0, 0]\nv = [0, 1, 1]\ncells = [3, 2]\n"
        kinds = {"flat": "", "round": 'quantity = "cylindrical"\naxis = [0, 1, 0]\n',
                 "half": 'quantity = "semicylindrical"\naxis = [1, 0, 0]\nfacing = [0, 1, 0]\n',
                 "seen": 'quantity = "radiance"\ndirection = [1, 1, 1]\nangle = 60\n'}
        scene = self.write("white.toml", '[options]\nke = "exitance"\n[[geometry]]\nfile = "white.obj"\n'
                           + "".join(self.receiver(name, grid + kind) for name, kind in kinds.items()))
        self.assert_done(start(["solve", scene, "--target-error", 0.01, "--out", self.out]))
        for name in kinds:
            rows = self.rows(name)
            self.assertEqual(len(rows), 6)
            exact = 2 / math.pi if name == "seen" else 2
            for row in rows:
                self.assertLess(abs(float(row["value"]) / exact - 1), 0.01, (name, row))
                self.assertEqual(row["unit"], "W/(m2 sr)" if name == "seen" else "W/m2")

    def test_a_cone_sees_what_is_in_it(self):
        """A lamp fills the cone of one meter and half of another's; of a wide one it has its part of the solid angle."""
        corners = [(2, 7.99, 0), (6, 7.99, 0), (6, 7.99, 2), (2, 7.99, 2)]
        lamp = "g lamp\nusemtl lamp\nf 9 10 11 12\n"
        scene = self.box(self.receiver("seen", 'quantity = "radiance"\npoints = [[4, 4, 1], [4, 4, 2]]\ndirection = [0, 1, 0]\nangle = 10')
                         + self.receiver("wide", 'quantity = "radiance"\npoints = [[4, 4, 1]]\ndirection = [0, 1, 0]\nangle = 120')
                         + '[options]\nke = "exitance"\n', lamp, corners, "newmtl lamp\nKd 0 0 0\nKe 7 7 7\n")
        self.assert_done(start(["solve", scene, "--target-error", 0.02, "--out", self.out]))
        whole, half = (float(row["value"]) for row in self.rows("seen"))
        self.assertAlmostEqual(whole * math.pi / 7, 1, delta=1e-3)
        self.assertAlmostEqual(half * math.pi / 7, 0.5, delta=0.02)
        a, b, d = 2, 1, 3.99  # half a rectangle's sides, before its middle
        lamp = 4 * math.asin(a * b / math.sqrt((a * a + d * d) * (b * b + d * d)))
        share = lamp / (2 * math.pi * (1 - math.cos(math.radians(60))))
        self.assertAlmostEqual(float(self.rows("wide")[0]["value"]) * math.pi / 7 / share, 1, delta=0.02)
        self.assertEqual({row["unit"] for row in self.rows("seen")}, {"cd/m2"})

    LUMINAIRES = [[4.5, 4.0, 3.0], [6.0, 5.5, 3.5]]

    def background(self, corners, eye, rho=0.5, side=60):
        """Luminance: what a mat that luminaires light sends to an eye that looks along x, over pi."""
        (x0, y0, z), (x1, _, _), (_, y1, _), _ = corners
        indirect, area = 0, (x1 - x0) * (y1 - y0) / side**2
        for i in range(side * side):
            at = (x0 + (x1 - x0) * (i % side + 0.5) / side, y0 + (y1 - y0) * (i // side + 0.5) / side, z)
            light = sum(CANDELAS * (place[2] - z) / dot(minus(place, at), minus(place, at))**1.5 for place in self.LUMINAIRES)
            way = minus(eye, at)
            indirect += rho * light * area * way[2] * -way[0] / (math.pi * dot(way, way)**2)
        return indirect / math.pi

    def glare_scene(self, tasks="", hidden=False):
        """Two luminaires before an eye, and a mat below its line of sight, which they light, as the background; a lamp
        overhead, beyond the field of view, lights the eye alone. A point luminaire may glare too, and a plate hide all of
        them."""
        corners = [(3, 3, 0.01), (5, 3, 0.01), (5, 5, 0.01), (3, 5, 0.01)]
        lamp = [(1.3, 3.8, 3.8), (1.3, 3.8, 4), (1.3, 4.2, 4), (1.3, 4.2, 3.8)]
        plate = [(1.5, 2, 1.2), (1.5, 6, 1.2), (1.5, 6, 3.9), (1.5, 2, 3.9)] if hidden else []
        luminaires = "".join(f'[[luminaires]]\nname = "l{k}"\nintensity = {CANDELAS}\nposition = {place}\nsize = [0.2, 0.3]\n'
                             f"aim = [0, 0, -1]\n" for k, place in enumerate(self.LUMINAIRES))
        observer = '[[observers]]\nname = "eye"\neye = [1, 4, 1.2]\ndirection = [1, 0, 0]\nup = [0, 0, 1]\n'
        blind = '[[observers]]\nname = "away"\neye = [5.2, 4, 1.2]\ndirection = [-1, 0, 0]\nup = [0, 0, 1]\n'
        return self.box(luminaires + observer + blind + tasks + '[options]\nke = "exitance"\n', "g mat\nusemtl mat\nf 9 10 11 12\n"
                        "g lamp\nusemtl lamp\nf 13 14 15 16\n" + ("g plate\nusemtl black\nf 17 18 19 20\n" if hidden else ""),
                        corners + lamp + plate, "newmtl mat\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n"), corners

    def test_glare_is_that_of_the_closed_form(self):
        scene, corners = self.glare_scene()
        eye, area = (1, 4, 1.2), 0.06
        background = self.background(corners, eye)
        weighted = 0
        for place in self.LUMINAIRES:
            way = minus(place, eye)
            distance = math.sqrt(dot(way, way))
            projected = area * way[2] / distance
            weighted += (CANDELAS / projected)**2 * projected / distance**2 / position_index(way)**2
        exact = 8 * math.log10(0.25 / background * weighted)
        for command, report in (("solve", "report.json"), ("reference", "reference.json")):
            job = start([command, scene, "--target-error", 0.02, "--out", self.out])
            self.assert_done(job)
            observers = json.loads((self.out / report).read_text())["observers"]
            found = observers["eye"]
            luminance = found["background_luminance"]
            self.assertLess(luminance["error"] / luminance["value"], 0.05)
            self.assertLess(abs(luminance["value"] - background), 3 * luminance["error"])
            self.assertAlmostEqual(found["ugr"]["value"] + 8 * math.log10(luminance["value"] / background), exact, delta=0.05)
            self.assertLess(found["ugr"]["error"], 0.45)
            self.assertNotIn("ugr", observers["away"], "the lamps are behind these eyes, and hidden by the brow")
            if command == "solve":
                self.assertIn(f"observer eye: UGR {found['ugr']['value']:.4g}", job.out)
                self.assertIn("observer away: nothing glares", job.out)

    def test_a_point_glares_as_a_small_opening(self):
        """CIE 147: it counts for 0.005 m2."""
        point = f'[[luminaires]]\nname = "point"\nintensity = {CANDELAS}\nposition = [5, 4, 2.4]\n'
        scene, _ = self.glare_scene()
        way = (4, 0, 1.2)
        self.assert_done(start(["solve", scene, "--target-error", 0.02, "--out", self.out]))
        without = self.report()["observers"]["eye"]
        weighted = 10**(without["ugr"]["value"] / 8) * without["background_luminance"]["value"] / 0.25
        weighted += CANDELAS**2 / 0.005 / dot(way, way) / position_index(way)**2
        scene, _ = self.glare_scene(point)
        self.assert_done(start(["solve", scene, "--target-error", 0.02, "--out", self.out]))
        eye = self.report()["observers"]["eye"]
        exact = 8 * math.log10(0.25 / eye["background_luminance"]["value"] * weighted)
        self.assertAlmostEqual(eye["ugr"]["value"], exact, delta=0.1)
        self.assertGreater(exact, without["ugr"]["value"] + 3)

    def test_what_is_hidden_does_not_glare(self):
        scene, _ = self.glare_scene(hidden=True)
        self.assert_done(start(["solve", scene, "--target-error", 0.1, "--out", self.out]))
        eye = self.report()["observers"]["eye"]
        self.assertNotIn("ugr", eye)
        self.assertEqual(eye["solid_angle"], 0)
        self.assertGreater(eye["indirect_illuminance"]["value"], 0)

    def desk(self):
        return self.receiver("desk", "origin = [2, 4, 1]\nu = [2, 0, 0]\nv = [0, 2, 0]\ncells = [4, 4]")

    def test_verdicts_have_three_words(self):
        scene = self.box(self.bulb() + self.desk())
        self.assert_done(start(["solve", scene, "--target-error", 0.05, "--out", self.out]))
        values = [float(row["value"]) for row in self.rows("desk")]
        mean, U0 = sum(values) / 16, 16 * min(values) / sum(values)
        wanted = {"easy": (0.5 * mean, 0.5 * U0, "pass"), "hard": (1.5 * mean, 0.5 * U0, "fail"),
                  "near": (0.9 * mean, U0, "not decided by the error"), "maintained": (0.9 * mean, 0.5 * U0, "fail")}
        tasks = "".join(f'[[tasks]]\nname = "{name}"\narea = "desk"\nilluminance = {illuminance}\nU0 = {uniformity}\n'
                        for name, (illuminance, uniformity, _) in wanted.items())
        scene = self.box(self.bulb() + self.desk() + tasks)
        for factor in (1, 0.8):
            job = start(["solve", scene, "--target-error", 0.05, "--maintenance-factor", factor, "--out", self.out])
            self.assert_done(job)
            verdicts = {task["name"]: task["verdict"] for task in self.report()["tasks"]}
            for name, (_, _, verdict) in wanted.items():
                if factor == 1 and name == "maintained":
                    verdict = "pass"
                if factor == 0.8 and name == "near":
                    verdict = "fail"
                self.assertEqual(verdicts[name], verdict, (name, factor))
                self.assertIn(f"task {name}: {verdict}", job.out)
        with open(self.out / "tasks.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["quantity"] for row in rows], ["Em", "U0"] * 4)
        self.assertAlmostEqual(float(rows[0]["found"]) / (0.8 * mean), 1, delta=1e-3)

    def test_what_is_around_a_task_has_requirements_of_its_own(self):
        for task, around in ((1000, 500), (750, 500), (500, 300), (300, 200), (200, 150), (100, 100)):
            scene = self.box(self.bulb() + self.desk() + f'[[tasks]]\nname = "t"\narea = "desk"\nsurrounding = "desk"\n'
                             f'background = "desk"\nilluminance = {task}\n')
            self.assert_done(start(["solve", scene, "--target-error", 0.3, "--out", self.out]))
            criteria = self.report()["tasks"][0]["criteria"]
            self.assertEqual([(row["zone"], row["quantity"]) for row in criteria],
                             [("task area", "Em"), ("surrounding", "Em"), ("surrounding", "U0"), ("background", "Em"), ("background", "U0")])
            for row, required in zip(criteria, (task, around, 0.4, around / 3, 0.1), strict=True):
                self.assertAlmostEqual(row["required"], required, delta=1e-4 * required)

    def test_glare_of_a_task_is_of_its_observers(self):
        task = '[[receivers]]\nname = "desk"\norigin = [3, 3, 1]\nu = [2, 0, 0]\nv = [0, 2, 0]\ncells = [2, 2]\n' \
            '[[tasks]]\nname = "read"\narea = "desk"\nilluminance = 1\nUGR = {}\nobservers = ["eye", "away"]\n'
        for limit, verdict in ((36, "pass"), (10, "fail")):
            scene, _ = self.glare_scene(task.format(limit))
            for command, report in (("solve", "report.json"), ("reference", "reference.json")):
                self.assert_done(start([command, scene, "--target-error", 0.05, "--out", self.out]))
                (judged,) = json.loads((self.out / report).read_text())["tasks"]
                self.assertEqual(judged["verdict"], verdict)
                glare = {row["of"]: row["verdict"] for row in judged["criteria"] if row["quantity"] == "UGR"}
                self.assertEqual(glare, {"eye": verdict, "away": "pass"})
                self.assertTrue((self.out / "tasks.csv").exists())

    def test_a_surface_carries_a_grid(self):
        """Over an L-shaped floor, with a border: only what is above the floor is measured and counted."""
        corners = [(1, 1, 0.1), (5, 1, 0.1), (5, 3, 0.1), (1, 3, 0.1), (3, 3, 0.1), (3, 5, 0.1), (1, 5, 0.1)]
        floor = "g floor\nusemtl black\nf 9 10 11 12\nf 12 13 14 15\n"
        grid = self.receiver("plan", 'surface = "floor"\nnormal = [0, 0, 1]\noffset = 0.75\nborder = 0.5\nspacing = 0.25')
        scene = self.box(self.bulb() + grid, floor, corners)
        self.assert_done(start(["solve", scene, "--target-error", 0.1, "--out", self.out]))
        self.assertEqual(len(self.rows("plan")), 12 * 12)
        rows = [row for row in self.rows("plan") if row["value"]]
        self.assertEqual(self.report()["receivers"]["plan"]["cells"], 12 * 12)
        self.assertTrue(all(abs(float(row["z_m"]) - 0.85) < 1e-9 for row in rows))
        for row in rows:
            x, y = float(row["x_m"]), float(row["y_m"])
            self.assertTrue(x < 2.5 or y < 2.5 or math.hypot(3 - x, 3 - y) >= 0.5, (x, y))
        mean = sum(float(row["value"]) for row in rows) / len(rows)
        self.assertAlmostEqual(self.report()["receivers"]["plan"]["mean"]["value"] / mean, 1, delta=1e-4)
        self.assertEqual(sum(self.report()["receivers"]["plan"]["error_histogram"]["cells"]), len(rows))

    def test_grids_are_shown_in_false_colours(self):
        scene = self.box(self.bulb() + self.desk() + self.receiver("line", "from = [1, 1, 1]\nto = [5, 1, 1]\ncount = 5\nnormal = [0, 0, 1]")
                         + "[camera]\neye = [1, 1, 1]\nlook_at = [4, 4, 1]\nup = [0, 0, 1]\nresolution = [40, 30]\n")
        self.assert_done(start(["solve", scene, "--target-error", 0.2, "--write", "false-colour", "--out", self.out]))
        first = (self.out / "receiver-desk.png").read_bytes()
        width, height = struct.unpack_from(">2I", first, 16)
        self.assertGreater(min(width, height), 700)
        self.assertFalse((self.out / "receiver-line.png").exists())
        self.assertEqual(len(self.rows("line")), 5)
        self.assertTrue((self.out / "image-false-colour.png").exists())
        self.assert_done(start(["solve", scene, "--target-error", 0.2, "--false-colour-max", 500, "--false-colour-decades", 2, "--out", self.out]))
        self.assertNotEqual(first, (self.out / "receiver-desk.png").read_bytes())
        self.assertFalse((self.out / "image-false-colour.png").exists(), "was not asked for again")
        self.assertEqual(self.report()["options"]["false_colour_max"], 500)

    def test_a_lamp_that_is_seen_does_not_make_all_else_dark(self):
        """The scale ends where what does not emit is brightest; the lamp, far beyond, has its last colour."""
        room = "[[geometry]]\nbox = [4, 3, 2.5]\ninwards = true\n"
        lamp = '[[geometry]]\nrectangle = [1, 1]\nrotate = [1, 0, 0, 180]\ntranslate = [1.5, 2, 2.4]\nmaterial = "lamp"\n[materials.lamp]\nE = 1000\n'
        camera = "[camera]\neye = [3.9, 0.2, 0.8]\nlook_at = [1.5, 1.5, 1.7]\nup = [0, 0, 1]\nfov = 80\nresolution = [40, 30]\n"
        scene = self.write("lamp.toml", room + lamp + camera)
        self.assert_done(start(["solve", scene, "--target-error", 0.2, "--write", "false-colour", "--out", self.out]))
        colours = png_colours(self.out / "image-false-colour.png")
        shown = sum(count for (red, green, blue), count in colours.items() if max(red, green, blue) - min(red, green, blue) > 40)
        bright = sum(count for (red, green, blue), count in colours.items() if green > 140 and green > blue + 30)
        self.assertGreater(bright, 0.1 * shown)

    def test_points_under_an_area_source(self):
        """In the style of CIE 171:2006, case 5.3: a lamp of 1 x 1 m, 3 m above the floor, level and upright points."""
        corners = [(3.5, 3.5, 3), (3.5, 4.5, 3), (4.5, 4.5, 3), (4.5, 3.5, 3)]
        level = [(4 + x, 4 + y, 0.01) for x, y in ((0, 0), (0.5, 0), (1, 0), (1.5, 0), (1, 1), (1.5, 1.5))]
        upright = [(6, 4, z) for z in (0.5, 1, 1.5, 2, 2.5)]
        scene = self.box(self.receiver("level", f"points = {[list(point) for point in level]}\nnormal = [0, 0, 1]")
                         + self.receiver("upright", f"points = {[list(point) for point in upright]}\nnormal = [-1, 0, 0]")
                         + '[options]\nke = "exitance"\n', "g lamp\nusemtl lamp\nf 9 10 11 12\n", corners,
                         "newmtl lamp\nKd 0 0 0\nKe 1000 1000 1000\n")
        self.assert_done(start(["solve", scene, "--target-error", 0.01, "--out", self.out]))
        for name, points, normal in (("level", level, (0, 0, 1)), ("upright", upright, (-1, 0, 0))):
            for row, point in zip(self.rows(name), points, strict=True):
                exact = irradiance_of_polygon(1000, corners, point, normal)
                self.assertLess(abs(float(row["value"]) / exact - 1), 0.005, (name, point))

    def test_temperatures_are_shown_too(self):
        """A hot wall and cold ones: two colours fill the picture, those of the ends of the scale."""
        self.write("heat.mtl", "newmtl hot\nemissivity 1\ntemperature 900\nnewmtl cold\nemissivity 1\ntemperature 300\n")
        self.write("heat.obj", "mtllib heat.mtl\n" + "".join("v {} {} {}\n".format(*corner) for corner in BOX) + "usemtl cold\n"
                   + "".join(f"f {face}\n" for face in BOX_FACES[:-1]) + "usemtl hot\n" + f"f {BOX_FACES[-1]}\n")
        camera = ("--eye", "4,4,2", "--look-at", "8,4.1,2", "--up", "0,0,1", "--fov", "90", "--resolution", "40x30")
        job = start(["solve", self.work / "heat.obj", "--thermal", *camera, "--write", "false-colour", "--out", self.out])
        self.assert_done(job)
        colours = png_colours(self.out / "image-false-colour.png")
        cold, hot = (0x44, 0x01, 0x54), (0xFD, 0xE7, 0x25)
        self.assertGreater(min(colours[cold], colours[hot]), 10000)
        self.assertGreater(colours[cold] + colours[hot], 0.9 * 12**2 * 40 * 30)

    def test_meters_inside_bodies_are_named(self):
        corners = [(x, y, z) for z in (0.5, 1.5) for y in (2, 3) for x in (2, 3)]
        faces = "".join("f " + " ".join(str(int(k) + 8) for k in face.split()[::-1]) + "\n" for face in BOX_FACES)
        crate = "g crate\nusemtl black\n" + faces
        scene = self.box(self.bulb() + self.receiver("meters", "points = [[2.5, 2.5, 1], [4, 4, 1]]\nnormal = [0, 0, 1]"), crate, corners)
        said = "receiver 'meters': 50 % of its points see nothing but dark backs, as that of 'crate'"
        job = start(["solve", scene, "--target-error", 0.2, "--out", self.out])
        self.assert_done(job)
        self.assertTrue(any(said in warning for warning in self.report()["warnings"]), job)
        self.assertIn(said, start(["info", scene]).out)
        self.assertEqual(float(self.rows("meters")[0]["value"]), 0)

    def test_views_and_ranks_measure_the_same(self):
        scene, _ = self.glare_scene(self.desk() + '[[tasks]]\nname = "t"\narea = "desk"\nilluminance = 9\nUGR = 19\nobservers = ["eye"]\n')
        files = []
        for ranks in (1, 3):
            self.assert_done(self.solve(scene, "--target-error", 0.1, "--threads", 1, ranks=ranks))
            files.append([(self.out / name).read_bytes() for name in ("receivers.csv", "tasks.csv")])
        tasks = fluxel.Solution(self.out).tasks
        self.assertEqual(tasks["zone"].tolist(), ["task area", "observer"])
        self.assertEqual(*files)
        view = self.work / "view"
        self.assert_done(start(["view", scene, "--solution", self.out / "solution.ply", "--out", view]))
        for solved, viewed in zip(self.rows("desk"), self.rows("desk", view), strict=True):
            self.assertAlmostEqual(float(viewed["value"]) / float(solved["value"]), 1, delta=0.02)
        report = json.loads((view / "report.json").read_text())
        self.assertAlmostEqual(report["observers"]["eye"]["ugr"]["value"], self.report()["observers"]["eye"]["ugr"]["value"], delta=0.1)
        self.assertEqual(report["tasks"][0]["name"], "t")

    def test_what_is_wrong_is_said(self):
        grid = "origin = [2, 4, 1]\nu = [2, 0, 0]\nv = [0, 2, 0]\n"
        surface = 'surface = "walls"\nnormal = [0, 0, 1]\n'
        desk, observer = self.desk(), '[[observers]]\nname = "eye"\neye = [1, 4, 1]\ndirection = [1, 0, 0]\nup = [0, 0, 1]\n'
        task = '[[tasks]]\nname = "t"\narea = "desk"\nilluminance = 500\n'
        cases = [
            (self.receiver("a", ""), "must say in one way where it is"),
            (self.receiver("a", grid + "cells = [2, 2]\npoints = [[1, 1, 1]]"), "must say in one way where it is"),
            (self.receiver("a", grid), "lacks cells"),
            (self.receiver("a", grid + "cells = [65536, 65536]"), "more than 16777216 cells"),
            (self.receiver("a", grid + "cells = [2, 2]\noffset = 1"), "offset has no meaning without a surface"),
            (self.receiver("a", grid + "cells = [2, 2]\nnormal = [0, 0, 1]"), "normal has no meaning"),
            (self.receiver("a", grid + 'cells = [2, 2]\nquantity = "lux"'), "receiver quantity is 'lux'"),
            (self.receiver("a", grid + 'cells = [2, 2]\nquantity = "cylindrical"'), "lacks axis"),
            (self.receiver("a", grid + 'cells = [2, 2]\nquantity = "semicylindrical"\naxis = [0, 0, 1]\nfacing = [0, 0, 2]'), "parallel to its axis"),
            (self.receiver("a", grid + 'cells = [2, 2]\nquantity = "radiance"\ndirection = [0, 0, 1]\nangle = 200'), "at most 180 degrees"),
            (self.receiver("a", "points = []\nnormal = [0, 0, 1]"), "must be an array of points"),
            (self.receiver("a", "points = [[1, 1, 1]]"), "lacks normal"),
            (self.receiver("a", "points = [[1, 1, 1e300]]\nnormal = [0, 0, 1]"), "too far away"),
            (self.receiver("a", "points = [[1, 1, 1]]\nnormal = [0, 0, 0]"), "has no direction"),
            (self.receiver("a", "from = [1, 1, 1]\nto = [1, 1, 1]\ncount = 4\nnormal = [0, 0, 1]"), "a line of no length"),
            (self.receiver("a", "from = [1, 1, 1]\nto = [2, 1, 1]\ncount = 1\nnormal = [0, 0, 1]"), "from 2 to 65536"),
            (self.receiver("a", surface + "cells = [2, 2]"), "surface 'walls' is not flat"),
            (self.receiver("a", surface.replace("walls", "wall") + "cells = [2, 2]"), "did you mean 'walls'"),
            (self.receiver("a", surface + "cells = [2, 2]\nspacing = 1"), "cells and spacing say the same"),
            (self.receiver("a", surface + "spacing = 0"), "must be greater than 0 m"),
            (self.receiver("a", surface + "border = -1\nspacing = 1"), "border is below 0 m"),
            (self.receiver("a", "origin = [1e300, 0, 0]\nu = [1, 0, 0]\nv = [0, 1, 0]\ncells = [1, 1]"), "too far away"),
            (self.receiver("a", surface + "spacing = 1\noffset = 1e300"), "receiver offset is too far"),
            (observer.replace("[1, 4, 1]", "[1e300, 4, 1]"), "observer eye is too far away"),
            (observer + desk + task + 'UGR = 19\nobservers = ["eye", "eye"]\n', "'eye' stands twice"),
            (self.receiver("round", 'quantity = "cylindrical"\naxis = [0, 0, 1]\npoints = [[1, 1, 1]]') + desk + task + 'surrounding = "round"\n',
             "measures cylindrical"),
            (desk + task.replace('"t"', '"t\\n"'), "no single line"),
            (desk + desk, "a second receiver 'desk'"),
            (task, "there is no receiver 'desk'"),
            (desk + task + task, "a second task 't'"),
            (desk + task.replace("500", "-1"), "task illuminance must be greater than 0"),
            (desk + task + "U0 = 2\n", "task U0 must be greater than 0 and at most 1"),
            (desk + task + "UGR = 19\n", "needs both UGR and observers"),
            (desk + task + 'UGR = 19\nobservers = ["eye"]\n', "there is no observer 'eye'"),
            (desk + task + 'background = "desk"\n', "has a background and no surrounding"),
            (self.receiver("desk", 'quantity = "radiance"\npoints = [[1, 1, 1]]\ndirection = [0, 0, 1]\nangle = 9') + task, "measures radiance"),
            (observer + observer, "a second observer 'eye'"),
            (observer.replace("up = [0, 0, 1]\n", ""), "[[observers]] lacks up"),
            (observer.replace("up = [0, 0, 1]", "up = [2, 0, 0]"), "observer up is parallel to its direction"),
        ]
        for text, message in cases:
            with self.subTest(message):
                scene = self.box(self.bulb() + text)
                job = start(["solve", scene, "--out", self.out], ranks=2)
                self.assertEqual(job.code, 2, job)
                self.assertEqual(len(job.said), 1, job)
                self.assertIn(message, job.said[0])
                self.assertRegex(job.said[0], r"box\.toml:\d+: ")
        scene = self.box(self.bulb() + desk + task)
        scene.write_text(scene.read_text().replace("photometric", "radiometric"))
        job = start(["solve", scene, "--out", self.out])
        self.assertEqual(job.code, 2, job)
        for options in (["--maintenance-factor", 1.5], ["--false-colour-decades", 99], ["--false-colour-max", 0]):
            job = start(["solve", self.box(self.bulb() + desk), *options, "--out", self.out])
            self.assertEqual(job.code, 2, job)


if __name__ == "__main__":
    unittest.main()
