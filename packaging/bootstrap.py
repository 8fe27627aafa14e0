"""Two lines from a fresh clone to a running application: `python3 packaging/bootstrap.py demo`, and `test`.

Standard library only, and readable by an old Python so that it can say which one is needed. It looks for what
the machine lacks, installs it where it may, makes `.venv`, and hands over to the application or its tests. A
second call finds its stamp and hands over at once. On Windows the same lines begin with `py`.
"""

from __future__ import annotations

import ctypes
import hashlib
import importlib.util
import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
VENV = ROOT / ".venv"
STAMP = VENV / "bootstrap-stamp"
LOG = VENV / "bootstrap.log"
CONSTRAINTS = Path("packaging", "constraints.txt")
TRANSLATIONS = ROOT / "resources" / "translations"

OLDEST_PYTHON = (3, 11)
DISK_NEEDED_MB = 2000
ALL_EXTRAS = "test,lint"

USAGE = """\
usage: python3 packaging/bootstrap.py demo  [arguments of ahrs-lab demo]
       python3 packaging/bootstrap.py test  [arguments of pytest]
       python3 packaging/bootstrap.py setup
"""

# What Qt loads, and the Debian package that brings it.
QT_LIBRARIES = {
    "libGL.so.1": "libgl1",
    "libEGL.so.1": "libegl1",
    "libgthread-2.0.so.0": "libglib2.0-0",
    "libdbus-1.so.3": "libdbus-1-3",
    "libfontconfig.so.1": "libfontconfig1",
    "libxkbcommon.so.0": "libxkbcommon0",
}
WINDOW_LIBRARIES = {
    "libxkbcommon-x11.so.0": "libxkbcommon-x11-0",
    "libxcb-cursor.so.0": "libxcb-cursor0",
    "libxcb-icccm.so.4": "libxcb-icccm4",
    "libxcb-keysyms.so.1": "libxcb-keysyms1",
    "libxcb-shape.so.0": "libxcb-shape0",
}
PDF_PROGRAMS = ("pdftotext", "pdftoppm", "pdfsig")


class MachineError(Exception):
    """Something the machine lacks; the message says what, and what to do."""


@dataclass(frozen=True)
class Missing:
    """Something Linux has to provide: what was looked for, and the Debian package that brings it."""

    what: str
    package: str


# ── what the machine is ──────────────────────────────────────────────────────────────────────────────────


def require_python(version: tuple[int, ...], found_newer: str | None) -> None:
    """Refuse a Python that is too old, naming a newer one if this machine has it."""
    if version >= OLDEST_PYTHON:
        return
    wanted = ".".join(map(str, OLDEST_PYTHON))
    have = ".".join(map(str, version[:2]))
    if found_newer:
        do = f"This machine has {found_newer}: write {found_newer} instead of python3."
    else:
        do = f"Install Python {wanted} or newer and start again with it."
    raise MachineError(f"This is Python {have}, and ahrs_lab needs {wanted} or newer. {do}")


def newer_python() -> str | None:
    """The newest suitable interpreter on the path under its versioned name."""
    names = (f"python3.{minor}" for minor in range(15, OLDEST_PYTHON[1] - 1, -1))
    return next((name for name in names if shutil.which(name)), None)


def has_screen(platform: str, environment: Mapping[str, str]) -> bool:
    """Whether a window can be opened: always on Windows and macOS, elsewhere where a display is named."""
    if platform in ("win32", "darwin"):
        return True
    return bool(environment.get("DISPLAY") or environment.get("WAYLAND_DISPLAY"))


def loads(library: str) -> bool:
    """Whether the dynamic linker finds the library."""
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def missing_on_linux(
    *,
    screen: bool,
    testing: bool,
    venv_exists: bool,
    library_loads: Callable[[str], bool] = loads,
    program_found: Callable[[str], object] = shutil.which,
    module_found: Callable[[str], object] = importlib.util.find_spec,
) -> list[Missing]:
    """What a Linux machine lacks for the application, for its window, and for its tests."""
    libraries = {**QT_LIBRARIES, **(WINDOW_LIBRARIES if screen else {})}
    lacking = [Missing(name, package) for name, package in libraries.items() if not library_loads(name)]
    if not venv_exists and not module_found("ensurepip"):
        lacking.append(Missing("the Python module ensurepip", "python3-venv"))
    if testing:
        programs = [name for name in PDF_PROGRAMS if not program_found(name)]
        lacking += [Missing(f"the program {name}", "poppler-utils") for name in programs]
    return lacking


# ── system packages ──────────────────────────────────────────────────────────────────────────────────────


def packages_of(lacking: Iterable[Missing]) -> list[str]:
    """The Debian packages that bring what is missing, each once."""
    return list(dict.fromkeys(missing.package for missing in lacking))


def apt_line(packages: Sequence[str]) -> str:
    """The line a person with the rights runs once."""
    return f"sudo apt-get update && sudo apt-get install -y --no-install-recommends {' '.join(packages)}"


def apt_rights() -> list[str] | None:
    """The prefix with which apt-get may be run here without asking anybody; None where it may not."""
    if os.geteuid() == 0:
        return []
    if not shutil.which("sudo"):
        return None
    asked = subprocess.run(["sudo", "-n", "true"], capture_output=True, check=False)
    return ["sudo", "-n"] if asked.returncode == 0 else None


def provide(lacking: list[Missing]) -> None:
    """Install what is missing with apt-get, or say what has to be installed."""
    if not lacking:
        return
    packages = packages_of(lacking)
    if not shutil.which("apt-get"):
        names = ", ".join(missing.what for missing in lacking)
        raise MachineError(
            f"This machine lacks {names}. Install them with its package manager and start again; "
            f"Debian's packages are: {' '.join(packages)}"
        )
    rights = apt_rights()
    if rights is None:
        raise MachineError(
            f"This machine lacks {' '.join(packages)}, and only an administrator can install them. "
            f"Have this line run once, then start again:\n\n    {apt_line(packages)}\n"
        )
    say(f"installing {' '.join(packages)}")
    apt_install(rights, packages)


def apt_install(rights: list[str], packages: list[str]) -> None:
    """Run apt-get without questions; refresh its lists where there are none or they do not know a package."""
    lists_exist = any(Path("/var/lib/apt/lists").glob("*_Packages*"))
    for refresh in (False, True) if lists_exist else (True,):
        if refresh:
            run_quietly([*rights, "apt-get", "update", "-q"], env=apt_environment())
        install = [*rights, "apt-get", "install", "-q", "-y", "--no-install-recommends", *packages]
        done = run_quietly(install, env=apt_environment())
        if done.returncode == 0:
            return
    raise MachineError(
        f"apt-get could not install {' '.join(packages)}:\n{last_lines(done.stdout)}\n"
        f"Have this line run once, then start again:\n\n    {apt_line(packages)}\n"
    )


def apt_environment() -> dict[str, str]:
    """An environment in which no package asks a question."""
    return {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}


# ── the environment of the application ───────────────────────────────────────────────────────────────────


def in_venv(program: str, platform: str = sys.platform) -> Path:
    """Where a program of the virtual environment lies."""
    return (
        VENV
        / ("Scripts" if platform == "win32" else "bin")
        / (f"{program}.exe" if platform == "win32" else program)
    )


def digest(root: Path, version: str) -> str:
    """What the environment depends on: the requirements, their versions, this Python, this folder."""
    import tomllib  # an older Python has been refused by now

    settings = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))
    requirements = {name: settings[name] for name in ("build-system", "project")}
    constraints = (root / CONSTRAINTS).read_text(encoding="utf-8")
    return hashlib.sha256(repr((version, str(root), requirements, constraints)).encode()).hexdigest()


def is_current(stamp: Path, wanted: str, extras: str) -> bool:
    """Whether the stamp stands for these requirements and at least these extras."""
    try:
        written, _, installed = stamp.read_text(encoding="utf-8").partition(" ")
    except OSError:
        return False
    return written == wanted and set(filter(None, extras.split(","))) <= set(installed.split(","))


def prepare(extras: str) -> None:
    """Make `.venv` and install the application into it, unless that was done."""
    wanted = digest(ROOT, sys.version)
    if is_current(STAMP, wanted, extras):
        return
    enough_disk(shutil.disk_usage(ROOT).free)
    say("installing ahrs_lab and its libraries into .venv; this takes some minutes the first time")
    STAMP.unlink(missing_ok=True)
    make_venv()
    target = f".[{extras}]" if extras else "."
    pip = [str(in_venv("python")), "-m", "pip", "--disable-pip-version-check", "install", "--no-input"]
    done = run_quietly([*pip, "-c", str(CONSTRAINTS), "-e", target], log=LOG)
    if done.returncode != 0:
        raise MachineError(explain_pip(done.stdout))
    STAMP.write_text(f"{wanted} {extras}", encoding="utf-8")


def make_venv() -> None:
    """Make the virtual environment anew unless the one that is there is of this Python and this place."""
    if in_venv("python").exists() and venv_fits(VENV, sys.version_info[:3]):
        return
    done = run_quietly([sys.executable, "-m", "venv", "--clear", str(VENV)])
    if done.returncode != 0:
        raise MachineError(f"Python could not make {VENV}:\n{last_lines(done.stdout)}")


def venv_fits(venv: Path, version: tuple[int, ...]) -> bool:
    """Whether it is of this Python version and was made where it lies: its programs cannot be moved."""
    try:
        lines = (venv / "pyvenv.cfg").read_text(encoding="utf-8").splitlines()
    except OSError:
        return False
    settings = dict(line.split(" = ", 1) for line in lines if " = " in line)
    made_at = settings.get("command", "")
    return settings.get("version") == ".".join(map(str, version)) and made_at.endswith(str(venv))


def enough_disk(free_bytes: int) -> None:
    """Refuse early what would fail half way."""
    free_mb = free_bytes // 1_000_000
    if free_mb < DISK_NEEDED_MB:
        raise MachineError(
            f"The disk of {ROOT} has {free_mb} MB free and the installation needs {DISK_NEEDED_MB} MB. "
            "Make room and start again."
        )


def explain_pip(output: str) -> str:
    """Pip's failure in plain words."""
    if "No space left on device" in output:
        return "The disk became full while installing. Make room and start again."
    if any(
        sign in output
        for sign in ("NewConnectionError", "NameResolutionError", "ProxyError", "ConnectTimeout")
    ):
        return (
            "The package index cannot be reached. Check the network (behind a proxy: set HTTPS_PROXY), "
            f"then start again. Pip's words are in {LOG}."
        )
    return f"Pip could not install the application:\n{last_lines(output)}\nEverything it said is in {LOG}."


def compile_modules() -> None:
    """Compile the modules that are newer than what was compiled from them, so that the first start, too, is
    quick (and where Python is told to write no bytecode by itself)."""
    done = run_quietly([str(in_venv("python")), "-m", "compileall", "-q", str(ROOT / "ahrs_lab")])
    if done.returncode != 0:
        raise MachineError(f"The application could not be compiled:\n{last_lines(done.stdout)}")


def compile_translations() -> None:
    """Compile each translation that is newer than what was compiled from it."""
    for source in stale_translations(TRANSLATIONS):
        say(f"compiling {source.name}")
        target = source.with_suffix(".qm")
        done = run_quietly([str(in_venv("pyside6-lrelease")), "-silent", str(source), "-qm", str(target)])
        if done.returncode != 0:
            raise MachineError(f"The translation {source} could not be compiled:\n{last_lines(done.stdout)}")


def stale_translations(folder: Path) -> list[Path]:
    """The sources of translations whose compiled form is missing or older."""

    def is_stale(source: Path) -> bool:
        compiled = source.with_suffix(".qm")
        return not compiled.exists() or compiled.stat().st_mtime < source.stat().st_mtime

    return sorted(source for source in folder.glob("*.ts") if is_stale(source))


# ── running ──────────────────────────────────────────────────────────────────────────────────────────────


def run_quietly(
    command: Sequence[str], *, env: Mapping[str, str] | None = None, log: Path | None = None
) -> subprocess.CompletedProcess[str]:
    """Run a step without showing its output, which is kept for the case that it fails."""
    done = subprocess.run(
        command,
        check=False,
        cwd=ROOT,
        env=env,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        encoding="utf-8",
        errors="replace",
    )
    if log is not None:
        log.write_text(f"{shlex.join(command)}\n\n{done.stdout}", encoding="utf-8")
    return done


def last_lines(output: str, count: int = 12) -> str:
    """The end of a program's output, where the reason of its failure stands."""
    return "\n".join(f"    {line}" for line in output.strip().splitlines()[-count:])


def say(words: str) -> None:
    """Tell what takes time, on standard error: standard output belongs to the program that is started."""
    print(f"bootstrap: {words}", file=sys.stderr, flush=True)


def demo_arguments(given: list[str], screen: bool) -> list[str]:
    """Arguments of `ahrs-lab demo`: without a screen headless, its results left in demo-output."""
    if screen or "--headless" in given:
        return given
    has_out = any(argument == "--out" or argument.startswith("--out=") for argument in given)
    return ["--headless", *([] if has_out else ["--out", "demo-output"]), *given]


def main(arguments: list[str]) -> int:
    """Set up and hand over. The exit code is that of what was started; 2: a wrong call, 3: this machine."""
    if not arguments or arguments[0] not in ("demo", "test", "setup"):
        print(USAGE, file=sys.stderr, end="")
        return 0 if arguments and arguments[0] in ("-h", "--help") else 2
    command, given = arguments[0], [argument for argument in arguments[1:] if argument != "--"]
    screen = has_screen(sys.platform, os.environ)
    try:
        require_python(sys.version_info[:3], newer_python())
        if sys.platform.startswith("linux"):
            venv_exists = in_venv("python").exists()
            provide(missing_on_linux(screen=screen, testing=command != "demo", venv_exists=venv_exists))
        prepare("" if command == "demo" else ALL_EXTRAS)
        compile_modules()
        compile_translations()
        if command == "demo":
            return start([str(in_venv("ahrs-lab")), "demo", *demo_arguments(given, screen)], os.environ)
        if command == "test":
            offscreen = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
            return start([str(in_venv("python")), "-m", "pytest", *given], offscreen)
        say("ready")
        return 0
    except MachineError as trouble:
        print(f"bootstrap: {trouble}", file=sys.stderr)
        return 3
    except OSError as error:
        print(f"bootstrap: {error.filename or 'this machine'}: {error.strerror or error}", file=sys.stderr)
        return 3
    except KeyboardInterrupt:
        return 130


def start(command: list[str], environment: Mapping[str, str]) -> int:
    """Run the application or its tests in the foreground, and leave an interruption to it."""
    with subprocess.Popen(command, cwd=ROOT, env=environment) as process:
        while True:
            try:
                return process.wait()
            except KeyboardInterrupt:
                continue


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
