"""VectorNav binary output: FA, groups, one mask of fields per group, payload, CRC-16.

The length follows from the masks. All numbers are little-endian; the CRC comes high byte first, so that the
CRC over everything after FA, itself included, is 0.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.protocols.checksums import crc16_xmodem
from ahrs_lab.instruments.protocols.frames import NO_FRAME, UNDECIDED, Bytes2D, FrameScanner, LinkCounts, Run
from ahrs_lab.instruments.protocols.layouts import Layout, Number, numbers
from ahrs_lab.recording.samples import ACCEL, GYRO, Samples

SYNC: Final = 0xFA

COMMON, TIME, IMU, GPS, ATTITUDE, INS = range(6)
"""Groups, by the number of their bit."""

_SIZES: Final[tuple[tuple[int, ...], ...]] = (
    (8, 8, 8, 12, 16, 12, 24, 12, 12, 24, 20, 28, 2, 4, 8),
    (8, 8, 8, 2, 8, 8, 8, 4),
    (2, 12, 12, 12, 4, 4, 16, 12, 12, 12, 12, 2, 40),
    (8, 8, 2, 1, 1, 24, 24, 12, 12, 12, 4, 4, 32),
    (2, 12, 16, 36, 12, 12, 12, 12, 12, 12, 28, 24),
    (2, 24, 24, 12, 12, 12, 12, 12, 12, 4, 4, 68, 64),
)
"""Bytes of each field of each group, field 0 first."""

COMPENSATED_GYRO: Final = tuple(f"gyro_compensated_{axis}" for axis in "xyz")
COMPENSATED_ACCEL: Final = tuple(f"accel_compensated_{axis}" for axis in "xyz")
MAG: Final = ("mag_x", "mag_y", "mag_z")
_COMPENSATED_MAG: Final = ("mag_compensated_x", "mag_compensated_y", "mag_compensated_z")
_YAW_PITCH_ROLL: Final = ("heading_deg", "pitch_deg", "roll_deg")
_QUATERNION: Final = ("quaternion_x", "quaternion_y", "quaternion_z", "quaternion_w")
_DCM: Final = tuple(f"dcm_{row}{column}" for row in "123" for column in "123")
_DELTA_ANGLE: Final = ("delta_time_s", "delta_angle_x_deg", "delta_angle_y_deg", "delta_angle_z_deg")
_DELTA_VELOCITY: Final = ("delta_velocity_x_mps", "delta_velocity_y_mps", "delta_velocity_z_mps")
_PLAIN: Final = dict(
    zip(COMPENSATED_GYRO + COMPENSATED_ACCEL + _COMPENSATED_MAG, GYRO + ACCEL + MAG, strict=True)
)

_FIELDS: Final[dict[tuple[int, int], tuple[tuple[str, tuple[str, ...], float], ...]]] = {
    (COMMON, 0): (("<u8", ("t_s",), 1e9),),
    (COMMON, 3): (("<f4", _YAW_PITCH_ROLL, 1.0),),
    (COMMON, 4): (("<f4", _QUATERNION, 1.0),),
    (COMMON, 5): (("<f4", COMPENSATED_GYRO, 1.0),),
    (COMMON, 8): (("<f4", COMPENSATED_ACCEL, 1.0),),
    (COMMON, 9): (("<f4", ACCEL + GYRO, 1.0),),
    (COMMON, 10): (("<f4", (*_COMPENSATED_MAG, "temperature_c", "pressure_kpa"), 1.0),),
    (COMMON, 11): (("<f4", _DELTA_ANGLE + _DELTA_VELOCITY, 1.0),),
    (TIME, 0): (("<u8", ("t_s",), 1e9),),
    (IMU, 0): (("<u2", ("imu_status",), 1.0),),
    (IMU, 1): (("<f4", MAG, 1.0),),
    (IMU, 2): (("<f4", ACCEL, 1.0),),
    (IMU, 3): (("<f4", GYRO, 1.0),),
    (IMU, 4): (("<f4", ("temperature_c",), 1.0),),
    (IMU, 5): (("<f4", ("pressure_kpa",), 1.0),),
    (IMU, 6): (("<f4", _DELTA_ANGLE, 1.0),),
    (IMU, 7): (("<f4", _DELTA_VELOCITY, 1.0),),
    (IMU, 8): (("<f4", _COMPENSATED_MAG, 1.0),),
    (IMU, 9): (("<f4", COMPENSATED_ACCEL, 1.0),),
    (IMU, 10): (("<f4", COMPENSATED_GYRO, 1.0),),
    (IMU, 11): (("<u2", ("over_range",), 1.0),),
    (ATTITUDE, 1): (("<f4", _YAW_PITCH_ROLL, 1.0),),
    (ATTITUDE, 2): (("<f4", _QUATERNION, 1.0),),
    (ATTITUDE, 3): (("<f4", _DCM, 1.0),),
    (ATTITUDE, 4): (("<f4", ("mag_north", "mag_east", "mag_down"), 1.0),),
    (ATTITUDE, 5): (("<f4", ("accel_north", "accel_east", "accel_down"), 1.0),),
}
"""What is kept of the fields; the rest is passed over."""


@dataclass(frozen=True)
class BinaryOutput:
    """Which fields a binary message has: groups by number, each with its mask of fields.

    Raises ValueError for a field that is not known, because then the length is not known either.
    """

    masks: tuple[tuple[int, int], ...]

    def __post_init__(self) -> None:
        if not self.masks or any(
            not 0 <= group < len(_SIZES) or not 0 < mask < 1 << len(_SIZES[group])
            for group, mask in self.masks
        ):
            raise ValueError(f"unknown groups or fields: {self.masks}")
        object.__setattr__(self, "masks", tuple(sorted(self.masks)))

    @classmethod
    def of(cls, fields: Mapping[int, Iterable[int]]) -> BinaryOutput:
        """From field numbers: ``{COMMON: [0, 9], IMU: [4]}``."""
        return cls(tuple((group, sum(1 << n for n in set(names))) for group, names in fields.items()))

    @property
    def groups(self) -> int:
        """The byte of groups."""
        return sum(1 << group for group, _ in self.masks)

    @property
    def header(self) -> bytes:
        """FA, groups, masks."""
        masks = b"".join(struct.pack("<H", mask) for _, mask in self.masks)
        return bytes((SYNC, self.groups)) + masks

    @property
    def fields(self) -> tuple[tuple[int, int], ...]:
        """(group, field) in the order of the payload."""
        return tuple((group, n) for group, mask in self.masks for n in range(16) if mask >> n & 1)

    @property
    def payload_length(self) -> int:
        """Bytes between the masks and the CRC."""
        return sum(_SIZES[group][n] for group, n in self.fields)

    @property
    def length(self) -> int:
        """Bytes of the whole frame."""
        return len(self.header) + self.payload_length + 2

    def layout(self) -> Layout:
        """Where its numbers are. Where a frame has both, uncompensated rates are ``gyro_x …`` and the
        filter's are ``gyro_compensated_x …``; else the filter's are ``gyro_x …``."""
        return _layout(self)

    @property
    def filtered_rates(self) -> bool:
        """Whether ``gyro_x …`` are the filter's rates, which have its estimate of bias taken off."""
        has = set(self.fields)
        raw = {(COMMON, 9), (IMU, 3)} & has
        return not raw and bool({(COMMON, 5), (IMU, 10)} & has)


@cache
def _layout(output: BinaryOutput) -> Layout:
    found: list[Number] = []
    place = len(output.header)
    for group, n in output.fields:
        at = place
        for code, columns, per_unit in _FIELDS.get((group, n), ()):
            found.extend(numbers(at, code, columns, per_unit))
            at += sum(number.size for number in found[-len(columns) :])
        place += _SIZES[group][n]
    names = {number.column for number in found}
    unique: dict[str, Number] = {}
    for number in found:
        plain = _PLAIN.get(number.column, number.column)
        name = plain if plain not in names else number.column
        unique.setdefault(name, Number(number.place, number.code, name, number.per_unit))
    return Layout(output.header + bytes(output.payload_length + 2), tuple(unique.values()))


@cache
def output_of(header: bytes) -> BinaryOutput | None:
    """From FA, groups and masks; None where a group or field is not known."""
    groups = [group for group in range(8) if header[1] >> group & 1]
    masks = struct.unpack(f"<{len(groups)}H", header[2:])
    try:
        return BinaryOutput(tuple(zip(groups, masks, strict=True)))
    except ValueError:
        return None


class BinaryFormat:
    """See :class:`~ahrs_lab.instruments.protocols.frames.FrameFormat`."""

    def find(self, data: bytes, start: int) -> int:
        place = data.find(SYNC, start)
        return place if place >= 0 else len(data)

    def extent(self, data: bytes, start: int) -> int:
        if len(data) < start + 2:
            return UNDECIDED
        groups = data[start + 1]
        if not groups or groups >> len(_SIZES):
            return NO_FRAME
        header = data[start : start + 2 + 2 * groups.bit_count()]
        if len(header) < 2 + 2 * groups.bit_count():
            return UNDECIDED
        return _length_of(header)

    def holds(self, data: bytes, start: int, stop: int) -> bool:
        return crc16_xmodem(data[start + 1 : stop]) == 0

    def key_length(self, data: bytes, start: int) -> int:
        return 2 + 2 * data[start + 1].bit_count()

    def rows_hold(self, rows: Bytes2D) -> NDArray[np.bool_]:
        data, length = rows.tobytes(), rows.shape[1]
        return np.array(
            [crc16_xmodem(data[at + 1 : at + length]) == 0 for at in range(0, len(data), length)],
            dtype=np.bool_,
        )


@cache
def _length_of(header: bytes) -> int:
    output = output_of(header)
    return output.length if output else NO_FRAME


@dataclass(frozen=True)
class BinaryFrame:
    """One binary message."""

    output: BinaryOutput
    payload: bytes


def frame_of(data: bytes) -> BinaryFrame:
    """From the bytes of a valid frame."""
    header = header_of(data)
    output = output_of(header)
    if output is None:
        raise ValueError("not a binary frame")
    return BinaryFrame(output, data[len(header) : -2])


def header_of(data: bytes, start: int = 0) -> bytes:
    """FA, groups and masks of a frame."""
    return data[start : start + 2 + 2 * data[start + 1].bit_count()]


def encode_frame(output: BinaryOutput, payload: bytes) -> bytes:
    """One binary message; raises ValueError where the payload is not as long as the fields."""
    if len(payload) != output.payload_length:
        raise ValueError(f"{output.payload_length} bytes of payload are needed, not {len(payload)}")
    body = output.header + payload
    return body + struct.pack(">H", crc16_xmodem(body[1:]))


def encode_samples(output: BinaryOutput, samples: Samples) -> bytes:
    """Binary messages that say ``samples``, one a row; fields without a column are zero."""
    rows = output.layout().write(samples)
    crcs = [crc16_xmodem(row[1:-2].tobytes()) for row in rows]
    rows[:, -2:] = np.array(crcs, dtype=">u2").reshape(-1, 1).view(np.uint8)
    return rows.tobytes()


class BinaryDecoder:
    """Binary messages as frames; see :class:`~ahrs_lab.instruments.protocols.frames.Decoder`."""

    def __init__(self) -> None:
        self._scanner = FrameScanner([BinaryFormat()])
        self.counts: LinkCounts = self._scanner.counts

    def feed(self, data: bytes) -> list[BinaryFrame]:
        return self._frames(self._scanner.feed(data))

    def flush(self) -> list[BinaryFrame]:
        return self._frames(self._scanner.flush())

    @staticmethod
    def _frames(runs: list[Run]) -> list[BinaryFrame]:
        return [frame_of(data) for run in runs for data in run.frames()]
