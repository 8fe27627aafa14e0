"""Every text of the core that a person reads exists in both languages."""

import ast
import json
import pickle
import re
import tomllib
from pathlib import Path

import pytest

import ahrs_lab
from ahrs_lab import errors
from ahrs_lab.errors import AhrsLabError, InputError
from ahrs_lab.messages import Message
from ahrs_lab.resource_files import resource_path

PACKAGE = Path(ahrs_lab.__file__).parent
SAYING = {"Message"} | {
    name for name, kind in vars(errors).items() if isinstance(kind, type) and issubclass(kind, AhrsLabError)
}
PLACEHOLDER = re.compile(r"\{(\w+)[^}]*\}")


def templates() -> dict[str, str]:
    """Template → where it stands, from the sources."""
    found: dict[str, str] = {}
    for path in PACKAGE.rglob("*.py"):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if not isinstance(node, ast.Call) or not node.args:
                continue
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            first = node.args[0]
            if name in SAYING and isinstance(first, ast.Constant) and isinstance(first.value, str):
                found[first.value] = f"{path.relative_to(PACKAGE)}:{node.lineno}"
    return found


def catalogue() -> dict[str, str]:
    texts: dict[str, str] = {}
    for path in sorted(resource_path("translations/core").glob("*.toml")):
        texts.update(tomllib.loads(path.read_text(encoding="utf-8")))
    return texts


def test_the_sources_say_something() -> None:
    assert len(templates()) > 100


def test_every_template_of_the_core_has_its_chinese() -> None:
    missing = {t: where for t, where in templates().items() if t.strip() and t not in catalogue()}
    assert not missing


def test_a_translation_keeps_the_placeholders() -> None:
    wrong = {
        english: chinese
        for english, chinese in catalogue().items()
        if set(PLACEHOLDER.findall(english)) != set(PLACEHOLDER.findall(chinese))
    }
    assert not wrong


def test_no_translation_is_left_of_a_text_that_is_gone() -> None:
    assert not set(catalogue()) - set(templates())


def test_nested_messages_follow_the_language() -> None:
    inner = Message("operator")
    outer = Message("{name} may not do this: it takes the role {role}.", name="甲", role=inner)
    assert "operator" in outer.text("en")
    assert "operator" not in outer.text("zh")


def test_a_message_survives_json_and_pickle() -> None:
    message = Message("{count} of {what}", count=3, what=Message("operator"))
    assert Message.from_json(json.loads(json.dumps(message.to_json()))) == message
    assert pickle.loads(pickle.dumps(message)) == message


def test_a_message_cannot_be_changed() -> None:
    message = Message("operator")
    with pytest.raises(AttributeError):
        message.template = "other"


def test_braces_in_a_value_are_no_placeholders() -> None:
    assert InputError("bad file {path}", path="{x}").message.text("zh").endswith("{x}")
