"""The command line: its arguments, its errors and its listings. Nothing starts here."""

import re
import sys

import pytest

from launch_py.command import command_line
from launch_py.errors import LaunchError

ARGUMENTS = """
actions = [
    DeclareLaunchArgument("world", default_value="empty", description="what to load",
                          choices=["empty", "objects"]),
    DeclareLaunchArgument("model"),
    python("sim", "raise SystemExit(99)", ready=LogLine("up", timeout_s=7),
           condition=IfCondition(EqualsSubstitution(LaunchConfiguration("world"), "objects"))),
]
"""


@pytest.fixture
def refused(capsys):
    """Run a command line that must be refused; return the sentence."""

    def run(*argv):
        assert command_line.run(argv, "prog") == 2
        captured = capsys.readouterr()
        assert captured.out == ""
        assert "Traceback" not in captured.err
        (line,) = captured.err.splitlines()
        assert line.startswith("prog: ")
        return line

    return run


@pytest.fixture
def demo(package_prefix, write_launch_file):
    """A package with one launch file; returns that file's path."""
    share = package_prefix("demo")
    path = share / "launch" / "demo.launch.py"
    path.write_text(write_launch_file(ARGUMENTS).read_text())
    return path


def test_an_unknown_package(refused, demo):
    assert "no package 'dmo'" in (line := refused("dmo", "demo.launch.py"))
    assert "did you mean 'demo'?" in line


def test_an_unknown_file(refused, demo):
    line = refused("demo", "dmo.launch.py")
    assert "package 'demo' has no launch file 'dmo.launch.py'; did you mean 'demo.launch.py" in line


def test_an_unknown_path(refused, demo):
    assert "did you mean 'demo.launch.py'?" in refused(str(demo.parent / "deom.launch.py"))


@pytest.fixture
def here(tmp_path, monkeypatch):
    """The current folder, which has a script and no launch file."""
    folder = tmp_path / "here"
    folder.mkdir()
    (folder / "move.py").touch()
    monkeypatch.chdir(folder)
    return folder


def test_a_script_is_not_offered_as_a_launch_file(refused, demo, here):
    line = refused("zzz.launch.py")
    assert line == (
        f"prog: no launch file zzz.launch.py; {here} holds none, and no package has one of a "
        "similar name"
    )
    assert refused("./zzz.launch.py").endswith(f"no launch file ./zzz.launch.py; {here} holds none")
    assert refused("nowhere/zzz.launch.py").endswith("; there is no folder nowhere")


def test_the_launch_files_of_the_current_folder_are_offered(refused, demo, here):
    (here / "two.launch.py").touch()
    assert refused("zzz.launch.py").endswith(f"; {here} holds two.launch.py")
    assert refused("tow.launch.py").endswith("; did you mean 'two.launch.py'?")


@pytest.mark.parametrize("word", ["demo.launch.py", "dmo.launch.py"])
def test_a_launch_file_of_a_package_is_offered_with_its_package(refused, demo, here, word):
    (here / "other_robot.launch.py").touch()
    assert f"no launch file {word}; did you mean 'demo demo.launch.py'" in refused(word)


def test_an_unknown_argument_is_a_warning(demo, capsys):
    words = ["demo", "demo.launch.py", "model:=x", "wrold:=objects", "--print"]
    assert command_line.run(words, "prog") == 0
    first = capsys.readouterr().out.splitlines()[0]
    assert first.startswith("warning: launch argument 'wrold' has no effect")
    assert first.endswith("did you mean 'world'?")


def test_an_unknown_option(refused, demo):
    assert "no option --show-arg; did you mean '--show-args'" in refused(str(demo), "--show-arg")
    assert ":=" not in refused(str(demo), "-x")


def test_an_unknown_option_lists_the_options_of_the_help(refused, demo, capsys):
    line = refused(str(demo), "-x")
    with pytest.raises(SystemExit):
        command_line.run(["--help"], "prog")
    shown = re.split(r"[\s,]+", capsys.readouterr().out)
    named = line.partition("there is ")[2].split(", ")
    assert "--print" in named
    assert [name for name in named if name not in shown] == []


@pytest.mark.parametrize("words", [("--world", "objects"), ("--world=objects",)])
def test_an_argument_written_as_an_option(refused, demo, words):
    assert "an argument of the launch file is given as world:=VALUE" in refused(str(demo), *words)


def test_an_equals_sign_without_colon(refused, demo):
    assert "launch arguments are written name:=value" in refused(str(demo), "world=objects")


def test_a_value_without_a_name(refused, demo):
    assert "':=objects' has no name before ':='" in refused(str(demo), ":=objects")


def test_a_package_without_a_file_lists_its_files(refused, demo):
    assert "which launch file of package 'demo'? It has demo.launch.py" in refused("demo")


def test_no_file_at_all(refused):
    assert "which launch file?" in refused()


def test_too_many_words(refused, demo):
    assert "too many words" in refused("demo", "demo.launch.py", "x", "y")


@pytest.mark.parametrize("word", ["", "short"])
def test_a_short_name_may_be_followed_by_arguments(demo, capsys, word):
    argv = [*word.split(), "world:=objects", "model:=x", "--print"]
    assert command_line.run(argv, "prog", {word: ("demo", "demo.launch.py")}) == 0
    assert "sim\n" in capsys.readouterr().out


def test_the_help_says_what_short_names_mean(capsys):
    with pytest.raises(SystemExit):
        command_line.run(["--help"], "prog", {"": ("a", "a.launch.py"), "b": ("c", "d.launch.py")})
    text = " ".join(capsys.readouterr().out.split())
    assert "Without PACKAGE and FILE: a a.launch.py. b: c d.launch.py." in text


def test_before_start_can_prevent_the_start(refused, demo):
    def refuse():
        raise LaunchError("not today")

    def run(*argv):
        return command_line.run(argv, "prog", {}, refuse)

    assert run(str(demo), "model:=x", "--print") == 0
    assert run(str(demo), "model:=x") == 2


def test_show_args_lists_names_defaults_choices_descriptions(demo, capsys):
    assert command_line.run([str(demo), "--show-args"], "prog") == 0
    assert capsys.readouterr().out.splitlines() == [
        "Arguments of demo.launch.py, given as name:=value:",
        "",
        "  world  (default 'empty')",
        "      what to load",
        "      choices: empty, objects",
        "  model  (required)",
    ]


def test_show_args_of_a_file_without_arguments(write_launch_file, capsys):
    path = write_launch_file("actions = []")
    assert command_line.run([str(path), "-s"], "prog") == 0
    assert capsys.readouterr().out == "test.launch.py has no arguments.\n"


def test_print_shows_the_plan_without_starting(write_launch_file, capsys, monkeypatch):
    monkeypatch.delenv("ROS_AUTOMATIC_DISCOVERY_RANGE", raising=False)
    path = write_launch_file(
        """
        actions = [
            forever("sim", additional_env={"A": "1"}, cwd="/tmp"),
            forever("b", depends_on="sim", restart=RestartPolicy.always()),
            Node(package="launch_py", executable="launch_py", name="n", parameters=[{"rate": 5}]),
            TimerAction(period=2.0, actions=[LogInfo(msg="hello"), Shutdown(reason="enough")]),
        ]
        """
    )
    assert command_line.run([str(path), "--print"], "prog") == 0
    text = capsys.readouterr().out
    for expected in (
        "  ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST",
        f"sim\n  command      {sys.executable} -c ",
        "  folder       /tmp",
        "  environment  A=1",
        "  ready        LogLine, within 60 s",
        "  starts after sim ready",
        "  restart      always",
        "-r __node:=n --params-file <generated.yaml>",
        '  parameters   "/n": {"ros__parameters": {"rate": 5}}',
        "message 'hello'\n  delay        2 s",
        "shutdown 'enough'",
    ):
        assert expected in text


def test_a_broken_launch_file_shows_its_traceback_only_with_debug(write_launch_file, capsys):
    path = write_launch_file("def generate_launch_description():\n    1 / 0")
    assert command_line.run([str(path)], "prog") == 2
    assert "Traceback" not in capsys.readouterr().err
    assert command_line.run([str(path), "--debug"], "prog") == 2
    assert "Traceback" in capsys.readouterr().err


def test_python_m_launch_py_is_the_command(run_launch_py, write_launch_file):
    path = write_launch_file("actions = [python('a', 'print(41 + 1)')]")
    done = run_launch_py(str(path))
    assert done.returncode == 0
    assert "[a] 42" in done.stdout.splitlines()
    assert done.stderr == ""


def test_a_refusal_is_on_stderr_with_exit_code_2(run_launch_py):
    done = run_launch_py("nowhere.launch.py")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("launch_py: no launch file nowhere.launch.py")


@pytest.mark.parametrize(("word", "replaces"), [("true", True), ("yes", True), ("false", False)])
def test_replace_is_the_launcher_s_own_argument(write_launch_file, monkeypatch, word, replaces):
    from launch_py.supervision import session

    asked = []
    monkeypatch.setattr(
        session, "run_plan", lambda plan, environ, options: asked.append(options.replace) or 0
    )
    path = write_launch_file("actions = []")
    assert command_line.run([str(path), f"replace:={word}"], "prog") == 0
    assert command_line.run([str(path)], "prog") == 0
    assert asked == [replaces, False]


def test_a_launch_file_may_declare_an_argument_replace(write_launch_file, capsys):
    path = write_launch_file(
        """
        actions = [DeclareLaunchArgument("replace"), LogInfo(msg=LaunchConfiguration("replace"))]
        """
    )
    assert command_line.run([str(path), "replace:=maybe", "--print"], "prog") == 0
    assert "maybe" in capsys.readouterr().out


def test_replace_is_true_or_false(write_launch_file, refused):
    path = write_launch_file("actions = []")
    assert refused(str(path), "replace:=maybe") == "prog: replace:=maybe is neither true nor false"


@pytest.mark.parametrize("words", ["x", "0", "-1", "nan", "inf"])
def test_a_log_limit_is_a_size(capsys, words):
    with pytest.raises(SystemExit, match="2"):
        command_line.run(["--log-limit", words], "prog")
    assert "argument --log-limit: must be" in capsys.readouterr().err
