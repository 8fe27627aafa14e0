"""Ideal Aerosmith ATL tables (1270 and older). Experimental: written from one user's code, never run on the
hardware by us. Try it with the platform empty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from ahrs_lab.errors import InstrumentError
from ahrs_lab.instruments.angles import TURN_DEG
from ahrs_lab.instruments.drivers.conversation import Conversation
from ahrs_lab.instruments.drivers.tables.dialect import TableReading
from ahrs_lab.instruments.drivers.tables.polled_table import PolledTable, Polling
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.instruments.links.link import Link, LinkLostError
from ahrs_lab.instruments.links.link_settings import LinkSettings
from ahrs_lab.instruments.protocols.atl import AnswerDecoder, encode_command
from ahrs_lab.instruments.settings import within

_WITHOUT_PROMPT = "JOG"


@dataclass(frozen=True)
class AtlSettings:
    """``wraps``: MOV takes the shortest path to 0 … 360°, which nobody has confirmed."""

    link: LinkSettings
    limits: SoftLimits = field(default_factory=lambda: SoftLimits(100.0, 50.0))
    polling: Polling = field(default_factory=lambda: Polling(poll_hz=10.0))
    wraps: bool = True
    pause_s: float = 0.2
    reply_timeout_s: float = 0.4

    def __post_init__(self) -> None:
        within("pause_s", self.pause_s, 0.0, 5.0)
        within("reply_timeout_s", self.reply_timeout_s, 0.05, 10.0)


class AtlDialect:
    """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`. Texts are ``WORD value``."""

    def __init__(self, settings: AtlSettings, link: Link, clock: Clock) -> None:
        self._settings = settings
        self._clock = clock
        self._talk: Conversation[tuple[str, ...]] = Conversation(
            link, AnswerDecoder(), settings.reply_timeout_s
        )
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
        """The language has no question for a name."""
        self._talk.open()
        return f"Ideal Aerosmith ATL (experimental), {self.name}"

    def disconnect(self) -> None:
        """Never raises."""
        self._talk.close()

    def enabling(self) -> Sequence[str]:
        """Stop, acceleration, rest."""
        return ("STO", f"ACL {self._settings.limits.max_acceleration_dps2:.6f}", "JOG 0")

    def disabling(self) -> Sequence[str]:
        """There is no servo off in what is known of the language."""
        return ("STO",)

    def stopping(self) -> Sequence[str]:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        return ("STO",)

    def turning(self, rate_dps: float, *, entering: bool) -> Sequence[str]:  # noqa: ARG002 - one mode only
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        return (f"JOG {rate_dps:.6f}",)

    def pointing(self, angle_deg: float, rate_dps: float) -> Sequence[str]:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        angle = angle_deg % TURN_DEG if self.wraps else angle_deg
        return (f"VEL {rate_dps:.6f}", f"MOV {angle:.6f}")

    def send(self, command: str) -> None:
        """``JOG`` gives its prompt only with the next command."""
        word, _, value = command.partition(" ")
        request = encode_command(word, float(value) if value else None)
        if word == _WITHOUT_PROMPT:
            self._talk.say(request)
        else:
            self._talk.ask(request)

    def read(self) -> TableReading:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        begin = self._clock.now_s()
        angle = self._number("PPO")
        end = self._clock.now_s()
        rate = self._number("PVE")
        return TableReading(0.5 * (begin + end), angle, rate, doubt_s=0.5 * (end - begin))

    def stay(self) -> None:
        """Nothing is known to be needed."""

    def _number(self, word: str) -> float:
        answer = self._talk.ask(encode_command(word), tries=2)
        if not answer:  # the prompt that JOG still owed
            late = self._talk.listen(self._talk.timeout_s)
            if late is None:
                raise LinkLostError(
                    "{name} has answered “{word}” with a prompt only.", name=self.name, word=word
                )
            answer = late
        try:
            value = float(answer[-1])
        except (ValueError, IndexError) as error:
            raise InstrumentError(
                "The table answers “{text}” to {word}, which is no number.", text=" ".join(answer), word=word
            ) from error
        if value - value != 0.0:
            raise InstrumentError(
                "The table answers “{text}” to {word}, which is no number.", text=" ".join(answer), word=word
            )
        return value


class AtlTable(PolledTable):
    """A :class:`~ahrs_lab.instruments.interfaces.RateTable`. Experimental."""

    def __init__(self, settings: AtlSettings, link: Link, clock: Clock) -> None:
        super().__init__(AtlDialect(settings, link, clock), settings.limits, clock, settings.polling)
