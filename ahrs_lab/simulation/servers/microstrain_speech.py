"""A 3DM unit as it speaks MIP: idle and resume, base rate and decimation, message format, stream switch."""

from __future__ import annotations

import struct

from ahrs_lab.instruments.protocols import microstrain_mip as mip
from ahrs_lab.instruments.protocols.microstrain import encode_samples, packet_layout
from ahrs_lab.recording.samples import Samples

_UNKNOWN, _INVALID = 1, 3
_NAME_LENGTH = 16


class MicroStrainSpeech:
    """See :class:`~ahrs_lab.simulation.servers.ahrs_service.Speech`. It comes up streaming the format it was
    delivered with: acceleration and rate without a time."""

    def __init__(self, world_rate_hz: float, model: str, serial_number: str) -> None:
        self.world_rate_hz = world_rate_hz
        self.model, self.serial_number = model, serial_number
        self.reboots = False
        self._decoder = mip.MipDecoder()
        self._idle = False
        self._on = True
        self.format: tuple[tuple[int, int], ...] = ()
        self.boot()

    def boot(self) -> bytes:
        """See :class:`~ahrs_lab.simulation.servers.ahrs_service.Speech`."""
        self._idle, self._on = False, True
        self.format = ((0x04, 1), (0x05, 1))
        return b""

    @property
    def streaming(self) -> bool:
        """Whether it sends by itself."""
        return self._on and not self._idle and bool(self.format)

    @property
    def rate_hz(self) -> float:
        """Of what it sends now."""
        return self.world_rate_hz / (self.format[0][1] if self.format else 1)

    def hear(self, data: bytes) -> bytes:
        """See :class:`~ahrs_lab.simulation.servers.ahrs_service.Speech`."""
        answers = [
            self._answer(packet.descriptor_set, field)
            for packet in self._decoder.feed(data)
            for field in packet.fields
        ]
        return b"".join(answers)

    def say(self, samples: Samples) -> bytes:
        """See :class:`~ahrs_lab.simulation.servers.ahrs_service.Speech`."""
        return encode_samples([descriptor for descriptor, _ in self.format], samples)

    def _answer(self, descriptor_set: int, field: mip.MipField) -> bytes:
        code, reply = self._do(descriptor_set, field.descriptor, field.data)
        return mip.encode_acknowledge(descriptor_set, field.descriptor, code, reply)

    def _do(self, descriptor_set: int, command: int, data: bytes) -> tuple[int, list[tuple[int, bytes]]]:
        match descriptor_set, command:
            case mip.BASE_COMMANDS, mip.PING:
                return 0, []
            case mip.BASE_COMMANDS, mip.SET_IDLE:
                self._idle = True
                return 0, []
            case mip.BASE_COMMANDS, mip.RESUME:
                self._idle = False
                return 0, []
            case mip.BASE_COMMANDS, mip.DEVICE_INFO:
                return 0, [(mip.DEVICE_INFO_REPLY, self._info())]
            case mip.COMMANDS_3DM, mip.BASE_RATE if data[:1] == bytes((mip.SENSOR_DATA,)):
                rate = struct.pack(">BH", mip.SENSOR_DATA, round(self.world_rate_hz))
                return 0, [(mip.BASE_RATE_REPLY, rate)]
            case mip.COMMANDS_3DM, mip.MESSAGE_FORMAT if len(data) >= 2:
                return self._message_format(data)
            case mip.COMMANDS_3DM, mip.STREAM if len(data) >= 2:
                return self._stream(data)
        return _UNKNOWN, []

    def _info(self) -> bytes:
        texts = (self.model, "6286-9999", self.serial_number, "", "")
        fields = [text.encode("ascii", "replace")[:_NAME_LENGTH].rjust(_NAME_LENGTH) for text in texts]
        return struct.pack(">H", 1200) + b"".join(fields)

    def _message_format(self, data: bytes) -> tuple[int, list[tuple[int, bytes]]]:
        if data[0] == mip.APPLY:
            data_set, wanted = mip.message_format_of(data[1:])
            try:
                packet_layout([descriptor for descriptor, _ in wanted])
            except ValueError:
                return _INVALID, []
            if data_set != mip.SENSOR_DATA or len({n for _, n in wanted}) != 1 or wanted[0][1] < 1:
                return _INVALID, []
            self.format = wanted
            return 0, []
        if data[0] == mip.READ and data[1] == mip.SENSOR_DATA:
            return 0, [(mip.MESSAGE_FORMAT_REPLY, mip.message_format_data(self.format))]
        return _INVALID, []

    def _stream(self, data: bytes) -> tuple[int, list[tuple[int, bytes]]]:
        if data[1] != mip.SENSOR_DATA:
            return _INVALID, []
        if data[0] == mip.APPLY and len(data) >= 3:
            self._on = bool(data[2])
            return 0, []
        if data[0] == mip.READ:
            return 0, [(mip.STREAM_REPLY, bytes((mip.SENSOR_DATA, int(self._on))))]
        return _INVALID, []
