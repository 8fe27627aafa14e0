"""Texts of the core that a person reads, in the reader's language.

The core knows no Qt. It says ``Message("The table trips at {rate_dps} °/s", rate_dps=120)``; the
Chinese stands in ``resources/translations/core/<room>.toml`` as ``"English template" = "中文"``. A test
walks the sources and fails where a template has no translation.
"""

from __future__ import annotations

import tomllib
from functools import cache
from typing import Any

from ahrs_lab.resource_files import resource_path

LANGUAGES = ("en", "zh")


@cache
def _catalogue(language: str) -> dict[str, str]:
    texts: dict[str, str] = {}
    if language == "zh":
        for path in sorted(resource_path("translations/core").glob("*.toml")):
            texts.update(tomllib.loads(path.read_text(encoding="utf-8")))
    return texts


class Message:
    """A template with its named values; immutable, compared by content, kept in results as JSON."""

    __slots__ = ("params", "template")

    template: str
    params: dict[str, Any]

    def __init__(self, template: str, /, **params: object) -> None:
        object.__setattr__(self, "template", template)
        object.__setattr__(self, "params", params)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError("a Message is immutable")

    def text(self, language: str = "en") -> str:
        """The text in ``language`` ("en" or "zh"); nested messages follow the language."""
        template = _catalogue(language).get(self.template, self.template)
        values = {k: v.text(language) if isinstance(v, Message) else v for k, v in self.params.items()}
        return template.format(**values) if values else template

    def to_json(self) -> dict[str, Any]:
        """``{"template", "params"}``; values that JSON does not know become their text."""
        params: dict[str, Any] = {}
        for key, value in self.params.items():
            if isinstance(value, Message):
                params[key] = value.to_json()
            elif isinstance(value, (int, float, str, bool)) or value is None:
                params[key] = value
            else:
                params[key] = str(value)
        return {"template": self.template, "params": params}

    @classmethod
    def from_json(cls, data: dict[str, Any] | str) -> Message:
        """The inverse of :meth:`to_json`; a plain string is a message without values."""
        if isinstance(data, str):
            return cls(data)
        params = {
            k: cls.from_json(v) if isinstance(v, dict) and "template" in v else v
            for k, v in data.get("params", {}).items()
        }
        return cls(data["template"], **params)

    def __str__(self) -> str:
        return self.text()

    @staticmethod
    def counted(count: int, one: Message, many: Message) -> Message:
        """``one`` where ``count`` is 1, else ``many``: English counts in two forms."""
        return one if count == 1 else many

    def __repr__(self) -> str:
        return f"Message({self.text()!r})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Message) and self.to_json() == other.to_json()

    def __hash__(self) -> int:
        return hash(self.template)

    def __reduce__(self) -> tuple[Any, ...]:
        return (Message.from_json, (self.to_json(),))
