"""Any table with a short ASCII language, by the template of its settings; with a trial of each text for a
page that helps to find the right ones."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, field

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.conversation import Conversation
from ahrs_lab.instruments.drivers.tables.dialect import TableReading
from ahrs_lab.instruments.drivers.tables.polled_table import PolledTable, Polling
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.links.link_settings import LinkSettings
from ahrs_lab.instruments.protocols.ascii_table import AsciiReading, AsciiTemplate
from ahrs_lab.instruments.protocols.lines import LineDecoder
from ahrs_lab.instruments.settings import settings_from_toml
from ahrs_lab.resource_files import resource_path

_MOVING = ("rate", "position")


@dataclass(frozen=True)
class AsciiTableSettings:
    """``template``: the language, see ``resources/tables``."""

    link: LinkSettings
    template: AsciiTemplate
    limits: SoftLimits = field(default_factory=lambda: SoftLimits(100.0, 50.0))
    polling: Polling = field(default_factory=lambda: Polling(poll_hz=20.0))


def template_from_text(text: str, source: str) -> AsciiTemplate:
    """The language of a TOML file; ``source`` names it in messages. Raises InputError."""
    try:
        table = tomllib.loads(text)
    except ValueError as error:
        raise InputError("{source} is not valid TOML: {reason}.", source=source, reason=str(error)) from error
    return settings_from_toml(AsciiTemplate, table, "")


def template_examples() -> dict[str, str]:
    """The languages that come along, name → text with comments."""
    return {
        path.stem: path.read_text(encoding="utf-8") for path in sorted(resource_path("tables").glob("*.toml"))
    }


@dataclass(frozen=True)
class TemplateTrial:
    """What came of one text. ``reply`` None where nothing came in time. ``reading``: what the query's
    expression found. ``good``: the reply is what the template expects."""

    sent: str
    reply: str | None
    reading: AsciiReading | None
    good: bool


class AsciiTableDialect:
    """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""

    def __init__(self, template: AsciiTemplate, link: Link, clock: Clock) -> None:
        self.template = template
        self._clock = clock
        self._talk: Conversation[str] = Conversation(
            link,
            LineDecoder(template.reply_terminator.encode("ascii", errors="replace"), 1024),
            template.timing.reply_timeout_s,
        )
        self._alive_s = float("-inf")
        self.wraps = template.wraps

    @property
    def name(self) -> str:
        """Of the link."""
        return self._talk.link.name

    @property
    def pause_s(self) -> float:
        """Between commands."""
        return self.template.timing.pause_s

    def connect(self) -> str:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        self._alive_s = float("-inf")
        self._talk.open()
        for text in self.template.render("connect"):
            self.send(text)
        answers = [self._talk.ask(self.template.encode(text)) for text in self.template.render("identify")]
        return " ".join([self.template.name, *(answer.strip() for answer in answers)])

    def open_only(self) -> None:
        """Open the link and say nothing yet."""
        self._talk.open()

    def disconnect(self) -> None:
        """Never raises."""
        self._talk.close()

    def enabling(self) -> Sequence[str]:
        """The template's ``enable``, then rest at rate 0."""
        return (*self.template.render("enable"), *self.turning(0.0, entering=True))

    def disabling(self) -> Sequence[str]:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        return self.template.render("off")

    def stopping(self) -> Sequence[str]:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        return self.template.render("stop")

    def turning(self, rate_dps: float, *, entering: bool) -> Sequence[str]:  # noqa: ARG002 - said whole each time
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        return self.template.render("rate", rate_dps=rate_dps)

    def pointing(self, angle_deg: float, rate_dps: float) -> Sequence[str]:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        return self.template.render("position", rate_dps=rate_dps, angle_deg=angle_deg)

    def send(self, command: str) -> None:
        """Raises InstrumentError where the answer is not the acknowledgement of the template."""
        request = self.template.encode(command)
        if not self.template.replies.acknowledgement:
            self._talk.say(request)
            return
        answer = self._talk.ask(request)
        if not self.template.acknowledges(answer):
            raise InstrumentError(
                "The table answers “{text}” to “{command}”: it refuses, or “replies.acknowledgement” of its "
                "template is wrong.",
                text=answer,
                command=command,
            )

    def read(self) -> TableReading:
        """See :class:`~ahrs_lab.instruments.drivers.tables.dialect.TableDialect`."""
        begin = self._clock.now_s()
        answer = self._talk.ask(self.template.encode(self.template.render("query")[0]), tries=2)
        end = self._clock.now_s()
        reading = self.template.parse(answer)
        if reading is None:
            raise InstrumentError(
                "The table answers “{text}” to its query, which “replies.query” of its template does not "
                "fit.",
                text=answer,
            )
        moment, doubt = 0.5 * (begin + end), 0.5 * (end - begin)
        return TableReading(moment, reading.angle_deg, reading.rate_dps, reading.fault, doubt)

    def stay(self) -> None:
        """The template's ``keep_alive``, where there is one."""
        now = self._clock.now_s()
        if now - self._alive_s >= self.template.timing.keep_alive_s:
            self._alive_s = now
            for text in self.template.render("keep_alive"):
                self.send(text)

    def trial(self, text: str, *, query: bool) -> TemplateTrial:
        """Say a text and show what comes, whatever it is."""
        self._talk.forget()
        self._talk.say(self.template.encode(text))
        reply = self._talk.listen(self.template.timing.reply_timeout_s)
        if query:
            reading = None if reply is None else self.template.parse(reply)
            return TemplateTrial(text, reply, reading, reading is not None)
        if not self.template.replies.acknowledgement:
            return TemplateTrial(text, reply, None, reply is None)
        return TemplateTrial(text, reply, None, reply is not None and self.template.acknowledges(reply))


class AsciiTable(PolledTable):
    """A :class:`~ahrs_lab.instruments.interfaces.RateTable`."""

    def __init__(self, settings: AsciiTableSettings, link: Link, clock: Clock) -> None:
        self._ascii = AsciiTableDialect(settings.template, link, clock)
        super().__init__(self._ascii, settings.limits, clock, settings.polling)

    def try_template(
        self, name: str, *, rate_dps: float = 0.0, angle_deg: float = 0.0
    ) -> tuple[TemplateTrial, ...]:
        """Say the texts of one command of the template ("query", "enable" …), opening the link where it is
        not open, and return the replies. The numbers are held to the soft limits; the table may move."""
        if name not in self._ascii.template.names():
            raise InputError("The table's language has no text for “{name}”.", name=name)
        if name in _MOVING:
            self._soft.check_rate(rate_dps)
            self._soft.check_angle(angle_deg)
        texts = self._ascii.template.render(name, rate_dps=rate_dps, angle_deg=angle_deg)
        with self._commanding, self._talk:
            if not self._identity:
                self._ascii.open_only()
            trials = tuple(self._ascii.trial(text, query=name == "query") for text in texts)
            if name in _MOVING:
                self._mode = "rate" if name == "rate" else "position"
            self._last_command_s = self._clock.now_s()
            return trials
