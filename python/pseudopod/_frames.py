"""Where the rows of a frame lie in the arrays of a result."""

from __future__ import annotations

import operator
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from ._file import ResultFile

Integers = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]


class Frames:
    """The recorded instants of a result, and the rows that each has."""

    def __init__(self, file: ResultFile) -> None:
        self.file = file
        # Most of a file comes with its first frame.
        begun = file.has("/VTKHDF/Points")
        self.times: Floats = file.read("/time").astype(np.float64) if begun else np.zeros(0)

    def __len__(self) -> int:
        return len(self.times)

    def need(self) -> None:
        """Complains about a run that has not recorded a frame yet."""
        if len(self) == 0:
            raise self.file.lacks("frame yet", "call refresh() when its run has recorded one")

    def number(self, frame: int, time: float | None) -> int:
        """The number of a frame, which may be counted from the end; or of the one nearest to a time (s)."""
        self.need()
        if time is not None:
            return int(np.abs(self.times - float(time)).argmin())
        wanted = operator.index(frame)
        if not -len(self) <= wanted < len(self):
            raise IndexError(f"frame {wanted} of {len(self)}: give a number from {-len(self)} to {len(self) - 1}")
        return wanted % len(self)

    def numbers(self, frames: slice | None) -> Integers:
        """The numbers of some frames, or of all."""
        every = np.arange(len(self))
        return every if frames is None else every[frames]

    @cached_property
    def steps(self) -> Integers:
        self.need()
        return self.file.read("/step").astype(np.int64)

    @cached_property
    def interpolated(self) -> npt.NDArray[np.bool_]:
        # Files of versions whose frames were where steps ended do not say so.
        self.need()
        if not self.file.has("/interpolated"):
            return np.zeros(len(self), dtype=np.bool_)
        return self.file.read("/interpolated").astype(np.bool_)

    @cached_property
    def first(self) -> Integers:
        return self._of_frames("/cells/first")

    @cached_property
    def count(self) -> Integers:
        return self._of_frames("/cells/count")

    def _of_frames(self, path: str) -> Integers:
        found = self.file.read(path).astype(np.int64)
        if len(found) != len(self) or (len(found) > 0 and found.min() < 0):
            raise self.file.damaged(path, f"{len(found)} entries for {len(self)} frames, or some below 0")
        return found

    def of_cells(self, numbers: Integers) -> tuple[Integers, Integers]:
        """Rows of the cells of some frames, and the frame of each row."""
        counts = self.count[numbers]
        frame = np.repeat(numbers, counts)
        begins = np.cumsum(counts) - counts
        return np.repeat(self.first[numbers] - begins, counts) + np.arange(len(frame)), frame

    def of_list(self, counter: str, numbers: Integers) -> tuple[Integers, Integers]:
        """Rows of some frames in a list whose counter says where the rows of a frame end, and the frame of each row."""
        ends = self._of_frames(counter)
        begins = np.concatenate([[0], ends[:-1]]).astype(np.int64)
        counts = (ends - begins)[numbers]
        if (counts < 0).any():
            raise self.file.damaged(counter, "it falls")
        frame = np.repeat(numbers, counts)
        before = np.cumsum(counts) - counts
        return np.repeat(begins[numbers] - before, counts) + np.arange(len(frame)), frame

    def take(self, path: str, rows: Integers) -> npt.NDArray[Any]:
        """Rows of a dataset, read in one piece."""
        if len(rows) == 0:
            return self.file.rows(path, 0, 0)
        low, high = int(rows.min()), int(rows.max()) + 1
        found = self.file.rows(path, low, high)
        return found if len(found) == len(rows) and (np.diff(rows) == 1).all() else found[rows - low]

    @cached_property
    def part(self) -> Integers:
        """The population of each frame: frames with the same one have the same cells and share their facets."""
        return self._of_frames("/VTKHDF/Steps/PartOffsets")
