"""The package in python/: arrays against what is known otherwise, runs, errors, the examples of docs/python.md."""

import os
import re
import shutil
import struct
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np

from fluxel_job import SCENES, JobTest

import fluxel
from fluxel.command import find_executable, option_words

ROOT = SCENES.parent
CORNELL = SCENES / "cornell-box" / "cornell-box.toml"
DESK = '[[receivers]]\nname = "desk"\norigin = [0.1, 0.1, 0.2]\nu = [0.4, 0, 0]\nv = [0, 0.3, 0]\ncells = [4, 2]\n'


def close(a, b, relative):
    return np.allclose(a, b, rtol=relative, atol=relative * np.abs(b).max())


class ArraysTest(unittest.TestCase):
    """One solve by two ranks, whose pixels show the elements as they were solved."""

    @classmethod
    def setUpClass(cls):
        cls.work = Path(tempfile.mkdtemp(prefix="fluxel-"))
        cls.addClassCleanup(shutil.rmtree, cls.work, ignore_errors=True)
        cls.scene = cls.work / "box.toml"
        cls.scene.write_text(CORNELL.read_text().replace('file = "', f'file = "{CORNELL.parent}/') + "\n" + DESK)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", fluxel.NotReachedWarning)  # elements are too coarse to be pixels
            cls.solution = fluxel.solve(cls.scene, ranks=2, threads=1, out=cls.work / "out", target_error=0.05, picture="elements",
                                        supersample=1, resolution=(24, 16), write=["vtu", "ply-triangles", "lightmap"], lightmap_texel=0.02)

    def test_elements(self):
        elements, report = self.solution.elements, self.solution.report
        self.assertEqual(len(elements), report["elements"])
        self.assertTrue(close(elements.areas @ elements.radiosity, report["leaving"], 1e-6))
        self.assertIsNone(elements.radiosity_back)
        self.assertEqual(elements.patch.max() + 1, report["patches"])
        triangles = elements.faces[:, 3] < 0
        self.assertTrue(np.array_equal(triangles, np.isnan(elements.corners).any(axis=(1, 2))))
        self.assertTrue(np.allclose(elements.centres[triangles], elements.vertices[elements.faces[triangles, :3]].mean(axis=1)))
        # Seen from the front its corners run counterclockwise, and the front of the floor is up.
        floor = elements.centres[:, 1] < 1e-6
        self.assertTrue(floor.any())
        self.assertTrue(np.allclose(elements.normals[floor], (0, 1, 0), atol=1e-6))

    def test_light_map(self):
        light_map, elements = self.solution.light_map, self.solution.elements
        sides = light_map.corners[:, 1] - light_map.corners[:, 0], light_map.corners[:, 2] - light_map.corners[:, 0]
        self.assertAlmostEqual(np.linalg.norm(np.cross(*sides), axis=1).sum() / 2 / elements.areas.sum(), 1, delta=1e-5)
        self.assertTrue(np.allclose(light_map.corners.min(axis=(0, 1)), elements.vertices.min(axis=0), atol=1e-6))
        self.assertTrue(np.allclose(light_map.corners.max(axis=(0, 1)), elements.vertices.max(axis=0), atol=1e-6))
        middles = light_map.places.mean(axis=1)
        lamp = light_map.groups == "light"
        self.assertTrue((light_map.light(middles[lamp])[:, 0] > 16.9).all(), "17 W/(m2 sr) and what it reflects")
        self.assertTrue((light_map.light(middles[~lamp])[:, 0] < 16).all())

    def test_triangles(self):
        elements = self.solution.elements
        cut = fluxel.read_elements(self.solution.out / "solution-triangles.ply")
        self.assertEqual(cut.faces.shape[1], 3)
        self.assertTrue(close(cut.areas @ cut.radiosity, self.solution.report["leaving"], 1e-6))
        corners, numbers = elements.triangles()
        self.assertTrue(np.array_equal(elements.vertices[corners], cut.corners))
        self.assertTrue(np.array_equal(elements.radiosity[numbers], cut.radiosity))

    def test_grid(self):
        grid, elements, energy = self.solution.grid, self.solution.elements, self.solution.report["energy"]
        self.assertTrue(np.array_equal(grid["radiosity"], elements.radiosity))
        self.assertTrue(np.array_equal(grid["patch"], elements.patch))
        self.assertTrue(np.array_equal(grid.corners, elements.corners, equal_nan=True))
        self.assertTrue(close(grid.areas @ grid["exitance"], energy["emitted"], 1e-6))
        self.assertTrue(close(grid.areas @ ((1 - grid["reflectance"]) * grid["irradiance"]), energy["absorbed"], 1e-5))
        self.assertEqual(grid.field_data["stated_error"], self.solution.stated_error)
        self.assertEqual(grid.groups[:3], ["floor", "ceiling", "back_wall"])
        self.assertTrue(grid["exitance"][grid.of_group("light")].min() > 0)
        self.assertEqual(grid["exitance"][~grid.of_group("light")].max(), 0)
        self.assertEqual([grid.materials[k] for k in np.unique(grid["material"][grid.of_group("left_wall")])], ["red"])

    def test_picture(self):
        picture, elements = self.solution.picture, self.solution.elements
        self.assertEqual(picture.shape, (16, 24))
        png = (self.solution.out / "image.png").read_bytes()
        self.assertEqual(struct.unpack(">2I", png[16:24]), (24, 16))
        seen = picture["element"] < len(elements)
        self.assertGreater(seen.mean(), 0.6)
        radiance = elements.radiosity[picture["element"][seen]] / np.pi
        self.assertTrue(close(picture.values[seen], radiance, 1e-6))
        self.assertTrue(close(picture["normal"][seen], elements.normals[picture["element"][seen]], 1e-5))
        # The red wall, x = 0.55, is on the left of the top row's middle.
        row = picture["reflectance"][8]
        self.assertGreater(row[np.flatnonzero(seen[8])[0], 0], 3 * row[np.flatnonzero(seen[8])[0], 1])
        self.assertEqual(picture.attributes["fluxel.units"], "radiometric")

    def test_receivers(self):
        desk = self.solution.receivers["desk"]
        self.assertEqual((desk.shape, desk.quantity), ((2, 4), "irradiance"))
        for row in range(2):
            for column in range(4):
                self.assertTrue(np.allclose(desk.centres[row, column], (0.15 + 0.1 * column, 0.325 - 0.15 * row, 0.2)))
        shown = fluxel.read_picture(self.solution.out / "receiver-desk.exr")
        self.assertTrue(np.allclose(desk.values, shown.values, rtol=1e-6))
        self.assertTrue(np.allclose(desk.error, shown.error, rtol=1e-2))
        self.assertTrue(close(desk.values.mean(axis=(0, 1)), self.solution.report["receivers"]["desk"]["mean_rgb"], 1e-5))

    def test_photons(self):
        found = fluxel.photons(self.scene, elements=self.solution.out / "solution.ply", photons=2e5, sequence="scrambled")
        self.assertTrue(found.reached)
        self.assertEqual(found.report["photons"]["sent"], 200000)
        layers = found.elements.layers
        self.assertEqual(layers["irradiance"].shape, layers["radiosity"].shape)
        self.assertGreater(float(layers["irradiance_error"].max()), 0)

    def test_reference(self):
        truth = fluxel.reference(self.scene, elements=self.solution.out / "solution.ply", rays=3e5, resolution=(8, 6))
        measured = truth.report["measured"]
        self.assertTrue(truth.reached)
        self.assertEqual(truth.picture.shape, (6, 8))
        of_picture = truth.picture.error.astype(float) ** 2
        self.assertTrue(close(np.sqrt(of_picture.mean(axis=(0, 1))) / truth.picture.values.mean(axis=(0, 1)),
                              measured["picture"]["relative_error_rgb"], 1e-4))
        elements = truth.elements
        self.assertTrue(np.array_equal(elements.corners, self.solution.elements.corners, equal_nan=True))
        self.assertTrue(close(elements.areas @ elements.radiosity / elements.areas.sum(), measured["elements"]["mean_rgb"], 1e-5))
        halves = (elements.layers["half_a"] + elements.layers["half_b"]) / 2
        self.assertTrue(close(halves, elements.radiosity, 1e-5))
        self.assertEqual(truth.receivers["desk"].shape, (2, 4))

    def test_view_and_comparison(self):
        seen = fluxel.view(self.scene, self.solution, resolution=(12, 8), target_error=0.1, audit=0)
        self.assertEqual(seen.picture.shape, (8, 12))
        off = fluxel.compare(self.solution.out / "image.exr", self.solution.out / "image.exr")
        self.assertEqual(off.report["figure"], 0)

    def test_files_that_are_torn(self):
        torn = self.solution.out / "torn"
        for name, read in (("solution.ply", fluxel.read_elements), ("solution.vtu", fluxel.read_grid), ("image.exr", fluxel.read_picture),
                           ("report.json", fluxel.read_report), ("receivers.csv", fluxel.read_receivers), ("lightmap.glb", fluxel.GlbFile)):
            data = (self.solution.out / name).read_bytes()
            for cut in (0, 3, 100, len(data) // 4, len(data) // 2, len(data) - 20):
                torn.write_bytes(data[:cut])
                with self.subTest(name, cut=cut), self.assertRaises(fluxel.FormatError) as caught:
                    read(torn)
                self.assertTrue(str(caught.exception).startswith(f"{torn}: "), caught.exception)
        data = (self.solution.out / "solution.ply").read_bytes()
        for name, damaged, what in (("more", data + b"\0", "1 bytes follow"), ("big endian", data.replace(b"little", b"big"), "kind")):
            torn.write_bytes(damaged)
            with self.subTest(name), self.assertRaisesRegex(fluxel.FormatError, what):
                fluxel.read_elements(torn)
        data = bytearray((self.solution.out / "solution.vtu").read_bytes())
        data[data.index(b"\n_") + 2 + 40] ^= 255
        torn.write_bytes(data)
        with self.assertRaisesRegex(fluxel.FormatError, "damaged"):
            fluxel.read_grid(torn)

    def test_by_other_readers(self):
        elements, grid = self.solution.elements, self.solution.grid
        for name in ("meshio", "trimesh", "OpenEXR"):
            with self.subTest(name):
                try:
                    module = __import__(name)
                except ImportError:
                    self.skipTest(f"there is no {name}")
                if name == "meshio":
                    mesh = module.read(self.solution.out / "solution.vtu")
                    self.assertTrue(np.array_equal(mesh.points, grid.vertices))
                    values = np.concatenate(mesh.cell_data["irradiance"])
                    self.assertTrue(np.array_equal(np.sort(values, axis=0), np.sort(grid["irradiance"], axis=0)))
                elif name == "trimesh":
                    mesh = module.load(self.solution.out / "solution-triangles.ply", process=False)
                    self.assertAlmostEqual(mesh.area / elements.areas.sum(), 1, places=6)
                else:
                    channels = module.File(str(self.solution.out / "image.exr"), separate_channels=True).channels()
                    for channel, values in self.solution.picture.channels.items():
                        self.assertTrue(np.array_equal(channels[channel].pixels, values, equal_nan=True))


class PixelsTest(JobTest):
    def test_half_and_whole_numbers_without_compression(self):
        attribute = lambda name, kind, value: f"{name}\0{kind}\0".encode() + struct.pack("<i", len(value)) + value
        channel = lambda name, kind: name.encode() + b"\0" + struct.pack("<4i", kind, 0, 1, 1)
        head = struct.pack("<2I", 20000630, 2) + attribute("channels", "chlist", channel("G", 1) + channel("id", 0) + b"\0") + \
            attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", struct.pack("<4i", 2, 5, 4, 6)) + b"\0"
        rows = [struct.pack("<3e", *values) + struct.pack("<3I", *ids) for values, ids in
                (((0.5, -2, 65504), (1, 2, 3)), ((0, 1, 2), (4, 5, 2**32 - 1)))]
        blocks = [struct.pack("<2i", 5 + k, len(row)) + row for k, row in enumerate(rows)]
        start = len(head) + 16
        file = self.work / "half.exr"
        # The last row stands first.
        file.write_bytes(head + struct.pack("<2Q", start + len(blocks[1]), start) + blocks[1] + blocks[0])
        picture = fluxel.read_picture(file)
        self.assertEqual(picture.channels["G"].tolist(), [[0.5, -2, 65504], [0, 1, 2]])
        self.assertEqual(picture.channels["id"].tolist(), [[1, 2, 3], [4, 5, 2**32 - 1]])
        file.write_bytes(file.read_bytes().replace(b"compression\0compression\0\1\0\0\0\0", b"compression\0compression\0\1\0\0\0\4"))
        with self.assertRaisesRegex(fluxel.FormatError, "PIZ"):
            fluxel.read_picture(file)


class TablesTest(JobTest):
    def test_heat(self):
        chamber = fluxel.solve(SCENES / "heating-chamber" / "heating-chamber.toml", target_error=0.1, audit=0, write="vtu")
        table, rows = chamber.thermal, chamber.report["thermal"]
        self.assertEqual(table["group"].tolist(), [row["group"] for row in rows])
        for name in ("area_m2", "net_W", "temperature_K"):
            self.assertTrue(np.allclose(table[name], [row[name.lower()] for row in rows], rtol=1e-8))
        grid = chamber.grid
        net = sum(grid.areas @ flux for name, flux in grid.cell_data.items() if name.startswith("net_flux"))
        self.assertTrue(np.isclose(net, table["net_W"].sum(), rtol=1e-3, atol=1e-4 * np.abs(table["net_W"]).sum()))

    def test_view_factors(self):
        cube = fluxel.viewfactors(SCENES / "emitting-wall" / "emitting-wall.toml", sides="one", ranks=2, threads=1)
        self.assertTrue(np.allclose(cube.matrix.sum(axis=1), 1, atol=2e-3))
        factors = fluxel.viewfactors(CORNELL, sides="one", tolerance=0.01)
        area = dict(zip(zip(factors.table["from"], factors.table["from_side"]), factors.table["area_from_m2"]))
        exchange = factors.matrix * np.array([[area[surface]] for surface in factors.surfaces])
        self.assertTrue(np.allclose(exchange, exchange.T, rtol=1e-9))
        sparse = fluxel.viewfactors(CORNELL, sides="one", tolerance=0.01, write="npz")
        rows = [sparse.surfaces.index(surface) for surface in factors.surfaces]
        self.assertTrue(np.allclose(sparse.matrix[np.ix_(rows, rows)], factors.matrix, rtol=1e-11))
        self.assertTrue(np.isclose(sparse.matrix.sum(), factors.matrix.sum(), rtol=1e-11))

    def test_names_and_empty_cells(self):
        table = fluxel.read_table(self.write("thermal.csv", 'group,net_W\n"a,""b""",\n12,inf\n'))
        self.assertEqual(table["group"].tolist(), ['a,"b"', "12"])
        self.assertTrue(np.isnan(table["net_W"][0]) and np.isinf(table["net_W"][1]))
        for text, what in (("group,net_W\na,1,2\n", "row 2 has 3 cells"), ("group,net_W\na,x\n", "net_W"), ("", "whole")):
            with self.assertRaisesRegex(fluxel.FormatError, what):
                fluxel.read_table(self.write("torn.csv", text))


class RunsTest(JobTest):
    """By a program that ends as it is told, and keeps its command line."""

    def program(self, code, text=""):
        file = self.write("program", f"#!/bin/sh\nprintf '%s\\n' \"$@\" > {self.work}/words\necho '{text}' >&2\nexit {code}\n")
        file.chmod(0o755)
        return file

    def words(self):
        return (self.work / "words").read_text().splitlines()

    def test_options(self):
        self.assertEqual(option_words({"target_error": 0.02, "no_cut": True, "preview": False, "threads": None, "rays": 1e6,
                                       "eye": (1, np.float32(0.5), -2), "look_at": np.arange(3) / 4, "resolution": [320, 240],
                                       "write": ["vtu", "glb"], "checkpoint": Path("a/b"), "form_factor": "points:2x2"}),
                         ["--target-error=0.02", "--no-cut", "--rays=1000000.0", "--eye=1,0.5,-2", "--look-at=0.0,0.25,0.5",
                          "--resolution=320x240", "--write=vtu,glb", "--checkpoint=a/b", "--form-factor=points:2x2"])
        fluxel.solve("-room.obj", executable=self.program(0), out=self.out, quiet=False)
        self.assertEqual(self.words(), ["solve", f"--out={self.out}", "--", "-room.obj"])
        fluxel.view("room.obj", fluxel.Solution("of"), executable=self.program(0), out=self.out, sides="one")
        self.assertEqual(self.words(), ["view", "--quiet", "--solution=of/solution.ply", "--sides=one", f"--out={self.out}", "--", "room.obj"])

    def test_exit_codes(self):
        with self.assertRaises(fluxel.InputError) as caught:
            fluxel.solve("a.obj", executable=self.program(2, "noise\nfluxel: a.obj: there is no such file"))
        self.assertEqual(str(caught.exception), "a.obj: there is no such file")
        with self.assertWarnsRegex(fluxel.NotReachedWarning, "^the error stated is 9 %$") as caught:
            result = fluxel.solve("a.obj", executable=self.program(3, "warning: the error stated is 9 %"))
        self.assertEqual(Path(caught.filename).name, "python_test.py")
        self.assertFalse(result.stopped)
        self.assertTrue(fluxel.solve("a.obj", executable=self.program(75)).stopped)
        with self.assertRaisesRegex(fluxel.RunError, "exit code 7:\nall is lost") as caught:
            fluxel.solve("a.obj", executable=self.program(7, "all is lost"))
        self.assertEqual(caught.exception.code, 7)

    def test_the_program_itself_refuses(self):
        with self.assertRaisesRegex(fluxel.InputError, "nowhere.obj: there is no such file"):
            fluxel.solve("nowhere.obj", ranks=2)
        with self.assertRaisesRegex(fluxel.InputError, "target-eror"):
            fluxel.solve(CORNELL, target_eror=0.1)

    def test_a_target_out_of_reach(self):
        with self.assertWarnsRegex(fluxel.NotReachedWarning, "above the target"):
            solution = fluxel.solve(CORNELL, target_error=1e-4, time=1, resolution=(8, 8))
        self.assertIs(solution.reached, False)
        self.assertTrue(solution.converged)

    def test_where_the_program_is_looked_for(self):
        program = self.program(0).rename(self.work / "fluxel")
        kept = {name: os.environ[name] for name in ("FLUXEL", "PATH")}
        self.addCleanup(os.environ.update, kept)
        self.assertEqual(find_executable(program), str(program))
        self.assertEqual(find_executable(None), kept["FLUXEL"])
        del os.environ["FLUXEL"]
        os.environ["PATH"] = f"{self.work}:{kept['PATH']}"
        self.assertEqual(find_executable(None), str(program))
        with self.assertRaisesRegex(fluxel.RunError, "no program .*/nowhere: build it"):
            fluxel.solve("a.obj", executable=self.work / "nowhere")
        (self.work / "text").write_text("text")
        (self.work / "text").chmod(0o755)
        with self.assertRaises(fluxel.RunError):
            fluxel.solve("a.obj", executable=self.work / "text")

    def test_temporary_folders_go_with_their_results(self):
        result = fluxel.solve("a.obj", executable=self.program(0))
        folder = result.out
        self.assertTrue(folder.is_dir())
        with self.assertRaises(FileNotFoundError):
            result.elements
        del result
        self.assertFalse(folder.exists())
        with self.assertRaises(fluxel.RunError):
            fluxel.solve("a.obj", executable=self.program(1))
        (failed,) = [word[len("--out="):] for word in self.words() if word.startswith("--out=")]
        self.assertFalse(Path(failed).exists())


class DocumentTest(JobTest):
    def test_examples(self):
        tutorial, document = ((ROOT / "docs" / name).read_text() for name in ("tutorial.md", "python.md"))
        self.write("room.toml", re.search(r"cat > room.toml <<'END'\n(.*?)\nEND\n", tutorial, re.DOTALL).group(1))
        examples = re.findall(r"```python\n(.*?)```", document, re.DOTALL)
        self.assertEqual(len(examples), 2)
        os.chdir(self.work)
        self.addCleanup(os.chdir, Path(__file__).parent)
        sys.stdout, screen = open(self.work / "said", "w+"), sys.stdout
        try:
            names = {}
            for example in examples:
                exec(compile(example, "docs/python.md", "exec"), names)
        finally:
            sys.stdout.close()
            sys.stdout = screen
        self.assertTrue(close(names["leaving"], names["solution"].report["leaving"], 1e-6))
        self.assertGreater(names["floor"].sum(), 0)
        self.assertEqual(names["picture"].shape, (120, 160))
        # What the legs touch of the desk and the floor is left out.
        self.assertTrue(np.allclose(names["factors"].matrix.sum(axis=1), 1, atol=0.02))


if __name__ == "__main__":
    unittest.main()
