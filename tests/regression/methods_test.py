"""Every option meets every method: it is meant, or it ends the run with a sentence that names who knows it."""

import re
import unittest

from fluxel_job import JobTest, option_key, start
from rooms import INSIDE, MTL, ROOM

METHODS = ("hierarchical", "matrix")
# Options that any method takes, with a value each (None: a flag).
COMMON = {"help": None, "help-all": None, "method": None, "out": None, "threads": 1, "isa": "auto", "quiet": None, "live": None,
          "sides": "one", "ke": "radiance", "metres-per-unit": 1, "textures": "face", "specular": "absorb", "thermal": None, "no-cut": None, "keep-polygons": None, "camera": "desk", "eye": "1,1,1",
          "look-at": "2,1,1", "up": "0,0,1", "fov": 60, "resolution": "8x8", "exposure": 0, "tone": "linear", "supersample": 1,
          "filter": "median:1", "write": "vtu", "mesh-max-edge": 0.5, "lightmap-texel": 0.2,
          "false-colour-max": 500, "false-colour-decades": 2, "maintenance-factor": 0.8}
# Of methods that know them, with a value each.
OWN = {"target-error": ("hierarchical", 0.1), "block-error": ("hierarchical", 0.1), "oracle": ("hierarchical", "all"), "exchange": ("hierarchical", "links"), 
       "picture": ("hierarchical matrix", "gather"),
       "audit": ("hierarchical matrix", 0.2), "error-of": ("hierarchical matrix", "regions"),
       "memory": ("hierarchical", "1G"), "time": ("hierarchical", 9),
       "subdivision": ("hierarchical matrix", "camera"), "max-edge": ("hierarchical matrix", 1),
       "subscenes": ("hierarchical matrix", "merged"), "solver": ("hierarchical matrix", "cg"),
       "tolerance": ("hierarchical matrix", 1e-3), "max-iterations": ("hierarchical matrix", 9),
       "checkpoint": ("hierarchical matrix", "kept"), "keep-links": ("hierarchical", None), "resume": ("hierarchical matrix", None),
       "form-factor": ("matrix", "disc"), "form-factor-tolerance": ("matrix", 1e-2),
       "no-partial-visibility": ("matrix", None), "closure": ("matrix", None), "warm-start": ("matrix", "a.ply"),
       "preview": ("hierarchical matrix", None), "no-error-estimate": ("matrix", None), "checkpoint-every": ("matrix", 9),
       "visibility-only": ("matrix", None), "reuse-visibility": ("matrix", "kept"), "device": ("matrix", "auto"),
       "verify-device": ("matrix", 0.1), "trace-every-pair": ("matrix", None), "timeline": ("matrix", None),
       "dry-run": ("hierarchical matrix", None)}
# What else an option asks for.
NEEDS = {"resume": ["--checkpoint", "kept"], "visibility-only": ["--checkpoint", "kept"],
         "max-edge": ["--subdivision", "camera"]}
EACH = {**COMMON, **{name: value for name, (_, value) in OWN.items()}}


class MethodsTest(JobTest):
    method = ()

    def setUp(self):
        super().setUp()
        self.write("room.mtl", MTL)
        self.write("room.obj", ROOM)
        self.room = self.write("room.toml", '[[geometry]]\nfile = "room.obj"\n[[camera]]\nname = "desk"\n')
        # Where no folder can be made a run ends after its options were checked.
        self.blocked = self.write("a-file", "") / "out"

    def given(self, method, name):
        value = EACH[name]
        option = [f"--{name}"] if value is None else [f"--{name}", value]
        job = start(["solve", self.room, *INSIDE, "--method", method, *NEEDS.get(name, []), *option,
                     "--out", self.blocked], ranks=1)
        self.assertEqual(job.code, 2, job)
        self.assertEqual(len(job.said), 1, job)
        return job.said[0]

    def test_all_options_are_known_here(self):
        job = start(["solve", "--help-all"], ranks=1)
        shown = set(re.findall(r"--([a-z][a-z-]*)", "\n".join(
            line.split("  ")[1] for line in job.out.splitlines() if re.match(r"  -", line))))
        self.assertEqual(shown, set(EACH), "a new option has to say here which methods know it")

    def test_an_option_of_another_method_is_refused_by_name(self):
        for name, (knowing, _) in OWN.items():
            for method in METHODS:
                if method in knowing.split():
                    continue
                with self.subTest(option=name, method=method):
                    said = self.given(method, name)
                    self.assertIn(f"--method {method} knows no --{name}", said)
                    self.assertIn(f"--method {knowing}", said)

    def test_a_value_that_a_method_refuses(self):
        for method, option, value, text in (
                ("hierarchical", "solver", "gauss-seidel", "knows no --solver gauss-seidel"),
                ("hierarchical", "tolerance", "auto:0.2", "knows no --tolerance auto:SHARE"),
                ("matrix", "subdivision", "transport", "--method hierarchical has made")):
            with self.subTest(method=method, option=option):
                job = start(["solve", self.room, *INSIDE, "--method", method, f"--{option}", value, "--out", self.out], ranks=1)
                self.assert_refused(job, text)
                scene = self.write("other.toml", f'[[geometry]]\nfile = "room.obj"\n[options]\n{option} = "{value}"\n')
                job = start(["solve", scene, *INSIDE, "--method", method, "--out", self.blocked], ranks=1)
                self.assertIn("a-file" if option != "tolerance" else text, job.said[0], "of a scene file it is left out")

    def test_an_option_that_a_method_knows_is_taken(self):
        for name in EACH:
            for method in METHODS:
                if name in ("help", "help-all", "out", "method", "metres-per-unit") or name in OWN and method not in OWN[name][0].split():
                    continue
                with self.subTest(option=name, method=method):
                    self.assertIn("a-file", self.given(method, name), "nothing but the folder is refused")

    def test_a_scene_files_options_of_another_method_are_said(self):
        scene = self.write("other.toml", '[[geometry]]\nfile = "room.obj"\n[options]\nform-factor = "disc"\nsides = "one"\n')
        job = self.solve(scene, *INSIDE, "--target-error", 0.3, "--resolution", "8x8")
        self.assert_done(job)
        self.assertTrue(any("form-factor" in line for line in job.warnings), job)
        options = self.report()["options"]
        self.assertNotIn("form_factor", options)
        self.assertEqual(options["method"], "hierarchical")

    def test_the_command_line_comes_before_what_excludes_it_in_a_scene_file(self):
        for of_scene, given, warning in (
                ("target-error = 0.1", ("--block-error", 0.1), None), ("block-error = 0.1", ("--target-error", 0.3), None),
                ('method = "matrix"\nmax-edge = 0.5\nsubdivision = "uniform"', ("--subdivision", "none"), None),
                ('method = "matrix"', ("--target-error", 0.3), "takes the place of the scene file's matrix")):
            with self.subTest(of_scene=of_scene, given=given):
                scene = self.write("other.toml", f'[[geometry]]\nfile = "room.obj"\n[options]\n{of_scene}\n')
                job = self.solve(scene, *given)
                self.assert_done(job)
                self.assertIn(option_key(given[0]), self.report()["options"])
                self.assertEqual(any("takes the place" in line for line in job.warnings), warning is not None, job)

    def test_options_that_exclude_each_other(self):
        for method, options, text in (("matrix", ("--trace-every-pair", "--device", "auto"), "leave out --device"),
                                      ("hierarchical", ("--oracle", "importance"), "give a camera")):
            with self.subTest(options=options):
                self.assert_refused(self.solve(self.room, "--method", method, "--subdivision", "none", *options), text)

    def test_the_report_holds_what_was_in_force(self):
        job = self.solve(self.room, *INSIDE, "--target-error", 0.3, "--resolution", "8x8", "--sides", "one")
        self.assert_done(job)
        report = self.report()
        for key in ("visibility", "forecast", "error_estimate", "subdivision"):
            self.assertNotIn(key, report)
        self.assertNotIn("predicted_bytes_max", report["memory"])
        for key in ("near_pairs", "rays", "bytes"):
            self.assertNotIn(key, report["form_factor"])
        self.assertEqual(set(report["time_s"]), {"load", "subdivision", "solve", "energy", "gather", "image", "total"})
        self.assertEqual(set(report["hierarchy"]["errors"]), {"discretisation", "rays", "picture", "iteration"})
        for name in OWN:
            if "hierarchical" not in OWN[name][0]:
                self.assertNotIn(option_key(name), report["options"])
        self.assertIs(report["options"]["thermal"], False)
        self.assertEqual(report["options"]["target_error"], 0.3)
        self.assertFalse([key for key in report["progress"] if " " in key])
        lines = [line for line in job.out.splitlines() if line.strip()]
        self.assertLessEqual(len(lines), 12, job)


if __name__ == "__main__":
    unittest.main()
