"""Driving: what is set, forces of one's own, cells that come and go, and what is refused."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from two_cells import DOCUMENT, make

from pseudopod_stepping import Simulation, SimulationError

DRAG = 20.0


def test_a_force_moves_a_cell_at_the_force_over_its_drag(two: Simulation) -> None:
    start = two.cell_positions(1)
    force = np.array([0.0, 8.0, -4.0])
    two.set_force(1, force)
    two.run_until(3.0)
    assert np.allclose(two.cell_positions(1) - start, 3.0 * force / DRAG, atol=1e-9)
    two.clear_forces()
    stopped = two.cell_positions(1)
    two.run_until(4.0)
    assert np.allclose(two.cell_positions(1), stopped, atol=1e-9)


def test_forces_between_steps_hold_a_cell_as_a_spring_does(two: Simulation) -> None:
    # A trap about a point, in which the mean of the atoms decays as exp(-stiffness * time / drag).
    stiffness, point = 4.0, np.array([12.0, 0.0, 0.0])

    def trap(simulation: Simulation) -> None:
        positions = simulation.cell_positions(1)
        simulation.set_atom_forces(1, np.tile(stiffness * (point - positions.mean(axis=0)) / 42, (42, 1)))

    two = make(overrides={"run.integrator.max_step": "0.01 s"})
    trap(two)
    two.run(2.0, stop=trap)
    offset = (two.cell_positions(1).mean(axis=0) - point)[0]
    assert offset == pytest.approx(-2.0 * np.exp(-stiffness * 2.0 / DRAG), rel=2e-3)


def test_uneven_forces_move_the_mean_by_their_sum(two: Simulation) -> None:
    forces = np.random.default_rng(1).normal(size=(42, 3))
    start = two.cell_positions(1).mean(axis=0)
    two.set_atom_forces(1, forces)
    two.run_until(2.0)
    moved = two.cell_positions(1).mean(axis=0) - start
    assert np.allclose(moved, 2.0 * forces.sum(axis=0) / DRAG, atol=1e-9)
    assert two.series("energy")[1] > 0


def test_what_links_set_is_set(two: Simulation) -> None:
    two.set(0, "load[pull]", 0.0)
    two.set(1, "fibre[belt]", 1.0)
    two.set(1, "motility.bias.y", 2.0)
    two.run_until(1.0)
    assert two.series("position_x")[0] == pytest.approx(-10.0, abs=1e-9)
    assert two.series("position_y")[1] == pytest.approx(2.0, abs=1e-6)
    assert two.series("size_x")[1] < 9.9


def test_cells_come_with_positions_of_their_own(two: Simulation) -> None:
    shape = (two.cell_positions(1) - [10.0, 0.0, 0.0]) * [1.0, 1.2, 1.0] + [0.0, 40.0, 0.0]
    (added,) = two.add_cells("pulled", positions=[shape])
    assert two.cells == [0, added, 1], "type after type"
    assert np.array_equal(two.cell_positions(added), shape)
    with pytest.raises(TypeError, match="either the centres"):
        two.add_cells("pulled")
    with pytest.raises(ValueError, match="2 parents were given for 1 cells"):
        two.add_cells("pulled", [[0.0, 80.0, 0.0]], parents=[0, 1])


@pytest.mark.parametrize(
    ("ask", "kind", "message", "help"),
    [
        (lambda s: s.series("volumes"), "unknown", "there is no series `volumes`", "did you mean `volume`?"),
        (lambda s: s.field("air"), "unknown", "there is no field `air`", "there is `medium`"),
        (lambda s: s.cell_positions(7), "no_such_cell", "there is no cell 7", "ask `cells`"),
        (lambda s: s.set(1, "fibre[bell]", 1.0), "unknown", "there is no fibre `bell`", "did you mean `belt`?"),
        (lambda s: s.set(1, "adhesion", 1.0), "not_settable", "touches nothing", "[contact]"),
        (lambda s: s.set(1, "fibre[belt]", 2.0), "value", "cannot be 2: a number from 0 to 1", None),
        (lambda s: s.set_force(1, [0, np.nan, 0]), "value", "the force on cell 1 cannot be NaN", None),
        (
            lambda s: s.set_atom_forces(1, np.zeros((41, 3))),
            "length",
            "forces on 41 atoms of cell 1 were given, which has 42",
            "one for each atom",
        ),
        (lambda s: s.add_cells("fre", [[0, 0, 0]]), "unknown", "there is no type of cells `fre`", "did you mean"),
        (lambda s: s.remove_cells([0, 9]), "no_such_cell", "there is no cell 9", "ask `cells`"),
        (lambda s: s.restore(b"something else"), "checkpoint", "not a checkpoint", "give the bytes"),
    ],
)
def test_what_cannot_be_is_refused_and_changes_nothing(
    two: Simulation, ask: object, kind: str, message: str, help: str | None
) -> None:
    before = two.checkpoint()
    with pytest.raises(SimulationError) as caught:
        ask(two)
    error = caught.value
    assert error.kind == kind
    assert message in error.message
    assert help in error.help if help else error.help is None
    assert str(error) == error.message + (f"\nhelp: {error.help}" if error.help else "")
    assert two.checkpoint() == before
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.kind, again.help) == (str(error), error.kind, error.help)


def test_shapes_that_cannot_be_are_told(two: Simulation) -> None:
    with pytest.raises(ValueError, match=r"a force cannot have the shape \(2,\): \(3,\) was expected"):
        two.set_force(0, [1.0, 2.0])
    with pytest.raises(ValueError, match=r"forces on atoms cannot have the shape \(126,\)"):
        two.set_atom_forces(0, np.zeros(126))


def test_faults_of_a_document_have_their_places() -> None:
    text = DOCUMENT.replace("drag", "darg", 1).replace('"4 s"', '"4 um"')
    with pytest.raises(SimulationError) as caught:
        Simulation.from_text(text, name="wrong.toml", equations={"medium.eml": "<eml/>"})
    error = caught.value
    assert error.kind == "input"
    lines = {fault.line: fault for fault in error.faults}
    assert {5, 12} <= set(lines), error
    assert lines[5].file == "wrong.toml"
    assert text.splitlines()[4][lines[5].column - 1 :].startswith('4 um"')
    assert str(error).startswith("wrong.toml:5:")
    assert "help: " in str(error)


def test_a_document_that_is_not_there_and_threads_that_cannot_be(tmp_path: Path) -> None:
    with pytest.raises(SimulationError, match=r"nowhere\.toml"):
        Simulation(tmp_path / "nowhere.toml")
    with pytest.raises(SimulationError, match="cannot be made by 0 threads") as caught:
        make(threads=0)
    assert caught.value.help == "ask for 1 or more; leave it out for all cores"
    with pytest.raises(TypeError, match="a document has no value like"):
        make(overrides={"run.until": object()})


def test_trouble_of_a_step_leaves_the_simulation_as_it_was(two: Simulation) -> None:
    two.step()
    two.set_force(1, [1e300, 0.0, 0.0])
    before = two.checkpoint()
    with pytest.raises(SimulationError) as caught:
        two.run()
    assert caught.value.kind == "trouble"
    assert two.checkpoint() == before
    two.clear_forces()
    two.run()
    assert two.time == two.end


def test_what_there_is_to_know_about_the_start_is_told() -> None:
    (notice,) = make().notices
    assert notice.startswith("nothing keeps cells apart")
