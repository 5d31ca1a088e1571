"""Usage: what is refused before any work, and what is only told."""

import json
import os
import pty
import re
import subprocess
import unittest

from fluxel_job import MATRIX, OUTPUTS, PHASES, JobTest, line_of, option_key, start
from rooms import INSIDE, MTL, OUTSIDE, ROOM, SMALL, VERTICES, scene_file

from fluxel.command import option_words


def scaled_room(factor):
    """The room in units of which there are so many to a metre."""
    return ROOM.replace(VERTICES, VERTICES.replace(" 1", f" {factor}"))


class CommandLineTest(JobTest):
    def setUp(self):
        super().setUp()
        self.write("room.mtl", MTL)
        self.room = self.write("room.obj", ROOM)

    def refuse(self, arguments, *texts):
        self.assert_refused(self.solve(self.room, *arguments), *texts)

    # Texts

    def test_help(self):
        for arguments, word in ((["--help"], "solve"), (["solve", "--help"], "--target-error"),
                                (["solve", "--help-all"], "--max-edge"), (["help", "solve"], "--eye"), (["-h"], "solve"), (["help"], "viewfactors"),
                                (["help", "info"], "--metres-per-unit"), (["info", "--help"], "--target-error")):
            with self.subTest(arguments):
                job = start(arguments)
                self.assert_done(job)
                self.assertEqual(job.out.count("Usage:"), 1, "from one rank, once")
                self.assertIn(word, job.out)
                self.assertEqual(job.err, "")

    def test_help_fits_a_screen_and_its_examples_are_valid(self):
        empty = self.work / "empty"
        empty.mkdir()
        for command in ("solve", "view", "reference", "photons", "viewfactors", "info", "compare"):
            with self.subTest(command):
                text = start([command, "--help"], ranks=1).out
                self.assertLessEqual(len(text.splitlines()), 50, "one screen")
                self.assertLessEqual(max(map(len, text.splitlines())), 100, "where there is no terminal")
                options = start([command, "--help-all"], ranks=1).out
                self.assertGreaterEqual(len(options.splitlines()), len(text.splitlines()) - 1)
                examples = text.split("Examples:\n")[1].split("\n\n")[0].splitlines()
                self.assertGreater(len(examples), 0)
                for example in examples:
                    words = re.split(r" {3,}", example.strip())[0].split()
                    words = words[words.index("fluxel") + 1:]
                    self.assertEqual(words[0], command)
                    # The scene is missing, and nothing else.
                    done = subprocess.run([os.environ["FLUXEL"], *words], cwd=empty, capture_output=True, text=True, timeout=60, check=False)
                    self.assertEqual(done.returncode, 2, done)
                    self.assertRegex(done.stderr, "no such file|cannot find|cannot open|cannot be read")

    def test_colours_are_for_terminals(self):
        def said(**environment):
            main, terminal = pty.openpty()
            names = {name: value for name, value in os.environ.items() if name not in ("TERM", "NO_COLOR")}
            subprocess.run([os.environ["FLUXEL"], "solve", "missing.obj"], stderr=terminal, stdout=subprocess.DEVNULL, timeout=60,
                           env={**names, **environment}, check=False)
            os.close(terminal)
            text = os.read(main, 10000).decode()
            os.close(main)
            return text.strip()
        plain = "fluxel: missing.obj: there is no such file"
        self.assertIn("\x1b[1m\x1b[31mfluxel:\x1b[0m missing.obj", said(TERM="xterm"))
        for environment in ({"TERM": "xterm", "NO_COLOR": "1"}, {"TERM": "dumb"}, {}):
            self.assertEqual(said(**environment), plain, environment)
        self.assertIn("\x1b[31m", said(TERM="xterm", NO_COLOR=""))
        self.assertEqual(start(["solve", "missing.obj"], ranks=1).err.splitlines()[0], plain)

    def test_version(self):
        job = start(["--version"])
        self.assert_done(job)
        for word in ("fluxel ", "Embree ", "MPI"):
            self.assertEqual(job.out.count(word), 1, str(job))
        self.assertEqual(job.err, "")

    # Sub-commands and options

    def test_no_sub_command(self):
        self.assert_refused(start([]), "subcommand")

    def test_unknown_sub_command(self):
        job = start(["paint", self.room])
        self.assert_refused(job, "unknown command 'paint' (see 'fluxel --help')")
        self.assert_refused(start(["sovle", self.room]), "unknown command 'sovle': did you mean 'solve'?")
        self.assert_refused(start(["help", "sovle"]), "did you mean 'solve'?")

    def test_names_that_are_empty(self):
        for option in ("--checkpoint", "--out", "--warm-start"):
            with self.subTest(option):
                self.refuse([option, ""], option)

    def test_help_is_no_option_of_a_scene_file(self):
        scene = self.write("room.toml", scene_file("[options]\nhelp = true\n"))
        self.assert_refused(self.solve(scene), "room.toml:", "option 'help': is none of a run")

    def test_no_scene(self):
        self.assert_refused(start(["solve"]), "scene is required")

    def test_two_scenes(self):
        self.refuse([self.room])

    def test_unknown_options(self):
        self.refuse(["--speed", "11"], "--speed")
        self.refuse(["--speed=11"], "--speed")
        self.refuse(["-x"], "-x")

    def test_the_nearest_name_of_an_option(self):
        for given, nearest in (("--sovler=cg", "--solver"), ("--target_error", "--target-error"), ("-eey", "--eye")):
            with self.subTest(given):
                self.refuse([given], f"unknown option '{given.split('=')[0]}': did you mean '{nearest}'?", "'fluxel solve --help'")
        self.assert_refused(start(["view", self.room, "--solution", "a.ply", "--tragets"]), "unknown option '--tragets' (see")
        scene = self.write("room.toml", scene_file('[options]\nmax-egde = 1\n'))
        self.assert_refused(self.solve(scene), "room.toml:11:", "did you mean '--max-edge'?")

    def test_option_without_its_value(self):
        job = start(["solve", *MATRIX, self.room, *INSIDE, "--out", self.out, "--resolution"])
        self.assert_refused(job, "--resolution")

    def test_bad_values(self):
        for option, values in {
                "--resolution": ("0x0", "-1x5", "10", "70000x10"),
                "--fov": ("0", "180", "nan"),
                "--eye": ("1,2", "1,nan,2"),
                "--tolerance": ("0", "nan", "automatic", "auto:", "auto:0", "auto:1.5", "auto:nan"),
                "--isa": ("mmx",),
                "--device": ("gpu",),
                "--max-iterations": ("0",),
                "--max-edge": ("-1",),
                "--threads": ("0",),
                "--supersample": ("65",),
                "--filter": ("blur", "median", "median:51", "median:-1", "median:1.5", "gaussian:1"),
                "--exposure": ("nan",),
                "--sides": ("three",),
                "--ke": ("power",),
                "--textures": ("pixel",),
                "--solver": ("magic",),
                "--form-factor": ("exact",),
                "--subdivision": ("fine",),
                "--subscenes": ("both",),
        }.items():
            for value in values:
                with self.subTest(option, value=value):
                    self.refuse([*INSIDE, f"{option}={value}"], option)

    def test_the_gaussian_filter_is_gone(self):
        self.refuse([*INSIDE, "--filter", "gaussian:1"], "the Gaussian filter is gone", "leave it out")

    def test_no_filter(self):
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL, "--filter", "none"))
        self.assertNotIn("filter", self.report()["options"])

    def test_negative_resolution_as_a_word_of_its_own(self):
        self.refuse([*INSIDE, "--resolution", "-1x5"])

    def test_negative_coordinates_as_a_word_of_their_own(self):
        self.assert_done(self.solve(self.room, *OUTSIDE, *SMALL, "--eye", "-3,-3,0.5"))

    # Cameras

    def test_half_a_camera(self):
        self.refuse(["--eye", "0,0,0"], "--look-at")
        self.refuse(["--look-at", "0,0,0"], "--eye")

    def test_eye_at_the_point_that_it_looks_at(self):
        self.refuse(["--eye", "0.5,0.5,0.5", "--look-at", "0.5,0.5,0.5"], "same point")

    def test_up_along_the_view(self):
        self.refuse([*INSIDE, "--up", "0,1,0"], "--up")
        self.refuse([*INSIDE, "--up", "0,-2,0"], "--up")
        self.refuse([*INSIDE, "--up", "0,0,0"], "--up")

    def test_the_camera_of_a_scene_file(self):
        for camera, line, text in (("eye = [0.5, 0.5, 0.5]\nlook_at = [0.5, 0.5, 0.5]\n", 6, "same point"),
                                   ("fov = 200\n", 5, "--fov must be"), ("eye = [0.5, 0.5, 0.5]\n", 5, "needs both")):
            with self.subTest(text):
                scene = self.write("room.toml", scene_file(camera=camera))
                self.assert_refused(self.solve(scene), f"room.toml:{line}: camera: ", text)
        self.assert_refused(self.solve(scene, "--look-at", "0.5,0.5,0.5"), "same point")
        self.assertNotIn("room.toml", self.solve(scene, "--look-at", "0.5,0.5,0.5").err, "the command line made it wrong")

    def two_cameras(self):
        """A scene file of them."""
        desk = 'name = "desk"\neye = [0.5, 0.1, 0.5]\nlook_at = [0.5, 0.9, 0.5]\nup = [0, 0, 1]\nresolution = [8, 8]\n'
        door = 'name = "door"\neye = [0.1, 0.5, 0.5]\nlook_at = [0.9, 0.5, 0.5]\nup = [0, 0, 1]\nresolution = [6, 4]\n'
        return self.write("room.toml", f'[[geometry]]\nfile = "room.obj"\n[[camera]]\n{desk}[[camera]]\n{door}')

    def test_cameras_by_name(self):
        scene = self.two_cameras()
        for given, name, resolution, eye in (((), "desk", [8, 8], [0.5, 0.1, 0.5]), (("--camera", "door"), "door", [6, 4], [0.1, 0.5, 0.5]),
                                             (("--camera", "door", "--eye", "0.2,0.5,0.5"), "door", [6, 4], [0.2, 0.5, 0.5])):
            with self.subTest(given):
                job = self.solve(scene, *given)
                self.assert_done(job)
                self.assertIn(f"camera: {name}, of desk, door (--camera NAME takes another)", job.out)
                options = self.report()["options"]
                self.assertEqual([options[key] for key in ("camera", "resolution", "eye")], [name, resolution, eye])
        solution = self.out / "solution.ply"
        for command, report in ((["view", scene, "--solution", solution, "--audit", 0, "--target-error", 0.1], "report.json"),
                                (["reference", scene, "--rays", 1e5], "reference.json")):
            with self.subTest(command[0]):
                seen = self.work / command[0]
                job = start([*command, "--camera", "door", "--out", seen])
                self.assert_done(job)
                options = json.loads((seen / report).read_text())["options"]
                self.assertEqual([options["camera"], options["resolution"]], ["door", [6, 4]])

    def test_no_camera_of_that_name(self):
        self.refuse(["--camera", "desk"], "--camera desk", "room.obj", "no camera with a name", "--eye")
        scene = self.write("single.toml", scene_file())
        self.assert_refused(self.solve(scene, "--camera", "desk"), "no camera with a name")
        scene = self.two_cameras()
        for command in (["solve"], ["reference"], ["view", "--solution", "none.ply"]):
            with self.subTest(command[0]):
                job = start([*command, scene, "--camera", "window", "--out", self.out])
                self.assert_refused(job, "--camera window: ", "room.toml has no such camera", "known: desk, door")
        self.assert_refused(self.solve(scene, "--camera", "desk", "--look-at", "0.5,0.1,0.5"), "same point")

    def test_a_camera_of_a_json_file(self):
        camera = self.write("eye.json", '{"eye": [0.5, 0.1, 0.5], "look_at": [0.5, 0.9, 0.5],\n "up": [0, 0, 1], "fov": 50.5, "resolution": [8, 6]}')
        for scene in (self.room, self.two_cameras()):
            with self.subTest(scene.name):
                job = self.solve(scene, "--camera", camera, "--fov", "60")
                self.assert_done(job)
                self.assertNotIn("camera:", job.out)
                options = self.report()["options"]
                self.assertEqual([options[key] for key in ("camera", "eye", "look_at", "up", "fov", "resolution")],
                                 [str(camera), [0.5, 0.1, 0.5], [0.5, 0.9, 0.5], [0, 0, 1], 60, [8, 6]])

    def test_bad_cameras_of_json_files(self):
        for text, line, words in (
                ('{"eye": [0, 0, 0],\n"lokat": [1, 0, 0]}', 2, ("unknown key 'lokat'", "known: eye, look_at, up, fov, resolution")),
                ('{"eye": [0, 0, 0],\n"lookat": [1, 0, 0]}', 2, ("unknown key 'lookat'", "did you mean 'look_at'?")),
                ('{"eye": [0, 0, 0],\n"look_at": [1, 0]}', 2, ("look_at must be an array of 3 numbers",)),
                ('{"eye": [0, "0", 0]}', 1, ("eye must have numbers",)), ('{"fov": [1]}', 1, ("fov must have numbers",)),
                ('{\n"fov": 190}', 2, ("--fov must be between",)), ('{"up":\n[0, 0, 0]}', 1, ("--up is zero",)),
                ('{"fov": 30,\n\n"fov": 40}', 1, ("camera fov is given twice",)),
                ('{"resolution": [16, 0]}', 1, ("resolution must be two whole numbers from 1 to 65536",)),
                ('{"resolution": [16, 1.5]}', 1, ("resolution must be two whole numbers",)),
                ('{"eye": [0, 0, 0]}', 1, ("needs both",)), ('{"eye": [1e400, 0, 0]}', None, ("out of range",)),
                ('{"eye": [0, 0,\n0],', 2, ("no JSON", '{"eye": [x, y, z]')), ("[1, 2]", 1, ("no JSON object",)), ("", 1, ("no JSON",)),
                ("[" * 60000, 1, ("no JSON",)), (" " * 70000 + "{}", None, ("bytes are too many",))):
            with self.subTest(text[:40]):
                camera = self.write("eye.json", text)
                self.assert_refused(self.solve(self.room, "--camera", camera), *words, file=camera, line=line)
        self.assert_refused(self.solve(self.room, "--camera", self.work / "gone.json"), "no such file", file=self.work / "gone.json")
        self.assert_refused(self.solve(self.room, "--camera", self.work), "no camera with a name")

    def test_the_nearest_name_of_a_camera(self):
        self.assert_refused(self.solve(self.two_cameras(), "--camera", "dsek"), "did you mean 'desk'? Known: desk, door")

    # Units

    def test_metres_per_unit_of_geometry(self):
        large = self.write("large.obj", scaled_room(2000))
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL))
        metres = (self.out / "solution.ply").read_bytes()
        job = self.solve(large, *INSIDE, *SMALL, "--metres-per-unit", "0.0005")
        self.assert_done(job)
        self.assertEqual(job.warnings, [])
        self.assertEqual((self.out / "solution.ply").read_bytes(), metres)
        self.assertEqual(self.report()["options"]["metres_per_unit"], 0.0005)
        solution = self.out / "solution.ply"
        for command in (["view", large, "--solution", solution, "--audit", 0, "--target-error", 0.3, *INSIDE, *SMALL],
                        ["reference", large, "--elements", solution, "--rays", 1e4], ["viewfactors", large], ["info", large]):
            with self.subTest(command[0]):
                out = [] if command[0] == "info" else ["--out", self.work / command[0]]
                job = start([*command, "--metres-per-unit", "0.0005", *out])
                self.assert_done(job)
                self.assertEqual(job.warnings, [])
        options = json.loads((self.work / "reference" / "reference.json").read_text())["options"]
        self.assertEqual(options["metres_per_unit"], 0.0005)

    def test_a_unit_that_is_doubted(self):
        large = self.write("large.obj", scaled_room(2000))
        for command in (["solve", *MATRIX, "--subdivision", "none"], ["viewfactors"]):
            with self.subTest(command[0]):
                job = start([*command, large, "--out", self.out])
                self.assert_done(job)
                self.assertEqual(len(job.warnings), 1, job)
                for word in ("2000 m wide", "--metres-per-unit 0.001"):
                    self.assertIn(word, job.warnings[0])
        self.assertIn("2000 m wide", self.report()["warnings"][0])
        job = self.solve(large, "--subdivision", "none", "--metres-per-unit", "1")
        self.assert_done(job)
        self.assertEqual(job.warnings, [])

    def test_a_unit_that_is_refused(self):
        for value in ("0", "-1", "nan", "inf", "mm"):
            self.refuse([*INSIDE, f"--metres-per-unit={value}"], "--metres-per-unit")
        scene = self.write("room.toml", scene_file())
        for command in (["solve"], ["reference"], ["view", "--solution", "a.ply"], ["viewfactors"], ["info"]):
            with self.subTest(command[0]):
                self.assert_refused(start([*command, scene, "--metres-per-unit", "0.001"]), "metres_per_unit", "[[geometry]]", file=scene)
        scene = self.write("other.toml", scene_file('[options]\nmetres-per-unit = 0.001\n'))
        self.assert_refused(self.solve(scene), "other.toml:11:", "metres_per_unit of [[geometry]]")

    def test_target_errors_below_all_measure(self):
        for command in (["solve"], ["reference"], ["view", "--solution", "none.ply"]):
            with self.subTest(command):
                job = start([*command, self.room, *INSIDE, *SMALL, "--target-error", "1e-155", "--out", self.out])
                self.assert_refused(job, "--target-error must be 1e-06 or more")

    def test_values_without_a_camera(self):
        self.refuse(["--subdivision", "none", "--fov", "999"], "--fov")
        self.refuse(["--subdivision", "none", "--up", "0,0,0"], "--up is zero")

    def test_huge_directions_and_places(self):
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL, "--up", "0,0,1e300"))
        solution = (self.out / "solution.ply").read_bytes()
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL))
        self.assertEqual((self.out / "solution.ply").read_bytes(), solution)

    def test_places_beyond_all_measure(self):
        self.refuse([*INSIDE, *SMALL, "--look-at", "1e200,0,0"], "--look-at", "too far")
        self.refuse([*INSIDE, *SMALL, "--eye", "1e200,0,0"], "--eye", "too far")

    def test_camera_options_without_a_camera(self):
        # The colours of the written elements have an exposure too.
        job = self.solve(self.room, "--subdivision", "none", "--filter", "median:1", "--exposure", "1")
        self.assert_done(job)
        self.assertEqual(len(job.warnings), 1, str(job))
        self.assertIn("--filter", job.warnings[0])
        self.assertNotIn("--exposure", job.warnings[0])
        self.assertEqual(self.report()["warnings"], [line.removeprefix("warning: ") for line in job.warnings])

    def test_an_edge_for_whole_patches(self):
        self.refuse(["--subdivision", "none", "--max-edge", "0.1"], "--max-edge")

    def test_camera_subdivision_without_a_camera(self):
        self.refuse(["--subdivision", "camera"], "camera")
        self.refuse([], "camera")

    def test_uniform_subdivision_without_an_edge(self):
        self.refuse(["--subdivision", "uniform"], "--max-edge")
        self.refuse([*INSIDE, "--subdivision", "uniform"], "--max-edge")

    def test_no_picture_without_a_camera(self):
        for arguments in (["--subdivision", "uniform", "--max-edge", "0.5"], ["--subdivision", "none"]):
            with self.subTest(arguments):
                self.assert_done(self.solve(self.room, *arguments))
                self.assertEqual(self.written(), ["convergence.csv", "report.html", "report.json", "solution.ply"])

    # The scene file's options stand below those of the command line

    def test_options_of_a_scene_file(self):
        toml = scene_file('[options]\nsolver = "gauss-seidel"\nsides = "one"\nno-cut = true\ntolerance = 0.01\n')
        self.assert_done(self.solve(self.write("room.toml", toml), "--tolerance", "0.005"))
        options = self.report()["options"]
        self.assertEqual(options["solver"], "gauss-seidel")
        self.assertEqual(options["sides"], "one")
        self.assertEqual(options["no_cut"], True)
        self.assertEqual(options["resolution"], [16, 16])
        self.assertEqual(options["tolerance"], 0.005)

    def test_the_camera_of_a_scene_file_stands_below_the_command_line(self):
        self.assert_done(self.solve(self.write("room.toml", scene_file()), "--resolution", "12x8", "--fov", "50"))
        options = self.report()["options"]
        self.assertEqual([options[name] for name in ("eye", "look_at", "up", "fov", "resolution")],
                         [[0.5, 0.1, 0.5], [0.5, 0.9, 0.5], [0, 0, 1], 50, [12, 8]])

    def test_camera_values_of_a_scene_file_without_a_camera(self):
        job = self.solve(self.write("room.toml", scene_file(camera="fov = 30\n")), "--subdivision", "none")
        self.assert_done(job)
        self.assertEqual(len(job.warnings), 1, str(job))
        self.assertIn("--fov, --resolution has no effect", job.warnings[0])

    def test_flags_of_a_scene_file_may_be_false(self):
        toml = scene_file("[options]\nno-cut = false\nquiet = false\nclosure = true\n")
        job = self.solve(self.write("room.toml", toml))
        self.assert_done(job)
        self.assertEqual(self.report()["options"]["no_cut"], False)
        self.assertEqual(self.report()["options"]["closure"], True)
        self.assertNotEqual(job.out, "")

    def test_false_is_no_value_of_other_options(self):
        for name in ("spede", "tolerance", "sides"):
            with self.subTest(name):
                scene = self.write("room.toml", scene_file(f"[options]\n{name} = false\n"))
                self.assert_refused(self.solve(scene), name)

    def test_numbers_of_a_scene_file_that_are_out_of_range(self):
        for option in ("target-error = -1", "target-error = 1e-9", "block-error = 0", "audit = 1", "time = 0", "max-edge = 0",
                       "checkpoint-every = 0", "form-factor-tolerance = -1", "verify-device = 2"):
            with self.subTest(option):
                text = scene_file(f"[options]\n{option}\n")
                scene = self.write("room.toml", text)
                name = option.split()[0]
                self.assert_refused(self.solve(scene), f"option '{name}'", f"--{name}", file=scene, line=line_of(text, option))

    def test_a_folder_may_be_called_false(self):
        self.out = self.work / "false"
        scene = self.write("room.toml", scene_file('[options]\nout = "false"\n'))
        here = os.getcwd()
        self.addCleanup(os.chdir, here)
        os.chdir(self.work)
        self.assert_done(start(["solve", *MATRIX, scene]))
        self.assertEqual(self.written(), sorted(OUTPUTS))

    def test_the_report_repeats_the_run(self):
        self.assert_done(self.solve(
            self.room, *INSIDE, *SMALL, "--exposure", "-1.5", "--threads", "1", "--filter", "median:1", "--supersample",
            "2", "--no-cut", "--keep-polygons", "--no-partial-visibility", "--closure", "--max-edge", "0.4", "--solver", "gauss-seidel",
            "--tolerance", "1e-4", "--sides", "one", "--ke", "radiance", "--textures", "face", "--form-factor", "points:2x3"))
        self.check_repeated()
        self.assert_done(self.solve(
            self.room, *INSIDE, *SMALL, "--tolerance", "auto:0.03", "--isa", "sse4", "--solver", "southwell",
            "--preview"))
        self.check_repeated()

    def check_repeated(self):
        first_out = self.out
        options = self.report()["options"]
        files = {name: (self.out / name).read_bytes() for name in ("image.png", "solution.ply")}
        scene = options.pop("scene")
        self.out = self.work / "again"
        self.assert_done(self.solve(scene, *option_words(options)))
        self.assertEqual({name: (self.out / name).read_bytes() for name in files}, files)
        again = self.report()["options"]
        again.pop("scene")
        self.assertEqual(again, options)
        self.out = first_out

    def test_options_without_effect_are_said(self):
        for options, idle in ((("--form-factor", "disc", "--form-factor-tolerance", "1e-2"), "--form-factor-tolerance"),
                              (("--form-factor", "disc", "--no-partial-visibility"), "--no-partial-visibility"),
                              (("--verify-device", "0.1"), "--verify-device"), (("--dry-run", "--timeline"), "--timeline"),
                              (("--dry-run", "--solver", "cg"), "--solver"),
                              (("--dry-run", "--exposure", "1"), "--exposure"), (("--dry-run", "--device", "auto"), "--device"),
                              (("--visibility-only", "--checkpoint", self.work / "strips", "--tolerance", "1e-3"), "--tolerance"),
                              (("--subdivision", "none", "--subscenes", "merged"), "--subscenes")):
            with self.subTest(idle):
                job = self.solve(self.room, *INSIDE, *SMALL, *options)
                self.assert_done(job)
                self.assertTrue(any(f"{idle} has no effect" in line for line in job.warnings), job)
                self.assertNotIn(option_key(idle), self.report()["options"])

    # What a run says

    def test_progress_in_a_pipe_comes_from_one_rank(self):
        job = self.solve(self.room, *INSIDE, *SMALL, ranks=3)
        self.assert_done(job)
        done = [line.split(":")[0] for line in job.err.splitlines() if ": done in " in line]
        self.assertEqual(done, list(PHASES))
        self.assertNotIn("\r", job.err)
        self.assertNotIn("\x1b", job.err)
        for word in ("scene:", "subdivision:", "visibility:", "solve:", "picture:", "solution:", "report:"):
            self.assertEqual(sum(line.startswith(word) for line in job.out.splitlines()), 1, str(job))
        self.assertEqual(self.written(), sorted(OUTPUTS))

    def test_quiet_says_nothing(self):
        job = self.solve(self.room, *INSIDE, *SMALL, "--quiet")
        self.assert_done(job)
        self.assertEqual((job.out, job.err), ("", ""))
        self.assertEqual(self.written(), sorted(OUTPUTS))


if __name__ == "__main__":
    unittest.main()
