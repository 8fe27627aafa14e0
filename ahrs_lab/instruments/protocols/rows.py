"""From columns of single kinds of frames to the samples of the stream.

Devices spread a sample over frames: rates in one, attitude in another at a lower rate, temperature now and
then, the time in a packet of its own. A row is made of each frame of the best kind the stream has (raw
rates, else filtered rates, else attitude, else heading); what other kinds last said is carried into it. Time
is never carried twice: a row whose time was lost is dropped and counted as untimed.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.protocols.frames import LinkCounts
from ahrs_lab.recording.samples import GYRO, Samples

Array = NDArray[np.float64]
TimeSource = Literal["device time", "device counter", "counted at the nominal rate", "none"]

TICKS: Final = "_ticks"
"""Column of a device time that wraps, in its own ticks; becomes ``t_s``."""

COUNTER: Final = "_counter"
"""Column of a sample counter that wraps; becomes ``counter``."""


class Rank(IntEnum):
    """How good a row a frame makes."""

    CARRIED = 0
    HEADING = 1
    ATTITUDE = 2
    FILTERED_RATE = 3
    RAW_RATE = 4


def rank_of(columns: Sequence[str], filtered: bool = False) -> Rank:
    """Of a frame with these columns; ``filtered``: the device has taken its own estimate of bias off."""
    if GYRO[0] in columns or GYRO[1] in columns or GYRO[2] in columns:
        return Rank.FILTERED_RATE if filtered else Rank.RAW_RATE
    if "pitch_deg" in columns or "roll_deg" in columns:
        return Rank.ATTITUDE
    return Rank.HEADING if "heading_deg" in columns else Rank.CARRIED


@dataclass(frozen=True)
class Part:
    """Frames of one kind: their place in the stream (k,), ascending, and columns of shape (k,)."""

    kind: Hashable
    rank: Rank
    orders: NDArray[np.int64]
    columns: dict[str, Array]

    @property
    def timed(self) -> bool:
        """Whether it carries the device's time."""
        return TICKS in self.columns or "t_s" in self.columns

    def between(self, first: int, last: int) -> Part:
        """Its frames with first ≤ order < last."""
        a, b = np.searchsorted(self.orders, [first, last])
        if a == 0 and b == len(self.orders):
            return self
        columns = {name: column[a:b] for name, column in self.columns.items()}
        return Part(self.kind, self.rank, self.orders[a:b], columns)


class Unwrapper:
    """A number modulo ``modulus``, made continuous over blocks.

    Times step the nearer way, so that a reboot is seen as a step back; a counter only goes forward, because
    what is lost in a long gap is more than half its range sooner than a device goes back.
    """

    def __init__(self, modulus: int, forward_only: bool) -> None:
        self._modulus = modulus
        self._forward = forward_only
        self._last: float | None = None
        self._turns = 0.0

    def unwrap(self, raw: Array) -> Array:
        """Shape (k,); the first value ever is kept as it is, what is not a number stays so."""
        told = np.isfinite(raw)
        if not told.all():
            result = np.full(len(raw), np.nan)
            result[told] = self.unwrap(raw[told])
            return result
        if not len(raw):
            return raw
        step = np.diff(raw, prepend=raw[0] if self._last is None else self._last)
        if self._forward:
            turned = (step < 0).astype(np.float64)
        else:
            half = self._modulus / 2
            turned = (step < -half).astype(np.float64) - (step >= half)
        turns = self._turns + np.cumsum(turned)
        self._last, self._turns = float(raw[-1]), float(turns[-1])
        return np.asarray(raw + turns * self._modulus, dtype=np.float64)


@dataclass(frozen=True)
class Clockwork:
    """How a protocol's raw time and counter wrap."""

    ticks_per_s: float = 1.0
    tick_modulus: int = 1 << 32
    counter_modulus: int = 1 << 16


@dataclass
class RowMaker:
    """Parts in, samples out; the rows do not depend on how the stream was split.

    ``nominal_rate_hz`` is used only where the device sends no time: then ``t_s`` is its counter, or where
    there is none the number of the row, over that rate, and :attr:`time_source` says so.
    """

    counts: LinkCounts
    clockwork: Clockwork = field(default_factory=Clockwork)
    nominal_rate_hz: float | None = None
    rank: Rank = Rank.CARRIED
    time_source: TimeSource = "none"

    def __post_init__(self) -> None:
        self._waiting: list[Part] = []
        self._learning = True
        self._timed = False
        self._carried: dict[str, float] = {}
        self._fresh = False
        self._known: dict[str, None] = {}
        self._silent = 0
        self._made = 0
        self._ticks = Unwrapper(self.clockwork.tick_modulus, forward_only=False)
        self._counter = Unwrapper(self.clockwork.counter_modulus, forward_only=True)

    def feed(self, parts: Sequence[Part]) -> Samples:
        """The rows that ``parts``, later in the stream than all before, complete."""
        if self._learning:
            self._waiting.extend(parts)
            if not self._learn():
                return Samples()
            parts, self._waiting = self._waiting, []
        return self._finished(self._rows(parts))

    def flush(self) -> Samples:
        """The stream has ended: rows that waited to learn what else it holds."""
        parts, self._waiting = self._waiting, []
        if self._learning and parts:
            self._decide(parts)
        return self._finished(self._rows(parts))

    def _learn(self) -> bool:
        """One round of the stream is known as soon as a kind of frame comes again."""
        seen: dict[Hashable, list[int]] = {}
        for part in self._waiting:
            seen.setdefault(part.kind, []).extend(part.orders[:2].tolist())
        again = [sorted(orders)[1] for orders in seen.values() if len(orders) > 1]
        if not again:
            return False
        self._decide([part for part in self._waiting if part.orders[0] <= min(again)])
        return True

    def _decide(self, parts: Sequence[Part]) -> None:
        self._learning = False
        self.rank = max(part.rank for part in parts)
        self._timed = any(part.timed for part in parts)
        if self._timed:
            self.time_source = "device time"
        elif self.nominal_rate_hz:
            # What the first round of the stream has decides for good: two time bases are never mixed.
            counted = any(COUNTER in part.columns or "counter" in part.columns for part in parts)
            self.time_source = "device counter" if counted else "counted at the nominal rate"

    def _rows(self, parts: Sequence[Part]) -> tuple[int, dict[str, Array]]:
        """Number of rows and raw columns; better kinds of frames take over from where they first come."""
        blocks: list[tuple[int, dict[str, Array]]] = []
        first = 0
        while True:
            better = [(int(p.orders[0]), p.rank) for p in parts if p.rank > self.rank and len(p.orders)]
            last = min(better)[0] if better else np.iinfo(np.int64).max
            cut = [part.between(first, last) for part in parts]
            blocks.append(self._rows_of_rank([part for part in cut if len(part.orders)]))
            if not better:
                break
            self.rank = min(better)[1]
            parts = [part.between(last, np.iinfo(np.int64).max) for part in parts]
            first = last
        full = [block for block in blocks if block[0]]
        if len(full) <= 1:
            return full[0] if full else (0, {})
        names = list(dict.fromkeys(name for _, columns in full for name in columns))
        return sum(n for n, _ in full), {
            name: np.concatenate([columns.get(name, np.full(n, np.nan)) for n, columns in full])
            for name in names
        }

    def _rows_of_rank(self, parts: Sequence[Part]) -> tuple[int, dict[str, Array]]:
        own = [part for part in parts if part.rank == self.rank and self.rank > Rank.CARRIED]
        others = [part for part in parts if part.rank != self.rank]
        if len(own) == 1 and not others and not self._carried_elsewhere(own[0]):
            return self._simple(own[0])
        return self._woven(own, others)

    def _carried_elsewhere(self, part: Part) -> bool:
        return any(name not in part.columns for name in self._carried) or (self._timed and not part.timed)

    def _simple(self, part: Part) -> tuple[int, dict[str, Array]]:
        if part.timed and not self._timed:
            self._timed = True
        for name, column in part.columns.items():
            self._carried[name] = float(column[-1])
        self._fresh = False
        return len(part.orders), part.columns

    def _woven(self, own: Sequence[Part], others: Sequence[Part]) -> tuple[int, dict[str, Array]]:
        """Rows of ``own`` in the order of the stream, with what was last said of every other column."""
        parts = [*own, *others]
        if not parts:
            return 0, {}
        orders = np.concatenate([p.orders for p in own]) if own else np.empty(0, dtype=np.int64)
        rows = np.sort(orders)
        columns: dict[str, Array] = {}
        for name in dict.fromkeys([*self._carried, *(name for part in parts for name in part.columns)]):
            if name not in columns:
                self._last_said(name, parts, rows, columns)
        keep = self._timely(parts, rows)
        if not keep.all():
            self.counts.untimed += int(np.count_nonzero(~keep))
            columns = {name: column[keep] for name, column in columns.items()}
        return int(np.count_nonzero(keep)), columns

    def _last_said(
        self, name: str, parts: Sequence[Part], rows: NDArray[np.int64], columns: dict[str, Array]
    ) -> None:
        """Fill in column ``name``, and all others that the same kinds of frames say."""
        saying = [part for part in parts if name in part.columns]
        if not saying:
            columns[name] = np.full(len(rows), self._carried[name])
            return
        silent = [part for part in parts if name not in part.columns]
        orders = np.concatenate([part.orders for part in saying])
        sort = np.argsort(orders, kind="stable")
        at = np.searchsorted(orders, rows, side="right", sorter=sort) - 1
        early, at = at < 0, sort[np.maximum(at, 0)]
        last = int(sort[-1])
        for other in saying[0].columns:
            alike = all(other in part.columns for part in saying)
            if alike and not any(other in part.columns for part in silent):
                values = np.concatenate([part.columns[other] for part in saying])
                columns[other] = np.where(early, self._carried.get(other, np.nan), values[at])
                self._carried[other] = float(values[last])

    def _timely(self, parts: Sequence[Part], rows: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Which rows have had a time since the row before them."""
        told = np.sort(np.concatenate([np.empty(0, np.int64), *(p.orders for p in parts if p.timed)]))
        # Rows before the first time ever are kept: nothing was lost, the device just had not told it yet.
        before = len(rows) if not len(told) else int(np.searchsorted(rows, told[0]))
        early = 0 if self._timed else before
        self._timed = self._timed or len(told) > 0
        heard = np.searchsorted(told, rows, side="right")
        keep = np.diff(heard, prepend=0) > 0
        keep[:early] = True
        if len(rows):
            keep[0] = keep[0] or self._fresh
            self._fresh = len(told) > int(heard[-1])
        else:
            self._fresh = self._fresh or len(told) > 0
        return keep

    def _finished(self, raw: tuple[int, dict[str, Array]]) -> Samples:
        """Wrapped numbers made continuous; every column said so far is there, NaN where it was not yet.

        Rows before the first number of all wait for the column that makes them visible.
        """
        count, given = raw
        if not count:
            return Samples()
        columns = {name: column for name, column in given.items() if not np.isnan(column).all()}
        ticks, counter = columns.pop(TICKS, None), columns.pop(COUNTER, None)
        if ticks is not None and "t_s" not in columns:
            columns["t_s"] = self._ticks.unwrap(ticks) / self.clockwork.ticks_per_s
        if counter is not None:
            columns["counter"] = self._counter.unwrap(counter)
        self._time(columns, count)
        self._made += count
        if not self._known and not columns:
            self._silent += count
            return Samples()
        if self._silent:
            wanting = np.full(self._silent, np.nan)
            columns = {name: np.concatenate([wanting, column]) for name, column in columns.items()}
            count, self._silent = count + self._silent, 0
        first = [name for name in ("t_s", "counter") if name in columns]
        self._known.update(dict.fromkeys([*first, *columns]))
        return Samples({name: columns.get(name, np.full(count, np.nan)) for name in self._known})

    def _time(self, columns: dict[str, Array], count: int) -> None:
        rate_hz = self.nominal_rate_hz
        if self.time_source == "device counter" and rate_hz:
            columns["t_s"] = columns.get("counter", np.full(count, np.nan)) / rate_hz
        elif self.time_source == "counted at the nominal rate" and rate_hz:
            numbers = np.arange(self._made + 1, self._made + count + 1, dtype=np.float64)
            columns["t_s"] = numbers / rate_hz
        elif "t_s" in columns:
            self.time_source = "device time"
