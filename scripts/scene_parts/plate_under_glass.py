"""A black plate under a slab of glass and a point luminaire (Dmitriev 2002, figure 1).

bench/photons/plate_under_glass.py has the exact illuminance of the plate.
"""

import math

from .mesh import Material, Mesh, SceneFile, box_faces, grey, number, quad

PLATE_EDGE = 2.0  # [m], about the origin, at z = 0
CELLS = 32  # along an edge of the plate
SOURCE_HEIGHT = 2.0  # [m]
SLAB_EDGE, SLAB_LOW, SLAB_HIGH = 4.0, 0.8, 1.0  # [m]
REFRACTION_INDEX = 1.33

C_ANGLES = tuple(range(0, 361, 30))  # [degrees]
GAMMAS = tuple(range(0, 46, 5))  # [degrees]: nothing is sent beyond, so nothing passes beside the slab
LAST_GAMMA = 90  # of the file: as the format has it, dark
AXIAL = 1000.0  # intensity [cd]


def intensity(C, gamma):
    """At the table's angles [degrees], as written [cd]; bilinear between them, as Fluxel has it."""
    twice = math.radians(2 * gamma)
    return round(AXIAL * math.cos(twice) * (1 + 0.4 * math.sin(twice) * math.cos(math.radians(C - 30))), 2)


def luminaire():
    """The IES file."""
    lines = [
        "IESNA:LM-63-2002",
        "[TEST] none: a smooth function, by scripts/make-scenes",
        "[MANUFAC] none",
        "[LUMINAIRE] a point whose intensity varies with C and gamma",
        "TILT=NONE",
        f"1 -1 1 {len(GAMMAS) + 1} {len(C_ANGLES)} 1 2 0 0 0",
        "1 1 0",
        " ".join(map(number, (*GAMMAS, LAST_GAMMA))),
        " ".join(map(number, C_ANGLES)),
    ]
    lines += [" ".join(number(intensity(C, gamma)) for gamma in GAMMAS) + " 0" for C in C_ANGLES]
    return "\n".join(lines) + "\n"


def plate_under_glass():
    name = "plate-under-glass"
    mesh = Mesh({"black": Material(grey(0.0)), "glass": Material(grey(0.0))})
    half = 0.5 * PLATE_EDGE
    plate = quad((-half, -half, 0.0), (PLATE_EDGE, 0.0, 0.0), (0.0, PLATE_EDGE, 0.0))
    mesh.add("plate", "black", [plate], towards=(0.0, 0.0, 1.0))
    half = 0.5 * SLAB_EDGE
    slab = box_faces((-half, -half, SLAB_LOW), (half, half, SLAB_HIGH))
    mesh.add("slab", "glass", slab.values(), away_from=(0.0, 0.0, 0.5 * (SLAB_LOW + SLAB_HIGH)))
    mesh.require_closed({"slab"}, outward=True)
    scene = SceneFile(
        "Plate under glass",
        f"""A black plate of {number(PLATE_EDGE)} x {number(PLATE_EDGE)} m lies {number(SOURCE_HEIGHT)} m below a point luminaire whose intensity varies with C and gamma; between them
hangs a slab of glass of {number(SLAB_EDGE)} x {number(SLAB_EDGE)} x {number(SLAB_HIGH - SLAB_LOW)} m (Dmitriev 2002, figure 1). All else is open.
Must give, as mean illuminance of each of {CELLS} x {CELLS} squares of the plate: bench/photons/plate_under_glass.py, which follows
Snell's and Fresnel's laws through the slab, with all reflections between its faces. Paths from the plate never find a
point behind glass; fluxel photons --max-edge {number(PLATE_EDGE / CELLS)} follows the light.""",
        f"{name}.obj",
        {},
        {"sides": "one", "subdivision": "uniform", "max-edge": PLATE_EDGE / CELLS},
        units="photometric",
        materials={"glass": {"refraction_index": REFRACTION_INDEX}},
        tables=f"""
[[luminaires]]
name = "source"
file = "{name}.ies"
position = [0, 0, {number(SOURCE_HEIGHT)}]
aim = [0, 0, -1]
""",
    )
    heading = ["A plate under a slab of glass, in metres; written by scripts/make-scenes."]
    return {
        f"{name}/{name}.obj": mesh.obj(heading, f"{name}.mtl"),
        f"{name}/{name}.mtl": mesh.mtl(["The index of refraction stands in the scene file."]),
        f"{name}/{name}.ies": luminaire(),
        f"{name}/{name}.toml": scene.text(),
    }
