"""The ACUTROL driver against the responder and the plant, in time that the test lets pass."""

from __future__ import annotations

from ahrs_lab.instruments.drivers.tables.acutrol import AcutrolSettings, AcutrolTable
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.links.link_settings import LinkSettings
from ahrs_lab.instruments.protocols.acutrol_responder import AclResponder
from tests.instruments.fake_clock import FakeClock
from tests.instruments.fake_link import FakeLink
from tests.instruments.tables.plant import Plant


class AclBench:
    """Everything connected; ``table`` is polled every 25 ms of waiting."""

    def __init__(self, max_rate_dps: float = 400.0, acceleration: float = 100.0, **limits: float) -> None:
        self.clock = FakeClock()
        self.plant = Plant(self.clock, acceleration=acceleration)
        self.responder = AclResponder(self.plant)
        self.link = FakeLink(self.responder.feed)
        settings = AcutrolSettings(
            LinkSettings(host="table"),
            limits=SoftLimits(max_rate_dps, acceleration, **limits),
            reply_timeout_s=0.05,
        )
        self.table = AcutrolTable(settings, self.link, self.clock)
        self.table.connect()
        self.clock.on_step = self.table.poll

    def enable(self) -> AcutrolTable:
        self.table.enable()
        return self.table

    def said(self) -> list[str]:
        """The requests since the last call that change something."""
        texts = [request.decode().strip() for request in self.link.written]
        self.link.written.clear()
        return [text for text in texts if "?" not in text]
