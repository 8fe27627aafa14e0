"""VectorNav units (VN-100 and relatives) on binary output 1: time since start-up, uncompensated rates and
specific force, temperature.

Uncompensated, because the on-board filter takes its estimate of bias off the other rates. The binary output
holds the newest of 800 samples a second, not their mean over the interval.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.ahrs.streaming import StreamingAhrs
from ahrs_lab.instruments.drivers.ahrs.unit_settings import UnitSettings
from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.protocols.vectornav import VectorNavStream
from ahrs_lab.instruments.protocols.vectornav_ascii import (
    ERRORS,
    Sentence,
    encode_async,
    encode_read,
    encode_write,
)
from ahrs_lab.instruments.protocols.vectornav_binary import ATTITUDE, COMMON, IMU, BinaryOutput
from ahrs_lab.instruments.settings import within

_BASE_HZ = 800
_MODEL, _SERIAL, _FIRMWARE, _ASYNC_TYPE, _BINARY = 1, 3, 4, 6, 75


@dataclass(frozen=True)
class VectorNavSettings(UnitSettings):
    """``rate_hz`` has to be 800 over a whole number. ``port_number``: which of the unit's serial ports the
    link is on. ``attitude``: yaw, pitch and roll of the unit's filter as well."""

    port_number: int = 1
    attitude: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        within("port_number", self.port_number, 1, 2)
        if not self.divisor or abs(_BASE_HZ / self.divisor - self.rate_hz) > 1e-9:
            raise InputError(
                "A VectorNav unit sends 800/n times a second, and {rate} is no such rate: take 100, 200 or "
                "400.",
                rate=self.rate_hz,
            )

    @property
    def divisor(self) -> int:
        """Of the 800 Hz."""
        return round(_BASE_HZ / self.rate_hz)

    @property
    def output(self) -> BinaryOutput:
        """Time since start-up; uncompensated acceleration and rate, temperature; attitude where asked for."""
        fields = {COMMON: [0], IMU: [2, 3, 4]}
        if self.attitude:
            fields[ATTITUDE] = [1]
        return BinaryOutput.of(fields)


class VectorNavAhrs(StreamingAhrs):
    """An :class:`~ahrs_lab.instruments.interfaces.Ahrs`."""

    def __init__(self, settings: VectorNavSettings, link: Link, clock: Clock) -> None:
        self.settings = settings
        super().__init__(
            link,
            clock,
            settings.description("rad/s", "m/s^2", "VectorNav"),
            boot_time_s=settings.boot_time_s,
            range_dps=settings.range_dps,
        )

    def _new_decoder(self) -> VectorNavStream:
        return VectorNavStream()

    @property
    def _frame_bytes(self) -> float:
        return self.settings.output.length

    def _ask_identity(self) -> str:
        model, serial, firmware = (
            ",".join(self._register(number)) for number in (_MODEL, _SERIAL, _FIRMWARE)
        )
        self._named(model=model, serial_number=serial)
        return f"VectorNav {model} s/n {serial} firmware {firmware}"

    def _pause(self) -> None:
        self._ask(encode_async(False), _paused, "$VNASY,0")

    def _resume(self) -> None:
        self._ask(encode_async(True), _resumed, "$VNASY,1")

    def _write_settings(self) -> None:
        self._write(_ASYNC_TYPE, "0")
        self._write(_BINARY, *self._wanted)

    def _settings(self) -> tuple[Mapping[str, str], Mapping[str, str]]:
        mode, divisor, *rest = self._wanted
        found_mode, found_divisor, *found_rest = (*self._register(_BINARY), "", "")[: len(self._wanted)]
        sends = _canonical((self._register(_ASYNC_TYPE) or ("–",))[0])
        return (
            {
                "output port": _canonical(mode),
                "rate divisor": _canonical(divisor),
                "fields": " ".join(map(_canonical, rest)),
                "sentences": "0",
            },
            {
                "output port": _canonical(found_mode),
                "rate divisor": _canonical(found_divisor),
                "fields": " ".join(map(_canonical, found_rest)),
                "sentences": sends,
            },
        )

    @property
    def _wanted(self) -> tuple[str, ...]:
        output = self.settings.output
        masks = (f"{mask:04X}" for _, mask in output.masks)
        return (str(self.settings.port_number), str(self.settings.divisor), f"{output.groups:02X}", *masks)

    def _register(self, number: int) -> tuple[str, ...]:
        return self._ask(encode_read(number), _about(number, "RRG"), f"$VNRRG,{number:02d}")

    def _write(self, number: int, *values: str) -> None:
        self._ask(encode_write(number, *values), _about(number, "WRG"), f"$VNWRG,{number:02d}")


def _about(number: int, tag: str) -> Callable[[Sentence], tuple[str, ...] | None]:
    """The values of the answer about a register; raises InstrumentError on an error message."""

    def values(sentence: Sentence) -> tuple[str, ...] | None:
        _raise_error(sentence, f"register {number}")
        if sentence.tag == tag and sentence.register == number:
            return sentence.fields[1:]
        return None

    return values


def _paused(sentence: Sentence) -> bool | None:
    _raise_error(sentence, "$VNASY")
    return True if sentence.tag == "ASY" and sentence.fields[:1] == ("0",) else None


def _resumed(sentence: Sentence) -> bool | None:
    _raise_error(sentence, "$VNASY")
    return True if sentence.tag == "ASY" and sentence.fields[:1] == ("1",) else None


_PASSING = (3, 11)
"""Errors after which asking again helps: a checksum damaged on the way, an output that was too full."""


def _raise_error(sentence: Sentence, what: str) -> None:
    code = sentence.error
    if code is not None and code not in _PASSING:
        raise InstrumentError(
            "The VectorNav unit refuses {what}: error {code}, {text}.",
            what=what,
            code=code,
            text=ERRORS.get(code, "unknown"),
        )


def _canonical(text: str) -> str:
    """A number without leading zeros, so that 05 and 5 are the same."""
    stripped = text.strip().upper().lstrip("0")
    return stripped or ("0" if text.strip() else "")
