"""Plates that transmit light, one below another in a shaft of mirrors (Dmitriev 2002, figure 2).

write_plates(folder, ...) writes the scene with other distances, transmittances and numbers of plates.
"""

from pathlib import Path

from .mesh import Material, Mesh, SceneFile, grey, number, quad

EDGE = 16.0  # of a plate [m]
CELLS = 32  # along an edge of a plate
PLATES = 5
DISTANCE = 0.1  # from one plate to the next [m]
STRAIGHT, DIFFUSE = 0.8, 0.2
EXITANCE = 1.0  # of the lid [W/m2]
DIM_STRAIGHT = 0.5


def irradiance(plate, straight=STRAIGHT, diffuse=DIFFUSE):
    """Of a plate from above, counted from 1: exactly the same everywhere [W/m2]."""
    return EXITANCE * (straight + diffuse) ** (plate - 1)


def plates_mesh(distance=DISTANCE, plates=PLATES):
    """The lid lies at z = 0. Walls are in one piece each and end half a distance below the last plate."""
    mesh = Mesh({"lid": Material(grey(0.0)), "plate": Material(grey(0.0)), "mirror": Material(grey(0.0))})
    low, high, bottom = -0.5 * EDGE, 0.5 * EDGE, -(plates + 0.5) * distance
    level = lambda z: quad((low, low, z), (EDGE, 0.0, 0.0), (0.0, EDGE, 0.0))
    mesh.add("lid", "lid", [level(0.0)[::-1]], towards=(0.0, 0.0, bottom))
    for plate in range(1, plates + 1):
        mesh.add(f"plate{plate}", "plate", [level(-plate * distance)], towards=(0.0, 0.0, 1.0))
    corners = [(low, low), (high, low), (high, high), (low, high)]
    walls = [[(*p, 0.0), (*q, 0.0), (*q, bottom), (*p, bottom)] for p, q in zip(corners, corners[1:] + corners[:1])]
    mesh.add("walls", "mirror", walls, towards=(0.0, 0.0, 0.5 * bottom))
    return mesh


def plates_text(geometry, distance=DISTANCE, straight=STRAIGHT, diffuse=DIFFUSE, plates=PLATES):
    """The scene file."""
    kept = number(straight + diffuse)
    power, share = ("E", "all") if kept == "1" else (f"E {kept}^(k - 1)", kept)
    return SceneFile(
        "Plates in a shaft of mirrors",
        f"""A shaft of {number(EDGE)} x {number(EDGE)} m between ideal mirrors, open below (Dmitriev 2002, figure 2). The lid emits E = {number(EXITANCE)} W/m2
downwards; below it hang {plates} plates, {number(distance)} m apart, that reflect nothing, let {number(straight)} of the light straight through and {number(diffuse)}
evenly in all directions.
Must give: the irradiance of plate k from above is {power} everywhere, exactly. The mirrors make lid and plates as good as
endless, under which each point is lit by E from above; each plate sends {share} of that on, as evenly; nothing comes back.
fluxel photons follows the light, with --max-edge {number(EDGE / CELLS)} to {CELLS} x {CELLS} squares of each plate; so does fluxel reference.""",
        geometry,
        {},
        {"sides": "one", "subdivision": "uniform", "max-edge": EDGE / CELLS},
        materials={
            "lid": {"E": EXITANCE},
            "plate": {"transmission": float(straight), "diffuse_transmission": float(diffuse), "sides": "two"},
            "mirror": {"mirror": 1.0},
        },
    ).text()


def plates_files(name, **parameters):
    """OBJ, MTL and scene file of that name; parameters are those of plates_text, but for the geometry."""
    mesh = plates_mesh(**{key: parameters[key] for key in ("distance", "plates") if key in parameters})
    return {
        f"{name}.obj": mesh.obj(["Plates in a shaft, in metres; written by scripts/make-scenes."], f"{name}.mtl"),
        f"{name}.mtl": mesh.mtl(["What the surfaces do with light stands in the scene file."]),
        f"{name}.toml": plates_text(f"{name}.obj", **parameters),
    }


def write_plates(folder, name="plates", **parameters):
    """Writes plates_files into a folder and returns the scene file."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for file, text in plates_files(name, **parameters).items():
        (folder / file).write_bytes(text.encode())
    return folder / f"{name}.toml"


def plates():
    files = plates_files("plates")
    files["plates-dim.toml"] = plates_text("plates.obj", straight=DIM_STRAIGHT)
    return {f"plates/{name}": text for name, text in files.items()}
