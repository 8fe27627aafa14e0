"""Bring the Chinese texts of the screens up to date and compile them.

    python packaging/translations.py            look through ahrs_lab/ui, update the .ts, compile the .qm
    python packaging/translations.py --compile  compile only

The ``.ts`` is kept in git, the ``.qm`` is not. Texts of the core stand in ``resources/translations/core``.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parents[1]
SOURCES = ROOT / "ahrs_lab" / "ui"
FOLDER = ROOT / "resources" / "translations"
TEXTS = FOLDER / "ahrs_lab_zh.ts"

BARE_TRANSLATE = re.compile(r"(?<![\w.])translate\(")


def tool(name: str) -> str:
    """Qt's tool beside the Python that runs this."""
    return str(Path(sys.executable).with_name(name))


def update() -> None:
    """Take new source texts into the ``.ts``; texts that are gone leave it."""
    with TemporaryDirectory() as folder:
        files = []
        for number, path in enumerate(sorted(SOURCES.rglob("*.py"))):
            copy = Path(folder) / f"{number:03d}_{path.name}"
            # lupdate takes the context of a bare translate(...) for the text.
            text = BARE_TRANSLATE.sub("QCoreApplication.translate(", path.read_text(encoding="utf-8"))
            copy.write_text(text, encoding="utf-8")
            files.append(str(copy))
        command = [tool("pyside6-lupdate"), *files, "-no-obsolete", "-locations", "none", "-silent"]
        subprocess.run([*command, "-ts", str(TEXTS)], check=True, cwd=ROOT)


def compile_all() -> None:
    """Every ``.ts`` to its ``.qm``."""
    for source in sorted(FOLDER.glob("*.ts")):
        # Made beside and put in place whole: two test processes may compile at once.
        partial = source.with_suffix(f".{os.getpid()}.part")
        command = [tool("pyside6-lrelease"), str(source), "-qm", str(partial), "-silent"]
        subprocess.run(command, check=True, cwd=ROOT)
        partial.replace(source.with_suffix(".qm"))


def stale() -> bool:
    """Whether a ``.qm`` is missing or older than its ``.ts``."""
    for source in FOLDER.glob("*.ts"):
        compiled = source.with_suffix(".qm")
        if not compiled.exists() or compiled.stat().st_mtime < source.stat().st_mtime:
            return True
    return False


def unfinished(path: Path = TEXTS) -> list[str]:
    """``context: source`` of every text without a finished translation."""
    found = []
    for context in ElementTree.parse(path).getroot().iter("context"):
        name = context.findtext("name", "")
        for message in context.iter("message"):
            translation = message.find("translation")
            if translation is None or translation.get("type") or not (translation.text or "").strip():
                found.append(f"{name}: {message.findtext('source', '')}")
    return found


def main() -> int:
    """Update, compile, and say what is left to translate."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--compile", action="store_true", help="compile only")
    if not parser.parse_args().compile:
        update()
    compile_all()
    left = unfinished()
    for text in left:
        print(text)
    print(f"{len(left)} texts without Chinese" if left else "every text has its Chinese")
    return 1 if left else 0


if __name__ == "__main__":
    raise SystemExit(main())
