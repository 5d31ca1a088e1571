"""Runs of fluxel, with what they leave behind, and references that are made once."""

import hashlib
import json
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from settings import PHOTONS, ROOT, without

sys.path += [str(ROOT / "bench"), str(ROOT / "python")]
from exact import deviation, mean
from fluxel import read_elements

FLUXEL = ROOT / "build/release/app/fluxel"
ESTIMATOR = 3  # to be raised with whatever changes the numbers of references, so that kept ones are made anew
# Of a run's report, in their order. The visibility is that of the run that made it.
SHARED_PHASES = ("load", "subdivision", "forecast", "visibility")
OWN_PHASES = ("form_factors", "energy", "solve", "gather", "image")
REPEATS, QUICK = 5, 3.0  # runs below so many seconds are repeated


def fluxel(*arguments, expect=(0,), limit=None):
    """The exit code; none of a run that has been ended after `limit` seconds."""
    command = [str(FLUXEL), *map(str, arguments), "--quiet"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=limit)
    except subprocess.TimeoutExpired:
        return None
    if done.returncode not in expect:
        sys.exit(f"{' '.join(command)}\nended with {done.returncode}:\n{done.stderr}")
    return done.returncode


def load(path):
    return json.loads(Path(path).read_text(encoding="utf-8"))


class Solves:
    """Solves of one scene; those on the same elements share the visibility of the first of them. One that takes longer than
    `limit` seconds is ended."""

    def __init__(self, scene, threads, limit=None):
        self.scene, self.threads, self.limit = scene, threads, limit
        self.folder = Path(tempfile.mkdtemp(prefix="fluxel-accuracy-"))
        self.mesh, self.shared = None, None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.folder)

    def run(self, setting):
        """Solves; its report with `seconds` {wall, cpu} of each run, or None where it did not converge or was ended."""
        if setting.method.is_view:
            return self._view(setting)
        if setting.method is PHOTONS:
            return self._photons(setting)
        options, phases = (), (*SHARED_PHASES, *OWN_PHASES)
        if not setting.whole:
            options, phases = ("--reuse-visibility", self.folder / "strips"), OWN_PHASES
            if setting.mesh != self.mesh:
                self.mesh, self.shared = setting.mesh, self._visibility(setting)
        runs = []
        while not runs or (runs[0]["wall"] < QUICK and len(runs) < REPEATS):
            if self._solve(setting, *options) is None:
                return None
            report = load(self.out / "report.json")
            runs.append({kind: (0 if setting.whole else self.shared[kind]) + sum(report[key].get(p, 0) for p in phases)
                         for kind, key in (("wall", "time_s"), ("cpu", "cpu_s"))})
        report["seconds"] = {kind: [run[kind] for run in runs] for kind in ("wall", "cpu")}
        return report if report["solve"]["converged"] else None

    @property
    def out(self):
        return self.folder / "out"

    def _solve(self, setting, *options):
        return fluxel("solve", self.scene.file, "--method", setting.method.name, "--out", self.out, "--threads",
                      # References are of pixels' centres.
                      self.threads, "--supersample", 1, *(() if setting.whole else ("--no-error-estimate",)),
                      # The chart measures errors itself; of a target the audit is a part.
                      *(() if "--target-error" in setting.mesh else ("--audit", 0)), *setting.mesh,
                      *setting.method.options, *options, expect=(0, 3), limit=self.limit)

    def _view(self, setting):
        """Views of one solution."""
        solution = self.folder / "solution"
        if fluxel("solve", self.scene.file, "--out", solution, "--threads", self.threads, "--audit", 0, *setting.solved_for_view,
                  expect=(0, 3), limit=self.limit) is None or not load(solution / "report.json")["solve"]["converged"]:
            return None
        runs = []
        while not runs or (runs[0]["wall"] < QUICK and len(runs) < REPEATS):
            if fluxel("view", self.scene.file, "--solution", solution / "solution.ply", "--out", self.out, "--threads", self.threads,
                      "--supersample", 1, "--audit", 0, *setting.seen, expect=(0, 3), limit=self.limit) is None:
                return None
            report = load(self.out / "report.json")
            runs.append({kind: sum(report[key].get(p, 0) for p in (*SHARED_PHASES, *OWN_PHASES)) for kind, key in (("wall", "time_s"), ("cpu", "cpu_s"))})
        return {**report, "seconds": {kind: [run[kind] for run in runs] for kind in ("wall", "cpu")}}

    def _photons(self, setting):
        """The light of elements by photons, and a view of it."""
        at = setting.mesh.index("--resolution")
        shown, made = setting.mesh[at:at + 2], without(without(setting.mesh, "--resolution"), "--subdivision")
        of = ("--threads", self.threads)
        runs = []
        while not runs or (runs[0]["wall"] < QUICK and len(runs) < REPEATS):
            if fluxel("photons", self.scene.file, "--photons", setting.photons, "--only", "elements", "--out", self.folder / "photons",
                      *of, *made, limit=self.limit) is None:
                return None
            traced = load(self.folder / "photons/photons.json")
            if fluxel("view", self.scene.file, "--solution", self.folder / "photons/photons.ply", "--out", self.out, *of,
                      "--supersample", 1, "--audit", 0, *shown, expect=(0, 3), limit=self.limit) is None:
                return None
            report = load(self.out / "report.json")
            runs.append({kind: traced["load_s"] + traced["photons"][own] + sum(report[key].get(p, 0) for p in OWN_PHASES)
                         for kind, key, own in (("wall", "time_s", "seconds"), ("cpu", "cpu_s", "cpu_s"))})
        return {**report, "seconds": {kind: [run[kind] for run in runs] for kind in ("wall", "cpu")}}

    def _visibility(self, setting):
        """Keeps the bits; seconds of all up to them, without those for writing them, the median of several."""
        runs = []
        while not runs or (runs[0]["wall"] < QUICK and len(runs) < REPEATS):
            shutil.rmtree(self.folder / "strips", ignore_errors=True)
            self._solve(setting, "--checkpoint", self.folder / "strips", "--visibility-only")
            report = load(self.out / "report.json")
            writing = report["checkpoint"]["seconds"]
            runs.append({"wall": sum(report["time_s"].get(phase, 0) for phase in SHARED_PHASES) - writing,
                         "cpu": sum(report["cpu_s"].get(phase, 0) for phase in SHARED_PHASES) - writing})
        return {kind: statistics.median(run[kind] for run in runs) for kind in runs[0]}


class References:
    """Pictures by paths of light, kept by what they depend on."""

    def __init__(self, folder, rays, threads):
        self.folder, self.rays, self.threads = Path(folder), rays, threads

    def picture(self, scene, resolution, sampling="even"):
        """The folder of a reference of the points that a picture is made of."""
        name = f"{resolution}" if sampling == "even" else f"{resolution}-{sampling}"
        return self._measure(scene, name, ("--only", "picture", "--supersample", 1, "--resolution", f"{resolution}x{resolution}",
                                           "--sampling", sampling))

    def elements(self, scene, solution, elements_hash):
        """The folder of a reference of a solution's elements."""
        return self._measure(scene, elements_hash, ("--only", "elements", "--elements", solution, "--sampling", "even"))

    def _measure(self, scene, name, options):
        digest = hashlib.sha256(f"{ESTIMATOR} {self.rays} {scene.options}".encode())
        for file in scene.files:
            digest.update(file.read_bytes())
        out = self.folder / f"{scene.name}-{name}-{digest.hexdigest()[:12]}"
        if not (out / "reference.json").exists():
            out.mkdir(parents=True, exist_ok=True)
            fluxel("reference", scene.file, "--out", out, "--threads", self.threads, "--rays", self.rays, *options,
                   *without(scene.options, "--max-edge"))
        return out


def reference_of(name, obj, options, error, seconds, threads):
    """The folder of a reference of the points that a picture of an OBJ file is made of, kept by these very files: a scene of
    the same name may be another after a change of what makes it. It ends at that standard error over the mean, or then; one that
    is kept and ended by a shorter time is made anew."""
    text = obj.read_bytes() + obj.with_suffix(".mtl").read_bytes() + repr((ESTIMATOR, options)).encode()
    folder = ROOT / "build/references" / f"{name}-{error:g}-{hashlib.sha256(text).hexdigest()[:12]}"
    report = folder / "reference.json"
    kept = load(report) if report.exists() else None
    if kept is None or not kept["measured"]["picture"]["reached"] and kept["options"]["time"] < seconds:
        fluxel("reference", obj, "--only", "picture", "--supersample", 1, "--sampling", "even", "--target-error", error, "--time", seconds,
               "--threads", threads, "--out", folder, *options, expect=(0, 3))
    return folder


def exact_error(solution, exact):
    """The error of a solution whose B is known, as compare has it."""
    elements = read_elements(solution)
    error = deviation(elements, exact)[0]
    return {"error": error, "low": error, "high": error, "bias": mean(elements) / exact - 1, "noise": 0.0}


def compare(judged, reference, folder):
    """The error of a picture: {error, low, high, bias, noise}, over the mean, of the worst colour."""
    fluxel("compare", judged, reference, "--out", folder)
    colours = [colour for colour in load(Path(folder) / "compare.json")["colours"].values() if colour]
    worst = max(colours, key=lambda colour: colour["noise_free"]["sigma_relative"])
    free = worst["noise_free"]
    return {"error": free["sigma_relative"], "low": free["sigma_low_relative"], "high": free["sigma_high_relative"],
            "bias": worst["bias_relative"], "noise": free["reference_noise_relative"]}
