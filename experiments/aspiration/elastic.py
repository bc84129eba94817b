"""How far suction draws the face of an elastic half space into a pipette with a round rim: writes data/elastic.csv.

Rings of pressure move the face along the axis as Boussinesq's solution has it. The wall holds it where it would pass the lip, and only pushes.
With a sharp rim this is the problem of Theret et al. 1988, whose factor is printed for comparison: 2.1 to 2.0 for walls of 0.2 to 1 inner radii.
"""

import math

YOUNG, POISSON = 500.0, 0.49  # pN/um^2
MOUTH, OUTER, RIM = 2.0, 4.0, 0.5  # inner and outer radius of the pipette and radius of its rims, um
SUCKED = 2.3  # suction acts within this radius, um; what of it is on the wall changes nothing but the force there
RINGS = 48


def elliptic(m):
    """The complete elliptic integral of the first kind, by the arithmetic-geometric mean."""
    a, b = 1.0, math.sqrt(1 - m)
    for _ in range(40):
        a, b = (a + b) / 2, math.sqrt(a * b)
    return math.pi / 2 / a


def ring(r, s):
    """The mean of one over the distance between a point at r and those of a ring of the radius s."""
    return 2 / math.pi * elliptic(min(4 * r * s / (r + s) ** 2, 1 - 1e-12)) / (r + s)


def annulus(r, inner, outer, parts=20):
    """The integral of one over the distance to a point at r, over a ring from inner to outer; parts are short near the point."""
    if inner < r < outer:
        return annulus(r, inner, r, parts) + annulus(r, r, outer, parts)
    near, far = (inner, outer) if r <= inner else (outer, inner)
    total = 0.0
    for part in range(parts):
        low, high = (part / parts) ** 3, ((part + 1) / parts) ** 3
        s = near + (far - near) * (low + high) / 2
        total += ring(r, s) * 2 * math.pi * s * abs(far - near) * (high - low)
    return total


def solve(matrix, right):
    rows = [row + [value] for row, value in zip(matrix, right)]
    for c in range(len(rows)):
        best = max(range(c, len(rows)), key=lambda i: abs(rows[i][c]))
        rows[c], rows[best] = rows[best], rows[c]
        for below in rows[c + 1 :]:
            part = below[c] / rows[c][c]
            for k in range(c, len(below)):
                below[k] -= part * rows[c][k]
    found = [0.0] * len(rows)
    for i in reversed(range(len(rows))):
        rest = sum(rows[i][k] * found[k] for k in range(i + 1, len(rows)))
        found[i] = (rows[i][-1] - rest) / rows[i][i]
    return found


class Wall:
    """The end of a wall from one radius to another."""

    def __init__(self, inner, outer, rim, sucked):
        ends = [inner + (outer - inner) * (1 - math.cos(math.pi * i / RINGS)) / 2 for i in range(RINGS + 1)]
        self.rings = list(zip(ends, ends[1:]))
        middles = [(low + high) / 2 for low, high in self.rings]
        self.by_wall = [[annulus(r, *ring) for ring in self.rings] for r in middles]
        self.by_suction = [annulus(r, 0, sucked, 200) for r in middles]
        beside = [max(inner + rim - r, r - outer + rim, 0) for r in middles]
        self.gaps = [rim - math.sqrt(rim**2 - off**2) for off in beside]
        self.middle_by_wall = [annulus(1e-9, *ring) for ring in self.rings]
        self.middle_by_suction = annulus(1e-9, 0, sucked, 200)

    def length(self, load):
        """How far the middle goes, with load = suction (1 - nu^2) / (pi E)."""
        touching = [i for i in range(RINGS) if load * self.by_suction[i] > self.gaps[i]]
        while True:
            matrix = [[self.by_wall[i][j] for j in touching] for i in touching]
            found = solve(matrix, [load * self.by_suction[i] - self.gaps[i] for i in touching])
            push = dict(zip(touching, found))
            moved = lambda i: load * self.by_suction[i] - sum(self.by_wall[i][j] * p for j, p in push.items())
            pull = {i for i, p in push.items() if p < 0}
            passed = {i for i in range(RINGS) if i not in push and moved(i) > self.gaps[i] + 1e-12}
            if not pull and not passed:
                by_wall = sum(self.middle_by_wall[j] * p for j, p in push.items())
                return load * self.middle_by_suction - by_wall
            touching = sorted(set(touching) - pull | passed)


for wall in (0.2, 0.5, 1.0):
    # Theret: E = 3 Phi suction / (2 pi) / (length / inner radius), with nu = 1/2.
    length = Wall(MOUTH, MOUTH * (1 + wall), 1e-9, MOUTH).length(0.75 / math.pi)
    print(f"sharp wall of {wall} inner radii: Phi = {length / MOUTH * 2 * math.pi / 3:.3f}")

wall = Wall(MOUTH, OUTER, RIM, SUCKED)
with open("data/elastic.csv", "w") as file:
    file.write("pressure_Pa,reach_um\n")
    for suction in range(5, 105, 5):
        length = wall.length(suction * (1 - POISSON**2) / (math.pi * YOUNG))
        file.write(f"{-suction},{length:.5f}\n")
