"""Texts of other processes cannot control the terminal on which `arm` prints, or forge a line."""

import json
from collections.abc import Iterator

import pytest
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import String

from arm_cli.bag_format.topic import BagTopic, find_definition
from arm_cli.bag_format.writer import BagSettings, BagWriter
from arm_cli.interface_types import InterfaceIndex
from arm_cli.main import main
from arm_cli.output import colour, complain, print_json, say, say_document
from arm_cli.topic.echo import MessagePrinter
from arm_cli.topic.message_parts import FieldPath
from arm_cli.verb import Runnable, Verb, VerbFamily
from arm_cli.verbs import ARM
from arm_node.messages.text import COMPLETE

HOSTILE = "a\x1b[2J\x1b]0;owned\x07\x9b\n---\nforged\u202e"
SHOWN = r"a\x1b[2J\x1b]0;owned\x07\x9b\n---\nforged\u202e"


def is_safe(text: str) -> bool:
    return not set(text) & set("\x1b\x07\x9b\u202e")


@pytest.mark.parametrize("style", ["yaml", "csv", "json"])
@pytest.mark.parametrize("field", [None, "data"])
def test_echo_escapes_control_sequences_in_a_string(capsys, style, field):
    printer = MessagePrinter(
        style=style,
        flow_style=False,
        abridgement=COMPLETE,
        path=field and FieldPath.parse(field),
        accepts=lambda _: True,
        with_info=False,
        limit=1,
    )
    printer.take(String(data=HOSTILE), {})
    text = capsys.readouterr().out
    assert is_safe(text)
    assert "\nforged" not in text
    assert text.count("\n---\n") == (style == "yaml")
    if style == "json":
        plain = json.loads(text)
        assert (plain if field else plain["data"]) == HOSTILE
    elif field or style == "csv":
        assert text.startswith(f"{SHOWN}\n")


def test_echo_keeps_the_lines_of_a_multi_line_part(capsys):
    pose = PoseStamped()
    pose.header.frame_id = HOSTILE
    printer = MessagePrinter("yaml", False, COMPLETE, FieldPath.parse("header"), bool, False, 1)
    printer.take(pose, {})
    text = capsys.readouterr().out
    assert text.startswith("stamp:\n  sec: 0\n")
    assert is_safe(text)


@pytest.mark.parametrize("words", [[], ["--topic-name"], ["--json"]])
def test_bag_info_escapes_names_in_a_bag(capsys, tmp_path, words):
    bag = BagWriter(tmp_path / "bag", BagSettings())
    type_ = "std_msgs/msg/String"
    bag.add_topic(BagTopic(f"/{HOSTILE}", type_), find_definition(InterfaceIndex(), type_))
    bag.close()
    assert main(["bag", "info", str(tmp_path / "bag"), *words]) == 0
    text = capsys.readouterr().out
    assert "owned" in text
    assert is_safe(text)
    assert "\nforged" not in text


@pytest.mark.parametrize("print_it", [say, say_document, complain])
def test_every_print_function_escapes(capsys, print_it):
    print_it(HOSTILE)
    said = capsys.readouterr()
    assert is_safe(said.out + said.err)


def test_colours_are_only_those_of_the_command(monkeypatch):
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    assert colour(92, HOSTILE) == f"\x1b[92m{SHOWN}\x1b[0m"


def test_json_stays_json(capsys):
    print_json({"name": f"{HOSTILE}\x7fé"})
    text = capsys.readouterr().out
    assert is_safe(text)
    assert "\x7f" not in text
    assert json.loads(text) == {"name": f"{HOSTILE}\x7fé"}


def exit_code(words: list[str]) -> object:
    try:
        return main(words)
    except SystemExit as end:
        return end.code


def verbs(family: VerbFamily, words: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    yield words
    for verb in family.verbs:
        here: tuple[Runnable, tuple[str, ...]] = (verb, (*words, verb.name))
        if isinstance(verb, VerbFamily):
            yield from verbs(*here)
        elif isinstance(verb, Verb) or verb.name in ("launch", "run"):
            yield here[1]


@pytest.mark.parametrize("words", list(verbs(ARM)), ids=" ".join)
def test_a_refused_argument_is_printed_escaped(capsys, words):
    assert exit_code([*words, f"--{HOSTILE}=1"]) in (1, 2)
    said = capsys.readouterr()
    assert is_safe(said.out + said.err)
    assert "\nforged" not in said.out + said.err


@pytest.mark.parametrize(
    "words", [["bag", "info"], ["check"], ["param", "load", "/n"], ["interface", "show"]]
)
def test_a_missing_file_s_name_is_printed_escaped(capsys, words):
    assert exit_code([*words, f"/no/{HOSTILE}"]) in (1, 2)
    said = capsys.readouterr()
    assert r"\x1b" in said.err
    assert is_safe(said.out + said.err)


@pytest.mark.parametrize(
    "words",
    [
        ["bag", "info"],
        ["bag", "play"],
        ["check"],
        ["interface", "show"],
        ["launch"],
        ["launch", "arm_gazebo"],
        ["run", "arm_controller"],
        ["pkg", "prefix"],
    ],
)
@pytest.mark.parametrize("name", ["a" * 300, "/tmp/" + "a" * 300, "std_msgs/msg/" + "a" * 300])
def test_a_name_of_300_characters_is_reported(capsys, words, name):
    assert exit_code([*words, name]) in (1, 2)
    assert "Traceback" not in capsys.readouterr().err


def test_check_escapes_names_in_a_description(capsys, tmp_path):
    name = "x\x7f&#10;usable: forged&#x9b;2J"
    file = tmp_path / "robot.urdf"
    file.write_text(f'<robot name="{name}"><link name="{name}"/><strange name="{name}"/></robot>')
    main(["check", str(file)])
    text = capsys.readouterr().out
    assert "forged" in text
    assert is_safe(text)
    assert not any(line.startswith("usable: forged") for line in text.splitlines())
    main(["check", str(file), "--json"])
    assert json.loads(capsys.readouterr().out)["robot"]["name"].endswith("forged\x9b2J")
