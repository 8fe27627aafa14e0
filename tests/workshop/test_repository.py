"""What every file of the repository has to keep to."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

# Where a package comes from is each machine's own setting. Written in two parts, lest this file offend.
REGISTRIES = [
    f"{name}.{domain}"
    for name, domain in (
        ("pypi", "org"),
        ("pythonhosted", "org"),
        ("npmjs", "org"),
        ("npmjs", "com"),
        ("npmmirror", "com"),
        ("yarnpkg", "com"),
        ("deb.debian", "org"),
        ("security.debian", "org"),
        ("ftp.debian", "org"),
        ("snapshot.debian", "org"),
        ("anaconda", "org"),
        ("crates", "io"),
        ("proxy.golang", "org"),
        ("repo.maven.apache", "org"),
        ("rubygems", "org"),
        ("tuna.tsinghua.edu", "cn"),
        ("mirrors.aliyun", "com"),
    )
]


@pytest.fixture(scope="module")
def text_files() -> dict[str, str]:
    """Every text file that is in git or will be: path from the root, and content."""
    git = shutil.which("git")
    if git is None or not (ROOT / ".git").exists():
        pytest.skip("this is not a git checkout")
    listed = subprocess.run(
        [git, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    files = {}
    for name in filter(None, listed.split("\0")):
        data = (ROOT / name).read_bytes() if (ROOT / name).is_file() else b""
        if b"\0" not in data[:8192]:
            files[name] = data.decode("utf-8", errors="replace")
    return files


def test_no_file_names_the_host_of_a_package_registry(text_files: dict[str, str]) -> None:
    host = re.compile(rf"(?<![\w-])({'|'.join(map(re.escape, REGISTRIES))})\b", re.IGNORECASE)
    found = [f"{name}: {match[0]}" for name, text in text_files.items() for match in host.finditer(text)]
    assert found == []


def test_constraints_pin_exact_versions_and_nothing_else(text_files: dict[str, str]) -> None:
    lines = text_files["packaging/constraints.txt"].splitlines()
    assert lines
    assert [line for line in lines if not re.fullmatch(r"[A-Za-z0-9._-]+==[A-Za-z0-9.+!]+", line)] == []
    names = [re.sub(r"[-_.]+", "-", line.split("==")[0]).lower() for line in lines]
    assert sorted(set(names)) == sorted(names)


def test_ci_can_be_run() -> None:
    assert (ROOT / ".ci" / "run").stat().st_mode & 0o111
