"""How far one result is off another: `fluxel compare`."""

import csv
import json
import math
import re
import struct
import unittest

from fluxel_job import MATRIX, SCENES, JobTest, solution_header, start
from result_files import radiosities

CORNELL = (SCENES / "cornell-box" / "cornell-box.toml", "--resolution", "16x16")

# A square of 1 m2 and a rectangle of 3 m2 beside it: corners by number, all in one plane.
VERTICES = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (4, 0, 0), (4, 1, 0)]
FACES = [(0, 1, 2, 3), (1, 4, 5, 2)]


def element_file(layers, vertices=VERTICES, faces=FACES):
    """The bytes of a file of elements with {name: a grey value or a triple for each face}."""
    header = ["ply", "format binary_little_endian 1.0", "comment Fluxel 0.0.0-of-a-test",
              "comment radiosity in W/m2 (or lm/m2, as the scene's emission), lengths in m",
              f"element vertex {len(vertices)}", *(f"property double {axis}" for axis in "xyz"),
              f"element face {len(faces)}", "property list uchar uint vertex_indices",
              *(f"property float {name}_{colour}" for name in layers for colour in "rgb"),
              "property uint patch", "end_header"]
    data = ("\n".join(header) + "\n").encode() + b"".join(struct.pack("<3d", *vertex) for vertex in vertices)
    for number, face in enumerate(faces):
        data += struct.pack(f"<B{len(face)}I", len(face), *face)
        for values in layers.values():
            value = values[number]
            data += struct.pack("<3f", *(value if isinstance(value, tuple) else (value,) * 3))
        data += struct.pack("<I", number)
    return data


class CompareTest(JobTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        # One solve for all that need one.
        maker = cls("test_a_solve_against_itself")
        maker.setUp()
        cls.addClassCleanup(maker.doCleanups)
        maker.assert_done(maker.solve(*CORNELL))
        cls.solution, cls.image = maker.out / "solution.ply", maker.out / "image.exr"

    def elements(self, name, layers, **geometry):
        file = self.work / name
        file.write_bytes(element_file(layers, **geometry))
        return file

    def compare(self, a, b, *options, **settings):
        return start(["compare", a, b, "--out", self.out, *options], **settings)

    def result(self):
        return json.loads((self.out / "compare.json").read_text())

    # What is measured

    def test_a_solve_against_itself(self):
        for file, kind in ((self.solution, "elements"), (self.image, "pixels")):
            with self.subTest(kind):
                self.assert_done(self.compare(file, file, "--fail-above", "0"))
                result = self.result()
                self.assertEqual((result["kind"], result["figure"]), (kind, 0))
                self.assertEqual(result["figure_is"], "sigma_relative")
                for colour in result["colours"].values():
                    self.assertGreater(colour["mean"], 0)
                    self.assertEqual(colour["mean"], colour["judged_mean"])
                    for name in ("sigma", "bias_relative", "deviation_relative", "largest_relative"):
                        self.assertEqual(colour[name], 0)
                    self.assertEqual("relmse" in colour, kind == "pixels")

    def test_by_hand(self):
        # Weights 1 and 3, B = 2 and 6, A = 4 and 5: as tests/unit/field_errors_test.cpp has it.
        a, b = self.elements("a.ply", {"radiosity": [4, 5]}), self.elements("b.ply", {"radiosity": [2, 6]})
        job = self.compare(a, b)
        self.assert_done(job)
        result = self.result()
        self.assertAlmostEqual(result["figure"], math.sqrt(7 / 4) / 5, delta=1e-12)
        self.assertEqual((result["elements"], result["sides"], result["area_m2"]), (2, 2, 4))
        for colour in result["colours"].values():
            for name, expected in {"mean": 5, "judged_mean": 4.75, "quadratic_mean": math.sqrt(28),
                                   "sigma": math.sqrt(7 / 4), "sigma_relative_quadratic": 0.25,
                                   "bias_relative": -0.05, "deviation_relative": math.sqrt(27) / 20,
                                   "percentile_99_relative": 0.4, "largest_relative": 0.4}.items():
                self.assertAlmostEqual(colour[name], expected, delta=1e-12, msg=name)
        self.assertIn("26.46 %", job.out)
        self.assertEqual(self.written(), ["compare.html", "compare.json", "error.ply", "histogram.csv"])

    def test_a_known_share_of_everything(self):
        for scale, failed in ((1.01, False), (1.5, True)):
            with self.subTest(scale=scale):
                data, faces = self.solution.read_bytes(), radiosities(self.solution)
                size = 4 * 3
                place = data.index(b"end_header\n") + len(b"end_header\n")
                vertices = next(int(line.split()[2]) for line in solution_header(self.solution)
                                if line.startswith("element vertex"))
                place += 24 * vertices
                scaled = bytearray(data)
                for face in faces:
                    place += 1 + 4 * data[place] + 3  # its corners and its colour
                    scaled[place:place + size] = struct.pack("<3f", *(scale * value for value in face))
                    place += size + 4
                self.assertEqual(place, len(data))
                (self.work / "scaled.ply").write_bytes(scaled)
                job = self.compare(self.work / "scaled.ply", self.solution, "--fail-above", "1")
                self.assert_done(job, 3 if failed else 0)
                for colour in self.result()["colours"].values():
                    self.assertAlmostEqual(colour["bias_relative"], scale - 1, delta=1e-6)
                    self.assertAlmostEqual(colour["sigma_relative_quadratic"], scale - 1, delta=1e-6)
                self.assertEqual(self.result()["figure"] > 1, failed)

    def test_noise_is_taken_out(self):
        # (A - Ha)(A - Hb) = 0.1 * 0.3 and 0; of the mean 1 with areas 1 and 3.
        noise = {"error": [0.1, 0.1], "half_a": [1.1, 0.8], "half_b": [0.9, 1.2]}
        b = self.elements("b.ply", {"radiosity": [1, 1], **noise})
        a = self.elements("a.ply", {"radiosity": [1.2, 1.2]})
        # Noise hides it: one standard error above, 16 %, is what is known.
        self.assert_done(self.compare(a, b, "--fail-above", "0.15"), 3)
        self.assert_done(self.compare(a, b, "--fail-above", "0.17"))
        result = self.result()
        self.assertEqual(result["figure_is"], "noise_free.sigma_relative")
        self.assertAlmostEqual(result["figure"], math.sqrt(0.03 / 4), delta=1e-6)
        for colour in result["colours"].values():
            self.assertAlmostEqual(colour["sigma_relative"], 0.2, delta=1e-6)
            free = colour["noise_free"]
            self.assertAlmostEqual(free["reference_noise_relative"], 0.1, delta=1e-6)
            self.assertAlmostEqual(free["bias_error_relative"], 0.1 * math.sqrt(10) / 4, delta=1e-6)
            self.assertEqual(free["judged_noise_relative"], 0)
            self.assertLess(free["sigma_low_relative"], result["figure"])
            self.assertGreater(free["sigma_high_relative"], result["figure"])

    def test_an_error_below_the_noise_is_0_and_said_to_be_hidden(self):
        noise = {"error": [0.1, 0.1], "half_a": [1.1, 1.1], "half_b": [0.9, 0.9]}
        b = self.elements("b.ply", {"radiosity": [1, 1], **noise})
        job = self.compare(b, self.elements("c.ply", {"radiosity": [1, 1]}))
        self.assert_done(job)
        self.assertEqual(self.result()["figure"], 0)
        self.assertTrue(self.result()["colours"]["green"]["noise_free"]["hidden"])
        self.assertEqual(len([note for note in self.result()["notes"] if "the noise hides" in note]), 3)
        self.assertIn("below 0, and reported as 0", job.out)

    def test_colours_and_sides_that_are_dark_in_both_are_left_out(self):
        dark = (0, 0, 0)
        a = self.elements("a.ply", {"radiosity": [(1, 0, 2), dark], "radiosity_back": [dark, (3, 0, 6)]})
        b = self.elements("b.ply", {"radiosity": [(1, 0, 2), dark], "radiosity_back": [dark, (2, 0, 4)]})
        self.assert_done(self.compare(a, b))
        result = self.result()
        self.assertEqual((result["sides"], result["area_m2"]), (2, 4))
        self.assertNotIn("green", result["colours"])
        self.assertEqual(result["colours"]["red"]["mean"], 1.75)
        self.assertAlmostEqual(result["colours"]["blue"]["sigma"], math.sqrt(3), delta=1e-12)
        self.assertIn("green", " ".join(result["notes"]))
        # The map shows the back, which is off by 1 and 2 where the means are 1.75 and 3.5.
        error = struct.unpack("<f", (self.out / "error.ply").read_bytes()[-8:-4])[0]
        self.assertAlmostEqual(error, 3 / 5.25, delta=1e-6)

    # What is written

    def test_the_map_of_elements(self):
        a, b = self.elements("a.ply", {"radiosity": [0.5, 1]}), self.elements("b.ply", {"radiosity": [1, 1]})
        self.assert_done(self.compare(a, b))
        self.assertEqual(self.result()["map_range"], 0.5)
        header = solution_header(self.out / "error.ply")
        self.assertIn("comment error over the mean, of all colours together: blue -0.5, white 0, red 0.5", header)
        self.assertEqual([line for line in header if line.startswith("property uchar")],
                         [f"property uchar {colour}" for colour in ("red", "green", "blue")])
        data = (self.out / "error.ply").read_bytes()
        below = struct.unpack("<3BfI", data[-2 * 28 + 17:-28])
        exact = struct.unpack("<3BfI", data[-11:])
        self.assertEqual(below, (5, 48, 97, -0.5, 0))
        self.assertEqual(exact, (247, 247, 247, 0, 1))

    def test_the_histogram_and_the_map_of_pixels(self):
        self.assert_done(self.compare(self.solution, self.solution))
        other = self.work / "other"
        job = start(["solve", *MATRIX, *CORNELL, "--form-factor", "point", "--out", other, "--quiet"])
        self.assert_done(job)
        self.assert_done(self.compare(other / "image.exr", self.image))
        self.assertEqual(self.written(), ["compare.html", "compare.json", "error.exr", "error.png", "histogram.csv"])
        rows = list(csv.reader((self.out / "histogram.csv").read_text().splitlines()))
        self.assertEqual(rows[0], ["from", "to", "share_r", "share_g", "share_b"])
        bins = [tuple(map(float, row)) for row in rows[1:]]
        self.assertEqual((bins[0][0], bins[-1][1]), (-math.inf, math.inf))
        self.assertAlmostEqual(bins[1][0], -self.result()["map_range"], delta=1e-9)
        for this, following in zip(bins, bins[1:]):
            self.assertEqual(this[1], following[0])
        for colour in (2, 3, 4):
            self.assertAlmostEqual(sum(row[colour] for row in bins), 1, delta=1e-4)
        self.assertEqual((self.out / "error.png").read_bytes()[1:4], b"PNG")
        # The map is a picture like others: off itself it is 0.
        map_of_error = (self.out / "error.exr").rename(self.work / "map.exr")
        self.assert_done(self.compare(map_of_error, map_of_error))

    def test_nothing_is_written_or_said_without_need(self):
        job = start(["compare", self.solution, self.solution, "--quiet"])
        self.assert_done(job)
        self.assertEqual((job.out, job.err, self.written()), ("", "", []))

    def test_the_same_bytes_for_every_number_of_ranks(self):
        a, b = self.elements("a.ply", {"radiosity": [4, 5]}), self.elements("b.ply", {"radiosity": [2, 6]})
        seen = set()
        for ranks in (1, 3):
            job = self.compare(a, b, ranks=ranks)
            self.assert_done(job)
            files = {name: (self.out / name).read_bytes() for name in self.written()}
            # The page repeats the command, and with it the ranks, and says when it was written.
            files["compare.html"] = re.sub(rb'mpirun -np 3 |"written":\d+', b"", files["compare.html"])
            seen.add((job.out, *files.values()))
        self.assertEqual(len(seen), 1)

    # What is refused: once, whatever the number of ranks

    def refuse(self, arguments, *texts, **place):
        self.assert_refused(start(["compare", *arguments], ranks=3), *texts, **place)

    def test_bad_usage(self):
        self.refuse([], "A is required")
        self.refuse([self.solution], "B is required")
        self.refuse([self.solution, self.solution, "--fail-above", "nan"], "--fail-above")
        self.refuse([self.solution, self.solution, "--out", self.solution], str(self.solution))

    def test_files_of_other_kinds(self):
        missing, text = self.work / "missing.ply", self.write("text.exr", "no picture")
        self.refuse([missing, self.solution], "no such file", file=missing)
        self.refuse([self.image, text], "no OpenEXR", file=text)
        self.refuse([self.solution, self.image], "no .ply file", file=self.image)
        png = self.image.with_suffix(".png")
        self.refuse([png, png], "neither .ply nor .exr", file=png)

    def test_a_file_that_is_cut_off(self):
        for file in (self.solution, self.image):
            cut = self.work / f"cut{file.suffix}"
            cut.write_bytes(file.read_bytes()[:-100])
            self.refuse([cut, file], file=cut)

    def test_other_elements(self):
        b = self.elements("b.ply", {"radiosity": [2, 6]})
        self.refuse([self.solution, b], "instead of 2", f"fluxel reference SCENE --elements {self.solution}",
                    file=self.solution)
        moved = [(x, y, 1e-5 if number == 4 else 0) for number, (x, y, _) in enumerate(VERTICES)]
        a = self.elements("a.ply", {"radiosity": [2, 6]}, vertices=moved)
        self.refuse([a, b], "number 1 lies elsewhere", file=a)
        rounded = [(x, y, 1e-6 if number == 4 else 0) for number, (x, y, _) in enumerate(VERTICES)]
        self.assert_done(self.compare(self.elements("a.ply", {"radiosity": [2, 6]}, vertices=rounded), b))

    def test_other_sides_layers_and_pixels(self):
        front = self.elements("front.ply", {"radiosity": [1, 1]})
        both = self.elements("both.ply", {"radiosity": [1, 1], "radiosity_back": [1, 1]})
        self.refuse([both, front], "--sides")
        half = self.elements("half.ply", {"radiosity": [1, 1], "error": [1, 1]})
        self.refuse([front, half], "half_a", file=half)
        other = self.elements("other.ply", {"irradiance": [1, 1]})
        self.refuse([front, other], "holds no radiosity", file=other)
        dark = self.elements("dark.ply", {"radiosity": [0, 0]})
        self.refuse([dark, dark], "dark everywhere")
        small = self.work / "small"
        self.assert_done(start(["solve", *MATRIX, CORNELL[0], "--resolution", "8x8", "--out", small]))
        self.refuse([small / "image.exr", self.image], "8x8 pixels", "--resolution", file=small / "image.exr")


if __name__ == "__main__":
    unittest.main()
