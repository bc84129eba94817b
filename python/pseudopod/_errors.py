"""What can go wrong, in words that say where and what to do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from typing import Any


class PseudopodError(Exception):
    """What all errors of this package have in common."""


class ResultError(PseudopodError):
    """A file that is no result, is damaged, or does not hold what was asked for.

    Parameters
    ----------
    path
        The result file.
    message
        What was found, and what was expected.
    help
        What to do.
    """

    def __init__(self, path: str | PathLike[str], message: str, help: str = "") -> None:
        self.path = fspath(path)
        self.message = message
        self.help = help
        super().__init__(f"{self.path}: {message}" + (f"\nhelp: {help}" if help else ""))

    def __reduce__(self) -> tuple[type[ResultError], tuple[str, str, str]]:
        return type(self), (self.path, self.message, self.help)


@dataclass(frozen=True)
class Fault:
    """One fault that the program found.

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

    @classmethod
    def of(cls, fact: dict[str, Any]) -> Fault:
        """The fault that an entry of the program's JSON tells."""
        return cls(*(fact.get(name) for name in ("message", "help", "file", "line", "column")))  # type: ignore[arg-type]

    def __str__(self) -> str:
        where = f"{self.file}:{self.line}:{self.column}: " if self.file is not None else ""
        return f"{where}{self.message}" + (f"\nhelp: {self.help}" if self.help else "")


class RunError(PseudopodError):
    """The program ended with a failure.

    Attributes
    ----------
    exit_code
        2: bad input; 3: the numbers failed, and the last good state is kept; 1: the machine failed; 130: interrupted;
        negative: ended by the signal of this number.
    message
        What the program said.
    faults
        The same, fault by fault; empty where the program told none.
    kept
        What is kept of the run: a result that :func:`pseudopod.open` reads.
    """

    def __init__(self, exit_code: int, message: str, faults: Sequence[Fault] = (), kept: str | None = None) -> None:
        self.exit_code = exit_code
        self.message = message
        self.faults = tuple(faults)
        self.kept = kept
        super().__init__(f"pseudopod ended with exit code {exit_code}\n{message}".rstrip())

    def __reduce__(self) -> tuple[type[RunError], tuple[int, str, tuple[Fault, ...], str | None]]:
        return type(self), (self.exit_code, self.message, self.faults, self.kept)


def missing(package: str, extra: str, what: str) -> ImportError:
    """The error for a package that is not installed and that only some need."""
    return ImportError(f'{what} need the package {package}: pip install "pseudopod[{extra}]", or {package} alone')
