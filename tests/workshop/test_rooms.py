"""The contracts between the rooms notice an import that goes the wrong way."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LINTER = Path(sysconfig.get_path("scripts")) / (
    "lint-imports.exe" if sys.platform == "win32" else "lint-imports"
)

OFFENCES = {
    "metrology/offence.py": ("import PySide6.QtCore", "Only the screen knows Qt"),
    "procedures/offence.py": ("import ahrs_lab.simulation", "Procedures cannot tell a simulated bench"),
    "certificates/offence.py": ("import ahrs_lab.recording", "A certificate is made of results"),
    "simulation/offence.py": ("import ahrs_lab.metrology", "The simulated world knows nothing"),
    "instruments/offence.py": ("import ahrs_lab.inertial", "Instruments know samples"),
    "inertial/offence.py": ("import sqlalchemy", "Mathematics knows numpy and scipy only"),
    "ui/offence.py": ("import reportlab", "The screen knows no file formats"),
    "records/offence.py": ("import ahrs_lab.certificates", "Data crosses the house once"),
}


@pytest.mark.skipif(not LINTER.exists(), reason="import-linter is not installed")
def test_each_contract_notices_its_offence(tmp_path: Path) -> None:
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "ahrs_lab", tmp_path / "ahrs_lab", ignore=ignored)
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    for file, (line, _) in OFFENCES.items():
        (tmp_path / "ahrs_lab" / file).write_text(f"{line}\n", encoding="utf-8")
    run = subprocess.run(
        [LINTER, "--no-cache"],
        cwd=tmp_path,
        check=False,
        capture_output=True,
        encoding="utf-8",
    )
    assert run.returncode == 1
    broken = [line for line in run.stdout.splitlines() if " BROKEN" in line]
    unnoticed = [words for _, words in OFFENCES.values() if not any(map(re.compile(words).match, broken))]
    assert unnoticed == []
