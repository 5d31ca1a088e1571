"""Radiation between grey diffuse surfaces by other means than Fluxel's: closed forms and dense elimination.

View factors of rectangles in parallel and in perpendicular planes: J. R. Ehlert and T. F. Smith, View factors
for perpendicular and parallel rectangular plates, J. Thermophys. Heat Transfer 7 (1993).
"""

import itertools
import math

SIGMA = 5.670374419e-8

# Of two opposed faces of a cube: Howell's catalogue, C-11.
OPPOSED = 0.199824895698387
ADJACENT = (1 - OPPOSED) / 4


def _atan_term(a, b_squared):
    """a b atan(a / b), continued to b = 0."""
    b = math.sqrt(b_squared)
    return a * b * math.atan(a / b) if b > 0 else 0.0


def _log_term(factor, square):
    return factor * math.log(square) if square > 0 else 0.0


def _parallel(x, y, distance):
    z2 = distance * distance
    logarithm = _log_term(z2 / 2, x * x + y * y + z2)
    return (_atan_term(y, x * x + z2) + _atan_term(x, y * y + z2) - logarithm) / (2 * math.pi)


def _perpendicular(a, b, along):
    """At distances a and b from the planes' common line, `along` apart."""
    r2 = a * a + b * b
    return (_atan_term(along, r2) - _log_term((r2 - along * along) / 4, r2 + along * along)) / (2 * math.pi)


def exchange_area(first, second):
    """A_1 F_12 of two rectangles, (low, high) corners along the axes, that see each other whole."""
    flat = [next(k for k in range(3) if low[k] == high[k]) for low, high in (first, second)]
    ends = [[(box[0][k], box[1][k]) for k in range(3)] for box in (first, second)]
    total = 0.0
    if flat[0] == flat[1]:
        u, v = (k for k in range(3) if k != flat[0])
        distance = abs(first[0][flat[0]] - second[0][flat[0]])
        if distance == 0:
            return 0.0
        for i, j, k, l in itertools.product(range(2), repeat=4):
            x, y = ends[0][u][i] - ends[1][u][k], ends[0][v][j] - ends[1][v][l]
            total += (-1) ** (i + j + k + l) * _parallel(x, y, distance)
        return total
    (along,) = (k for k in range(3) if k not in flat)
    for i, j, k, l in itertools.product(range(2), repeat=4):
        a = ends[0][flat[1]][i] - second[0][flat[1]]  # from the second's plane
        b = ends[1][flat[0]][k] - first[0][flat[0]]
        total += (-1) ** (i + j + k + l) * _perpendicular(a, b, ends[0][along][j] - ends[1][along][l])
    return abs(total)


def box_factors(rectangles):
    """F of rectangles on the faces of a box, seen from inside."""
    areas = [area_of(rectangle) for rectangle in rectangles]
    F = [[0.0] * len(areas) for _ in areas]
    for i, first in enumerate(rectangles):
        for j in range(i):
            G = exchange_area(first, rectangles[j])
            F[i][j], F[j][i] = G / areas[i], G / areas[j]
    return F


def area_of(rectangle):
    return math.prod(high - low for low, high in zip(*rectangle) if high > low)


def eliminate(matrix, right):
    """x of matrix x = right, by Gauss with partial pivoting; overwrites both."""
    n = len(right)
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(matrix[i][k]))
        matrix[k], matrix[pivot], right[k], right[pivot] = matrix[pivot], matrix[k], right[pivot], right[k]
        row = matrix[k]
        for i in range(k + 1, n):
            factor = matrix[i][k] / row[k]
            if factor == 0:
                continue
            below = matrix[i]
            for j in range(k + 1, n):
                below[j] -= factor * row[j]
            right[i] -= factor * right[k]
    for k in reversed(range(n)):
        right[k] = (right[k] - sum(a * x for a, x in zip(matrix[k][k + 1:], right[k + 1:]))) / matrix[k][k]
    return right


def bisect(f, low, high):
    """Where f, which changes its sign once between low and high, is 0."""
    rises = f(high) > 0
    for _ in range(100):
        middle = (low + high) / 2
        if (f(middle) > 0) == rises:
            high = middle
        else:
            low = middle
    return low


class Surface:
    """Of emissivity `eps`, with a temperature [K] or a net flux q [W/m2], to which h (air - T) [W/(m2 K), K] is added."""

    def __init__(self, eps, T=None, q=None, h=0.0, air=0.0):
        self.eps, self.T, self.q, self.h, self.air = eps, T, q, h, air


def net_fluxes(surfaces, F):
    """(q, T) of every surface, by the unknowns q and sigma T^4 themselves, not by radiosities (Siegel & Howell):
    sum_j (delta_ij - F_ij (1 - eps_j)) / eps_j q_j = sum_j (delta_ij - F_ij) sigma T_j^4."""
    n = len(surfaces)
    known = lambda s: s.T is not None
    matrix, right = [[0.0] * n for _ in range(n)], [0.0] * n
    for i in range(n):
        for j, surface in enumerate(surfaces):
            of_q = (i == j) / surface.eps - F[i][j] * (1 - surface.eps) / surface.eps
            of_black = (i == j) - F[i][j]
            if known(surface):
                matrix[i][j] = of_q
                right[i] += of_black * SIGMA * surface.T**4
            else:
                matrix[i][j] = -of_black
                right[i] -= of_q * surface.q
    found = eliminate(matrix, right)
    return [(x, s.T) if known(s) else (s.q, (x / SIGMA) ** 0.25) for x, s in zip(found, surfaces)]


def net_fluxes_with_convection(surfaces, F):
    """As net_fluxes. The temperatures of surfaces with h are guessed and taken as known; each then balances the
    irradiance that follows, until none changes."""
    T = [surface.air for surface in surfaces]
    while True:
        found = net_fluxes([Surface(s.eps, T=guess) if s.h else s for s, guess in zip(surfaces, T)], F)
        before, T = T, T.copy()
        for i, s in enumerate(surfaces):
            if s.h:
                H = SIGMA * before[i]**4 - found[i][0] / s.eps
                T[i] = bisect(lambda x: s.eps * (SIGMA * x**4 - H) - s.q - s.h * (s.air - x), 0, 5000)
        if max(abs(a - b) for a, b in zip(T, before)) < 1e-9:
            return found


def wall_grid(low, high, count):
    """The faces of a box, each as count x count rectangles: [(face, rectangle)], 'x0' being the face x = low."""
    cells = []
    for axis in range(3):
        u, v = (k for k in range(3) if k != axis)
        cut = [[low[k] + (high[k] - low[k]) * i / count for i in range(count + 1)] for k in range(3)]
        for end in range(2):
            for i in range(count):
                for j in range(count):
                    a, b = [0.0] * 3, [0.0] * 3
                    a[axis] = b[axis] = (low, high)[end][axis]
                    a[u], b[u], a[v], b[v] = cut[u][i], cut[u][i + 1], cut[v][j], cut[v][j + 1]
                    cells.append(("xyz"[axis] + str(end), (tuple(a), tuple(b))))
    return cells


def inward(name, rectangle):
    """The rectangle's corners, counter-clockwise seen from inside the box."""
    low, high = rectangle
    axis = "xyz".index(name[0])
    u, v = (axis + 1) % 3, (axis + 2) % 3
    corners = []
    for s, t in ((low, low), (high, low), (high, high), (low, high)):
        corner = list(low)
        corner[u], corner[v] = s[u], t[v]
        corners.append(tuple(corner))
    return corners if name[1] == "0" else corners[::-1]
