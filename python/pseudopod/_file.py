"""The HDF5 file of a result: opened without a lock, looked into with care."""

from __future__ import annotations

import os
from typing import Any

import h5py
import numpy as np
import numpy.typing as npt

from ._errors import ResultError

#: The format of results that is read (attribute ``pseudopod_format``).
FORMAT = 2

#: What HDF5 raises for bytes that are not as they should be.
FAILURES = (OSError, KeyError, RuntimeError, ValueError, TypeError, MemoryError)


class ResultFile:
    """An open result file.

    The program never writes into a file that others see: it puts whole new versions in its place. So what is open
    stays as it was when it was opened, and :meth:`reopen` shows the version that there is then.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = os.path.abspath(os.fspath(path))
        self._file: h5py.File | None = None
        self.reopen()

    @property
    def is_open(self) -> bool:
        return self._file is not None

    def close(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None

    def reopen(self) -> None:
        """Opens the version that lies at the path now."""
        if not os.path.exists(self.path):
            begun = os.path.exists(self.path + ".frames")
            more = ": its run has begun and has not recorded a frame yet" if begun else ""
            raise FileNotFoundError(f"{self.path} does not exist{more}")
        try:
            file = self._opened()
        except FAILURES as error:
            raise self._unreadable(error) from error
        try:
            found = file.attrs.get("pseudopod_format")
        except FAILURES as error:
            file.close()
            raise self.damaged("/", error) from error
        if found is None:
            file.close()
            raise ResultError(
                self.path, "an HDF5 file, but not a result of pseudopod", "open a file that `pseudopod run` made"
            )
        if found != FORMAT:
            file.close()
            help = "read it with the version that wrote it, or run its experiment again"
            raise ResultError(self.path, f"its format is {found}, and this package reads format {FORMAT}", help)
        self.close()
        self._file = file

    def _opened(self) -> h5py.File:
        """With the lock that is usual, so that others in this process open it as well; without one where it is refused.

        Nobody writes into the file, so that a lock is of no use, and some network drives have none.
        """
        try:
            return h5py.File(self.path, "r")
        except OSError as error:
            if "lock" not in str(error):
                raise
            return h5py.File(self.path, "r", locking=False)

    def _unreadable(self, error: BaseException) -> ResultError:
        if isinstance(error, PermissionError):
            return ResultError(self.path, "may not be read", "ask whoever owns it for the permission")
        if os.path.isdir(self.path):
            return ResultError(self.path, "is a folder", "name the result file in it, which ends in .vtkhdf or .h5")
        if not h5py.is_hdf5(self.path):
            return ResultError(self.path, "is not an HDF5 file", "open a file that `pseudopod run` made")
        return ResultError(self.path, f"is damaged: {error}", "take it from a backup, or run its experiment again")

    def damaged(self, where: str, why: object) -> ResultError:
        """The error for what cannot be right."""
        command = f"`pseudopod info {os.path.basename(self.path)}`"
        help = f"see what {command} says; take it from a backup, or run its experiment again"
        return ResultError(self.path, f"is damaged at {where}: {why}", help)

    def lacks(self, what: str, help: str) -> ResultError:
        """The error for what a sound file may well not hold."""
        return ResultError(self.path, f"holds no {what}", help)

    def _item(self, path: str) -> Any:
        if self._file is None:
            raise ResultError(self.path, "was closed", "open it again with pseudopod.open, or call refresh()")
        item: Any = self._file
        # Part by part: a link to another file is never followed.
        for part in path.strip("/").split("/"):
            try:
                link = item.get(part, getlink=True) if part in item else None
                if link is None:
                    return None
                if not isinstance(link, h5py.HardLink):
                    raise self.damaged(path, "it is a link, and results hold none")
                item = item[part]
            except FAILURES as error:
                raise self.damaged(path, error) from error
        return item

    def has(self, path: str) -> bool:
        """Whether there is a dataset or a group at a path."""
        return self._item(path) is not None

    def dataset(self, path: str) -> Any:
        """The dataset at a path that every result has."""
        item = self._item(path)
        if not isinstance(item, h5py.Dataset):
            raise self.damaged(path, "the dataset is missing")
        if item.external:
            raise self.damaged(path, "its numbers lie in another file")
        return item

    def length(self, path: str) -> int:
        """Rows of a dataset."""
        dataset = self.dataset(path)
        return int(dataset.shape[0]) if dataset.ndim > 0 else 1

    def read(self, path: str, selection: Any = ()) -> npt.NDArray[Any]:
        """Numbers of a dataset: all, or those of a selection."""
        dataset = self.dataset(path)
        try:
            return np.asarray(dataset[selection])
        except FAILURES as error:
            raise self.damaged(path, error) from error

    def rows(self, path: str, start: int, stop: int) -> npt.NDArray[Any]:
        """The rows of a dataset from one to another; it must have them."""
        if not 0 <= start <= stop <= self.length(path):
            raise self.damaged(path, f"rows {start} to {stop} of {self.length(path)} are asked for")
        return self.read(path, slice(start, stop))

    def texts(self, path: str) -> list[str]:
        """Texts of a dataset, one or many."""
        try:
            found = np.atleast_1d(self.dataset(path).asstr()[()])
            return [str(text) for text in found]
        except FAILURES as error:
            raise self.damaged(path, error) from error

    def names(self, path: str) -> list[str]:
        """Names in a group in the order of the program; none where there is no such group."""
        group = self._item(path)
        if not isinstance(group, h5py.Group):
            return []
        try:
            return sorted(group, key=lambda name: (int(group[name].attrs.get("order", 0)), name))
        except FAILURES as error:
            raise self.damaged(path, error) from error

    def attribute(self, path: str, name: str, default: Any = None) -> Any:
        """An attribute, as a Python text or number or as an array."""
        item = self._item(path)
        try:
            value = default if item is None else item.attrs.get(name, default)
        except FAILURES as error:
            raise self.damaged(f"{path}, attribute {name}", error) from error
        if isinstance(value, bytes):
            return value.decode("utf-8", "replace")
        return value.item() if isinstance(value, np.generic) else value

    def unit(self, path: str) -> str:
        """The unit of a dataset, ``1`` for pure numbers."""
        return str(self.attribute(path, "unit", "1"))

    def description(self, path: str) -> str:
        """What the numbers of a dataset mean."""
        return str(self.attribute(path, "description", ""))
