"""Pictures of what each round has come to: `--preview` with the hierarchical method."""

import re
import struct
import unittest

from fluxel_job import SCENES, JobTest
from result_files import read_exr

CORNELL_FILE = SCENES / "cornell-box" / "cornell-box.toml"


def png_size(file):
    """Width and height."""
    data = file.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", file
    return struct.unpack(">II", data[16:24])


class PreviewsTest(JobTest):
    method = ()

    def previews(self):
        return [name for name in self.written() if name.startswith("preview")]

    def test_one_a_round_and_the_same_result(self):
        for exchange in ("links", "rays"):
            with self.subTest(exchange):
                goal = ("--target-error", 0.03, "--resolution", "50x31", "--exchange", exchange)
                self.assert_done(self.solve(CORNELL_FILE, *goal, "--quiet", ranks=1))
                pixels, stated = read_exr(self.out / "image.exr"), self.report()["stated_error"]
                self.assertEqual(self.previews(), [])
                job = self.solve(CORNELL_FILE, *goal, "--preview", ranks=2)
                self.assert_done(job)
                rounds = len(self.report()["hierarchy"]["rounds"])
                self.assertEqual(self.previews(), [f"preview-{k + 1}.png" for k in range(rounds)])
                for name in self.previews():
                    self.assertEqual(png_size(self.out / name), (13, 8))
                self.assertTrue(read_exr(self.out / "image.exr") == pixels)
                self.assertEqual(self.report()["stated_error"], stated)
                # What is told of them: nothing yet of the first, then errors as the estimates have them.
                told = re.findall(r"preview: round (\d+), 13 x 8 pixels, its error is (.*): .*/(preview-\d+\.png)", job.out)
                self.assertEqual([name for _, _, name in told], self.previews())
                self.assertEqual(told[0][1], "not known yet")
                for (_, error, _), one in zip(told[1:], self.report()["hierarchy"]["rounds"][1:]):
                    percent = float(re.fullmatch(r"about ([\d.]+) %", error)[1])
                    self.assertGreaterEqual(percent * 1.05, 100 * one["discretisation"])
                # A run without them removes them; other files stay.
                (self.out / "preview-of-mine.png").write_bytes(b"mine")
                self.assert_done(self.solve(CORNELL_FILE, *goal, "--quiet"))
                self.assertEqual(self.previews(), ["preview-of-mine.png"])
                (self.out / "preview-of-mine.png").unlink()

    def test_of_an_earlier_run(self):
        goal = ("--block-error", 0.1, "--resolution", "8x8", "--preview", "--quiet")
        self.out.mkdir()
        for name in ("preview-9.png", "preview-4s.png"):
            (self.out / name).write_bytes(b"earlier")
        self.assert_done(self.solve(CORNELL_FILE, *goal))
        rounds = len(self.report()["hierarchy"]["rounds"])
        self.assertEqual(self.previews(), [f"preview-{k + 1}.png" for k in range(rounds)])

    def test_a_pixel_and_supersamples(self):
        self.assert_done(self.solve(CORNELL_FILE, "--block-error", 0.1, "--resolution", "1x5", "--supersample", 2,
                                    "--preview", "--quiet"))
        self.assertEqual(png_size(self.out / "preview-1.png"), (1, 2))

    def test_they_need_a_camera(self):
        self.assert_refused(self.solve(CORNELL_FILE.with_name("cornell-box.obj"), "--preview"), "--preview", "--eye")


if __name__ == "__main__":
    unittest.main()
