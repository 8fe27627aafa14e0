"""Acutronic ACUTROL 3000 over ACL: the reference driver.

Order that ran on hardware: ``Interlock:Reset``, ``Mode:Off``, ``Interlock:Close``, ``Demand:Rate 0``,
``Mode:Rate`` … ``Demand:Rate 0``, ``Interlock:Open``. Demands persist and act when their mode is entered, so
a demand is always written before its mode.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from ahrs_lab.errors import InstrumentError
from ahrs_lab.instruments.drivers.conversation import Conversation
from ahrs_lab.instruments.drivers.tables.dialect import TableReading
from ahrs_lab.instruments.drivers.tables.polled_table import PolledTable, Polling
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.links.link_settings import LinkSettings
from ahrs_lab.instruments.patience import patient_s
from ahrs_lab.instruments.protocols.acutrol import (
    INTERLOCK_STATES,
    Reply,
    ReplyDecoder,
    bit_names,
    encode_request,
    register,
)
from ahrs_lab.instruments.settings import Difference, within
from ahrs_lab.messages import Message

_STATUS_EVERY = 8
"""Looks between two questions about faults: a few times a second."""
_ABORT_BITS = 1 << 6 | 1 << 7
_FAULT_REGISTERS = ("SWFLT", "INTLK", "STATE")
_READ_BACK = 1e-4
_CLOSING_S = 3.0
_CLOSING_LOOK_S = 0.1
_REPLY_HEADER = 8
_QUICK_S = 0.008
"""An answer takes 2 ms on TCP."""
_TRIES = 3


@dataclass(frozen=True)
class AcutrolSettings:
    """``trip_rate_dps``: where the table itself trips in rate mode; 0 leaves it as it is. ``lockout`` locks
    the table's own front panel while the link is open, its stop button with it on some firmware."""

    link: LinkSettings
    axis: int = 1
    limits: SoftLimits = field(default_factory=lambda: SoftLimits(200.0, 100.0))
    polling: Polling = field(default_factory=Polling)
    trip_rate_dps: float = 0.0
    pause_s: float = 0.2
    reply_timeout_s: float = 0.4
    lockout: bool = False

    def __post_init__(self) -> None:
        within("axis", self.axis, 1, 9)
        within("trip_rate_dps", self.trip_rate_dps, 0.0, 10_000.0)
        within("pause_s", self.pause_s, 0.0, 5.0)
        within("reply_timeout_s", self.reply_timeout_s, 0.05, 10.0)


class AcutrolDialect:
    """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""

    wraps = True

    def __init__(self, settings: AcutrolSettings, link: Link, clock: Clock) -> None:
        self._settings = settings
        self._clock = clock
        self._talk: Conversation[Reply] = Conversation(link, ReplyDecoder(), settings.reply_timeout_s)
        self._position_limit: float | None = None
        self._looks = 0
        self._closed = False

    @property
    def name(self) -> str:
        """Of the link."""
        return self._talk.link.name

    @property
    def pause_s(self) -> float:
        """Between state-changing commands."""
        return self._settings.pause_s

    def connect(self) -> str:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        self._position_limit, self._looks, self._closed = None, 0, False
        self._talk.open()
        identity = self.query("*IDN?")
        if self._settings.lockout:
            self.send(":Utility:Lockout ON")
        return identity

    def disconnect(self) -> None:
        """Never raises."""
        self._talk.close()

    def enabling(self) -> Sequence[str]:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        axis = self._settings.axis
        return (
            f":Interlock:Reset {axis}",
            f":Mode:Off {axis}",
            f":Interlock:Close {axis}",
            f":Demand:Rate {axis},0",
            f":Mode:Rate {axis}",
        )

    def disabling(self) -> Sequence[str]:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        return (f":Demand:Rate {self._settings.axis},0", f":Interlock:Open {self._settings.axis}")

    def stopping(self) -> Sequence[str]:
        """The soft stop: closed loop at zero rate."""
        return (f":Mode:Off {self._settings.axis}",)

    def turning(self, rate_dps: float, *, entering: bool) -> Sequence[str]:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        axis = self._settings.axis
        demand = f":Demand:Rate {axis},{_number(rate_dps)}"
        return (demand, f":Mode:Rate {axis}") if entering else (demand,)

    def pointing(self, angle_deg: float, rate_dps: float) -> Sequence[str]:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        axis = self._settings.axis
        commands = [f":Demand:Position {axis},{_number(angle_deg)}", f":Mode:Position {axis}"]
        if self._position_limit != rate_dps:
            commands.insert(0, f":Limit:Rate P,{axis},{_number(rate_dps)}")
        return commands

    def send(self, command: str) -> None:
        """Raises InstrumentError with the table's own text where it refuses."""
        self.query(command)
        if command.startswith(":Limit:Rate P,"):
            self._position_limit = float(command.rsplit(",", 1)[1])
        elif command.startswith(":Interlock:"):
            self._closed = False  # until it is seen closed: power comes up slowly

    def query(self, request: str) -> str:
        """The answer's text. Raises InstrumentError where its code is not 0."""
        reply = self._talk.ask(encode_request(request), tries=2 if "?" in request else 1)
        if reply.code:
            explained = self._talk.ask(encode_request(f":Query:Error? {reply.code}"))
            raise InstrumentError(
                "The rate table refuses “{command}”: error {code}, {text}.",
                command=request,
                code=reply.code,
                text=explained.text or reply.text,
            )
        return reply.text

    def read(self) -> TableReading:
        """Angle, rate and now and then the state of the interlock."""
        axis = self._settings.axis
        moment, doubt, text = self._asked_quickly(f":Read:Pos? {axis};Rate? {axis}")
        angle, rate = _numbers(text, 2)
        fault: str | Message = ""
        if self._looks % _STATUS_EVERY == 0:
            fault = self._fault()
        self._looks += 1
        return TableReading(moment, angle, rate, fault, doubt)

    def _asked_quickly(self, request: str) -> tuple[float, float, str]:
        """When the answer was true, by how much that may be wrong, and the answer. One that took long, as a
        computer was busy, may be of any moment of that time: then ask again, keep what took least."""
        best = (float("inf"), 0.0, "")
        quick = _QUICK_S * float(getattr(self._clock, "speed", 1.0))
        for _ in range(_TRIES):
            begin = self._clock.now_s()
            text = self.query(request)
            end = self._clock.now_s()
            # What a slow line takes for the bytes is not uncertainty of the moment.
            asked = self._talk.on_the_wire_s(len(request) + 2)
            answered = self._talk.on_the_wire_s(len(text) + _REPLY_HEADER)
            moment = max(begin, min(0.5 * (begin + asked + end - answered), end))
            best = min(best, (end - begin - asked - answered, moment, text))
            if best[0] <= quick:
                break
        return best[1], 0.5 * max(best[0], 0.0), best[2]

    def stay(self) -> None:
        """Nothing to do: the table keeps its state."""

    def interlock(self) -> str:
        """ "Close", "Open" or "Fault"."""
        text = self.query(f":Interlock? {self._settings.axis}")
        for state in INTERLOCK_STATES:
            if text and state.lower().startswith(text.lower()):
                return state
        raise InstrumentError("The rate table says “{text}” about its interlock.", text=text)

    def _fault(self) -> str | Message:
        axis = self._settings.axis
        interlock = self.interlock()
        state = _whole(self.query(f":Status:CSR? {register(axis, 'STATE')}"))
        if interlock == "Fault" or state & _ABORT_BITS:
            texts: list[str] = []
            for name in _FAULT_REGISTERS:
                value = _whole(self.query(f":Status:ESR? {register(axis, name)}"))
                if name == "STATE":
                    value &= _ABORT_BITS
                texts += bit_names(name, value)
            return ", ".join(dict.fromkeys(texts)) or Message("interlock fault")
        opened = self._closed and interlock == "Open"
        self._closed = interlock == "Close"
        return Message("the interlock has opened") if opened else ""

    def limit(self, name: str, letter: str) -> float:
        """A limit as the table reads it back: ``name`` Rate, Acceleration or Vtrip, ``letter`` of the
        mode."""
        return _numbers(self.query(f":Limit:{name}? {letter},{self._settings.axis}"), 1)[0]


class AcutrolTable(PolledTable):
    """A :class:`~ahrs_lab.instruments.interfaces.RateTable`."""

    def __init__(self, settings: AcutrolSettings, link: Link, clock: Clock) -> None:
        self._settings = settings
        self._acl = AcutrolDialect(settings, link, clock)
        super().__init__(self._acl, settings.limits, clock, settings.polling)

    def enable(self) -> None:
        """Acknowledge faults and servo on. Raises InstrumentError where the interlock stays open."""
        super().enable()
        end = self._clock.now_s() + patient_s(self._clock, _CLOSING_S)
        while True:
            with self._talk:
                interlock = self._acl.interlock()
            if interlock != "Open":
                return  # a fault shows in the state
            if self._clock.now_s() >= end:
                self._enabled = False
                raise InstrumentError(
                    "The rate table's interlock stays open: check its emergency stop, its doors and its "
                    "power amplifier."
                )
            self._clock.wait(_CLOSING_LOOK_S)

    def configure(self, acceleration_dps2: float | None = None) -> tuple[Difference, ...]:
        """Set rate, acceleration and trip limits of position and rate mode, read them back, and return what
        differs. ``acceleration_dps2``: lower than the soft limit. The table has to be at rest."""
        acceleration = self._soft.max_acceleration_dps2 if acceleration_dps2 is None else acceleration_dps2
        self._soft.check_acceleration(acceleration)
        if self.state().moving:
            raise InstrumentError("The rate table turns: stop it before it is configured.")
        wanted = [
            ("Rate", "P", self._soft.max_rate_dps),
            ("Rate", "R", self._soft.max_rate_dps),
            ("Acceleration", "P", acceleration),
            ("Acceleration", "R", acceleration),
        ]
        if self._settings.trip_rate_dps:
            wanted.append(("Vtrip", "R", self._settings.trip_rate_dps))
        axis = self._settings.axis
        with self._commanding:
            generation = self._generation
            commands = [f":Limit:{name} {letter},{axis},{_number(value)}" for name, letter, value in wanted]
            self._say(generation, commands)
            with self._talk:
                found = [self._acl.limit(name, letter) for name, letter, _ in wanted]
        return tuple(
            Difference(f"{name} {letter}", _number(value), _number(read))
            for (name, letter, value), read in zip(wanted, found, strict=True)
            if abs(read - value) > _READ_BACK * abs(value)
        )


def _number(value: float) -> str:
    """Plain decimals: exponents are not in the language's description."""
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def _numbers(text: str, count: int) -> list[float]:
    try:
        values = [float(part) for part in text.split(";")]
    except ValueError as error:
        raise _not_understood(text) from error
    if len(values) != count or any(value - value != 0.0 for value in values):
        raise _not_understood(text)
    return values


def _whole(text: str) -> int:
    try:
        return int(text)
    except ValueError as error:
        raise _not_understood(text) from error


def _not_understood(text: str) -> InstrumentError:
    return InstrumentError(
        "The rate table has answered “{text}”, which is no number: check its firmware and the axis.",
        text=text,
    )
