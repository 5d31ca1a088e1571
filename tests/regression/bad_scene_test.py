"""Scenes that cannot be used: exit code 2, one message with file and line, nothing written."""

import unittest

from fluxel_job import JobTest, line_of
from rooms import CEILING, INSIDE, MTL, OUTSIDE, ROOM, SMALL, VERTICES, WALLS, scene_file


class BadSceneTest(JobTest):
    def refuse_obj(self, obj, *texts, mtl=MTL, at=None, camera=INSIDE, options=()):
        """`at` is a part of the line that is to blame."""
        file = self.write("room.obj", obj)
        self.write("room.mtl", mtl)
        job = self.solve(file, *camera, *SMALL, *options)
        self.assert_refused(job, *texts, file=file if at else None, line=line_of(obj, at) if at else None)
        return job

    def refuse_mtl(self, mtl, *texts, at):
        self.write("room.mtl", mtl)
        job = self.solve(self.write("room.obj", ROOM), *INSIDE, *SMALL)
        self.assert_refused(job, *texts, file=self.work / "room.mtl", line=line_of(mtl, at))

    def refuse_toml(self, toml, *texts, at):
        self.write("room.obj", ROOM)
        self.write("room.mtl", MTL)
        file = self.write("room.toml", toml)
        self.assert_refused(self.solve(file), *texts, file=file, line=line_of(toml, at))

    # What single precision cannot hold

    def test_an_emitting_needle(self):
        """0.6 m long: rounded to single precision about the scene's centre its element has no width."""
        self.write("room.mtl", MTL)
        for width in (1e-9, 1e-12):
            with self.subTest(width=width):
                needle = f"v 0.2 0.5 0.9\nv 0.8 0.5 0.9\nv 0.8 0.5 {0.9 + width}\nusemtl light\nf -3 -2 -1\n"
                scene = self.write("needle.obj", ROOM + needle)
                self.assert_done(self.solve(scene, "--subdivision", "none", "--threads", "1", ranks=1))
                self.assertLess(self.report()["energy"]["defect_relative"], 0.1)

    def test_pixels_that_coincide(self):
        self.write("room.mtl", MTL)
        scene = self.write("room.obj", ROOM)
        for fov in ("1e-6", "1e-9", "1e-100"):
            with self.subTest(fov=fov):
                self.assert_refused(self.solve(scene, *INSIDE, "--fov", fov, *SMALL), "cannot be told apart", "--fov")

    # Files

    def test_missing_scene(self):
        file = self.work / "nowhere.obj"
        self.assert_refused(self.solve(file, *INSIDE), "no such file", file=file)

    def test_a_folder_as_scene(self):
        folder = self.work / "folder.obj"
        folder.mkdir()
        self.assert_refused(self.solve(folder, *INSIDE), file=folder)

    def test_unknown_extension(self):
        file = self.write("room.xyz", ROOM)
        self.assert_refused(self.solve(file, *INSIDE), ".obj", file=file)

    def test_missing_mtl(self):
        file = self.write("room.obj", ROOM)
        job = self.solve(file, *INSIDE, *SMALL)
        self.assert_refused(job, "room.mtl", file=file, line=line_of(ROOM, "mtllib"))

    def test_missing_geometry(self):
        toml = scene_file()
        file = self.write("room.toml", toml)
        self.assert_refused(self.solve(file), "room.obj", file=file, line=line_of(toml, "file ="))

    # Geometry

    def test_vertex_that_is_not_finite(self):
        for word in ("nan", "-inf", "1e999", "x"):
            with self.subTest(word):
                self.refuse_obj(ROOM.replace("v 0 1 1", f"v 0 {word} 1"), at=f"v 0 {word} 1")

    def test_vertex_without_its_third_coordinate(self):
        self.refuse_obj("v 7 7\n" + ROOM, at="v 7 7")

    def test_index_out_of_range(self):
        for word in ("9", "0", "-9"):
            with self.subTest(word):
                self.refuse_obj(ROOM.replace("f 5 8 7 6", f"f 5 8 7 {word}"), at=f"f 5 8 7 {word}")

    def test_no_face(self):
        for name, obj in (("empty", ""), ("a remark", "# nothing\n"), ("vertices", "mtllib room.mtl\n" + VERTICES)):
            with self.subTest(name):
                self.refuse_obj(obj, "face")

    def test_only_degenerate_faces(self):
        faces = "usemtl light\nf 1 1 2\nf 1 2 1\nf 3 3 3\n"
        self.refuse_obj("mtllib room.mtl\n" + VERTICES + faces)

    def test_a_lamp_too_small_for_the_sky_around_it(self):
        corners = [f"v {x} {y} {z}" for x in ("-5e8", "5e8") for y in ("-5e8", "5e8") for z in ("-5e8", "5e8")]
        faces = ("1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4")
        sky = "\n".join(corners + ["g sky", "usemtl white"] + ["f " + face for face in faces])
        # Corners of the sky come first; those of the room are counted back from where they stand.
        vertices = [line for line in VERTICES.splitlines() if line.startswith("v ")]
        lamp = "\n".join(vertices[:3] + ["g lamp", "usemtl light", "f -3 -2 -1"])
        self.refuse_obj(f"mtllib room.mtl\n{sky}\n{lamp}\n", "no patch emits light", "1 face is too small", "'lamp' (1, emitting)",
                        "a square of 173 m", "'sky' reaches farthest")

    # Materials

    def test_no_emitter(self):
        self.refuse_obj(ROOM, "emits light", mtl=MTL.replace("Ke 1 1 1", "Ke 0 0 0"))

    def test_reflectance_outside_0_to_1(self):
        for kd in ("0.5 1.01 0.5", "-0.1 0.5 0.5", "nan 0.5 0.5"):
            with self.subTest(kd):
                self.refuse_mtl(MTL.replace("Kd 0.5 0.5 0.5", "Kd " + kd), at="Kd " + kd)

    def test_negative_emission(self):
        self.refuse_mtl(MTL.replace("Ke 1 1 1", "Ke 1 -1 1"), at="Ke 1 -1 1")

    # Scene files

    def test_reflectance_outside_0_to_1_in_a_scene_file(self):
        self.refuse_toml(scene_file("[materials.white]\nrho = 1.2\n"), "0..1", at="rho")

    def test_negative_emission_in_a_scene_file(self):
        self.refuse_toml(scene_file("[materials.light]\nE = [1.0, -2.0, 1.0]\n"), at="E =")

    def test_unknown_keys(self):
        self.refuse_toml(scene_file("[lights]\na = 1\n"), "'lights'", at="[lights]")
        self.refuse_toml("colour = 1\n" + scene_file(), "'colour'", at="colour")
        self.refuse_toml(scene_file(camera="eye = [0.5, 0.1, 0.5]\nfocus = 2\n"), "'focus'", at="focus")
        self.refuse_toml(scene_file("[materials.white]\nshine = 1\n"), "'shine'", at="shine")

    def test_unknown_material(self):
        self.refuse_toml(scene_file("[materials.gold]\nrho = 0.5\n"), "'gold'", at="gold")

    def test_no_toml(self):
        self.refuse_toml(scene_file("[options\n"), at="[options")

    def test_keys_of_very_many_parts(self):
        key = ".".join(["a"] * 40000)
        self.refuse_toml(scene_file(f"[options]\n{key} = 1\n"), "more than 32 dots", at=key)

    def test_camera_of_a_scene_file(self):
        self.refuse_toml(scene_file().replace("[16, 16]", "[70000, 2]"), "65536", at="resolution")
        self.refuse_toml(scene_file('[options]\neye = "0,0,0"\n'), "'eye' is set twice", at='eye = "')

    def test_unknown_format_of_geometry(self):
        self.refuse_toml(scene_file().replace("room.obj", "room.xyz"), "room.xyz", "known: .obj", at="room.xyz")

    def test_unknown_option_in_a_scene_file(self):
        self.refuse_toml(scene_file('[options]\nsides = "two"\nspeed = 11\n'), "'speed'", at="speed")

    def test_bad_option_values_in_a_scene_file(self):
        for option in ('sides = "three"', "threads = 0", "tolerance = nan", 'tolerance = "small"', "cut = 1979-05-27"):
            with self.subTest(option):
                self.refuse_toml(scene_file(f"[options]\n{option}\n"), at=option)

    # Cameras

    def test_camera_that_sees_the_back_of_a_closed_component_alone(self):
        self.refuse_obj(ROOM, "camera", camera=OUTSIDE, options=("--sides", "one"))

    def test_camera_inside_a_closed_component_that_faces_outward(self):
        outward = "\n".join(" ".join(["f", *reversed(line.split()[1:])]) if line.startswith("f ") else line
                            for line in (WALLS + CEILING).splitlines())
        obj = "mtllib room.mtl\n" + VERTICES + outward + "\n"
        self.refuse_obj(obj, "camera", options=("--sides", "one"))

    def test_camera_that_sees_nothing(self):
        self.refuse_obj(ROOM, "camera", camera=("--eye", "0,-3,0", "--look-at", "0,-9,0", "--up", "0,0,1"))


if __name__ == "__main__":
    unittest.main()
