"""Parameter studies: many runs of one experiment, and one table of what they measured."""

from __future__ import annotations

import os

import pandas as pd

from ._csv import read_csv
from ._program import call
from ._progress import Progress


def sweep(
    study: str | os.PathLike[str], folder: str | os.PathLike[str], jobs: int = 1, *, progress: bool = True
) -> pd.DataFrame:
    """Plans a study, runs what has not been run, and collects it.

    Parameters
    ----------
    study
        The document of the study.
    folder
        Where its runs lie; a study that was stopped goes on there.
    jobs
        Runs at a time.
    progress
        Whether the lines are shown that the program says.

    Returns
    -------
    pandas.DataFrame
        As :func:`read_summary`.

    Raises
    ------
    RunError
        If the program refuses the study or cannot run it.
    """
    with Progress(progress, "sweep") as shown:

        def line(text: str) -> bool:
            shown.say(text)
            return False

        if not os.path.isdir(folder):
            call(["sweep", "plan", study, "-o", folder], line, json=False)
        call(["sweep", "run", folder, "-j", str(int(jobs))], line, json=False)
        call(["sweep", "collect", folder], line, json=False)
    return read_summary(folder)


def read_summary(folder: str | os.PathLike[str]) -> pd.DataFrame:
    """The table of a study: a row for each run.

    Parameters
    ----------
    folder
        The folder of the study, or its ``summary.csv``.

    Returns
    -------
    pandas.DataFrame
        Columns are what the file has, without the units in their titles; ``attrs["units"]`` has these by column,
        ``1`` for what has none.

    Raises
    ------
    FileNotFoundError
        If nothing was collected there.
    ResultError
        If the file is no such table.
    """
    path = os.fspath(folder)
    path = os.path.join(path, "summary.csv") if os.path.isdir(path) else path
    if not os.path.exists(path):
        raise FileNotFoundError(f"{path} does not exist\nhelp: `pseudopod sweep collect {os.fspath(folder)}` makes it")
    return read_csv(path)
