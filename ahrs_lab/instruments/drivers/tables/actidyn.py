"""Actidyn tables over TCP. Experimental: written from one user's code, never run on the hardware by us. Try
it with the platform empty. ``ALC 0`` is repeated, or the drive drops out after 30 s."""

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
from ahrs_lab.instruments.protocols.actidyn import encode_command, parse_values
from ahrs_lab.instruments.protocols.lines import LineDecoder
from ahrs_lab.instruments.settings import within

_LEAST_VALUES = 2
_LONGEST_ALIVE_S = 25.0


@dataclass(frozen=True)
class ActidynSettings:
    """``user`` and ``code``: of the login ``USR 0,user,code``; an empty code logs nobody in."""

    link: LinkSettings
    axis: int = 1
    user: int = 1
    code: str = ""
    limits: SoftLimits = field(default_factory=lambda: SoftLimits(100.0, 50.0))
    polling: Polling = field(default_factory=Polling)
    wraps: bool = True
    pause_s: float = 0.2
    reply_timeout_s: float = 0.4
    alive_s: float = 10.0

    def __post_init__(self) -> None:
        within("axis", self.axis, 1, 9)
        within("pause_s", self.pause_s, 0.0, 5.0)
        within("reply_timeout_s", self.reply_timeout_s, 0.05, 10.0)
        within("alive_s", self.alive_s, 0.5, _LONGEST_ALIVE_S)


class ActidynDialect:
    """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`. Texts are ``WORD a,b``."""

    def __init__(self, settings: ActidynSettings, link: Link, clock: Clock) -> None:
        self._settings = settings
        self._clock = clock
        self._talk: Conversation[str] = Conversation(link, LineDecoder(b"\n", 512), settings.reply_timeout_s)
        self._alive_s = float("-inf")
        self.wraps = settings.wraps

    @property
    def name(self) -> str:
        """Of the link."""
        return self._talk.link.name

    @property
    def pause_s(self) -> float:
        """Between commands."""
        return self._settings.pause_s

    def connect(self) -> str:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        self._alive_s = float("-inf")
        self._talk.open()
        self.send("RMT 0")
        if self._settings.code:
            self.send(f"USR 0,{self._settings.user},{self._settings.code}")
        return f"Actidyn (experimental), {self.name}"

    def disconnect(self) -> None:
        """Never raises."""
        self._talk.close()

    def enabling(self) -> Sequence[str]:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        axis = self._settings.axis
        return ("ALC 0", f"MOD {axis},1", *self.turning(0.0, entering=True))

    def disabling(self) -> Sequence[str]:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        return (f"MOD {self._settings.axis},OFF",)

    def stopping(self) -> Sequence[str]:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        return (f"MOD {self._settings.axis},STP",)

    def turning(self, rate_dps: float, *, entering: bool) -> Sequence[str]:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        axis = self._settings.axis
        demand = f"RAT {axis},{rate_dps:.6f},{self._settings.limits.max_acceleration_dps2:.6f}"
        return (demand, f"MOD {axis},RAT") if entering else (demand,)

    def pointing(self, angle_deg: float, rate_dps: float) -> Sequence[str]:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        axis = self._settings.axis
        return (f"POS {axis},{angle_deg:.6f},{rate_dps:.6f}", f"MOD {axis},POS")

    def send(self, command: str) -> None:
        """Whether commands are answered is not known: whatever comes is dropped before the next question."""
        word, _, arguments = command.partition(" ")
        self._talk.say(encode_command(word, *arguments.split(",")))

    def read(self) -> TableReading:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        begin = self._clock.now_s()
        line = self._talk.ask(encode_command("PRV", str(self._settings.axis), "?"), tries=2)
        end = self._clock.now_s()
        values = parse_values(line)
        if values is None or len(values) < _LEAST_VALUES:
            raise InstrumentError(
                "The table answers “{text}” to PRV, which is no position and rate.", text=line
            )
        return TableReading(0.5 * (begin + end), values[0], values[1], doubt_s=0.5 * (end - begin))

    def stay(self) -> None:
        """The table's own watchdog wants to hear from us."""
        if self._clock.now_s() - self._alive_s >= self._settings.alive_s:
            self.send("ALC 0")
            self._alive_s = self._clock.now_s()


class ActidynTable(PolledTable):
    """A :class:`~ahrs_lab.instruments.interfaces.RateTable`. Experimental."""

    def __init__(self, settings: ActidynSettings, link: Link, clock: Clock) -> None:
        super().__init__(ActidynDialect(settings, link, clock), settings.limits, clock, settings.polling)
