"""The house's errors: one small hierarchy that says whose fault it is and what to do.

The message is written where the error is raised: what, where, what to do. It is a
:class:`~ahrs_lab.messages.Message`, so that a screen can show it in the reader's language;
``str(error)`` is English.

This module and :mod:`ahrs_lab.messages` are the doorstep of the house: every room may import them.
"""

from __future__ import annotations

from ahrs_lab.messages import Message


class AhrsLabError(Exception):
    """Something a person has to know; ``exit_code`` is what the command line returns for it."""

    exit_code = 3

    def __init__(self, template: str | Message, /, **params: object) -> None:
        self.message = template if isinstance(template, Message) else Message(template, **params)
        super().__init__(self.message.text())


class InputError(AhrsLabError):
    """A file, a setting or a call is at fault: correct it and try again."""

    exit_code = 2


class PermissionDeniedError(InputError):
    """The person's role does not allow it."""


class InstrumentError(AhrsLabError):
    """An instrument does not do what it was asked."""


class LinkLostError(InstrumentError):
    """The wire to an instrument is gone: unplugged, switched off, or closed by the other side. Opening it
    again may help."""


class MountingError(InstrumentError):
    """The case is not mounted as asked (the recording was refused)."""


class MachineError(AhrsLabError):
    """The computer does not let us: disk full, folder read-only, file in use."""


class AbortedError(AhrsLabError):
    """A person stopped the run; what was recorded is kept."""
