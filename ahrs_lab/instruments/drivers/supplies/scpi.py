"""A DC supply that speaks SCPI: ``VOLT``, ``CURR``, ``OUTP``, ``MEAS:VOLT?``, ``MEAS:CURR?``."""

from __future__ import annotations

from dataclasses import dataclass

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.reading_loop import ReadingLoop
from ahrs_lab.instruments.drivers.scpi_talk import ScpiConnection, ScpiTalk
from ahrs_lab.instruments.interfaces import Clock, SupplyReading
from ahrs_lab.instruments.protocols.scpi import number_text, parse_number, parse_switch
from ahrs_lab.instruments.settings import Difference, within

_READ_BACK = 0.005


@dataclass(frozen=True)
class ScpiSupplySettings:
    """``max_voltage_v`` and ``max_current_a``: more is refused before it is sent, whatever the supply could.
    ``select``: said after connecting, to choose a channel (``INST:NSEL 1``)."""

    connection: ScpiConnection
    max_voltage_v: float = 32.0
    max_current_a: float = 5.0
    select: str = ""
    period_s: float = 0.2

    def __post_init__(self) -> None:
        within("max_voltage_v", self.max_voltage_v, 0.1, 1000.0)
        within("max_current_a", self.max_current_a, 0.001, 1000.0)
        within("period_s", self.period_s, 0.02, 10.0)


class ScpiSupply:
    """A :class:`~ahrs_lab.instruments.interfaces.Supply`. Read in the background five times a second."""

    def __init__(self, settings: ScpiSupplySettings, talk: ScpiTalk, clock: Clock) -> None:
        self._settings = settings
        self._talk = talk
        self._clock = clock
        self._identity = ""
        self._wanted: tuple[float, float] | None = None
        self._loop = ReadingLoop(f"supply {talk.name}", self._measure, self._reconnect, settings.period_s)

    def open(self) -> str:
        """Connect, and read from now on; who answered. The output is left as it is."""
        identity = self.connect()
        self._loop.start()
        return identity

    def connect(self) -> str:
        """Connect and ask who is there."""
        with self._loop.lock:
            self._talk.open()
            self._identity = self._talk.ask("*IDN?")
            if self._settings.select:
                self._talk.say(self._settings.select)
            return self._identity

    def close(self) -> None:
        """End the thread and release the link; the output is left as it is."""
        self._loop.close()
        self._talk.close()

    def identify(self) -> str:
        """Who answered when the link was opened last."""
        return self._identity

    def set_output(self, voltage_v: float, current_limit_a: float) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.Supply`. Raises InstrumentError where the supply reads
        back something else."""
        differences = self.configure(voltage_v, current_limit_a)
        if differences:
            raise InstrumentError(differences[0].message)

    def configure(self, voltage_v: float, current_limit_a: float) -> tuple[Difference, ...]:
        """Set, read back, and return what differs. Raises InputError beyond the limits."""
        s = self._settings
        if not 0.0 <= voltage_v <= s.max_voltage_v:
            raise InputError(
                "The supply may not give {voltage_v} V: its limit is set to {limit_v} V.",
                voltage_v=voltage_v,
                limit_v=s.max_voltage_v,
            )
        if not 0.0 < current_limit_a <= s.max_current_a:
            raise InputError(
                "The supply's current limit may not be {current_a} A: set it above 0 and up to {limit_a} A.",
                current_a=current_limit_a,
                limit_a=s.max_current_a,
            )
        with self._loop.lock:
            # The limit first: a higher voltage must not meet an old, higher limit.
            self._talk.say(f"CURR {number_text(current_limit_a)}")
            self._talk.say(f"VOLT {number_text(voltage_v)}")
            self._wanted = (voltage_v, current_limit_a)
            return self._differences()

    def on(self) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.Supply`."""
        self._switch("OUTP ON", True)

    def off(self) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.Supply`."""
        self._switch("OUTP OFF", False)

    def read(self) -> SupplyReading:
        """The last reading, less than half a second old. Raises what is wrong with the supply."""
        return self._loop.latest()

    def _switch(self, text: str, wanted: bool) -> None:
        with self._loop.lock:
            self._talk.say(text)
            reading = self._loop.refresh()
        if reading.output_on is not wanted:
            raise InstrumentError(
                "The supply was told “{text}”, but its output is {state}: check whether it is locked or "
                "has tripped.",
                text=text,
                state="ON" if reading.output_on else "OFF",
            )

    def _measure(self) -> SupplyReading:
        begin = self._clock.now_s()
        voltage = self._number("MEAS:VOLT?")
        current = self._number("MEAS:CURR?")
        answer = self._talk.ask("OUTP?")
        on = parse_switch(answer)
        if on is None:
            raise _not_understood("OUTP?", answer)
        return SupplyReading(0.5 * (begin + self._clock.now_s()), voltage, current, on)

    def _differences(self) -> tuple[Difference, ...]:
        if self._wanted is None:
            return ()
        found = (self._number("VOLT?"), self._number("CURR?"))
        return tuple(
            Difference(name, number_text(wanted), number_text(read))
            for name, wanted, read in zip(("VOLT", "CURR"), self._wanted, found, strict=True)
            if abs(read - wanted) > _READ_BACK * max(abs(wanted), 1.0)
        )

    def _reconnect(self) -> None:
        """Once the link is back: the same supply, set as before? If not, reading goes on to fail."""
        before = self._identity
        self._talk.close()
        identity = self.connect()
        if identity != before:
            self._identity = before
            raise InstrumentError(
                "After the link was lost another supply answers: {found} instead of {wanted}.",
                found=identity,
                wanted=before,
            )
        differences = self._differences()
        if differences:
            raise InstrumentError(differences[0].message)

    def _number(self, query: str) -> float:
        answer = self._talk.ask(query)
        value = parse_number(answer)
        if value is None:
            raise _not_understood(query, answer)
        return value


def _not_understood(query: str, answer: str) -> InstrumentError:
    return InstrumentError("The supply answers “{text}” to {query}.", text=answer, query=query)
