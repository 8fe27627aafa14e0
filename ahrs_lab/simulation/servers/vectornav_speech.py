"""A VN-100 as it speaks: registers, asynchronous sentences, binary output 1."""

from __future__ import annotations

from ahrs_lab.instruments.protocols.vectornav_ascii import (
    ASYNC_NUMBERS,
    AsciiDecoder,
    Sentence,
    encode,
    encode_samples,
)
from ahrs_lab.instruments.protocols.vectornav_binary import BinaryOutput
from ahrs_lab.instruments.protocols.vectornav_binary import encode_samples as encode_binary
from ahrs_lab.recording.samples import Samples

MODEL, SERIAL, FIRMWARE, BAUD, ASYNC_TYPE, ASYNC_RATE, BINARY = 1, 3, 4, 5, 6, 7, 75
_READ_ONLY = (MODEL, SERIAL, FIRMWARE)
_FILTERED = ("YPR", "YMR")
_BASE_HZ = 800
_ASYNC_RATES = (1, 2, 4, 5, 10, 20, 25, 40, 50, 100, 200)
_INVALID_CHECKSUM, _INVALID_COMMAND, _INVALID_PARAMETER, _INVALID_REGISTER, _READ_ONLY_ERROR = 3, 4, 7, 8, 9
_TAG_OF = {number: tag for tag, number in ASYNC_NUMBERS.items()}


class VectorNavSpeech:
    """See :class:`~ahrs_lab.simulation.servers.ahrs_service.Speech`. It comes up sending ``$VNYMR`` as units
    do that leave the factory: a driver has to cope with a stream that runs already."""

    def __init__(self, world_rate_hz: float, model: str, serial_number: str) -> None:
        self.world_rate_hz = world_rate_hz
        self.model, self.serial_number = model, serial_number
        self.reboots = False
        self._decoder = AsciiDecoder()
        self._failed = 0
        self.registers: dict[int, tuple[str, ...]] = {}
        self.streaming = True
        self.boot()

    def boot(self) -> bytes:
        """See :class:`~ahrs_lab.simulation.servers.ahrs_service.Speech`."""
        rate = max((hz for hz in _ASYNC_RATES if hz <= 40 and self._divides(hz)), default=1)
        self.registers = {
            MODEL: (self.model,),
            SERIAL: (self.serial_number,),
            FIRMWARE: ("3.1.0.0",),
            BAUD: ("115200",),
            ASYNC_TYPE: ("14",),
            ASYNC_RATE: (str(rate),),
            BINARY: ("0", "80", "00"),
        }
        self.streaming = True
        return b""

    @property
    def rate_hz(self) -> float:
        """Of what it sends now."""
        if self._binary is not None:
            return _BASE_HZ / int(self.registers[BINARY][1])
        return float(self.registers[ASYNC_RATE][0])

    def hear(self, data: bytes) -> bytes:
        """See :class:`~ahrs_lab.simulation.servers.ahrs_service.Speech`."""
        sentences = self._decoder.feed(data)
        failed = self._decoder.counts.failed - self._failed
        self._failed = self._decoder.counts.failed
        return b"".join([*(self._answer(s) for s in sentences), *[_error(_INVALID_CHECKSUM)] * failed])

    def say(self, samples: Samples) -> bytes:
        """See :class:`~ahrs_lab.simulation.servers.ahrs_service.Speech`."""
        output = self._binary
        if output is not None:
            return encode_binary(output, samples)
        tag = _TAG_OF.get(int(self.registers[ASYNC_TYPE][0]))
        return b"" if tag is None else encode_samples(tag, samples)

    @property
    def _binary(self) -> BinaryOutput | None:
        mode, _, groups, *masks = self.registers[BINARY]
        if mode == "0":
            return None
        present = [bit for bit in range(8) if int(groups, 16) >> bit & 1]
        return BinaryOutput(tuple(zip(present, (int(mask, 16) for mask in masks), strict=True)))

    def _answer(self, sentence: Sentence) -> bytes:
        if sentence.tag == "ASY" and sentence.fields in (("0",), ("1",)):
            self.streaming = sentence.fields == ("1",)
            return encode("ASY", *sentence.fields)
        if sentence.tag == "RST":
            self.reboots = True
            return encode("RST")
        number = sentence.register
        if number is None:
            return _error(_INVALID_COMMAND)
        if number not in self.registers:
            return _error(_INVALID_REGISTER)
        if sentence.tag == "RRG":
            return encode("RRG", f"{number:02d}", *self.registers[number])
        values = sentence.fields[1:]
        if number in _READ_ONLY:
            return _error(_READ_ONLY_ERROR)
        if not values or not self._fits(number, values):
            return _error(_INVALID_PARAMETER)
        self.registers[number] = values
        return encode("WRG", f"{number:02d}", *values)

    def _fits(self, number: int, values: tuple[str, ...]) -> bool:
        try:
            if number == ASYNC_TYPE:
                return values[0] == "0" or int(values[0]) in _TAG_OF
            if number == ASYNC_RATE:
                return int(values[0]) in _ASYNC_RATES and self._divides(int(values[0]))
            if number == BINARY:
                return self._fits_binary(values)
            return number == BAUD and int(values[0]) > 0
        except ValueError:
            return False

    def _fits_binary(self, values: tuple[str, ...]) -> bool:
        mode, divisor, groups, *masks = values
        if mode == "0":
            return True
        present = [bit for bit in range(8) if int(groups, 16) >> bit & 1]
        BinaryOutput(tuple(zip(present, (int(mask, 16) for mask in masks), strict=True)))
        return int(divisor) > 0 and self._divides(_BASE_HZ / int(divisor))

    def _divides(self, rate_hz: float) -> bool:
        every = self.world_rate_hz / rate_hz
        return every >= 1.0 - 1e-9 and abs(every - round(every)) < 1e-9


def _error(code: int) -> bytes:
    return encode("ERR", code)
