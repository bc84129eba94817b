"""Experiments are run with changes and faults are told."""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path

import numpy as np
import pytest

import pseudopod
from pseudopod._progress import Progress
from pseudopod._toml import toml

from .conftest import DOCUMENTS

WALK = DOCUMENTS / "walk.toml"


def test_a_run_takes_changes_of_every_kind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    changes = {
        "cells.walker.number": np.int64(3),
        "cells.box.placement.at": [["0 um", "0 um", "30 um"], ("10 um", "0 um", "30 um")],
        "cells.walker.motility.brownian": {"speed": "2 um/min", "persistence": "5 s"},
        "cells.walker.mechanics.shape_memory.shape_modulus": "20 pN/um",
        "output.tractions": True,
        "title": 'of "three" \\ cells, µ',
    }
    result = pseudopod.run(WALK, changes, seed=8, until="10 s", threads=1, progress=False)
    assert result.path == str(tmp_path / "results" / "documents-walk.vtkhdf")
    assert result.title == changes["title"]
    assert result.provenance.seed == 8
    assert result.times[-1] == 10.0
    assert list(result.cells()["type"]) == ["walker"] * 3 + ["box"] * 2
    assert result.cells(0).loc[4, ["x", "y", "z"]].tolist() == [10.0, 0.0, 30.0]
    assert "traction_x" in result.tracks
    assert not list(tmp_path.glob("results/*.png"))
    with pytest.raises(pseudopod.RunError, match=r"exit code 2\n.*exists"):
        pseudopod.run(WALK, changes, progress=False)
    again = pseudopod.run(WALK, changes, seed=9, until="4 s", force=True, pictures=True, progress=False)
    assert again.provenance.seed == 9
    assert list(tmp_path.glob("results/*.png"))


def test_the_package_for_stepping_writes_values_in_the_same_way() -> None:
    # Neither needs the other, so that each has this file.
    python = Path(__file__).parents[1]
    here, there = python / "pseudopod", python / "stepping" / "python" / "pseudopod_stepping"
    assert (here / "_toml.py").read_bytes() == (there / "_toml.py").read_bytes()


def test_values_are_written_as_toml_has_them() -> None:
    assert toml('a "b" \\ \n µ') == '"a \\"b\\" \\\\ \\n µ"'
    assert [toml(value) for value in (True, 3, np.float32(0.5), 1e300, 1e-5, -2.0)] == [
        "true",
        "3",
        "0.5",
        "1e300",
        "1e-05",
        "-2.0",
    ]
    assert [toml(value) for value in (math.inf, -math.inf, math.nan)] == ["inf", "-inf", "nan"]
    assert toml([1, "2 um", [np.array([1.0, 2.0])]]) == '[1, "2 um", [[1.0, 2.0]]]'
    assert toml({"a": {"b": 1}}) == '{ "a" = { "b" = 1 } }'
    with pytest.raises(TypeError, match="no value like None"):
        toml(None)


def test_faults_of_documents_are_told_with_their_place() -> None:
    assert pseudopod.check(WALK) == []
    faults = pseudopod.check(WALK, {"run.until": "soon", "cells.walker.numbr": 3})
    assert len(faults) == 2
    assert any("numbr" in fault.message for fault in faults)
    assert all(fault.line == 1 and fault.help for fault in faults)
    with pytest.raises(pseudopod.RunError) as caught:
        pseudopod.run(WALK, {"run.until": "soon"}, progress=False)
    assert caught.value.exit_code == 2
    assert "soon" in caught.value.faults[0].message
    # As on a terminal, with the line and a mark under it.
    assert "───" in str(caught.value)
    assert pseudopod.check("nowhere.toml")[0].message


def test_the_program_is_named_found_or_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    assert pseudopod.version().count(".") == 2
    program = pseudopod.binary()
    monkeypatch.setenv("PSEUDOPOD_BINARY", str(tmp_path / "none"))
    with pytest.raises(pseudopod.PseudopodError, match="which is no program"):
        pseudopod.binary()
    monkeypatch.delenv("PSEUDOPOD_BINARY")
    monkeypatch.setattr("sysconfig.get_path", lambda _: str(tmp_path))
    monkeypatch.setattr("pseudopod._program._installed", list)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(pseudopod.PseudopodError, match=r"pip install \."):
        pseudopod.binary()
    os.symlink(program, tmp_path / "pseudopod")
    assert pseudopod.binary() == str(tmp_path / "pseudopod")
    # What kills the program is told by its number.
    (tmp_path / "killed").write_text("#!/bin/sh\nkill -9 $$\n")
    (tmp_path / "killed").chmod(0o755)
    monkeypatch.setenv("PSEUDOPOD_BINARY", str(tmp_path / "killed"))
    with pytest.raises(pseudopod.RunError, match="exit code -9"):
        pseudopod.run(WALK, progress=False)


def test_progress_is_a_bar_or_lines(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    lines = [
        "t = 12.5000 of 100 s, 40 steps, about 3 s left",
        "pushing cells apart, 3 pairs overlap: round 1 of 9 at most",
    ]
    for has_bar in (True, False):
        if not has_bar:
            monkeypatch.setitem(sys.modules, "tqdm.auto", None)
        with Progress(True, "walk") as shown:
            assert [shown.line(text) for text in [*lines, "else"]] == [True, True, False]
        told = capsys.readouterr().err
        assert ("12.5/100 s of its time" in told) == has_bar
        assert "walk: pushing cells apart" in told
        assert ("walk: t = 12.5000 of 100 s" in told) != has_bar
    with Progress(False, "walk") as quiet:
        assert quiet.line(lines[0])
    assert capsys.readouterr().err == ""


def test_what_a_run_notices_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pseudopod.run(WALK, output=tmp_path / "a.vtkhdf")
    assert "walk: nothing keeps cells apart" in capsys.readouterr().err


def test_a_summary_of_a_study_has_its_units_apart(tmp_path: Path) -> None:
    (tmp_path / "summary.csv").write_text(
        "run,contact.strength (pN/um^2),seed,state,speed (um/min),share,share (%)\n"
        "0,0.1,1,done,3.5,0.25,25\n1,0.2,1,failed,,,\n"
    )
    for where in (tmp_path, tmp_path / "summary.csv"):
        table = pseudopod.read_summary(where)
        assert list(table.columns) == ["run", "contact.strength", "seed", "state", "speed", "share", "share (%)"]
        assert table.attrs["units"]["contact.strength"] == "pN/um^2"
        assert table.attrs["units"]["speed"] == "um/min"
        assert table.attrs["units"]["share"] == "1"
        assert table.attrs["units"]["share (%)"] == "%"
        assert table["contact.strength"].tolist() == [0.1, 0.2]
        assert math.isnan(table["speed"][1])
    with pytest.raises(FileNotFoundError, match="sweep collect"):
        pseudopod.read_summary(tmp_path / "none")
    (tmp_path / "summary.csv").write_text("")
    with pytest.raises(pseudopod.ResultError, match="is no table"):
        pseudopod.read_summary(tmp_path)


def test_a_study_is_planned_run_and_collected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The three commands of the program in their order; the first only where there is no folder yet."""
    folder, log = tmp_path / "study", tmp_path / "log"
    stub = tmp_path / "stub"
    stub.write_text(
        f'#!/bin/sh\necho "$@" >> {log}\nif [ "$2" = plan ]; then mkdir {folder}; fi\n'
        f'if [ "$2" = collect ]; then printf "run,force (pN)\\n0,2\\n" > {folder}/summary.csv; fi\necho running >&2\n'
    )
    stub.chmod(0o755)
    monkeypatch.setenv("PSEUDOPOD_BINARY", str(stub))
    for _ in range(2):
        table = pseudopod.sweep("study.toml", folder, jobs=2)
        assert table["force"].tolist() == [2]
        assert table.attrs["units"]["force"] == "pN"
    words = [line.split() for line in log.read_text().splitlines()]
    assert [line[1] for line in words] == ["plan", "run", "collect", "run", "collect"]
    assert words[0] == ["sweep", "plan", "study.toml", "-o", str(folder)]
    assert words[1] == ["sweep", "run", str(folder), "-j", "2"]
