"""What a person chooses for the screen, kept between starts. Nothing here changes a number."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

Language = Literal["en", "zh"]
Theme = Literal["light", "dark", "system"]


@dataclass
class Settings:
    """``settings.toml`` in the laboratory's folder; a damaged file falls back to the defaults and is said so
    in
    ``damaged``."""

    path: Path
    language: Language = "en"
    theme: Theme = "system"
    last_person: str = ""
    damaged: bool = field(default=False, repr=False)

    @classmethod
    def load(cls, path: Path) -> Settings:
        """From ``path``; defaults where it does not exist yet."""
        settings = cls(path)
        if not path.exists():
            return settings
        try:
            data = tomllib.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            settings.damaged = True
            return settings
        settings._take(data)
        return settings

    def _take(self, data: dict[str, Any]) -> None:
        language, theme, person = data.get("language"), data.get("theme"), data.get("last_person")
        if language in ("en", "zh"):
            self.language = language
        if theme in ("light", "dark", "system"):
            self.theme = theme
        if isinstance(person, str):
            self.last_person = person

    def save(self) -> None:
        """Write the file, whole or not at all."""
        import tomli_w

        text = tomli_w.dumps(
            {"language": self.language, "theme": self.theme, "last_person": self.last_person}
        )
        partial = self.path.with_name(self.path.name + ".part")
        partial.write_text(text, encoding="utf-8")
        partial.replace(self.path)
