"""View factors between groups, as a table: `fluxel viewfactors`."""

import csv
import os
import re
import unittest
import zipfile

import numpy as np

from fluxel_job import JobTest, start

HEADER = "from,from_side,to,to_side,area_from_m2,view_factor,error_estimate"

# Of two opposed unit squares 1 m apart: Howell's catalogue, C-11.
OPPOSED = 0.199824895698387

BELOW = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]  # faces up
ABOVE = [(0, 0, 1), (0, 1, 1), (1, 1, 1), (1, 0, 1)]  # faces down
HALF_WAY = [(-1, -1, 0.5), (0.5, -1, 0.5), (0.5, 2, 0.5), (-1, 2, 0.5)]  # hides one half


def obj(groups):
    """An OBJ text of {name: polygons}."""
    lines, count = [], 0
    for name, polygons in groups.items():
        lines.append(f"g {name}")
        for polygon in polygons:
            lines += ["v {:.17g} {:.17g} {:.17g}".format(*corner) for corner in polygon]
            lines.append("f " + " ".join(str(count + k) for k in range(1, len(polygon) + 1)))
            count += len(polygon)
    return "\n".join(lines) + "\n"


def cube(side, squares, outward):
    """The faces of a cube about the origin, each squares x squares."""
    step, polygons = side / squares, []
    for axis in range(3):
        for sign in (-1, 1):
            for i in range(squares):
                for j in range(squares):
                    polygon = []
                    for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        corner = [0.0, 0.0, 0.0]
                        corner[axis] = sign * side / 2
                        corner[(axis + 1) % 3] = a * step - side / 2
                        corner[(axis + 2) % 3] = b * step - side / 2
                        polygon.append(corner)
                    # Counter-clockwise about the axis, so outward at +1.
                    polygons.append(polygon if (sign > 0) == outward else polygon[::-1])
    return polygons


class ViewFactorsTest(JobTest):
    def setUp(self):
        super().setUp()
        self.table = self.out / "view-factors.csv"
        self.squares = self.write("squares.obj", obj({"below": [BELOW], "above": [ABOVE]}))

    def compute(self, scene, *arguments, **settings):
        return start(["viewfactors", scene, "--out", self.out, *arguments], **settings)

    def factors(self):
        """{(from, to): (area, factor, error)} of the table, of a back NAME-back."""
        with self.table.open(newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        self.assertEqual(",".join(rows[0]), HEADER)
        for row in rows[1:]:
            self.assertEqual(len(row), 7, row)
            self.assertLessEqual({row[1], row[3]}, {"front", "back"})

        def name(group, side):
            return group if side == "front" else f"{group}-back"

        found = {(name(*row[:2]), name(*row[2:4])): tuple(map(float, row[4:])) for row in rows[1:]}
        self.assertEqual(len(found), len(rows) - 1, "each pair once")
        return found

    def row_sums(self, job):
        """(least, mean, largest), as printed."""
        found = re.search(r"^row sums: least (\S+), mean (\S+), largest (\S+) ", job.out, re.MULTILINE)
        self.assertIsNotNone(found, str(job))
        return tuple(map(float, found.groups()))

    # The table

    def test_two_squares(self):
        job = self.compute(self.squares)
        self.assert_done(job)
        self.assertEqual(self.table.read_text().splitlines()[0], HEADER)
        factors = self.factors()
        self.assertEqual(set(factors), {("below", "above"), ("above", "below")})
        for area, factor, error in factors.values():
            self.assertEqual(area, 1)
            self.assertAlmostEqual(factor, OPPOSED, delta=error)
            self.assertLess(error, 1e-3 * OPPOSED)
        for row_sum in self.row_sums(job):
            self.assertAlmostEqual(row_sum, OPPOSED, delta=1e-3 * OPPOSED)
        self.assertEqual(self.written(), ["view-factors.csv", "view-factors.html"])
        self.assertIn("sides of groups that see nothing, and have no row: 2", job.out)

    def test_a_tolerance_of_its_own(self):
        self.assert_done(self.compute(self.squares, "--tolerance", "1e-7"))
        for _, factor, error in self.factors().values():
            self.assertAlmostEqual(factor, OPPOSED, delta=1e-11)
            self.assertLess(error, 1e-7)

    def test_half_hidden(self):
        scene = self.write("half.obj", obj({"below": [BELOW], "above": [ABOVE], "plate": [HALF_WAY]}))
        self.assert_done(self.compute(scene, "--tolerance", "1e-5"))
        factors = self.factors()
        _, factor, error = factors["below", "above"]
        self.assertAlmostEqual(factor, OPPOSED / 2, delta=4 * error)
        self.assertLess(error, 1e-3 * OPPOSED)
        self.assertEqual(factor, factors["above", "below"][1])
        self.assertNotIn(("below", "plate"), factors, "the plate's front looks up")
        self.assertIn(("below", "plate-back"), factors)
        self.assertIn(("above", "plate"), factors)
        self.assert_done(self.compute(scene, "--tolerance", "1e-5", "--sides", "one"))
        fronts = self.factors()
        self.assertEqual(set(fronts), {pair for pair in factors if "plate-back" not in pair})
        for pair, (_, factor, error) in fronts.items():
            self.assertAlmostEqual(factor, factors[pair][1], delta=4 * (error + factors[pair][2]))

    def test_names_with_commas_and_quotes(self):
        names = ["low, \"the floor\"", "up: 100%"]
        self.assert_done(self.compute(self.write("names.obj", obj({names[0]: [BELOW], names[1]: [ABOVE]}))))
        self.assertEqual(set(self.factors()), {tuple(names), tuple(names[::-1])})
        self.assertIn('"low, ""the floor""",front,up: 100%,front,1,', self.table.read_text())

    def test_both_sides(self):
        stack = [[(x, y, z) for x, y, _ in BELOW] for z in (0, 1, 2)]
        scene = self.write("stack.obj", obj({name: [plate] for name, plate in zip("abc", stack)}))
        self.assert_done(self.compute(scene, "--sides", "one"))
        self.assertEqual(self.table.read_text(), HEADER + "\n", "all look up, at a back")
        self.assert_done(self.compute(scene))
        factors = self.factors()
        self.assertEqual(set(factors), {("a", "b-back"), ("b-back", "a"), ("b", "c-back"), ("c-back", "b")})
        for area, factor, error in factors.values():
            self.assertEqual(area, 1)
            self.assertAlmostEqual(factor, OPPOSED, delta=error)

    def test_the_inside_of_a_dark_room(self):
        """Nothing emits, nobody looks: both sides of its walls are there all the same."""
        scene = self.write("room.obj", obj({"room": cube(1, 1, False), "body": cube(0.3, 1, True)}))
        job = self.compute(scene)
        self.assert_done(job)
        factors = self.factors()
        self.assertEqual(set(factors), {("room", "room"), ("room", "body"), ("body", "room"), ("body-back", "body-back")})
        self.assertAlmostEqual(factors["body-back", "body-back"][1], 1, delta=1e-3)
        for row_sum in self.row_sums(job):
            self.assertAlmostEqual(row_sum, 1, delta=1e-3)
        self.assertIn("sides of groups that see nothing, and have no row: 1", job.out)

    def test_quiet(self):
        job = self.compute(self.squares, "--quiet")
        self.assert_done(job)
        self.assertEqual((job.out, job.err), ("", ""))
        self.assertTrue(self.factors())

    def test_the_same_bytes_for_every_number_of_ranks(self):
        groups = {"inner": cube(1, 4, True), "outer": cube(3, 4, False)}
        scene, tables = self.write("cubes.obj", obj(groups)), set()
        for ranks in (1, 2, 3):
            job = self.compute(scene, "--threads", "1", ranks=ranks)
            self.assert_done(job)
            tables.add(self.table.read_bytes())
        self.assertEqual(len(tables), 1)
        factors = self.factors()
        self.assertEqual(set(factors), {("inner", "outer"), ("outer", "inner"), ("outer", "outer"),
                                        ("inner-back", "inner-back")})
        self.assertAlmostEqual(factors["outer", "inner"][0], 54, delta=1e-9)
        self.assertAlmostEqual(factors["outer", "inner"][1], 1 / 9, delta=1e-3 / 9)
        self.assertAlmostEqual(factors["inner", "outer"][1], 1, delta=1e-3)
        self.assertAlmostEqual(factors["outer", "outer"][1], 8 / 9, delta=1e-3)
        for row_sum in self.row_sums(job):
            self.assertAlmostEqual(row_sum, 1, delta=1e-3)
        defect = re.search(r"^reciprocity defect: ([^;]+);", job.out, re.MULTILINE)
        self.assertLess(float(defect[1]), 1e-12)

    # Files of faces

    def matrix(self):
        """(number of faces, {(i, j): factor}) of the Matrix Market file, counted from 0, and its comments."""
        comments, entries = [], {}
        with (self.out / "view-factors.mtx").open(encoding="utf-8") as file:
            self.assertEqual(file.readline(), "%%MatrixMarket matrix coordinate real general\n")
            for line in file:
                if line.startswith("%"):
                    comments.append(line)
                    continue
                rows, columns, count = map(int, line.split())
                break
            for line in file:
                i, j, factor = line.split()
                entries[int(i) - 1, int(j) - 1] = float(factor)
        self.assertEqual((rows, count), (columns, len(entries)))
        self.assertIn("% The rows of faces.csv are these faces in this order, with their areas in m2.\n", comments)
        return rows, entries

    def faces(self):
        with (self.out / "faces.csv").open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([int(row["face"]) for row in rows], list(range(1, len(rows) + 1)))
        return rows

    def test_faces_as_a_matrix(self):
        scene = self.write("cubes.obj", obj({"inner": cube(1, 2, True), "outer": cube(3, 3, False)}))
        job = self.compute(scene, "--keep-polygons", "--write", "mtx,npy,faces-csv", "--sides", "one")
        self.assert_done(job)
        self.assertEqual(self.written(), ["face-view-factors.csv", "faces.csv", "view-factors.csv", "view-factors.html", "view-factors.mtx",
                                          "view-factors.npy"])
        count, entries = self.matrix()
        faces = self.faces()
        self.assertEqual(count, 24 + 54)
        self.assertEqual(len(faces), count)
        self.assertEqual([(row["patch"], row["side"]) for row in faces], [(str(k), "front") for k in range(count)])
        self.assertEqual([row["group"] for row in faces], 24 * ["inner"] + 54 * ["outer"])
        areas = [float(row["area_m2"]) for row in faces]
        for area, row in zip(areas, faces):
            self.assertAlmostEqual(area, 0.25 if row["group"] == "inner" else 1, delta=1e-12)
        for i in range(count):
            self.assertAlmostEqual(sum(entries.get((i, j), 0) for j in range(count)), 1, delta=2e-3)
        for (i, j), factor in entries.items():
            self.assertNotEqual(i, j)
            self.assertAlmostEqual(areas[i] * factor, areas[j] * entries[j, i], delta=1e-9)
        # Groups have the sums.
        of_groups = self.factors()
        for (one, other), (area, factor, _) in of_groups.items():
            inside = lambda k, name: faces[k]["group"] == name
            total = sum(areas[i] * f for (i, j), f in entries.items() if inside(i, one) and inside(j, other))
            self.assertAlmostEqual(total, area * factor, delta=1e-8 * total)
        with (self.out / "face-view-factors.csv").open(newline="", encoding="utf-8") as file:
            table = {(int(row["from"]) - 1, int(row["to"]) - 1): float(row["view_factor"]) for row in csv.DictReader(file)}
        self.assertEqual(table, entries)
        records = np.load(self.out / "view-factors.npy")
        self.assertEqual(records.dtype.names, ("from", "to", "view_factor", "error_estimate"))
        self.assertEqual({(int(row["from"]) - 1, int(row["to"]) - 1): float(f"{row['view_factor']:.10g}") for row in records}, entries)

    def test_fronts_and_backs_are_faces(self):
        stack = [[(x, y, z) for x, y, _ in BELOW] for z in (0, 1)]
        scene = self.write("stack.obj", obj({name: [plate] for name, plate in zip("ab", stack)}))
        self.assert_done(self.compute(scene, "--write", "mtx"))
        count, entries = self.matrix()
        self.assertEqual([(row["patch"], row["side"], row["group"]) for row in self.faces()],
                         [("0", "front", "a"), ("0", "back", "a"), ("1", "front", "b"), ("1", "back", "b")])
        self.assertEqual(set(entries), {(0, 3), (3, 0)})
        self.assertAlmostEqual(entries[0, 3], OPPOSED, delta=1e-3 * OPPOSED)

    def test_faces_are_the_same_bytes_for_every_number_of_ranks(self):
        scene, files = self.write("cubes.obj", obj({"in": cube(1, 2, True), "out": cube(3, 3, False)})), set()
        for ranks in (1, 2, 3):
            self.assert_done(self.compute(scene, "--keep-polygons", "--write", "mtx,npy", "--threads", "1", ranks=ranks))
            files.add(tuple((self.out / name).read_bytes() for name in self.written() if not name.endswith(".html")))
        self.assertEqual(len(files), 1)

    def test_files_of_faces_go_where_none_are_asked_for(self):
        self.assert_done(self.compute(self.squares, "--write", "faces-csv"))
        self.assertEqual(self.written(), ["face-view-factors.csv", "faces.csv", "view-factors.csv", "view-factors.html"])
        self.assert_done(self.compute(self.squares))
        self.assertEqual(self.written(), ["view-factors.csv", "view-factors.html"])

    # The matrix of groups

    def sparse(self):
        """Of view-factors.npz: {(row, column): (factor, error)}, areas; surfaces.csv beside it."""
        self.assertIsNone(zipfile.ZipFile(self.out / "view-factors.npz").testzip())
        with np.load(self.out / "view-factors.npz") as arrays:
            found = {name: arrays[name] for name in arrays.files}
        self.assertEqual(found["format"].item(), b"csr")
        rows = len(found["area_m2"])
        self.assertEqual(found["shape"].tolist(), [rows, rows])
        self.assertEqual({name: str(found[name].dtype) for name in ("data", "indices", "indptr", "error_estimate")},
                         {"data": "float64", "indices": "int32", "indptr": "int32", "error_estimate": "float32"})
        of_row = np.repeat(np.arange(rows), np.diff(found["indptr"]))
        self.assertEqual(len(of_row), len(found["data"]))
        for row in range(rows):
            self.assertTrue((np.diff(found["indices"][of_row == row]) > 0).all(), "columns ascend")
        with (self.out / "surfaces.csv").open(newline="", encoding="utf-8") as file:
            surfaces = list(csv.DictReader(file))
        self.assertEqual([int(surface["row"]) for surface in surfaces], list(range(rows)))
        for surface, area in zip(surfaces, found["area_m2"]):
            self.assertAlmostEqual(float(surface["area_m2"]), area, delta=1e-11)
        return {(i, j): (f, e) for i, j, f, e in zip(of_row.tolist(), found["indices"].tolist(), found["data"], found["error_estimate"])}, surfaces

    def test_groups_as_a_matrix(self):
        """The same factors as in the table, whoever has them."""
        scene = self.write("cubes.obj", obj({"inner": cube(1, 2, True), "outer, \"the room\"": cube(3, 2, False)}))
        self.assert_done(self.compute(scene, "--write", "npz,csv"))
        self.assertEqual(self.written(), ["surfaces.csv", "view-factors.csv", "view-factors.html", "view-factors.npz"])
        entries, surfaces = self.sparse()
        self.assertEqual([(row["group"], row["side"]) for row in surfaces],
                         [(group, side) for group in ("inner", "outer, \"the room\"") for side in ("front", "back")])
        name = [row["group"] + ("" if row["side"] == "front" else "-back") for row in surfaces]
        table = self.factors()
        self.assertEqual({(name[i], name[j]) for i, j in entries}, set(table))
        for (i, j), (factor, error) in entries.items():
            _, of_table, error_of_table = table[name[i], name[j]]
            self.assertAlmostEqual(factor, of_table, delta=1e-11 * factor)
            self.assertAlmostEqual(error, error_of_table, delta=0.06 * error)

    def test_many_groups_are_a_matrix_unless_a_table_is_asked_for(self):
        faces = cube(1, 10, False)
        many = self.write("many.obj", obj({f"s{k}": [face] for k, face in enumerate(faces)}))
        self.assert_done(self.compute(many, "--sides", "one"))
        self.assertEqual(self.written(), ["surfaces.csv", "view-factors.html", "view-factors.npz"])
        entries, surfaces = self.sparse()
        self.assertEqual([row["group"] for row in surfaces], [f"s{k}" for k in range(600)])
        self.assertEqual(len(entries), 600 * 500, "squares of a wall do not see each other")
        sums = np.zeros(600)
        for (i, j), (factor, _) in entries.items():
            sums[i] += factor
            self.assertAlmostEqual(factor, entries[j, i][0], delta=1e-14)
        np.testing.assert_allclose(sums, 1, atol=1e-4)
        # Files of an earlier run go.
        self.assert_done(self.compute(many, "--sides", "one", "--write", "csv"))
        self.assertEqual(self.written(), ["view-factors.csv", "view-factors.html"])
        self.assertEqual(len(self.factors()), len(entries))
        self.assert_done(self.compute(many, "--sides", "one"))
        self.assertEqual(self.written(), ["surfaces.csv", "view-factors.html", "view-factors.npz"])

    def test_a_matrix_is_the_same_bytes_for_every_number_of_ranks(self):
        """Some of the squares are partly hidden from each other."""
        groups = {f"{name}{k}": [face] for name, squares in (("in", cube(1, 4, True)), ("out", cube(3, 4, False)))
                  for k, face in enumerate(squares)}
        scene, files = self.write("cubes.obj", obj(groups)), set()
        for ranks, threads in ((1, 1), (1, 3), (2, 1), (3, 2)):
            self.assert_done(self.compute(scene, "--sides", "one", "--write", "npz", "--threads", threads, ranks=ranks))
            files.add((self.out / "view-factors.npz").read_bytes())
        self.assertEqual(len(files), 1)

    # What is refused: once, whatever the number of ranks

    def refuse(self, arguments, *texts, **place):
        self.assert_refused(start(["viewfactors", *arguments], ranks=3), *texts, **place)

    def test_no_scene_and_no_table(self):
        self.refuse([], "scene is required")
        self.refuse([self.squares, "--out"], "--out")
        self.refuse([self.squares, "--out", ""], "--out")

    def test_bad_values(self):
        for option, values in {
                "--tolerance": ("0", "-1", "1e-12", "9e-8", "nan", "inf", "fine"),
                "--sides": ("three",),
                "--threads": ("0",),
                "--write": ("matrix", "", "mtx,vtu"),
        }.items():
            for value in values:
                with self.subTest(option, value=value):
                    self.refuse([self.squares, "--out", self.out, f"{option}={value}"], option)

    def test_options_of_a_solution(self):
        self.refuse([self.squares, "--out", self.out, "--max-edge", "1"], "--max-edge")

    def test_scenes_that_are_not_there_or_empty(self):
        missing, empty = self.work / "missing.obj", self.write("empty.obj", "v 0 0 0\n")
        self.refuse([missing, "--out", self.out], file=missing)
        self.refuse([empty, "--out", self.out], "holds no face", file=empty)

    def test_a_table_as_folder(self):
        self.refuse([self.squares, "--out", self.work / "factors.csv"], "factors.csv", "folder", "view-factors.csv")
        self.assertFalse((self.work / "factors.csv").exists())

    def test_a_folder_that_cannot_be_used(self):
        self.refuse([self.squares, "--out", self.squares], str(self.squares))
        unwritable = "/proc/self" if os.geteuid() == 0 else "/usr"
        self.refuse([self.squares, "--out", unwritable], "cannot be")

    def test_a_new_folder_is_made_with_its_parents(self):
        self.out = self.out / "a" / "b c"
        self.table = self.out / "view-factors.csv"
        self.assert_done(self.compute(self.squares))
        self.assertEqual(len(self.factors()), 2)

    def test_out_is_the_folder_that_solve_writes_to(self):
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.work)
        self.assert_done(start(["viewfactors", self.squares]))
        self.assertEqual(sorted(file.name for file in (self.work / "out").iterdir()), ["view-factors.csv", "view-factors.html"])

    def test_a_failed_run_leaves_the_last_table_alone(self):
        self.assert_done(self.compute(self.squares))
        before = self.table.read_bytes()
        self.assertEqual(self.compute(self.squares, "--tolerance", "0").code, 2)
        self.assertEqual(self.compute(self.write("empty.obj", "v 0 0 0\n")).code, 2)
        self.assertEqual(self.table.read_bytes(), before)


if __name__ == "__main__":
    unittest.main()
