"""The schemas of reports: that they describe every key, refuse what is no report, and hold for all kinds of runs."""

import copy
import json
import unittest

import jsonschema
from fluxel_job import SCENES, JobTest, start
from report_schema import NAMES, SNAKE_CASE, check_reports, faults, keys_not_in_snake_case, schema
from rooms import INSIDE, MTL, ROOM, SMALL

CORNELL = SCENES / "cornell-box" / "cornell-box.toml"
CHAMBER = SCENES / "heating-chamber" / "heating-chamber.toml"
TASKS = SCENES / "office-luminaires" / "office-tasks.toml"


def objects(value, place="#"):
    """All parts of a schema that describe an object, with their places."""
    if isinstance(value, dict):
        if value.get("type") == "object":
            yield place, value
        for key, part in value.items():
            yield from objects(part, f"{place}/{key}")
    elif isinstance(value, list):
        for k, part in enumerate(value):
            yield from objects(part, f"{place}/{k}")


def keys_of(value):
    """All keys of a report."""
    if isinstance(value, dict):
        return set(value).union(*map(keys_of, value.values()))
    return set().union(*map(keys_of, value)) if isinstance(value, list) else set()


class SchemaTest(JobTest):
    method = ()

    def setUp(self):
        super().setUp()
        self.write("room.mtl", MTL)
        self.room = self.write("room.obj", ROOM)

    # The schemas

    def test_they_are_schemas(self):
        for name in NAMES:
            jsonschema.Draft202012Validator.check_schema(schema(name))

    def test_every_key_is_described_in_snake_case(self):
        for name in NAMES:
            for place, part in objects(schema(name)):
                with self.subTest(name, place=place):
                    # What has keys of its own has no others; what has a user's names has values of one kind.
                    self.assertTrue(part["additionalProperties"] is False or isinstance(part["additionalProperties"], dict))
                    self.assertEqual("properties" in part, part["additionalProperties"] is False)
                    self.assertLessEqual(set(part.get("required", ())), set(part.get("properties", ())))
                    for key, value in part.get("properties", {}).items():
                        self.assertRegex(key, f"^{SNAKE_CASE.pattern}$")
                        self.assertTrue(self.description(name, value).strip(), key)

    def description(self, name, part):
        """Of a part, or of what it refers to."""
        while "description" not in part:
            part = schema(name)["$defs"][part["$ref"].removeprefix("#/$defs/")]
        return part["description"]

    def test_numbers_have_units(self):
        for name in NAMES:
            for place, part in objects(schema(name)):
                for key, value in part.get("properties", {}).items():
                    if value.get("type") == "number":
                        with self.subTest(name, place=place, key=key):
                            self.assertRegex(value["description"], r"\[.+\]|\bunit\b")

    # That they can refuse

    def test_what_is_no_report_is_refused(self):
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL, "--target-error", 0.3))
        report = self.report()
        self.assertEqual(faults("report", report), [])

        def without(of, key):
            del of[key]

        for place, words, change in (
                ("$: ", "'ranks' is a required property", lambda r: without(r, "ranks")),
                ("$.hierarchy.rounds[0]: ", "'links' is a required property", lambda r: without(r["hierarchy"]["rounds"][0], "links")),
                ("$: ", "'surprise' was unexpected", lambda r: r.update(surprise=1)),
                ("$.energy: ", "'surprise' was unexpected", lambda r: r["energy"].update(surprise=1)),
                ("$.options: ", "'look-at' was unexpected", lambda r: r["options"].update({"look-at": [0, 0, 0]})),
                ("$.elements: ", "is not of type 'integer'", lambda r: r.update(elements="12")),
                ("$.stated_error: ", "is not of type 'number'", lambda r: r.update(stated_error=None)),
                ("$.leaving[0]: ", "is not of type 'number'", lambda r: r.update(leaving=[None, 1, 1])),
                ("$.time_s.total: ", "is less than the minimum", lambda r: r["time_s"].update(total=-1)),
                ("$.version: ", "is too short", lambda r: r.update(version="")),
                ("$.solve.Cause: ", "snake case", lambda r: r["solve"].update(Cause="none"))):
            with self.subTest(words, place=place):
                changed = copy.deepcopy(report)
                change(changed)
                self.assertTrue(any(fault.startswith(place) and words in fault for fault in faults("report", changed)), faults("report", changed))
                (self.out / "report.json").write_text(json.dumps(changed))
                with self.assertRaisesRegex(AssertionError, "report.json is not as docs/schema/report.schema.json has it"):
                    check_reports(self.out)

    def test_a_file_without_a_schema_is_refused(self):
        self.write("unknown.json", "{}")
        with self.assertRaisesRegex(AssertionError, "unknown.json has no schema"):
            check_reports(self.work)

    def test_names_of_a_scene_may_be_in_any_case(self):
        self.assertEqual(list(keys_not_in_snake_case({"receivers": {"My Desk": {"mean": 1}}, "progress": {"receiver_My-Desk": {}}})), [])
        self.assertEqual(list(keys_not_in_snake_case({"receivers": {"My Desk": {"U0": 1}}, "a": [{"b-c": 1}]})),
                         ["$.receivers.My Desk.U0", "$.a[0].b-c"])

    # What runs write. Each of them validates what it has written: see fluxel_job

    def of_run(self, *arguments, name="report", code=0):
        job = start([*arguments, "--out", self.out])
        self.assertEqual(job.code, code, job)
        return json.loads((self.out / f"{name}.json").read_text())

    def test_receivers_observers_and_tasks(self):
        report = self.of_run("solve", TASKS, "--target-error", 0.2, "--resolution", "32x24")
        self.assertLessEqual({"hierarchy", "stated_error", "audit", "receivers", "observers", "tasks", "picture", "image", "progress"}, set(report))
        self.assertLessEqual({"u0", "ud", "ugr", "error_histogram", "background_luminance"}, keys_of(report))
        truth = self.of_run("reference", TASKS, "--only", "receivers", "--time", 0.5, name="reference")
        self.assertLessEqual({"observers", "tasks", "measured"}, set(truth))
        self.assertLessEqual({"u0", "ugr", "passes"}, keys_of(truth))

    def test_heat(self):
        report = self.of_run("solve", CHAMBER, "--target-error", 0.2)
        self.assertTrue(report["thermal"])
        self.assertIn("convected", report["energy"])

    def test_the_matrix_method(self):
        report = self.of_run("solve", CORNELL, "--method", "matrix", "--resolution", "32x32", "--checkpoint", self.work / "strips")
        self.assertLessEqual({"visibility", "form_factor", "forecast", "error_estimate", "audit", "checkpoint", "solve"}, set(report))
        self.assertIn("corrections", report["ranks_detail"][1])

    def test_dry_runs(self):
        for method in ("matrix", "hierarchical"):
            with self.subTest(method):
                report = self.of_run("solve", CORNELL, "--method", method, "--resolution", "32x32", "--dry-run")
                self.assertIn("forecast", report)
                self.assertNotIn("solve", report)

    def test_a_run_that_fails(self):
        report = self.of_run("solve", self.room, "--method", "matrix", *INSIDE, *SMALL, "--solver", "jacobi", "--max-iterations", 1, code=3)
        self.assertIn("cause", report["solve"])
        self.assertEqual(start(["solve", self.work / "none.obj", "--out", self.work / "refused"]).code, 2)
        self.assertEqual(list((self.work / "refused").glob("*.json")), [])

    def test_a_run_that_ends_early(self):
        report = self.of_run("solve", CORNELL, "--time", 1, "--target-error", 1e-4, "--resolution", "32x32", code=3)
        self.assertEqual(report["hierarchy"]["ended_by"], "time")
        self.assertIs(report["hierarchy"]["reached"], False)

    def test_meshes_and_light_maps_and_views(self):
        written = ("--write", "vtu,lightmap", "--mesh-max-edge", 0.5, "--lightmap-texel", 0.2)
        self.of_run("solve", self.room, *INSIDE, *SMALL, "--target-error", 0.3, "--keep-links", *written)
        solved = (self.out / "solution.ply").rename(self.work / "solution.ply")
        report = self.of_run("view", self.room, "--solution", solved, *INSIDE, *SMALL, "--target-error", 0.3, *written)
        self.assertLessEqual({"mesh", "light_map"}, set(report))
        self.assertNotIn("solve", report)

    def test_references_photons_and_comparisons(self):
        self.of_run("solve", self.room, *INSIDE, *SMALL, "--target-error", 0.3)
        solved = self.out / "solution.ply"
        truth = self.of_run("reference", self.room, "--elements", solved, *INSIDE, *SMALL, "--rays", 1e4, name="reference")
        self.assertEqual(set(truth["measured"]), {"elements", "picture"})
        counted = self.of_run("photons", self.room, "--elements", solved, "--photons", 1e4, name="photons")
        self.assertEqual(set(counted["measured"]), {"elements"})
        of_elements = self.of_run("compare", solved, self.out / "reference.ply", name="compare")
        self.assertIn("noise_free", of_elements["colours"]["red"])
        self.assertNotIn("fail_above", of_elements)
        of_pixels = self.of_run("compare", self.out / "image.exr", self.out / "reference.exr", "--fail-above", 10, name="compare")
        self.assertIn("relmse", of_pixels["colours"]["red"])

    def test_view_factors_are_no_json(self):
        job = start(["viewfactors", self.room, "--out", self.out])
        self.assert_done(job)
        self.assertEqual([name for name in self.written() if name.endswith(".json")], [])


if __name__ == "__main__":
    unittest.main()
