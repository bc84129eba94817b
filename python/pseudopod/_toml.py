"""Values of a document as TOML has them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any


def toml(value: Any) -> str:
    """A value as TOML has it: texts in quotes, numbers with all their digits."""
    if hasattr(value, "tolist") and not isinstance(value, str):
        value = value.tolist()  # numbers and arrays of NumPy
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value).replace("e+", "e")
    if isinstance(value, str):
        # JSON escapes a little more than TOML has to, and nothing that TOML does not know; but surrogates.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{json.dumps(str(key))} = {toml(entry)}" for key, entry in value.items()) + " }"
    if isinstance(value, Sequence):
        return "[" + ", ".join(toml(entry) for entry in value) + "]"
    raise TypeError(
        f"a document has no value like {value!r}: give a text with its unit, a number, a truth, or a list of these"
    )
