"""An electrically heated chamber, for heat in place of light."""

from .mesh import Material, Mesh, SceneFile, area_vector, dot, grey, room_faces, subtract

LOW, HIGH = (0.0, 0.0, 0.0), (4.0, 2.0, 2.0)
SQUARE = 0.5  # [m]

# Kd is 1 - emissivity: what a picture by light would show.
MATERIALS = {
    "steel": Material(grey(0.2), heat={"emissivity": 0.8, "temperature": 700.0}),
    "heating_panel": Material(grey(0.1), heat={"emissivity": 0.9, "temperature": 1300.0}),
    "refractory": Material(grey(0.5), heat={"emissivity": 0.5, "heat_flux": 0.0}),
    "leaking_wall": Material(grey(0.5), heat={"emissivity": 0.5, "heat_flux": -1500.0}),
    "opening": Material(grey(0.0), heat={"emissivity": 1.0, "temperature": 300.0}),
}


def squares(face):
    """A wall as squares of SQUARE metres."""
    origin, first, second = face[0], subtract(face[1], face[0]), subtract(face[3], face[0])
    columns, rows = (round(dot(edge, edge) ** 0.5 / SQUARE) for edge in (first, second))
    at = lambda i, j: tuple(o + i / columns * a + j / rows * b for o, a, b in zip(origin, first, second))
    return [[at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)] for j in range(rows) for i in range(columns)]


def part_of(wall, middle):
    """(group, material) of the square around `middle`."""
    x, y, z = middle
    along = 0.5 < x < 3.5
    if wall == "bottom" and along and 0.5 < y < 1.5:
        return "load", "steel"
    if wall == "top" and along and not 0.5 < y < 1.5:
        return "heaters", "heating_panel"
    if wall == "left" and 0.5 < y < 1.5 and z < 0.5:
        return "opening", "opening"
    return ("end-wall", "leaking_wall") if wall == "right" else ("refractory", "refractory")


def heating_chamber():
    mesh = Mesh(MATERIALS)
    centre = tuple((a + b) / 2 for a, b in zip(LOW, HIGH))
    area = {}
    for wall, face in room_faces(LOW, HIGH).items():
        for square in squares(face):
            group, material = part_of(wall, tuple(sum(corner[k] for corner in square) / 4 for k in range(3)))
            mesh.add(group, material, [square], towards=centre)
            normal = area_vector(square)
            area[group] = area.get(group, 0.0) + dot(normal, normal) ** 0.5
    mesh.require_closed(set(area), outward=False)

    scene = SceneFile(
        "Heating chamber, by radiation alone",
        f"""A chamber of 4 x 2 x 2 m seen from inside, heat in place of light: steel at 700 K on the floor ({area["load"]:g} m2), heating panels
at 1300 K under the roof ({area["heaters"]:g} m2), walls of refractory brick that give back what they get, an end wall through which
1500 W/m2 are lost, and an opening of {area["opening"]:g} m2 into surroundings at 300 K (black: what enters it is gone).
Must give, with one element a square of {SQUARE:g} m, as net powers [W] and temperatures [K] of the areas:
  heaters 222616, load -178773, opening -37843, end-wall -6000, refractory 0; refractory 1096.39 K, end-wall 1087.50 K.
Squares of 0.25 m give instead 221108, -177819, -37289, -6000, 0; 1095.77 K, 1086.66 K: a refined run must move there.
The net powers add up to 0. Where from: the net radiation method for q and T themselves, solved by elimination with view
factors in closed form (parallel and perpendicular rectangles, Ehlert & Smith 1993), as tests/regression/radiation.py does.
The chamber is made up; its sizes, emissivities and temperatures are common ones of electric furnaces.""",
        "heating-chamber.obj",
        {},
        {"method": "matrix", "thermal": True, "sides": "one", "subdivision": "none"},
    )
    return {
        "heating-chamber/heating-chamber.obj": mesh.obj(
            ["A heating chamber seen from inside, in metres; written by scripts/make-scenes."], "heating-chamber.mtl"
        ),
        "heating-chamber/heating-chamber.mtl": mesh.mtl(["Emissivities, temperatures [K], net fluxes [W/m2]."]),
        "heating-chamber/heating-chamber.toml": scene.text(),
    }
