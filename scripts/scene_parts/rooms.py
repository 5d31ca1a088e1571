"""Closed rooms full of boxes, for measuring visibility."""

import random

from .mesh import Material, Mesh, SceneFile, box_faces, grey, room_faces

ROOM = ((0.0, 0.0, 0.0), (10.0, 8.0, 3.0))
MIDDLE = (5.0, 4.0, 1.5)
GAP = 0.002  # between a box and the floor, the light and the ceiling: nothing touches, so nothing is cut
LEAST_DISTANCE = 0.02  # between two boxes, and from the walls
COLOURS = ("terracotta", "moss", "slate", "sand")
SEED = 10083
KINDS = {  # number of boxes: range of a side of the foot, range of the height [m]
    12: ((0.5, 1.3), (0.6, 1.8)),
    180: ((0.15, 0.5), (0.3, 2.2)),
}


def overlap(a, b):
    """Whether two feet (x0, y0, x1, y1) come closer than LEAST_DISTANCE."""
    return all(a[k] < b[k + 2] + LEAST_DISTANCE and b[k] < a[k + 2] + LEAST_DISTANCE for k in (0, 1))


def place_boxes(count):
    """Low and high corners of boxes of random place and size; one too near to another is drawn again."""
    draw = random.Random(SEED + count)
    (least_side, most_side), (least_height, most_height) = KINDS[count]
    feet, boxes = [], []
    while len(boxes) < count:
        sides = [least_side + (most_side - least_side) * draw.random() for _ in range(2)]
        corner = [
            LEAST_DISTANCE + (ROOM[1][k] - sides[k] - 2 * LEAST_DISTANCE) * draw.random() for k in range(2)
        ]
        height = least_height + (most_height - least_height) * draw.random()
        foot = [round(value, 3) for value in (*corner, corner[0] + sides[0], corner[1] + sides[1])]
        if any(overlap(foot, other) for other in feet):
            continue
        feet.append(foot)
        boxes.append(((*foot[:2], GAP), (*foot[2:], round(height, 3))))
    return boxes


def room_of_boxes(count):
    mesh = Mesh(
        {
            "wall": Material(grey(0.7)),
            "terracotta": Material((0.55, 0.25, 0.15)),
            "moss": Material((0.2, 0.4, 0.15)),
            "slate": Material(grey(0.35)),
            "sand": Material((0.7, 0.6, 0.4)),
            "light": Material(grey(0.0), grey(50.0)),
        }
    )
    walls = room_faces(*ROOM)
    for name, face in walls.items():
        group = {"bottom": "floor", "top": "ceiling"}.get(name, f"{name}_wall")
        mesh.add(group, "wall", [face], towards=MIDDLE)
    mesh.require_closed({group for group, _, _ in mesh.faces}, outward=False)
    for index, (low, high) in enumerate(place_boxes(count), 1):
        middle = tuple(0.5 * (a + b) for a, b in zip(low, high))
        group = f"box_{index}"
        mesh.add(group, COLOURS[index % len(COLOURS)], box_faces(low, high).values(), away_from=middle)
        mesh.require_closed({group}, outward=True)
    height = ROOM[1][2] - GAP
    light = [(4.0, 4.5, height), (6.0, 4.5, height), (6.0, 3.5, height), (4.0, 3.5, height)]
    mesh.add("light", "light", [light], towards=MIDDLE)

    name = f"room-of-{count}-boxes"
    scene = SceneFile(
        f"Room of {count} boxes",
        f"""A closed room of 10 x 8 x 3 m with {count} boxes of random place and size (fixed seed), 2 mm above the
floor, and a light of 2 m2 as far below the ceiling: the speed of visibility is measured in it.
Must give: {7 + 6 * count} patches, none cut; emitted power 2 m2 x 50 W/m2 = 100 W in each channel; nothing
escapes.""",
        f"{name}.obj",
        {
            "eye": (0.4, 0.4, 2.6),
            "look_at": (6.0, 4.8, 0.6),
            "up": (0.0, 0.0, 1.0),
            "fov": 60.0,
            "resolution": (128, 128),
        },
        {"sides": "one"},
    )
    return {
        f"room-of-boxes/{name}.obj": mesh.obj(
            [f"A room of {count} boxes, in metres; written by scripts/make-scenes."], "room-of-boxes.mtl"
        ),
        "room-of-boxes/room-of-boxes.mtl": mesh.mtl(["Ke is an exitance."]),
        f"room-of-boxes/{name}.toml": scene.text(),
    }


def rooms_of_boxes():
    return {name: text for count in KINDS for name, text in room_of_boxes(count).items()}
