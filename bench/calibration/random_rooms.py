"""Random rooms by seed, as people build them: furniture, blinds, shelves, hovering and curved things, several rooms, lamps of
many kinds. Lamps and boxes may cut into each other and into furniture. z is up, lengths are metres, the corner of the (first)
room is the origin."""

import math
import random
from dataclasses import dataclass, field

KINDS = ("boxes", "tables", "shelves", "blinds", "grille", "hovering", "sheets", "two rooms", "slit", "curved", "closed")
LAMPS = ("panel", "hung panel", "small", "hooded", "many", "coloured", "near a wall", "flush")


@dataclass
class Room:
    kind: str
    lamp: str
    faces: list = field(default_factory=list)  # (group, material, corners)
    materials: dict = field(default_factory=dict)  # name -> (reflectance, exitance), of three colours each
    eye: tuple = (0, 0, 0)
    look_at: tuple = (0, 0, 0)

    def polygon(self, group, material, *corners):
        self.faces.append((group, material, corners))

    def box(self, group, material, low, high, turned=0.0, without=()):
        """Faces outward, turned about its vertical axis [rad]; `without` leaves out some of "-x +x -y +y -z +z"."""
        middle = [0.5 * (a + b) for a, b in zip(low, high)]

        def corner(k):
            x, y, z = ((low, high)[k >> axis & 1][axis] for axis in range(3))
            dx, dy = x - middle[0], y - middle[1]
            return (middle[0] + math.cos(turned) * dx - math.sin(turned) * dy,
                    middle[1] + math.sin(turned) * dx + math.cos(turned) * dy, z)

        for side, face in (("-z", (0, 2, 3, 1)), ("+z", (4, 5, 7, 6)), ("-y", (0, 1, 5, 4)), ("+y", (2, 6, 7, 3)),
                           ("-x", (0, 4, 6, 2)), ("+x", (1, 3, 7, 5))):
            if side not in without:
                self.polygon(group, material, *map(corner, face))

    def inside(self, group, material, low, high, without=()):
        """A room: its walls, floor and ceiling, seen from inside."""
        before = len(self.faces)
        self.box(group, material, low, high, without=without)
        self.faces[before:] = [(name, of, tuple(reversed(corners))) for name, of, corners in self.faces[before:]]

    def write(self, path):
        """PATH (.obj) and the MTL file beside it."""
        text = "".join(f"newmtl {name}\nKd {rho[0]:.4f} {rho[1]:.4f} {rho[2]:.4f}\n" +
                       (f"Ke {light[0]:.5g} {light[1]:.5g} {light[2]:.5g}\n" if any(light) else "")
                       for name, (rho, light) in self.materials.items())
        path.with_suffix(".mtl").write_text(text, encoding="ascii")
        vertices = 0
        with open(path, "w", encoding="ascii") as file:
            file.write(f"mtllib {path.with_suffix('.mtl').name}\n")
            for group, material, corners in self.faces:
                file.write(f"g {group.replace(' ', '-')}\nusemtl {material}\n")
                file.writelines("v " + " ".join(f"{x:.7g}" for x in corner) + "\n" for corner in corners)
                file.write("f " + " ".join(str(vertices + 1 + k) for k in range(len(corners))) + "\n")
                vertices += len(corners)

    def options(self, pixels):
        return ("--eye", ",".join(f"{x:.6g}" for x in self.eye), "--look-at", ",".join(f"{x:.6g}" for x in self.look_at),
                "--up", "0,0,1", "--fov", "70", "--resolution", f"{pixels}x{pixels * 3 // 4}")


def make_room(seed):
    return _Builder(seed).room


class _Builder:
    """Draws a room; every choice comes from the seed."""

    def __init__(self, seed):
        self.draw = random.Random(seed)
        self.room = Room(self.draw.choice(KINDS), self.draw.choice(LAMPS))
        self.size = [self.draw.uniform(2.5, 7), self.draw.uniform(2.5, 7), self.draw.uniform(2.2, 3.5)]
        self._paint()
        self._shell()
        for _ in range(self.draw.randrange(4)):
            self._box()
        getattr(self, "_" + self.room.kind.replace(" ", "_"))()
        self._light()
        self._camera()

    def _reflectance(self, low, high):
        grey = self.draw.uniform(low, high)
        tint = self.draw.choice((0, 0, 0.1, 0.3))
        return tuple(min(0.99, max(0.02, grey * (1 + self.draw.uniform(-tint, tint)))) for _ in range(3))

    def _paint(self):
        walls = (0.95, 0.99) if self.room.kind == "closed" else self.draw.choice(((0.5, 0.85), (0.2, 0.9), (0.05, 0.3)))
        for name, bounds in (("floor", (0.1, 0.6)), ("wall", walls), ("ceiling", (max(0.3, walls[0]), walls[1] + 0.05)),
                             ("dark", (0.02, 0.15)), ("wood", (0.2, 0.5)), ("white", (0.7, 0.92))):
            if self.room.kind == "closed" and name == "floor":
                bounds = walls
            self.room.materials[name] = (self._reflectance(*bounds), (0, 0, 0))

    def _material(self):
        return self.draw.choice(("dark", "wood", "wood", "white"))

    def _shell(self):
        x, y, z = self.size
        # One in four has no ceiling, or a wall less.
        is_open = self.room.kind not in ("closed", "blinds", "two rooms", "slit") and self.draw.random() < 0.25
        self.missing = self.draw.choice(("+z", "-y")) if is_open else ""
        replaced = {"blinds": "+x", "two rooms": "+x", "slit": "+x"}.get(self.room.kind, "")
        self.room.inside("walls", "wall", (0, 0, 0), (x, y, z), without=("-z", "+z", self.missing, replaced))
        self.room.polygon("floor", "floor", (0, 0, 0), (x, 0, 0), (x, y, 0), (0, y, 0))
        if self.missing != "+z":
            self.room.polygon("ceiling", "ceiling", (0, 0, z), (0, y, z), (x, y, z), (x, 0, z))

    def _spot(self, width, depth):
        """The low corner of a place on the floor, away from the walls."""
        return (self.draw.uniform(0.1, max(0.11, self.size[0] - width - 0.1)),
                self.draw.uniform(0.1, max(0.11, self.size[1] - depth - 0.1)))

    def _box(self, above=0.0):
        width, depth, height = (self.draw.uniform(0.2, 1.2) for _ in range(3))
        turned = self.draw.choice((0, 0, self.draw.uniform(0, math.pi)))
        # What it takes on the floor, turned.
        across = abs(math.cos(turned)) * width + abs(math.sin(turned)) * depth
        along = abs(math.sin(turned)) * width + abs(math.cos(turned)) * depth
        x, y = self._spot(across, along)
        x, y = x + 0.5 * (across - width), y + 0.5 * (along - depth)
        height = min(height, 0.8 * self.size[2])
        self.room.box("boxes", self._material(), (x, y, above), (x + width, y + depth, above + height), turned,
                      without=() if above else ("-z",))

    # Kinds.

    def _boxes(self):
        for _ in range(self.draw.randint(2, 12)):
            self._box()

    def _closed(self):
        pass

    def _tables(self):
        for _ in range(self.draw.randint(1, 4)):
            width, depth, height = self.draw.uniform(0.6, 1.8), self.draw.uniform(0.5, 1.0), self.draw.uniform(0.45, 0.8)
            leg, top = self.draw.uniform(0.02, 0.06), self.draw.uniform(0.02, 0.05)
            x, y = self._spot(width, depth)
            wood = self._material()
            self.room.box("tables", wood, (x, y, height - top), (x + width, y + depth, height))
            for a in (x + 0.03, x + width - leg - 0.03):
                for b in (y + 0.03, y + depth - leg - 0.03):
                    self.room.box("tables", wood, (a, b, 0), (a + leg, b + leg, height - top), without=("-z", "+z"))

    def _shelves(self):
        width, depth, height = self.draw.uniform(0.8, 2), self.draw.uniform(0.2, 0.4), self.draw.uniform(1, 0.85 * self.size[2])
        board, x = 0.02, self.draw.uniform(0.1, max(0.11, self.size[0] - width - 0.1))
        wood = self._material()
        for side in (x, x + width - board):
            self.room.box("shelves", wood, (side, 0.01, 0), (side + board, 0.01 + depth, height), without=("-z",))
        count = self.draw.randint(3, 6)
        for k in range(count):
            z = 0.1 + k * (height - 0.15) / (count - 1)
            self.room.box("shelves", wood, (x + board, 0.01, z), (x + width - board, 0.01 + depth, z + board),
                          without=("-x", "+x"))
            if k + 1 < count and self.draw.random() < 0.7:
                thick = self.draw.uniform(0.1, 0.3)
                self.room.box("books", self._material(), (x + 0.05, 0.05, z + board),
                              (x + 0.05 + thick, depth - 0.02, z + board + 0.15), without=("-z",))

    def _window(self):
        """In the wall of large x: (low, high) of y and of z; the wall around it is made."""
        x, y, z = self.size
        a, b = y * self.draw.uniform(0.1, 0.3), y * self.draw.uniform(0.6, 0.9)
        c, d = z * self.draw.uniform(0.25, 0.4), z * self.draw.uniform(0.75, 0.92)
        for low_y, high_y, low_z, high_z in ((0, y, 0, c), (0, y, d, z), (0, a, c, d), (b, y, c, d)):
            self.room.polygon("walls", "wall", (x, low_y, low_z), (x, low_y, high_z), (x, high_y, high_z), (x, high_y, low_z))
        return (a, b), (c, d)

    def _pane(self, x, span_y, span_z, light):
        (a, b), (c, d) = span_y, span_z
        self.room.materials["sky"] = ((0, 0, 0), light)
        self.room.polygon("sky", "sky", (x, a, c), (x, a, d), (x, b, d), (x, b, c))

    def _blinds(self):
        (a, b), (c, d) = self._window()
        x = self.size[0]
        self._pane(x, (a, b), (c, d), (self.draw.uniform(5, 40),) * 3)
        self.room.lamp = "window"
        width, tilt = self.draw.uniform(0.02, 0.05), self.draw.uniform(-1, 1)
        step = width * self.draw.uniform(0.6, 1.1)
        dx, dz = 0.5 * width * math.cos(tilt), 0.5 * width * math.sin(tilt)
        middle = x - 0.5 * width - self.draw.uniform(0.02, 0.1)
        for k in range(int((d - c) / step)):
            z = c + (k + 0.5) * step
            self.room.polygon("blinds", "white", (middle - dx, a, z - dz), (middle + dx, a, z + dz), (middle + dx, b, z + dz),
                              (middle - dx, b, z - dz))

    def _grille(self):
        z = self.draw.uniform(0.5, 0.85) * self.size[2]
        step, bar = self.draw.uniform(0.1, 0.3), self.draw.uniform(0.01, 0.04)
        for k in range(int(self.size[0] / step)):
            x = (k + 0.5) * step
            self.room.box("grille", "white", (x, 0.05, z), (x + bar, self.size[1] - 0.05, z + 2 * bar))

    def _hovering(self):
        for _ in range(self.draw.randint(2, 6)):
            self._box(above=10 ** self.draw.uniform(-3, -0.5))

    def _sheets(self):
        for _ in range(self.draw.randint(2, 6)):
            x, y = self._spot(0.5, 0.5)
            width, height, low = self.draw.uniform(0.3, 1.5), self.draw.uniform(0.3, 1.8), self.draw.choice((0, 0.05, 0.4))
            angle = self.draw.uniform(0, math.pi)
            dx, dy = 0.5 * width * math.cos(angle), 0.5 * width * math.sin(angle)
            x, y = (min(max(at, abs(half) + 0.02), size - abs(half) - 0.02)
                    for at, half, size in ((x, dx, self.size[0]), (y, dy, self.size[1])))
            self.room.polygon("sheets", self._material(), (x - dx, y - dy, low), (x + dx, y + dy, low),
                              (x + dx, y + dy, low + height), (x - dx, y - dy, low + height))

    def _opening(self, width, low_z, high_z):
        """A hole in the wall of large x, and a second room behind it."""
        x, y, z = self.size
        at = self.draw.uniform(0.2, y - width - 0.2)
        for low_y, high_y, bottom, top in ((0, y, 0, low_z), (0, y, high_z, z), (0, at, low_z, high_z),
                                           (at + width, y, low_z, high_z)):
            if top > bottom:
                self.room.polygon("walls", "wall", (x, low_y, bottom), (x, low_y, top), (x, high_y, top), (x, high_y, bottom))
        depth = self.draw.uniform(1.5, 4)
        self.room.inside("second-room", "wall", (x, 0, 0), (x + depth, y, z), without=("-x", "-z"))
        self.room.polygon("second-floor", "floor", (x, 0, 0), (x + depth, 0, 0), (x + depth, y, 0), (x, y, 0))

    def _two_rooms(self):
        self._opening(self.draw.uniform(0.7, 1.2), 0, min(2.05, 0.9 * self.size[2]))

    def _slit(self):
        self._opening(self.draw.uniform(0.02, 0.1), 0.1, 0.9 * self.size[2])

    def _curved(self):
        for _ in range(self.draw.randint(1, 3)):
            radius = self.draw.uniform(0.1, 0.35)
            x, y = self._spot(2 * radius, 2 * radius)
            height, base = self.draw.uniform(0.3, 1.5), self.draw.uniform(0.3, 1)
            around, rows = self.draw.choice((12, 24, 40)), self.draw.choice((4, 10, 20))
            material = self._material()

            def point(row, k, x=x, y=y, radius=radius, height=height, base=base, around=around, rows=rows):
                t = row / rows
                r = radius * (base + (1 - base) * math.sin(math.pi * t)) * (1 if row < rows else 0.6)
                angle = 2 * math.pi * k / around
                return (x + radius + r * math.cos(angle), y + radius + r * math.sin(angle), 0.001 + t * height)

            for row in range(rows):
                for k in range(around):
                    low, right = point(row, k), point(row, k + 1)
                    above, beside = point(row + 1, k), point(row + 1, k + 1)
                    self.room.polygon("vases", material, low, right, beside)
                    self.room.polygon("vases", material, low, beside, above)

    # Lamps.

    def _lamp(self, name, x, y, z, width, depth, light, rho=0.0):
        """A polygon that shines down."""
        self.room.materials[name] = ((rho,) * 3, light)
        self.room.polygon(name, name, (x, y, z), (x, y + depth, z), (x + width, y + depth, z), (x + width, y, z))

    def _light(self):
        x, y, z = self.size
        kind, grey = self.room.lamp, (self.draw.uniform(5, 50),) * 3
        under = z - self.draw.choice((0.005, 0.02, 0.1))
        if kind == "window":
            return
        if kind in ("panel", "hung panel", "flush"):
            hang = {"panel": 0.01, "hung panel": self.draw.uniform(0.1, 0.6), "flush": 1e-3}[kind]
            width, depth = x * self.draw.uniform(0.1, 0.4), y * self.draw.uniform(0.1, 0.4)
            self._lamp("lamp", self.draw.uniform(0.1, x - width - 0.1), self.draw.uniform(0.1, y - depth - 0.1), z - hang,
                       width, depth, grey)
        elif kind == "small":
            side = self.draw.uniform(0.03, 0.15)
            self._lamp("lamp", self.draw.uniform(0.3, x - 0.5), self.draw.uniform(0.3, y - 0.5),
                       self.draw.uniform(0.6, 0.95) * z, side, side, tuple(200 * c for c in grey))
        elif kind in ("many", "coloured"):
            for k in range(self.draw.randint(3, 8)):
                side = self.draw.uniform(0.05, 0.3)
                light = tuple(self.draw.uniform(0, 60) for _ in range(3)) if kind == "coloured" else grey
                self._lamp(f"lamp-{k}", self.draw.uniform(0.1, x - 0.5), self.draw.uniform(0.1, y - 0.5), under, side, side,
                           light)
        elif kind == "near a wall":
            width = self.draw.uniform(0.3, 1.5)
            self._lamp("lamp", self.draw.uniform(0.1, x - width - 0.1), self.draw.uniform(0.02, 0.1),
                       z * self.draw.uniform(0.5, 0.9), width, self.draw.uniform(0.05, 0.2), grey)
        else:  # hooded: what it lights first is the ceiling, or a wall
            self._hooded(grey)

    def _hooded(self, grey):
        x, y, z = self.size
        for k in range(self.draw.randint(1, 3)):
            side = self.draw.uniform(0.08, 0.3)
            at_x, at_y = self.draw.uniform(0.1, x - 0.5), self.draw.choice((0.08, self.draw.uniform(0.1, y - 0.5)))
            low = z - self.draw.uniform(0.3, 0.9)
            name = f"lamp-{k}"
            self.room.materials[name] = ((0, 0, 0), tuple(20 * c for c in grey))
            self.room.polygon(name, name, (at_x, at_y, low), (at_x + side, at_y, low), (at_x + side, at_y + side, low),
                              (at_x, at_y + side, low))
            hood = 0.01
            self.room.box("hoods", "dark", (at_x - hood, at_y - hood, low - 0.02),
                          (at_x + side + hood, at_y + side + hood, low + self.draw.uniform(0.02, 0.1)), without=("+z",))

    def _camera(self):
        x, y, z = self.size
        corner = (self.draw.choice((0.1, x - 0.1)) if self.room.kind != "blinds" else 0.1, self.draw.choice((0.1, y - 0.1)))
        self.room.eye = (*corner, self.draw.uniform(0.5, 0.8) * z)
        self.room.look_at = (x * self.draw.uniform(0.4, 0.6), y * self.draw.uniform(0.4, 0.6), self.draw.uniform(0.2, 0.5) * z)
