"""Tables that the program writes as CSV: titles of columns carry the units."""

from __future__ import annotations

import os
import re
import tempfile

import numpy as np
import numpy.typing as npt
import pandas as pd

from ._errors import ResultError
from ._program import call

#: ``contact.strength (pN/um^2)``: a name and its unit.
_TITLE = re.compile(r"(?P<name>.*\S)\s*\((?P<unit>[^()]*)\)")


def read_csv(path: str | os.PathLike[str]) -> pd.DataFrame:
    """A table without the units in the titles of its columns; ``attrs["units"]`` has them."""
    try:
        table: pd.DataFrame = pd.read_csv(path)
    except ValueError as error:
        raise ResultError(path, f"is no table: {error}", "let the program write it again") from error
    units: dict[str, str] = {}
    for title in map(str, table.columns):
        found = _TITLE.fullmatch(title)
        name = found["name"] if found else title
        # Two columns that differ in their units alone keep their titles.
        units[title if name in units else name] = found["unit"] if found else "1"
    table.columns = pd.Index(list(units))
    table.attrs["units"] = units
    return table


def contact_series(path: str, times: npt.NDArray[np.float64]) -> pd.DataFrame:
    """Series of contacts that are not stored, as the program finds them."""
    with tempfile.TemporaryDirectory() as folder:
        name = os.path.join(folder, "series.csv")
        call(["export", path, "--output", name])
        table = read_csv(name)
    units = table.attrs["units"]
    names = [name for name in table.columns if name.startswith("contact.")]
    of_frames = table.drop_duplicates("frame").set_index("frame")[names].reindex(range(len(times)))
    of_frames.index = pd.Index(times, name="time")
    of_frames.attrs["units"] = {"time": "s", **{name: units[name] for name in names}}
    return of_frames
