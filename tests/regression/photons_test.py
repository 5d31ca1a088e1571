"""`fluxel photons` as a command: what it writes, that it is the same for any ranks, that it goes on where it was."""

import json
import os
import re
import signal
import struct
import time
import unittest

from fluxel_job import MATRIX, SCENES, JobTest, finish, launch, ranks_of, start
from result_files import read_elements, read_exr
from rooms import MTL, ROOM

CORNELL = SCENES / "cornell-box" / "cornell-box.toml"
RECEIVER = """[[receivers]]
name = "desk"
origin = [0.1, 0.1, 0.5]
u = [0.8, 0, 0]
v = [0, 0.8, 0]
cells = [8, 8]
"""
ONE_SIDED = '[options]\nsides = "one"\n'


class PhotonsTest(JobTest):
    def photons(self, scene, *arguments, out=None, **settings):
        settings.setdefault("ranks", 1)
        return start(["photons", scene, *arguments, "--out", out or self.out], **settings)

    def room(self, materials="", receivers=RECEIVER, name="room"):
        self.write(f"{name}.obj", ROOM.replace("room.mtl", f"{name}.mtl"))
        self.write(f"{name}.mtl", MTL)
        return self.write(f"{name}.toml", f'[[geometry]]\nfile = "{name}.obj"\n{materials}\n{receivers}\n{ONE_SIDED}')

    def photon_report(self, out=None):
        return json.loads(((out or self.out) / "photons.json").read_text())

    def results(self, folder, kept=None):
        """The bytes of what must not depend on ranks; `kept`: the folder of the tally."""
        files = (folder / "photons.ply", folder / "receiver-desk.exr", (kept or folder) / "photons.tally")
        return {file.name: file.read_bytes() for file in files}

    # What it finds

    def test_furnace(self):
        scene = self.room("[materials.white]\nrho = 0.3\nmirror = 0.4\nE = 0.3\n[materials.light]\nE = 0.8\n")
        for sequence in ("sobol", "halton", "scrambled", "random"):
            with self.subTest(sequence=sequence):
                self.assert_done(self.photons(scene, "--sequence", sequence, "--photons", 1 << 18, "--max-edge", 0.5))
                elements = read_elements(self.out / "photons.ply")
                self.assertGreater(len(elements), 20)
                for element in elements:
                    self.assertAlmostEqual(element["irradiance"][1], 1, delta=0.03)
                    halves = [element[f"irradiance_half_{half}"][1] for half in "ab"]
                    self.assertAlmostEqual(sum(halves) / 2, element["irradiance"][1], delta=1e-3)
                    self.assertEqual("error" in element, sequence == "scrambled")
                cells = read_exr(self.out / "receiver-desk.exr")
                self.assertEqual("error.R" in cells, sequence in ("scrambled", "random"))
                mean = sum(map(sum, cells["R"])) / 64
                self.assertAlmostEqual(mean, 1, delta=0.01)

    def test_a_solve_and_photons_agree(self):
        solved = self.work / "solved"
        self.assert_done(start(["solve", *MATRIX, CORNELL, "--resolution", "64x64", "--out", solved], ranks=2))
        self.assert_done(self.photons(CORNELL, "--elements", solved / "solution.ply", "--photons", 4000000, ranks=2))
        job = start(["compare", solved / "solution.ply", self.out / "photons.ply"], ranks=1)
        self.assert_done(job)
        error = float(re.search(r"^error: ([0-9.]+) %", job.out, re.MULTILINE)[1])
        self.assertLess(error, 3)

    def test_what_the_report_says(self):
        self.assert_done(self.photons(self.room(), "--photons", 100000, "--sequence", "random", "--seed", 3))
        report = self.photon_report()
        self.assertEqual(report["photons"]["sent"], 100000)
        self.assertEqual(report["options"]["seed"], 3)
        energy = report["energy"]
        out = sum(sum(energy[name]) / 3 for name in ("absorbed_rgb", "escaped_rgb", "lost_rgb"))
        self.assertAlmostEqual(out / energy["emitted_mean"], 1, delta=1e-6)
        self.assertEqual(set(report["measured"]), {"elements", "receiver desk"})
        for measured in report["measured"].values():
            self.assertGreater(measured["received"], 1000)
            self.assertLess(measured["quadratic_error_rgb"][0], measured["relative_error_rgb"][0])
        self.assertTrue((self.out / "convergence.csv").read_text().count("\n") > 1)

    # How it ends

    def test_limits(self):
        scene = self.room()
        for arguments, ended, code in ((("--target-error", 0.02), "target", 0), (("--photons", 1000), "asked", 0),
                                       (("--received", 5000, "--target-of", "desk"), "desk", 0),
                                       (("--time", 1), "time", 0),
                                       (("--absolute-error", 0.05, "--target-of", "desk"), "target", 0),
                                       (("--target-error", 0.02, "--target-of", "receiver desk"), "target", 0),
                                       (("--target-error", 1e-6, "--photons", 300000), "asked", 3)):
            with self.subTest(arguments=arguments):
                job = self.photons(scene, *arguments)
                self.assert_done(job, code)
                self.assertIn(ended, self.photon_report()["photons"]["ended_by"])
                if code == 3:
                    self.assertIn("not reached", (self.out / "photons.ply").read_bytes()[:400].decode(errors="replace"))

    def test_photons_that_meet_nothing(self):
        self.write("away.obj", "mtllib away.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl light\nf 1 2 3 4\n")
        self.write("away.mtl", MTL)
        job = self.photons(self.work / "away.obj", "--sides", "one", "--photons", 1000)
        self.assert_done(job, 3)
        self.assertTrue(any("no photon has met" in warning for warning in job.warnings), str(job))

    def test_glass_on_a_surface_is_noted(self):
        glass = self.BOX.replace("white", "glass")
        self.room("", "", "glass")
        self.write("glass.obj", ROOM.replace("room.mtl", "glass.mtl") + glass.format(0.1, 0.4).replace(" 0.2\n", " 0\n"))
        self.write("glass.mtl", MTL + "newmtl glass\nKd 0 0 0\n")
        (self.work / "glass.toml").write_text('[[geometry]]\nfile = "glass.obj"\n[materials.glass]\nrefraction_index = 1.5\n')
        job = self.photons(self.work / "glass.toml", "--photons", 1000)
        self.assert_done(job)
        self.assertIn("faces of clear bodies lie on other surfaces", job.out)

    # The same for any ranks, and after an end

    def test_same_for_any_ranks_and_threads(self):
        scene = self.room("[materials.white]\nmirror = 0.2\n")
        expected = None
        for ranks, threads in ((1, 1), (1, 2), (2, 1), (3, 2), (7, 1)):
            for sequence in ("sobol", "scrambled"):
                out = self.work / f"{sequence}-{ranks}-{threads}"
                self.assert_done(self.photons(scene, "--photons", 300001, "--sequence", sequence, "--threads", threads,
                                              "--max-edge", 0.3, out=out, ranks=ranks))
            found = [self.results(self.work / f"{sequence}-{ranks}-{threads}") for sequence in ("sobol", "scrambled")]
            expected = expected or found
            self.assertEqual(found, expected, f"{ranks} ranks, {threads} threads")

    def test_going_on(self):
        scene = self.room()
        whole, part = self.work / "whole", self.work / "part"
        self.assert_done(self.photons(scene, "--photons", 500000, out=whole))
        self.assert_done(self.photons(scene, "--photons", 200000, out=part))
        self.assert_done(self.photons(scene, "--photons", 500000, "--resume", out=part, ranks=3))
        self.assertEqual(self.results(part), self.results(whole))
        self.assertEqual(self.photon_report(part)["photons"]["restored"], 200000)

    def test_a_signal_and_going_on(self):
        scene = self.room()
        whole, part = self.work / "whole", self.work / "part"
        begin = time.monotonic()
        process = launch(["photons", scene, "--photons", 1 << 26, "--out", part], ranks=2)
        self.wait_for(lambda: len(ranks_of(process)) == 2, process)
        self.wait_for_work(process, 2)
        os.kill(ranks_of(process)[1], signal.SIGUSR2)  # one rank alone
        job = finish(process, begin)
        self.assert_done(job, 75)
        sent = self.photon_report(part)["photons"]["sent"]
        self.assertLess(sent, 1 << 26)
        more = sent + 100000
        self.assert_done(self.photons(scene, "--photons", more, "--resume", out=part))
        self.assert_done(self.photons(scene, "--photons", more, out=whole))
        self.assertEqual(self.results(part), self.results(whole))

    def test_a_kept_tally_survives_a_kill(self):
        scene = self.room()
        whole, part, kept = self.work / "whole", self.work / "part", self.work / "kept"
        for more in (("--checkpoint-every", 0.2), ()):
            with self.subTest(more):
                tally = kept / "photons.tally"
                tally.unlink(missing_ok=True)
                process = launch(["photons", scene, "--photons", 1 << 28, "--checkpoint", kept, *more, "--threads", 1,
                                  "--out", part], ranks=2)
                self.wait_for(lambda: len(ranks_of(process)) == 2, process)
                if not more:
                    self.wait_for_work(process, 2)
                    self.assertFalse(tally.exists())
                    os.kill(ranks_of(process)[1], signal.SIGUSR1)
                self.wait_for(tally.exists, process)
                os.kill(ranks_of(process)[1], signal.SIGKILL)
                self.assertEqual(finish(process, time.monotonic()).code, 137)
                sent = struct.unpack_from("<Q", tally.read_bytes(), 32)[0]
                self.assertGreater(sent, 0)
                going_on = ("--photons", sent + 100000, "--checkpoint", kept, "--resume")
                self.assert_done(self.photons(scene, *going_on, out=part, ranks=3))
                self.assertEqual(self.photon_report(part)["photons"]["restored"], sent)
                self.assert_done(self.photons(scene, "--photons", sent + 100000, out=whole))
                self.assertEqual(self.results(part, kept), self.results(whole))

    # After a change

    BOX = """v {0} 0.3 0.2\nv {1} 0.3 0.2\nv {1} 0.7 0.2\nv {0} 0.7 0.2\nv {0} 0.3 0.6\nv {1} 0.3 0.6\nv {1} 0.7 0.6\nv {0} 0.7 0.6
usemtl white\nf 9 12 11 10\nf 9 10 14 13\nf 10 11 15 14\nf 11 12 16 15\nf 12 9 13 16\nf 13 14 15 16\n"""

    def furnished(self, name, low, materials="", receivers=RECEIVER, more=""):
        scene = self.room(materials, receivers, name)
        self.write(f"{name}.obj", ROOM.replace("room.mtl", f"{name}.mtl") + self.BOX.format(low, low + 0.25) + more)
        return scene

    RENEWED = ("--sequence", "halton", "--max-edge", 0.2)

    def test_renewal_ends_with_the_new_scene(self):
        before, after = self.furnished("before", 0.1), self.furnished("after", 0.5)
        fresh, kept = self.work / "fresh", self.work / "kept"
        self.assert_done(self.photons(after, *self.RENEWED, "--photons", 300000, out=fresh, ranks=2))
        for ranks in (1, 3):
            self.assert_done(self.photons(before, *self.RENEWED, "--photons", 300000, out=kept))
            self.assert_done(self.photons(after, *self.RENEWED, "--resume", "--changed-from", before, out=kept, ranks=ranks))
            self.assertEqual(self.results(kept), self.results(fresh))
        renewal = self.photon_report(kept)["renewal"]
        self.assertTrue(renewal["complete"])
        changed = renewal["turns"][-1]["changed"]
        self.assertGreater(changed, 30000)
        self.assertLess(changed, 250000)
        # It goes on as any other tally.
        for folder in (kept, fresh):
            self.assert_done(self.photons(after, *self.RENEWED, "--photons", 400000, "--resume", out=folder))
        self.assertEqual(self.results(kept), self.results(fresh))

    def test_an_early_end_of_a_renewal(self):
        before, after = self.furnished("before", 0.1), self.furnished("after", 0.5)
        self.assert_done(self.photons(before, *self.RENEWED, "--photons", 300000))
        tally = (self.out / "photons.tally").read_bytes()
        job = self.photons(after, *self.RENEWED, "--resume", "--changed-from", before, "--photons", 60000)
        self.assert_done(job, 3)
        self.assertTrue(any("still bring the light of the scene before" in line for line in job.warnings), str(job))
        self.assertEqual((self.out / "photons.tally").read_bytes(), tally)
        renewal = self.photon_report()["renewal"]
        self.assertFalse(renewal["complete"])
        first, last = renewal["turns"][0], renewal["turns"][-1]
        share = (last["changed"] - first["changed"]) / (last["renewed"] - first["renewed"])
        self.assertGreater(share, 1.5 * first["changed"] / first["renewed"], "groups of most change come first")

    def test_what_is_shown_within_a_renewal(self):
        before, after = self.furnished("before", 0.1), self.furnished("after", 0.5)
        self.assert_done(self.photons(before, *self.RENEWED, "--photons", 4000000))
        tally, shown = self.out / "photons.tally", self.out / "photons.ply"
        kept = tally.read_bytes()
        shown.unlink()
        begin = time.monotonic()
        process = launch(["photons", after, *self.RENEWED, "--resume", "--changed-from", before, "--threads", 1, "--out", self.out],
                         ranks=2)
        self.wait_for(lambda: len(ranks_of(process)) == 2, process)
        self.wait_for_work(process, 1)
        os.kill(ranks_of(process)[1], signal.SIGUSR1)
        self.wait_for(shown.exists, process)
        self.assertIn(b"not all photons have gone again", shown.read_bytes()[:400])
        os.kill(ranks_of(process)[0], signal.SIGUSR2)
        self.assert_done(finish(process, begin), 75)
        self.assertIn(b"not all photons have gone again", shown.read_bytes()[:400])
        self.assertEqual(tally.read_bytes(), kept)

    def test_changes_that_are_refused(self):
        before = self.furnished("before", 0.1)
        kept = self.work / "kept"
        self.assert_done(self.photons(before, *self.RENEWED, "--photons", 10000, out=kept))
        renew = ("--resume", "--checkpoint", kept, "--changed-from", before)
        refused = lambda scene, *texts, more=self.RENEWED: self.assert_refused(self.photons(scene, *renew, *more), *texts)
        refused(self.furnished("brighter", 0.1, "[materials.light]\nE = 3\n"), "what emits light has changed")
        refused(self.furnished("larger", 0.1, more="v 3 0 0\nv 4 0 0\nv 4 1 0\nf 17 18 19\n"), "the box around the scene")
        refused(self.furnished("lux", 0.1).parent / self.units("lux").name, "other units")
        refused(self.furnished("unmeasured", 0.1, receivers=""), "other receivers")
        self.write("nothing.obj", "mtllib before.mtl\nv 0 0 0\nv 1 1 0\nv 1 0 1\nusemtl light\nf 1 2 3\n")
        refused(self.work / "nothing.obj", "no surface in common")
        after = self.furnished("after", 0.5)
        refused(after, "--sequence halton", more=("--max-edge", 0.2))
        refused(after, "--photons", more=(*self.RENEWED, "--target-error", 0.01))
        refused(after, "another scene", more=("--sequence", "halton", "--max-edge", 0.1))
        self.assert_refused(self.photons(after, *self.RENEWED, "--changed-from", before), "--resume")
        self.assert_refused(self.photons(after, *self.RENEWED, "--resume", "--changed-from", before), "no tally")
        self.assert_refused(self.photons(after, *self.RENEWED, "--groups", 10), "--groups")
        refused(after, "--groups 1000000000000", more=(*self.RENEWED, "--groups", "1e12"))
        # And options without effect there are said.
        job = self.photons(after, *renew, *self.RENEWED, "--target-of", "desk", "--checkpoint-every", 5, out=self.work / "done")
        self.assert_done(job)
        for idle in ("--target-of", "--checkpoint-every"):
            self.assertTrue(any(f"{idle} has no effect" in line for line in job.warnings), str(job))
        refused(after, "one that has been renewed goes on without --changed-from")

    def units(self, name):
        file = self.work / f"{name}.toml"
        file.write_text('units = "photometric"\n' + file.read_text())
        return file

    # What is refused

    def test_refused(self):
        scene = self.room()
        tally = self.out / "photons.tally"
        other = self.room("[materials.white]\nrho = 0.4\n", name="other")
        self.assert_refused(self.photons(scene, "--resume"), "no tally", "--resume")
        self.assert_refused(self.photons(scene, "--photons", "1e13"), "62 bits")
        self.assert_refused(self.photons(scene, "--photons", "1e11", "--sequence", "scrambled"), "scrambled")
        self.assert_refused(self.photons(scene, "--target-of", "desks"), "--target-of desks", "elements, desk")
        self.assert_refused(self.photons(scene, "--sequence", "niederreiter"), "sobol")
        self.assert_refused(self.photons(scene, "--only", "receivers", "--target-of", "elements"), "known: desk")
        solved = self.work / "solved"
        self.assert_done(start(["solve", *MATRIX, CORNELL, "--resolution", "8x8", "--out", solved], ranks=1))
        self.assert_refused(self.photons(scene, "--elements", solved / "solution.ply"), file=solved / "solution.ply")
        kept = self.work / "kept"
        self.assert_done(self.photons(scene, "--photons", 1000, out=kept))
        tally = kept / "photons.tally"
        going_on = ("--resume", "--checkpoint", kept)
        self.assert_refused(self.photons(other, *going_on), "another scene", file=tally)
        self.assert_refused(self.photons(scene, *going_on, "--max-edge", 0.2), "other elements", file=tally)
        self.assert_refused(self.photons(scene, *going_on, "--sequence", "halton"), "--sequence", file=tally)
        seeded = ("--sequence", "random", "--photons", 1000)
        self.assert_done(self.photons(scene, *seeded, "--seed", 2, out=self.work / "seeded"))
        self.assert_refused(self.photons(scene, *seeded, "--seed", 3, "--resume", "--checkpoint", self.work / "seeded"),
                            "another --seed", file=self.work / "seeded/photons.tally")
        data = tally.read_bytes()
        tally.write_bytes(data[:-5])
        self.assert_refused(self.photons(scene, *going_on), "damaged", file=tally)
        tally.write_bytes(b"something else that is long enough to have had a header of a tally of photons")
        self.assert_refused(self.photons(scene, *going_on), "no tally", file=tally)
        tally.unlink()
        tally.mkdir()
        self.assert_refused(self.photons(scene, *going_on), "cannot be read", file=tally)

    def test_heat_that_is_drawn(self):
        heat = "[materials.white]\nemissivity = 0.5\ntemperature = 300\n[materials.light]\nemissivity = 0.5\nheat_flux = -10\n"
        job = self.photons(self.room(heat, ""), "--thermal")
        self.assert_refused(job, "'light' draws heat")


if __name__ == "__main__":
    unittest.main()
