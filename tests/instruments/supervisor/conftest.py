"""The house's drivers as installed ones, in this process and those that it starts."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from importlib.metadata import entry_points

import pytest

from ahrs_lab.instruments.registry import GROUP

_POINTS = """[ahrs_lab.instruments]
table-acutrol = ahrs_lab.instruments.drivers.catalogue:ACUTROL
supply-scpi = ahrs_lab.instruments.drivers.catalogue:SCPI_SUPPLY
"""


@pytest.fixture(scope="session", autouse=True)
def installed_drivers(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """A checkout that was installed before it had drivers does not know their entry points."""
    if entry_points(group=GROUP):
        yield
        return
    folder = tmp_path_factory.mktemp("installed")
    about = folder / "ahrs_lab_drivers-1.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: ahrs_lab_drivers\nVersion: 1\n")
    (about / "entry_points.txt").write_text(_POINTS)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", os.pathsep.join([str(folder), os.environ.get("PYTHONPATH", "")]))
        patch.syspath_prepend(str(folder))
        assert str(folder) in sys.path
        yield
