"""MicroStrain units on MIP: reference time, rate and acceleration of the sensor data set.

The command that captures the gyro bias (0C/39) is not in here: a unit that has taken its own bias off cannot
be measured for it.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.ahrs.streaming import StreamingAhrs
from ahrs_lab.instruments.drivers.ahrs.unit_settings import UnitSettings
from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.protocols import microstrain_mip as mip
from ahrs_lab.instruments.protocols.microstrain import (
    ACCELERATION,
    ANGULAR_RATE,
    EULER,
    OVER_RANGE,
    REFERENCE_TIME,
    TEMPERATURE,
    MicroStrainStream,
    packet_layout,
)

_NAME_LENGTH = 16


@dataclass(frozen=True)
class MicroStrainSettings(UnitSettings):
    """``rate_hz`` has to be the unit's base rate over a whole number; the unit is asked for it."""

    temperature: bool = True
    over_range: bool = False
    attitude: bool = False

    @property
    def descriptors(self) -> tuple[int, ...]:
        """Fields of a packet, in order."""
        return (
            REFERENCE_TIME,
            ACCELERATION,
            ANGULAR_RATE,
            *((EULER,) if self.attitude else ()),
            *((TEMPERATURE,) if self.temperature else ()),
            *((OVER_RANGE,) if self.over_range else ()),
        )


class MicroStrainAhrs(StreamingAhrs):
    """An :class:`~ahrs_lab.instruments.interfaces.Ahrs`."""

    def __init__(self, settings: MicroStrainSettings, link: Link, clock: Clock) -> None:
        self.settings = settings
        self._decimation = 0
        super().__init__(
            link,
            clock,
            settings.description("rad/s", "g", "MicroStrain"),
            boot_time_s=settings.boot_time_s,
            range_dps=settings.range_dps,
        )

    def _new_decoder(self) -> MicroStrainStream:
        return MicroStrainStream()

    @property
    def _frame_bytes(self) -> float:
        return packet_layout(self.settings.descriptors).length

    def _ask_identity(self) -> str:
        request = mip.encode(mip.BASE_COMMANDS, [(mip.DEVICE_INFO, b"")])
        info = self._ask(
            request, _replied(mip.BASE_COMMANDS, mip.DEVICE_INFO, mip.DEVICE_INFO_REPLY), "device info"
        )
        texts = [
            info[at : at + _NAME_LENGTH].decode("ascii", "replace").strip("\0 ")
            for at in range(2, len(info), _NAME_LENGTH)
        ]
        model, _, serial = (*texts, "", "", "")[:3]
        self._named(model=model, serial_number=serial)
        firmware = int.from_bytes(info[:2], "big")
        return f"MicroStrain {model} s/n {serial} firmware {firmware}"

    def _pause(self) -> None:
        self._ask(mip.encode_idle(), _accepted(mip.BASE_COMMANDS, mip.SET_IDLE), "set to idle")

    def _resume(self) -> None:
        self._ask(mip.encode_stream(True), _accepted(mip.COMMANDS_3DM, mip.STREAM), "stream on")
        self._ask(mip.encode_resume(), _accepted(mip.BASE_COMMANDS, mip.RESUME), "resume")

    def _write_settings(self) -> None:
        self._decimation = self._decimation_of(self._base_rate_hz())
        request = mip.encode_message_format([(d, self._decimation) for d in self.settings.descriptors])
        self._ask(request, _accepted(mip.COMMANDS_3DM, mip.MESSAGE_FORMAT), "message format")

    def _settings(self) -> tuple[Mapping[str, str], Mapping[str, str]]:
        request = mip.encode(mip.COMMANDS_3DM, [(mip.MESSAGE_FORMAT, bytes((mip.READ, mip.SENSOR_DATA, 0)))])
        data = self._ask(
            request,
            _replied(mip.COMMANDS_3DM, mip.MESSAGE_FORMAT, mip.MESSAGE_FORMAT_REPLY),
            "message format",
        )
        wanted = tuple((descriptor, self._decimation) for descriptor in self.settings.descriptors)
        return {"message format": _spelled(wanted)}, {
            "message format": _spelled(mip.message_format_of(data)[1])
        }

    def _base_rate_hz(self) -> int:
        data = self._ask(
            mip.encode_base_rate_request(),
            _replied(mip.COMMANDS_3DM, mip.BASE_RATE, mip.BASE_RATE_REPLY),
            "base rate",
        )
        return int(struct.unpack(">H", data[1:3])[0]) if len(data) >= 3 else 0

    def _decimation_of(self, base_hz: int) -> int:
        decimation = round(base_hz / self.settings.rate_hz)
        if decimation < 1 or abs(base_hz / decimation - self.settings.rate_hz) > 1e-9:
            raise InputError(
                "The MicroStrain unit sends {base}/n times a second, and {rate} is no such rate.",
                base=base_hz,
                rate=self.settings.rate_hz,
            )
        return decimation


def _spelled(fields: tuple[tuple[int, int], ...]) -> str:
    return " ".join(f"{descriptor:02X}/{decimation}" for descriptor, decimation in fields)


def _acknowledgement(packet: mip.MipPacket, descriptor_set: int, command: int) -> bool:
    """Whether the packet acknowledges the command; raises InstrumentError where it refuses it."""
    if packet.descriptor_set != descriptor_set:
        return False
    for acknowledged, code in packet.acknowledgements:
        if acknowledged != command:
            continue
        if code:
            raise InstrumentError(
                "The MicroStrain unit refuses command {command}: code {code}, {text}.",
                command=f"{descriptor_set:02X}/{command:02X}",
                code=code,
                text=mip.ACK_CODES.get(code, "unknown"),
            )
        return True
    return False


def _accepted(descriptor_set: int, command: int) -> Callable[[mip.MipPacket], bool | None]:
    return lambda packet: _acknowledgement(packet, descriptor_set, command) or None


def _replied(descriptor_set: int, command: int, reply: int) -> Callable[[mip.MipPacket], bytes | None]:
    """The data of the reply field that goes with an acknowledgement."""

    def data(packet: mip.MipPacket) -> bytes | None:
        if not _acknowledgement(packet, descriptor_set, command):
            return None
        return next((field.data for field in packet.fields if field.descriptor == reply), None)

    return data
