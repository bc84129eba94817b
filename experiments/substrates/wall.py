#!/usr/bin/env python3
"""Writes wall.obj: a closed block whose edge along y at x = 0, z = height is round. Turned about x it is a wall with a round end."""
import math, sys
from collections import Counter


def block(height, radius, length, half_width, edge, rises=1):
    profile = [(0.0, 0.0)] + [(0.0, (height - radius) * k / rises) for k in range(1, rises + 1) if height > radius]
    arc = max(2, math.ceil(radius * math.pi / 2 / edge))
    profile += [(radius - radius * math.cos(math.pi / 2 * k / arc), height - radius + radius * math.sin(math.pi / 2 * k / arc)) for k in range(1, arc + 1)]
    along = round((length - radius) / edge)
    profile += [(radius + (length - radius) * k / along, height) for k in range(1, along + 1)]
    profile.append((length, 0.0))
    across = round(2 * half_width / edge)
    ys = [-half_width + 2 * half_width * j / across for j in range(across + 1)]
    atoms, facets, top, bottom = [], [], {}, {}
    last = len(profile) - 1
    for i, (x, z) in enumerate(profile):
        for j, y in enumerate(ys):
            top[i, j] = len(atoms)
            atoms.append((x, y, z))
    for k in range(along + 1):
        for j, y in enumerate(ys):
            if k in (0, along):
                bottom[k, j] = top[0 if k == 0 else last, j]
            else:
                bottom[k, j] = len(atoms)
                atoms.append((length * k / along, y, 0.0))
    for i in range(last):
        for j in range(across):
            a, b, c, d = top[i, j], top[i + 1, j], top[i + 1, j + 1], top[i, j + 1]
            facets += [(a, b, c), (a, c, d)] if (i + j) % 2 == 0 else [(a, b, d), (b, c, d)]
    for k in range(along):
        for j in range(across):
            a, b, c, d = bottom[k, j], bottom[k, j + 1], bottom[k + 1, j + 1], bottom[k + 1, j]
            facets += [(a, b, c), (a, c, d)]
    for j, turn in ((0, False), (across, True)):
        i = k = 0
        while i < last or k < along:
            nearer = k == along or (i < last and atoms[top[i + 1, j]][0] <= atoms[bottom[k + 1, j]][0])
            f = (top[i, j], bottom[k, j], top[i + 1, j] if nearer else bottom[k + 1, j])
            i, k = (i + 1, k) if nearer else (i, k + 1)
            if len(set(f)) == 3:
                facets.append(f[::-1] if turn else f)
    volume = sum(sum(p * q for p, q in zip(atoms[a], (atoms[b][1] * atoms[c][2] - atoms[b][2] * atoms[c][1], atoms[b][2] * atoms[c][0] - atoms[b][0] * atoms[c][2], atoms[b][0] * atoms[c][1] - atoms[b][1] * atoms[c][0]))) for a, b, c in facets) / 6
    if volume < 0:
        facets = [f[::-1] for f in facets]
    sides = Counter((f[s], f[(s + 1) % 3]) for f in facets for s in range(3))
    assert all(n == 1 and (b, a) in sides for (a, b), n in sides.items()), "not closed"
    return atoms, facets


def write(path, atoms, facets):
    with open(path, "w") as out:
        out.write("# made by wall.py\n")
        out.writelines("v %.6g %.6g %.6g\n" % a for a in atoms)
        out.writelines("f %d %d %d\n" % tuple(k + 1 for k in f) for f in facets)
    print(path, len(atoms), "atoms")


if __name__ == "__main__":
    write("wall.obj", *block(4, 3, 28, 5, 2.6))
