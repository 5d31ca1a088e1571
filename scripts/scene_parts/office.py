"""An office of exactly 2391 triangles, made of boxes."""

import random

from .mesh import Material, Mesh, SceneFile, box_faces, grey, room_faces

TRIANGLES = 2391
ROOM = ((0.0, 0.0, 0.0), (9.0, 6.0, 3.0))
GAP = 0.002  # so that no two boxes touch: the patches are the triangles, uncut
SHELF_WIDTH, SHELF_BOARDS, BOOKS_A_SHELF = 2.0, 5, 24
BOOK_COLOURS = ("red_cloth", "green_cloth", "blue_cloth", "paper")
SEED = 2391


def add_box(mesh, group, material, low, high, lit_face=None):
    """A closed box; `lit_face` gets the material `lamp`."""
    middle = tuple(0.5 * (a + b) for a, b in zip(low, high))
    for name, face in box_faces(low, high).items():
        mesh.add(group, "lamp" if name == lit_face else material, [face], away_from=middle)
    mesh.require_closed({group}, outward=True)


def add_shifted(mesh, group, material, origin, boxes):
    for index, (low, high) in enumerate(boxes, 1):
        shifted = [tuple(round(o + c, 6) for o, c in zip(origin, corner)) for corner in (low, high)]
        add_box(mesh, f"{group}_{index}", material, *shifted)


def add_workplace(mesh, name, x, y):
    """A desk of 1.6 x 0.8 m with its screen on the far side (+y) and a chair before it: 16 boxes."""
    leg = 0.72 - GAP
    desk = [((0, 0, 0.72), (1.6, 0.8, 0.75))]
    desk += [((a, b, GAP), (a + 0.05, b + 0.05, leg)) for a in (0.02, 1.53) for b in (0.02, 0.73)]
    desk += [((1.1, 0.05, 0.2), (1.5, 0.7, leg))]
    add_shifted(mesh, f"{name}_desk", "wood", (x, y, 0), desk)
    top = 0.75 + GAP
    screen = [
        ((0.65, 0.55, top), (0.95, 0.7, top + 0.015)),
        ((0.78, 0.61, top + 0.017), (0.82, 0.64, 0.9)),
        ((0.5, 0.6, 0.9 + GAP), (1.1, 0.64, 1.27)),
        ((0.55, 0.15, top), (1.05, 0.32, top + 0.02)),
    ]
    add_shifted(mesh, f"{name}_computer", "plastic", (x, y, 0), screen)
    chair = [((0, 0, 0.45), (0.45, 0.45, 0.5)), ((0, 0, 0.5 + GAP), (0.45, 0.04, 1.0))]
    chair += [((a, b, GAP), (a + 0.04, b + 0.04, 0.45 - GAP)) for a in (0, 0.41) for b in (0, 0.41)]
    add_shifted(mesh, f"{name}_chair", "blue_cloth", (x + 0.55, y - 0.5, 0), chair)


def add_shelf(mesh, name, x, y, draw):
    """Two sides, a back, five boards and 24 books on the lower four: 32 boxes. Open towards -y."""
    depth, height, board = 0.35, 2.0, 0.03
    frame = [
        ((0, 0, GAP), (board, depth, height)),
        ((SHELF_WIDTH - board, 0, GAP), (SHELF_WIDTH, depth, height)),
        ((board + GAP, depth - 0.02, GAP), (SHELF_WIDTH - board - GAP, depth, height)),
    ]
    levels = [0.05 + level * 0.46 for level in range(SHELF_BOARDS)]
    frame += [((board + GAP, 0, z), (SHELF_WIDTH - board - GAP, depth - 0.02 - GAP, z + board)) for z in levels]
    add_shifted(mesh, f"{name}_frame", "wood", (x, y, 0), frame)
    for index in range(BOOKS_A_SHELF):
        level, place = divmod(index, BOOKS_A_SHELF // 4)
        left = 0.06 + place * 0.31 + 0.05 * draw.random()
        width, tall, front = 0.04 + 0.2 * draw.random(), 0.2 + 0.18 * draw.random(), 0.02 + 0.06 * draw.random()
        bottom = levels[level] + board + GAP
        book = [((left, front, bottom), (left + width, depth - 0.03, bottom + tall))]
        colour = BOOK_COLOURS[int(draw.random() * len(BOOK_COLOURS))]
        add_shifted(mesh, f"{name}_book_{index + 1}", colour, (x, y, 0), book)


def office():
    mesh = Mesh(
        {
            "wall": Material((0.75, 0.75, 0.72)),
            "carpet": Material((0.25, 0.28, 0.32)),
            "wood": Material((0.55, 0.38, 0.22)),
            "plastic": Material(grey(0.15)),
            "metal": Material(grey(0.6)),
            "paper": Material((0.7, 0.68, 0.6)),
            "red_cloth": Material((0.55, 0.08, 0.07)),
            "green_cloth": Material((0.1, 0.4, 0.12)),
            "blue_cloth": Material((0.08, 0.15, 0.5)),
            "lamp": Material(grey(0.5), (60.0, 57.0, 50.0)),
        }
    )
    inside = (4.5, 3.0, 1.5)
    walls = room_faces(*ROOM)
    for name, face in walls.items():
        group = {"bottom": "floor", "top": "ceiling"}.get(name, f"{name}_wall")
        mesh.add(group, "carpet" if name == "bottom" else "wall", [face], towards=inside)
    mesh.require_closed({"floor", "ceiling", *(f"{n}_wall" for n in ("front", "back", "left", "right"))}, outward=False)
    for index, (x, y) in enumerate(((x, y) for y in (1.2, 3.4) for x in (1.0, 3.7, 6.4)), 1):
        add_workplace(mesh, f"workplace_{index}", x, y)
        lamp = [round(x + 0.2, 6), round(y + 0.1, 6)]
        add_box(mesh, f"lamp_{index}", "metal", (*lamp, 2.6), (round(lamp[0] + 1.2, 6), round(lamp[1] + 0.3, 6), 2.68), "bottom")
    draw = random.Random(SEED)
    for index, x in enumerate((0.6, 3.5, 6.4), 1):
        add_shelf(mesh, f"shelf_{index}", x, 5.6, draw)
    near_left = 0.01
    board = [(near_left, 1.6, 1.0), (near_left, 3.6, 1.0), (near_left, 3.6, 2.0), (near_left, 1.6, 2.0)]
    mesh.add("whiteboard", "paper", [board], towards=inside)
    pennant = [(near_left, 4.9, 2.4), (near_left, 4.1, 2.4), (near_left, 4.5, 1.2)]
    mesh.add("pennant", "red_cloth", [pennant], towards=inside)
    mesh.triangulate()
    if mesh.triangles() != TRIANGLES:
        raise ValueError(f"the office has {mesh.triangles()} triangles, not {TRIANGLES}")
    scene = SceneFile(
        "Office of 2391 triangles",
        """A closed room of 9 x 6 x 3 m with six workplaces, six hanging lamps, three shelves with books, a whiteboard and a pennant,
procedural and of a fixed seed. For the table of speed-ups of Debelov and Sattarov, section 5.2, whose scene of 2391
triangles is not published: this one has as many, and nothing else in common.
Must give: 2391 patches, none degenerate, none cut (boxes keep 2 mm apart); emitted power 6 lamps x 0.36 m2 x
(60, 57, 50) W/m2 = (129.6, 123.12, 108) W; nothing escapes.""",
        "office-2391.obj",
        {
            "eye": (8.7, 0.3, 1.75),
            "look_at": (3.2, 3.9, 0.9),
            "up": (0.0, 0.0, 1.0),
            "fov": 58.0,
            "resolution": (128, 128),
        },
        {"sides": "one"},
    )
    return {
        "office-2391/office-2391.obj": mesh.obj(
            ["An office of 2391 triangles, in metres; written by scripts/make-scenes."], "office-2391.mtl"
        ),
        "office-2391/office-2391.mtl": mesh.mtl(["Ke is an exitance."]),
        "office-2391/office-2391.toml": scene.text(),
    }
