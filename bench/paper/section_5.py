"""Section 5 of the paper: the construction in wood, times, and speed-up on several processors."""

import csv
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import charts
from brute_force import blocked_pairs
from outcome import ROOT, Outcome, Row
from runs import bench, percent, scene_file, solve

sys.path.append(str(ROOT / "bench/speedup"))
from tables import PAPER_SECONDS

SCENE = "construction-in-wood"
CORES = len(os.sched_getaffinity(0))


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return [{key: value if key in ("scene", "hash") else float(value or "nan") for key,
                 value in row.items()} for row in csv.DictReader(file)]


def colourfulness(radiance):
    """Mean over the pixels of how far the colours are apart, over the brightest of them."""
    return float(np.mean((radiance.max(axis=2) - radiance.min(axis=2)) / radiance.max(axis=2)))


def white_copy(folder):
    """The scene, every painted back white."""
    source = scene_file(SCENE)
    for suffix in (".obj", ".toml"):
        (folder / source.name).with_suffix(suffix).write_bytes(source.with_suffix(suffix).read_bytes())
    materials = source.with_suffix(".mtl").read_text(encoding="utf-8").split("newmtl ")
    white = [part if part.startswith(("white", "window", "#")) else
             "\n".join("Kd 0.8 0.8 0.8" if line.startswith("Kd") else line for line in part.split("\n")) for part in materials]
    (folder / source.name).with_suffix(".mtl").write_text("newmtl ".join(white), encoding="utf-8")
    return folder / source.name


def figure_2(out):
    options = {"resolution": (128, 128), "supersample": 1, "form_factor": "disc"}
    solution = solve(SCENE, **options)
    radiance, reflectance = solution.picture.values, solution.picture["reflectance"]
    with tempfile.TemporaryDirectory() as folder:
        plain = solve(white_copy(Path(folder)), **options).picture.values
    outcome = Outcome(("backs", "reflectance of what is seen", "mean colourfulness of the picture"), [], "")
    seen = f"{reflectance.min():.2f} to {reflectance.max():.2f}, red, green and blue"
    outcome.rows = [("painted", seen, percent(colourfulness(radiance))), ("white", "", percent(colourfulness(plain)))]
    elements = solution.elements
    figure, (left, right) = charts.pyplot.subplots(1, 2, figsize=(9, 5.2), layout="constrained")
    left.set_title("plan: the eye is below, the window above", fontsize=9)
    upright = np.abs(elements.normals[:, 2]) < 0.5
    colours = np.clip(elements.radiosity / np.pi / 1.2, 0, 1) ** (1 / 2.2)
    for corners, colour in zip(elements.corners[upright], colours[upright]):
        ends = corners[:, :2]
        left.plot(ends[:, 0], ends[:, 1], color=colour, linewidth=2.5)
    left.plot(2, -2.35, "k^")
    left.set_aspect("equal")
    left.set_facecolor("#BBBBBB")
    left.set(xlabel="m", ylabel="m")
    right.imshow(charts.shown(radiance, 1.6), interpolation="nearest")
    right.set_title("what the eye sees: white faces alone", fontsize=9)
    right.set_axis_off()
    figure.savefig(out / "scene.png", dpi=charts.DPI)
    charts.pyplot.close(figure)
    outcome.found = (f"all that is seen reflects {seen}; colourfulness {percent(colourfulness(radiance))}, with white backs "
                     f"{percent(colourfulness(plain))}")
    outcome.expect("all that is seen is white", np.ptp(reflectance) < 1e-3)
    outcome.expect("painted backs make it at least three times as colourful as white ones",
                   colourfulness(radiance) > 3 * colourfulness(plain))
    return outcome


def dearest(out):
    phases = ("subdivision", "visibility", "form_factors", "solve")
    outcome = Outcome(("scene", "form factors", "elements", *(f"{phase.replace('_', ' ')}, s" for phase in phases),
                       "visibility's share"), [], "")
    shares, bars = {}, []
    for scene in (SCENE, "office-2391"):
        for rule in ("point", "adaptive"):
            size = 48
            report = solve(scene, resolution=(size, size), form_factor=rule).report
            seconds = [report["cpu_s"].get(phase, 0) for phase in phases]
            shares[scene, rule] = seconds[1] / sum(seconds)
            bars.append((f"{scene}\n{'eq. (6)' if rule == 'point' else rule}", np.array(seconds) / sum(seconds)))
            outcome.rows.append((scene, rule, report["elements"], *(f"{value:.3f}" for value in seconds),
                                 percent(shares[scene, rule])))
    figure, axes = charts.axes_of("", "share of the processor time", "Phases of a run, 48 x 48 pixels", log_x=False, log_y=False)
    bottom = np.zeros(len(bars))
    for number, phase in enumerate(phases):
        heights = np.array([of[number] for _, of in bars])
        axes.bar([name for name, _ in bars], heights, bottom=bottom, color=charts.COLOURS[number], label=phase.replace("_", " "))
        bottom += heights
    axes.set_ylim(0, 1.35)
    axes.tick_params(axis="x", labelsize=8)
    charts.save(figure, axes, out / "phases.png")
    outcome.found = "visibility takes " + ", ".join(f"{percent(share)} ({scene}, {rule})" for (scene, rule),
                                                    share in shares.items())
    outcome.expect("office-2391 with eq. (6): visibility is the largest phase, as in the paper",
                   shares["office-2391", "point"] > 0.5)
    outcome.expect("with `adaptive` visibility takes less than a fifth in both scenes",
                   max(share for (_, rule), share in shares.items() if rule == "adaptive") < 0.2)
    return outcome


def figure_3(out):
    sizes = (32, 64, 128, 256, 512, 1024)
    bench("visibility", "subdivision", "--only", SCENE, "--resolutions", ",".join(map(str, sizes)), "--repeat", 3, "--out",
          out / "subdivision.csv")
    preparing = {int(row["resolution"]): row for row in rows_of(out / "subdivision.csv")}
    seeing = {}
    for size in sizes[:4]:
        with tempfile.TemporaryDirectory() as folder:
            report = solve(SCENE, resolution=(size, size), threads=1, visibility_only=True, checkpoint=folder).report
        seeing[size] = report["cpu_s"]["visibility"], report["elements"]
    outcome = Outcome(("pixels", "elements seen", "preprocessing, s", "elements in all", "visibility matrix, s"), [], "")
    seconds = [preparing[size]["raster_seconds"] + preparing[size]["split_seconds"] for size in sizes]
    for size, value in zip(sizes, seconds):
        matrix = seeing.get(size)
        outcome.rows.append((f"{size} x {size}", int(preparing[size]["elements"]), f"{value:.4f}", matrix[1] if matrix else "",
                             f"{matrix[0]:.3f}" if matrix else ""))
    figure, axes = charts.axes_of("pixels a side R", "processor time on one core [s]", "Construction in wood: time against the "
                                                                                       "camera's resolution")
    charts.draw(axes, sizes, seconds, "preprocessing (raster and splitting)", 0)
    charts.draw(axes, list(seeing), [value for value, _ in seeing.values()], "visibility matrix", 1)
    charts.reference_line(axes, sizes, [seconds[-1] / (sizes[-1] / sizes[0]) ** 2], 2, "R²: the number of pixels")
    charts.ticks(axes, sizes)
    charts.save(figure, axes, out / "resolution.png")
    # Below 128 pixels the time is that of starting.
    power = charts.law(sizes[2:], seconds[2:])
    ends = list(seeing)[-2:]
    matrix_power = charts.law(ends, [seeing[size][0] for size in ends])
    outcome.found = (f"preprocessing grows as R^{power:.2f} from 128 to 1024 pixels ({seconds[-1]:.2f} s for "
                     f"{int(preparing[1024]['elements']):,} elements), the visibility "
                     f"matrix as R^{matrix_power:.2f} from {ends[0]} to {ends[1]} ({seeing[256][0]:.2f} s)")
    outcome.expect("preprocessing grows as R^1.8 to R^2.3, as the number of pixels", 1.8 <= power <= 2.3)
    outcome.expect("preprocessing at 256 pixels takes less than a fifth of the visibility matrix",
                   seconds[3] < 0.2 * seeing[256][0])
    return outcome


def figure_4(out):
    sizes = (1000, 2000, 4000, 8000, 16000, 32000)
    bench("visibility", "visibility", "--only", SCENE, "--sizes", ",".join(map(str, sizes)), "--repeat", 3, "--out",
          out / "visibility.csv")
    rows = rows_of(out / "visibility.csv")
    count = [row["elements"] for row in rows]
    ours, tree = [row["seconds"] for row in rows], [row["classical_seconds"] for row in rows]
    brute = []
    for edge in (1.2, 0.9, 0.7, 0.55):
        elements = solve(SCENE, subdivision="uniform", max_edge=edge, form_factor="point", resolution=(16, 16)).elements
        start = time.process_time()
        blocked_pairs(elements)
        brute.append((len(elements), time.process_time() - start))
    powers = charts.law(count, ours), charts.law(count, tree), charts.law(*zip(*brute))
    outcome = Outcome(("elements N", "patches occlude (Fluxel), s", "elements occlude, in Embree's tree, s",
                       "every element tested, s"), [], "")
    outcome.rows = [(number, "", "", f"{value:.2f}") for number, value in brute]
    outcome.rows += [(f"{number:.0f}", f"{a:.3f}", f"{b:.3f}", "") for number, a, b in zip(count, ours, tree)]
    figure, axes = charts.axes_of("elements N", "time of the visibility matrix on one core [s]",
                                  "Construction in wood: patches as occluders against the elements")
    charts.draw(axes, *zip(*brute), f"classical: every element tested (NumPy): N$^{{{powers[2]:.2f}}}$", 0, "--")
    charts.draw(axes, count, tree, f"elements occlude, found by Embree: N$^{{{powers[1]:.2f}}}$", 3, "--")
    charts.draw(axes, count, ours, f"patches occlude (Fluxel): N$^{{{powers[0]:.2f}}}$", 1)
    charts.reference_line(axes, [number for number, _ in brute], [brute[0][1]], 3, "the paper: N³ classical")
    charts.reference_line(axes, count, [tree[0] * 1.6], 2, "the paper: N² of its method")
    charts.save(figure, axes, out / "elements.png")
    outcome.found = (f"N^{powers[0]:.2f} with patches as occluders, N^{powers[1]:.2f} with elements in Embree's tree, "
                     f"N^{powers[2]:.2f} with every element tested; at "
                     f"{count[-1]:,.0f} elements {ours[-1]:.2f} s against {tree[-1]:.1f} s")
    outcome.expect("testing every element grows as N^2.7 to N^3.2: the paper's cubic", 2.7 <= powers[2] <= 3.2)
    outcome.expect("with patches as occluders the power is at most 1.9: below the paper's quadratic", powers[0] <= 1.9)
    outcome.expect("elements as occluders take at least five times as long at the largest size", tree[-1] > 5 * ours[-1])
    return outcome


def table(out):
    command = [sys.executable, str(ROOT / "bench/speedup/speedup.py"), "--resolution", "40x40", "--out", str(out)]
    print(f"\n{' '.join(command[1:])}", flush=True)
    if subprocess.run(["bash", "-c", f'source "{ROOT}/scripts/mpi-env.sh"; exec "$@"', "bash", *command], check=False).returncode:
        sys.exit("the table could not be measured")
    runs = {int(row["ranks"]): row for row in rows_of(out / "speedup.csv")}
    outcome = Outcome(("processors", "paper, s", "paper, speed-up over 2", "over one worker, a worker", "Fluxel, s",
                       "speed-up over 1", "processor time over 1 rank's"), [], "")
    for ranks, run in runs.items():
        seconds = PAPER_SECONDS.get(ranks)
        paper = (seconds, f"{PAPER_SECONDS[2] / seconds:.2f}",
                 f"{PAPER_SECONDS[2] / seconds / (ranks - 1):.2f}") if seconds else ("", "", "")
        speedup = runs[1]["wall_s"] / run["wall_s"]
        outcome.rows.append((ranks, *paper, f"{run['wall_s']:.1f}", f"{speedup:.2f}" if ranks <= CORES else "-",
                             f"{run['cpu_inflation']:.2f}"))
    share = {ranks: PAPER_SECONDS[2] / seconds / (ranks - 1) for ranks, seconds in PAPER_SECONDS.items()}
    figure, axes = charts.axes_of("processors", "speed-up a processor that computes", "The paper's table, and Fluxel's",
                                  log_x=False, log_y=False)
    charts.draw(axes, list(share), list(share.values()), "paper: over 2 processors, of which one computes", 3)
    charts.draw(axes, [ranks for ranks in runs if ranks <= CORES],
                [runs[1]["wall_s"] / run["wall_s"] / ranks for ranks, run in runs.items() if ranks <= CORES],
                f"Fluxel: over one rank, on {CORES} cores", 1)
    charts.draw(axes, list(runs), [1 / run["cpu_inflation"] for run in runs.values()], "Fluxel: processor time of one rank "
                                                                                       "over that of all", 2, "--")
    axes.axhline(1, color="#555555", linestyle=":", label="linear")
    axes.set_ylim(0, 1.6)
    charts.save(figure, axes, out / "efficiency.png")
    most = min(CORES, max(runs))
    speedup, inflation = runs[1]["wall_s"] / runs[most]["wall_s"], runs[max(runs)]["cpu_inflation"]
    outcome.found = (f"{speedup:.2f} times as fast on {most} ranks as on one ({runs[1]['wall_s']:.1f} s); {max(runs)} ranks "
                     f"take {inflation:.2f} times the processor time "
                     f"of one. The paper's own figures are {min(share.values()):.2f} to {max(share.values()):.2f} times linear "
                     "in the processors that compute")
    outcome.expect(f"on {most} ranks, as many as there are cores, at least 0.75 of linear (on a machine that does nothing else)",
                   speedup >= 0.75 * most)
    outcome.expect(f"{max(runs)} ranks take at most 1.3 times the processor time of one", inflation <= 1.3)
    return outcome


ROWS = (
    Row("figure-2", "5.1, Fig. 2", "the scene: construction in wood",
        "every surface towards the eye is white; light from behind and painted backs colour them",
        "plan and picture of `scenes/construction-in-wood`, whose sizes are its own, and the same with white backs", 0.2,
        "reproduced", figure_2),
    Row("claim-dearest", "5.1", "visibility is the dearest part",
        "of preprocessing, visibility and solution, visibility takes longest",
        "processor time of the phases of two scenes at 48 x 48 pixels, with eq. (6) and with `adaptive`", 1,
        "confirmed with eq. (6) where patches are many; with exact form factors these take longest", dearest),
    Row("figure-3", "5.1, Fig. 3", "time against the camera's resolution",
        "a curve of the time of preprocessing (the text: of visibility) against resolution, without figures",
        "both for the construction in wood, one core", 0.5,
        "reproduced: preprocessing is proportional to the pixels", figure_3),
    Row("figure-4", "5.1, Fig. 4", "visibility against the number of elements",
        "cubic by the classical method, about quadratic where rays meet the scene's patches first",
        "three ways for the construction in wood, one core: patches as occluders, elements in a tree, every element tested", 1,
        "confirmed, and better: below quadratic", figure_4),
    Row("table", "5.2", "time on 2 to 10 processors",
        "6500 s on 2 to 503 s on 10 processors (12.92 times as fast), nearly linear; the abstract has a coefficient below 1",
        "`bench/speedup` on `scenes/office-2391`, as many triangles as the paper's lost scene, at 40 x 40 pixels on 1 to 10 "
        "ranks", 4,
        "nearly linear as far as there are cores (other hardware); the paper's own table is more than linear, against its "
        "abstract", table),
)
