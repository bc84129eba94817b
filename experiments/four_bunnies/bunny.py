#!/usr/bin/env python3
"""Makes bunny.obj: a closed, non-convex surface with a body, a head, a tail and two long ears.

    python3 bunny.py > bunny.obj

The body is a sphere of 42 atoms drawn out to a smooth union of round cones, the hulls of two balls, all of which begin in
its middle. The five neighbours of two of its atoms are then joined to these by nine rings of five atoms along a bent line:
the ears. Lengths are in micrometres, facets turn outward. No library is needed.
"""

import itertools
import math

# End of each cone, its radius there and at the origin.
CONES = [
    ((-1.0, 0.0, -0.5), 4.6, 4.8),  # body
    ((3.4, 0.0, 2.6), 3.3, 3.4),  # head
    ((-5.4, 0.0, -2.4), 1.6, 2.4),  # tail
]
BLEND = 0.5  # how far the union is rounded
TIPS = ((0.6, -4.6, 17.5), (0.6, 4.6, 17.5))  # of the ears
EAR = (2.1, 1.35)  # radius of an ear where it begins and near its tip
RINGS = 9


def add(a, b, s=1.0):
    return tuple(x + s * y for x, y in zip(a, b))


def times(a, s):
    return tuple(s * x for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def unit(a):
    return times(a, 1 / length(a))


def height(p):
    """About the distance to the surface of the body, negative inside."""
    near = []
    for end, there, here in CONES:
        t = min(1.0, max(0.0, dot(p, end) / dot(end, end)))
        near.append(length(add(p, end, -t)) - (here + t * (there - here)))
    least = min(near)
    return least - BLEND * math.log(sum(math.exp((least - d) / BLEND) for d in near))


def along(ray):
    """Where a ray from the origin leaves the body."""
    low, high = 0.0, 30.0
    for _ in range(50):
        mid = 0.5 * (low + high)
        low, high = (mid, high) if height(times(ray, mid)) < 0 else (low, mid)
    return times(ray, low)


def sphere():
    """An icosahedron divided once: its atoms 0 and 1 are corners, two edges apart, on both sides of the plane y = 0."""
    g = (1 + math.sqrt(5)) / 2
    points = [(0, -1, g), (0, 1, g), (-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0),
              (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    points = [unit(p) for p in points]
    close = lambda i, j: length(add(points[i], points[j], -1)) < 1.1
    facets = [f for f in itertools.combinations(range(12), 3) if all(close(*e) for e in itertools.combinations(f, 2))]
    facets = [(i, j, k) if dot(points[i], cross(points[j], points[k])) > 0 else (i, k, j) for i, j, k in facets]
    middle, finer = {}, []
    for a, b, c in facets:
        for e in ((a, b), (b, c), (c, a)):
            if (min(e), max(e)) not in middle:
                middle[min(e), max(e)] = len(points)
                points.append(unit(add(points[e[0]], points[e[1]])))
        ab, bc, ca = (middle[min(e), max(e)] for e in ((a, b), (b, c), (c, a)))
        finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return points, finer


def draw_out(points, facets, tip, end):
    """Puts rings between an atom and its neighbours, along a line that leaves the body straight and bends to an end."""
    after = {f[(f.index(tip) + 1) % 3]: f[(f.index(tip) + 2) % 3] for f in facets if tip in f}
    ring = [min(after)]
    while len(ring) < len(after):
        ring.append(after[ring[-1]])
    facets = [f for f in facets if tip not in f]
    start = times((0, 0, 0), 0)
    for i in ring:
        start = add(start, points[i], 1 / len(ring))
    bend = add(start, unit(points[tip]), 0.45 * length(add(end, start, -1)))
    offsets = [add(points[i], start, -1) for i in ring]
    for number in range(1, RINGS + 1):
        s = number / (RINGS + 0.8)
        centre = add(add(times(start, (1 - s) ** 2), bend, 2 * s * (1 - s)), end, s * s)
        tangent = unit(add(times(add(bend, start, -1), 1 - s), add(end, bend, -1), s))
        radius = EAR[0] + (EAR[1] - EAR[0]) * s
        # Each atom of a ring is between two of the ring before.
        offsets = [add(offsets[k - 1], offsets[k]) for k in range(len(ring))]
        offsets = [unit(add(o, tangent, -dot(o, tangent))) for o in offsets]
        new = list(range(len(points), len(points) + len(ring)))
        points += [add(centre, o, radius) for o in offsets]
        for k in range(len(ring)):
            facets += [(ring[k - 1], ring[k], new[k]), (ring[k - 1], new[k], new[k - 1])]
        ring = new
    points[tip] = end
    return facets + [(tip, ring[k - 1], ring[k]) for k in range(len(ring))]


def main():
    points, facets = sphere()
    points = [along(p) for p in points]
    for tip, end in enumerate(TIPS):
        facets = draw_out(points, facets, tip, end)
    print(f"# Made by bunny.py: {len(points)} atoms, {len(facets)} facets, in micrometres")
    for p in points:
        print("v {:.4f} {:.4f} {:.4f}".format(*p))
    for f in facets:
        print("f {} {} {}".format(*(i + 1 for i in f)))


main()
