"""Tables hold what the file and the program say."""

from __future__ import annotations

import re
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import pytest

import pseudopod

from .conftest import told

UNIT = re.compile(r"(.*?)(?: \((.*)\))?")


def exported(result: Path, table: str, folder: Path) -> tuple[pd.DataFrame, dict[str, str]]:
    """A table of `pseudopod export`, and the units of its columns."""
    told("export", result, "-o", folder / "table.csv", "--table", table, "--force")
    found = pd.read_csv(folder / "table.csv")
    split = {title: UNIT.fullmatch(title).groups() for title in found.columns}
    found.columns = pd.Index([name for name, _ in split.values()])
    return found, {name: unit or "1" for name, unit in split.values()}


def test_tracks_are_the_rows_that_h5py_reads(any_result: Path) -> None:
    with h5py.File(any_result) as file, pseudopod.open(any_result) as result:
        tracks = result.tracks.sort_values(["frame", "cell"], kind="stable")
        cells = file["cells"]
        assert np.array_equal(tracks["cell"], cells["id"][:])
        assert np.array_equal(tracks[["x", "y", "z"]], cells["position"][:])
        assert np.array_equal(tracks["volume"], cells["volume"][:])
        assert np.array_equal(tracks["type"], cells["type_names"].asstr()[:][cells["type"][:]])
        assert np.array_equal(tracks["time"], np.repeat(file["time"][:], cells["count"][:]))
        assert np.array_equal(result.times, file["time"][:])
        for name, unit in {"x": "um", "volume": "um^3", "velocity_y": "um/s", "time": "s"}.items():
            assert tracks.attrs["units"][name] == unit


def test_tracks_are_the_series_that_the_program_exports(any_result: Path, tmp_path: Path) -> None:
    wanted, units = exported(any_result, "series", tmp_path)
    result = pseudopod.open(any_result)
    tracks = result.tracks.rename(columns={axis: f"position_{axis}" for axis in "xyz"})
    wanted = wanted.sort_values(["cell", "frame"], ignore_index=True)
    shared = [name for name in wanted.columns if name in tracks.columns]
    # What is not stored, but follows from who touches whom, is left.
    lacking = set(wanted.columns) - set(shared) - set(result.series.columns)
    assert all(name.startswith("contact.") for name in lacking - {"position_x", "position_y", "position_z"}), lacking
    assert set(tracks.columns) - set(wanted.columns) <= {"parent"}
    for name in shared:
        if name == "type":
            assert list(tracks[name]) == list(wanted[name])
        else:
            np.testing.assert_allclose(tracks[name], wanted[name], rtol=1e-15, err_msg=name)
        name_here = name.removeprefix("position_")
        if name_here in result.tracks.attrs["units"]:
            assert result.tracks.attrs["units"][name_here] == units[name], name
    of_frames = wanted.drop_duplicates("frame").sort_values("frame")
    for name in result.series.columns:
        np.testing.assert_array_equal(result.series[name], of_frames[name], err_msg=name)
        assert result.series.attrs["units"][name] == units[name]
    np.testing.assert_array_equal(result.series.index, of_frames["time"])


def test_some_columns_and_frames_are_those_of_all(amoebae: pseudopod.Result) -> None:
    some = amoebae.read_tracks(["x", "speed", "compass.c"], slice(1, None, 2))
    assert list(some.columns) == ["cell", "type", "frame", "time", "x", "speed", "compass.c"]
    every = amoebae.tracks
    expected = every[every["frame"] % 2 == 1].reset_index(drop=True)[some.columns]
    pd.testing.assert_frame_equal(some, expected)
    assert some.attrs["units"] == {"time": "s", "x": "um", "speed": "um/s", "compass.c": "nM"}
    with pytest.raises(pseudopod.ResultError, match=r"'mass' of cells\nhelp: it has x, y, z"):
        amoebae.read_tracks(["mass"])


def test_frames_are_at_the_times_asked_for(amoebae: pseudopod.Result) -> None:
    np.testing.assert_allclose(amoebae.times, 5.0 * np.arange(7), rtol=1e-12)
    within = amoebae.interpolated
    assert within.dtype == np.bool_
    assert len(within) == len(amoebae)
    assert not within[0]
    assert not within[-1]


def test_cells_of_a_frame(amoebae: pseudopod.Result) -> None:
    last = amoebae.cells()
    assert list(last.index) == [0, 1]
    assert last.index.name == "cell"
    assert (last["time"] == 30.0).all()
    pd.testing.assert_frame_equal(amoebae.cells(time=29.0), last)
    pd.testing.assert_frame_equal(amoebae.cells(len(amoebae) - 1), last)
    assert (amoebae.cells(0)["frame"] == 0).all()
    with pytest.raises(IndexError, match="frame 7 of 7: give a number from -7 to 6"):
        amoebae.cells(7)
    assert amoebae.cells(0).attrs["units"]["area"] == "um^2"


def test_contacts_are_those_that_the_program_exports(made, tmp_path: Path) -> None:
    for name in ("heap", "amoebae"):
        wanted, _ = exported(made(name), "contacts", tmp_path)
        result = pseudopod.open(made(name))
        pairs, planes = result.contacts, result.plane_contacts
        of_pairs = wanted[wanted["other"].notna()]
        assert len(pairs) + len(planes) == len(wanted) > 0
        np.testing.assert_array_equal(pairs[["first", "second"]], of_pairs[["cell", "other"]])
        np.testing.assert_array_equal(pairs[["frame", "time", "area"]], of_pairs[["frame", "time", "area"]])
        of_planes = wanted[wanted["other"].isna()]
        assert list(planes["plane"]) == list(of_planes["type or plane"])
        np.testing.assert_array_equal(planes[["cell", "area"]], of_planes[["cell", "area"]])
        assert pairs.attrs["units"]["area"] == planes.attrs["units"]["area"] == "um^2"
        series = result.contact_series
        area = pairs.groupby("frame")["area"].sum().reindex(range(len(result)), fill_value=0.0)
        kind = result.types.index[0]
        np.testing.assert_allclose(series[f"contact.area.{kind}.{kind}"], area, rtol=1e-12, atol=1e-9)
        assert series.attrs["units"][f"contact.area.{kind}.{kind}"] == "um^2"
        np.testing.assert_array_equal(series.index, result.times)
    assert list(pseudopod.open(made("amoebae")).planes.index) == ["glass"]


def test_events_are_those_that_the_program_exports(made, tmp_path: Path) -> None:
    for name, table in (("walk", "runs"), ("amoebae", "pseudopods")):
        wanted, _ = exported(made(name), table, tmp_path)
        found = getattr(pseudopod.open(made(name)), table)
        assert len(found) == len(wanted) > 0
        for title in wanted.columns:
            np.testing.assert_allclose(found[title.replace(" ", "_")], wanted[title], rtol=1e-15, err_msg=title)
        assert (found["end_time"] <= found["time"]).all()


def test_fibres_add_up_to_what_cells_record(amoebae: pseudopod.Result) -> None:
    fibres = amoebae.fibres
    assert len(fibres) > 0
    assert fibres.attrs["units"]["tension"] == "pN"
    total = fibres.groupby(["cell", "frame"])["tension"].sum()
    of_cells = amoebae.tracks.set_index(["cell", "frame"])["fibre_tension"]
    np.testing.assert_allclose(total.reindex(of_cells.index, fill_value=0.0), of_cells, rtol=1e-12)


def test_what_a_file_does_not_hold_is_told(walk: pseudopod.Result) -> None:
    with pytest.raises(pseudopod.ResultError, match=r"add \[contact\] to the document"):
        walk.contacts  # noqa: B018
    with pytest.raises(pseudopod.ResultError, match="holds no contacts"):
        walk.contact_series  # noqa: B018
    with pytest.raises(pseudopod.ResultError, match="holds no fibres"):
        walk.fibres  # noqa: B018
    with pytest.raises(pseudopod.ResultError, match="give the experiment a field"):
        walk.field("red")
    with pytest.raises(pseudopod.ResultError, match="membrane"):
        walk.membrane("a.b")
    assert len(walk.planes) == len(walk.fields) == len(walk.membranes) == 0
    assert list(walk.types.index) == ["walker", "box"]
    assert list(walk.types["atoms"]) == [42, 26]


def test_provenance_and_measures_are_those_of_info(any_result: Path) -> None:
    info, result = told("info", any_result), pseudopod.open(any_result)
    header, found = info["header"], result.provenance
    for name in ("title", "version", "commit", "seed", "document", "experiment"):
        assert getattr(found, name) == header[name], name
    assert found.settings == tuple(header["sets"])
    assert found.equations == dict(header["equations"])
    assert found.started is not None
    assert found.started.isoformat() == header["started"].replace("Z", "+00:00")
    assert (found.finished, found.wall_time, found.resumed) == (True, info["wall_time"], 0)
    assert result.is_complete
    assert found.command.startswith(f"pseudopod run {found.document}")
    assert set(result.measures) == set(info["summary"])
    for name, fact in info["summary"].items():
        measure = result.measures[name]
        assert (measure.value, measure.unit, measure.description) == (fact["value"], fact["unit"], fact["description"])
        assert result.measures.to_frame().loc[name, "unit"] == fact["unit"]
    assert len(result) == info["frames"]
    with pytest.raises(KeyError, match="no measure 'sped': there are"):
        result.measures["sped"]


def test_a_result_tells_what_it_is(amoebae: pseudopod.Result) -> None:
    for text in (repr(amoebae), amoebae._repr_html_()):
        for word in ("Two amoebae and an attractant", "2 amoeba", "attractant [nM]", "compass", "speed = ", "complete"):
            assert word in text
    assert "speed" in repr(amoebae.measures)
    assert "nM" in repr(amoebae.fields)
    amoebae.close()
    assert "closed" in repr(amoebae)
    assert "closed" in amoebae._repr_html_()


def test_what_is_done_to_a_table_leaves_the_result_as_it_is(walk: pseudopod.Result) -> None:
    tracks = walk.tracks
    before = tracks.copy()
    tracks["x"] = 0.0
    tracks["more"] = 1
    tracks.attrs["units"]["x"] = "m"
    assert walk.tracks.equals(before)
    assert walk.tracks.attrs["units"]["x"] == "um"
