"""The table of verbs: every one has a parser, and none imports rclpy to explain itself."""

import subprocess
import sys
from importlib import import_module

import pytest

from arm_cli.main import main
from arm_cli.verb import Verb, VerbFamily
from arm_cli.verbs import VERBS


def leaves(verbs=VERBS, program="arm"):
    for verb in verbs:
        name = f"{program} {verb.name}"
        if isinstance(verb, VerbFamily):
            yield from leaves(verb.verbs, name)
        elif isinstance(verb, Verb):
            yield name, verb


@pytest.mark.parametrize(("program", "verb"), list(leaves()), ids=str)
def test_every_verb_has_a_parser_and_a_function(program, verb):
    assert verb.parser(program).prog == program
    assert callable(import_module(verb.module).run)


def test_no_verb_imports_rclpy_for_its_help():
    code = (
        "import sys\n"
        "from importlib import import_module\n"
        "from arm_cli.verb import VerbFamily\n"
        "from arm_cli.verbs import ARM\n"
        "def build(verbs):\n"
        "    for verb in verbs:\n"
        "        if isinstance(verb, VerbFamily): build(verb.verbs)\n"
        "        else: import_module(verb.module)\n"
        "build(ARM.verbs)\n"
        "sys.exit(', '.join({'rclpy', 'numpy', 'yaml', 'rich'} & sys.modules.keys()) or 0)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")


def test_a_family_without_a_verb_lists_its_verbs(capsys):
    assert main(["control"]) == 2
    text = capsys.readouterr().out
    assert "usage: arm control [-h] VERB ..." in text
    assert "  list_controllers  " in text


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["topic", "ech"], "arm topic: no verb 'ech'; did you mean 'echo'?"),
        (
            ["topic", "echo", "/x", "--onc"],
            "arm topic echo: no option --onc; did you mean '--once'",
        ),
        (["topic", "echo", "/x", "a/b", "c"], "arm topic echo: too many words, from 'c' on"),
        (
            ["topic", "pub", "/x", "a/B", "--rate", "0"],
            "argument -r/--rate: '0' is no number above",
        ),
        (["param", "list", "--filter", "*"], "argument --filter: '*' is no regular expression"),
        (["control", "set_controller_state", "c", "on"], "invalid choice: 'on'"),
    ],
)
def test_wrong_words_are_one_sentence_and_exit_code_2(capsys, words, sentence):
    try:
        code = main(words)
    except SystemExit as exit_:
        code = exit_.code
    captured = capsys.readouterr()
    assert code == 2
    assert sentence in captured.err
    assert captured.err.count("\n") == 1
