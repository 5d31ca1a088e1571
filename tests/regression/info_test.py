"""`fluxel info`: what a scene holds, what is suspicious of it, and what a solve would take."""

import re
import unittest

from fluxel_job import SCENES, JobTest, start
from rooms import CEILING, MTL, ROOM, VERTICES, WALLS, scene_file

ROOM_IN_PARTS = 'title = "Two rooms"\n[[geometry]]\nfile = "room.obj"\nmetres_per_unit = 2\n[[geometry]]\nfile = "room.obj"\ntranslate = [5, 0, 0]\n'


class InfoTest(JobTest):
    def setUp(self):
        super().setUp()
        self.write("room.mtl", MTL)
        self.room = self.write("room.obj", ROOM)

    def info(self, *arguments, ranks=1):
        job = start(["info", *arguments], ranks=ranks)
        self.assert_done(job)
        self.assertEqual(job.err, "")
        return job.out

    def row(self, text, name):
        """The words after the one line that begins with a name."""
        lines = [line.split() for line in text.splitlines() if line.split()[:1] == [name]]
        self.assertEqual(len(lines), 1, (name, text))
        return lines[0][1:]

    def test_what_a_scene_holds(self):
        text = self.info(self.room)
        self.assertIn("scene: room\n", text)
        for file in (self.room, self.work / "room.mtl"):
            self.assertIn(f"  {file}\n", text)
        self.assertEqual(" ".join(self.row(text, "bounds")), "0,0,0 to 1,1,1 m")
        self.assertEqual(" ".join(self.row(text, "extent")), "1 x 1 x 1 m")
        self.assertIn("(none was given)", text)
        self.assertEqual(self.row(text, "faces")[0], "6:")
        self.assertEqual(self.row(text, "patches")[0], "6,")
        self.assertIn("the scene is closed and convex", text)
        self.assertEqual(self.row(text, "white"), ["0.5", "0", "two", "5", "5", "0"])
        self.assertEqual(self.row(text, "light"), ["0.2", "3.142", "two", "1", "1", "3.142"])
        self.assertIn("all surfaces emit 3.142 W\n", text)
        for absent in ("suspicious", "cameras", "receivers", "luminaires", "No solve"):
            self.assertNotIn(absent, text)

    def test_what_a_solve_would_take(self):
        text = self.info(self.room)
        self.assertIn("Forecast of a solve to 1 % of the surfaces, by its first rounds:", text)
        self.assertRegex(text, r"round 1: .* leaves, ")
        self.assertRegex(text, r"forecast: .* links in the end, .* GiB on the largest rank; rounds [0-9.]+ s")
        coarser = self.info(self.room, "--target-error", "0.1")
        self.assertIn("to 10 % of the surfaces", coarser)
        links = [float(re.search(r"about ([0-9.e+]+) (links|rows)", one)[1]) for one in (coarser, text)]
        self.assertGreater(links[1], links[0])

    def test_cameras_receivers_and_placed_files(self):
        camera = '[[camera]]\nname = "desk"\neye = [0.5, 0.1, 0.5]\nlook_at = [0.5, 0.9, 0.5]\nup = [0, 0, 1]\nresolution = [8, 8]\n'
        receiver = '[[receivers]]\nname = "plane"\norigin = [0.1, 0.1, 0.5]\nu = [0.5, 0, 0]\nv = [0, 0.5, 0]\ncells = [3, 2]\n'
        text = self.info(self.write("rooms.toml", ROOM_IN_PARTS + camera + receiver), ranks=2)
        self.assertIn("scene: Two rooms\n", text)
        self.assertEqual(text.count(f"  {self.room}\n"), 1, "once, though it is placed twice")
        self.assertEqual(text.count("unit  "), 2)
        self.assertEqual(" ".join(self.row(text, "desk")), "from 0.5,0.1,0.5 to 0.5,0.9,0.5")
        self.assertEqual(" ".join(self.row(text, "plane")), "irradiance, 3x2 cells at 0.1,0.1,0.5")
        self.assertEqual(" ".join(self.row(text, "bounds")), "0,0,0 to 6,2,2 m")
        self.assertEqual(self.row(text, "light")[3:], ["2", "5", "15.71"])
        self.assertIn("to 1 % of the picture", text)

    def test_what_is_suspicious(self):
        flipped = "mtllib room.mtl\n" + VERTICES + WALLS.replace("f 1 2 3 4", "f 4 3 2 1").replace("f 4 8 5 1\n", "") + CEILING + CEILING
        self.write("room.mtl", MTL.replace("Kd 0.5 0.5 0.5", "Kd 0.5 0.99 0.5"))
        text = self.info(self.write("wrong.obj", flipped), "--sides", "one")
        suspicious = text.split("suspicious:\n")[1].split("\n\n")[0]
        for words in ("face opposite ways", "light leaves by a gap", "1 pair of patches overlaps", "above 0.95", "white"):
            self.assertIn(words, suspicious)

    def test_a_wrong_unit(self):
        large = self.write("large.obj", ROOM.replace(VERTICES, VERTICES.replace(" 1", " 3000")))
        self.assertIn("3000 m wide: if its unit is the millimetre, give --metres-per-unit 0.001", self.info(large))
        text = self.info(large, "--metres-per-unit", "0.001")
        self.assertNotIn("suspicious", text)
        self.assertEqual(" ".join(self.row(text, "extent")), "3 x 3 x 3 m")

    def test_a_scene_that_emits_nothing(self):
        self.write("room.mtl", MTL.replace("Ke 1 1 1", "Ke 0 0 0"))
        text = self.info(self.room, ranks=2)
        self.assertIn("all surfaces emit 0 W\n", text)
        self.assertIn("No solve: nothing emits light", text)
        self.assertNotIn("Forecast", text)

    def test_options_of_the_scene_file_count(self):
        scene = self.write("room.toml", scene_file('[options]\nmethod = "matrix"\nsides = "one"\nmax-edge = 0.1\nsubdivision = "uniform"\nke = "radiance"\n'))
        text = self.info(scene)
        self.assertEqual(self.row(text, "light")[1:3], ["3.142", "one"])
        self.assertIn("Forecast of a solve to 1 % of the picture", text)
        self.assertEqual(self.row(self.info(scene, "--sides", "two", "--ke", "exitance"), "light")[1:3], ["1", "two"])

    def test_heat(self):
        text = self.info(SCENES / "heating-chamber" / "heating-chamber.toml")
        self.assertIn("emissivity", text)
        self.assertIn(" K\n", text)
        self.assertIn("Forecast", text)

    def test_convection_in_celsius(self):
        self.write("case.mtl", "newmtl a\nKd 0\nemissivity 0.8\nconvection_coefficient 12\nair_temperature 293.15\n")
        self.write("case.obj", "mtllib case.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n")
        text = self.info(self.write("case.toml", 'temperature_unit = "celsius"\n[[geometry]]\nfile = "case.obj"\n'
                                                 "[options]\nthermal = true\n"))
        self.assertIn("emissivity 0.8, 0 W/m2, 12 W/(m2 K) to air of 20 C\n", text)
        self.assertIn("No forecast: material 'a' has a convection_coefficient", text)
        self.assertNotIn("Forecast", text)

    def test_what_cannot_be_read(self):
        self.assert_refused(start(["info", self.work / "gone.obj"], ranks=1), "no such file")
        self.assert_refused(start(["info", self.write("bad.obj", "v 0 0 x\n")], ranks=1), "bad.obj:1:")
        self.assert_refused(start(["info"], ranks=1), "scene is required", "'fluxel info --help'")


if __name__ == "__main__":
    unittest.main()
