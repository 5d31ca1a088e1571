"""Section 4 of the paper: sub-scenes, and a master that deals tasks."""

import csv

import charts
from outcome import ROOT, Outcome, Row
from runs import bench, error, percent, solve, truth

RANKS = (2, 4, 8)
LAMP = 4  # [W/(m2 sr)], less than any lamp's radiance and more than what it lights


def subscenes(out):
    scenes = {"construction-in-wood": 64, "cornell-box": 64}
    outcome = Outcome(("scene", "sub-scenes", "ranks", "elements", "error of the picture"), [], "")
    errors, counts, finer = {}, {}, {}
    for scene, size in scenes.items():
        reference = truth(scene, size)
        # A lamp that is seen is exact, and so bright that the rest would not count.
        where = reference.values.max(axis=2) < LAMP
        options = {"resolution": (size, size), "supersample": 1, "subdivision": "camera", "threads": 1}

        def measure(name, ranks, scene=scene, reference=reference, where=where, options=options, **others):
            solution = solve(scene, ranks=ranks, **options, **others)
            found = error(solution.picture.values, reference, where)
            outcome.rows.append((scene, name, ranks, len(solution.elements), percent(found)))
            return found, len(solution.elements)

        errors[scene, 1], counts[scene, 1] = measure("merged", 2)
        for ranks in RANKS:
            errors[scene, ranks], counts[scene, ranks] = measure("independent", ranks, subscenes="independent")
        # The same work in another way: smaller elements where the camera does not look.
        edge = solve(scene, **options, dry_run=True).report["subdivision"]["max_edge_m"]
        finer[scene] = measure("merged, --max-edge over 1.3", 2, max_edge=edge / 1.3)[0]
    figure, axes = charts.axes_of("ranks (1: merged, whatever their number)", "error of the picture", "Independent sub-scenes",
                                  log_y=False)
    for number, scene in enumerate(scenes):
        charts.draw(axes, (1, *RANKS), [errors[scene, ranks] for ranks in (1, *RANKS)], scene, number)
    axes.set_ylim(bottom=0)
    charts.ticks(axes, (1, *RANKS))
    charts.save(figure, axes, out / "subscenes.png")
    outcome.found = "; ".join(f"{scene}: {percent(errors[scene, 1])} merged, "
                              f"{', '.join(percent(errors[scene, ranks]) for ranks in RANKS)} independent on "
                              f"{', '.join(map(str, RANKS))} ranks with "
                              f"{', '.join(f'{counts[scene, ranks] / counts[scene, 1]:.2f}' for ranks in RANKS)} times the "
                              f"elements" for scene in scenes)
    wood, box = scenes
    outcome.found += f"; smaller elements everywhere: {percent(finer[wood])} and {percent(finer[box])}"
    outcome.expect(f"{wood}: on every number of ranks the error falls by a tenth or more",
                   all(errors[wood, ranks] < 0.9 * errors[wood, 1] for ranks in RANKS))
    outcome.expect(f"{wood}: smaller elements wherever the camera does not look gain less than that",
                   finer[wood] > max(errors[wood, ranks] for ranks in RANKS))
    outcome.expect(f"{box}: the error changes by less than a twentieth",
                   all(abs(errors[box, ranks] / errors[box, 1] - 1) < 0.05 for ranks in RANKS))
    return outcome


def master(out):
    outcome = Outcome(("task", "ranks", "tasks", "messages", "idle", "efficiency"), [], "")
    traced, machine = out / "office.traced", ROOT / "bench/results/scaling/machine.json"
    bench("simulate", "trace", "--scene", "office-2391", "--elements", 8000, "--blocks", 128, "--tiles", 1, "--out", traced)
    bench("simulate", "tasks", traced, "--machine", machine, "--out", out / "tasks.csv")
    with open(out / "tasks.csv", newline="", encoding="utf-8") as file:
        rows = {(row["task"], int(row["ranks"])): row for row in csv.DictReader(file)}
    shown = [ranks for task, ranks in rows if task == "strip" and ranks in (2, 3, 5, 10, 32, 64)]
    efficiency = {key: float(row["visibility_efficiency"]) for key, row in rows.items()}
    for ranks in shown:
        for task in ("strip", "pair of patches"):
            row = rows[task, ranks]
            outcome.rows.append((f"{task} (simulated)", ranks, row["strips"], row["messages"], percent(float(row["idle"])),
                                 f"{efficiency[task, ranks]:.2f}"))
        outcome.rows.append(("one rank that only deals, at best", ranks, "", "", "", f"{(ranks - 1) / ranks:.2f}"))
    detail = solve("office-2391", ranks=2, threads=1, resolution=(48, 48), form_factor="disc").report["ranks_detail"]
    parts = [rank["visibility"] for rank in detail]
    busy = [part["busy_s"] for part in parts]
    waiting = sum(part["waiting_s"] for part in parts)
    waiting /= waiting + sum(part["busy_s"] + part["message_s"] for part in parts)
    share = busy[0] / sum(busy)
    outcome.rows.append(("strip (a run)", 2, "", "", percent(waiting), ""))
    figure, axes = charts.axes_of("ranks", "parallel efficiency", "Visibility of office-2391, 8,400 elements: strips, pairs of "
                                                                  "patches", log_y=False)
    for number, (task,
                 label) in enumerate((("strip", "strips (Fluxel), simulated"), ("pair of patches", "pairs of patches, simulated"))):
        charts.draw(axes, shown, [efficiency[task, ranks] for ranks in shown], label, number)
    charts.draw(axes, shown, [(ranks - 1) / ranks for ranks in shown], "a master that only deals, at best", 2, ":")
    axes.set_ylim(0, 1.05)
    charts.ticks(axes, shown)
    charts.save(figure, axes, out / "master.png")
    outcome.found = (f"simulated efficiency of strips {efficiency['strip', 2]:.2f}, {efficiency['strip', 10]:.2f}, "
                     f"{efficiency['strip', 64]:.2f} on 2, 10, 64 ranks, of "
                     f"pairs of patches {efficiency['pair of patches', 2]:.2f}, {efficiency['pair of patches', 10]:.2f}, "
                     f"{efficiency['pair of patches', 64]:.2f}; a run on 2 ranks waits {percent(waiting)} of the phase, and "
                     f"its rank 0, which deals, computes "
                     f"{percent(share)} of the work")
    outcome.expect("strips: at least 0.9 on 10 ranks (simulated)", efficiency["strip", 10] >= 0.9)
    outcome.expect("strips are ahead of pairs of patches on every number of ranks",
                   all(efficiency["strip", ranks] > efficiency["pair of patches", ranks] for ranks in shown))
    outcome.expect("on two ranks the one that deals computes at least 0.4 of the work", share >= 0.4)
    outcome.expect("these two wait for at most a tenth of the phase", waiting <= 0.1)
    return outcome


ROWS = (
    Row("claim-subscenes", "4.2", "independent sub-scenes",
        "each process subdivides its part of the scene by itself; what others hide is then subdivided too, which makes the "
        "picture more realistic",
        "`--subscenes independent` on 2 to 8 ranks against `merged` and against smaller elements everywhere, all against paths "
        "of light, lamps left out", 2.5,
        "confirmed in the construction in wood, where hidden faces light what is seen; no gain in the Cornell box", subscenes),
    Row("claim-master", "4.3", "a master that deals tasks",
        "a master deals blocks or strips of the visibility matrix on demand, so that hardly anyone is idle; it computes "
        "nothing itself, which matters less "
        "the more there are; strips are better where patches are many",
        "simulation of strips and of pairs of patches, and a run of two ranks", 0.5,
        "confirmed for strips; the master need not be idle", master),
)
