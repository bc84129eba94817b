"""What the page of the book shows works as it stands there."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import matplotlib
import pytest

import pseudopod

PAGE = (Path(__file__).parents[2] / "docs" / "src" / "howto_python.md").read_text(encoding="utf-8")


def blocks(language: str, text: str = PAGE) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    matplotlib.use("agg")
    (tmp_path / "walk.toml").write_text(blocks("toml")[0], encoding="utf-8")
    return tmp_path


def test_the_first_steps(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    names: dict[str, object] = {}
    for block in blocks("python", PAGE.split("## Step it yourself")[0]):
        exec(block, names)
    told = capsys.readouterr().out
    assert re.search(r"619 +19 +600\.0", told)
    assert "\num/s\n" in told
    assert "True" in told
    assert float(re.search(r"^([\d.]+) um/min$", told, re.MULTILINE)[1]) == pytest.approx(2.8, abs=0.05)
    assert names["axes"].get_ylabel() == "mean speed (um/min)"


def test_stepping(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pseudopod_stepping")
    for block in blocks("python", PAGE.split("## Step it yourself")[1].split("## Studies")[0]):
        exec(block, {})
    told = capsys.readouterr().out
    assert re.search(r"^far at \d+ s$", told, re.MULTILINE), told
    assert "(240, 3)" in told
    held = float(re.search(r"^([\d.]+) um apart$", told, re.MULTILINE)[1])
    assert held == pytest.approx(14.0, abs=0.5)


def test_without_the_module_stepping_says_which_command_installs_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pseudopod_stepping", None)
    with pytest.raises(ImportError, match=r"pip install \./python/stepping"):
        from pseudopod import Simulation  # noqa: F401
    with pytest.raises(AttributeError, match="no attribute 'Simulations'"):
        pseudopod.Simulations  # noqa: B018


def test_the_search_by_optuna(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    optuna = pytest.importorskip("optuna")
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    names: dict[str, object] = {}
    for block in blocks("python", PAGE.split("## Studies")[1].split("### Dask")[0]):
        exec(block, names)
    best, value = names["study"].best_params, names["study"].best_value
    # Measured speeds along recorded paths are a little below those that cells have.
    assert value < 0.02, (best, value)
    assert 3.0 < best["speed"] < 4.5
    assert set(best) == {"speed", "persistence"}


def test_every_attribute_that_the_page_lists_is_there() -> None:
    listed = set(re.findall(r"result\.(\w+)", PAGE))
    assert len(listed) > 15
    assert not [name for name in listed if not hasattr(pseudopod.Result, name)]
    called = {name for name in re.findall(r"pseudopod\.(\w+)", PAGE)}
    # That one is of another package, which is tested beside it.
    assert not [name for name in called - {"Simulation"} if not hasattr(pseudopod, name)]


def test_every_public_name_is_on_the_page() -> None:
    public = [name for name in vars(pseudopod.Result) if not name.startswith("_")]
    beside = {"close", "path", "title", "steps"}
    assert not [name for name in public if name not in beside and not re.search(rf"\b{name}\b", PAGE)]
