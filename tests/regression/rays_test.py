"""Light that nodes exchange by rays: `--exchange rays`, and what chooses it."""

import unittest

from fluxel_job import SCENES, JobTest
from result_files import read_exr

CORNELL_FILE = SCENES / "cornell-box" / "cornell-box.toml"
BOXES_FILE = SCENES / "room-of-boxes" / "room-of-180-boxes.toml"  # 2,506 faces
RAYS = ("--exchange", "rays")
SMALL = ("--resolution", "24x24")


def pixels(image):
    """Of a picture's green channel."""
    return [pixel for row in image["G"] for pixel in row]


def mean(values):
    return sum(values) / len(values)


def box(low, high):
    """Lines of an OBJ file: six quadrangles that face inwards."""
    corners = [[(low, high)[k >> axis & 1][axis] for axis in range(3)] for k in range(8)]
    faces = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return [f"v {x} {y} {z}" for x, y, z in corners] + ["f " + " ".join(str(k - 8) for k in face) for face in faces]


class RaysTest(JobTest):
    method = ()

    def made(self, *arguments, **settings):
        """All that must not depend on who works."""
        self.assert_done(self.solve(CORNELL_FILE, *SMALL, *RAYS, *arguments, "--quiet", **settings))
        report = self.report()
        rounds = [{key: value for key, value in one.items() if not key.endswith("_s")}
                  for one in report["hierarchy"]["rounds"]]
        return {"solution": (self.out / "solution.ply").read_bytes(), "rounds": rounds,
                "pixels": read_exr(self.out / "image.exr"), "stated": report["stated_error"],
                "energy": report["energy"], "rays": [report["hierarchy"][key] for key in ("rays", "gather_rays")]}

    def test_ranks_and_threads(self):
        first = self.made("--target-error", 0.05, ranks=1)
        self.assertGreater(first["rounds"][-1]["rows"], 100)
        self.assertEqual(first["rounds"][-1]["links"], 0)
        for ranks, threads in ((1, 2), (2, 1), (3, 1)):
            with self.subTest(ranks=ranks, threads=threads):
                other = self.made("--target-error", 0.05, "--threads", threads, ranks=ranks)
                for key, value in first.items():
                    self.assertTrue(other[key] == value, key)

    def test_rounds_that_were_kept(self):
        goal = ("--block-error", 5e-3)
        whole = self.made(*goal, ranks=1)
        folder = str(self.out.parent / "kept")
        # Another goal is another solution; the same one is taken up where it ended, by any number of ranks.
        self.assert_done(self.solve(CORNELL_FILE, *SMALL, *RAYS, *goal, "--checkpoint", folder, "--quiet", ranks=2))
        again = self.made(*goal, "--checkpoint", folder, "--resume", ranks=1)
        self.assertEqual(self.report()["hierarchy"]["rounds_resumed"], len(whole["rounds"]))
        self.assertTrue(again["solution"] == whole["solution"])
        self.assertTrue(again["pixels"] == whole["pixels"])
        # Links cannot take them up.
        self.assert_done(self.solve(CORNELL_FILE, *SMALL, *goal, "--checkpoint", folder, "--resume", "--quiet"))
        self.assertEqual(self.report()["hierarchy"]["rounds_resumed"], 0)

    def test_says_what_links_say(self):
        pictures = []
        for exchange in ("links", "rays"):
            self.assert_done(self.solve(CORNELL_FILE, *SMALL, "--exchange", exchange, "--target-error", 0.02, "--quiet"))
            report = self.report()
            self.assertEqual(report["hierarchy"]["exchange"], exchange)
            self.assertEqual(report["options"]["exchange"], exchange)
            self.assertLessEqual(report["stated_error"], 0.02)
            pictures.append(pixels(read_exr(self.out / "image.exr")))
        # Neighbouring pixels share light in the second picture, by no more than rays may be off.
        errors = report["hierarchy"]["errors"]
        self.assertGreater(errors["picture"], 0.1 * errors["rays"])
        self.assertLess(errors["picture"], report["stated_error"])
        by_links, by_rays = pictures
        self.assertAlmostEqual(mean(by_rays) / mean(by_links), 1, delta=0.02)
        # The lamp, whose light is known, is most of the mean: 2 % of that are 8 % of what is reflected, of which a
        # picture is allowed half.
        reflected = [pair for pair in zip(by_links, by_rays) if pair[0] < 2 * sorted(by_links)[len(by_links) // 2]]
        off = mean([(a - b) ** 2 for a, b in reflected]) ** 0.5
        self.assertLess(off, 0.04 * mean([a for a, _ in reflected]))

    def test_reflected_light_is_scaled_by_what_is_measured(self):
        # A black table keeps most of the floor dark. Where nodes are few, the floor is as bright everywhere, and the
        # ceiling, which is seen away from the lamp, too dark.
        self.write("table.mtl", "newmtl white\nKd 0.7 0.5 0.3\nnewmtl black\nKd 0 0 0\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n")
        room = self.write("table.obj", "\n".join(
            ["mtllib table.mtl", "usemtl white"] + box((0, 0, 0), (4, 4, 3)) +
            ["usemtl black", "v .9 .5 .8", "v 3.5 .5 .8", "v 3.5 3.5 .8", "v .9 3.5 .8", "f -4 -3 -2 -1",
             "usemtl lamp", "v .2 1.5 2.9", "v .2 2.5 2.9", "v .9 2.5 2.9", "v .9 1.5 2.9", "f -4 -3 -2 -1"]) + "\n")
        view = ("--sides", "two", "--eye", "2.4,2,1.2", "--look-at", "2.4,2,3", "--up", "0,1,0", "--fov", 60,
                "--resolution", "24x24", "--quiet")

        def solved(*arguments):
            self.assert_done(self.solve(room, *view, *arguments))
            return self.report(), mean(pixels(read_exr(self.out / "image.exr")))

        coarse = ("--exchange", "rays", "--block-error", 0.5)
        _, expected = solved("--exchange", "links", "--target-error", 0.01)
        _, alone = solved(*coarse, "--audit", 0)
        report, scaled = solved(*coarse, "--audit", 0.97)
        # The stated bias of the first is at most a quarter of 1 %.
        self.assertLess(alone / expected, 0.98)
        self.assertGreater(report["audit"]["scale_of_reflected"][1], 1.02)
        for bias in report["audit"]["bias"]:
            self.assertAlmostEqual(bias["bias"], 0, delta=1e-9)
        self.assertAlmostEqual(scaled / expected, 1, delta=report["audit"]["bias"][1]["half_interval"] + 0.0025)

    def test_is_chosen_for_pictures_of_many_faces(self):
        side = 103  # squared: triangles of two faces each
        lines = ["mtllib many.mtl", "usemtl white"]
        for k in range(side * side):
            x, y, z = k % side / side, k // side / side, 0.01 * (k % 7)
            lines += [f"v {x} {y} {z}", f"v {x + 0.003} {y} {z}", f"v {x} {y + 0.003} {z}", "f -3 -2 -1"]
        lines += ["usemtl lamp", "v 0 0 1", "v 0 1 1", "v 1 1 1", "v 1 0 1", "f -4 -3 -2 -1"]
        self.write("many.mtl", "newmtl white\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n")
        room = self.write("many.obj", "\n".join(lines) + "\n")
        view = ("--eye", "0.5,0.5,0.9", "--look-at", "0.5,0.5,0", "--up", "0,1,0", "--fov", 60, "--resolution", "8x8")
        goal = ("--block-error", 0.5, "--audit", 0, "--quiet")
        self.assert_done(self.solve(room, *view, *goal))
        report = self.report()
        self.assertEqual(report["hierarchy"]["exchange"], "rays")
        # Where power goes is then told by samples of the sides.
        self.assertGreater(report["unknowns"], 8192)
        emitted = report["energy"]["emitted"][0]
        self.assertGreater(report["energy"]["sampling_error"][0], 0)
        self.assertLess(abs(report["energy"]["defect"][0]), 0.02 * emitted + 4 * report["energy"]["sampling_error"][0])
        # What wants light of single elements has links where these are not too many.
        for scene, options, exchange in ((BOXES_FILE, (), "rays"), (BOXES_FILE, ("--keep-links",), "links"),
                                         (CORNELL_FILE, (), "links")):
            self.assert_done(self.solve(scene, *SMALL, *goal, *options))
            self.assertEqual(self.report()["hierarchy"]["exchange"], exchange, scene)
        job = self.solve(BOXES_FILE, *SMALL, *goal, "--solver", "cg")
        self.assert_done(job)
        self.assertTrue(any("--solver: light goes by rays" in line for line in job.warnings), job)
        job = self.solve(room, *view, *goal, "--keep-links")
        self.assert_done(job)
        self.assertTrue(any("--keep-links: light goes by rays" in line for line in job.warnings), job)


if __name__ == "__main__":
    unittest.main()
