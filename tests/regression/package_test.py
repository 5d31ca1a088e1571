"""The installed libraries: another project finds them, wherever they lie, and what it builds by them is right.

FLUXEL_BUILD names the build folder.
"""

import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

from fluxel_job import SCENES, JobTest, start

ROOT = SCENES.parent
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)


class PackageTest(JobTest):
    def run_cmake(self, *arguments):
        job = subprocess.run(["cmake", *map(str, arguments)], capture_output=True, text=True, check=False)
        self.assertEqual(job.returncode, 0, job.stdout + job.stderr)

    def setUp(self):
        super().setUp()
        first = self.work / "first"
        self.run_cmake("--install", os.environ["FLUXEL_BUILD"], "--prefix", first, "--component", "development")
        self.prefix = first.rename(self.work / "moved")

    def test_headers_include_what_is_installed(self):
        folder = self.prefix / "include/fluxel"
        headers = sorted(folder.rglob("*.hpp"))
        self.assertGreater(len(headers), 100)
        missing = [f"{header.relative_to(folder)}: {name}" for header in headers
                   for name in INCLUDE.findall(header.read_text()) if not (folder / name).is_file()]
        self.assertEqual(missing, [])

    def test_an_example_is_built_and_right(self):
        for file in self.prefix.rglob("*.cmake"):
            for folder in (ROOT, os.environ["FLUXEL_BUILD"], self.work, "/usr/"):
                self.assertNotIn(str(folder), file.read_text(), file)
        source = self.work / "example"
        shutil.copytree(ROOT / "examples/solve-a-box", source)
        build = self.work / "build"
        self.run_cmake("-S", source, "-B", build, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}",
                       "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror")
        self.run_cmake("--build", build)
        for method in ("hierarchical", "matrix"):
            for ranks in (1, 2):
                with self.subTest(method=method, ranks=ranks):
                    job = start([method], ranks, program=build / "solve-a-box")
                    self.assertEqual(job.code, 0, str(job))
                    said = re.fullmatch(r"mean radiosity (\S+) W/m2, exact (\S+) W/m2, estimated error (\S+) %\n", job.out)
                    self.assertTrue(said, str(job))
                    mean, exact, error = map(float, said.groups())
                    self.assertEqual(exact, 2)
                    self.assertAlmostEqual(mean, exact, delta=1e-4)
                    self.assertLess(error, 1)


if __name__ == "__main__":
    unittest.main()
