"""Pseudopod from Python: run experiments on deformable cells, and read what comes out.

>>> import pseudopod
>>> result = pseudopod.run("experiments/random_walk/experiment.toml", {"cells.walker.number": 50}, until="2 min")
>>> result.tracks[["cell", "time", "x", "y"]]
>>> result.mesh().plot(scalars="cell")

Everything is in um, s and pN; tables carry their units in ``attrs["units"]``.
"""

from __future__ import annotations

import os
from importlib import metadata
from typing import TYPE_CHECKING, Any

from ._errors import Fault, PseudopodError, ResultError, RunError
from ._fields import Fields
from ._program import binary, version
from ._provenance import Measure, Measures, Provenance
from ._result import Result
from ._run import check, resume, run
from ._sweep import read_summary, sweep

if TYPE_CHECKING:
    from pseudopod_stepping import Simulation as Simulation

try:
    __version__ = metadata.version("pseudopod")
except metadata.PackageNotFoundError:  # a clone that was not installed
    __version__ = "unknown"


def open(path: str | os.PathLike[str]) -> Result:
    """Opens a result, also one whose run goes on.

    Parameters
    ----------
    path
        The file that ``pseudopod run`` made.

    Returns
    -------
    Result
        Opened; its arrays are read where somebody looks.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ResultError
        If it is no result, or is damaged.
    """
    return Result(path)


def __getattr__(name: str) -> Any:
    """``pseudopod.Simulation`` is that of another package, which not everybody has."""
    if name != "Simulation":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    try:
        from pseudopod_stepping import Simulation
    except ModuleNotFoundError as error:
        if error.name != "pseudopod_stepping":
            raise
        raise ImportError(
            "stepping a simulation from Python needs the package pseudopod-stepping: "
            "pip install ./python/stepping, in a clone of the repository"
        ) from None
    return Simulation


__all__ = [
    "Fault",
    "Fields",
    "Measure",
    "Measures",
    "Provenance",
    "PseudopodError",
    "Result",
    "ResultError",
    "RunError",
    "binary",
    "check",
    "open",
    "read_summary",
    "resume",
    "run",
    "sweep",
    "version",
]
