"""Simulations of pseudopod in memory: stepped, looked at and driven from Python.

>>> from pseudopod_stepping import Simulation
>>> simulation = Simulation("experiment.toml", overrides={"run.until": "10 s"})
>>> simulation.run(stop=lambda s: s.series("size_x")[0] > 12)
>>> simulation.positions

Everything is in um, s and pN.
"""

from __future__ import annotations

from importlib import metadata

from ._errors import Fault, SimulationError
from ._simulation import Simulation
from ._views import CellType, Field, Series, Step

try:
    __version__ = metadata.version("pseudopod-stepping")
except metadata.PackageNotFoundError:  # a module that was put here by hand
    __version__ = "unknown"

__all__ = ["CellType", "Fault", "Field", "Series", "Simulation", "SimulationError", "Step"]
