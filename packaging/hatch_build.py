"""Puts the top-level resources into a wheel as `ahrs_lab/_resources`.

An editable installation reads them where they lie; a plain `force-include` would leave it a copy that ages.
"""

from __future__ import annotations

from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class ResourcesHook(BuildHookInterface):  # type: ignore[misc]
    """Found by hatchling through `pyproject.toml`."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Include the resources in a standard wheel; `version` is `editable` for an editable one."""
        if version == "standard":
            build_data["force_include"]["resources"] = "ahrs_lab/_resources"
