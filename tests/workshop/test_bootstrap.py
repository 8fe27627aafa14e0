"""The bootstrap's decisions, without installing anything."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import bootstrap


def lacking(*, absent: set[str], screen: bool = False, testing: bool = False) -> list[str]:
    """Debian packages asked for where the named libraries, programs and modules are absent."""

    def there(name: str) -> bool:
        return name not in absent

    found = bootstrap.missing_on_linux(
        screen=screen,
        testing=testing,
        venv_exists=False,
        library_loads=there,
        program_found=there,
        module_found=lambda name: name if there(name) else None,
    )
    return bootstrap.packages_of(found)


ALL = {*bootstrap.QT_LIBRARIES, *bootstrap.WINDOW_LIBRARIES, *bootstrap.PDF_PROGRAMS, "ensurepip"}


class TestWhatIsMissing:
    def test_nothing_on_a_complete_machine(self) -> None:
        assert lacking(absent=set(), screen=True, testing=True) == []

    def test_bare_machine_without_a_screen(self) -> None:
        assert lacking(absent=ALL) == [
            "libgl1",
            "libegl1",
            "libglib2.0-0",
            "libdbus-1-3",
            "libfontconfig1",
            "libxkbcommon0",
            "python3-venv",
        ]

    def test_a_screen_needs_the_window_libraries(self) -> None:
        asked = lacking(absent=ALL, screen=True)
        assert asked[6:11] == [
            "libxkbcommon-x11-0",
            "libxcb-cursor0",
            "libxcb-icccm4",
            "libxcb-keysyms1",
            "libxcb-shape0",
        ]

    def test_tests_need_poppler_once(self) -> None:
        assert lacking(absent={"pdftotext", "pdfsig"}, testing=True) == ["poppler-utils"]
        assert lacking(absent={"pdftotext", "pdfsig"}) == []

    def test_only_what_is_missing_is_asked_for(self) -> None:
        assert lacking(absent={"libEGL.so.1"}, screen=True, testing=True) == ["libegl1"]

    def test_an_existing_environment_needs_no_ensurepip(self) -> None:
        found = bootstrap.missing_on_linux(
            screen=False,
            testing=False,
            venv_exists=True,
            library_loads=lambda name: True,
            module_found=lambda name: None,
        )
        assert found == []

    def test_library_is_found_by_loading_it(self) -> None:
        assert not bootstrap.loads("libahrs-lab-has-no-such-library.so.1")


LACKING = [
    bootstrap.Missing("libGL.so.1", "libgl1"),
    bootstrap.Missing("the program pdftotext", "poppler-utils"),
]


class TestProvide:
    def test_without_rights_it_names_the_exact_line(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(bootstrap, "apt_rights", lambda: None)
        monkeypatch.setattr("shutil.which", lambda name: f"/usr/bin/{name}")
        with pytest.raises(bootstrap.MachineError) as caught:
            bootstrap.provide(LACKING)
        line = "sudo apt-get update && sudo apt-get install -y --no-install-recommends libgl1 poppler-utils"
        assert line in str(caught.value).splitlines()[2].strip()

    def test_without_apt_it_names_what_was_looked_for(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr("shutil.which", lambda name: None)
        with pytest.raises(bootstrap.MachineError, match=r"libGL\.so\.1, the program pdftotext"):
            bootstrap.provide(LACKING)

    def test_nothing_missing_calls_nothing(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(bootstrap, "run_quietly", None)
        monkeypatch.setattr(bootstrap, "apt_rights", None)
        bootstrap.provide([])

    @pytest.mark.parametrize(
        ("install_codes", "expected"),
        [
            ([0], ["install"]),
            ([100, 0], ["install", "update", "install"]),
        ],
    )
    @pytest.mark.skipif(sys.platform == "win32", reason="apt-get is Debian's")
    def test_lists_are_refreshed_only_when_needed(
        self, install_codes: list[int], expected: list[str], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        calls: list[str] = []
        codes = iter(install_codes)

        def run(command: list[str], **_: object) -> subprocess.CompletedProcess[str]:
            calls.append(command[1])
            code = next(codes) if command[1] == "install" else 0
            return subprocess.CompletedProcess(command, code, stdout="E: Unable to locate package")

        monkeypatch.setattr(bootstrap, "run_quietly", run)
        monkeypatch.setattr(Path, "glob", lambda self, pattern: iter([Path("some_Packages.lz4")]))
        bootstrap.apt_install([], ["libgl1"])
        assert calls == expected

    def test_failing_apt_is_told_with_its_reason(self, monkeypatch: pytest.MonkeyPatch) -> None:
        def fails(command: list[str], **_: object) -> subprocess.CompletedProcess[str]:
            return subprocess.CompletedProcess(command, 100, stdout="E: Unable to fetch some archives")

        monkeypatch.setattr(bootstrap, "run_quietly", fails)
        with pytest.raises(bootstrap.MachineError, match="Unable to fetch some archives"):
            bootstrap.apt_install([], ["libgl1"])


class TestPython:
    def test_old_python_names_the_one_needed(self) -> None:
        with pytest.raises(bootstrap.MachineError, match=r"This is Python 3\.9, and ahrs_lab needs 3\.11"):
            bootstrap.require_python((3, 9, 2), None)

    def test_old_python_names_a_newer_one_that_is_there(self) -> None:
        with pytest.raises(bootstrap.MachineError, match=r"write python3\.12 instead"):
            bootstrap.require_python((3, 10, 0), "python3.12")

    @pytest.mark.parametrize("version", [(3, 11, 0), (3, 14, 1)])
    def test_suitable_python(self, version: tuple[int, ...]) -> None:
        bootstrap.require_python(version, None)


class TestScreen:
    @pytest.mark.parametrize(
        ("platform", "environment", "expected"),
        [
            ("linux", {}, False),
            ("linux", {"DISPLAY": ""}, False),
            ("linux", {"DISPLAY": ":0"}, True),
            ("linux", {"WAYLAND_DISPLAY": "wayland-0"}, True),
            ("win32", {}, True),
            ("darwin", {}, True),
        ],
    )
    def test_detection(self, platform: str, environment: dict[str, str], expected: bool) -> None:
        assert bootstrap.has_screen(platform, environment) is expected

    def test_demo_on_a_screen_gets_what_was_given(self) -> None:
        assert bootstrap.demo_arguments(["--language", "zh"], screen=True) == ["--language", "zh"]

    def test_demo_without_a_screen_leaves_results(self) -> None:
        assert bootstrap.demo_arguments(["--speed", "max"], screen=False) == [
            "--headless",
            "--out",
            "demo-output",
            "--speed",
            "max",
        ]

    @pytest.mark.parametrize("out", [["--out", "elsewhere"], ["--out=elsewhere"]])
    def test_demo_without_a_screen_keeps_a_given_folder(self, out: list[str]) -> None:
        assert bootstrap.demo_arguments(out, screen=False) == ["--headless", *out]

    def test_demo_asked_to_be_headless(self) -> None:
        given = ["--headless", "--out", "x"]
        assert bootstrap.demo_arguments(given, screen=False) == given
        assert bootstrap.demo_arguments(given, screen=True) == given


class TestEnvironment:
    def test_programs_on_linux_and_windows(self) -> None:
        assert bootstrap.in_venv("python", "linux") == bootstrap.VENV / "bin" / "python"
        assert bootstrap.in_venv("ahrs-lab", "win32") == bootstrap.VENV / "Scripts" / "ahrs-lab.exe"

    @pytest.mark.parametrize("changed", ["pyproject.toml", "packaging/constraints.txt"])
    def test_digest_follows_the_requirements(self, changed: str, tmp_path: Path) -> None:
        (tmp_path / "packaging").mkdir()
        project = '[build-system]\n[project]\ndependencies = ["numpy"]\n'
        files = {"pyproject.toml": project, "packaging/constraints.txt": "numpy==2.0\n"}
        for name, text in files.items():
            (tmp_path / name).write_text(text)
        before = bootstrap.digest(tmp_path, "3.11.2")
        assert before == bootstrap.digest(tmp_path, "3.11.2")
        assert before != bootstrap.digest(tmp_path, "3.12.0")
        (tmp_path / "pyproject.toml").write_text(f"{project}[tool.ruff]\nline-length = 110\n")
        assert before == bootstrap.digest(tmp_path, "3.11.2"), "a linter's settings need no installation"
        (tmp_path / changed).write_text(files[changed].replace("numpy", "scipy"))
        assert before != bootstrap.digest(tmp_path, "3.11.2")

    def test_stamp_covers_fewer_extras_but_not_more(self, tmp_path: Path) -> None:
        stamp = tmp_path / "stamp"
        assert not bootstrap.is_current(stamp, "abc", "")
        stamp.write_text("abc ")
        assert bootstrap.is_current(stamp, "abc", "")
        assert not bootstrap.is_current(stamp, "abc", "test,lint")
        stamp.write_text("abc test,lint")
        assert bootstrap.is_current(stamp, "abc", "")
        assert bootstrap.is_current(stamp, "abc", "test,lint")
        assert not bootstrap.is_current(stamp, "abd", "")

    def test_environment_of_another_version_or_place_is_made_anew(self, tmp_path: Path) -> None:
        assert not bootstrap.venv_fits(tmp_path, (3, 11, 2))
        settings = tmp_path / "pyvenv.cfg"
        settings.write_text(f"home = /usr/bin\nversion = 3.11.2\ncommand = python3 -m venv {tmp_path}\n")
        assert bootstrap.venv_fits(tmp_path, (3, 11, 2))
        assert not bootstrap.venv_fits(tmp_path, (3, 12, 0))
        settings.write_text("home = /usr/bin\nversion = 3.11.2\ncommand = python3 -m venv /somewhere/else\n")
        assert not bootstrap.venv_fits(tmp_path, (3, 11, 2))

    def test_second_call_installs_nothing(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(bootstrap, "STAMP", tmp_path / "stamp")
        monkeypatch.setattr(bootstrap, "run_quietly", None)
        (tmp_path / "stamp").write_text(f"{bootstrap.digest(bootstrap.ROOT, sys.version)} test,lint")
        bootstrap.prepare("test,lint")
        bootstrap.prepare("")

    def test_full_disk_is_refused_early(self) -> None:
        bootstrap.enough_disk(5_000_000_000)
        with pytest.raises(bootstrap.MachineError, match="has 300 MB free"):
            bootstrap.enough_disk(300_000_000)

    @pytest.mark.parametrize(
        ("output", "words"),
        [
            ("... NewConnectionError('<pip...>: Failed to establish a new connection", "Check the network"),
            (
                "ERROR: Could not install packages due to an OSError: [Errno 28] No space left on device",
                "full",
            ),
            ("ERROR: No matching distribution found for numpy==9", "No matching distribution"),
        ],
    )
    def test_pip_failures_in_plain_words(self, output: str, words: str) -> None:
        assert words in bootstrap.explain_pip(output)


class TestTranslations:
    def test_compiled_where_missing_or_older(self, tmp_path: Path) -> None:
        import os

        for name, when in (
            ("new.ts", 200),
            ("new.qm", 100),
            ("old.ts", 100),
            ("old.qm", 200),
            ("alone.ts", 1),
        ):
            (tmp_path / name).touch()
            os.utime(tmp_path / name, (when, when))
        assert [path.name for path in bootstrap.stale_translations(tmp_path)] == ["alone.ts", "new.ts"]

    def test_no_folder_is_no_work(self, tmp_path: Path) -> None:
        assert bootstrap.stale_translations(tmp_path / "absent") == []


class TestCommandLine:
    @pytest.mark.parametrize("arguments", [[], ["dmeo"]])
    def test_wrong_call_shows_the_usage(
        self, arguments: list[str], capsys: pytest.CaptureFixture[str]
    ) -> None:
        assert bootstrap.main(arguments) == 2
        assert "bootstrap.py demo" in capsys.readouterr().err

    @pytest.fixture
    def started(self, monkeypatch: pytest.MonkeyPatch) -> list[tuple[list[str], str | None]]:
        """Programs that would have been started, on a machine that lacks nothing."""
        calls: list[tuple[list[str], str | None]] = []

        def start(command: list[str], environment: dict[str, str]) -> int:
            calls.append((command, environment.get("QT_QPA_PLATFORM")))
            return 7

        for name in ("provide", "prepare"):
            monkeypatch.setattr(bootstrap, name, lambda *_: None)
        monkeypatch.setattr(bootstrap, "compile_modules", lambda: None)
        monkeypatch.setattr(bootstrap, "compile_translations", lambda: None)
        monkeypatch.setattr(bootstrap, "start", start)
        return calls

    def test_test_passes_its_arguments_on(self, started: list[tuple[list[str], str | None]]) -> None:
        assert bootstrap.main(["test", "--", "tests/workshop", "-x"]) == 7
        assert started == [
            ([str(bootstrap.in_venv("python")), "-m", "pytest", "tests/workshop", "-x"], "offscreen")
        ]

    def test_demo_starts_the_application(
        self, started: list[tuple[list[str], str | None]], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(bootstrap, "has_screen", lambda *_: False)
        assert bootstrap.main(["demo"]) == 7
        command = [str(bootstrap.in_venv("ahrs-lab")), "demo", "--headless", "--out", "demo-output"]
        assert started[0][0] == command

    def test_trouble_is_told_without_a_traceback(
        self, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
    ) -> None:
        def refuse(*_: object) -> None:
            raise bootstrap.MachineError("Make room and start again.")

        monkeypatch.setattr(bootstrap, "provide", refuse)
        monkeypatch.setattr(bootstrap, "prepare", refuse)
        assert bootstrap.main(["setup"]) == 3
        assert capsys.readouterr().err == "bootstrap: Make room and start again.\n"

    def test_an_old_python_can_read_it(self) -> None:
        import ast

        source = Path(bootstrap.__file__).read_text(encoding="utf-8")
        ast.parse(source, feature_version=(3, 9))
