"""How a run tells where it is: with a bar of tqdm where that is installed, in plain lines elsewhere."""

from __future__ import annotations

import re
import sys
from types import TracebackType
from typing import Any

#: What the program says every few seconds.
_LINE = re.compile(
    r"(?:pseudopod: )?t = (?P<time>[-+.0-9eE]+) of (?P<until>[-+.0-9eE]+) s, (?P<steps>\d+) steps(?P<rest>.*)"
)

#: What it says before the first step of a crowded scene.
_START = ("looking whether cells overlap", "pushing cells apart,")


class Progress:
    """Passes on what a run says of where it is.

    Parameters
    ----------
    shown
        Whether anything is told at all.
    name
        What stands before the bar.
    """

    def __init__(self, shown: bool, name: str) -> None:
        self._shown = shown
        self._name = name
        self._bar: Any = None

    def __enter__(self) -> Progress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            if kind is None:
                self._bar.n = self._bar.total
                self._bar.refresh()
            self._bar.close()

    def line(self, text: str) -> bool:
        """Takes a line; whether it was one of progress."""
        text = text.strip()
        found = _LINE.fullmatch(text)
        if found is None and not text.startswith(_START):
            return False
        at = None if found is None else (float(found["time"]), float(found["until"]), f"{found['steps']} steps")
        if self._shown and (at is None or not self._advance(*at)):
            self.say(text)
        return True

    def say(self, text: str) -> None:
        """Prints a line."""
        if self._shown:
            print(f"{self._name}: {text}", file=sys.stderr, flush=True)

    def _advance(self, time: float, until: float, what: str) -> bool:
        if self._bar is None:
            try:
                from tqdm.auto import tqdm
            except ImportError:
                return False
            form = (
                "{desc}: {percentage:3.0f} %|{bar}| {n:.4g}/{total:.4g} s of its time [{elapsed}<{remaining}{postfix}]"
            )
            self._bar = tqdm(total=until, desc=self._name, bar_format=form, leave=True)
        self._bar.set_postfix_str(what, refresh=False)
        self._bar.n = time
        self._bar.refresh()
        return True
