"""An office of 8 x 6 m under twelve luminaires of a measured distribution, and under as many plain lamps."""

from .mesh import Material, Mesh, SceneFile, grey, room_faces
from .office import add_box, add_shelf, add_workplace

import random

ROOM = ((0.0, 0.0, 0.0), (8.0, 6.0, 2.8))
COLUMNS, ROWS = 4, 3
HEIGHT = 2.3  # of the openings' centres
SIZE = (1.23, 0.26)  # of the file's opening: 4.04 x 0.85 feet
FLUX = 5296.65  # [lm], of the file
SEED = 12
LUMINAIRES = f"""
[[luminaires]]
name = "apex"
file = "../luminaires/ledalite-apex55.ies"
position = [1.0, 1.0, {HEIGHT}]
aim = [0, 0, -1]
rows = {ROWS}
columns = {COLUMNS}
row_step = [0, 2.0, 0]
column_step = [2.0, 0, 0]
"""
TASKS = """
[[receivers]]
name = "desk"
origin = [0.7, 1.05, 0.78]
u = [1.4, 0, 0]
v = [0, 0.45, 0]
cells = [14, 5]

[[receivers]]
name = "around"
origin = [0.1, 0.5, 0.78]
u = [2.6, 0, 0]
v = [0, 1.0, 0]
cells = [13, 5]

[[receivers]]
name = "plan"
surface = "floor"
normal = [0, 0, 1]
offset = 0.78
border = 0.5
spacing = 0.25

[[receivers]]
name = "faces"
quantity = "cylindrical"
axis = [0, 0, 1]
from = [1.0, 2.6, 1.2]
to = [7.0, 2.6, 1.2]
count = 13

[[observers]]
name = "at_work"
eye = [1.4, 0.7, 1.2]
direction = [0, 1, 0]
up = [0, 0, 1]

[[observers]]
name = "along_the_room"
eye = [7.5, 2.6, 1.2]
direction = [-1, 0, 0]
up = [0, 0, 1]

[[tasks]]
name = "writing, reading"
area = "desk"
surrounding = "around"
background = "plan"
illuminance = 500
U0 = 0.6
UGR = 19
observers = ["at_work", "along_the_room"]
"""
CAMERA = {
    "eye": (7.7, 0.3, 1.7),
    "look_at": (2.6, 4.0, 0.9),
    "up": (0.0, 0.0, 1.0),
    "fov": 62.0,
    "resolution": (320, 240),
}


def furniture(mesh):
    inside = (4.0, 3.0, 1.4)
    for name, face in room_faces(*ROOM).items():
        group = {"bottom": "floor", "top": "ceiling"}.get(name, f"{name}_wall")
        material = {"bottom": "carpet", "top": "ceiling"}.get(name, "wall")
        mesh.add(group, material, [face], towards=inside)
    for index, (x, y) in enumerate(((x, y) for y in (1.0, 3.2) for x in (0.6, 3.1, 5.6)), 1):
        add_workplace(mesh, f"workplace_{index}", x, y)
    draw = random.Random(SEED)
    for index, x in enumerate((0.4, 3.0, 5.6), 1):
        add_shelf(mesh, f"shelf_{index}", x, 5.6, draw)


def materials():
    return {
        "wall": Material(grey(0.6)),
        "ceiling": Material(grey(0.8)),
        "carpet": Material(grey(0.2)),
        "wood": Material((0.5, 0.4, 0.3)),
        "plastic": Material(grey(0.15)),
        "paper": Material(grey(0.7)),
        "red_cloth": Material((0.55, 0.08, 0.07)),
        "green_cloth": Material((0.1, 0.4, 0.12)),
        "blue_cloth": Material((0.08, 0.15, 0.5)),
    }


def lit_office():
    name = "office-luminaires"
    bare, lamps = Mesh(materials()), Mesh(materials())
    furniture(bare)
    furniture(lamps)
    exitance = FLUX / (SIZE[0] * SIZE[1])
    lamps.materials["lamp"] = Material(grey(0.0), grey(exitance))
    for row in range(ROWS):
        for column in range(COLUMNS):
            x, y = 1.0 + 2.0 * column, 1.0 + 2.0 * row
            low, high = (x - SIZE[0] / 2, y - SIZE[1] / 2), (x + SIZE[0] / 2, y + SIZE[1] / 2)
            panel = [(*low, HEIGHT), (low[0], high[1], HEIGHT), (*high, HEIGHT), (high[0], low[1], HEIGHT)]
            lamps.add(f"lamp_{row + 1}_{column + 1}", "lamp", [panel], towards=(x, y, 0.0))
    heading = ["An office of 8 x 6 m, in metres; written by scripts/make-scenes."]
    about = """A closed room of 8 x 6 x 2.8 m with six workplaces and three shelves of books.{lamps}
Must give: {count} x {flux:.2f} lm = {all:.1f} lm are emitted, and nothing escapes."""
    values = {"count": ROWS * COLUMNS, "flux": FLUX, "all": ROWS * COLUMNS * FLUX}
    options = {"sides": "one", "target-error": 0.02}
    scene = SceneFile(
        "Office under twelve luminaires",
        about.format(
            lamps=" Twelve luminaires for two fluorescent\nlamps, direct and indirect, of one photometric file hang from its ceiling.",
            **values,
        ),
        f"{name}.obj",
        CAMERA,
        options,
        units="photometric",
        tables=LUMINAIRES,
    )
    plain = SceneFile(
        "Office under twelve plain lamps",
        about.format(
            lamps=" Twelve diffuse lamps of the same size and flux, which\nemit downwards alone, hang where office-luminaires has its luminaires.",
            **values,
        ),
        f"{name}-plain.obj",
        CAMERA,
        options,
        units="photometric",
    )
    tasks = SceneFile(
        "Tasks in an office under twelve luminaires",
        """The room of office-luminaires, with light meters on a desk, around it and over the whole floor, at faces, and with two observers.
Must give: a table after EN 12464-1 for a place of work (500 lx, U0 0.6, UGR 19).""",
        f"{name}.obj",
        CAMERA,
        options,
        units="photometric",
        tables=LUMINAIRES + TASKS,
    )
    return {
        f"{name}/office-tasks.toml": tasks.text(),
        f"{name}/{name}.obj": bare.obj(heading, f"{name}.mtl"),
        f"{name}/{name}.mtl": bare.mtl(["Reflectances alone: the luminaires stand in the scene file."]),
        f"{name}/{name}.toml": scene.text(),
        f"{name}/{name}-plain.obj": lamps.obj(heading, f"{name}-plain.mtl"),
        f"{name}/{name}-plain.mtl": lamps.mtl(["Ke is an exitance [lm/m2]."]),
        f"{name}/{name}-plain.toml": plain.text(),
    }
