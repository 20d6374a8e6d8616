"""The table of verbs: every one has a parser, and none imports rclpy to explain itself."""

import pytest
from run_python import run_python

from arm_cli.main import main
from arm_cli.verb import Verb, VerbFamily
from arm_cli.verbs import ARM


def leaves(verbs=ARM.verbs, program="arm"):
    for verb in verbs:
        name = f"{program} {verb.name}"
        if isinstance(verb, VerbFamily):
            yield from leaves(verb.verbs, name)
        elif isinstance(verb, Verb):
            yield name, verb


@pytest.mark.parametrize(("program", "verb"), list(leaves()), ids=str)
def test_every_verb_has_a_parser_and_a_function(program, verb):
    assert verb.parser(program).prog == program
    assert callable(verb.load().run)


def test_no_verb_imports_rclpy_for_its_help():
    code = (
        "import sys\n"
        "from arm_cli.verb import VerbFamily\n"
        "from arm_cli.verbs import ARM\n"
        "def build(verbs):\n"
        "    for verb in verbs:\n"
        "        if isinstance(verb, VerbFamily): build(verb.verbs)\n"
        "        else: verb.arguments()\n"
        "build(ARM.verbs)\n"
        "sys.exit(', '.join({'rclpy', 'numpy', 'yaml', 'rich'} & sys.modules.keys()) or 0)"
    )
    done = run_python("-c", code)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_family_without_a_verb_lists_its_verbs(capsys):
    assert main(["control"]) == 2
    text = capsys.readouterr().out
    assert "usage: arm control [-h] VERB ..." in text
    assert "  list_controllers  " in text


@pytest.mark.parametrize(
    "line",
    [
        "topic list -t -c -v --include-hidden-topics --no-daemon --spin-time 2",
        "topic echo /x --qos-profile sensor_data --qos-depth 5 --qos-history keep_last "
        "--qos-reliability reliable --qos-durability volatile --csv -n 2 --field a --filter m.a",
        "topic echo /x -s",
        "topic echo /x --flow-style --no-arr --no-str -f -l 5 --timeout 3 --include-message-info "
        "--no-lost-messages --use-sim-time --raw --once",
        "topic hz /x -w 5 --wall-time --filter m.a",
        "topic bw /x --window 5",
        "topic delay /x --window 5",
        "topic pub /x std_msgs/msg/String --keep-alive 0",
        "topic pub -t 3 -r 2 -p 2 -w 1 --keep-alive 1 --max-wait-time-secs 2 -n me "
        "--qos-liveliness automatic /x std_msgs/msg/String",
        "topic find std_msgs/msg/String -c --include-hidden-topics",
        "node list -a -c",
        "node info /x --include-hidden",
        "param list /x --filter a --param-type --param-prefixes a b",
        "param list --include-hidden-nodes",
        "param get /x a --hide-type --include-hidden-nodes",
        "param dump /x --print --output-dir .",
        "param load /x f.yaml --no-use-wildcard",
        "param describe /x a b",
        "param delete /x a",
        "service list -t -c --include-hidden-services",
        "service find std_srvs/srv/Empty -c",
        "service call /x std_srvs/srv/Empty {} -r 1",
        "action list -t -c",
        "action info /x -t -c",
        "action find control_msgs/action/GripperCommand -c",
        "action send_goal /x control_msgs/action/GripperCommand {} -f",
        "interface list -m -s -a",
        "interface packages --only-msgs",
        "interface package std_msgs -m",
        "interface show std_msgs/msg/String --all-comments",
        "interface proto std_msgs/msg/String --no-quotes",
        "lifecycle nodes -a -c",
        "lifecycle list /x -a --include-hidden-nodes",
        "lifecycle get /x --include-hidden-nodes",
        "lifecycle get --include-hidden-nodes",
        "lifecycle set /x configure --include-hidden-nodes",
        "control list_controllers --include-hidden-nodes",
        "control switch_controllers --activate c --include-hidden-nodes",
        "bag play . --playback-duration -1",
        "pkg prefix x --share",
        "pkg executables x --full-path",
        "pkg xml x -t version",
        "bag record -a -s mcap -o d -b 5 -d 5 --max-cache-size 9 --exclude-regex a "
        "--exclude-topics /a /b --include-hidden-topics --no-discovery -p 100 --use-sim-time "
        "--compression-mode file --compression-format zstd --storage-preset-profile zstd_fast "
        "--node-name me --qos-profile-overrides-path f.yaml --disable-keyboard-controls",
        "bag record --topics /a /b -e c",
        "bag info . -s mcap -v -t --sort count",
        "bag play . -s mcap -r 2 -l --start-offset 1 --playback-duration 2 --clock 50 -d 1 "
        "--topics /a --exclude-topics /b -e c -x d -m /a:=/b --read-ahead-queue-size 9 "
        "--qos-profile-overrides-path f.yaml --disable-keyboard-controls",
    ],
)
def test_ros2_s_flags_are_known(line):
    words = line.split()
    verb = dict(leaves())[f"arm {words[0]} {words[1]}"]
    assert verb.parser("arm").parse_words(words[2:])


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["topic", "ech"], "arm topic: no verb 'ech'; did you mean 'echo'?"),
        (
            ["topic", "echo", "/x", "--onc"],
            "arm topic echo: no option --onc; did you mean '--once'",
        ),
        (
            ["topic", "echo", "/x", "a/b", "c"],
            "arm topic echo: too many arguments, starting with 'c'",
        ),
        (
            ["topic", "pub", "/x", "a/B", "--rate", "0"],
            "argument -r/--rate: '0' is not a number above",
        ),
        (["topic", "pub", "/x", "a/B", "-r", "1e-300"], "'1e-300' is not between 1e-9 and 2e9"),
        (
            ["topic", "echo", "/x", "--qos-liveliness-lease-duration-seconds", "1e300"],
            "'1e300' is not between 1e-9 and 2e9",
        ),
        (
            ["topic", "echo", "/x", "--qos-depth", "99999999999999999999"],
            "99999999999999999999 is too large: the largest value is 2147483647",
        ),
        (["topic", "pub", "/x", "a/B", "--qos-depth", "2147483648"], "largest value is 2147483647"),
        (
            ["topic", "hz", "/x", "-w", "9" * 5000],
            "is too large: the largest value is 9223372036854775807",
        ),
        (["topic", "pub", "-n", "a b", "/x", "a/B"], "'a b' is not a node name"),
        (["topic", "pub", "-n", "1a", "/x", "a/B"], "'1a' is not a node name"),
        (["param", "list", "--filter", "*"], "argument --filter: '*' is not a regular expression"),
        (["control", "set_controller_state", "c", "on"], "invalid choice: 'on'"),
    ],
)
def test_wrong_arguments_are_one_sentence_and_exit_code_2(capsys, words, sentence):
    try:
        code = main(words)
    except SystemExit as exit_:
        code = exit_.code
    captured = capsys.readouterr()
    assert code == 2
    assert sentence in captured.err
    assert captured.err.count("\n") == 1


@pytest.mark.parametrize("option", ["history", "reliability", "durability", "liveliness"])
def test_a_policy_that_cannot_be_requested_is_not_a_choice(capsys, option):
    with pytest.raises(SystemExit) as exit_:
        main(["topic", "pub", "/x", "a/B", f"--qos-{option}", "unknown"])
    assert exit_.value.code == 2
    assert "invalid choice: 'unknown'" in capsys.readouterr().err
