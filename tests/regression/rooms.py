"""Small scenes as texts: the inside of a unit cube, lit by its ceiling (z = 1)."""

MTL = """newmtl white
Kd 0.5 0.5 0.5
newmtl light
Kd 0.2 0.2 0.2
Ke 1 1 1
"""

VERTICES = """v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
"""

# Normals point inward.
WALLS = """usemtl white
f 1 2 3 4
f 1 5 6 2
f 2 6 7 3
f 3 7 8 4
f 4 8 5 1
"""
CEILING = """usemtl light
f 5 8 7 6
"""

ROOM = "mtllib room.mtl\n" + VERTICES + WALLS + CEILING

INSIDE = ("--eye", "0.5,0.1,0.5", "--look-at", "0.5,0.9,0.5", "--up", "0,0,1", "--fov", "70")
OUTSIDE = ("--eye", "0.5,-3,0.5", "--look-at", "0.5,0.5,0.5", "--up", "0,0,1")
SMALL = ("--resolution", "16x16")


def scene_file(extra="", camera="eye = [0.5, 0.1, 0.5]\nlook_at = [0.5, 0.9, 0.5]\nup = [0.0, 0.0, 1.0]\n"):
    """A scene file of the room with a camera inside; `extra` goes after it."""
    return f'[[geometry]]\nfile = "room.obj"\n\n[camera]\n{camera}resolution = [16, 16]\n\n{extra}'
