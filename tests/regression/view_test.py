"""`fluxel view`: another picture of a finished solve."""

import json
import unittest

from fluxel_job import SCENES, JobTest, start
from rays_test import box, mean, pixels
from result_files import read_exr

CORNELL_FILE = SCENES / "cornell-box" / "cornell-box.toml"
ASIDE = ("--eye", "0.15,0.4,-0.3", "--look-at", "0.3,0.2,0.3")


class ViewTest(JobTest):
    method = ()

    def setUp(self):
        super().setUp()
        self.seen = self.work / "seen"

    def view(self, *arguments, scene=CORNELL_FILE, **settings):
        return start(["view", scene, "--solution", self.out / "solution.ply", "--out", self.seen, *arguments],
                     **settings)

    def viewed(self, *arguments, **settings):
        self.assert_done(self.view(*arguments, "--quiet", **settings))
        return read_exr(self.seen / "image.exr"), json.loads((self.seen / "report.json").read_text())

    def solved(self, *arguments, scene=CORNELL_FILE, **settings):
        self.assert_done(self.solve(scene, *arguments, "--quiet", **settings))

    def assert_refused(self, job, *words):
        self.assertEqual(job.code, 2, job)
        self.assertEqual(len(job.said), 1, job)
        for word in words:
            self.assertIn(word, job.said[0])

    def test_another_eye(self):
        small = ("--resolution", "64x64", "--target-error", 0.03)
        self.solved(*small, *ASIDE)
        wanted, of_run = pixels(read_exr(self.out / "image.exr")), self.report()
        self.solved(*small)
        self.seen.mkdir()
        (self.seen / "solution.ply").write_text("another run's")
        picture, report = self.viewed(*small, *ASIDE)
        self.assertEqual((self.seen / "solution.ply").read_text(), "another run's")
        (self.seen / "solution.ply").unlink()
        # Both are off by no more than they say, and by errors of their own.
        off = mean([(a - b) ** 2 for a, b in zip(pixels(picture), wanted)]) ** 0.5 / mean(wanted)
        self.assertGreater(off, 0)
        self.assertLess(off, of_run["stated_error"] + report["stated_error"])
        self.assertLess(report["stated_error"], 0.03)
        self.assertEqual(report["options"]["method"], "view")
        self.assertEqual(report["options"]["eye"], [0.15, 0.4, -0.3])
        self.assertNotIn("solve", report)
        self.assertEqual({file.name for file in self.seen.iterdir()},
                         {"convergence.csv", "image.exr", "image.png", "report.html", "report.json"})

    def test_kept_links(self):
        small = ("--resolution", "64x64", "--target-error", 0.03)
        self.solved(*small, "--keep-links", ranks=2)
        self.assertEqual(len(list((self.out / "links").iterdir())), 3)
        of_run = self.report()
        # From its own eye, by the same links, it is the run's picture but for other random numbers, and for the scale
        # of reflected light that the run's audit has found.
        wanted = pixels(read_exr(self.out / "image.exr"))
        job = self.view(*small)
        self.assert_done(job)
        self.assertIn(f"{of_run['hierarchy']['rounds'][-1]['links']} links between", job.out)
        picture = read_exr(self.seen / "image.exr")
        off = mean([(a - b) ** 2 for a, b in zip(pixels(picture), wanted)]) ** 0.5 / mean(wanted)
        self.assertLess(off, 0.02)
        # Any number of ranks takes up what two have kept.
        for ranks in (1, 3):
            self.assertTrue(self.viewed(*small, ranks=ranks)[0] == picture)

    def test_coarse_links(self):
        coarse = ("--resolution", "48x48", "--target-error", 0.1)
        self.solved(*coarse, "--keep-links")
        wanted = pixels(read_exr(self.out / "image.exr"))
        picture, report = self.viewed(*coarse, "--audit", 0)
        off = mean([(a - b) ** 2 for a, b in zip(pixels(picture), wanted)]) ** 0.5 / mean(wanted)
        self.assertLess(off, 0.07)
        self.assertLess(report["picture"]["error"], 0.07)

    def assert_by_rays(self, job, reason):
        self.assert_done(job)
        told = [line for line in job.warnings if line.endswith("pictures are gathered by rays")]
        self.assertEqual(len(told), 1, job)
        self.assertIn(reason, told[0])
        self.assertNotIn("links between", job.out)

    def test_what_is_no_folder_of_links(self):
        small = ("--resolution", "16x16", "--target-error", 0.3)
        self.out.mkdir()
        (self.out / "links").write_text("notes")
        self.solved(*small)
        self.assertEqual((self.out / "links").read_text(), "notes")
        self.assert_refused(self.solve(CORNELL_FILE, *small, "--keep-links"), "links")
        (self.out / "links").unlink()
        self.assert_refused(self.solve(CORNELL_FILE, *small, "--checkpoint", self.out / "links"), "another --checkpoint")

    def test_links_that_are_not_the_solutions(self):
        small = ("--resolution", "24x24", "--target-error", 0.1)
        self.solved(*small, "--keep-links", ranks=1)
        solution = (self.out / "solution.ply").read_bytes()
        links, rounds = sorted((self.out / "links").iterdir())
        whole = links.read_bytes()
        links.write_bytes(whole[:-9])
        self.assert_by_rays(self.view(*small), "is damaged or cut off")
        links.unlink()
        self.assert_by_rays(self.view(*small), "is missing")
        links.write_bytes(whole)
        named = rounds.read_bytes()
        rounds.unlink()
        rounds.mkdir()
        self.assert_by_rays(self.view(*small), "cannot be read")
        rounds.rmdir()
        rounds.write_bytes(named)
        self.solved("--resolution", "24x24", "--target-error", 0.05, "--keep-links", ranks=1)
        self.assertEqual(len(list((self.out / "links").iterdir())), 2)
        (self.out / "solution.ply").write_bytes(solution)
        self.assert_by_rays(self.view(*small), "holds no whole round")
        self.solved(*small)
        self.assertFalse((self.out / "links").exists(), "of an earlier run")
        job = self.solve(CORNELL_FILE, *small, "--keep-links", "--exchange", "rays")
        self.assertIn("--keep-links has no effect", "\n".join(job.warnings))

    def test_more_pixels_than_elements(self):
        self.solved("--method", "matrix", "--resolution", "24x24")
        fine = ("--resolution", "96x96", "--target-error", 0.02)
        elements, coarse = self.viewed(*fine, "--picture", "elements", "--audit", 0)
        self.assertNotIn("stated_error", coarse)
        picture, _ = self.viewed(*fine, "--audit", 0)
        self.solved(*fine)
        truth = pixels(read_exr(self.out / "image.exr"))
        off = [mean([(a - b) ** 2 for a, b in zip(pixels(of), truth)]) ** 0.5 / mean(truth)
               for of in (elements, picture)]
        self.assertGreater(off[0], 0.04)  # one shade an element
        self.assertLess(off[1], 0.02)

    def test_matrix_gathers_its_picture(self):
        uniform = ("--method", "matrix", "--subdivision", "uniform", "--max-edge", 0.12, "--resolution", "64x64")
        self.solved(*uniform)
        gathered, report = pixels(read_exr(self.out / "image.exr")), self.report()
        self.solved(*uniform, "--picture", "elements")
        shades, coarse = pixels(read_exr(self.out / "image.exr")), self.report()
        self.assertGreater(len(set(gathered)), 3 * len(set(shades)))
        self.assertLess(report["stated_error"], 0.3 * coarse["stated_error"])
        self.assertGreater(report["picture"]["ray_error"], 0)
        self.assertNotIn("picture", coarse)

    def test_ranks_and_threads(self):
        self.solved("--method", "matrix", "--subdivision", "uniform", "--max-edge", 0.12, "--picture", "elements")
        options = ("--resolution", "72x72", "--target-error", 0.08)
        first, report = self.viewed(*options, ranks=1)
        self.assertGreater(report["picture"]["records"], 0)
        for ranks, threads in ((1, 2), (2, 1), (7, 1)):
            with self.subTest(ranks=ranks, threads=threads):
                other, of_other = self.viewed(*options, "--threads", threads, ranks=ranks)
                self.assertTrue(other == first)
                self.assertEqual(of_other["stated_error"], report["stated_error"])

    def with_desk(self, text=CORNELL_FILE.read_text()):
        """The scene with a receiver."""
        text = text.replace('file = "', f'file = "{CORNELL_FILE.parent}/')
        meter = '[[receivers]]\nname = "desk"\norigin = [0.1, 0.3, 0.1]\nu = [0.3, 0, 0]\nv = [0, 0, 0.3]\ncells = [4, 2]\n\n'
        return self.write("cornell.toml", text.replace("[options]", meter + "[options]", 1))

    def test_receivers_alone(self):
        geometry, _, rest = CORNELL_FILE.read_text().partition("[camera]")
        scene = self.with_desk(geometry + rest[rest.index("[options]"):])
        self.solved("--target-error", 0.3, scene=scene)
        job = self.view("--target-error", 0.1, "--audit", 0.3, scene=scene)
        self.assert_done(job)
        self.assertEqual([line.rpartition(": ")[2] for line in job.warnings if "no effect" in line],
                         ["--target-error has no effect", "--audit has no effect"])
        options = json.loads((self.seen / "report.json").read_text())["options"]
        self.assertNotIn("target-error", options)
        self.assertNotIn("audit", options)

    def test_receivers(self):
        scene = self.with_desk()
        self.solved("--resolution", "32x32", "--target-error", 0.04, scene=scene)
        wanted = self.report()["receivers"]["desk"]["mean_rgb"]
        job = self.view("--resolution", "8x8", "--target-error", 0.2, scene=scene)
        self.assert_done(job, 0)
        self.assertFalse(any("no effect" in line for line in job.warnings), job)
        found = json.loads((self.seen / "report.json").read_text())["receivers"]["desk"]["mean_rgb"]
        for a, b in zip(found, wanted):
            self.assertGreater(a, 0)
            self.assertLess(abs(a / b - 1), 0.01)
        self.assertTrue((self.seen / "receivers.csv").exists())

    def test_no_solution_of_this_scene(self):
        self.solved("--resolution", "16x16", "--target-error", 0.2)
        solution = self.out / "solution.ply"
        whole = solution.read_bytes()
        self.assert_refused(self.view(scene=SCENES / "furnace" / "furnace.toml"), "solution.ply", "another scene")
        solution.write_bytes(whole[:len(whole) // 2])
        self.assert_refused(self.view(), "solution.ply")
        solution.write_bytes(whole[:-8] + b"\xff\xff\xff\x7f" + whole[-4:])
        self.assert_refused(self.view(), "solution.ply")
        solution.write_bytes(whole.replace(b"float radiosity_", b"float brightness_"))
        self.assert_refused(self.view(), "solution.ply", "radiosity of 0 sides")
        solution.unlink()
        self.assert_refused(self.view(), "solution.ply")

    def test_another_scene_than_was_solved(self):
        scene = self.write("cornell.toml", CORNELL_FILE.read_text())
        for file in CORNELL_FILE.parent.iterdir():
            if file.suffix in (".obj", ".mtl"):
                self.write(file.name, file.read_text())
        self.solved("--resolution", "16x16", "--target-error", 0.2, scene=scene)
        mtl = next(self.work.glob("*.mtl"))
        text = mtl.read_text()
        for change in (("Ke ", "Ke 9"), ("Ke ", "Ke 0."), ("Kd 0.7", "Kd 0.1")):
            with self.subTest(change=change):
                self.assertIn(change[0], text)
                mtl.write_text(text.replace(*change))
                self.assert_refused(self.view(scene=scene), "other lights or materials")
        mtl.write_text(text)
        # Furniture that the solution knows nothing of.
        obj = next(self.work.glob("*.obj"))
        obj.write_text(obj.read_text() + "\n".join(["", "g table", *box((200, 350, 100), (300, 450, 200)), ""]))  # mm
        self.assert_refused(self.view(scene=scene), "solution.ply", "of the scene's")

    def test_bad_options(self):
        self.solved("--resolution", "16x16", "--target-error", 0.2)
        self.assert_refused(self.view("--target-error", 0), "--target-error")
        self.assert_refused(self.view("--eye", "9,9,9", "--look-at", "10,9,9"), "sees nothing")
        self.assert_refused(start(["view", CORNELL_FILE, "--solution", self.out / "solution.ply", "--out", self.out]),
                            "solution.ply", "choose another --out")
        self.assert_refused(start(["view", CORNELL_FILE]), "--solution is required")
        self.assert_refused(self.view(scene=SCENES / "heating-chamber" / "heating-chamber.toml"), "thermal")
        self.assert_refused(start(["solve", CORNELL_FILE, "--method", "view"]), "--method")

    def test_a_wrong_solution_is_refused_before_the_picture(self):
        self.solved("--resolution", "16x16", "--target-error", 0.2)
        solution = self.out / "solution.ply"
        solution.write_bytes(solution.read_bytes().replace(b"float radiosity_", b"float brightness_"))
        self.assert_refused(self.view("--eye", "9,9,9", "--look-at", "10,9,9"), "solution.ply", "radiosity of 0 sides")

    def test_what_an_error_is_due_to(self):
        self.solved("--resolution", "16x16", "--target-error", 0.2)
        job = self.view("--resolution", "24x24", "--target-error", 0.02, "--audit", 0.8)
        self.assert_done(job, code=3)
        told = [line for line in job.warnings if "the error stated is" in line]
        self.assertRegex(told[0], r"by the solution and [\d.]+ % by how the picture is gathered; solve with a smaller")

    def test_a_pixel(self):
        self.solved("--resolution", "16x16", "--target-error", 0.2)
        self.assertIn(self.view("--resolution", "1x1").code, (0, 3))
        self.assertGreater(max(pixels(read_exr(self.seen / "image.exr"))), 0)


if __name__ == "__main__":
    unittest.main()
