"""Going on: the course of a recorded run, rules of one's own, interrupts, threads."""

from __future__ import annotations

import _thread
import signal
import sys
import threading
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
from two_cells import make

import pseudopod
from pseudopod_stepping import Simulation, SimulationError

DOCUMENTS = Path(__file__).parents[2] / "tests" / "documents"


def test_it_is_where_a_recorded_run_is_to_the_last_bit(tmp_path: Path) -> None:
    changes = {"run.until": "2 s", "run.integrator.max_step": "1 s", "output.every": "1 s"}
    path = tmp_path / "run.vtkhdf"
    pseudopod.run(DOCUMENTS / "amoebae.toml", changes, seed=5, output=path, progress=False).close()
    simulation = Simulation(DOCUMENTS / "amoebae.toml", overrides=changes, seed=5, threads=1)
    with h5py.File(path) as result:
        recorded = result["VTKHDF/Points"][:].reshape(len(result["time"]), -1, 3)
        assert np.array_equal(simulation.positions, recorded[0])
        assert simulation.run() is None
        assert simulation.time == result["time"][-1] == 2.0
        assert np.array_equal(simulation.positions, recorded[-1])
        assert np.abs(recorded[-1] - recorded[0]).max() > 1e-3
        fields = result["fields/attractant/CellData"]
        for species in fields:
            # Results have fields in single precision.
            now = simulation.field("attractant")[species].astype(np.float32)
            assert np.array_equal(now.ravel(), fields[species][-1].ravel())
        assert np.array_equal(simulation.series("volume"), result["cells/volume"][-2:])


def test_steps_and_times(two: Simulation) -> None:
    assert (two.time, two.steps, two.end) == (0.0, 0, 4.0)
    made = two.step()
    assert two.time == made.dt > 0
    assert (two.steps, made.refused) == (1, 0)
    two.run_until(1 / 3)
    assert two.time == 1 / 3
    two.run_until(0.1)
    assert two.time == 1 / 3, "what is past is past"
    assert two.run() is None
    assert two.time == 4.0
    two.run_until(5.5)
    assert two.time == 5.5, "the end of the document is no wall"
    assert repr(two) == f"<Simulation at 5.5 s after {two.steps} steps, 2 cells>"


def test_overrides_seed_and_threads_change_what_they_say() -> None:
    changes = {"run.until": "2 s", "cells.pulled.loads[0].force": "8 pN", "run.integrator.max_step": np.float64(0.25)}
    with pytest.raises(SimulationError, match="max_step"):
        make(overrides=changes)
    changes["run.integrator.max_step"] = "0.25 s"
    one, other = make(overrides=changes, threads=1), make(overrides=changes, threads=2)
    for simulation in (one, other):
        simulation.run()
        assert (simulation.time, simulation.series("load.pull").tolist()) == (2.0, [8.0])
    assert np.array_equal(one.positions, other.positions)
    assert make(seed=4).checkpoint() != make(seed=3).checkpoint()
    assert make(seed=3).checkpoint() == make().checkpoint()


def test_a_rule_of_ones_own_stops_it(two: Simulation) -> None:
    times = []

    def far(simulation: Simulation) -> str | None:
        assert simulation is two
        times.append(simulation.time)
        return "far" if simulation.series("position_x")[0] > -9.7 else None

    assert two.run(stop=far) == "far"
    assert 0 < two.time < two.end
    assert two.series("position_x")[0] > -9.7
    assert (len(times), times[-1]) == (two.steps, two.time)
    # It can go on from there, and the rule may look now and then.
    times.clear()
    two.run(10.0, stop=lambda s: times.append(s.time), every=2.0)
    assert two.time == 10.0
    assert [int(time / 2) for time in times] == list(range(int(times[0] / 2), 6))
    with pytest.raises(ValueError, match="above 0 s"):
        two.run(stop=far, every=0.0)


def test_a_rule_does_not_change_the_course() -> None:
    one, other = make(), make()
    one.run()
    other.run(stop=lambda simulation: simulation.positions.sum() > 1e9)
    assert one.steps == other.steps
    assert one.checkpoint() == other.checkpoint()


def test_what_a_rule_raises_comes_out_as_it_is(two: Simulation) -> None:
    raised = LookupError("own")

    def rule(simulation: Simulation) -> bool:
        if simulation.steps == 2:
            raise raised
        return False

    with pytest.raises(LookupError) as caught:
        two.run(stop=rule)
    assert caught.value is raised
    assert two.steps == 2
    two.run()
    assert two.time == two.end


def test_an_interrupt_ends_a_run_after_a_step(two: Simulation) -> None:
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    timer = threading.Timer(0.3, _thread.interrupt_main)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        two.run(until=float("inf"))
    timer.join()
    reached = two.time
    assert reached > 0
    two.step()
    assert two.time > reached


def test_other_threads_go_on_while_it_steps(two: Simulation) -> None:
    # With turns as long as these another thread runs only where this one lets it: within steps.
    counted, asked, done, turn = 0, [], threading.Event(), sys.getswitchinterval()

    def count() -> None:
        nonlocal counted
        while not done.is_set():
            counted += 1
            asked.append(two.time)
            time.sleep(0.0005)

    other, until = threading.Thread(target=count), time.monotonic() + 60
    sys.setswitchinterval(100.0)
    try:
        other.start()
        while counted < 5 and time.monotonic() < until:
            two.step()
    finally:
        sys.setswitchinterval(turn)
        done.set()
        other.join()
    assert counted >= 5
    assert asked == sorted(asked)


def test_threads_that_step_one_simulation_make_whole_steps(two: Simulation) -> None:
    threads = [threading.Thread(target=lambda: [two.step() for _ in range(10)]) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert two.steps == 40


def test_a_checkpoint_goes_on_to_the_same_bits(two: Simulation) -> None:
    two.set_force(1, [0.0, 3.0, 0.0])
    two.run_until(1.0)
    saved = two.checkpoint()
    two.run()
    end = two.checkpoint()
    for simulation in (two, make(threads=1)):
        simulation.restore(saved)
        assert simulation.time == 1.0
        simulation.run()
        assert simulation.checkpoint() == end
