"""The program behind the package: where it is, how it is called, and what it answers."""

from __future__ import annotations

import json as json_text
import os
import shutil
import signal
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Callable, Mapping, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any

from ._errors import Fault, PseudopodError, RunError
from ._toml import toml

#: Names the program, where another than that of the package is wanted.
VARIABLE = "PSEUDOPOD_BINARY"

_NAME = "pseudopod.exe" if sys.platform == "win32" else "pseudopod"


def binary() -> str:
    """The program that :func:`pseudopod.run` starts.

    Returns
    -------
    str
        What the environment variable ``PSEUDOPOD_BINARY`` names; otherwise the program that was installed with this
        package; otherwise the one on the ``PATH``.

    Raises
    ------
    PseudopodError
        If there is none.
    """
    named = os.environ.get(VARIABLE)
    if named:
        found = shutil.which(named)
        if found is None:
            raise PseudopodError(
                f"{VARIABLE} names {named}, which is no program\n"
                "help: correct it, or unset it to use the program of the package"
            )
        return found
    for candidate in (*_installed(), Path(sysconfig.get_path("scripts")) / _NAME):
        if candidate.is_file() and os.access(candidate, os.X_OK):
            return str(candidate)
    found = shutil.which(_NAME)
    if found is None:
        raise PseudopodError(
            "the program pseudopod was not found\n"
            f"help: install the package with `pip install .` in a clone, or name a program in {VARIABLE}"
        )
    return found


def _installed() -> list[Path]:
    """The program as the list of files of the package names it."""
    try:
        files = metadata.files("pseudopod") or []
    except metadata.PackageNotFoundError:
        return []
    return [Path(str(file.locate())) for file in files if file.name == _NAME]


def version() -> str:
    """Version of the program, as in ``0.1.0``."""
    answer = subprocess.run([binary(), "--version"], capture_output=True, text=True, check=False)
    if answer.returncode != 0:
        raise RunError(answer.returncode, answer.stderr.strip())
    return answer.stdout.split()[-1]


def settings(overrides: Mapping[str, Any] | None) -> list[str]:
    """The options that change keys of a document."""
    return [word for key, value in (overrides or {}).items() for word in ("--set", f"{key}={toml(value)}")]


def call(
    arguments: Sequence[str | os.PathLike[str]], line: Callable[[str], bool] | None = None, *, json: bool = True
) -> dict[str, Any]:
    """Starts the program, waits for it, and returns what it reports with ``--json``; what it noticed is under ``said``.

    Parameters
    ----------
    arguments
        Command and options, without ``--json``.
    line
        Takes each line that it says while it works, and says whether it was one of progress.
    json
        Whether the command reports in JSON.

    Raises
    ------
    RunError
        If it fails.
    KeyboardInterrupt
        If it is interrupted: it was then told so, and has ended in its own way.
    """
    command = [binary(), *(os.fspath(word) for word in arguments), *(["--json"] if json else [])]
    said: list[str] = []
    with tempfile.TemporaryFile("w+", encoding="utf-8") as output:
        # In a session of its own, or Ctrl-C of a terminal would reach it twice, and twice means at once.
        child = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.PIPE, text=True, encoding="utf-8",
            errors="replace", start_new_session=True,
        )  # fmt: skip
        interrupted = False
        try:
            while True:
                try:
                    _listen(child, said, line)
                    break
                except KeyboardInterrupt:
                    interrupted = True
                    child.send_signal(signal.SIGINT)
        finally:
            if child.poll() is None:
                child.kill()
                child.wait()
            if child.stderr is not None:
                child.stderr.close()
        output.seek(0)
        answer = output.read()
    if interrupted:
        raise KeyboardInterrupt("the run was stopped; pseudopod.resume goes on with what it recorded")
    report = _report(answer)
    if child.returncode != 0:
        faults = [Fault.of(fact) for fact in report.get("faults", [])]
        message = "\n".join(said).strip() or "\n".join(str(fault) for fault in faults)
        raise RunError(child.returncode, message, faults, report.get("kept") or report.get("result"))
    return report | {"said": said}


def _listen(child: subprocess.Popen[str], said: list[str], line: Callable[[str], bool] | None) -> None:
    """Hears what the program says until it ends; progress is passed on and not kept."""
    assert child.stderr is not None
    for text in child.stderr:
        text = text.rstrip("\n")
        if line is None or not line(text):
            said.append(text)
    child.wait()


def _report(answer: str) -> dict[str, Any]:
    try:
        found = json_text.loads(answer)
    except json_text.JSONDecodeError:
        return {}
    return found if isinstance(found, dict) else {}
