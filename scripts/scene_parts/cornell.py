"""The Cornell box in its measured coordinates."""

from .mesh import Material, Mesh, SceneFile, grey, point_factor

# Coordinates [mm]: Cornell University Program of Computer Graphics, graphics.cornell.edu/online/box/data.html.
# The published order of corners makes every normal point into the room and out of the blocks.
WALLS = {
    "floor": ("white", [(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)]),
    "ceiling": ("white", [(556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)]),
    "back_wall": ("white", [(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)]),
    "right_wall": ("green", [(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]),
    "left_wall": ("red", [(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)]),
    "light": ("light", [(343, 548.8, 227), (343, 548.8, 332), (213, 548.8, 332), (213, 548.8, 227)]),
}
SHORT_BLOCK = [
    [(130, 165, 65), (82, 165, 225), (240, 165, 272), (290, 165, 114)],
    [(290, 0, 114), (290, 165, 114), (240, 165, 272), (240, 0, 272)],
    [(130, 0, 65), (130, 165, 65), (290, 165, 114), (290, 0, 114)],
    [(82, 0, 225), (82, 165, 225), (130, 165, 65), (130, 0, 65)],
    [(240, 0, 272), (240, 165, 272), (82, 165, 225), (82, 0, 225)],
]
TALL_BLOCK = [
    [(423, 330, 247), (265, 330, 296), (314, 330, 456), (472, 330, 406)],
    [(423, 0, 247), (423, 330, 247), (472, 330, 406), (472, 0, 406)],
    [(472, 0, 406), (472, 330, 406), (314, 330, 456), (314, 0, 456)],
    [(314, 0, 456), (314, 330, 456), (265, 330, 296), (265, 0, 296)],
    [(265, 0, 296), (265, 330, 296), (423, 330, 247), (423, 0, 247)],
]
# Focal length 35 mm, film 25 mm x 25 mm: full angle 2 atan(12.5/35).
CAMERA = {
    "eye": (0.278, 0.273, -0.8),
    "look_at": (0.278, 0.273, 0.0),
    "up": (0.0, 1.0, 0.0),
    "fov": 39.3076,
    "resolution": (256, 256),
}
SOURCE = """Geometry, camera and light: the measured Cornell box (Cornell University Program of Computer Graphics,
graphics.cornell.edu/online/box/data.html; Goral, Torrance, Greenberg, Battaile 1984 for the first one). The front is
open, the light lies in the plane of the ceiling, the red wall is not planar, the blocks have no bottom."""


def cornell_box():
    mesh = Mesh(
        {
            "white": Material((0.725, 0.71, 0.68)),
            "red": Material((0.63, 0.065, 0.05)),
            "green": Material((0.14, 0.45, 0.091)),
            "light": Material(grey(0.78), (17.0, 12.0, 4.0)),
        }
    )
    for name, (material, corners) in WALLS.items():
        mesh.add(name, material, [corners], towards=(278.0, 273.0, 279.6))
    mesh.add("short_block", "white", SHORT_BLOCK, away_from=(185.0, 82.0, 169.0))
    mesh.add("tall_block", "white", TALL_BLOCK, away_from=(368.0, 165.0, 351.0))

    rgb = SceneFile(
        "Cornell box",
        f"""{SOURCE}
Reflectances and light in RGB: the set of the McGuire Computer Graphics Archive (casual-effects.com/data), where the
light 17 12 4 is a radiance; the emitted exitance is pi times that.
Must give: emitted power pi * (17, 12, 4) * 0.01365 m2 = (0.7290, 0.5146, 0.1715) W; red light on the left side of
the blocks and of the room, green on the right.""",
        "cornell-box.obj",
        CAMERA,
        {"sides": "one", "ke": "radiance"},
        0.001,
    )
    light = [tuple(map(float, c)) for c in WALLS["light"][1]]
    up, checks = (0.0, 1.0, 0.0), []
    for where, point, normal in (
        ("floor", (40.0, 0.0, 300.0), up),
        ("floor", (60.0, 0.0, 500.0), up),
        ("back wall", (278.0, 450.0, 559.2), (0.0, 0.0, -1.0)),
        ("green wall", (0.0, 274.4, 279.6), (1.0, 0.0, 0.0)),
        ("short block's top", (186.0, 165.0, 170.0), up),
        ("tall block's top", (368.0, 330.0, 351.0), up),
    ):
        place = "({:g}, {:g}, {:g})".format(*point)
        checks.append(f"  {where} {place}: {point_factor(point, normal, light):.10f}")
    spectral = SceneFile(
        "Cornell box, spectral means",
        f"""{SOURCE}
Reflectances: the measured spectra (400 to 700 nm in 76 samples), each averaged with the light's spectrum as weight,
as grey. The light's exitance is 1 W/m2.
Must give: emitted power 0.01365 W in each channel, equal channels. Direct irradiance [W/m2] (light of exitance 1, all
of it visible; Lambert's closed form for a polygon), at a point in mm:
"""
        + "\n".join(checks),
        "cornell-box.obj",
        CAMERA,
        {"sides": "one"},
        0.001,
        {
            "white": {"rho": grey(0.7356)},
            "green": {"rho": grey(0.2041)},
            "red": {"rho": grey(0.3475)},
            "light": {"rho": grey(0.78), "E": grey(1.0)},
        },
    )
    heading = [
        "The Cornell box in mm, measured coordinates of the Cornell University Program of Computer Graphics",
        "(graphics.cornell.edu/online/box/data.html). All normals point into the room and out of the blocks.",
    ]
    return {
        "cornell-box/cornell-box.obj": mesh.obj(heading, "cornell-box.mtl"),
        "cornell-box/cornell-box.mtl": mesh.mtl(
            ["RGB set of the McGuire Computer Graphics Archive (casual-effects.com/data); Ke is a radiance there."]
        ),
        "cornell-box/cornell-box.toml": rgb.text(),
        "cornell-box/cornell-box-spectral.toml": spectral.text(),
    }
