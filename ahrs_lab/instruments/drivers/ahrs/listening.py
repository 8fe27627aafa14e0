"""Units that are only listened to: NMEA, and private formats described in TOML. What they send is set with
their maker's own program; here it is read, timed and counted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.ahrs.streaming import StreamingAhrs
from ahrs_lab.instruments.drivers.ahrs.unit_settings import UnitSettings
from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.protocols.catalogue import stream_decoder
from ahrs_lab.instruments.protocols.nmea import NmeaStream
from ahrs_lab.instruments.protocols.stream import StreamDecoder
from ahrs_lab.recording.samples import Samples

_NMEA_BYTES = 18
"""The shortest sentence that makes a sample, ``$HEHDT,1.0,T*hh``; which ones come is not known before."""
_LAG_S = 0.2
_LAG_INTERVALS = 3.0
_LAG_SHARE = 2e-3


@dataclass(frozen=True)
class NmeaSettings(UnitSettings):
    """``rate_hz``: of the heading or attitude sentences."""

    rate_hz: float = 10.0


@dataclass(frozen=True)
class GenericSettings(UnitSettings):
    """``description``: the TOML file of the format, see
    :mod:`ahrs_lab.instruments.protocols.description`. ``frame_bytes``: of a frame or line, for the check of
    the line's rate; 0: not checked."""

    format: str = ""
    frame_bytes: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.format:
            raise InputError("Setting “{path}” is missing: it has no default.", path="format")


class ListeningAhrs(StreamingAhrs):
    """An :class:`~ahrs_lab.instruments.interfaces.Ahrs` that is never spoken to.

    Where it sends neither time nor counter its samples are counted at the nominal rate; then a sample that is
    missing would go unnoticed, so a damaged frame or a count that falls behind the clock ends the run.
    """

    _failed_before: int | None = None

    def start(self) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.Ahrs`."""
        self._failed_before = None
        super().start()

    def read(self) -> Samples:
        """See :class:`~ahrs_lab.instruments.interfaces.Ahrs`."""
        samples = super().read()
        if len(samples) and self._decoder.time_source == "counted at the nominal rate":
            self._check_counted(samples)
        return samples

    def _check_counted(self, samples: Samples) -> None:
        failed = self._decoder.counts.failed
        if self._failed_before is None:
            self._failed_before = failed
        relation = self._time_base.relation
        late = float(samples["host_t_s"][-1] - samples["t_s"][-1])
        lag = 0.0 if relation is None else late - relation.least_s
        seen = 0.0 if relation is None else relation.seen_s
        allowed = max(_LAG_S, _LAG_INTERVALS / self.description.sample_rate_hz) + _LAG_SHARE * seen
        if failed > self._failed_before or lag > allowed:
            raise InstrumentError(
                "Samples of the device on {port} were lost ({failed} damaged frames, {lag} s behind the "
                "clock), and it sends neither time nor counter to tell how many. Set it to send one of "
                "them, or correct its rate ({rate} Hz).",
                port=self._link.name,
                failed=failed - self._failed_before,
                lag=round(lag, 3),
                rate=round(self.description.sample_rate_hz, 3),
            )

    def _ask_identity(self) -> str:
        known = self.description
        return " ".join(filter(None, (known.manufacturer, known.model or known.name, known.serial_number)))

    def _recover(self) -> None:
        """There is nothing to verify: what comes next is read on."""
        self._last_sample_s = self._clock.now_s()

    def _pause(self) -> None:
        """It cannot be told."""

    def _resume(self) -> None:
        """It sends by itself."""

    def _write_settings(self) -> None:
        """It cannot be told."""

    def _settings(self) -> tuple[Mapping[str, str], Mapping[str, str]]:
        return {}, {}


class NmeaAhrs(ListeningAhrs):
    """Heading and attitude sentences."""

    def __init__(self, settings: NmeaSettings, link: Link, clock: Clock) -> None:
        self.settings = settings
        super().__init__(
            link,
            clock,
            settings.description("deg/s", "m/s^2"),
            boot_time_s=settings.boot_time_s,
            range_dps=settings.range_dps,
        )

    def _new_decoder(self) -> StreamDecoder:
        return NmeaStream(self.settings.rate_hz)

    @property
    def _frame_bytes(self) -> float:
        return _NMEA_BYTES


class GenericAhrs(ListeningAhrs):
    """Delimited text or fixed binary frames."""

    def __init__(self, settings: GenericSettings, link: Link, clock: Clock) -> None:
        self.settings = settings
        decoder = self._new_decoder()
        super().__init__(
            link,
            clock,
            settings.description(decoder.rate_unit, decoder.accel_unit),
            boot_time_s=settings.boot_time_s,
            range_dps=settings.range_dps,
        )

    def _new_decoder(self) -> StreamDecoder:
        if not Path(self.settings.format).suffix:
            raise InputError(
                "“{format}” is no description of a format: name its .toml file.", format=self.settings.format
            )
        return stream_decoder(self.settings.format, self.settings.rate_hz)

    @property
    def _frame_bytes(self) -> float:
        return self.settings.frame_bytes
