"""The exact shape of a drop that is drawn into a pipette with a round rim: writes data/exact.csv."""

import math

TENSION, RADIUS = 35.0, 4.25  # pN/um, um
MOUTH, RIM = 2.0, 0.5  # inner radius of the pipette and radius of its rim, um
VOLUME = 4 / 3 * math.pi * RADIUS**3


def touching(radius):
    """Height of the middle of a sphere on the axis that touches the rim, and the point where it does."""
    height = RIM - math.sqrt((radius + RIM) ** 2 - (MOUTH + RIM) ** 2)
    across, along = -(MOUTH + RIM) / (radius + RIM), (height - RIM) / (radius + RIM)
    return height, (MOUTH + RIM + RIM * across, RIM + RIM * along)


def part(radius, middle, low, high):
    """Volume of a sphere between two heights."""
    up_to = lambda z: math.pi * (radius**2 * (z - middle) - (z - middle) ** 3 / 3)
    return up_to(high) - up_to(low)


def volume(tongue, outer):
    (above, inner_touch), (below, outer_touch) = touching(tongue), touching(outer)
    total = part(outer, below, below - outer, outer_touch[1]) + part(tongue, above, inner_touch[1], above + tongue)
    begin, end = (math.atan2(z - RIM, r - MOUTH - RIM) % (2 * math.pi) for r, z in (outer_touch, inner_touch))
    steps = 2000
    for step in range(steps):
        angle = begin + (end - begin) * (step + 0.5) / steps
        width = MOUTH + RIM + RIM * math.cos(angle)
        total += math.pi * width**2 * RIM * math.cos(angle) * (end - begin) / steps
    return total


def outer_radius(tongue):
    low, high = 3.5, 4.3
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if volume(tongue, middle) < VOLUME else (low, middle)
    return (low + high) / 2


with open("data/exact.csv", "w") as file:
    file.write("pressure_Pa,reach_um,outer_radius_um\n")
    for row in range(41):
        tongue = MOUTH + (RADIUS - MOUTH) * ((40 - row) / 40) ** 2
        outer = outer_radius(tongue)
        pressure = -2 * TENSION * (1 / tongue - 1 / outer)
        # The run ends at 18 Pa.
        if pressure > -18:
            reach = touching(tongue)[0] + tongue
            file.write(f"{min(pressure, 0) or 0:.4f},{reach:.4f},{outer:.4f}\n")

# Where the tongue is half a ball as wide as the mouth: more suction draws the cell in.
outer = outer_radius(MOUTH)
pressure = -2 * TENSION * (1 / MOUTH - 1 / outer)
with open("data/critical.csv", "w") as file:
    file.write(f"reach_um,pressure_Pa\n{touching(MOUTH)[0] + MOUTH:.4f},{pressure:.4f}\n")
