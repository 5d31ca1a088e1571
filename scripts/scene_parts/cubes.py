"""Unit cubes seen from inside: the white furnace and the box with an emitting wall."""

import random

from .mesh import Material, Mesh, SceneFile, area_vector, grey, room_faces, subtract

CUBE = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
CENTRE = (0.5, 0.5, 0.5)
CAMERA = {
    "eye": (0.15, 0.1, 0.6),
    "look_at": (0.6, 0.9, 0.4),
    "up": (0.0, 0.0, 1.0),
    "fov": 75.0,
    "resolution": (128, 128),
}
SQUARES_A_SIDE = 16
LEVELS = 64
SEED = 20021


def grid(face, count):
    """A rectangle as count x count equal rectangles. Corners are multiples of 1/count, equal for both walls of an edge."""
    origin, first, second = face[0], subtract(face[1], face[0]), subtract(face[3], face[0])
    at = lambda i, j: tuple(o + (i * a + j * b) / count for o, a, b in zip(origin, first, second))
    return [
        [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)] for j in range(count) for i in range(count)
    ]


def furnace():
    rho_levels = [round(0.9 * level / (LEVELS - 1), 4) for level in range(LEVELS)]
    mesh = Mesh({f"level_{k}": Material(grey(rho), grey(1 - rho)) for k, rho in enumerate(rho_levels)})
    draw = random.Random(SEED)
    area_rho = 0.0
    walls = room_faces(*CUBE)
    for name, face in walls.items():
        for cell in grid(face, SQUARES_A_SIDE):
            level = int(draw.random() * LEVELS)
            area_rho += rho_levels[level] * sum(a * a for a in area_vector(cell)) ** 0.5
            mesh.add(name, f"level_{level}", [cell], towards=CENTRE)
    mesh.require_closed(set(walls), outward=False)

    plain = Mesh({"wall": Material(grey(0.9), grey(0.1))})
    for name, face in walls.items():
        plain.add(name, "wall", [face], towards=CENTRE)
    plain.require_closed(set(walls), outward=False)

    random_rho = SceneFile(
        "White furnace, random reflectances",
        f"""The inside of a unit cube, {SQUARES_A_SIDE} x {SQUARES_A_SIDE} squares a wall, each with a reflectance rho drawn from {LEVELS} levels of 0..0.9
(fixed seed; mean {area_rho / 6:.4f}) and an exitance of 1 - rho.
Must give: B = 1 everywhere, because sum_j F_ij = 1 in a closed scene makes B = 1 solve B = E + rho F B exactly. What
differs from 1 is the error of the form factors alone.""",
        "furnace.obj",
        CAMERA,
        {"method": "matrix", "sides": "one", "subdivision": "none"},
    )
    constant_rho = SceneFile(
        "White furnace, reflectance 0.9",
        """The inside of a unit cube, reflectance 0.9 and exitance 0.1 on all walls.
Must give: B = 0.1 / (1 - 0.9) = 1 everywhere (closed scene, row sums of the form factors 1).""",
        "furnace-0.9.obj",
        CAMERA,
        {"method": "matrix", "sides": "one", "subdivision": "uniform", "max-edge": 0.0625},
    )
    heading = ["The inside of a unit cube; written by scripts/make-scenes."]
    return {
        "furnace/furnace.obj": mesh.obj(heading, "furnace.mtl"),
        "furnace/furnace.mtl": mesh.mtl(["Ke is an exitance: 1 - Kd."]),
        "furnace/furnace.toml": random_rho.text(),
        "furnace/furnace-0.9.obj": plain.obj(heading, "furnace-0.9.mtl"),
        "furnace/furnace-0.9.mtl": plain.mtl(["Ke is an exitance: 1 - Kd."]),
        "furnace/furnace-0.9.toml": constant_rho.text(),
    }


def emitting_wall():
    mesh = Mesh({"wall": Material(grey(0.5)), "emitter": Material(grey(0.5), grey(1.0))})
    names = {"bottom": "emitter", "top": "opposite"}
    walls = room_faces(*CUBE)
    for name, face in walls.items():
        group = names.get(name, name)
        mesh.add(group, "emitter" if group == "emitter" else "wall", [face], towards=CENTRE)
    mesh.require_closed({names.get(name, name) for name in walls}, outward=False)
    scene = SceneFile(
        "Unit cube with one emitting wall",
        """The inside of a unit cube, reflectance 0.5 on all walls; the wall z = 0 emits 1 W/m2.
Must give, as averages of B over a wall under refinement (the continuous solution):
  emitter 1.104362, opposite 0.171216, each side 0.181105; emitter + opposite + 4 sides = 1 / (1 - 0.5) = 2 at every
  refinement (energy).
Where from: B = E + 0.5 F B on n x n x 6 elements with exact factors, the closed forms of parallel and perpendicular
rectangles (Howell's catalogue of view factors, C-11 to C-16), n = 2..64, extrapolated (last digits uncertain by 2, 1, 2);
photon tracing agrees: 1.10438(5), 0.17124(11), 0.18110(6).
One element a wall (factors 0.1998248957 opposite, 0.2000437761 adjacent) gives instead 1.0909090981, 0.1817458261,
0.1818362689: a refined solution must leave these values.""",
        "emitting-wall.obj",
        {
            "eye": (0.5, 0.05, 0.55),
            "look_at": (0.5, 1.0, 0.45),
            "up": (0.0, 0.0, 1.0),
            "fov": 80.0,
            "resolution": (128, 128),
        },
        {"method": "matrix", "sides": "one", "subdivision": "uniform", "max-edge": 0.0625},
    )
    return {
        "emitting-wall/emitting-wall.obj": mesh.obj(
            ["The inside of a unit cube; written by scripts/make-scenes."], "emitting-wall.mtl"
        ),
        "emitting-wall/emitting-wall.mtl": mesh.mtl(["Ke is an exitance."]),
        "emitting-wall/emitting-wall.toml": scene.text(),
    }
