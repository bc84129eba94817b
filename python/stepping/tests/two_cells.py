"""A small experiment in which everything is there that Python steps, looks at and drives."""

from __future__ import annotations

from pseudopod_stepping import Simulation

#: Two cells that touch nothing, one pulled by a load, in a scene with a field.
DOCUMENT = """
title = "Two cells"
seed = 3
[run]
until = "4 s"
integrator = { max_step = "0.5 s" }
[output]
every = "2 s"
[cells.pulled]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { at = [["-10 um", "0 um", "0 um"]] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "10 pN/um" } }
loads = [{ name = "pull", cap = { direction = [1, 0, 0], number = 3 }, direction = [1, 0, 0], force = "5 pN" }]
[cells.free]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { at = [["10 um", "0 um", "0 um"]] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "10 pN/um" } }
fibres = [{ name = "belt", pattern = "horizontal", stiffness = "1 pN/um" }]
[chemistry.medium]
document = "medium.eml"
"""

#: Two species that decay; more of the first in front.
MEDIUM = """<eml name="medium"><grid dimension="2" spacing="5" origin="-30 -20" size="60 40"/>
    <field id="food" decay="0.1" initial="4 + 0.1*x + 0.01*y"/><field id="waste" initial="0"/></eml>"""


def make(**options: object) -> Simulation:
    """A simulation of it."""
    return Simulation.from_text(DOCUMENT, name="two.toml", equations={"medium.eml": MEDIUM}, **options)
