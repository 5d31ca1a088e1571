"""Blocks as coarse as an error allows: `--method hierarchical` and `--target-error`."""

import math
import re
import sys
import unittest

from fluxel_job import MATRIX, SCENES, JobTest, start
from radiation import SIGMA
from result_files import read_elements, read_exr
from rooms import INSIDE, MTL, ROOM, SMALL, VERTICES, CEILING, WALLS
from scale_test import CORNELL, WOOD

import fluxel

sys.path.insert(0, str(SCENES.parent / "bench" / "growth"))
from field import write_field

HIERARCHICAL = ("--method", "hierarchical")
CORNELL_FILE = SCENES / "cornell-box" / "cornell-box.toml"
CUBE_EDGE = 0.25  # [m]

# rho 0.5 everywhere; the ceiling emits 1 W/m2, or everything 1 - rho. Ke is a radiance.
ONE, HALF = (f"Ke {E / math.pi:.15g}" for E in (1, 0.5))
EMITTING = MTL.replace("Kd 0.2 0.2 0.2", "Kd 0.5 0.5 0.5").replace("Ke 1 1 1", ONE)
FURNACE = EMITTING.replace(ONE, HALF).replace("newmtl white", f"newmtl white\n{HALF}")


def area_and_normal(corners):
    vector = [0.0, 0.0, 0.0]
    for a, b in zip(corners, corners[1:] + corners[:1]):
        for k in range(3):
            vector[k] += (a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]) / 2
    area = math.hypot(*vector)
    return area, tuple(round(x / area) for x in vector)


def face_means(elements):
    """{normal: area-weighted mean of the red radiosity of the fronts}."""
    sums = {}
    for element in elements:
        area, normal = area_and_normal(element["corners"])
        of_normal = sums.setdefault(normal, [0.0, 0.0])
        of_normal[0] += area
        of_normal[1] += area * element["radiosity"][0]
    return {normal: power / area for normal, (area, power) in sums.items()}


class HierarchicalTest(JobTest):
    method = ()

    def setUp(self):
        super().setUp()
        self.write("room.mtl", MTL)
        self.room = self.write("room.obj", ROOM)

    def room_of(self, materials):
        self.write("room.mtl", materials)
        return self.room

    def solved(self, *arguments, **settings):
        """Elements and report of a run that goes well."""
        self.assert_done(self.solve(*arguments, "--quiet", **settings))
        return read_elements(self.out / "solution.ply"), self.report()

    # Closed forms

    def test_white_furnace(self):
        for error, largest in ((1e-3, 0.01), (3e-5, 0.0025)):
            with self.subTest(error=error):
                elements, report = self.solved(self.room_of(FURNACE), "--block-error", error)
                for element in elements:
                    for value in element["radiosity"]:
                        self.assertAlmostEqual(value, 1, delta=largest)
                for mean in face_means(elements).values():
                    self.assertAlmostEqual(mean, 1, delta=0.1 * largest)
                self.assertLess(abs(report["energy"]["defect_relative"]), 1e-3)

    def test_emitting_wall(self):
        # Within 0.09 % when it was written.
        elements, report = self.solved(self.room_of(EMITTING), "--block-error", 1e-5)
        means = face_means(elements)
        self.assertEqual(len(means), 6)
        for normal, mean in means.items():
            expected = {-1: 1.104362, 1: 0.171216, 0: 0.181105}[normal[2]]
            self.assertAlmostEqual(mean / expected, 1, delta=2e-3)
        self.assertEqual(report["hierarchy"]["chosen"]["block_error"], 1e-5)
        self.assertEqual(report["hierarchy"]["shafts"], 0, "nothing stands between two walls")

    def test_an_error_that_falls_with_the_blocks(self):
        errors = []
        for error in (1e-3, 1e-4, 1e-5):
            elements, _ = self.solved(self.room_of(EMITTING), "--block-error", error)
            means = face_means(elements)
            errors.append(max(abs(mean / {-1: 1.104362, 1: 0.171216, 0: 0.181105}[normal[2]] - 1)
                              for normal, mean in means.items()))
        self.assertLess(errors[1], errors[0])
        self.assertLess(errors[2], errors[1])
        self.assertLess(errors[2], 1e-3)

    def test_cube_in_cube_is_what_the_matrix_says(self):
        scene = SCENES / "cube-in-cube" / "cube-in-cube.toml"
        elements, report = self.solved(scene, "--target-error", 0.01)
        # Elements alone are looked at.
        fine, _ = self.solved(scene, *MATRIX, "--subdivision", "uniform", "--max-edge", CUBE_EDGE, "--picture", "elements")
        found, expected = face_means(elements), face_means(fine)
        self.assertEqual(found.keys(), expected.keys())
        for normal, mean in found.items():
            self.assertAlmostEqual(mean / expected[normal], 1, delta=0.01)
        self.assertLess(abs(report["energy"]["defect_relative"]), 0.01)

    def test_given_elements_get_the_light_of_their_own_place(self):
        # The hierarchy halves some pieces across the other side first: 1.8 % where it took the node that is as large for
        # the element. 0.4 % when it was written.
        scene, mesh = SCENES / "corridor" / "corridor.toml", ("--subdivision", "uniform", "--max-edge", 0.4, "--audit", 0)
        self.solved(scene, *mesh, "--target-error", 0.01, "--error-of", "surfaces")
        found = fluxel.read_elements(self.out / "solution.ply")
        self.solved(scene, *MATRIX, *mesh, "--no-error-estimate")
        expected = fluxel.read_elements(self.out / "solution.ply")
        areas, green = expected.areas, expected.radiosity[:, 1]
        off = (areas @ (found.radiosity[:, 1] - green) ** 2 / areas.sum()) ** 0.5
        self.assertLess(off / (areas @ green / areas.sum()), 0.009)

    def test_a_floor_full_of_boxes_keeps_its_light(self):
        # A leaf of the floor is large beside the boxes on it. 0.5 % when it was written.
        field = self.work / "field.obj"
        write_field(field, 20)
        _, report = self.solved(field, "--sides", "one", "--subdivision", "transport", "--block-error", 1e-3)
        self.assertLess(abs(report["energy"]["defect_relative"]), 0.015)

    def test_light_comes_out_from_between_boxes(self):
        # What is high up between boxes is brighter and sends more of its light to the ceiling than the mean of a
        # leaf. -2.0 % when it was written (-2.9 % at 3e-4, -1.2 % at 3e-5), where constants over leaves that are seen
        # in part give -3.4 %.
        field = self.work / "field.obj"
        write_field(field, 8, gap=0, lamp_gap=0)
        elements, _ = self.solved(field, "--ke", "exitance", "--sides", "one", "--subdivision", "transport",
                                  "--block-error", 1e-4)
        ceiling = [e for e in elements if e["radiosity"][0] < 10 and all(z > 3.99 for *_, z in e["corners"])]
        # By `fluxel reference --time 50` of 8,862 elements, 1,152 of them on the ceiling: 145 million rays.
        self.assertAlmostEqual(face_means(ceiling)[0, 0, -1] / 0.3772, 1, delta=0.025)

    # Where nothing is reflected

    def test_heat_between_black_walls(self):
        heat = lambda T: f"emissivity 1\ntemperature {T}\n"
        materials = MTL.replace("newmtl light", heat(300) + "newmtl light") + heat(1000)
        self.write("room.mtl", materials)
        room = self.write("room.obj", ROOM.replace("usemtl light", "g ceiling\nusemtl light"))
        _, report = self.solved(room, *HIERARCHICAL, "--thermal", "--sides", "one")
        net = SIGMA * (1000**4 - 300**4)
        for row in report["thermal"]:
            self.assertAlmostEqual(row["net_w"] / net, {"ceiling": 1, "default": -1}[row["group"]], delta=0.01)

    def test_pictures_that_stay_black(self):
        black_wall = ROOM.replace("f 3 7 8 4\n", "usemtl black\nf 3 7 8 4\nusemtl white\n")
        shifted = VERTICES.replace("v 0", "v 3").replace("v 1", "v 4")
        walls = WALLS + "f 5 8 7 6\n"
        dark_room = ROOM + shifted + re.sub(r"\d", lambda corner: str(int(corner[0]) + 8), walls)
        self.write("room.mtl", MTL + "newmtl black\nKd 0 0 0\n")
        for room, x in ((black_wall, 0.5), (dark_room, 3.5)):
            view = ("--eye", f"{x},0.5,0.5", "--look-at", f"{x},0.9,0.5", "--up", "0,0,1", "--fov", "40")
            with self.subTest(x=x):
                _, report = self.solved(self.write("room.obj", room), *view, *SMALL, "--sides", "one",
                                        "--target-error", 0.05, "--memory", "100M")
                self.assertLess(len(report["hierarchy"]["rounds"]), 6)

    # The same whoever works, in whatever unit

    def made(self, *arguments, **settings):
        """All that must not depend on who works: bytes of the solution, pixels, counts."""
        self.assert_done(self.solve(*arguments, "--quiet", **settings))
        report = self.report()
        hierarchy = report["hierarchy"]
        rounds = [[one.get(key) for key in ("block_error", "links", "nodes", "leaves", "iterations", "change")]
                  for one in hierarchy["rounds"]]
        image = self.out / "image.exr"
        return {"solution": (self.out / "solution.ply").read_bytes(), "rounds": rounds,
                "errors": hierarchy["errors"], "chosen": hierarchy["chosen"],
                "pixels": read_exr(image) if image.exists() else None, "elements": report["hash"]["elements"],
                "rays": [hierarchy[key] for key in ("node_pairs_looked_at", "shafts", "contours", "rays", "gather_rays")]}

    def check_same(self, first, other):
        for key, value in first.items():
            self.assertTrue(other[key] == value, key)

    def test_ranks_and_threads(self):
        wood = self.write("wood.toml", WOOD.text(1, 1))
        for scene in ((CORNELL_FILE, "--resolution", "24x24", "--target-error", 0.05),
                      (wood, "--block-error", 1e-3)):
            first = self.made(*scene, ranks=1)
            self.assertGreater(first["rounds"][-1][1], 1000)
            for ranks, threads in ((1, 2), (3, 2)):
                with self.subTest(scene=str(scene[0]), ranks=ranks, threads=threads):
                    self.check_same(first, self.made(*scene, "--threads", threads, ranks=ranks))

    def test_powers_of_two_of_the_unit(self):
        for room, error in ((CORNELL, 1e-3), (WOOD, 1e-2)):
            def made(scale, brightness):
                scene = self.write("scene.toml", room.text(scale, brightness).replace("max-edge", "# max-edge"))
                found = self.made(scene, "--block-error", error, ranks=1)
                faces = read_elements(self.out / "solution.ply")
                del found["solution"], found["elements"], found["pixels"]
                return found, [value / brightness for face in faces for value in face["radiosity"]]

            first, B = made(1.0, 1.0)
            for scale, brightness in ((2.0**-20, 1.0), (2.0**20, 1.0), (1.0, 2.0**-30), (1.0, 2.0**30)):
                with self.subTest(room=room.light, scale=math.log2(scale), brightness=math.log2(brightness)):
                    other, light = made(scale, brightness)
                    self.check_same(first, other)
                    self.assertTrue(light == B, "B differs")

    # Elements

    def test_every_subdivision(self):
        # The means of all are those of the same light.
        means = {}
        for name, arguments in (("transport", ()), ("uniform", ("--max-edge", 0.125)), ("none", ()),
                                ("camera", (*INSIDE, *SMALL))):
            with self.subTest(name):
                elements, report = self.solved(self.room_of(EMITTING), "--block-error", 3e-5, *arguments,
                                               "--subdivision", name)
                means[name] = face_means(elements)
                self.assertEqual(report["elements"], len(elements))
                self.assertEqual(len(elements) == 6, name == "none")
                for normal, mean in means[name].items():
                    self.assertAlmostEqual(mean / means["transport"][normal], 1, delta=0.02)

    def test_without_a_camera(self):
        elements, report = self.solved(self.room, "--target-error", 0.02)
        self.assertEqual(self.written(), ["convergence.csv", "report.html", "report.json", "solution.ply"])
        self.assertTrue(report["hierarchy"]["reached"])
        self.assertLessEqual(report["hierarchy"]["errors"]["discretisation"], 0.02)
        self.assertGreater(len(elements), 6)

    def test_both_sides(self):
        # A sheet in the middle of the room: its upper side sees the light, the lower one does not.
        obj = ROOM + "v 0.2 0.2 0.5\nv 0.8 0.2 0.5\nv 0.8 0.8 0.5\nv 0.2 0.8 0.5\nusemtl white\nf 9 10 11 12\n"
        elements, report = self.solved(self.write("sheet.obj", obj), "--target-error", 0.02, "--sides", "two")
        sheet = [element for element in elements if all(abs(corner[2] - 0.5) < 1e-9 for corner in element["corners"])]
        self.assertGreater(len(sheet), 1)
        for element in sheet:
            self.assertGreater(element["radiosity"][0], 1.5 * element["radiosity_back"][0])
            self.assertGreater(element["radiosity_back"][0], 0.01)
        self.assertLess(abs(report["energy"]["defect_relative"]), 0.02)

    def test_a_single_patch(self):
        one = self.write("one.obj", "mtllib room.mtl\n" + VERTICES + CEILING)
        for sides in ("one", "two"):
            with self.subTest(sides=sides):
                elements, report = self.solved(one, "--ke", "exitance", "--target-error", 0.01, "--sides", sides)
                self.assertEqual([element["radiosity"] for element in elements], [(1.0, 1.0, 1.0)])
                self.assertEqual(report["hierarchy"]["rounds"][-1]["links"], 0)
                self.assertEqual(report["energy"]["defect_relative"], 0)

    # What it says

    def test_report(self):
        _, report = self.solved(self.room, *INSIDE, *SMALL, "--target-error", 0.02)
        hierarchy = report["hierarchy"]
        self.assertEqual(report["options"]["method"], "hierarchical")
        self.assertEqual(report["options"]["target_error"], 0.02)
        rounds = hierarchy["rounds"]
        self.assertNotIn("discretisation", rounds[0])
        for before, after in zip(rounds, rounds[1:]):
            self.assertLess(after["block_error"], before["block_error"])
            self.assertGreaterEqual(after["links"], before["links"])
            self.assertGreaterEqual(after["leaves"], before["leaves"])
            self.assertGreater(after["change"], 0)
        self.assertEqual(hierarchy["chosen"]["block_error"], rounds[-1]["block_error"])
        self.assertEqual(hierarchy["errors"]["discretisation"], rounds[-1]["discretisation"])
        self.assertTrue(hierarchy["reached"])
        self.assertTrue(hierarchy["fits_memory"])
        self.assertNotIn("ended_by", hierarchy)
        self.assertLessEqual(report["stated_error"], 0.02)
        errors = hierarchy["errors"]
        self.assertNotIn("picture", errors)  # of so few pixels each is gathered
        self.assertLessEqual(math.hypot(*errors.values()), 0.02)
        leaves = rounds[-1]["leaves"]
        self.assertEqual(hierarchy["leaf_pairs"], leaves * (leaves - 1) / 2)
        self.assertLess(rounds[-1]["links"], hierarchy["leaf_pairs"])
        self.assertGreater(hierarchy["node_pairs_looked_at"], rounds[-1]["links"])
        self.assertEqual(report["warnings"], [])

    def test_memory_that_does_not_suffice(self):
        job = self.solve(self.room_of(EMITTING), "--block-error", 1e-6, "--memory", "1M", ranks=1)
        self.assert_done(job, code=3)
        self.assertEqual(len(job.warnings), 1, str(job))
        self.assertIn("--memory", job.warnings[0])
        self.assertIn("1 MiB", job.warnings[0])
        report = self.report()
        self.assertFalse(report["hierarchy"]["fits_memory"])
        self.assertEqual(report["hierarchy"]["ended_by"], "memory")
        self.assertEqual([f"warning: {text}" for text in report["warnings"]], job.warnings)
        # A little more than it was given, for what was open then; and still right where it is coarse.
        self.assertLess(report["hierarchy"]["bytes_max"], 4 * 2**20)
        self.assertLess(abs(report["energy"]["defect_relative"]), 2e-3)
        for normal, mean in face_means(read_elements(self.out / "solution.ply")).items():
            self.assertAlmostEqual(mean / {-1: 1.104362, 1: 0.171216, 0: 0.181105}[normal[2]], 1, delta=0.01)

    def test_a_target_that_memory_forbids(self):
        job = self.solve(self.room, *INSIDE, *SMALL, "--target-error", 1e-4, "--memory", "1M")
        self.assert_done(job, code=3)
        self.assertEqual(len(job.warnings), 2, str(job))
        self.assertIn("above the target of 0.01 %", job.warnings[1])
        self.assertFalse(self.report()["hierarchy"]["reached"])

    def test_oracles(self):
        blocks = {}
        for oracle in ("all", "power", "importance", "geometry"):
            _, report = self.solved(CORNELL_FILE, "--resolution", "16x16", "--block-error", 1e-3, "--oracle", oracle)
            blocks[oracle] = report["hierarchy"]["rounds"][-1]["links"]
        self.assertEqual(len(set(blocks.values())), 4, str(blocks))

    # The error that is asked for

    def test_target_errors_are_kept(self):
        """Of the pixels that show no lamp, against paths of light, whose two halves take out their noise.

        What remains is known within some tens of percent: 4.1 of 5 and 1.0 of 2 % when this was written.
        """
        view = (CORNELL_FILE, "--resolution", "64x64")
        truth = self.work / "reference"
        self.assert_done(start(["reference", *view, "--supersample", 1, "--only", "picture", "--rays", 1e7,
                                "--out", truth, "--quiet"], ranks=1))
        truth = read_exr(truth / "reference.exr")
        grey = lambda layers, name, place: sum(layers[name + c][place[0]][place[1]] for c in "RGB") / 3
        for target in (0.05, 0.02):
            with self.subTest(target=target):
                self.solved(*view, "--supersample", 1, "--target-error", target, ranks=1)
                image = read_exr(self.out / "image.exr")
                places = [(y, x) for y in range(64) for x in range(64) if image["R"][y][x] < 10]
                self.assertGreater(len(places), 4000)
                square = mean = 0
                for place in places:
                    value = grey(image, "", place)
                    a, b = grey(truth, "half_a.", place), grey(truth, "half_b.", place)
                    square += (value - a) * (value - b) / len(places)
                    mean += (a + b) / 2 / len(places)
                error = math.sqrt(max(0, square)) / mean
                self.assertLessEqual(error, 1.2 * self.report()["stated_error"])
                self.assertLessEqual(self.report()["stated_error"], target)
                self.assertGreaterEqual(error, target / 3, "finer than asked for")

    # What is refused: once, whatever the number of ranks

    def refuse(self, arguments, *texts):
        self.assert_refused(self.solve(self.room, *arguments, ranks=3), *texts)

    def test_what_it_does_not_know(self):
        folder = str(self.work)
        for arguments, text in ((("--form-factor", "disc"), "--form-factor"), (("--closure",), "--closure"),
                                (("--warm-start", "x.ply"), "--warm-start"),
                                (("--visibility-only", "--checkpoint", folder), "--visibility-only"),
                                 (("--reuse-visibility", folder), "--reuse-visibility"),
                                (("--trace-every-pair",), "--trace-every-pair"),
                                (("--solver", "gauss-seidel"), "gauss-seidel")):
            with self.subTest(text):
                self.refuse([*HIERARCHICAL, *arguments], text, "--method matrix")

    def test_what_only_it_knows(self):
        for arguments in (("--block-error", 1e-4), ("--target-error", 0.1), ("--oracle", "power"), ("--memory", "1G")):
            with self.subTest(arguments[0]):
                self.refuse([*MATRIX, *INSIDE, *SMALL, *arguments], "--method hierarchical")
        self.refuse([*MATRIX, "--subdivision", "transport"], "--subdivision transport")

    def test_bad_values(self):
        self.refuse(["--target-error", 0.1, "--block-error", 1e-3], "give one of them")
        for value in ("0", "-0.1", "1.5", "nan", "a"):
            self.refuse(["--target-error", value], "--target-error")
        for value in ("0", "-1", "nan", "inf"):
            self.refuse([*HIERARCHICAL, "--block-error", value], "--block-error")
        for value in ("0", "-1M", "1T5", "much"):
            self.refuse([*HIERARCHICAL, "--memory", value], "--memory")
        self.refuse([*HIERARCHICAL, "--oracle", "delphi"], "--oracle")
        self.refuse(["--method", "magic"], "--method")
        self.refuse([*HIERARCHICAL, "--subdivision", "camera"], "--eye")
        self.refuse([*HIERARCHICAL, "--subdivision", "uniform"], "--max-edge")

    def test_a_scene_without_light(self):
        self.room_of(MTL.replace("Ke 1 1 1", "Ke 0 0 0"))
        self.refuse(["--target-error", 0.05], "nothing emits light")


if __name__ == "__main__":
    unittest.main()
