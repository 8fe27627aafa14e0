"""Two ways to a SCPI instrument: a link of our own (serial port, TCP socket), or any VISA resource through
PyVISA's pure-Python backend (``ASRL…``, ``TCPIP…::INSTR``, ``TCPIP…::SOCKET``, ``USB…``, ``GPIB…``).

PyVISA opens more kinds of instruments than our links. Our links notice a closed connection at once, where
PyVISA's raw sockets know only that no answer has come.
"""

from __future__ import annotations

import threading
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, Protocol

from ahrs_lab.errors import InputError, MachineError
from ahrs_lab.instruments.drivers.conversation import Conversation
from ahrs_lab.instruments.links.link import Link, LinkLostError
from ahrs_lab.instruments.links.link_settings import LinkSettings, make_link
from ahrs_lab.instruments.protocols.scpi import answer_decoder, encode_line
from ahrs_lab.instruments.settings import within

if TYPE_CHECKING:
    from pyvisa.resources import MessageBasedResource

DEFAULT_PORT = 5025


@dataclass(frozen=True)
class ScpiConnection:
    """Either ``link``, or ``resource``: a VISA resource string. ``baud`` is for a serial resource."""

    link: LinkSettings | None = None
    resource: str = ""
    baud: int = 9600
    terminator: Literal["\n", "\r\n", "\r"] = "\n"
    timeout_s: float = 0.8

    def __post_init__(self) -> None:
        if (self.link is None) == (not self.resource):
            raise InputError("A SCPI instrument needs either “link” or “resource”, not both and not none.")
        within("connection.timeout_s", self.timeout_s, 0.05, 30.0)


class ScpiTalk(Protocol):
    """Say and ask; raises LinkLostError where nothing answers."""

    @property
    def name(self) -> str: ...
    def open(self) -> None: ...
    def close(self) -> None: ...
    def say(self, text: str) -> None: ...
    def ask(self, text: str) -> str: ...


class LinkTalk:
    """A :class:`ScpiTalk` over a link."""

    def __init__(self, link: Link, terminator: str = "\n", timeout_s: float = 0.8) -> None:
        self._terminator = terminator
        self._talk: Conversation[str] = Conversation(link, answer_decoder(terminator), timeout_s)

    @property
    def name(self) -> str:
        """Of the link."""
        return self._talk.link.name

    def open(self) -> None:
        """Raises LinkLostError."""
        self._talk.open()

    def close(self) -> None:
        """Never raises."""
        self._talk.close()

    def say(self, text: str) -> None:
        """Raises LinkLostError."""
        self._talk.say(encode_line(text, self._terminator))

    def ask(self, text: str) -> str:
        """The answer, stripped. Raises LinkLostError."""
        return self._talk.ask(encode_line(text, self._terminator)).strip()


class VisaTalk:
    """A :class:`ScpiTalk` over PyVISA with the backend ``@py``."""

    def __init__(self, connection: ScpiConnection) -> None:
        self._connection = connection
        self._manager: Any = None
        self._resource: MessageBasedResource | None = None
        self._lock = threading.Lock()

    @property
    def name(self) -> str:
        """The resource string."""
        return self._connection.resource

    def open(self) -> None:
        """Raises LinkLostError, MachineError where PyVISA is not installed."""
        if self._resource is not None:
            return
        try:
            import pyvisa
        except ImportError as error:
            raise MachineError(
                "{name} needs the packages pyvisa and pyvisa-py, which are not installed.", name=self.name
            ) from error
        options: dict[str, Any] = {"baud_rate": self._connection.baud} if self._serial else {}
        try:
            self._manager = pyvisa.ResourceManager("@py")
            self._resource = self._manager.open_resource(
                self.name,
                read_termination=self._connection.terminator,
                write_termination=self._connection.terminator,
                timeout=1000.0 * self._connection.timeout_s,
                **options,
            )
        except (pyvisa.errors.Error, OSError, ValueError) as error:
            self.close()
            raise LinkLostError(
                "{name} cannot be opened ({reason}): check the resource string, the cable and that the "
                "instrument is switched on.",
                name=self.name,
                reason=str(error),
            ) from error

    @property
    def _serial(self) -> bool:
        return self.name.upper().startswith("ASRL")

    def close(self) -> None:
        """Never raises."""
        import pyvisa

        for part in (self._resource, self._manager):
            if part is not None:
                try:
                    part.close()
                except (pyvisa.errors.Error, OSError):
                    continue  # what is unplugged cannot be closed properly either
        self._resource = self._manager = None

    def say(self, text: str) -> None:
        """Raises LinkLostError."""
        self._do(lambda resource: resource.write(text), text)

    def ask(self, text: str) -> str:
        """The answer, stripped. Raises LinkLostError."""
        return str(self._do(lambda resource: resource.query(text), text)).strip()

    def _do(self, call: Any, text: str) -> Any:
        import pyvisa

        resource = self._resource
        if resource is None:
            raise LinkLostError("The connection to {name} is not open.", name=self.name)
        try:
            with self._lock:
                return call(resource)
        except (pyvisa.errors.Error, OSError, UnicodeDecodeError) as error:
            # An answer that comes late would be taken for the next one, so the connection is made anew.
            self.close()
            raise LinkLostError(
                "{name} has not answered “{request}” ({reason}): check the cable, the power and the "
                "settings of the link.",
                name=self.name,
                request=text,
                reason=str(error),
            ) from error


def make_talk(connection: ScpiConnection, link: Link | None = None) -> ScpiTalk:
    """The way to the instrument, not yet open; ``link`` takes the place of the settings' own."""
    if link is None and connection.link is not None:
        link = make_link(connection.link, default_port=DEFAULT_PORT)
    if link is not None:
        return LinkTalk(link, connection.terminator, connection.timeout_s)
    return VisaTalk(connection)
