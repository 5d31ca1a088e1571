"""Three rectangles, a construction in wood, a courtyard."""

from .mesh import Material, Mesh, SceneFile, box_faces, grey, point_factor, quad, room_faces, split_around

UP = (0.0, 0.0, 1.0)
FAR_ABOVE, FAR_BELOW = (0.0, 0.0, 100.0), (0.0, 0.0, -100.0)


def level_square(half, height):
    return quad((-half, -half, height), (2 * half, 0.0, 0.0), (0.0, 2 * half, 0.0))


def three_rectangles():
    mesh = Mesh(
        {
            "light": Material(grey(0.0), grey(10.0)),
            "shade": Material(grey(0.0)),
            "screen": Material(grey(0.7)),
        }
    )
    light = level_square(0.5, 3.0)[::-1]
    mesh.add("light", "light", [light], towards=FAR_BELOW)
    mesh.add("shade", "shade", [level_square(0.6, 1.5)], towards=FAR_ABOVE)
    mesh.add("screen", "screen", [level_square(2.5, 0.0)], towards=FAR_ABOVE)
    corner, beyond = (2.0, 2.0, 0.0), (2.0, 0.0, 0.0)
    scene = SceneFile(
        "Three rectangles",
        f"""Three horizontal squares: the upper one (1 m, z = 3) is the light, the lower one (5 m, z = 0) the screen, the middle one
(1.2 m, z = 1.5) stands between. After Debelov and Sattarov, "Parallel radiosity algorithm with simplified calculation of
form-factors" (in Russian), Fig. 1.
Light and shade reflect nothing and the screen does not see itself, so B on the screen is exact: with a = 0.5 and b = 0.6
the half sides of light and shade, which hangs half way,
  0 in the umbra |x|, |y| < 2 b - a = 0.7;
  0.7 * 10 * F outside the penumbra, |x| or |y| > 2 b + a = 1.7, F the factor from the point to the light (Lambert's closed
  form for a polygon): B(2, 0) = {7 * point_factor(beyond, UP, light):.10f}, B(2, 2) = {7 * point_factor(corner, UP, light):.10f}.
Energy: nothing else reflects, so what the screen sends, 0.7 of what it receives, escapes but for what the shade and the
light's back absorb.""",
        "three-rectangles.obj",
        {
            "eye": (3.0, -7.4, 2.5),
            "look_at": (0.0, 0.0, 1.3),
            "up": UP,
            "fov": 48.0,
            "resolution": (128, 128),
        },
        {"sides": "two"},
    )
    return {
        "three-rectangles/three-rectangles.obj": mesh.obj(
            ["Light, shade and screen; written by scripts/make-scenes."], "three-rectangles.mtl"
        ),
        "three-rectangles/three-rectangles.mtl": mesh.mtl(["Ke is an exitance."]),
        "three-rectangles/three-rectangles.toml": scene.text(),
    }


# Boards [m]: left and right edge, y of the front, colour of the back. The eye is at small y and looks along +y.
WOOD_BOARDS = (
    (0.00, 0.42, 2.10, "violet"),
    (0.70, 1.30, 1.15, "red"),
    (1.08, 1.74, 2.00, "blue"),
    (1.72, 2.30, 1.30, "yellow"),
    (2.32, 3.05, 2.20, "violet"),
    (2.72, 3.25, 1.00, "green"),
    (3.55, 4.00, 1.95, "orange"),
)
WOOD_THICKNESS = 0.05
WOOD_HEIGHT = 3.0


def construction_in_wood():
    mesh = Mesh(
        {
            "white": Material(grey(0.8)),
            "red": Material((0.8, 0.06, 0.05)),
            "orange": Material((0.85, 0.35, 0.04)),
            "yellow": Material((0.85, 0.7, 0.04)),
            "green": Material((0.06, 0.6, 0.12)),
            "blue": Material((0.05, 0.15, 0.75)),
            "violet": Material((0.45, 0.06, 0.6)),
            "window": Material(grey(0.1), (40.0, 40.0, 38.0)),
        }
    )
    room = room_faces((0.0, -2.5, 0.0), (4.0, 3.6, WOOD_HEIGHT))
    names = {"bottom": "floor", "top": "ceiling", "front": "wall_behind_eye", "left": "left_wall", "right": "right_wall"}
    inside = (2.0, 0.0, 1.5)
    for key, name in names.items():
        mesh.add(name, "white", [room[key]], towards=inside)
    frame, window = split_around(room["back"], (0.08, 0.92), (0.1, 0.75))
    mesh.add("window_frame", "white", frame, towards=inside)
    mesh.add("window", "window", [window], towards=inside)
    for index, (left, right, front, colour) in enumerate(WOOD_BOARDS, 1):
        low, high = (left, front, 0.0), (right, front + WOOD_THICKNESS, WOOD_HEIGHT)
        faces = box_faces(low, high)
        middle = tuple(0.5 * (a + b) for a, b in zip(low, high))
        # A board reaches from floor to ceiling; an edge that touches a side wall is not seen either.
        white = [faces["front"]]
        if left > 0.0:
            white.append(faces["left"])
        if right < 4.0:
            white.append(faces["right"])
        mesh.add(f"board_{index}", "white", white, away_from=middle)
        mesh.add(f"board_{index}_back", colour, [faces["back"]], away_from=middle)
    scene = SceneFile(
        "Construction in wood",
        """After John Ferren, "Construction in Wood, A Daylight Experiment", as the radiosity papers describe it (Goral et al.
1984; Debelov and Sattarov, Fig. 2): an homage with dimensions and colours of its own, not a model of the sculpture.
Seven boards stand from floor to ceiling in a white box. Every face towards the eye is white, every back is painted; the
light comes from a window behind the boards, which the eye does not see.
Must give: no pixel shows a painted face or the window, and yet the rear boards are coloured: each by the back of the board
in front of it. With all backs white as well (rho 0.8) the colours vanish.""",
        "construction-in-wood.obj",
        {
            "eye": (2.0, -2.35, 1.4),
            "look_at": (2.0, 2.0, 1.4),
            "up": UP,
            "fov": 56.0,
            "resolution": (200, 200),
        },
        {"method": "matrix", "sides": "one", "subdivision": "camera", "max-edge": 0.2},
    )
    return {
        "construction-in-wood/construction-in-wood.obj": mesh.obj(
            ["After John Ferren's Construction in Wood, in metres; written by scripts/make-scenes."],
            "construction-in-wood.mtl",
        ),
        "construction-in-wood/construction-in-wood.mtl": mesh.mtl(["Ke is an exitance."]),
        "construction-in-wood/construction-in-wood.toml": scene.text(),
    }


# Gauss-Legendre on 0..1, 8 points, enough for a smooth factor to 10 digits.
GAUSS = (
    (0.0198550717512319, 0.0506142681451881),
    (0.1016667612931866, 0.1111905172266872),
    (0.2372337950418355, 0.1568533229389436),
    (0.4082826787521751, 0.1813418916891810),
    (0.5917173212478249, 0.1813418916891810),
    (0.7627662049581645, 0.1568533229389436),
    (0.8983332387068134, 0.1111905172266872),
    (0.9801449282487681, 0.0506142681451881),
)


def courtyard():
    mesh = Mesh(
        {
            "plaster": Material((0.7, 0.65, 0.55)),
            "paving": Material((0.4, 0.38, 0.35)),
            "stone": Material((0.5, 0.5, 0.55)),
            "panel": Material(grey(0.0), grey(20.0)),
        }
    )
    high = (6.0, 5.0, 3.0)
    inside = (3.0, 2.5, 1.5)
    walls = room_faces((0.0, 0.0, 0.0), high)
    mesh.add("ground", "paving", [walls["bottom"]], towards=inside)
    frame, panel = split_around(walls["back"], (1 / 6, 1 / 2), (1 / 3, 2 / 3))
    mesh.add("wall_with_panel", "plaster", frame, towards=inside)
    mesh.add("panel", "panel", [panel], towards=inside)
    for name in ("front", "left", "right"):
        mesh.add(f"{name}_wall", "plaster", [walls[name]], towards=inside)
    for group, low, top in (("bench", (0.6, 1.0, 0.0), (1.1, 3.5, 0.45)), ("basin", (3.4, 2.2, 0.0), (5.0, 3.6, 0.6))):
        faces = box_faces(low, top)
        middle = tuple(0.5 * (a + b) for a, b in zip(low, top))
        mesh.add(group, "stone", [face for name, face in faces.items() if name != "bottom"], away_from=middle)

    opening = [(0.0, 0.0, 3.0), (6.0, 0.0, 3.0), (6.0, 5.0, 3.0), (0.0, 5.0, 3.0)]
    corner, first, second = panel[0], panel[1], panel[3]
    factor = 0.0
    for s, s_weight in GAUSS:
        for t, t_weight in GAUSS:
            point = tuple(c + s * (a - c) + t * (b - c) for c, a, b in zip(corner, first, second))
            factor += s_weight * t_weight * point_factor(point, (0.0, -1.0, 0.0), opening)

    place = "An open yard of 6 x 5 m between walls of 3 m, with a panel of 2 x 1 m in one wall and two low blocks."
    camera = {"eye": (5.6, 0.3, 2.6), "look_at": (2.2, 3.8, 0.7), "up": UP, "fov": 62.0, "resolution": (160, 120)}
    options = {"method": "matrix", "sides": "one", "subdivision": "camera", "max-edge": 0.5}
    direct = f"""Straight from the panel {factor:.8f} of its power leaves through the open top: nothing stands between (the blocks are
lower than the panel), and that is its form factor to the opening (Lambert's closed form at a point, integrated over the
panel by Gauss-Legendre)."""
    bright = SceneFile(
        "Courtyard",
        f"""{place}
{direct}
Must give: emitted 40 W in each channel; escaped more than {40 * factor:.4f} W, absorbed the rest.""",
        "courtyard.obj",
        camera,
        options,
    )
    black = SceneFile(
        "Courtyard, black",
        f"""{place} Nothing reflects.
{direct}
Must give: emitted 40 W in each channel, escaped {40 * factor:.6f} W, absorbed {40 * (1 - factor):.6f} W.""",
        "courtyard.obj",
        camera,
        options,
        materials={name: {"rho": grey(0.0)} for name in ("plaster", "paving", "stone")},
    )
    return {
        "courtyard/courtyard.obj": mesh.obj(
            ["A courtyard without a roof, in metres; written by scripts/make-scenes."], "courtyard.mtl"
        ),
        "courtyard/courtyard.mtl": mesh.mtl(["Ke is an exitance."]),
        "courtyard/courtyard.toml": bright.text(),
        "courtyard/courtyard-black.toml": black.text(),
    }
