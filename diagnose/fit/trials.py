"""The one place where a trial is evaluated: an answer, or a rejection by one exception, whatever went wrong.

A trial may lie where a law turns over, where no press was made, or where a number leaves all bounds. None of that ends
a search, a fit, an interval or the choice of the next press: all of them see NoAnswerError and go elsewhere.
"""

from collections import OrderedDict
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np

from diagnose.engines.passing_on import DelegatingEngine
from diagnose.forward import Candidate, Engine, NoAnswerError, Setting, Signals
from diagnose.signals.recording import Run
from foundation.progress import Report
from solve.solution.errors import NoEquilibriumError

MOST_REMEMBERED = 2000  # predictions of one run


@contextmanager
def rejected() -> Iterator[None]:
    """Turn whatever a trial fails with into NoAnswerError."""
    try:
        yield
    except NoAnswerError:
        raise
    except (ValueError, ArithmeticError, NoEquilibriumError) as error:
        raise NoAnswerError(str(error)) from error


class Trials(DelegatingEngine):
    """An engine as fits ask it: its last answers are remembered, rejections too, until it solves anew."""

    def __init__(self, engine: Engine, runs: Sequence[Run]) -> None:
        super().__init__(engine)
        self._runs = tuple(runs)
        self._known: OrderedDict[tuple[object, ...], Signals | NoAnswerError] = OrderedDict()

    def prepare(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Prepare the engine; what it said before may be better now."""
        super().prepare(candidates, report)
        self._forget()

    def prepare_roughly(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Prepare the engine roughly; what it said before may be better now."""
        super().prepare_roughly(candidates, report)
        self._forget()

    def refine(self, settings: Sequence[Setting], report: Report) -> Sequence[Setting]:
        """Refine the engine; what it said before may be better now."""
        changed = super().refine(settings, report)
        self._forget()
        return changed

    def _forget(self) -> None:
        if not self.solves_outright:
            self._known.clear()

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """Every answer of a run. NoAnswerError."""
        on = [s for s in settings if any(s.values)]
        key = (run, *((s.candidate.name, s.values) for s in on))
        if key not in self._known:
            self._known[key] = self._tried(run, on)
            if len(self._known) > MOST_REMEMBERED:
                self._known.popitem(last=False)
        self._known.move_to_end(key)
        found = self._known[key]
        if isinstance(found, NoAnswerError):
            raise NoAnswerError(str(found))
        return found

    def _tried(self, run: int, on: Sequence[Setting]) -> Signals | NoAnswerError:
        try:
            with rejected():
                return _checked(self._runs[run], super().predict(run, on))
        except NoAnswerError as error:
            return error

    def imagine(self, run: Run, settings: Sequence[Setting]) -> Signals:
        """Every answer of a run that was not made. NoAnswerError."""
        with rejected():
            return super().imagine(run, settings)


def _checked(run: Run, signals: Signals) -> Signals:
    """Signals that are numbers wherever the run has some. NoAnswerError."""
    for name in run.answers:
        if not np.isfinite(signals[name][np.isfinite(run.channels[name])]).all():
            raise NoAnswerError(f"run '{run.label}', {name}: the answer is beyond all numbers")
    return signals
