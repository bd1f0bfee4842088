"""What functions of this package raise; each is a subclass of the nearest exception of Python's own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Issue:
    """One thing that is wrong with an input.

    Attributes
    ----------
    file : str
        The file as it was named, or the track of arrays (``track "up"``); empty where it is neither.
    line : int
        Counted from 1; 0 where there is none.
    key : str
        ``"camera.frame_rate_hz"``, ``"x_m[3]"``; empty where there is none.
    found : str
        What stands there.
    expected : str
        What is allowed there.
    """

    file: str
    line: int
    key: str
    found: str
    expected: str


_ARGUMENTS = {"--target": "targets", "--mass": "mass_kg", "--masses": "masses_kg", "--incline": "incline_deg",
              "--out": "folder"}  # the others are called as their options are


def _argument(key: str) -> str:
    """"estimator_command" for "--estimator-command"; several are separated by commas."""
    if not key.startswith("--"):
        return key
    return ", ".join(_ARGUMENTS.get(one, one[2:].replace("-", "_")) for one in key.split(", "))


class Error(Exception):
    """The base of all that follow."""


class InputError(Error, ValueError):
    """The input is wrong. Everything that is wrong with it is reported at once.

    Attributes
    ----------
    issues : tuple of Issue
        Everything that was found. `file`, `line`, `key`, `found` and `expected` are those of the first.
    """

    def __init__(self, message: str, issues: Sequence[tuple[str, int, str, str, str]]) -> None:
        for key in {issue[2] for issue in issues}:
            if key.startswith("--"):  # what a room calls by the command's option is an argument here
                message = message.replace(f"{key}: found", f"{_argument(key)}: found")
        super().__init__(message)
        self.issues: tuple[Issue, ...] = tuple(
            Issue(file, line, _argument(key), found, expected) for file, line, key, found, expected in issues)

    def __reduce__(self) -> tuple[type[InputError], tuple[str, list[tuple[str, int, str, str, str]]]]:
        issues = [(one.file, one.line, one.key, one.found, one.expected) for one in self.issues]
        return InputError, (str(self), issues)

    @property
    def file(self) -> str:
        """Of the first issue."""
        return self.issues[0].file

    @property
    def line(self) -> int:
        """Of the first issue."""
        return self.issues[0].line

    @property
    def key(self) -> str:
        """Of the first issue."""
        return self.issues[0].key

    @property
    def found(self) -> str:
        """Of the first issue."""
        return self.issues[0].found

    @property
    def expected(self) -> str:
        """Of the first issue."""
        return self.issues[0].expected


def _described(issue: tuple[str, int, str, str, str]) -> str:
    file, _, key, found, expected = issue
    where = f"{file}: {key}" if file and key else file or key
    return f"{where}: found {found}, expected {expected}" if where else f"found {found}, expected {expected}"


_MOST_LINES = 20  # of a message, as of the program's


def input_errors(issues: Sequence[tuple[str, int, str, str, str]]) -> InputError:
    """An InputError with these issues, in the words that the C++ rooms use."""
    lines = [_described(issue) for issue in issues[:_MOST_LINES]]
    if len(issues) > _MOST_LINES:
        lines.append(f"and {len(issues) - _MOST_LINES} more")
    return InputError("\n".join(lines), issues)


def input_error(key: str, found: str, expected: str, file: str = "") -> InputError:
    """The same with one issue."""
    return input_errors([(file, 0, key, found, expected)])


class NumericalError(Error, ArithmeticError):
    """A solver broke down; the message gives time, step and tolerance."""


class SystemFailure(Error, OSError):
    """The disk is full, a file cannot be written, a codec or a program is missing."""


class NotMet(Error, RuntimeError):
    """What was asked to hold does not."""
