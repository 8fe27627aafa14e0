"""What every decoder of an AHRS stream offers a driver: samples in the bundle's columns, the replies between
them, counts."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np

from ahrs_lab.instruments.protocols.frames import FrameFormat, FrameScanner, LinkCounts, Run
from ahrs_lab.instruments.protocols.rows import Clockwork, Part, Rank, RowMaker, TimeSource
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import AccelUnit, RateUnit


class StreamDecoder(Protocol):
    """Bytes of a link in, samples out; the same samples for any split, and never an exception.

    Columns are the bundle's: ``t_s`` (device time, unwrapped, s), ``counter`` (unwrapped), ``gyro_x …`` in
    ``rate_unit``, ``accel_x …`` in ``accel_unit``, ``heading_deg pitch_deg roll_deg`` as the device sends
    them (headings may be ±180°), ``temperature_c`` and what else it says. A column once seen is in every
    later block, NaN where nothing was said yet. ``t_s`` is missing where the device sends neither time nor
    counter and no nominal rate was given: the host's time of arrival is the driver's.
    """

    rate_unit: RateUnit
    accel_unit: AccelUnit
    replies: list[Any]
    """Frames that are not samples (answers, acknowledgements, errors); the driver takes them out."""

    @property
    def counts(self) -> LinkCounts: ...
    @property
    def time_source(self) -> TimeSource: ...
    @property
    def filtered_rates(self) -> bool:
        """The rates are those the device's own filter took its estimate of bias off: not for calibration."""
        ...

    def feed(self, data: bytes) -> Samples: ...
    def flush(self) -> Samples:
        """The stream has ended: the rows that still waited."""
        ...


class FramedStream(ABC):
    """A stream of frames; a protocol says what its frames mean."""

    rate_unit: RateUnit = "rad/s"
    accel_unit: AccelUnit = "m/s^2"

    def __init__(
        self,
        formats: Sequence[FrameFormat],
        clockwork: Clockwork | None = None,
        nominal_rate_hz: float | None = None,
    ) -> None:
        self._scanner = FrameScanner(formats)
        self._rows = RowMaker(self._scanner.counts, clockwork or Clockwork(), nominal_rate_hz)
        self.replies: list[Any] = []

    @property
    def counts(self) -> LinkCounts:
        """Of all bytes fed."""
        return self._scanner.counts

    @property
    def time_source(self) -> TimeSource:
        """Where ``t_s`` comes from."""
        return self._rows.time_source

    @property
    def filtered_rates(self) -> bool:
        """See :class:`StreamDecoder`."""
        return self._rows.rank == Rank.FILTERED_RATE

    def feed(self, data: bytes) -> Samples:
        """See :class:`StreamDecoder`."""
        runs = self._scanner.feed(data)
        return self._samples(runs) if runs else Samples()

    def flush(self) -> Samples:
        """See :class:`StreamDecoder`."""
        runs = self._scanner.flush()
        blocks = [self._samples(runs)] if runs else []
        with np.errstate(all="ignore"):
            blocks.append(self._rows.flush())
        return joined(blocks)

    def _samples(self, runs: Sequence[Run]) -> Samples:
        # What a device sends may be any bit pattern, signalling NaN and infinity among them.
        with np.errstate(all="ignore"):
            return self._rows.feed(self._parts(runs))

    @abstractmethod
    def _parts(self, runs: Sequence[Run]) -> list[Part]:
        """The columns of frames that carry data; everything else goes to :attr:`replies`."""


def joined(blocks: Sequence[Samples]) -> Samples:
    """One block of several of one stream: the columns of the last, NaN where earlier ones lack them."""
    full = [block for block in blocks if len(block)]
    if len(full) <= 1:
        return full[0] if full else Samples()
    names = dict.fromkeys(name for block in reversed(full) for name in block.columns)
    return Samples(
        {
            name: np.concatenate([b[name] if name in b else np.full(len(b), np.nan) for b in full])
            for name in names
        }
    )
