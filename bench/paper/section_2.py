"""Section 2 of the paper: form factors by one ray or several, one bit a pair."""

import numpy as np

import charts
from method_tables import difference
from outcome import Outcome, Row
from runs import error, percent, scene_file, solve, truth


def norm(out):
    outcome = Outcome(("elements a wall's edge", "form factors", "largest rho times row sum", "solver"), [], "")
    norms, diverged = {}, []
    sizes = (1, 2, 4, 8, 16)
    for n in sizes:
        for rule in ("point", "disc", "adaptive"):
            report = solve(scene_file("furnace").with_name("furnace-0.9.toml"), subdivision="uniform", max_edge=1.001 / n,
                           form_factor=rule,
                           solver="jacobi").report
            norms[rule, n] = 0.9 * report["form_factor"]["row_sum_max"]
            converged = report["solve"]["converged"]
            if rule == "point" and not converged:
                diverged.append(n)
            outcome.rows.append((n, rule, f"{norms[rule, n]:.4f}", "converged" if converged else "diverged"))
    figure, axes = charts.axes_of("elements along a wall's edge", "largest rho times row sum",
                                  "Norm of the matrix, closed cube, rho = 0.9",
                                  log_y=False)
    for number, (rule, label) in enumerate((("point", "eq. (6)"), ("disc", "disc"), ("adaptive", "adaptive"))):
        charts.draw(axes, sizes, [norms[rule, n] for n in sizes], label, number)
    axes.axhline(1, color="#555555", linestyle=":", label="1: the paper's bound")
    charts.ticks(axes, sizes)
    charts.save(figure, axes, out / "norm.png")
    outcome.found = (f"eq. (6): {norms['point', 1]:.2f} with one element a wall to {norms['point', 16]:.2f} with 16 x 16, "
                     f"Jacobi's method diverges "
                     f"with {', '.join(f'{n} x {n}' for n in diverged) or 'none'}; `adaptive` at most "
                     f"{max(norms['adaptive', n] for n in sizes):.4f}")
    outcome.expect("with `adaptive` the norm is rho, within 0.002", all(abs(norms["adaptive", n] - 0.9) < 0.002 for n in sizes))
    outcome.expect("with eq. (6) the norm is above 1 at some size", max(norms["point", n] for n in sizes) > 1)
    outcome.expect("with eq. (6) Jacobi's method diverges at some size", diverged)
    return outcome


def equation_6(out):
    scenes, sizes = ("construction-in-wood", "emitting-wall"), (25, 50, 100)
    outcome = Outcome(("scene", "pixels", "form factors", "elements", "largest row sum", "error of the picture"), [], "")
    errors, sums = {}, {}
    for scene in scenes:
        for size in sizes:
            reference = truth(scene, size)
            for rule in ("point", "adaptive"):
                # Scenes have other rules for what is unseen and for subdivision; the camera is to decide alone.
                solution = solve(scene, resolution=(size, size), supersample=1, form_factor=rule, subdivision="camera")
                errors[scene, rule, size] = error(solution.picture.values, reference)
                sums[scene, rule, size] = solution.report["form_factor"]["row_sum_max"]
                outcome.rows.append((scene, f"{size} x {size}", rule, len(solution.elements), f"{sums[scene, rule, size]:.3f}",
                                     percent(errors[scene, rule, size])))
    figure, axes = charts.axes_of("pixels a side", "error of the picture", "No element above a pixel: one ray a pair against "
                                                                           "adaptive")
    for number, (scene, rule) in enumerate((scene, rule) for scene in scenes for rule in ("point", "adaptive")):
        charts.draw(axes, sizes, [errors[scene, rule, size] for size in sizes],
                    f"{scene}, {'eq. (6)' if rule == 'point' else rule}", number)
    charts.ticks(axes, sizes)
    charts.save(figure, axes, out / "equation-6.png")

    def series(rule, scene):
        return ", ".join(percent(errors[scene, rule, size]) for size in sizes)

    outcome.found = "; ".join(f"{scene} at {', '.join(map(str, sizes))} pixels: eq. (6) {series('point', scene)}, adaptive "
                              f"{series('adaptive', scene)}"
                              for scene in scenes)
    for scene in scenes:
        outcome.expect(f"{scene}: at {sizes[-1]} pixels eq. (6) errs at least twice as much as `adaptive`",
                       errors[scene, "point", sizes[-1]] > 2 * errors[scene, "adaptive", sizes[-1]])
    outcome.expect("with eq. (6) row sums stay above 1.1 at every size",
                   min(sums[scene, "point", size] for scene in scenes for size in sizes) > 1.1)
    return outcome


def one_bit(out):
    outcome = Outcome(("scene", "elements", "form factors as doubles, MB", "one bit a pair, MB", "visibility as kept, MB",
                       "bits a pair"), [], "")
    bits = {}
    for scene in ("construction-in-wood", "cornell-box", "office-2391"):
        report = solve(scene, resolution=(100, 100), form_factor="point").report
        pairs = report["elements"] ** 2
        bits[scene] = 8 * report["visibility"]["bytes"] / pairs
        outcome.rows.append((scene, report["elements"], f"{8e-6 * pairs:.0f}", f"{pairs / 8e6:.1f}",
                             f"{1e-6 * report['visibility']['bytes']:.2f}",
                             f"{bits[scene]:.3f}"))
    figure, axes = charts.axes_of("bits a pair of elements", "", "Memory of a pair, 100 x 100 pixels", log_y=False)
    names = ["form factor (double)", "the paper: one bit", *(f"Fluxel, {scene}" for scene in bits)]
    axes.barh(names, [64, 1, *bits.values()], color=[charts.COLOURS[7]] * 2 + [charts.COLOURS[1]] * len(bits))
    axes.bar_label(axes.containers[0], [f" {value:.3g}" for value in (64, 1, *bits.values())])
    axes.set_xlim(0.01, 300)
    axes.invert_yaxis()
    axes.grid(False, axis="y")
    figure.savefig(out / "bits.png", dpi=charts.DPI)
    charts.pyplot.close(figure)
    outcome.found = ", ".join(f"{scene} {value:.3f}" for scene, value in bits.items()) + " bits a pair"
    outcome.expect("less than half a bit a pair in every scene", max(bits.values()) < 0.5)
    return outcome


def several_points(out):
    scene, size = "cornell-box", 24
    options = {"resolution": (size, size), "tolerance": 1e-4}
    exact = solve(scene, form_factor_tolerance=1e-5, **options).elements
    outcome = Outcome(("points on each element", "rays, million", "form factors, s", "error (rms)", "largest error of an element"),
                      [], "")
    found = []
    for n in (1, 2, 3, 4):
        solution = solve(scene, form_factor=f"points:{n}x{n}", **options)
        rms, _, largest = difference(solution.elements, exact)
        found.append((solution.report["form_factor"]["rays"], rms))
        outcome.rows.append((f"{n} x {n}", f"{1e-6 * found[-1][0]:.2f}", f"{solution.report['time_s']['form_factors']:.2f}",
                             percent(rms),
                             percent(largest)))
    figure, axes = charts.axes_of("rays", "error (rms over the mean)", "Several points on each element, Cornell box, 24 x 24 "
                                                                       "pixels")
    charts.draw(axes, *np.transpose(found), "1 x 1, 2 x 2, 3 x 3, 4 x 4 points", 1)
    charts.save(figure, axes, out / "points.png")
    growth = found[-1][0] / found[0][0]
    outcome.found = (f"{', '.join(percent(rms) for _, rms in found)} with 1 x 1 to 4 x 4 points on both; 4 x 4 take {growth:.0f} times "
                     "as many rays")
    outcome.expect("the error falls with every step", all(fine[1] < coarse[1] for coarse, fine in zip(found, found[1:])))
    outcome.expect("16 points on each of two elements take 256 times the rays, within a tenth", abs(growth / 256 - 1) < 0.1)
    return outcome


ROWS = (
    Row("claim-norm", "2.2", "the matrix has a norm below 1",
        "the largest row sum of reflectance times form factors is below 1, so that iterations converge",
        "the closed cube with rho = 0.9, whose exact norm is 0.9, with eq. (6), `disc` and `adaptive`, by Jacobi's method", 0.3,
        "true of exact form factors, refuted for eq. (6)", norm),
    Row("claim-equation-6", "2.2, eq. (6)", "one ray between centres suffices below the pixel",
        "artifacts of eq. (6) come from elements that are too large; where none is above a pixel, form factors reduce to "
        "visibility",
        "two scenes with elements of a pixel at most, with eq. (6) (with the 1/pi that the print lacks) and with `adaptive`, "
        "against paths of light",
        2.5, "refuted: the error falls, and stays a multiple of that with exact factors, as elements that touch have wrong ones at "
        "any size", equation_6),
    Row("claim-one-bit", "2.2, remark", "one bit a pair",
        "visibility takes one bit a pair in place of 64 of a form factor",
        "what the visibility of three scenes takes at 100 x 100 pixels", 0.3, "confirmed, and compressed further", one_bit),
    Row("claim-several-points", "2.2, method 2", "several points on each element",
        "many points come close to the factor, at a cost that grows with the rays",
        "the Cornell box at 24 x 24 pixels with 1 to 16 points on each element, against the same elements by `adaptive` at a "
        "tolerance of 1e-5",
        0.4, "confirmed", several_points),
)
