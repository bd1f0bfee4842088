"""A dict as the text of a TOML file (https://toml.io/en/v1.0.0): what a scenario or a sweep may hold."""

from __future__ import annotations

import json
import numbers
import os
import re
from collections.abc import Mapping, Sequence
from typing import Any

from ._errors import input_error

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def _key(key: object, path: str) -> str:
    if not isinstance(key, str):
        raise input_error(path, f"a key of type {type(key).__name__}", "text", "scenario")
    # A JSON string without surrogates is a basic string of TOML; TOML also wants DEL escaped.
    return key if _BARE.fullmatch(key) else _text(key)


def _text(value: str) -> str:
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: object, path: str) -> str:
    if hasattr(value, "item") and not isinstance(value, (str, bytes)) and getattr(value, "ndim", None) == 0:
        value = value.item()  # a number of numpy's
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return repr(float(value))  # the shortest text that reads back as the same number; "inf" and "nan" are TOML's
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, os.PathLike):
        return _text(os.fspath(value))
    if isinstance(value, Mapping):
        inside = ", ".join(f"{_key(k, path)} = {_value(v, f'{path}.{k}')}" for k, v in value.items())
        return "{" + inside + "}"
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        return "[" + ", ".join(_value(one, f"{path}[{i}]") for i, one in enumerate(value)) + "]"
    raise input_error(path, f"a value of type {type(value).__name__}", "a number, a switch, a string, a list or a dict",
                      "scenario")


def _is_tables(value: object) -> bool:
    return isinstance(value, Sequence) and len(value) > 0 and all(isinstance(one, Mapping) for one in value)


def _lines(table: Mapping[str, Any], path: str, lines: list[str]) -> None:
    def name_of(key: str) -> str:
        return f"{path}.{_key(key, path)}" if path else _key(key, path)

    for key, value in table.items():
        if not isinstance(value, Mapping) and not _is_tables(value):
            lines.append(f"{_key(key, path)} = {_value(value, f'{path}.{key}' if path else str(key))}")
    for key, value in table.items():
        if isinstance(value, Mapping):
            lines.append(f"\n[{name_of(key)}]")
            _lines(value, name_of(key), lines)
        elif _is_tables(value):
            for one in value:
                lines.append(f"\n[[{name_of(key)}]]")
                _lines(one, name_of(key), lines)


def toml_text(table: Mapping[str, Any]) -> str:
    """`table` as TOML. Reading it gives an equal table: numbers keep every bit, and the kinds of their values.

    Raises
    ------
    InputError
        A key that is no text, or a value that TOML does not have (None among them).
    """
    lines: list[str] = []
    _lines(table, "", lines)
    return "\n".join(lines) + "\n"
