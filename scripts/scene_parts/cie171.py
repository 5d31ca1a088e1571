"""Scenes in the style of cases 5.3, 5.4, 5.6 to 5.8 of CIE 171:2006; bench/cie171.py judges them.

The sizes are this project's own, not the report's; the values follow from closed forms. Units: m, lm/m2
(exitance), lx (illuminance). z is up; the room is 4 m wide and deep, 3 m high, and stands on z = 0.

How illuminance is read: a solution holds B alone. A receiver has E = 0 and a reflectance in one colour channel,
and nothing that it sees reflects in that channel, so that H = B / rho there is the direct illuminance, averaged
over the receiver, without any interreflection.
"""

import math
import textwrap
from dataclasses import dataclass

from .mesh import Material, Mesh, SceneFile, add, grey, point_factor, quad, room_faces, split_around

UP, DOWN, TO_LEFT, TO_RIGHT = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (-1.0, 0.0, 0.0), (1.0, 0.0, 0.0)
LOW, HIGH, MIDDLE = (-2.0, -2.0, 0.0), (2.0, 2.0, 3.0), (0.0, 0.0, 1.5)
EXITANCE = 1000.0  # of every lamp and lit patch [lm/m2]
RECEIVER_RHO = 0.5
RECEIVER_EDGE = 0.1
RED, GREEN, BLUE = range(3)


def in_channel(channel):
    return tuple(RECEIVER_RHO if c == channel else 0.0 for c in range(3))


@dataclass(frozen=True)
class Rectangle:
    """A horizontal rectangle."""

    x: tuple
    y: tuple
    z: float

    @property
    def area(self):
        return (self.x[1] - self.x[0]) * (self.y[1] - self.y[0])

    def face(self):
        """Corners, normal upward."""
        (x0, x1), (y0, y1) = self.x, self.y
        return quad((x0, y0, self.z), (x1 - x0, 0.0, 0.0), (0.0, y1 - y0, 0.0))


@dataclass(frozen=True)
class Receiver:
    """A square of RECEIVER_EDGE about a point where illuminance is asked for; normal along an axis."""

    point: tuple
    normal: tuple

    @property
    def channel(self):
        """Level receivers do not see each other, nor do those of one wall; level ones and a wall's do."""
        return RED if self.normal in (UP, DOWN) else GREEN

    @property
    def axes(self):
        """Two unit vectors in the plane of the square."""
        return ((1.0, 0.0, 0.0) if self.normal in (UP, DOWN) else UP), (0.0, 1.0, 0.0)

    def at(self, s, t):
        """The place s along the first axis and t along the second from the middle [m]."""
        return tuple(p + s * a + t * b for p, a, b in zip(self.point, *self.axes))

    def face(self):
        half = 0.5 * RECEIVER_EDGE
        corners = [self.at(-half, -half), self.at(half, -half), self.at(half, half), self.at(-half, half)]
        return corners[::-1] if self.normal in (DOWN, TO_RIGHT) else corners

    def describe(self):
        place = "({:g}, {:g}, {:g})".format(*self.point)
        return f"{'level' if self.channel == RED else 'upright'} at {place}"


@dataclass(frozen=True)
class PointCase:
    """Illuminance at points from one rectangle of exitance EXITANCE. Receivers are patches 0, 1, ..."""

    name: str
    emitter: Rectangle
    faces: tuple  # normal of the emitter
    receivers: tuple
    board: tuple = None  # (x, height): a board across the room, standing on the emitter

    def visible(self, point):
        """The parts of the emitter that a point left of the board sees."""
        if self.board is None:
            return [self.emitter]
        board_x, height = self.board
        (x0, x1), above = self.emitter.x, point[2] - height
        parts = [Rectangle((x0, board_x), self.emitter.y, self.emitter.z)]
        shadow_end = board_x + (board_x - point[0]) * height / above if above > 0 else math.inf
        if shadow_end < x1:
            parts.append(Rectangle((shadow_end, x1), self.emitter.y, self.emitter.z))
        return parts


LAMP = Rectangle((-0.5, 0.5), (-0.5, 0.5), 3.0)
ON_CEILING = tuple(Receiver((x, 0.0, 3.0), DOWN) for x in (0.0, 0.5, 1.0, 1.5))
ON_RIGHT_WALL = tuple(Receiver((2.0, 0.0, z), TO_LEFT) for z in (0.5, 1.0, 1.5, 2.0, 2.5))
POINT_CASES = (
    PointCase(
        "5.3-area-source",
        LAMP,
        DOWN,
        tuple(
            Receiver((x, y, 0.0), UP)
            for x, y in ((0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.5, 0.0), (1.0, 1.0), (1.5, 1.5))
        )
        + ON_RIGHT_WALL,
    ),
    PointCase(
        "5.6-small-patch", Rectangle((-0.25, 0.25), (-0.25, 0.25), 0.0), UP, ON_CEILING + ON_RIGHT_WALL
    ),
    PointCase("5.6-whole-floor", Rectangle((-2.0, 2.0), (-2.0, 2.0), 0.0), UP, ON_CEILING + ON_RIGHT_WALL),
    PointCase(
        "5.7-obstruction",
        Rectangle((-2.0, 2.0), (-2.0, 2.0), 0.0),
        UP,
        # While the point moves over one receiver, the shadow's end does not cross the emitter's.
        tuple(Receiver((x, 0.0, 3.0), DOWN) for x in (-1.5, -1.0, -0.5))
        + tuple(Receiver((-2.0, 0.0, z), TO_RIGHT) for z in (0.5, 1.0, 1.5, 2.0, 2.5)),
        board=(0.0, 0.9),
    ),
)

# Off the grids of elements on panel and floor, so that no line between two centres meets the opening's edge.
OPENING = Rectangle((0.13, 1.13), (-0.41, 0.59), 3.0)
PANEL = Rectangle((-0.57, 1.43), (-0.94, 1.06), 4.0)
# Each of the five receiving surfaces reflects in one channel of one of the two scene files; none sees itself.
CONSERVATION_FILES = {
    "a": {"floor": RED, "left": GREEN, "front": BLUE},
    "b": {"right": GREEN, "back": BLUE},
}
CONSERVATION_SURFACES = ("floor", "front", "back", "left", "right")  # patches 0 to 4

CUBE_EDGE, SQUARES = 4.0, 16
FLUX = 10000.0  # of the point source in the cube's centre [lm]
CUBE_RHO = (0.1, 0.5, 0.9)  # by colour channel

CAMERA = {
    "eye": (-1.8, -1.8, 1.2),
    "look_at": (1.0, 1.0, 1.5),
    "up": UP,
    "fov": 90.0,
    "resolution": (64, 64),
}
SMALL_PRINT = """In the style of case {case} of CIE 171:2006; sizes and points are this project's own, the
values follow from closed forms. Lamps and lit patches have an exitance of 1000 lm/m2 and reflect nothing."""
POINTS_PRINT = """Receivers are squares of 0.1 m that reflect 0.5 in one channel (level ones in red, upright
ones in green), so that illuminance = B / 0.5 there, without interreflection. It is the mean over the square;
bench/cie171.py compares with the exact mean. Must give, as illuminance over exitance at the points themselves
(Lambert's closed form for a polygon):"""
LIT = "Its exitance is rho times its illuminance, say 0.5 times 2000 lx, and is given as emitted."
ABOUT = {
    "5.3-area-source": "A lamp of 1 x 1 m in the ceiling's middle lights points on the floor and on a wall.",
    "5.6-small-patch": f"A lit square of 0.5 x 0.5 m on the floor lights points on ceiling and wall. {LIT}",
    "5.6-whole-floor": f"The evenly lit floor of 4 x 4 m lights points on ceiling and wall. {LIT}",
    "5.7-obstruction": """The floor of case 5.6 with a black board of height 0.9 m across its middle, x = 0.
From a point (x, y, z) with x < 0 the board hides the floor from x = 0 to -x 0.9 / (z - 0.9), and all of x > 0
from a point no higher than itself. What is left, one or two rectangles, counts.""",
    "5.4-pane": """A pane of 1 x 1 m in the ceiling shines into the room. Must give: illuminance times area,
summed over the floor and the walls, is the pane's flux of 1000 lm.""",
    "5.4-opening": """A panel of 2 x 2 m hangs 1 m above an opening of 1 x 1 m in the ceiling. Must give:
illuminance times area, summed over the floor and the walls, is the flux through the opening, {flux:.6f} lm:
the panel's exitance times its configuration factor (Lambert's closed form), integrated over the opening.""",
    "5.4": """The five inner surfaces see each other: in this file only {surfaces} reflect, 0.5 in one channel
each (red, green, blue), so that their illuminance is B / 0.5 without interreflection; the other file has the
rest.""",
    "5.8-cube": """A closed cube of 4 m, reflectance 0.1 in red, 0.5 in green, 0.9 in blue, with an isotropic
point source of 10000 lm in its middle. The first reflection is the exitance: each of 16 x 16 squares a wall
has E = rho times the source's mean illuminance on it, intensity times solid angle over area, exactly. The
illuminance by reflected light is then (B - E) / rho. Must give, as its mean over the room, and by symmetry
over each wall, flux * rho / (S (1 - rho)) = {values}. (In any closed room of surface S what the walls absorb
is the source's flux: (1 - rho) S <H> = flux, and <H> = flux / S + <H reflected>.)""",
}


def prose(*texts):
    return "\n".join(textwrap.fill(" ".join(text.split()), 110) for text in texts)


def point_case(case):
    mesh = Mesh(
        {
            "emitter": Material(grey(0.0), grey(EXITANCE)),
            "level": Material(in_channel(RED)),
            "upright": Material(in_channel(GREEN)),
            "board": Material(grey(0.0)),
        }
    )
    if case.board is None:
        del mesh.materials["board"]
    for receiver in case.receivers:
        material = "level" if receiver.channel == RED else "upright"
        mesh.add("receivers", material, [receiver.face()], towards=add(receiver.point, receiver.normal))
    face = case.emitter.face()
    mesh.add("emitter", "emitter", [face if case.faces == UP else face[::-1]], towards=MIDDLE)
    if case.board is not None:
        x, height = case.board
        face = quad((x, LOW[1], 0.0), (0.0, 0.0, height), (0.0, HIGH[1] - LOW[1], 0.0))
        mesh.add("board", "board", [face], towards=(LOW[0], 0.0, 0.0))
    values = []
    for receiver in case.receivers:
        parts = case.visible(receiver.point)
        factor = sum(point_factor(receiver.point, receiver.normal, part.face()) for part in parts)
        values.append(f"  {receiver.describe()}: {factor:.10f}")
    scene = SceneFile(
        title(case.name),
        "\n".join([prose(ABOUT[case.name], SMALL_PRINT.format(case=case.name[:3]), POINTS_PRINT), *values]),
        f"{case.name}.obj",
        CAMERA,
        {"method": "matrix", "sides": "one", "subdivision": "uniform", "max-edge": 0.126, "tolerance": 1e-6},
    )
    return files(case.name, mesh, {case.name: scene})


def conservation(name, light, tolerance, **values):
    """A room with an opening in its ceiling, lit through it by `light`: fluxes of two scene files add up."""
    mesh = Mesh({surface: Material(grey(0.0)) for surface in CONSERVATION_SURFACES})
    mesh.materials |= {"roof": Material(grey(0.0)), "light": Material(grey(0.0), grey(EXITANCE))}
    walls = room_faces(LOW, HIGH)
    walls["floor"] = walls.pop("bottom")
    for surface in CONSERVATION_SURFACES:
        mesh.add(surface, surface, [walls[surface]], towards=MIDDLE)
    level = Rectangle((LOW[0], HIGH[0]), (LOW[1], HIGH[1]), HIGH[2]).face()
    part = lambda ends, axis: tuple((end - LOW[axis]) / (HIGH[axis] - LOW[axis]) for end in ends)
    frame, _ = split_around(level, part(OPENING.x, 0), part(OPENING.y, 1))
    mesh.add("roof", "roof", [cell[::-1] for cell in frame], towards=MIDDLE)
    mesh.add("light", "light", [light.face()[::-1]], towards=MIDDLE)
    scenes = {}
    for letter, channels in CONSERVATION_FILES.items():
        own = ABOUT["5.4"].format(surfaces=", ".join(channels))
        scenes[f"{name}-{letter}"] = SceneFile(
            f"{title(name)} ({letter})",
            prose(ABOUT[name].format(**values), SMALL_PRINT.format(case="5.4"), own),
            f"{name}.obj",
            CAMERA,
            {"method": "matrix", "sides": "one", "subdivision": "uniform", "max-edge": 0.251, "tolerance": tolerance},
            materials={surface: {"rho": in_channel(channel)} for surface, channel in channels.items()},
        )
    return files(name, mesh, scenes)


def flux_through_opening():
    """The panel's light through the opening [lm]: Gauss-Legendre, 8 cells of 2 points along each side."""
    half = 0.5 / 8
    shifts = [(2 * k + 1 + sign / math.sqrt(3)) * half for k in range(8) for sign in (-1, 1)]
    (x0, x1), (y0, y1) = OPENING.x, OPENING.y
    points = [(x0 + s * (x1 - x0), y0 + t * (y1 - y0), OPENING.z) for s in shifts for t in shifts]
    return EXITANCE * OPENING.area * sum(point_factor(p, UP, PANEL.face()) for p in points) / len(points)


def cie171_points():
    return {name: text for case in POINT_CASES for name, text in point_case(case).items()}


def cie171_conservation():
    # With the pane in the room's own ceiling, single precision cannot prove 1e-6.
    pane = conservation("5.4-pane", OPENING, tolerance=1e-5)
    return pane | conservation("5.4-opening", PANEL, tolerance=1e-6, flux=flux_through_opening())


def corner_solid_angle(a, b, distance):
    """Solid angle of a rectangle a x b seen from `distance` above one of its corners; odd in a and in b."""
    return math.atan(a * b / (distance * math.sqrt(a * a + b * b + distance * distance)))


def mean_direct(i, j):
    """Mean direct illuminance over square (i, j) of a wall: intensity * solid angle / area, exactly."""
    half, side = 0.5 * CUBE_EDGE, CUBE_EDGE / SQUARES
    (s0, s1), (t0, t1) = ((k * side - half, (k + 1) * side - half) for k in (i, j))
    angle = sum(
        sign * corner_solid_angle(s, t, half)
        for sign, s, t in ((1, s1, t1), (-1, s0, t1), (-1, s1, t0), (1, s0, t0))
    )
    return FLUX / (4 * math.pi) * angle / side**2


def cie171_cube():
    """Squares at the same distances from a wall's middle get the same light and share a material."""
    # Same distances from the middle, in either order.
    key = lambda i, j: tuple(sorted(max(k, SQUARES - 1 - k) - SQUARES // 2 for k in (i, j)))
    mesh, received = Mesh(), 0.0
    half = 0.5 * CUBE_EDGE
    walls = room_faces((-half,) * 3, (half,) * 3)
    for wall, face in walls.items():
        first = tuple((b - a) / SQUARES for a, b in zip(face[0], face[1]))
        second = tuple((b - a) / SQUARES for a, b in zip(face[0], face[3]))
        for j in range(SQUARES):
            for i in range(SQUARES):
                direct = mean_direct(i, j)
                received += direct * (CUBE_EDGE / SQUARES) ** 2
                name = "square_{}_{}".format(*key(i, j))
                mesh.materials.setdefault(name, Material(CUBE_RHO, tuple(rho * direct for rho in CUBE_RHO)))
                corner = tuple(o + i * a + j * b for o, a, b in zip(face[0], first, second))
                mesh.add(wall, name, [quad(corner, first, second)], towards=(0.0, 0.0, 0.0))
    mesh.require_closed(set(walls), outward=False)
    if abs(received - FLUX) > 1e-9 * FLUX:
        raise ValueError("the walls do not receive the source's flux")
    surface = 6 * CUBE_EDGE**2
    values = ", ".join(f"{FLUX * rho / (surface * (1 - rho)):.6g} lx at rho {rho:g}" for rho in CUBE_RHO)
    scene = SceneFile(
        title("5.8-cube"),
        prose(ABOUT["5.8-cube"].format(values=values)),
        "5.8-cube.obj",
        CAMERA,
        # Single precision leaves an error bound of some 1e-6 at rho = 0.9.
        {"method": "matrix", "sides": "one", "subdivision": "uniform", "max-edge": 0.251, "tolerance": 1e-5},
    )
    return files("5.8-cube", mesh, {"5.8-cube": scene})


def cie171_point_source():
    """The same cube, plain, with the source itself in its middle, and meters on a wall."""
    name, half = "5.8-point-source", 0.5 * CUBE_EDGE
    mesh = Mesh({"wall": Material(CUBE_RHO)})
    for wall, face in room_faces((-half,) * 3, (half,) * 3).items():
        mesh.add(wall, "wall", [face], towards=(0.0, 0.0, 0.0))
    intensity = FLUX / (4 * math.pi)
    # Cells so small that their mean is the value in their middle; a millionth of the room off the wall.
    tables = f"""
[[luminaires]]
name = "source"
intensity = {intensity:.9g}
position = [0, 0, 0]

[[receivers]]
name = "middle"
origin = [-0.005, -0.005, -1.99999]
u = [0.01, 0, 0]
v = [0, 0.01, 0]
cells = [1, 1]

[[receivers]]
name = "corner"
origin = [1.9995, 1.9995, -1.99999]
u = [0.0004, 0, 0]
v = [0, 0.0004, 0]
cells = [1, 1]
"""
    surface = 6 * CUBE_EDGE**2
    values = ", ".join(f"{FLUX * rho / (surface * (1 - rho)):.6g} lx at rho {rho:g}" for rho in CUBE_RHO)
    scene = SceneFile(
        title(name),
        prose(
            f"""The cube of 5.8-cube.toml of six plain walls, with an isotropic luminaire of 10000 lm in its middle.
            Must give: direct illuminance {intensity / 4:.6g} lx in the middle of a wall and
            {intensity / (12 * math.sqrt(3)):.6g} lx in a corner; reflected light of {values} as its mean over the room."""
        ),
        f"{name}.obj",
        CAMERA,
        {"sides": "one"},
        units="photometric",
        tables=tables,
    )
    return files(name, mesh, {name: scene})


def title(name):
    case, words = name.split("-", 1)
    return f"After CIE 171:2006, case {case}, {words.replace('-', ' ')}"


def files(name, mesh, scenes):
    heading = [f"After CIE 171:2006, case {name[:3]}, with sizes of its own; written by scripts/make-scenes."]
    texts = {
        f"cie171/{name}.obj": mesh.obj(heading, f"{name}.mtl"),
        f"cie171/{name}.mtl": mesh.mtl(["Ke is an exitance [lm/m2]."]),
    }
    return texts | {f"cie171/{scene}.toml": text.text() for scene, text in scenes.items()}
