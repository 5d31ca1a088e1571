"""The forecasts that a run records of its long phases.

How good they are is measured by bench/accuracy/forecasts.py (bench/results/runs.md): no test can ask
a machine that others use too for seconds. What is asserted here holds on any machine: which phases have a record, that it
is in order, that an end is forecast after a tenth of a phase, and that it is within a factor of FACTOR of the true one.
"""

import csv
import math
import signal

from fluxel_job import MATRIX, SCENES, JobTest, launch

CORNELL = SCENES / "cornell-box" / "cornell-box.toml"
FACTOR = 3
# Phases shorter than this are over before a forecast means anything [s].
SHORTEST = 0.2


class ForecastTest(JobTest):
    def solve_cornell(self, *options, **settings):
        job = self.solve(CORNELL, "--resolution", "96x96", "--threads", "1", *options, **settings)
        self.assert_done(job)
        return self.report()

    def check_order(self, record):
        samples = record["samples"]
        self.assertLessEqual(len(samples), 200)
        seconds, done = [sample["time_s"] for sample in samples], [sample["done"] for sample in samples]
        self.assertEqual(seconds, sorted(seconds))
        self.assertEqual(done, sorted(done))
        self.assertEqual(seconds[-1], record["final_s"])
        self.assertEqual(samples[-1]["forecast_s"], record["final_s"], "at its end a phase knows it")

    def check_forecasts(self, record, share=0.1):
        end = record["final_s"]
        later = [sample for sample in record["samples"] if sample["time_s"] >= share * end]
        for sample in later:
            self.assertIn("forecast_s", sample, f"no forecast within {end} s")
            self.assertGreaterEqual(sample["forecast_s"], sample["time_s"], "an end that has passed")
        self.assertLess(abs(math.log(later[0]["forecast_s"] / end)), math.log(FACTOR), later[0])

    def test_long_phases_forecast_their_end(self):
        for ranks in (1, 3):
            progress = self.solve_cornell(ranks=ranks)["progress"]
            self.assertEqual(list(progress), ["visibility", "corrections", "solve"])
            for name, record in progress.items():
                self.check_order(record)
                if name != "solve" and record["final_s"] >= SHORTEST:
                    self.check_forecasts(record)

    def test_all_work_is_done_at_the_end(self):
        record = self.solve_cornell(ranks=3)["progress"]["visibility"]
        # The last sample before rank 0 has nothing left; others may be at their last strips.
        last = record["samples"][-2]
        self.assertLess(record["final_s"] / last["forecast_s"], FACTOR)

    def test_a_solve_comes_to_its_target(self):
        report = self.solve_cornell("--form-factor", "disc", "--solver", "jacobi", "--tolerance", "1e-4", ranks=1)
        record = report["progress"]["solve"]
        self.check_order(record)
        self.assertEqual(record["target"], 1e-4)
        errors, targets = [sample["error"] for sample in record["samples"]], [sample["target"] for sample in record["samples"]]
        self.assertEqual(set(targets), {1e-4})
        self.assertEqual(errors, sorted(errors, reverse=True))
        self.assertLessEqual(errors[-1], 1e-4)
        self.assertEqual(record["samples"][-1]["done"], report["solve"]["iterations"])
        self.check_forecasts(record, 0.3)

    def test_the_target_of_auto_is_a_share_of_the_discretisation_error(self):
        report = self.solve_cornell("--form-factor", "disc", ranks=1)
        record = report["progress"]["solve"]
        self.assertIn(round(record["target"], 9),
                      [round(0.1 * of_colour, 9) for of_colour in report["solve"]["variation_rgb"]])
        self.assertLessEqual(record["samples"][-1]["error"], record["target"])
        self.assertLess(record["samples"][-1]["error"], record["samples"][0]["error"])

    def table(self):
        with open(self.out / "convergence.csv", newline="") as lines:
            return list(csv.DictReader(lines))

    def test_the_table_says_what_the_report_says(self):
        progress = self.solve_cornell(ranks=1)["progress"]
        rows = self.table()
        self.assertEqual(list(rows[0]), ["phase", "seconds", "done", "error", "target", "forecast_s"])
        for name, record in progress.items():
            of_phase = [row for row in rows if row["phase"] == name]
            self.assertEqual(len(of_phase), len(record["samples"]))
            for row, sample in zip(of_phase, record["samples"]):
                self.assertAlmostEqual(float(row["seconds"]), sample["time_s"], delta=1e-5 * sample["time_s"])
                self.assertEqual(row["target"] != "", name == "solve")

    def test_a_long_run_can_be_watched(self):
        # A minute of rays or more.
        process = launch(["solve", *MATRIX, CORNELL, "--resolution", "64x64", "--threads", "1", "--form-factor",
                          "points:6x6", "--no-error-estimate", "--out", self.out], ranks=2)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        self.wait_for((self.out / "convergence.csv").exists, process)
        process.send_signal(signal.SIGUSR2)
        process.communicate(timeout=30)
        self.assertEqual(process.returncode, 75)
        running = [row for row in self.table() if row["phase"] == "corrections"]
        self.assertGreater(len(running), 10)
        self.assertGreater(float(running[-1]["forecast_s"]), float(running[-1]["seconds"]))

    def test_a_dry_run_records_nothing(self):
        self.assert_done(self.solve(CORNELL, "--resolution", "32x32", "--dry-run"))
        self.assertNotIn("progress", self.report())
        self.assertEqual(self.written(), ["report.html", "report.json"])
