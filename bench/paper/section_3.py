"""Section 3 of the paper: subdivision by the camera."""

import numpy as np

import charts
from outcome import Outcome, Row
from raster_loop import Camera, corrected_bound, eq_7, steps
from runs import error, percent, scene_file, solve, truth

SCENE = "three-rectangles"
NAMES = ("light", "shade", "screen")  # of its rectangles, in the order of its file
SHOWN = 128  # pixels a side of Fig. 1's pictures
WHITE = 0.35  # [W/(m2 sr)], of its pictures


def rectangles():
    """(3, 4, 3): as its file has them."""
    lines = scene_file(SCENE).with_suffix(".obj").read_text(encoding="utf-8").splitlines()
    vertices = [list(map(float, line.split()[1:])) for line in lines if line.startswith("v ")]
    return np.array(vertices).reshape(3, 4, 3)


def camera_of(size):
    """That of its scene file."""
    return Camera(np.array([3.0, -7.4, 2.5]), np.array([0.0, 0.0, 1.3]), np.array([0.0, 0.0, 1.0]), np.radians(48), size)


def write_scene(path, elements):
    """The elements of a step as polygons of a scene of their own."""
    lines = [f"mtllib {scene_file(SCENE).with_suffix('.mtl')}"]
    count = 0
    for name, corners in zip(NAMES, elements):
        lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in corners.reshape(-1, 3)]
        lines.append(f"usemtl {name}")
        lines += [f"f {n + 1} {n + 2} {n + 3} {n + 4}" for n in range(count, count + 4 * len(corners), 4)]
        count += 4 * len(corners)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def radiance_of(path, elements):
    """The picture of the scene with these elements."""
    camera = camera_of(SHOWN)
    solution = solve(write_scene(path, elements), subdivision="none", ke="exitance", sides="two", eye=camera.eye,
                     look_at=camera.look_at, up=camera.up,
                     fov=48, resolution=(SHOWN, SHOWN), supersample=1)
    return solution.picture.values


def elements_of_fluxel(size):
    """Those of the camera alone."""
    return solve(SCENE, resolution=(size, size), max_edge=1e9, form_factor="point").elements


def as_set(corners):
    """Elements by their centres, to a millionth."""
    return {tuple(centre) for centre in np.round(np.asarray(corners).mean(axis=1), 6) + 0.0}


def draw_outlines(axes, camera, elements):
    for corners, colour in zip(elements, ("#D55E00", "#0072B2", "#333333")):
        outlines = camera.projected(np.concatenate([corners, corners[:, :1]], axis=1))
        for outline in outlines:
            axes.plot(outline[:, 0], outline[:, 1], color=colour, linewidth=0.35)


def figure_1(out):
    size = 64
    found = list(steps(camera_of(size), rectangles()))
    own = elements_of_fluxel(size)
    reference = truth(SCENE, SHOWN)
    outcome = Outcome(("step", "light", "shade", "screen", "elements", "error of the picture"), [], "")
    last = len(found) - 1
    pictured = sorted({0, 2, 4, 6, 8, last})
    figure, panels = charts.pyplot.subplots(2, len(pictured), figsize=(2.6 * len(pictured), 5.6), layout="constrained")
    errors = {}
    for step, elements in enumerate(found):
        counts = [len(corners) for corners in elements]
        if step in pictured:
            radiance = radiance_of(out / f"step-{step}.obj", elements)
            errors[step] = error(radiance, reference, reference.values.max(axis=2) < 1)
            upper, lower = panels[:, pictured.index(step)]
            upper.imshow(charts.shown(radiance, WHITE), interpolation="nearest")
            upper.set_title(f"step {step}: {sum(counts)} elements\nerror {percent(errors[step])}", fontsize=9)
            lower.imshow(np.ones((SHOWN, SHOWN, 3)))
            draw_outlines(lower, camera_of(SHOWN), elements)
            for axes in (upper, lower):
                axes.set(xlim=(0, SHOWN - 1), ylim=(SHOWN - 1, 0))
                axes.set_axis_off()
        outcome.rows.append((step, *counts, sum(counts), percent(errors[step]) if step in errors else ""))
    figure.savefig(out / "steps.png", dpi=charts.DPI)
    charts.pyplot.close(figure)
    total = sum(map(len, found[-1]))
    outcome.found = (f"{last} steps to {total} elements at {size} x {size} pixels, the same as Fluxel's {len(own)}; the "
                     f"screen's error falls from "
                     f"{percent(errors[0])} to {percent(errors[last])}")
    outcome.expect("the paper's loop, written to the letter, ends with Fluxel's elements",
                   as_set(np.concatenate(found[-1])) == as_set(own.corners))
    outcome.expect("the error of the picture falls at every step that is drawn",
                   all(errors[b] < errors[a] for a, b in zip(pictured, pictured[1:])))
    return outcome


def near_square(size):
    """A square of 1 m, seen from 1 cm."""
    square = np.array([[[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]]])
    return Camera(np.array([0.123, 0.071, 0.01]), np.array([0.123, 0.071, 0]), np.array([0.0, 1, 0]), np.radians(45), size), square


CASES = [(SCENE, lambda size: (camera_of(size), rectangles()), size) for size in (16, 32, 64, 128)] + [
    ("a square seen from 1 cm", near_square, size) for size in (16, 32, 64)]


def theorem(out):
    outcome = Outcome(("scene", "pixels", "steps", "eq. (7)", "corrected bound"), [], "")
    figure, axes = charts.axes_of("pixels a side", "steps until no element covers two pixels", "Steps and their bounds",
                                  log_y=False)
    beyond, ok = [], []
    lines = {}
    for name, view, size in CASES:
        camera, scene = view(size)
        taken = len(list(steps(camera, scene))) - 1
        bounds = eq_7(camera, scene), corrected_bound(camera, scene)
        outcome.rows.append((name, f"{size} x {size}", taken, f"{bounds[0]:.1f}", bounds[1]))
        lines.setdefault(name, []).append((size, taken, *bounds))
        beyond.append((name, taken, bounds[0], taken > np.ceil(bounds[0])))
        ok.append(taken <= bounds[1])
    for number, (name, line) in enumerate(lines.items()):
        for column, label, style, marker in ((1, "steps", "-", "o"), (2, "eq. (7)", "--", "s"), (3, "corrected bound", ":", "^")):
            axes.plot([row[0] for row in line], [row[column] for row in line], style, marker=marker, color=charts.COLOURS[number],
                      label=f"{name}: {label}")
    charts.ticks(axes, sorted({size for *_, size in CASES}))
    axes.set_ylim(0, 62)  # room for the legend
    charts.save(figure, axes, out / "theorem.png")
    near = [row for row in beyond if row[0] != SCENE]
    outcome.found = (f"the loop ends in every case; {SCENE}: {', '.join(str(row[1]) for row in beyond if row[0] == SCENE)} "
                     f"steps, eq. (7) allows "
                     f"{', '.join(f'{row[2]:.1f}' for row in beyond if row[0] == SCENE)}; the near square: "
                     f"{', '.join(str(row[1]) for row in near)} steps, "
                     f"eq. (7) allows {', '.join(f'{row[2]:.1f}' for row in near)}")
    outcome.expect("a square seen from very near takes more steps than eq. (7) allows", all(row[3] for row in near))
    outcome.expect("the bound of docs/method.md holds in every case", all(ok))
    return outcome


def operations(out):
    outcome = Outcome(("scene", "pixels", "rasters", "rays T", "k0 Nx Ny", "T / (k0 Nx Ny)", "Fluxel's rays"), [], "")
    shares, same = [], []
    for size in (16, 32, 64, 128):
        camera, scene = camera_of(size), rectangles()
        found = list(steps(camera, scene))
        rasters = len(found)  # the last of which finds nothing to split
        same.append(as_set(np.concatenate(found[-1])) == as_set(elements_of_fluxel(size).corners))
        bound = eq_7(camera, scene) * size * size
        shares.append(rasters * size * size / bound)
        outcome.rows.append((SCENE, f"{size} x {size}", rasters, rasters * size * size, f"{bound:.0f}", f"{shares[-1]:.2f}",
                             size * size))
    camera, scene = near_square(64)
    rasters = len(list(steps(camera, scene)))
    near = rasters / eq_7(camera, scene)
    outcome.rows.append(("a square seen from 1 cm", "64 x 64", rasters, rasters * 64 * 64, f"{eq_7(camera, scene) * 64 * 64:.0f}",
                         f"{near:.2f}", 64 * 64))
    figure, axes = charts.axes_of("pixels a side", "rays", "Rays of the subdivision, three rectangles")
    sizes = (16, 32, 64, 128)
    for number, (column, label) in enumerate(((3, "the paper's loop"), (4, "k0 Nx Ny"), (6, "Fluxel: one raster"))):
        charts.draw(axes, sizes, [float(row[column]) for row in outcome.rows[:4]], label, number)
    charts.ticks(axes, sizes)
    charts.save(figure, axes, out / "operations.png")
    outcome.found = (f"the loop casts {', '.join(f'{share:.2f}' for share in shares)} times k0 Nx Ny rays at "
                     f"{', '.join(map(str, sizes))} pixels a side, "
                     f"{near:.2f} times where eq. (7) fails; Fluxel casts Nx Ny rays")
    outcome.expect("three rectangles: rays over k0 Nx Ny are at most 1.1 and grow by at most a third from 16 to 128 pixels",
                   max(shares) <= 1.1 and max(shares) / min(shares) < 4 / 3)
    outcome.expect("Fluxel's one raster gives the elements of the loop at each size", all(same))
    return outcome


ROWS = (
    Row("figure-1", "3.2, Fig. 1", "three rectangles at steps of the subdivision",
        "pictures of light, shade and screen at several steps, no figures",
        "the loop of 3.2 written to the letter at 64 x 64 pixels; each step's elements solved as they are and shown with 128 x "
        "128", 0.5,
        "reproduced; Fluxel's one raster gives the elements of the loop", figure_1),
    Row("claim-theorem", "3.3, eq. (7)", "the loop ends, after at most k0 steps",
        "it ends after log(q / Rmax) / log s steps at most, q the pixel, Rmax the largest radius, s = sqrt(5/8) for rectangles",
        "steps of the loop against eq. (7) and against the bound of docs/method.md", 0.1,
        "that it ends is confirmed; eq. (7) is refuted, as it takes the pixel's size for a distance in the scene", theorem),
    Row("claim-operations", "3.3, remark", "T < C k0 Nx Ny",
        "the subdivision takes fewer than C k0 Nx Ny operations",
        "rays that the loop casts, against k0 Nx Ny and against Fluxel's single raster", 0.2,
        "confirmed where eq. (7) holds; one raster is enough", operations),
)
