"""blind(): experiments whose cause is withheld, diagnosed by another process, and scored."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

from . import _glidelab
from ._apart import interpreter
from ._checks import file_name, switch, text, whole
from ._inputs import PathLike, Progress, checked_seed, job_count, teller
from ._outside import Estimator, OutsideRuns, given_command, outside_runs
from ._results import Made, Result, frame_of, words_of
from ._shown import html_plot, html_table, new_axes

MOST_CASES = 100000


@dataclass(frozen=True)
class BlindTarget:
    """What a diagnosis should reach.

    Attributes
    ----------
    what : str
        In words.
    of, yes : int or None
        Cases that bear on it, and those that are as wanted; None for a target that is not a share.
    value : float or None
        The share, or the number; None without a case.
    at_least, at_most : float or None
        What is wanted.
    met : bool or None
        None if too few cases decide, or none bears on it.
    """

    what: str
    of: Optional[int]
    yes: Optional[int]
    value: Optional[float]
    at_least: Optional[float]
    at_most: Optional[float]
    met: Optional[bool]


@dataclass(frozen=True)
class BlindCase:
    """One experiment: what was in it, and what the diagnosis said.

    Attributes
    ----------
    case : int
        Its number, counted from 0.
    kind : str
        ``"none"``, ``"single"``, ``"pair"`` or ``"outside"``: how many causes, or one that is not on the list.
    causes : tuple of str
        Ids of what was put in.
    verdict : str
        ``"none"``, ``"effect"``, ``"unknown"``, or ``"failed"``.
    named : tuple of str
        Ids of what the verdict names.
    """

    case: int
    kind: str
    causes: tuple[str, ...]
    verdict: str
    named: tuple[str, ...]


@dataclass(frozen=True)
class BlindAnswers:
    """What an estimator of one's own said of one quantity in the cases of one class.

    Attributes
    ----------
    kind : str
        ``"one"``, ``"two"``, ``"dirt"`` (small imperfections alone) or ``"outside"``: what was in these cases.
    quantity : str
        ``k_over_m_1_s``, ``mu``, ``alpha_deg`` or ``v_lim_m_s``.
    true_values, answered, covered : int
        Configurations with a true value, those of them with an answer, and answers whose 95 % interval contains it.
    bias, rms_error : float or None
        Mean and root mean square of the errors, in the quantity's unit; None without an answer.
    """

    kind: str
    quantity: str
    true_values: int
    answered: int
    covered: int
    bias: Optional[float]
    rms_error: Optional[float]

    @property
    def coverage(self) -> Optional[float]:
        """The share of answers whose 95 % interval contains the true value."""
        return self.covered / self.answered if self.answered else None


@dataclass(frozen=True, eq=False, repr=False)
class Blind(Result):
    """How often diagnoses of withheld causes are right.

    Attributes
    ----------
    seed : int
        Of the cases.
    failed : int
        Cases that could not be diagnosed.
    targets : tuple of BlindTarget
        What a diagnosis should reach, and what it reached.
    calibration_error : float
        Mean difference between stated probabilities and how often they are right.
    cases : tuple of BlindCase
        All of them.
    folder : str
        Where experiments, diagnoses and truths lie.
    answers : tuple of BlindAnswers
        Of an estimator of your own, by class and quantity; empty without one.
    outside : OutsideRuns or None
        How its runs went.
    """

    seed: int
    failed: int
    targets: tuple[BlindTarget, ...]
    calibration_error: float
    cases: tuple[BlindCase, ...]
    folder: str
    answers: tuple[BlindAnswers, ...] = ()
    outside: Optional[OutsideRuns] = None

    def to_frame(self) -> Any:
        """A pandas.DataFrame, one row per case."""
        return frame_of({name: [getattr(one, name) for one in self.cases]
                         for name in ("case", "kind", "causes", "verdict", "named")})

    def plot(self) -> list[Any]:
        """The targets that are shares of cases, with what is wanted as dashes; and how many cases of each kind got each
        verdict.

        Returns
        -------
        list of matplotlib.axes.Axes
            The two.
        """
        shares, cases = new_axes(2)
        shown = [one for one in self.targets if one.of and one.value is not None]
        for number, one in enumerate(shown):
            shares.barh(number, 100.0 * (one.value or 0.0), color="C3" if one.met is False else "0.8")
            for limit in (one.at_least, one.at_most):
                if limit is not None:
                    shares.plot([100.0 * limit] * 2, [number - 0.4, number + 0.4], "k--", linewidth=1)
        shares.set_yticks(range(len(shown)), [f"{one.what} ({one.yes} of {one.of})" for one in shown], fontsize=7)
        shares.invert_yaxis()
        shares.set_xlim(0.0, 100.0)
        shares.set_xlabel("cases (%)")
        kinds, verdicts, counts = self._counted()
        most = max((count for of_kind in counts for count in of_kind), default=0)
        cases.imshow(counts, cmap="Blues", aspect="auto", vmin=0)
        for row, of_kind in enumerate(counts):
            for column, count in enumerate(of_kind):
                cases.text(column, row, str(count), ha="center", va="center",
                           color="white" if 2 * count > most else "black")
        cases.set_xticks(range(len(verdicts)), verdicts)
        cases.set_yticks(range(len(kinds)), kinds)
        cases.set_xlabel("verdict")
        cases.set_ylabel("what was put in")
        return [shares, cases]

    def _counted(self) -> tuple[list[str], list[str], list[list[int]]]:
        """Kinds, verdicts, and how many cases of each kind got each verdict."""
        kinds = _in_order({one.kind for one in self.cases}, ("none", "single", "pair", "outside"))
        verdicts = _in_order({one.verdict for one in self.cases}, ("none", "effect", "unknown", "failed"))
        return kinds, verdicts, [[sum((one.kind, one.verdict) == (kind, verdict) for one in self.cases)
                                  for verdict in verdicts] for kind in kinds]

    def _repr_html_(self) -> str:
        rows = [[one.what, _found_text(one), _wanted_text(one), _verdict_text(one)] for one in self.targets]
        kinds, verdicts, counts = self._counted()
        return (html_table(["", "found", "wanted", ""], rows, f"{len(self.cases)} blind cases, seed {self.seed}")
                + html_table(["put in", *(f"verdict {verdict}" for verdict in verdicts)],
                             [[kind, *map(str, of_kind)] for kind, of_kind in zip(kinds, counts)])
                + (html_table(["put in", "quantity", "answers", "mean error", "rms error", "95 % intervals that hold"],
                              [_answers_row(one) for one in self.answers], self.outside.name if self.outside else "")
                   if self.answers else "")
                + (html_plot(self.plot) if self.cases else ""))


def _answers_row(one: BlindAnswers) -> list[str]:
    def number(value: Optional[float]) -> str:
        return "" if value is None else f"{value:.3g}"

    return [one.kind, words_of(one.quantity), f"{one.answered} of {one.true_values}", number(one.bias), number(one.rms_error),
            f"{one.covered} of {one.answered}"]


def _in_order(found: set[str], order: Sequence[str]) -> list[str]:
    return [one for one in order if one in found] + sorted(found - set(order))


def _found_text(target: BlindTarget) -> str:
    if target.value is None:
        return ""
    return f"{target.value:.3g}" if not target.of else f"{100.0 * target.value:.0f} % ({target.yes} of {target.of})"


def _verdict_text(target: BlindTarget) -> str:
    if target.met is None:
        return "" if target.value is None else "open"
    return "met" if target.met else "missed"


def _wanted_text(target: BlindTarget) -> str:
    return " and ".join(f"{words} {limit:g}" for words, limit in (("at least", target.at_least),
                                                                  ("at most", target.at_most)) if limit is not None)


def _target(found: Mapping[str, Any]) -> BlindTarget:
    of, yes = found.get("of"), found.get("yes")
    value = found.get("value", yes / of if of and yes is not None else None)
    return BlindTarget(found["what"], of, yes, value, found.get("at_least"), found.get("at_most"), found.get("met"))


def _answers(found: Mapping[str, Any]) -> tuple[BlindAnswers, ...]:
    return tuple(
        BlindAnswers(kind, quantity, one["answered"]["of"], one["answered"]["yes"], one["covered"]["yes"],
                     one["error"].get("mean"), one["error"].get("rms"))
        for kind, quantities in found.get("everyday", {}).get("answers", {}).items() for quantity, one in quantities.items())


def blind(cases: int, folder: PathLike, *, only: str = "", everyday: bool = False, pictures: bool = False,
          leave_out: bool = False, estimator_command: Union[str, Estimator, None] = None, estimator_name: str = "",
          estimator_seconds: float = 60.0, estimator_megabytes: float = 4096.0, seed: int = 1,
          jobs: Optional[int] = None, progress: Progress = None) -> Blind:
    """Makes experiments whose cause is withheld, has another process diagnose each, and scores the diagnoses.

    Parameters
    ----------
    cases : int
        How many, 1 to 100000. Called again with the same folder and more cases, it resumes where it stopped.
    folder : str or path
        Where experiments, diagnoses and truths lie or are made.
    only : str
        An effect (docs/reference/effects.md) that every case has; without it none, one, two, or one that is not on the
        list.
    everyday : bool
        Tracks as students record them: causes as above, and three to five small imperfections.
    pictures : bool
        Rendered clips instead of tracks.
    leave_out : bool
        Diagnose each case of one effect again with that effect taken off the list.
    estimator_command, estimator_name, estimator_seconds, estimator_megabytes
        As in `validate`: with ``everyday=True`` an estimator of your own answers the same cases. It finds values and names
        no cause, so that its errors and its intervals are scored beside the values that the diagnosis recovers. It answers
        all cases anew at each call; the diagnoses in the folder are kept.
    seed : int
        Of the cases.
    jobs, progress
        As in `analyze`; jobs are cases at a time.

    Returns
    -------
    Blind
        As ``glidelab blind`` writes it. Missed targets raise no exception.

    Raises
    ------
    InputError
        Choices that exclude each other, an unknown effect, a folder of another run, or an estimator without
        ``everyday=True``.
    SystemFailure
        The folder cannot be written.

    Notes
    -----
    Each case is diagnosed by an interpreter of its own, started with the name of the experiment folder and nothing else;
    the truth is written afterwards. docs/evidence/blind-tracks.md has what a large run says.
    """
    where = file_name("folder", folder, "the name of a folder")
    with given_command(estimator_command, estimator_name, estimator_seconds, estimator_megabytes) as given:
        made = Made(_glidelab.blind(interpreter(), where, whole("cases", cases, 1, MOST_CASES), checked_seed(seed) or 0,
                                    text("only", only, "the id of an effect"), switch("everyday", everyday),
                                    switch("pictures", pictures), switch("leave_out", leave_out), given.command,
                                    job_count(jobs), teller(progress)))
    found = Result(made).to_dict()
    return Blind(made, found["seed"], found["failed"], tuple(_target(one) for one in found["targets"]),
                 found["expected_calibration_error"], tuple(
                     BlindCase(one["case"], one["kind"], tuple(cause["id"] for cause in one["truth"]), one["verdict"],
                               tuple(cause["id"] for cause in one["named"])) for one in found["outcomes"]),
                 os.fspath(folder), _answers(found), outside_runs(found, given.calls_s))
