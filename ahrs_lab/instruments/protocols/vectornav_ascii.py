"""VectorNav ASCII: ``$VN…*CS`` CR LF, the checksum of the characters between ``$`` and ``*``.

Two hexadecimal digits are their exclusive or, four their CRC-16 (0x1021, initial value 0); ``XX`` stands for
no checksum.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.protocols.checksums import crc16_xmodem, xor8
from ahrs_lab.instruments.protocols.frames import FrameScanner, LinkCounts, Run
from ahrs_lab.instruments.protocols.sentences import SentenceFormat, printable
from ahrs_lab.instruments.protocols.vectornav_binary import MAG
from ahrs_lab.recording.samples import ACCEL, GYRO, Samples

ChecksumMode = Literal["xor", "crc16", "none"]

_NUMERIC: Final = b"0123456789+-.eE,nNaAiIfF"

_YAW_PITCH_ROLL: Final = ("heading_deg", "pitch_deg", "roll_deg")

ASYNC_COLUMNS: Final[dict[str, tuple[str, ...]]] = {
    "YPR": _YAW_PITCH_ROLL,
    "MAG": MAG,
    "ACC": ACCEL,
    "GYR": GYRO,
    "MAR": MAG + ACCEL + GYRO,
    "YMR": _YAW_PITCH_ROLL + MAG + ACCEL + GYRO,
    "IMU": (*MAG, *ACCEL, *GYRO, "temperature_c", "pressure_kpa"),
}
"""Columns of the asynchronous messages. All but IMU are the filter's: compensated."""

ASYNC_NUMBERS: Final[dict[str, int]] = {
    "YPR": 1, "MAG": 10, "ACC": 11, "GYR": 12, "MAR": 13, "YMR": 14, "IMU": 19,
}  # fmt: skip
"""What register 6 says for them."""

_SPELLINGS: Final[dict[str, str]] = {
    **dict.fromkeys(_YAW_PITCH_ROLL, "%+08.3f"),
    **dict.fromkeys(MAG, "%+08.4f"),
    **dict.fromkeys(ACCEL, "%+07.3f"),
    **dict.fromkeys(GYRO, "%+010.6f"),
    "temperature_c": "%+05.1f",
    "pressure_kpa": "%+08.3f",
}
"""Digits as the device writes them."""

ERRORS: Final[dict[int, str]] = {
    1: "hard fault",
    2: "serial buffer overflow",
    3: "invalid checksum",
    4: "invalid command",
    5: "not enough parameters",
    6: "too many parameters",
    7: "invalid parameter",
    8: "invalid register",
    9: "unauthorized access",
    10: "watchdog reset",
    11: "output buffer overflow",
    12: "insufficient baud rate",
    255: "error buffer overflow",
}
"""What ``$VNERR`` says."""


ASCII_FORMAT: Final = SentenceFormat(b"$VN", re.compile(rb"\*([0-9A-Fa-f]{4}|[0-9A-Fa-f]{2}|XX)\r?\n"))
"""How a sentence stands in a stream."""


@dataclass(frozen=True)
class Sentence:
    """``$VN`` and ``tag``, then fields; ``checked`` is false where ``XX`` stood for the checksum."""

    tag: str
    fields: tuple[str, ...]
    checked: bool = True

    @property
    def error(self) -> int | None:
        """The number of a ``$VNERR``, read as hexadecimal where it is no decimal number; else None."""
        if self.tag != "ERR" or not self.fields:
            return None
        try:
            return int(self.fields[0])
        except ValueError:
            return 255 if self.fields[0].strip().upper() == "FF" else None

    @property
    def register(self) -> int | None:
        """The register that an answer to a read or write is about; else None."""
        if self.tag not in ("RRG", "WRG") or not self.fields or not self.fields[0].isdecimal():
            return None
        return int(self.fields[0])


def sentence_of(data: bytes) -> Sentence:
    """From the bytes of a valid frame."""
    body, _, checksum = data[3:].rpartition(b"*")
    tag, *fields = body.decode("ascii").split(",")
    return Sentence(tag, tuple(fields), checksum.strip() != b"XX")


def encode(tag: str, *fields: object, checksum: ChecksumMode = "xor") -> bytes:
    """A sentence: ``encode("WRG", 7, 40)`` is ``$VNWRG,7,40*…``. Commands and the device's own are alike."""
    body = ",".join(["VN" + tag, *(str(field) for field in fields)]).encode("ascii")
    if not printable(body):
        raise ValueError(f"not for a sentence: {body!r}")
    if checksum == "none":
        return b"$" + body + b"*XX\r\n"
    digits = b"%02X" % xor8(body) if checksum == "xor" else b"%04X" % crc16_xmodem(body)
    return b"$" + body + b"*" + digits + b"\r\n"


def encode_read(register: int, checksum: ChecksumMode = "xor") -> bytes:
    """Ask for a register."""
    return encode("RRG", f"{register:02d}", checksum=checksum)


def encode_write(register: int, *values: object, checksum: ChecksumMode = "xor") -> bytes:
    """Set a register."""
    return encode("WRG", f"{register:02d}", *values, checksum=checksum)


def encode_async(on: bool) -> bytes:
    """Pause or resume what the device sends by itself."""
    return encode("ASY", int(on))


def encode_samples(tag: str, samples: Samples, checksum: ChecksumMode = "xor") -> bytes:
    """Asynchronous messages of kind ``tag`` that say ``samples``, in the device's own digits; a column that
    is not there is written as zero."""
    names = ASYNC_COLUMNS[tag]
    zero = np.zeros(len(samples))
    matrix = np.column_stack([samples.columns.get(name, zero) for name in names])
    spelling = ",".join(_SPELLINGS[name] for name in names)
    return b"".join(encode(tag, spelling % tuple(row), checksum=checksum) for row in matrix)


def numbers_of(lines: Sequence[bytes], columns: int) -> NDArray[np.float64] | None:
    """Shape (lines, columns) from comma-separated numbers; None where a line is something else."""
    text = b",".join(lines)
    if text.translate(None, _NUMERIC):
        return None
    values = text.split(b",")
    if len(values) != columns * len(lines):
        return None
    try:
        return np.array([float(value) for value in values]).reshape(len(lines), columns)
    except ValueError:
        return None


class AsciiDecoder:
    """Sentences as frames; see :class:`~ahrs_lab.instruments.protocols.frames.Decoder`."""

    def __init__(self) -> None:
        self._scanner = FrameScanner([ASCII_FORMAT])
        self.counts: LinkCounts = self._scanner.counts

    def feed(self, data: bytes) -> list[Sentence]:
        return self._sentences(self._scanner.feed(data))

    def flush(self) -> list[Sentence]:
        return self._sentences(self._scanner.flush())

    @staticmethod
    def _sentences(runs: list[Run]) -> list[Sentence]:
        return [sentence_of(data) for run in runs for data in run.frames()]
