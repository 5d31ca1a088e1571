"""Where the pixels of a picture have their light from: `--picture cached | gather | elements`."""

import unittest

from fluxel_job import SCENES, JobTest
from reference_files import read_exr
from rays_test import box, mean, pixels

CORNELL_FILE = SCENES / "cornell-box" / "cornell-box.toml"


class PicturesTest(JobTest):
    method = ()

    def picture(self, scene, *arguments, **settings):
        self.assert_done(self.solve(scene, *arguments, "--quiet", **settings))
        return read_exr(self.out / "image.exr")

    def test_records_instead_of_pixels(self):
        for exchange in ("links", "rays"):
            with self.subTest(exchange=exchange):
                options = ("--resolution", "96x96", "--target-error", 0.02, "--exchange", exchange)
                each = pixels(self.picture(CORNELL_FILE, *options, "--picture", "gather"))
                gathered = self.report()["hierarchy"]
                self.assertEqual((gathered["records"], gathered["single_pixels"]), (0, 0))
                few = pixels(self.picture(CORNELL_FILE, *options))
                report = self.report()
                cached = report["hierarchy"]
                self.assertEqual(report["options"]["picture"], "cached")
                self.assertGreater(cached["records"], 300)
                self.assertLess(cached["records"] + cached["single_pixels"], 0.4 * len(few))
                # Both are off by no more than they say, and by errors of their own.
                off = mean([(a - b) ** 2 for a, b in zip(few, each)]) ** 0.5 / mean(each)
                self.assertLess(off, 2 * report["stated_error"])
                self.assertGreater(cached["errors"]["picture"], 0)
                self.assertLess(cached["errors"]["picture"], 1.2 * cached["errors"]["rays"])
                self.assertLess(abs(mean(few) / mean(each) - 1), 0.003)

    def test_elements_are_as_they_were_solved(self):
        coarse = ("--resolution", "32x32", "--block-error", 0.05)
        picture = pixels(self.picture(CORNELL_FILE, *coarse, "--picture", "elements"))
        self.assertEqual(self.report()["hierarchy"]["records"], 0)
        # Few leaves, each of one colour.
        self.assertLess(len(set(picture)), 0.5 * len(picture))

    def test_ranks_and_threads(self):
        for exchange in ("links", "rays"):
            options = ("--resolution", "40x30", "--target-error", 0.03, "--exchange", exchange)
            first = self.picture(CORNELL_FILE, *options, ranks=1)
            records = self.report()["hierarchy"]["records"]
            self.assertGreater(records, 50)
            for ranks, threads in ((1, 2), (2, 1), (3, 1), (7, 1)):
                with self.subTest(exchange=exchange, ranks=ranks, threads=threads):
                    other = self.picture(CORNELL_FILE, *options, "--threads", threads, ranks=ranks)
                    self.assertTrue(other == first)
                    self.assertEqual(self.report()["hierarchy"]["records"], records)

    def test_nothing_leaks_from_room_to_room(self):
        # Two rooms under one roof, the wall between them a sheet on a floor that goes through; a lamp in one.
        self.write("two.mtl", "newmtl white\nKd 0.7 0.7 0.7\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n")
        scene = self.write("two.obj", "\n".join([
            "mtllib two.mtl", "usemtl white", "g room", *box((0, 0, 0), (4, 2, 2)),
            "g wall", "v 2 0 0", "v 2 2 0", "v 2 2 2", "v 2 0 2", "f -4 -3 -2 -1",
            "usemtl lamp", "g lamp", "v 2.5 0.5 1.9", "v 2.5 1 1.9", "v 3 1 1.9", "v 3 0.5 1.9", "f -4 -3 -2 -1", ""]))
        for exchange in ("links", "rays"):
            with self.subTest(exchange=exchange):
                dark = ("--eye", "0.1,1,1", "--look-at", "2,1,0.6", "--up", "0,0,1", "--fov", 80)
                picture = self.picture(scene, *dark, "--resolution", "48x48", "--sides", "two", "--exchange", exchange)
                self.assertEqual(max(pixels(picture)), 0)
                # From above, through a roof that is seen from outside as nothing: both at once.
                lit = ("--eye", "3.9,1,1", "--look-at", "2,1,0.6", "--up", "0,0,1", "--fov", 80)
                picture = self.picture(scene, *lit, "--resolution", "48x48", "--sides", "two", "--exchange", exchange,
                                       "--target-error", 0.05)
                self.assertGreater(min(pixels(picture)), 0.01)

    def test_a_pixel(self):
        for resolution in ("1x1", "3x1", "1x5"):
            picture = self.picture(CORNELL_FILE, "--resolution", resolution, "--target-error", 0.1)
            self.assertGreater(max(pixels(picture)), 0)


if __name__ == "__main__":
    unittest.main()
