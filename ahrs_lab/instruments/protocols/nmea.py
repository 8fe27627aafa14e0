"""NMEA 0183 heading (HDT) and attitude (PASHR) as samples. Framing and checksum are done here, and so are
the fields of sentences in their usual form; ``pynmeagps`` reads the odd ones, and is the measure of all."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import time
from functools import cache
from typing import Any, Final

import numpy as np

from ahrs_lab.instruments.protocols.checksums import xor8
from ahrs_lab.instruments.protocols.frames import FrameScanner, LinkCounts, Run
from ahrs_lab.instruments.protocols.rows import TICKS, Clockwork, Part, rank_of
from ahrs_lab.instruments.protocols.sentences import SentenceFormat, printable
from ahrs_lab.instruments.protocols.stream import FramedStream
from ahrs_lab.recording.samples import Samples

NMEA_FORMAT: Final = SentenceFormat(b"$", re.compile(rb"\*[0-9A-Fa-f]{2}\r?\n"))
"""How a sentence stands in a stream."""

_DAY_US: Final = 86_400_000_000
_CLOCKWORK: Final = Clockwork(ticks_per_s=1e6, tick_modulus=_DAY_US)
_ATTRIBUTES: Final = {
    "HDT": {"heading_deg": "headingT"},
    "PASHR": {"heading_deg": "trueHdg", "pitch_deg": "pitch", "roll_deg": "roll"},
}


_KINDS: Final = {b"HDT": "HDT"}

_NUMBER: Final = rb"[+-]?\d{1,9}(?:\.\d{0,9})?"
_ATTITUDE: Final = re.compile(
    rb"\$PASHR,([01]\d|2[0-3])([0-5]\d)([0-5]\d)(?:\.(\d{1,6}))?,(N),[^,*]*,(N),(N),[^,*]*"
    rb"(?:,(?:N)?){3},\d{0,9}(?:,\d{0,9})?\*".replace(b"N", _NUMBER)
)
_ATTITUDE_COLUMNS: Final = (TICKS, "heading_deg", "pitch_deg", "roll_deg")
_HEADING: Final = re.compile(rb"\$[A-OQ-Z][A-Z]HDT,(N)(?:,[^,*]*)?\*".replace(b"N", _NUMBER))
_HEADING_COLUMNS: Final = ("heading_deg",)
"""Sentences as makers print them: a pattern reads them forty times as fast as pynmeagps does. It takes only
what pynmeagps would read in the same way, which a test holds against it."""


@dataclass(frozen=True)
class NmeaSentence:
    """Address (``HEHDT``) and fields."""

    address: str
    fields: tuple[str, ...]

    @property
    def kind(self) -> str:
        """The address without the talker; proprietary ones keep it whole."""
        return self.address if self.address.startswith("P") else self.address[2:]


def sentence_of(data: bytes) -> NmeaSentence:
    """From the bytes of a valid frame."""
    address, *fields = data[1 : data.rindex(b"*")].decode("ascii").split(",")
    return NmeaSentence(address, tuple(fields))


def encode(address: str, *fields: object) -> bytes:
    """A sentence with its checksum; raises ValueError for characters that may not be in one."""
    body = ",".join([address, *(str(field) for field in fields)]).encode("ascii")
    if not printable(body):
        raise ValueError(f"not for a sentence: {body!r}")
    return b"$" + body + b"*%02X\r\n" % xor8(body)


def _clock(t_s: float) -> str:
    ms = round(t_s * 1e3) % (_DAY_US // 1000)
    minutes, rest = divmod(ms, 60_000)
    return f"{minutes // 60:02d}{minutes % 60:02d}{rest // 1000:02d}.{rest % 1000:03d}"


def encode_attitude(samples: Samples) -> bytes:
    """PASHR sentences: time of day from ``t_s``, heading 0–360°, roll, pitch."""
    columns = [samples[name] for name in ("t_s", "heading_deg", "roll_deg", "pitch_deg")]
    rest = ("0.000", "0.000", "0.000", 1, 1)
    return b"".join(
        encode("PASHR", _clock(t), f"{h % 360:.2f}", "T", f"{r:+.2f}", f"{p:+.2f}", "+0.00", *rest)
        for t, h, r, p in zip(*columns, strict=True)
    )


def encode_heading(samples: Samples, talker: str = "HE") -> bytes:
    """HDT sentences; they have no time."""
    return b"".join(encode(talker + "HDT", f"{h % 360:.2f}", "T") for h in samples["heading_deg"])


class NmeaStream(FramedStream):
    """See :class:`~ahrs_lab.instruments.protocols.stream.StreamDecoder`. Heading 0–360°, true; device time is
    the time of day of PASHR, continuous over midnight. HDT has none. No rates: attitude only.

    ``replies`` are :class:`NmeaSentence`: all others, and those whose fields cannot be read.
    """

    def __init__(self, nominal_rate_hz: float | None = None) -> None:
        super().__init__([NMEA_FORMAT], _CLOCKWORK, nominal_rate_hz)

    def _parts(self, runs: Sequence[Run]) -> list[Part]:
        found: dict[tuple[str, ...], tuple[list[int], list[float]]] = {}
        for run in runs:
            row = _usual(run) or _odd(run)
            if row is None:
                self.replies.append(sentence_of(run.data[run.start : run.start + run.length]))
                continue
            names, values = row
            orders, numbers = found.setdefault(names, ([], []))
            orders.append(run.order)
            numbers += values
        parts = []
        for names, (orders, numbers) in found.items():
            table = np.array(numbers, dtype=np.float64).reshape(-1, len(names))
            columns = dict(zip(names, table.T, strict=True))
            parts.append(Part(names, rank_of(names), np.array(orders, dtype=np.int64), columns))
        return parts


_Row = tuple[tuple[str, ...], tuple[float, ...]]
"""Names of columns and their values."""


def _usual(run: Run) -> _Row | None:
    """The row of a sentence that is written as the makers print it; None where pynmeagps has to look."""
    match = _ATTITUDE.match(run.data, run.start)
    if match:
        hour, minute, second, fraction, heading, roll, pitch = match.groups()
        whole_s = (int(hour) * 60 + int(minute)) * 60 + int(second)
        ticks = whole_s * 1e6 + int((fraction or b"").ljust(6, b"0"))
        return _ATTITUDE_COLUMNS, (ticks, float(heading), float(pitch), float(roll))
    match = _HEADING.match(run.data, run.start)
    return (_HEADING_COLUMNS, (float(match[1]),)) if match else None


def _odd(run: Run) -> _Row | None:
    """The row of any heading or attitude sentence; None where it is neither or a value is missing."""
    data = run.data[run.start : run.start + run.length]
    address = data[1 : data.index(b",")] if b"," in data else b""
    kind = _KINDS.get(address[-3:]) if address != b"PASHR" else "PASHR"
    values = _measured(kind, data) if kind else None
    return None if values is None else (tuple(values), tuple(values.values()))


def _measured(kind: str, data: bytes) -> dict[str, float] | None:
    """Columns of one sentence; None where a value is missing."""
    message = _parsed(data)
    values: dict[str, float] = {}
    stamp = getattr(message, "utctime", None)
    if isinstance(stamp, time):
        seconds = (stamp.hour * 60 + stamp.minute) * 60 + stamp.second
        values[TICKS] = seconds * 1e6 + stamp.microsecond
    for column, attribute in _ATTRIBUTES[kind].items():
        value = getattr(message, attribute, None)
        if not isinstance(value, (int, float)):
            return None
        values[column] = float(value)
    return values


def _parsed(data: bytes) -> Any:
    """What pynmeagps makes of it, None where it cannot: it stumbles over empty and odd fields."""
    parse, known = _pynmeagps()
    try:
        return parse(data, validate=0)
    except known:
        return None


@cache
def _pynmeagps() -> tuple[Callable[..., Any], tuple[type[Exception], ...]]:
    """Its parser and what that raises; imported when the first sentence comes."""
    from pynmeagps import (  # type: ignore[import-untyped]
        NMEAMessageError,
        NMEAParseError,
        NMEAReader,
        NMEATypeError,
    )

    own = (NMEAMessageError, NMEAParseError, NMEATypeError)
    return NMEAReader.parse, (*own, IndexError, KeyError, ValueError, TypeError, AttributeError)


class NmeaDecoder:
    """Sentences as frames; see :class:`~ahrs_lab.instruments.protocols.frames.Decoder`."""

    def __init__(self) -> None:
        self._scanner = FrameScanner([NMEA_FORMAT])
        self.counts: LinkCounts = self._scanner.counts

    def feed(self, data: bytes) -> list[NmeaSentence]:
        return self._sentences(self._scanner.feed(data))

    def flush(self) -> list[NmeaSentence]:
        return self._sentences(self._scanner.flush())

    @staticmethod
    def _sentences(runs: list[Run]) -> list[NmeaSentence]:
        return [sentence_of(data) for run in runs for data in run.frames()]
