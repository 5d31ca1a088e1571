"""Surfaces that do more than reflect evenly, where only diffuse ones are known: refused, or black but for rho."""

import unittest

from fluxel_job import JobTest, line_of, start
from rooms import MTL, ROOM, scene_file

MIRROR = "[materials.white]\nrho = 0.25\nmirror = 0.5\n"
REFUSED = ("material 'white' does more than reflect evenly (mirror)", "--specular absorb")


class SpecularTest(JobTest):
    def scene(self, extra=MIRROR, name="room.toml"):
        self.write("room.obj", ROOM)
        self.write("room.mtl", MTL)
        return self.write(name, scene_file(extra))

    def assert_scene_refused(self, job, extra=MIRROR, texts=REFUSED, at="mirror"):
        self.assert_refused(job, *texts, file=self.work / "room.toml", line=line_of(scene_file(extra), at))

    def test_solve(self):
        scene = self.scene()
        for method in ("matrix", "hierarchical"):
            self.assert_scene_refused(self.solve(scene, "--method", method))
        self.assert_scene_refused(self.solve(scene, "--specular", "refuse"))

    def test_solve_names_each_kind(self):
        for key, value in (("transmission", "[0, 0, 0.25]"), ("diffuse_transmission", "0.25"), ("mirror", "0.5")):
            extra = f"[materials.white]\nrho = 0.25\n{key} = {value}\n"
            with self.subTest(key):
                self.assert_scene_refused(self.solve(self.scene(extra)), extra, (f"({key})",), at=key)
        extra = "[materials.white]\nrefraction_index = 1.5\n"
        self.assert_scene_refused(self.solve(self.scene(extra)), extra, ("(refraction_index)",), at="refraction_index")

    def test_viewfactors(self):
        self.assert_scene_refused(start(["viewfactors", self.scene(), "--out", self.out]))
        self.assert_done(start(["viewfactors", self.scene(), "--specular", "absorb", "--out", self.out]))

    def test_view(self):
        plain, seen = self.scene("[materials.white]\nrho = 0.25\n"), self.work / "seen"
        self.assert_done(self.solve(plain))
        solution = ["--solution", self.out / "solution.ply"]
        self.out = seen
        self.assert_scene_refused(start(["view", self.scene(), *solution, "--out", seen]))
        self.assert_done(start(["view", self.scene(), *solution, "--specular", "absorb", "--out", seen]))

    def test_absorbed_light_is_that_of_rho_alone(self):
        job = self.solve(self.scene(), "--specular", "absorb")
        self.assert_done(job)
        self.assertIn("note: --specular absorb: 1 material is taken as black but for rho", job.out)
        absorbed, solution = self.report(), (self.out / "solution.ply").read_bytes()
        self.assertEqual(absorbed["options"]["specular"], "absorb")
        self.assert_done(self.solve(self.scene("[materials.white]\nrho = 0.25\n")))
        self.assertTrue(solution == (self.out / "solution.ply").read_bytes(), "as without the mirror")
        # As an option of the scene file.
        self.assert_done(self.solve(self.scene(MIRROR + '[options]\nspecular = "absorb"\n')))

    def test_unused_materials_are_not_refused(self):
        self.write("room.mtl", MTL + "newmtl gold\nKd 0 0 0\n")
        self.write("room.obj", ROOM)
        file = self.write("room.toml", scene_file("[materials.gold]\nmirror = 0.9\n"))
        self.assert_done(self.solve(file))

    def test_a_choice_that_is_none(self):
        job = self.solve(self.scene(), "--specular", "follow")
        self.assert_refused(job, "--specular", "absorb", "refuse")

    def test_heat_knows_diffuse_surfaces_alone(self):
        heat = "emissivity = 0.5\ntemperature = 300\n"
        extra = f"{MIRROR}{heat}[materials.light]\n{heat}"
        job = self.solve(self.scene(extra), "--thermal", "--specular", "absorb")
        self.assert_scene_refused(job, extra, ("material 'white' does more than reflect evenly", "--thermal"))

    def test_bad_shares(self):
        for extra, at, text in (
            ("[materials.white]\nmirror = 0.75\n", "mirror", "add up to 1.25"),
            ("[materials.white]\ntransmission = -0.5\n", "transmission", "share outside 0..1"),
            ("[materials.white]\nrefraction_index = 0.5\n", "refraction_index", "from 1 to 10"),
            ("[materials.white]\nrefraction_index = 1.5\nrho = 0.5\n", "rho", "beside refraction_index"),
        ):
            with self.subTest(extra):
                self.assert_scene_refused(self.solve(self.scene(extra), "--specular", "absorb"), extra, (text,), at)


if __name__ == "__main__":
    unittest.main()
