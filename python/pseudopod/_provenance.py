"""Where a result comes from, and what its experiment measured."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from datetime import datetime

import pandas as pd

from ._file import ResultFile


@dataclass(frozen=True)
class Provenance:
    """Everything that repeats a run to the last bit.

    Attributes
    ----------
    title
        Title of the experiment.
    version, commit
        The program that ran it.
    seed
        What all random numbers follow from.
    document
        Path of the experiment when it was run.
    experiment
        Text of the document, verbatim.
    settings
        Changes of the command line, ``KEY=VALUE``, in their order.
    equations
        Documents of equations by the names that the experiment gives them, verbatim.
    started
        When the run began (UTC).
    wall_time
        How long it took, s; None as long as it goes on.
    resumed
        How often it was resumed.
    finished
        Whether it reached its end.
    """

    title: str
    version: str
    commit: str
    seed: int
    document: str
    experiment: str = field(repr=False)
    settings: tuple[str, ...]
    equations: Mapping[str, str] = field(repr=False)
    started: datetime | None
    wall_time: float | None
    resumed: int
    finished: bool

    @property
    def command(self) -> str:
        """The command line that repeats the run, for a shell."""
        words = ["pseudopod", "run", self.document]
        for setting in self.settings:
            words += ["--set", setting]
        return shlex.join(words)


def provenance(file: ResultFile) -> Provenance:
    """Reads ``/provenance``."""
    root = "/provenance"

    def text(name: str) -> str:
        return str(file.attribute(root, name, ""))

    def texts(name: str) -> list[str]:
        path = f"{root}/{name}"
        return file.texts(path) if file.has(path) and file.dataset(path).size else []

    started, wall_time = text("started"), file.attribute(root, "wall_time")
    try:
        began = datetime.fromisoformat(started.replace("Z", "+00:00")) if started else None
    except ValueError as error:
        raise file.damaged(f"{root}, attribute started", error) from error
    experiment = texts("experiment")
    return Provenance(
        title=text("title"),
        version=text("version"),
        commit=text("commit"),
        seed=int(file.attribute(root, "seed", 0)),
        document=text("document"),
        experiment=experiment[0] if experiment else "",
        settings=tuple(texts("sets")),
        equations=dict(zip(texts("equation_files"), texts("equations"), strict=False)),
        started=began,
        wall_time=None if wall_time is None else float(wall_time),
        resumed=int(file.attribute(root, "resumed", 0)),
        finished=bool(file.attribute(root, "finished", 0)),
    )


@dataclass(frozen=True)
class Measure:
    """A number that the experiment declares.

    Attributes
    ----------
    value
        NaN where it could not be found.
    unit
        ``1`` for pure numbers.
    description
        What it means.
    """

    value: float
    unit: str
    description: str

    def __float__(self) -> float:
        return self.value

    def __str__(self) -> str:
        return f"{self.value:.6g}" + ("" if self.unit == "1" else f" {self.unit}")


class Measures(Mapping[str, Measure]):
    """The measures of an experiment by name: empty until its run has ended."""

    def __init__(self, found: Mapping[str, Measure]) -> None:
        self._found = dict(found)

    @classmethod
    def of(cls, file: ResultFile) -> Measures:
        """Reads ``/summary``."""
        paths = {name: f"/summary/{name}" for name in sorted(file.names("/summary"))}
        return cls({n: Measure(float(file.read(p)), file.unit(p), file.description(p)) for n, p in paths.items()})

    def __getitem__(self, name: str) -> Measure:
        if name not in self._found:
            raise KeyError(f"no measure {name!r}: there are {', '.join(self._found) or 'none'}")
        return self._found[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._found)

    def __len__(self) -> int:
        return len(self._found)

    def to_frame(self) -> pd.DataFrame:
        """A table with a row for each measure and the columns value, unit and description."""
        rows = [(name, measure.value, measure.unit, measure.description) for name, measure in self.items()]
        return pd.DataFrame(rows, columns=["name", "value", "unit", "description"]).set_index("name")

    def __repr__(self) -> str:
        lines = [f"  {name} = {measure}  ({measure.description})" for name, measure in self.items()]
        return "\n".join(["<measures>", *lines]) if lines else "<no measures>"

    def _repr_html_(self) -> str:
        return str(self.to_frame().to_html())
