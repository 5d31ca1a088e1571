"""A closed room with a field of boxes on its floor, in any number: detail that becomes finer in a room that stays."""

import random

SIDE, HEIGHT = 10.0, 4.0  # of the room [m]
LAMP = 3.0  # side of the lamp [m]
GAP = 1e-3  # of a cell, between boxes and floor, so that nothing touches and the floor is not cut
LAMP_GAP = 0.002  # below the ceiling [m]
MATERIALS = (("wall", 0.7, 0.0), ("box", 0.5, 0.0), ("lamp", 0.0, 20.0))  # name, reflectance, emission
SEED = 7519


def box(low, high):
    """Corners, and faces by them, seen from outside."""
    corners = [tuple((low, high)[(k >> axis) & 1][axis] for axis in range(3)) for k in range(8)]
    return corners, ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def write_field(path, boxes, gap=GAP, lamp_gap=LAMP_GAP):
    """Writes PATH and the MTL beside it: boxes x boxes boxes, z up, of one share of their cells and random heights of
    up to two cells; everything is to be solved one-sided. Without gaps boxes stand on the floor, which is cut around
    them."""
    draw = random.Random(SEED)
    cell = SIDE / boxes
    materials = path.with_suffix(".mtl")
    materials.write_text("".join(f"newmtl {name}\nKd {rho} {rho} {rho}\nKe {light} {light} {light}\n"
                                 for name, rho, light in MATERIALS), encoding="ascii")
    vertices = 0
    with open(path, "w", encoding="ascii") as file:

        def add(corners, faces, material):
            nonlocal vertices
            file.write(f"usemtl {material}\n")
            file.writelines(f"v {x:.7g} {y:.7g} {z:.7g}\n" for x, y, z in corners)
            file.writelines("f " + " ".join(str(vertices + 1 + corner) for corner in face) + "\n" for face in faces)
            vertices += len(corners)

        file.write(f"mtllib {materials.name}\n")
        corners, faces = box((0, 0, 0), (SIDE, SIDE, HEIGHT))
        add(corners, [face[::-1] for face in faces], "wall")
        low, high, under = 0.5 * (SIDE - LAMP), 0.5 * (SIDE + LAMP), HEIGHT - lamp_gap
        add([(low, low, under), (low, high, under), (high, high, under), (high, low, under)], [(0, 1, 2, 3)], "lamp")
        for i in range(boxes):
            for j in range(boxes):
                x, y = (i + 0.2) * cell, (j + 0.2) * cell
                top = (0.2 + 1.8 * draw.random()) * cell
                add(*box((x, y, gap * cell), (x + 0.6 * cell, y + 0.6 * cell, top)), "box")
