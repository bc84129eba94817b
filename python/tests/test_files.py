"""Whatever lies at a path is opened or told: cells that come and go, damage, what others made, runs that go on."""

from __future__ import annotations

import pickle
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest

import pseudopod

from .conftest import DOCUMENTS, told


def test_what_is_no_result_is_told(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="does not exist"):
        pseudopod.open(tmp_path / "none.vtkhdf")
    (tmp_path / "begun.vtkhdf.frames").write_bytes(b"")
    with pytest.raises(FileNotFoundError, match="has not recorded a frame yet"):
        pseudopod.open(tmp_path / "begun.vtkhdf")
    with pytest.raises(pseudopod.ResultError, match=r"is a folder\nhelp: name the result file in it"):
        pseudopod.open(tmp_path)
    (tmp_path / "text.vtkhdf").write_text("no HDF5\n" * 1000)
    with pytest.raises(pseudopod.ResultError, match="is not an HDF5 file"):
        pseudopod.open(tmp_path / "text.vtkhdf")
    with h5py.File(tmp_path / "foreign.h5", "w") as file:
        file["data"] = [1, 2, 3]
    with pytest.raises(pseudopod.ResultError, match="not a result of pseudopod"):
        pseudopod.open(tmp_path / "foreign.h5")
    with h5py.File(tmp_path / "foreign.h5", "a") as file:
        file.attrs["pseudopod_format"] = 1
    with pytest.raises(pseudopod.ResultError, match="format is 1, and this package reads format 2"):
        pseudopod.open(tmp_path / "foreign.h5")


def test_a_file_that_is_cut_short_is_told(made: Callable[[str], Path], tmp_path: Path) -> None:
    whole = made("walk").read_bytes()
    (tmp_path / "cut.vtkhdf").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(pseudopod.ResultError, match=r"is damaged: .*truncated"):
        pseudopod.open(tmp_path / "cut.vtkhdf").tracks  # noqa: B018


def changed(result: Path, folder: Path, change: Callable[[h5py.File], None]) -> pseudopod.Result:
    """A copy in which something is changed."""
    path = folder / "changed.vtkhdf"
    shutil.copy(result, path)
    with h5py.File(path, "a") as file:
        change(file)
    return pseudopod.open(path)


def put(file: h5py.File, path: str, values: object) -> None:
    attributes = dict(file[path].attrs)
    del file[path]
    file[path] = values
    file[path].attrs.update(attributes)


def add(file: h5py.File, path: str, what: int) -> None:
    put(file, path, file[path][:] + what)


@pytest.mark.parametrize(
    ("change", "look", "words"),
    [
        (lambda f: f.pop("cells/id"), lambda r: r.tracks, "cells/id: the dataset is missing"),
        (lambda f: add(f, "cells/count", 100), lambda r: r.tracks, "rows 0 to"),
        (lambda f: add(f, "cells/first", -1), lambda r: r.tracks, "below 0"),
        (lambda f: put(f, "cells/first", [0]), lambda r: r.tracks, "1 entries for 7 frames"),
        (lambda f: add(f, "cells/type", 5), lambda r: r.tracks, "a type that is none of the 1"),
        (lambda f: add(f, "VTKHDF/Polygons/Connectivity", 80), lambda r: r.mesh(), "an atom that is none of the 84"),
        (lambda f: add(f, "VTKHDF/PointData/cell", 7), lambda r: r.mesh(), "not in its frame"),
        (lambda f: add(f, "VTKHDF/Steps/PointOffsets", 10**9), lambda r: r.mesh(), "rows 1000000"),
        (lambda f: add(f, "contacts/planes/plane", 1), lambda r: r.plane_contacts, "a plane that is none of the 1"),
        (lambda f: put(f, "contacts/pair_count", [3, 2, 1, 0, 0, 0, 0]), lambda r: r.contacts, "it falls"),
        (lambda f: f["fields/attractant"].attrs.pop("Origin"), lambda r: r.field("attractant"), "extent, origin or"),
        (
            lambda f: put(f, "fields/attractant/CellData/attractant", [1.0]),
            lambda r: r.fields["attractant"],
            "its shape is",
        ),
        (lambda f: f["provenance"].attrs.modify("started", "today"), lambda r: r.provenance, "started"),
    ],
)
def test_damage_is_told_with_its_place(made, tmp_path: Path, change, look, words: str) -> None:
    with pytest.raises(pseudopod.ResultError, match=words) as caught:
        look(changed(made("amoebae"), tmp_path, change))
    assert "help: " in str(caught.value)
    assert "changed.vtkhdf" in caught.value.path


def test_no_other_file_is_read_through_a_result(made, tmp_path: Path) -> None:
    with h5py.File(tmp_path / "secret.h5", "w") as file:
        file["numbers"] = [1.0]

    def lead_out(file: h5py.File) -> None:
        del file["scene"]
        file["scene"] = h5py.ExternalLink(str(tmp_path / "secret.h5"), "/")

    with pytest.raises(pseudopod.ResultError, match="it is a link, and results hold none"):
        changed(made("amoebae"), tmp_path, lead_out).series  # noqa: B018


def test_a_run_that_has_recorded_nothing_has_no_frames(made, tmp_path: Path) -> None:
    def change(file: h5py.File) -> None:
        for path in ("VTKHDF", "time", "step", "cells/id", "cells/first", "cells/count", "contacts", "fields", "scene"):
            del file[path]

    result = changed(made("amoebae"), tmp_path, change)
    assert len(result) == len(result.times) == len(result.series) == len(result.membranes) == 0
    assert "Two amoebae" in repr(result)
    looks = [lambda: result.tracks, result.cells, result.mesh, lambda: result.contacts, lambda: result.steps]
    for look in looks:
        with pytest.raises(pseudopod.ResultError, match=r"holds no frame yet\nhelp: call refresh"):
            look()


def test_what_is_closed_says_so_and_opens_again(made) -> None:
    with pseudopod.open(made("walk")) as result:
        tracks = result.tracks
    assert len(tracks) > 0
    with pytest.raises(pseudopod.ResultError, match=r"was closed\nhelp: .*refresh"):
        result.contacts  # noqa: B018
    assert len(result.refresh().tracks) == len(tracks)


def test_a_result_is_sent_by_its_path(walk: pseudopod.Result) -> None:
    sent = pickle.loads(pickle.dumps(walk))
    assert sent.path == walk.path
    assert len(sent.tracks) == len(walk.tracks)
    error = pseudopod.RunError(2, "no", [pseudopod.Fault("a")], "b")
    assert str(pickle.loads(pickle.dumps(error))) == str(error)
    error = pseudopod.ResultError("a", "b", "c")
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


def test_others_may_have_the_file_open(made) -> None:
    with h5py.File(made("walk")) as before, pseudopod.open(made("walk")) as result, h5py.File(made("walk")) as after:
        assert len(before["time"]) == len(result) == len(after["time"])


def test_cells_come_and_go(made, tmp_path: Path) -> None:
    """Of seven cells the third frame has four, and rows between frames belong to nobody."""
    kept = np.array([0, 2, 3, 6])

    def change(file: h5py.File) -> None:
        count, first, frames = file["cells/count"][:], file["cells/first"][:], len(file["time"])
        cells = {name: data[:] for name, data in file["cells"].items() if len(data) == 7 * frames}
        count[2] = 4
        first[3:] += 2
        put(file, "cells/count", count)
        put(file, "cells/first", first)
        for name, values in cells.items():
            filler = np.full((5, *values.shape[1:]), -1 if values.dtype.kind == "i" else np.nan, values.dtype)
            put(file, f"cells/{name}", np.concatenate([values[:14], values[14:21][kept], filler, values[21:]]))

    whole = pseudopod.open(made("walk"))
    found = changed(made("walk"), tmp_path, change)
    expected = whole.tracks[(whole.tracks["frame"] != 2) | whole.tracks["cell"].isin(kept)]
    assert found.tracks.equals(expected.reset_index(drop=True))
    assert list(found.cells(2).index) == list(kept)
    assert found.cells(3).equals(whole.cells(3))
    some = found.read_tracks(["volume"], slice(1, 4))
    assert list(some.groupby("frame").size()) == [7, 4, 7]


#: A run of years of its time, which are hours of ours, with a frame or two a second: a file that grows fast is put in
#: its place more and more rarely.
LONG = {
    "cells.walker.number": 60,
    "run.until": "100000 h",
    "run.integrator": {"max_step": "20 s"},
    "output.every": "10 h",
}


def until(condition: Callable[[], bool], what: str) -> None:
    """Waits, two minutes at most: a new version of a file is not made before the disk has taken the last."""
    end = time.monotonic() + 120.0
    while not condition():
        assert time.monotonic() < end, f"no {what} in two minutes"
        time.sleep(0.05)


@pytest.fixture
def start(tmp_path: Path):
    """Starts :func:`pseudopod.run` in another process; ends it when the test does."""
    path, children = tmp_path / "long.vtkhdf", []

    def begin(changes: dict[str, object]) -> tuple[Path, subprocess.Popen[str]]:
        asked = f"{str(DOCUMENTS / 'walk.toml')!r}, {changes!r}, output={str(path)!r}, threads=1"
        command = [sys.executable, "-c", f"import pseudopod; pseudopod.run({asked})"]
        children.append(subprocess.Popen(command, stderr=subprocess.PIPE, text=True))
        return path, children[-1]

    yield begin
    for child in children:
        if child.poll() is None:
            child.send_signal(signal.SIGINT)
            child.communicate()


def test_a_run_is_read_while_it_goes_on_and_stops_when_it_is_told_to(start) -> None:
    path, child = start(LONG)
    until(path.exists, "result")
    result = pseudopod.open(path)
    until(lambda: len(result.refresh()) > 0, "frame")
    seen = [len(result)]
    first = result.tracks
    for _ in range(3):
        until(lambda: len(result.refresh()) > seen[-1], "new frame")
        seen.append(len(result))
        assert not result.is_complete
        assert len(result.measures) == 0
        assert len(result.tracks) == 62 * seen[-1]
        assert result.mesh().n_points == 60 * result.types.loc["walker", "atoms"] + 2 * result.types.loc["box", "atoms"]
        with pseudopod.open(path) as other:
            assert len(other) >= seen[-1]
    assert result.tracks[result.tracks["frame"] < seen[0]].reset_index(drop=True).equals(first)
    # A notebook and a terminal tell Python; Python tells the program, once, and waits for it.
    child.send_signal(signal.SIGINT)
    _, words = child.communicate(timeout=120)
    assert "KeyboardInterrupt" in words
    assert "pseudopod.resume goes on" in words
    assert told("info", path)["running"] is False
    assert len(result.refresh()) >= seen[-1]
    assert not result.is_complete


def test_a_run_that_was_stopped_goes_on(start) -> None:
    path, child = start(LONG | {"run.until": "30 h", "output.every": "10 min"})
    until(path.exists, "result")
    child.send_signal(signal.SIGINT)
    child.communicate(timeout=120)
    result = pseudopod.open(path)
    assert not result.is_complete
    whole = pseudopod.resume(result, progress=False)
    assert whole.is_complete
    assert result.refresh().is_complete
    assert len(result) == len(whole) == 181
    assert whole.provenance.resumed == 1
    assert whole.measures["speed"].unit == "um/min"
    # Once more is no fault.
    assert len(pseudopod.resume(path, progress=False)) == 181
