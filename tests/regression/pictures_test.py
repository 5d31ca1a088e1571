"""Where the pixels of a picture have their light from: `--picture cached | gather | elements`."""

import signal
import time
import unittest

from fluxel_job import OUTPUTS, SCENES, JobTest, finish, launch
from result_files import read_exr
from rays_test import mean, pixels

CORNELL_FILE = SCENES / "cornell-box" / "cornell-box.toml"


class PicturesTest(JobTest):
    method = ()

    def picture(self, scene, *arguments, **settings):
        self.assert_done(self.solve(scene, *arguments, "--quiet", **settings))
        return read_exr(self.out / "image.exr")

    def test_records_instead_of_pixels(self):
        for exchange in ("links", "rays"):
            with self.subTest(exchange=exchange):
                options = ("--resolution", "72x72", "--target-error", 0.04, "--exchange", exchange)
                each = pixels(self.picture(CORNELL_FILE, *options, "--picture", "gather"))
                gathered = self.report()["picture"]
                self.assertEqual((gathered["records"], gathered["single_pixels"]), (0, 0))
                few = pixels(self.picture(CORNELL_FILE, *options))
                report = self.report()
                cached, errors = report["picture"], report["hierarchy"]["errors"]
                self.assertEqual(report["options"]["picture"], "cached")
                self.assertGreater(cached["records"], 300)
                self.assertLess(cached["records"] + cached["single_pixels"], 0.4 * len(few))
                # Both are off by no more than they say, and by errors of their own.
                off = mean([(a - b) ** 2 for a, b in zip(few, each)]) ** 0.5 / mean(each)
                self.assertLess(off, 2 * report["stated_error"])
                self.assertEqual(cached["error"], errors["picture"])
                self.assertGreater(cached["error"], 0)
                self.assertLess(cached["error"], 1.2 * errors["rays"])
                self.assertLess(abs(mean(few) / mean(each) - 1), 0.003)

    def test_elements_are_as_they_were_solved(self):
        coarse = ("--resolution", "32x32", "--block-error", 0.05)
        picture = pixels(self.picture(CORNELL_FILE, *coarse, "--picture", "elements"))
        self.assertNotIn("picture", self.report())
        # Few leaves, each of one colour.
        self.assertLess(len(set(picture)), 0.5 * len(picture))

    def test_elements_say_how_coarse_they_are(self):
        options = ("--resolution", "32x32", "--target-error", 0.02)
        truth = pixels(self.picture(CORNELL_FILE, *options, "--picture", "gather"))
        # The lamp is known, and most of the mean.
        lit = [k for k, value in enumerate(truth) if value < 2 * sorted(truth)[len(truth) // 2]]
        self.assert_done(self.solve(CORNELL_FILE, *options, "--picture", "elements", "--quiet"), 3)
        shown, report = pixels(read_exr(self.out / "image.exr")), self.report()
        off = mean([(shown[k] - truth[k]) ** 2 for k in lit]) ** 0.5 / mean([truth[k] for k in lit])
        self.assertGreater(report["stated_error"], 0.02)
        self.assertGreater(report["stated_error"], 0.8 * off)
        self.assertFalse(report["hierarchy"]["reached"])

    def test_ranks_and_threads(self):
        for exchange in ("links", "rays"):
            options = ("--resolution", "72x72", "--target-error", 0.06, "--exchange", exchange)
            first = self.picture(CORNELL_FILE, *options, ranks=1)
            records = self.report()["picture"]["records"]
            self.assertGreater(records, 50)
            for ranks, threads in ((2, 2), (7, 1)) if exchange == "links" else ((3, 2),):
                with self.subTest(exchange=exchange, ranks=ranks, threads=threads):
                    other = self.picture(CORNELL_FILE, *options, "--threads", threads, ranks=ranks)
                    self.assertTrue(other == first)
                    self.assertEqual(self.report()["picture"]["records"], records)

    def test_nothing_leaks_from_room_to_room(self):
        # Two rooms without a roof, seen from above; the wall between them is a sheet on a floor that goes through, and the
        # lamp of one is below the wall's top.
        self.write("two.mtl", "newmtl white\nKd 0.7 0.7 0.7\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n")
        walls = ["v 0 0 0", "v 4 0 0", "v 4 2 0", "v 0 2 0", "v 0 0 2", "v 4 0 2", "v 4 2 2", "v 0 2 2",
                 "f 1 2 3 4", "f 1 5 6 2", "f 2 6 7 3", "f 3 7 8 4", "f 4 8 5 1",
                 "g wall", "v 2 0 0", "v 2 2 0", "v 2 2 2", "v 2 0 2", "f -4 -3 -2 -1"]
        scene = self.write("two.obj", "\n".join([
            "mtllib two.mtl", "usemtl white", "g room", *walls,
            "usemtl lamp", "g lamp", "v 2.5 0.5 1.5", "v 2.5 1 1.5", "v 3 1 1.5", "v 3 0.5 1.5", "f -4 -3 -2 -1", ""]))
        above = ("--eye", "2,1,6", "--look-at", "2,1,0", "--up", "0,1,0", "--fov", 30)
        for exchange in ("links", "rays"):
            with self.subTest(exchange=exchange):
                picture = self.picture(scene, *above, "--resolution", "192x128", "--sides", "two", "--exchange", exchange,
                                       "--target-error", 0.05)["G"]
                self.assertGreater(self.report()["picture"]["records"], 100)
                dark, lit = [[value for row in picture[16:112] for value in row[part]] for part in (slice(92), slice(100, None))]
                self.assertEqual(max(dark), 0)
                self.assertGreater(sorted(lit)[len(lit) // 4], 0.01)  # beside the lamp's back and what is beyond the walls

    def test_edges_are_smooth(self):
        options = ("--resolution", "40x40", "--target-error", 0.03)
        area = pixels(self.picture(CORNELL_FILE, *options, "--supersample", 6))
        lit = range(10 * 40, len(area))  # below the lamp, which is most of the mean
        off = {}
        elements = ("--picture", "elements", "--method", "matrix", "--no-error-estimate", "--audit", 0)
        for given in ((), ("--supersample", 1), elements, (*elements, "--supersample", 1)):
            shown = pixels(self.picture(CORNELL_FILE, *(options if "matrix" not in given else options[:2]), *given))
            off[given] = (mean([(shown[k] - area[k]) ** 2 for k in lit]) ** 0.5 / mean([area[k] for k in lit]))
        smooth, stairs, smooth_elements, stairs_of_elements = off.values()
        self.assertLess(smooth, 0.06)
        self.assertGreater(stairs, 0.1)
        self.assertLess(smooth_elements, 0.7 * stairs_of_elements)

    def test_no_specks_where_light_is_noisy(self):
        """At the foot of the short box light goes to and fro across a crease, and its rays are noisy: 73 pixels differed there by a
        tenth from those around where the noise of all records decided who is gathered singly, 3 by that around each."""
        light = pixels(self.picture(CORNELL_FILE, "--resolution", "640x480", "--target-error", 0.02, "--audit", 0))
        self.assertGreater(self.report()["picture"]["single_pixels"], 100)
        specks = 0
        for y in range(323, 439):
            for x in range(317, 429):
                around = sorted(light[640 * (y + dy) + x + dx] for dy in (-1, 0, 1) for dx in (-1, 0, 1))
                specks += abs(light[640 * y + x] - around[4]) > 0.1 * around[4]
        self.assertLess(specks, 12)

    def test_the_error_of_rays_is_that_of_the_last_try(self):
        # Of few pixels the first records do not come to what is allowed; of fewer, none do.
        for resolution, is_finer in (("56x56", True), ("24x24", False)):
            with self.subTest(resolution=resolution):
                self.picture(CORNELL_FILE, "--resolution", resolution, "--target-error", 0.05)
                report = self.report()
                finer = report["picture"]["ray_error"] / report["hierarchy"]["chosen"]["ray_error"]
                self.assertEqual(report["picture"]["records"] > 0, is_finer)
                if is_finer:
                    self.assertGreaterEqual(finer, 0.6)
                    self.assertLess(finer, 0.8)
                else:
                    self.assertEqual(finer, 1)

    def test_a_signal_while_it_is_gathered(self):
        begin = time.monotonic()
        process = launch(["solve", CORNELL_FILE, "--method", "matrix", "--subdivision", "uniform", "--max-edge", 0.25,
                          "--resolution", "1024x1024", "--supersample", 1, "--picture", "gather", "--threads", 1, "--out", self.out])
        watched = self.out / "convergence.csv"
        self.wait_for(lambda: watched.exists() and "\ngathering the picture," in watched.read_text(), process)
        process.send_signal(signal.SIGUSR2)
        job = finish(process, begin)
        self.assert_done(job, code=75)
        self.assertTrue(any("a signal has ended the gathering" in line for line in job.warnings), job)
        self.assertEqual(self.written(), sorted(OUTPUTS))
        self.assertNotIn("picture", self.report())

    def test_a_pixel(self):
        for resolution in ("1x1", "3x1", "1x5"):
            picture = self.picture(CORNELL_FILE, "--resolution", resolution, "--target-error", 0.1)
            self.assertGreater(max(pixels(picture)), 0)


if __name__ == "__main__":
    unittest.main()
