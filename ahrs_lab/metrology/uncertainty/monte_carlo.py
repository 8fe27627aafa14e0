"""Propagation of distributions by Monte Carlo (JCGM 101): vectorised, in blocks, adaptive, repeatable by its
seed; and the test of a GUM interval against it (clause 8).

Each block draws from a stream of its own, spawned from the seed, so that any number of threads gives the same
numbers. All values are kept, because the ends of an interval are order statistics of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from decimal import Decimal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.result import MonteCarloCheck
from ahrs_lab.metrology.uncertainty.distributions import Input, Joint, StudentT

Array = NDArray[np.float64]
Model = Callable[[Array], Array]
"""Input quantities, shape (inputs, trials), to the output quantity, shape (trials,); pure, for threads."""

PROBABILITY = 0.95
BLOCK = 10_000
"""Trials of a block, the M of 7.9.4 b): it fits into a core's cache, and holds 250 trials beyond each end."""
MAXIMAL_TRIALS = 10_000_000
"""All values are kept to find the interval's ends: 80 MB."""
SAFETY = 5.0
"""For a validation the ends have to be stable to δ/5 (8.2)."""
THREADS = 2
_AHEAD = 4
"""Blocks begun before it is known whether they are needed."""
_BINS, _BINS_REACH = 60, 4.0
_NO_VARIANCE = 2.0
"""Degrees of freedom up to which a t has no variance."""


@dataclass(frozen=True)
class Propagated:
    """What the trials say of the output quantity. ``values``, shape (trials,), in ascending order.

    ``stable``: the adaptive procedure ended by itself, not by its limit; True for a fixed number of trials.
    ``finite``: the output has a standard uncertainty. Without one ``standard`` is that of these trials alone
    and grows with their number.
    """

    seed: int
    values: Array
    mean: float
    standard: float
    symmetric: tuple[float, float]
    shortest: tuple[float, float]
    stable: bool
    finite: bool = True

    @property
    def trials(self) -> int:
        return len(self.values)


def propagate(
    inputs: Sequence[Input],
    model: Model,
    *,
    seed: int,
    trials: int | None = None,
    digits: int = 2,
    tolerance: float | None = None,
    most: int = MAXIMAL_TRIALS,
    safety: float = SAFETY,
    probability: float = PROBABILITY,
    threads: int = THREADS,
) -> Propagated:
    """Mean, standard uncertainty and both coverage intervals of ``model`` (7.6, 7.7).

    ``trials`` None: adaptive (7.9.4), until mean, standard uncertainty and both ends of the interval are
    stable to δ/``safety``, or ``most`` trials are made. δ is ``tolerance``, else that of ``digits``
    significant digits of the trials' own u. Where an input is a t of two or fewer degrees of freedom, only
    the ends have to be stable: mean and u are not. Raises InputError for a number of trials out of bounds and
    where the model gives no finite number.
    """
    check_trials(most if trials is None else trials)
    size = sum(entry.size for entry in inputs)
    finite = not any(isinstance(entry, StudentT | Joint) and entry.dof <= _NO_VARIANCE for entry in inputs)

    def block(index: int, count: int) -> Array:
        stream = np.random.SeedSequence(seed, spawn_key=(index,))
        generator = np.random.Generator(np.random.SFC64(stream))
        drawn = np.empty((size, count))
        first = 0
        for entry in inputs:
            entry.fill(generator, drawn[first : first + entry.size])
            first += entry.size
        return model(drawn)

    total = most if trials is None else trials
    stop = None if trials is not None else _Stability(digits, tolerance, safety, probability, finite)
    kept, stable = [], trials is not None
    for values in _in_order(block, total, threads):
        kept.append(values)
        if stop is not None and stop.reached(values):
            stable = True
            break
    return _summary(np.concatenate(kept), seed, probability, stable, finite)


def check_trials(trials: int) -> None:
    """Raises InputError for a number of trials that is too small to hold an interval or too large to keep."""
    if not BLOCK <= trials <= MAXIMAL_TRIALS:
        raise InputError(
            "{trials} Monte Carlo trials cannot be made: at least {fewest}, so that enough of them lie "
            "beyond the ends of a 95 % interval, and at most {most}, because all of them are kept in memory.",
            trials=trials,
            fewest=BLOCK,
            most=MAXIMAL_TRIALS,
        )


def _in_order(block: Callable[[int, int], Array], total: int, threads: int) -> Iterator[Array]:
    """The blocks of ``total`` trials, in order; some are made ahead."""
    counts = [BLOCK] * (total // BLOCK) + ([total % BLOCK] if total % BLOCK else [])
    if threads == 1:
        yield from (block(index, count) for index, count in enumerate(counts))
        return
    with ThreadPoolExecutor(threads) as pool:
        ahead = [pool.submit(block, index, count) for index, count in enumerate(counts[:_AHEAD])]
        try:
            for index in range(len(counts)):
                values = ahead.pop(0).result()
                if index + _AHEAD < len(counts):
                    ahead.append(pool.submit(block, index + _AHEAD, counts[index + _AHEAD]))
                yield values
        finally:
            pool.shutdown(cancel_futures=True)


class _Stability:
    """7.9.4 e) to i): the scatter of the blocks' own results says how well their average is known."""

    def __init__(
        self, digits: int, tolerance: float | None, safety: float, probability: float, finite: bool
    ) -> None:
        self._digits, self._tolerance, self._safety = digits, tolerance, safety
        self._probability, self._finite = probability, finite
        self._results: list[tuple[float, float, float, float]] = []

    def reached(self, values: Array) -> bool:
        """Whether, with this block, all four results are stable; without a finite u the ends alone."""
        ends = _symmetric_places(len(values), self._probability)
        low, high = np.partition(values, ends)[list(ends)]  # what sorting would put there
        self._results.append((float(values.mean()), float(values.std(ddof=1)), low, high))
        count = len(self._results)
        if count < 2:
            return False
        results = np.array(self._results)
        scatter = results.std(axis=0, ddof=1) / math.sqrt(count)
        tolerance = self._tolerance
        if tolerance is None:
            tolerance = numerical_tolerance(float(np.sqrt(np.mean(results[:, 1] ** 2))), self._digits)
        judged = scatter if self._finite else scatter[2:]
        return bool(np.all(2.0 * judged <= tolerance / self._safety))


def numerical_tolerance(standard: float, digits: int) -> float:
    """δ = ½·10^l of u = c·10^l, c of ``digits`` digits (7.9.2); 0 for u = 0.

    The first digit is that of u before rounding: 9.7 rounded to 1·10¹ would make δ half of u.
    """
    if standard == 0.0:
        return 0.0
    return 0.5 * 10.0 ** (Decimal(repr(standard)).adjusted() - digits + 1)


def symmetric_interval(ordered: Array, probability: float = PROBABILITY) -> tuple[float, float]:
    """The probabilistically symmetric coverage interval (7.7.2) of ``ordered`` values, shape (trials,)."""
    first, last = _symmetric_places(len(ordered), probability)
    return float(ordered[first]), float(ordered[last])


def _symmetric_places(count: int, probability: float) -> tuple[int, int]:
    inside = math.floor(probability * count + 0.5)
    first = max(0, (count - inside + 1) // 2 - 1)
    return first, min(first + inside, count - 1)


def shortest_interval(ordered: Array, probability: float = PROBABILITY) -> tuple[float, float]:
    """The shortest coverage interval (7.7.4) of ``ordered`` values, shape (trials,)."""
    inside = min(math.floor(probability * len(ordered) + 0.5), len(ordered) - 1)
    low, high = ordered[: len(ordered) - inside], ordered[inside:]
    best = int(np.argmin(high - low))
    return float(low[best]), float(high[best])


def _summary(values: Array, seed: int, probability: float, stable: bool, finite: bool) -> Propagated:
    bad = len(values) - int(np.isfinite(values).sum())
    if bad:
        raise InputError(
            "The model gives no finite number in {bad} of {trials} Monte Carlo trials: check the estimates "
            "and the widths of its inputs.",
            bad=bad,
            trials=len(values),
        )
    values.sort()
    return Propagated(
        seed=seed,
        values=values,
        mean=float(values.mean()),
        standard=float(values.std(ddof=1)),
        symmetric=symmetric_interval(values, probability),
        shortest=shortest_interval(values, probability),
        stable=stable,
        finite=finite,
    )


def validate(found: Propagated, low: float, high: float, *, standard: float, digits: int) -> MonteCarloCheck:
    """The test of clause 8: whether both ends of the GUM interval lie within δ of the symmetric one's.

    δ is of the GUM's own ``standard``, which is what the clause tests, never of the trials'.
    """
    tolerance = numerical_tolerance(standard, digits)
    off = max(abs(low - found.symmetric[0]), abs(high - found.symmetric[1]))
    rounding = 8.0 * math.ulp(max(abs(low), abs(high)))
    bins, counts = _histogram(found)
    return MonteCarloCheck(
        trials=found.trials,
        seed=found.seed,
        mean=found.mean,
        standard=found.standard if found.finite else None,
        symmetric=found.symmetric,
        shortest=found.shortest,
        digits=digits,
        tolerance=tolerance,
        validated=off <= max(tolerance, rounding),
        bins=bins,
        counts=counts,
        gum_expanded=0.5 * (high - low),
    )


def _histogram(found: Propagated) -> tuple[tuple[float, float], tuple[int, ...]]:
    """Counts over the mean ± 4 u, without a finite u about twice the symmetric interval; a t with few degrees
    of freedom would spread over nothing."""
    middle, reach = found.mean, _BINS_REACH * found.standard
    if not found.finite:
        middle, reach = sum(found.symmetric) / 2.0, found.symmetric[1] - found.symmetric[0]
    low, high = middle - reach, middle + reach
    if not low < high:
        return (low, high), ()
    place = (found.values - low) * (_BINS / (high - low)) + 1.0
    np.clip(place, 0.0, _BINS + 1.0, out=place)
    counts = np.bincount(place.astype(np.intp), minlength=_BINS + 2)
    return (low, high), tuple(counts[1:-1].tolist())
