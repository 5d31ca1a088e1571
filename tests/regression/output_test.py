"""Where output goes: folders that cannot be used, full disks, memory that is not there."""

import os
import subprocess
import time
import unittest

from fluxel_job import MATRIX, OUTPUTS, SCENES, JobTest, finish, launch, start
from rooms import INSIDE, MTL, ROOM, SMALL

CORNELL = SCENES / "cornell-box" / "cornell-box.toml"


class OutputTest(JobTest):
    def setUp(self):
        super().setUp()
        self.write("room.mtl", MTL)
        self.room = self.write("room.obj", ROOM)

    def refuse_folder(self, folder, *texts):
        job = start(["solve", *MATRIX, self.room, *INSIDE, *SMALL, "--out", folder])
        self.assert_refused(job, *texts)
        self.assertIn(str(folder), job.said[0])

    # What is read is never replaced

    def refuse_to_replace(self, input, arguments, ranks=2):
        """Ended with 2 before anything was written; the message names the output."""
        before = {file: file.read_bytes() for file in self.work.rglob("*") if file.is_file()}
        job = start(arguments, ranks=ranks)
        self.assertEqual(job.code, 2, str(job))
        self.assertEqual(len(job.said), 1, str(job))
        for text in ("would be replaced", str(input), "--out"):
            self.assertIn(text, job.said[0])
        self.assertEqual({file: file.read_bytes() for file in self.work.rglob("*") if file.is_file()}, before)

    def test_a_table_in_the_place_of_the_scene(self):
        for link in ("symlink_to", "hardlink_to"):
            with self.subTest(link=link):
                folder = self.work / link
                folder.mkdir()
                getattr(folder / "view-factors.csv", link)(self.room)
                self.refuse_to_replace(self.room, ["viewfactors", self.room, "--out", folder])
                self.refuse_to_replace(self.room, ["viewfactors", self.room, "--out", os.path.relpath(folder)])

    def test_materials_in_the_place_of_an_output(self):
        for name, command in (("report.json", "solve"), ("image.exr", "solve"), ("reference.json", "reference"), ("view-factors.csv", "viewfactors"),
                              ("strips-1.fxs", "solve")):
            with self.subTest(name=name, command=command):
                materials = self.write(name, MTL)
                scene = self.write("named.obj", ROOM.replace("room.mtl", name))
                keep = ("--checkpoint", self.work) if command == "solve" else ()
                camera = () if command == "viewfactors" else (*INSIDE, *SMALL)
                self.refuse_to_replace(materials, [command, scene, *camera, *keep, "--out", self.work])

    def test_what_is_compared_or_measured(self):
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL))
        for name, origin in (("error.ply", "solution.ply"), ("error.exr", "image.exr")):
            judged = self.out / name
            (self.out / origin).rename(judged)
            for pair in ((judged, judged), (judged, self.out / origin), (self.out / origin, judged)):
                with self.subTest(pair=pair):
                    self.refuse_to_replace(judged, ["compare", *pair, "--out", self.out])
            judged.rename(self.out / origin)
        elements = self.out / "reference.ply"
        (self.out / "solution.ply").rename(elements)
        self.refuse_to_replace(elements, ["reference", self.room, "--elements", elements, "--out", self.out])

    def test_a_warm_start_that_has_been_read_may_be_replaced(self):
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL))
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL, "--warm-start", self.out / "solution.ply"))

    # Folders

    def test_jobs_started_together_share_a_folder(self):
        for _ in range(3):
            arguments = ["solve", self.room, *INSIDE, *SMALL, "--threads", 1, "--out", self.out]
            processes = [launch(arguments, ranks=1) for _ in range(4)]
            for job in [finish(process, time.monotonic()) for process in processes]:
                self.assert_done(job)
            self.assertEqual(self.written(), sorted(OUTPUTS))

    def test_a_new_folder_is_made_with_its_parents(self):
        self.out = self.work / "a" / "b c" / "d"
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL))
        self.assertEqual(self.written(), sorted(OUTPUTS))

    def test_a_file_in_the_way(self):
        self.refuse_folder(self.write("taken", "mine"))
        self.assertEqual((self.work / "taken").read_text(), "mine")
        self.refuse_folder(self.work / "taken" / "below")

    def test_a_folder_that_cannot_be_made(self):
        self.refuse_folder("/proc/nope")

    def test_a_folder_that_cannot_be_written_to(self):
        self.refuse_folder("/proc/self" if os.geteuid() == 0 else "/usr")

    def test_a_failed_run_leaves_the_last_one_alone(self):
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL))
        before = {name: (self.out / name).read_bytes() for name in OUTPUTS}
        self.assertEqual(self.solve(self.room, *INSIDE, *SMALL, "--up", "0,1,0").code, 2)
        (self.work / "room.mtl").write_text(MTL.replace("Ke 1 1 1", "Ke 0 0 0"))
        self.assertEqual(self.solve(self.room, *INSIDE, *SMALL).code, 2)
        self.assertEqual({name: (self.out / name).read_bytes() for name in OUTPUTS}, before)

    def test_a_second_run_replaces_the_first(self):
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL))
        self.assert_done(self.solve(self.room, *INSIDE, "--resolution", "20x20"))
        self.assertEqual(self.written(), sorted(OUTPUTS))
        self.assertEqual(self.report()["options"]["resolution"], [20, 20])

    def test_a_folder_in_the_place_of_a_file(self):
        for name in OUTPUTS:
            with self.subTest(name):
                self.out = self.work / f"out-{name}"
                (self.out / name).mkdir(parents=True)
                job = self.solve(self.room, *INSIDE, *SMALL)
                self.assertEqual(job.code, 2, str(job))
                self.assertEqual(len(job.said), 1, str(job))
                self.assertIn(str(self.out / name), job.said[0])
                self.assertIn("folder", job.said[0])
                self.assertEqual(self.written(), [name], "nothing was computed")

    def test_files_of_an_earlier_run_go(self):
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL))
        self.assert_done(self.solve(self.room, "--subdivision", "none"))
        self.assertEqual(self.written(), ["convergence.csv", "report.html", "report.json", "solution.ply"])

    def test_early_pictures_stay_where_no_new_ones_are_made(self):
        self.out.mkdir()
        early = self.out / "preview-1s.png"
        early.write_bytes(b"earlier")
        self.write("bad.obj", "f 1 2 3\n")
        self.assertEqual(self.solve(self.work / "bad.obj", *INSIDE, *SMALL, "--preview").code, 2)
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL, "--preview", "--dry-run"))
        self.assertEqual(early.read_bytes(), b"earlier")
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL, "--preview"))
        self.assertFalse(early.exists() and early.read_bytes() == b"earlier", "it is of another run")

    def test_a_dry_run_removes_nothing_and_says_so(self):
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL))
        before = {name: (self.out / name).read_bytes() for name in OUTPUTS if not name.startswith("report.")}
        job = self.solve(self.room, *INSIDE, *SMALL, "--dry-run")
        self.assert_done(job)
        self.assertEqual({name: (self.out / name).read_bytes() for name in before}, before)
        for name in before:
            self.assertEqual(sum(name in line for line in job.warnings), 1, str(job))

    # A full disk

    def mount(self, kilobytes):
        disk = self.work / f"disk{kilobytes}"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "tmpfs", disk],
                                 stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if mounted.returncode != 0:
            self.skipTest(f"only root can mount a small disk: {mounted.stderr.strip()}")
        self.addCleanup(subprocess.run, ["umount", disk], check=True)
        return disk

    def test_a_full_disk(self):
        resolution = ("--resolution", "32x32")
        self.assert_done(self.solve(self.room, *INSIDE, *resolution))
        whole = {name: (self.out / name).stat().st_size for name in OUTPUTS}
        pages = {name: (size + 4095) // 4096 * 4 for name, size in whole.items()}  # kB on a tmpfs
        # Room for nothing, for the first picture, for both, and for all but the report.
        room_for = ("image.exr", "image.png", "solution.ply")
        kilobytes = [4, *(sum(pages[name] for name in room_for[:count]) for count in (1, 2, 3))]
        for size in kilobytes:
            with self.subTest(f"{size} kB"):
                self.out = self.mount(size)
                job = self.solve(self.room, *INSIDE, *resolution)
                self.assertEqual(job.code, 2, str(job))
                self.assertEqual(len(job.said), 1, str(job))
                self.assertIn("No space left on device", job.said[0])
                self.assertIn(str(self.out), job.said[0])
                self.assertLess(job.seconds, 10)
                for name in self.written():  # what stands under its final name is whole
                    self.assertEqual((self.out / name).stat().st_size, whole.get(name), name)
                self.assertNotIn("report.html", "report.json", self.written())

    def test_a_full_disk_keeps_the_last_run(self):
        self.out = self.mount(4 * len(OUTPUTS) + 4)  # a page for each old file, and one that is left
        for name in OUTPUTS:
            (self.out / name).write_text("the last run's")
        self.assertEqual(self.solve(self.room, *INSIDE, "--resolution", "32x32").code, 2)
        self.assertEqual(self.written(), sorted(OUTPUTS))
        for name in OUTPUTS:
            self.assertEqual((self.out / name).read_text(), "the last run's", name)

    # Memory: refused by all ranks together before it is taken. The limits keep a defect from taking the machine's.

    def test_more_memory_needed_than_there_is(self):
        job = self.solve(CORNELL, "--resolution", "60000x60000", "--quiet", address_space_kb=3_000_000, limit=20)
        self.assert_refused(job, "not enough memory")

    def test_more_memory_needed_than_ranks_may_have(self):
        job = self.solve(CORNELL, "--resolution", "1024x1024", "--quiet", address_space_kb=1_000_000, limit=20)
        self.assert_refused(job, "not enough memory")

    def test_too_many_elements_without_a_camera(self):
        job = self.solve(CORNELL, "--subdivision", "uniform", "--max-edge", "1e-5", "--quiet",
                         address_space_kb=3_000_000, limit=20)
        self.assert_refused(job, "not enough memory")

    def test_too_many_elements_of_a_needle(self):
        # Ten kilometres by a micron: 10^4 squares of 1 mm in area, but 10^7 of them side by side.
        needle = "v 0 0 0\nv 1e4 0 0\nv 1e4 1e-6 0\nv 0 1e-6 0\nusemtl light\nf 1 2 3 4\n"
        scene = self.write("needle.obj", "mtllib room.mtl\n" + needle)
        job = self.solve(scene, "--subdivision", "uniform", "--max-edge", "1e-3", "--quiet", "--dry-run", ranks=1,
                         address_space_kb=3_000_000, limit=20)
        self.assert_refused(job, "not enough memory: the visibility of the elements")


if __name__ == "__main__":
    unittest.main()
