"""A cube in a cube, and a corridor lit from the side."""

from .mesh import Material, Mesh, SceneFile, box_faces, grey, room_faces, split_around

UP = (0.0, 0.0, 1.0)

# Reflectances of the six walls of each cube, in the order of box_faces.
BODY_RHO = (0.1, 0.9, 0.3, 0.6, 0.8, 0.4)
SHELL_RHO = (0.7, 0.2, 0.9, 0.5, 0.3, 0.8)


def cube_in_cube():
    levels = sorted(set(BODY_RHO + SHELL_RHO))
    mesh = Mesh({f"rho_{10 * rho:.0f}": Material(grey(rho), grey(round(1 - rho, 9))) for rho in levels})
    body, shell = box_faces((1.0, 1.0, 1.0), (2.0, 2.0, 2.0)), room_faces((0.0, 0.0, 0.0), (3.0, 3.0, 3.0))
    for (name, face), rho in zip(body.items(), BODY_RHO):
        mesh.add(f"body_{name}", f"rho_{10 * rho:.0f}", [face], away_from=(1.5, 1.5, 1.5))
    for (name, face), rho in zip(shell.items(), SHELL_RHO):
        mesh.add(f"shell_{name}", f"rho_{10 * rho:.0f}", [face], towards=(1.5, 1.5, 1.5))
    mesh.require_closed({f"body_{name}" for name in body}, outward=True)
    mesh.require_closed({f"shell_{name}" for name in shell}, outward=False)
    scene = SceneFile(
        "Cube in a cube, a furnace",
        """A cube of side 1 in the middle of a cube of side 3. Each wall of both has a reflectance rho of its own and emits 1 - rho.
Must give: B = 1 everywhere, since in a closed scene sum_j F_ij = 1 makes B = 1 solve B = E + rho F B exactly, whatever
stands in the way. Factors between the cubes: body to shell 1, shell to body 1/9, shell to itself past the body 8/9.""",
        "cube-in-cube.obj",
        {"eye": (0.3, 0.2, 2.6), "look_at": (1.8, 1.9, 1.2), "up": UP, "fov": 75.0, "resolution": (128, 128)},
        {"sides": "one"},
    )
    return {
        "cube-in-cube/cube-in-cube.obj": mesh.obj(
            ["A cube in a cube; written by scripts/make-scenes."], "cube-in-cube.mtl"
        ),
        "cube-in-cube/cube-in-cube.mtl": mesh.mtl(["Ke is an exitance: 1 - Kd."]),
        "cube-in-cube/cube-in-cube.toml": scene.text(),
    }


CORRIDOR = ((0.0, 0.0, 0.0), (2.0, 14.0, 2.6))
PIERS = (((0.0, 7.0), (0.55, 7.4)), ((1.45, 4.0), (2.0, 4.4)))  # low and high corner in plan


def corridor():
    mesh = Mesh({"white": Material(grey(0.75)), "floor": Material((0.35, 0.25, 0.18)), "light": Material(grey(0.0), (30.0, 29.0, 26.0))})
    room, inside = room_faces(*CORRIDOR), (1.0, 7.0, 1.3)
    for name in ("top", "front", "back", "right"):
        mesh.add({"top": "ceiling", "front": "near_end", "back": "far_end", "right": "right_wall"}[name], "white", [room[name]], towards=inside)
    mesh.add("floor", "floor", [room["bottom"]], towards=inside)
    frame, window = split_around(room["left"], (0.35, 0.85), (0.12, 0.28))
    mesh.add("left_wall", "white", frame, towards=inside)
    mesh.add("window", "light", [window], towards=inside)
    for number, ((x0, y0), (x1, y1)) in enumerate(PIERS, 1):
        faces = box_faces((x0, y0, 0.0), (x1, y1, CORRIDOR[1][2]))
        hidden = {"bottom", "top", "left" if x0 == 0 else "right"}
        middle = ((x0 + x1) / 2, (y0 + y1) / 2, 1.3)
        for name, face in faces.items():
            if name not in hidden:
                mesh.add(f"pier_{number}", "white", [face], away_from=middle)
    scene = SceneFile(
        "Corridor lit from the side",
        """A corridor 14 m long, 2 m wide and 2.6 m high. A window in the left wall far from the eye is its only light; two piers, 55 cm
wide, stand between.
Must give: light that falls by more than an order of magnitude from the window to the eye.""",
        "corridor.obj",
        {"eye": (1.0, 0.2, 1.5), "look_at": (1.0, 7.0, 1.3), "up": UP, "fov": 60.0, "resolution": (128, 128)},
        {"sides": "one"},
    )
    return {
        "corridor/corridor.obj": mesh.obj(["A corridor with a window; written by scripts/make-scenes."], "corridor.mtl"),
        "corridor/corridor.mtl": mesh.mtl(["Ke is an exitance."]),
        "corridor/corridor.toml": scene.text(),
    }
