"""Section 6 of the paper: the three pictures."""

import charts
from filters import gaussian
from outcome import Outcome, Row
from runs import error, percent, solve, truth

SCENE = "construction-in-wood"
WHITE = 1.6  # [W/(m2 sr)], of its pictures


def three_pictures(out):
    outcome = Outcome(("picture", "form factors", "elements", "error"), [], "")
    errors, shown = {}, []
    coarse = {"subdivision": "uniform", "max_edge": 1e9}
    # Eq. (6), the paper's rule, has no solution without subdivision; the disc is bounded at any distance.
    for name, rule, size, options in (("no subdivision", "disc", 70, coarse), ("50 x 50", "disc", 50, {}),
                                      ("70 x 70", "disc", 70, {}),
                                      ("70 x 70, Gaussian 1 px", "disc", 70, {}), ("no subdivision", "point", 70, coarse)):
        solution = solve(SCENE, resolution=(size, size), supersample=1, form_factor=rule, **options)
        if not solution.converged:
            outcome.rows.append((name, rule, len(solution.elements), "diverged"))
            continue
        image = solution.picture.values
        if "Gaussian" in name:
            image = gaussian(image, 1)
        errors[name, rule] = error(image, truth(SCENE, size))
        outcome.rows.append((name, rule, len(solution.elements), percent(errors[name, rule])))
        shown.append((f"{name}\n{len(solution.elements)} elements, error {percent(errors[name, rule])}",
                      charts.shown(image, WHITE)))
    charts.panels([*shown, ("paths of light", charts.shown(truth(SCENE, 70).values, WHITE))], out / "pictures.png")
    none = errors.get(("no subdivision", "disc"), float("inf"))
    fifty, seventy, filtered = (errors[name, "disc"] for name in ("50 x 50", "70 x 70", "70 x 70, Gaussian 1 px"))
    outcome.found = (f"no subdivision {percent(none)}, 50 x 50 {percent(fifty)}, 70 x 70 {percent(seventy)}, that with the "
                     f"Gaussian {percent(filtered)}; with eq. (6) "
                     "the scene without subdivision has no solution")
    outcome.expect("the error falls from no subdivision to 50 x 50 to 70 x 70 pixels", none > fifty > seventy)
    outcome.expect("subdivision at least halves it", seventy < 0.5 * none)
    outcome.expect("the Gaussian filter makes it larger", filtered > seventy)
    outcome.expect("without subdivision eq. (6) diverges", ("no subdivision", "point") not in errors)
    return outcome


ROWS = (
    Row("three-pictures", "6", "no subdivision, 50 x 50, 70 x 70 with a Gaussian",
        "artifacts become fewer with the camera's resolution; the third picture is filtered",
        "the same of the construction in wood, as the paper's scene is lost, with `disc`, against paths of light", 0.6,
        "confirmed for the resolution, refuted for the filter", three_pictures),
)
