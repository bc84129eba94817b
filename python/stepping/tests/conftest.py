"""What the tests share."""

from __future__ import annotations

import pytest
from two_cells import make

from pseudopod_stepping import Simulation


@pytest.fixture
def two() -> Simulation:
    return make()
