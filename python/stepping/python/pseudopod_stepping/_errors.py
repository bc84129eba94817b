"""What can go wrong, in words that say where and what to do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """One fault of a document.

    Attributes
    ----------
    message
        What is wrong.
    help
        What to write instead, or to do.
    file
        The document in which it is, if it is in one.
    line, column
        Where in the document, counted from 1.
    """

    message: str
    help: str | None = None
    file: str | None = None
    line: int | None = None
    column: int | None = None

    def __str__(self) -> str:
        where = f"{self.file}:{self.line}:{self.column}: " if self.file is not None else ""
        return f"{where}{self.message}" + (f"\nhelp: {self.help}" if self.help else "")


class SimulationError(Exception):
    """A simulation that could not be made, or could not do what was asked. It is then as it was before.

    Attributes
    ----------
    kind
        ``"input"``: the document is at fault; ``"trouble"``: the numbers failed in a step; ``"no_such_cell"``,
        ``"unknown"``, ``"value"``, ``"not_settable"``, ``"length"``, ``"population"``, ``"fibre"``, ``"checkpoint"``:
        something was asked for that cannot be; ``"machine"``, ``"cancelled"``, ``"other"``.
    message
        What is wrong, in the words of the library.
    help
        What to do; none where the message says it all.
    faults
        Of a document: all that is wrong with it, and where.
    """

    def __init__(self, kind: str, message: str, help: str | None = None, faults: Sequence[Fault] = ()) -> None:
        self.kind = kind
        self.message = message
        self.help = help
        self.faults = tuple(faults)
        whole = "\n".join(str(fault) for fault in self.faults)
        super().__init__(whole or message + (f"\nhelp: {help}" if help else ""))

    def __reduce__(self) -> tuple[type[SimulationError], tuple[str, str, str | None, tuple[Fault, ...]]]:
        return type(self), (self.kind, self.message, self.help, self.faults)


def made(
    kind: str,
    message: str,
    help: str | None,
    faults: Sequence[tuple[str, str | None, str | None, int | None, int | None]],
) -> SimulationError:
    """The exception for an error of the library, which calls this."""
    return SimulationError(kind, message, help, [Fault(*fault) for fault in faults])
