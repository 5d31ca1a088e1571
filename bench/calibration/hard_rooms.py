"""Rooms by name in which radiosity methods have failed: light behind slats or a screen, and gaps in rooms that absorb little."""

import math

from random_rooms import Room


def _shell(size, wall, floor, without=()):
    """A room of uniform walls with a floor of its own, seen from the corner."""
    x, y, z = size
    room = Room("", "")
    room.materials |= {"wall": ((wall,) * 3, (0, 0, 0)), "floor": ((floor,) * 3, (0, 0, 0))}
    room.inside("walls", "wall", (0, 0, 0), size, without=("-z", *without))
    room.polygon("floor", "floor", (0, 0, 0), (x, 0, 0), (x, y, 0), (0, y, 0))
    room.eye, room.look_at = (0.2, 0.2, 0.65 * z), (0.6 * x, 0.6 * y, 0.35 * z)
    return room


def blinds():
    """A window of 2 m x 1.5 m behind 60 slats of 35 mm, 25 mm apart, tilted by 30 degrees."""
    x, y, z = 4, 5, 2.8
    low, high, sill = 1.5, 3.5, 0.9
    room = _shell((x, y, z), 0.7, 0.3, without=("+x",))
    room.kind, room.lamp = "blinds", "window"
    top = sill + 1.5
    for y0, y1, z0, z1 in ((0, y, 0, sill), (0, y, top, z), (0, low, sill, top), (high, y, sill, top)):
        room.polygon("walls", "wall", (x, y0, z0), (x, y0, z1), (x, y1, z1), (x, y1, z0))
    room.materials |= {"sky": ((0, 0, 0), (20, 20, 20)), "slat": ((0.8,) * 3, (0, 0, 0))}
    room.polygon("sky", "sky", (x, low, sill), (x, low, top), (x, high, top), (x, high, sill))
    dx, dz = 0.5 * 0.035 * math.cos(math.pi / 6), 0.5 * 0.035 * math.sin(math.pi / 6)
    middle = x - 0.06
    for k in range(60):
        at = sill + (k + 0.5) * 0.025
        room.polygon("blinds", "slat", (middle - dx, low, at - dz), (middle + dx, low, at + dz), (middle + dx, high, at + dz),
                     (middle - dx, high, at - dz))
    return room


def hooded():
    """Small lamps under hoods that are open to the ceiling, near a wall; a screen stands before what they light."""
    room = _shell((5, 4, 2.6), 0.8, 0.4)
    room.kind, room.lamp = "sheets", "hooded"
    room.materials |= {"hood": ((0.05,) * 3, (0, 0, 0)), "screen": ((0.5, 0.4, 0.3), (0, 0, 0))}
    for k, light in enumerate(((900, 800, 600), (600, 700, 900))):
        low = (4.85, 0.8 + 2 * k, 2.0)
        x, y, z = low
        name = f"lamp-{k}"
        room.materials[name] = ((0, 0, 0), light)
        room.polygon(name, name, (x, y, z), (x + 0.1, y, z), (x + 0.1, y + 0.1, z), (x, y + 0.1, z))
        room.box("hoods", "hood", (x - 0.01, y - 0.01, z - 0.02), (x + 0.11, y + 0.11, z + 0.08), without=("+z",))
    room.polygon("screen", "screen", (3.2, 0.3, 0), (3.2, 3.7, 0), (3.2, 3.7, 2.2), (3.2, 0.3, 2.2))
    return room


def _lamp_below_ceiling(reflectance):
    room = _shell((4, 5, 3), reflectance, reflectance)
    room.kind, room.lamp = "closed", "hung panel"
    room.materials["lamp"] = ((0, 0, 0), (100, 100, 100))
    room.polygon("lamp", "lamp", (1.5, 2, 2.99), (1.5, 3, 2.99), (2.5, 3, 2.99), (2.5, 2, 2.99))
    return room


HARD_ROOMS = {"blinds": blinds, "hooded": hooded, "gap-0.99": lambda: _lamp_below_ceiling(0.99),
              "gap-0.999": lambda: _lamp_below_ceiling(0.999)}
