"""Advanced Navigation ANPP: LRC, identifier, length, CRC-16 of the data, data; little-endian.

The frame has no sync byte: a header is one where its five bytes sum to 0 modulo 256. Framing and the packets
of samples are decoded here, because the manufacturer's package walks byte by byte, keeps its state on the
class and passes identifiers it does not know as garbage; what the package does well, the packets of
configuration, is left to it (:func:`packet_object`, :func:`encode_object`). Experimental: no capture of a
real unit was at hand; the tests hold it against that package.
"""

from __future__ import annotations

import importlib
import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.protocols.checksums import crc16_ccitt
from ahrs_lab.instruments.protocols.frames import (
    UNDECIDED,
    Bytes2D,
    FrameScanner,
    LinkCounts,
    Run,
    grouped,
    stacked,
)
from ahrs_lab.instruments.protocols.layouts import DEG_IN_RAD, Layout, numbers
from ahrs_lab.instruments.protocols.rows import Part, Rank
from ahrs_lab.instruments.protocols.stream import FramedStream
from ahrs_lab.recording.samples import ACCEL, GYRO, Samples

_HEADER: Final = 5
_WINDOW: Final = 4096

ACKNOWLEDGE: Final = 0
REQUEST: Final = 1
DEVICE_INFORMATION: Final = 3
SYSTEM_STATE: Final = 20
UNIX_TIME: Final = 21
RAW_SENSORS: Final = 28
BODY_ACCELERATION: Final = 38
EULER: Final = 39
ANGULAR_VELOCITY: Final = 42
RUNNING_TIME: Final = 49
PACKET_TIMER_PERIOD: Final = 180
PACKETS_PERIOD: Final = 181
BAUD_RATES: Final = 182

_SECONDS: Final = "_seconds"
_MICROSECONDS: Final = "_microseconds"
_CLOCK: Final = (_SECONDS, _MICROSECONDS)
_ROLL_PITCH_HEADING: Final = ("roll_deg", "pitch_deg", "heading_deg")

_CONTENT: Final[dict[int, tuple[int, Rank, tuple[tuple[int, str, tuple[str, ...], float], ...]]]] = {
    SYSTEM_STATE: (
        100,
        Rank.FILTERED_RATE,
        (
            (0, "<u2", ("status", "filter_status"), 1.0),
            (4, "<u4", _CLOCK, 1.0),
            (48, "<f4", ACCEL, 1.0),
            (64, "<f4", _ROLL_PITCH_HEADING, DEG_IN_RAD),
            (76, "<f4", GYRO, 1.0),
        ),
    ),
    UNIX_TIME: (8, Rank.CARRIED, ((0, "<u4", _CLOCK, 1.0),)),
    RAW_SENSORS: (
        48,
        Rank.RAW_RATE,
        (
            (0, "<f4", ACCEL, 1.0),
            (12, "<f4", GYRO, 1.0),
            (24, "<f4", ("mag_x", "mag_y", "mag_z", "temperature_c", "pressure_pa"), 1.0),
        ),
    ),
    BODY_ACCELERATION: (16, Rank.CARRIED, ((0, "<f4", ACCEL, 1.0),)),
    EULER: (12, Rank.ATTITUDE, ((0, "<f4", _ROLL_PITCH_HEADING, DEG_IN_RAD),)),
    ANGULAR_VELOCITY: (12, Rank.FILTERED_RATE, ((0, "<f4", GYRO, 1.0),)),
    RUNNING_TIME: (8, Rank.CARRIED, ((0, "<u4", ("running_s", "running_us"), 1.0),)),
}
"""Length, rank and numbers of the packets that make samples: place in the data, format, columns, scale."""

_CLASSES: Final = {
    ACKNOWLEDGE: "AcknowledgePacket",
    DEVICE_INFORMATION: "DeviceInformationPacket",
    PACKET_TIMER_PERIOD: "PacketTimerPeriodPacket",
    PACKETS_PERIOD: "PacketsPeriodPacket",
    BAUD_RATES: "BaudRatesPacket",
}


@dataclass(frozen=True)
class AnppPacket:
    """One packet."""

    id: int
    data: bytes = b""


class AnppFormat:
    """See :class:`~ahrs_lab.instruments.protocols.frames.FrameFormat`."""

    def find(self, data: bytes, start: int) -> int:
        end = len(data)
        if start + _HEADER <= end and sum(data[start : start + _HEADER]) & 0xFF == 0:
            return start
        while start < end:
            window = np.frombuffer(data, np.uint8, min(_WINDOW, end - start), start).astype(np.int64)
            if len(window) < _HEADER:
                return start
            sums = np.convolve(window, np.ones(_HEADER, dtype=np.int64), "valid")
            places = np.flatnonzero(sums & 0xFF == 0)
            if len(places):
                return start + int(places[0])
            start += len(window) - _HEADER + 1
        return end

    def extent(self, data: bytes, start: int) -> int:
        if len(data) - start < _HEADER:
            return UNDECIDED
        return data[start + 2] + _HEADER

    def holds(self, data: bytes, start: int, stop: int) -> bool:
        return crc16_ccitt(data[start + _HEADER : stop]) == data[start + 4] << 8 | data[start + 3]

    def key_length(self, _data: bytes, _start: int) -> int:
        # Identifier and length alone decide; the bytes before and behind them differ from packet to packet.
        return 0

    def rows_hold(self, rows: Bytes2D) -> NDArray[np.bool_]:
        return np.array([self.holds(row.tobytes(), 0, len(row)) for row in rows], dtype=np.bool_)


def packet_of(frame: bytes) -> AnppPacket:
    """From the bytes of a valid frame."""
    return AnppPacket(frame[1], frame[_HEADER:])


def encode(packet_id: int, data: bytes = b"") -> bytes:
    """A packet: commands and the device's own are alike. Raises ValueError beyond 255 bytes."""
    if len(data) > 255:
        raise ValueError(f"a packet has at most 255 bytes of data, not {len(data)}")
    head = struct.pack("<BBH", packet_id, len(data), crc16_ccitt(data))
    return bytes((-sum(head) & 0xFF,)) + head + data


def encode_request(packet_ids: Iterable[int]) -> bytes:
    """Ask for packets once."""
    return encode(REQUEST, bytes(packet_ids))


def encode_packets_period(
    periods: Iterable[tuple[int, int]], permanent: bool = False, clear: bool = True
) -> bytes:
    """Ask for ``(packet, period)`` to be sent every ``period`` timer periods; ``clear`` stops all others."""
    listed = b"".join(struct.pack("<BI", packet, period) for packet, period in periods)
    return encode(PACKETS_PERIOD, bytes((int(permanent), int(clear))) + listed)


def encode_timer_period(microseconds: int, permanent: bool = False, utc: bool = True) -> bytes:
    """Set the timer period that packet periods count in."""
    return encode(PACKET_TIMER_PERIOD, struct.pack("<BBH", permanent, utc, microseconds))


def encode_acknowledge(command: bytes, result: int = 0) -> bytes:
    """The device's answer to the bytes of a command; result 0 is success."""
    return encode(ACKNOWLEDGE, command[1:2] + command[3:5] + bytes((result,)))


def packet_object(packet: AnppPacket) -> Any | None:
    """The manufacturer's own object of an acknowledgement, device information or setting: a new one each
    time. None for other packets and where it does not know a value in it.

    It keeps the name of the device and the results as its own enumerations.
    """
    name = _CLASSES.get(packet.id)
    if name is None:
        return None
    protocol = importlib.import_module("advanced_navigation.anpp_packets.an_packet_protocol")
    module = importlib.import_module(f"advanced_navigation.anpp_packets.an_packet_{packet.id}")
    carrier = protocol.ANPacket(id=packet.id, length=len(packet.data), data=packet.data)
    found = getattr(module, name)()
    try:
        return found if found.decode(carrier) == 0 else None
    except (ValueError, struct.error):
        return None


def encode_object(packet: Any) -> bytes:
    """Bytes of one of the manufacturer's packet objects that has ``encode``."""
    carrier = packet.encode()
    return encode(int(carrier.id), bytes(carrier.data))


def _layout(packet_id: int) -> Layout:
    length, _, content = _CONTENT[packet_id]
    template = b"\0" + bytes((packet_id, length)) + bytes(2 + length)
    found = [numbers(_HEADER + place, code, names, scale) for place, code, names, scale in content]
    return Layout(template, tuple(number for group in found for number in group))


_LAYOUTS: Final = {packet_id: _layout(packet_id) for packet_id in _CONTENT}


def encode_samples(packet_ids: Sequence[int], samples: Samples) -> bytes:
    """For each row the packets asked for, in that order; numbers without a column are zero. A packet 28 needs
    a 20 or 21 before it for its time. Raises ValueError for a packet that carries no samples."""
    unknown = [packet_id for packet_id in packet_ids if packet_id not in _LAYOUTS]
    if unknown:
        raise ValueError(f"packets without samples: {unknown}")
    if "t_s" in samples:
        microseconds = np.rint(samples["t_s"] * 1e6)
        whole = np.floor(microseconds / 1e6)
        samples = samples.with_columns({_SECONDS: whole, _MICROSECONDS: microseconds - 1e6 * whole})
    blocks = [_LAYOUTS[packet_id].write(samples) for packet_id in packet_ids]
    rounds = zip(packet_ids, blocks, strict=True)
    packets = [[encode(packet_id, row[_HEADER:].tobytes()) for row in rows] for packet_id, rows in rounds]
    return b"".join(packet for round_ in zip(*packets, strict=True) for packet in round_)


class AnppStream(FramedStream):
    """See :class:`~ahrs_lab.instruments.protocols.stream.StreamDecoder`. Rates in rad/s, specific force in
    m/s², magnetic field in mG; device time is the Unix time of packet 20 or 21. Raw sensors (28) make the
    rows where they come, else the filter's rates (20, 42), else the attitude (39).

    ``replies`` are :class:`AnppPacket`.
    """

    def __init__(self, nominal_rate_hz: float | None = None) -> None:
        super().__init__([AnppFormat()], nominal_rate_hz=nominal_rate_hz)

    def _parts(self, runs: Sequence[Run]) -> list[Part]:
        data: list[tuple[int, Run]] = []
        for run in runs:
            packet_id = run.data[run.start + 1]
            if packet_id in _CONTENT and run.length == _CONTENT[packet_id][0] + _HEADER:
                data.append((packet_id, run))
            else:
                self.replies.extend(packet_of(frame) for frame in run.frames())
        parts = []
        for packet_id, group in grouped(data).items():
            orders, rows = stacked(group)
            columns = _LAYOUTS[packet_id].read(rows)
            if _SECONDS in columns:
                columns["t_s"] = columns.pop(_SECONDS) + columns.pop(_MICROSECONDS) / 1e6
            parts.append(Part(packet_id, _CONTENT[packet_id][1], orders, columns))
        return parts


class AnppDecoder:
    """Packets as frames; see :class:`~ahrs_lab.instruments.protocols.frames.Decoder`."""

    def __init__(self) -> None:
        self._scanner = FrameScanner([AnppFormat()])
        self.counts: LinkCounts = self._scanner.counts

    def feed(self, data: bytes) -> list[AnppPacket]:
        return self._packets(self._scanner.feed(data))

    def flush(self) -> list[AnppPacket]:
        return self._packets(self._scanner.flush())

    @staticmethod
    def _packets(runs: list[Run]) -> list[AnppPacket]:
        return [packet_of(data) for run in runs for data in run.frames()]
