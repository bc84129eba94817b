"""Results for the tests, made by the program from small documents: seconds for all of them."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import pseudopod

DOCUMENTS = Path(__file__).parent / "documents"


@pytest.fixture(scope="session")
def made(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """Runs a document once, and names its result."""
    folder = tmp_path_factory.mktemp("results")

    def make(name: str) -> Path:
        path = folder / f"{name}.vtkhdf"
        if not path.exists():
            pseudopod.run(DOCUMENTS / f"{name}.toml", output=path, progress=False).close()
        return path

    return make


@pytest.fixture(params=["walk", "amoebae", "heap", "membrane"])
def any_result(request: pytest.FixtureRequest, made: Callable[[str], Path]) -> Path:
    return made(request.param)


@pytest.fixture
def amoebae(made: Callable[[str], Path]) -> pseudopod.Result:
    return pseudopod.open(made("amoebae"))


@pytest.fixture
def walk(made: Callable[[str], Path]) -> pseudopod.Result:
    return pseudopod.open(made("walk"))


def told(*words: str | Path) -> Any:
    """What the program answers with ``--json``."""
    answer = subprocess.run([pseudopod.binary(), *words, "--json"], capture_output=True, text=True, check=True)
    return json.loads(answer.stdout)
