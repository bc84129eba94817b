"""What is shown: arrays are right, read-only, and stay what they were whatever the simulation does."""

from __future__ import annotations

import gc
import itertools
from pathlib import Path

import h5py
import numpy as np
import pytest
from two_cells import DOCUMENT, MEDIUM, make

from pseudopod_stepping import Simulation, SimulationError


def test_cells_types_and_positions(two: Simulation) -> None:
    assert two.cells == [0, 1]
    pulled, free = two.types
    assert (pulled.name, pulled.atom_count, pulled.is_closed, pulled.loads, pulled.cells) == (
        "pulled", 42, True, ("pull",), (0,),
    )  # fmt: skip
    assert free.fibres == ("belt",)
    assert (pulled.facets.shape, pulled.facets.max()) == ((80, 3), 41)
    positions = two.positions
    assert (positions.shape, positions.dtype) == ((84, 3), np.float64)
    assert np.allclose(positions.reshape(2, 42, 3).mean(axis=1), [[-10, 0, 0], [10, 0, 0]])
    assert np.allclose(np.linalg.norm(two.cell_positions(1) - [10, 0, 0], axis=1), 5)
    assert np.shares_memory(two.cell_positions(1), two.positions), "no copy"
    assert np.array_equal(two.cell_positions(1), two.positions[42:])
    # Outward facets: the volume that they enclose is that of the series.
    corners = two.cell_positions(0)[pulled.facets]
    volume = np.einsum("fi,fi->f", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert volume == pytest.approx(two.series("volume")[0], rel=1e-12)


def test_series(two: Simulation) -> None:
    two.run_until(1.0)
    assert {"volume", "position_x", "load.pull"} <= set(two.series_names)
    infos = two.series_infos
    assert list(infos) == two.series_names
    assert infos["volume"] == ("um^3", True)
    assert infos["load.pull"] == ("pN", False)
    assert two.series("volume").shape == (2,)
    assert two.series("load.pull").tolist() == [5.0]
    assert not two.series("volume").flags.writeable


def test_positions_stay_what_they_were(two: Simulation) -> None:
    first = two.positions
    kept = first.copy()
    own = two.cell_positions(0)
    looks = [first]
    for _ in range(6):
        two.step()
        assert np.array_equal(first, kept), "a look is a look at one instant"
        assert np.array_equal(own, kept[:42])
        looks.append(two.positions)
    assert np.shares_memory(two.positions, looks[-1]), "one copy an instant"
    for one, other in itertools.pairwise(looks):
        assert not np.shares_memory(one, other)
        assert not np.array_equal(one, other)
    # Where nobody holds them, the same memory shows one instant after the other.
    addresses = set()
    del one, other
    looks.clear()
    for _ in range(10):
        addresses.add(two.positions.__array_interface__["data"][0])
        two.step()
    assert len(addresses) <= 3


def test_fields_are_shown_without_a_copy_and_stay_what_they_were(two: Simulation) -> None:
    assert two.field_names == ["medium"]
    field = two.field("medium")
    assert (field.name, field.species, field.time) == ("medium", ("food", "waste"), 0.0)
    assert field.units == {"food": "", "waste": ""}
    assert (field.spacing[:2], field.origin[:2]) == ((5.0, 5.0), (-30.0, -20.0))
    assert field.values.shape == (2, 1, 8, 12)
    x, y = np.meshgrid(-30 + 5 * (np.arange(12) + 0.5), -20 + 5 * (np.arange(8) + 0.5))
    assert np.allclose(field["food"][0], 4 + 0.1 * x + 0.01 * y)
    assert np.shares_memory(field["food"], two.field("medium").values), "no copy"
    kept, looks = field["food"].copy(), [field]
    for _ in range(4):
        two.step()
        assert np.array_equal(field["food"], kept)
        looks.append(two.field("medium"))
    for look in looks:
        assert np.allclose(look["food"], kept * np.exp(-0.1 * look.time), rtol=1e-3)
    # What is held does not change the course.
    plain = make()
    plain.run_until(two.time)
    for _ in range(plain.steps, two.steps):
        plain.step()
    two.run()
    plain.run()
    assert np.array_equal(plain.field("medium").values, two.field("medium").values)
    with pytest.raises(SimulationError, match="no species `fod`"):
        field["fod"]


def test_nobody_writes_into_what_is_shown(two: Simulation) -> None:
    for array in (two.positions, two.cell_positions(0), two.field("medium").values, two.series("volume")):
        assert not array.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0.0
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.flags.writeable = True


def test_arrays_outlive_their_simulation() -> None:
    simulation = make()
    simulation.step()
    positions, food = simulation.positions, simulation.field("medium")["food"]
    copies = positions.copy(), food.copy()
    del simulation
    gc.collect()
    # Memory that was free would be taken by these.
    others = [make() for _ in range(3)]
    for other in others:
        other.step()
    assert np.array_equal(positions, copies[0])
    assert np.array_equal(food, copies[1])


def test_arrays_survive_cells_that_come_and_go_and_steps_back(two: Simulation) -> None:
    positions, kept, saved = two.positions, two.positions.copy(), two.checkpoint()
    added = two.add_cells("free", [[0.0, 30.0, 0.0], [0.0, -30.0, 0.0]], parents=[0, None])
    assert added == [2, 3]
    assert two.positions.shape == (168, 3)
    two.step()
    two.remove_cells([0, *added])
    assert two.positions.shape == (42, 3)
    two.restore(saved)
    assert np.array_equal(two.positions, kept)
    assert np.array_equal(positions, kept)


def test_a_field_begins_as_a_file_of_h5py_has_it(tmp_path: Path) -> None:
    # Two libraries of HDF5 are in the process then, h5py's and that of the module.
    start = np.arange(96.0).reshape(8, 12)
    with h5py.File(tmp_path / "start.h5", "w") as file:
        file["food"] = start
    medium = MEDIUM.replace('initial="4 + 0.1*x + 0.01*y"', 'dataset="start.h5:/food" scale="2"')
    (tmp_path / "medium.eml").write_text(medium)
    (tmp_path / "two.toml").write_text(DOCUMENT)
    field = Simulation(tmp_path / "two.toml").field("medium")
    assert np.allclose(field["food"][0], 2 * start)
    with h5py.File(tmp_path / "start.h5") as file:
        assert np.array_equal(file["food"], start)
