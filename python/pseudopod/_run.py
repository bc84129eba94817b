"""Runs experiments, goes on with them, and checks documents."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from ._errors import Fault, RunError
from ._program import call, settings
from ._progress import Progress
from ._result import Result


def run(
    experiment: str | os.PathLike[str],
    overrides: Mapping[str, Any] | None = None,
    *,
    output: str | os.PathLike[str] | None = None,
    seed: int | None = None,
    until: str | None = None,
    threads: int | None = None,
    force: bool = False,
    pictures: bool = False,
    progress: bool = True,
) -> Result:
    """Runs an experiment and opens its result.

    Parameters
    ----------
    experiment
        The document.
    overrides
        Keys of the document that are changed, as in ``{"contact.strength": "0.2 pN/um^2", "cells.walker.number": 50}``.
        Quantities are texts with their units.
    output
        The result file; by default ``results/NAME.vtkhdf`` in the working folder.
    seed
        Another seed.
    until
        Another end of the run, as in ``"10 s"``.
    threads
        Threads; the result does not depend on them.
    force
        Whether a result that is there is replaced.
    pictures
        Whether pictures and charts are made beside the result.
    progress
        Whether the run tells where it is: with a bar if tqdm is installed, otherwise in lines.

    Returns
    -------
    Result
        The complete result.

    Raises
    ------
    RunError
        If the run fails, with the exit code and what the program said.
    KeyboardInterrupt
        If it is interrupted. The run has then stopped after its step, and :func:`resume` goes on with it.
    """
    arguments: list[str | os.PathLike[str]] = ["run", experiment, *settings(overrides)]
    arguments += [] if output is None else ["--output", output]
    arguments += [] if seed is None else ["--seed", str(int(seed))]
    arguments += [] if until is None else ["--until", until]
    arguments += ["--force"] if force else []
    return _started(arguments, threads, pictures, progress, _name_of(experiment))


def resume(
    result: Result | str | os.PathLike[str],
    *,
    threads: int | None = None,
    pictures: bool = False,
    progress: bool = True,
) -> Result:
    """Goes on with a run that was stopped or killed, to its end.

    Parameters
    ----------
    result
        The result, or its file.
    threads, pictures, progress
        As for :func:`run`.

    Returns
    -------
    Result
        The complete result; a result that was given shows it after :meth:`Result.refresh`.

    Raises
    ------
    RunError
        If the run fails, or there is nothing to go on with.
    """
    path = result.path if isinstance(result, Result) else os.fspath(result)
    return _started(["resume", path], threads, pictures, progress, _name_of(path))


def _started(
    arguments: list[str | os.PathLike[str]], threads: int | None, pictures: bool, progress: bool, name: str
) -> Result:
    arguments += [] if threads is None else ["--threads", str(int(threads))]
    arguments += [] if pictures else ["--no-pictures"]
    with Progress(progress, name) as shown:
        report = call(arguments, shown.line)
    # What it noticed of the document, such as cells that pass through each other.
    for line in report["said"]:
        shown.say(line)
    return Result(report["result"])


def _name_of(path: str | os.PathLike[str]) -> str:
    """experiment.toml is known by its folder."""
    folder, name = os.path.split(os.path.abspath(os.fspath(path)))
    stem = os.path.splitext(name)[0]
    return os.path.basename(folder) if stem == "experiment" else stem


def check(document: str | os.PathLike[str], overrides: Mapping[str, Any] | None = None) -> list[Fault]:
    """Checks a document as :func:`run` would, and runs nothing.

    Parameters
    ----------
    document
        The experiment.
    overrides
        Keys that are changed before, as for :func:`run`.

    Returns
    -------
    list of Fault
        All faults, each with its line and what to write instead; empty if there are none.

    Raises
    ------
    RunError
        If the program could not look.
    """
    try:
        call(["check", document, *settings(overrides)])
    except RunError as error:
        if error.exit_code == 2 and error.faults:
            return list(error.faults)
        raise
    return []
