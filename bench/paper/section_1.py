"""Section 1 of the paper: filters, and rendering below the pixel."""

import numpy as np

import charts
from filters import box, gaussian, gaussian_mean
from outcome import Outcome, Row
from runs import error, percent, picture, solve, truth

SCENE = "construction-in-wood"
WHITE = 1.6  # [W/(m2 sr)], of its pictures


def near_edges(solution):
    """(rows, columns): whether another patch is within a pixel."""
    shown = solution.elements.patch[solution.picture["element"].astype(int)]
    around = np.lib.stride_tricks.sliding_window_view(np.pad(shown, 1, mode="edge"), (3, 3))
    return (around != shown[..., None, None]).any(axis=(2, 3))


def filters(out):
    size = 70
    points, means = truth(SCENE, size), truth(SCENE, size, area=True)
    outcome = Outcome(("form factors", "filter", "error at points", "within a pixel of an edge", "elsewhere",
                       "error of pixels' means"), [], "")
    found, shown = {}, []
    for rule in ("point", "adaptive"):
        solution = solve(SCENE, resolution=(size, size), supersample=1, form_factor=rule)
        plain = solution.picture.values
        edges = near_edges(solution)
        median = picture(SCENE, size, form_factor=rule, filter="median:1").values
        for name, image in (("none", plain), ("Gaussian 0.5 px", gaussian(plain, 0.5)), ("Gaussian 1 px", gaussian(plain, 1)),
                            ("Gaussian 1.5 px", gaussian(plain, 1.5)), ("median 3 x 3 px", median)):
            errors = error(image, points), error(image, points, edges), error(image, points, ~edges), error(image, means)
            found[rule, name] = errors
            outcome.rows.append((rule, name, *map(percent, errors)))
            if rule == "point" and "0.5" not in name:
                shown.append((f"eq. (6), filter: {name}\nerror {percent(errors[0])}", charts.shown(image, WHITE)))
    charts.panels([*shown, ("paths of light", charts.shown(points.values, WHITE))], out / "filters.png")
    of_paper = ("Gaussian 1 px", "Gaussian 1.5 px", "median 3 x 3 px")
    outcome.found = "with eq. (6) " + "; ".join(f"{name}: {percent(found['point', name][0])} at points, "
                                                f"{percent(found['point', name][3])} of means"
                                                for rule, name in found if rule == "point")
    for rule in ("point", "adaptive"):
        outcome.expect(f"`{rule}`: Gaussians of 1 px and more and a median make the error at points larger",
                       all(found[rule, name][0] > found[rule, "none"][0] for name in of_paper))
        means_of = {name: found[rule, name][3] for of_rule, name in found if of_rule == rule}
        outcome.expect(f"`{rule}`: a Gaussian of 1.5 px makes that of pixels' means larger, one of half a pixel and a median "
                       f"make it smaller",
                       means_of["Gaussian 1.5 px"] > means_of["none"] > max(means_of["Gaussian 0.5 px"],
                                                                            means_of["median 3 x 3 px"]))
    return outcome


def subpixel(out):
    size = 48
    reference = truth(SCENE, size, area=True)
    outcome = Outcome(("rays a pixel", "elements", "error, plain mean", "error, Gaussian of half a pixel"), [], "")
    found, shown = [], []
    for factor in (1, 2, 3, 4):
        solution = solve(SCENE, resolution=(size * factor, size * factor), supersample=1, form_factor="disc")
        fine = solution.picture.values
        plain = box(fine, factor)
        errors = error(plain, reference), error(gaussian_mean(fine, factor, 0.5), reference)
        found.append(errors)
        outcome.rows.append((f"{factor} x {factor}", len(solution.elements), *map(percent, errors)))
        shown.append((f"{factor} x {factor} rays a pixel\nerror {percent(errors[0])}", charts.shown(plain, WHITE)))
    own = error(picture_of_option(size, 4), reference)
    charts.panels([*shown, ("paths of light", charts.shown(reference.values, WHITE))], out / "subpixel.png")
    outcome.found = (f"{', '.join(percent(plain) for plain, _ in found)} with 1, 2 x 2, 3 x 3 and 4 x 4 rays a pixel; averaged "
                     f"by a Gaussian "
                     f"{percent(found[-1][1])} at the end")
    outcome.expect("the error falls with every step", all(fine[0] < coarse[0] for coarse, fine in zip(found, found[1:])))
    outcome.expect("4 x 4 rays at least halve it", found[-1][0] < 0.5 * found[0][0])
    outcome.expect("from 3 x 3 rays a plain mean is better than a Gaussian", all(plain < blurred for plain, blurred in found[2:]))
    outcome.expect("`--supersample 4` is the same picture", abs(own / found[-1][0] - 1) < 1e-3)
    return outcome


def picture_of_option(size, factor):
    return solve(SCENE, resolution=(size, size), supersample=factor, form_factor="disc").picture.values


ROWS = (
    Row("claim-filter", "1", "filters take artifacts away",
        "what artifacts are left are of a pixel at most; a low-pass filter, Gaussian or median, removes them",
        "the construction in wood at 70 x 70 pixels, unfiltered and filtered, against paths of light: at the points that "
        "pixels show, "
        "near edges of patches and elsewhere, and against the mean of each pixel", 1,
        "refuted for a Gaussian of 1 px and more, which blurs edges; where a pixel is to show its mean, a median helps, as "
        "more rays do", filters),
    Row("claim-subpixel", "1", "rendering below the pixel",
        "where a filter blurs too much, subdivide and render for a finer grid, and average",
        "the construction in wood at 48 x 48 pixels of 1 to 16 rays, each of which decides on elements, against the mean of each "
        "pixel by paths of light", 0.8, "confirmed", subpixel),
)
