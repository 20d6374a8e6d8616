"""The value of each substitution, and the error if it has none."""

import sys
from pathlib import Path

import pytest

from launch_py import LaunchContext
from launch_py.errors import LaunchFileError, NotFoundError, SubstitutionError
from launch_py.substitution import perform_text
from launch_py.substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnySubstitution,
    Call,
    Command,
    EnvironmentVariable,
    EqualsSubstitution,
    FindExecutable,
    IfElseSubstitution,
    LaunchConfiguration,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    PathJoinSubstitution,
    PythonExpression,
    TextSubstitution,
    ThisLaunchFileDir,
)


@pytest.fixture
def context():
    return LaunchContext(launch_configurations={"world": "objects", "yes": "true", "no": "false"})


def test_a_text_may_be_joined_from_parts(context):
    value = ["a ", TextSubstitution(text="b "), LaunchConfiguration("world"), Path("/c")]
    assert perform_text(context, value) == "a b objects/c"


def test_a_value_that_is_not_a_text_is_refused(context):
    with pytest.raises(LaunchFileError, match="not 3 of type int"):
        perform_text(context, 3)  # pyright: ignore[reportArgumentType]


def test_launch_configuration_suggests_similar_names(context):
    with pytest.raises(SubstitutionError, match=r"'wrld'.*did you mean 'world'"):
        LaunchConfiguration("wrld").perform(context)


def test_launch_configuration_takes_its_default(context):
    assert LaunchConfiguration("other", default="x").perform(context) == "x"


def test_environment_variable_sees_the_launch_file_s_settings():
    context = LaunchContext(base_environment={"A": "1", "B": "2"})
    context.set_environment_variable("A", "3")
    context.set_environment_variable("B", None)
    assert EnvironmentVariable("A").perform(context) == "3"
    with pytest.raises(SubstitutionError, match="B is not set"):
        EnvironmentVariable("B").perform(context)
    assert EnvironmentVariable("B", default_value="d").perform(context) == "d"


def test_path_join(context):
    parts = ["/share", [LaunchConfiguration("world"), ".xml"]]
    assert PathJoinSubstitution(parts).perform(context) == "/share/objects.xml"


def test_this_launch_file_dir(context):
    context.launch_file = Path("/a/b/x.launch.py")
    assert ThisLaunchFileDir().perform(context) == "/a/b"


def test_without_a_launch_file_there_is_no_folder(context):
    with pytest.raises(SubstitutionError, match="no launch file is being read"):
        ThisLaunchFileDir().perform(context)


def test_command_returns_the_output(context):
    command = [sys.executable, " -c 'print(1 + 1)'"]
    assert Command(command).perform(context) == "2"


def test_command_that_fails_reports_its_stderr(context):
    command = Command([sys.executable, " -c 'import sys; sys.exit(\"no such file\")'"])
    with pytest.raises(SubstitutionError, match="exit code 1: no such file"):
        command.perform(context)


@pytest.mark.parametrize(
    ("text", "message"),
    [("echo 'a", "cannot be split: No closing quotation"), (" ", "Command has no text")],
)
def test_an_empty_command_is_refused(context, text, message):
    with pytest.raises(SubstitutionError, match=message):
        Command(text).perform(context)


def test_command_that_writes_to_stderr_fails_by_default(context):
    text = [sys.executable, " -c 'import sys; sys.stderr.write(\"hm\"); print(5)'"]
    with pytest.raises(SubstitutionError, match="complained: hm"):
        Command(text).perform(context)
    assert Command(text, on_stderr="ignore").perform(context) == "5"


def test_command_whose_parts_lack_a_space_suggests_it(context):
    with pytest.raises(NotFoundError, match=r"no-such/arm.urdf .*without spaces: is one missing"):
        Command(["no-such", "/arm.urdf"]).perform(context)
    with pytest.raises(NotFoundError, match="no program 'no-such'") as said:
        Command(["no-such ", "/arm.urdf"]).perform(context)
    assert "space" not in str(said.value)


def test_command_finds_programs_beside_this_python(context):
    context.base_environment = {"PATH": "/nowhere"}
    found = FindExecutable(name=Path(sys.executable).name).perform(context)
    assert found == sys.executable


def test_find_executable_suggests_similar_programs(tmp_path):
    (tmp_path / "xacro").touch(mode=0o755)
    context = LaunchContext(base_environment={"PATH": str(tmp_path)})
    with pytest.raises(NotFoundError, match=r"no program 'xacr'.*did you mean 'xacro'"):
        FindExecutable(name="xacr").perform(context)


def test_call_gets_performed_texts(context):
    def expand(path: str, **arguments: str) -> str:
        return f"{path} {arguments}"

    call = Call(expand, ["/a/", LaunchConfiguration("world")], base=LaunchConfiguration("yes"))
    assert call.perform(context) == "/a/objects {'base': 'true'}"


def test_call_that_fails_is_reported(context):
    class OwnError(Exception):
        pass

    def describe():
        raise OwnError("no file arm.xacro")

    with pytest.raises(LaunchFileError, match=r"^Call\(describe\): no file arm.xacro$"):
        Call(describe).perform(context)
    with pytest.raises(LaunchFileError, match=r"Call\(int\): ValueError: invalid literal"):
        Call(int, "x").perform(context)


@pytest.mark.parametrize(
    ("left", "right", "equal"),
    [
        (LaunchConfiguration("world"), "objects", True),
        (["ob", LaunchConfiguration("none", default="jects")], "objects", True),
        ("1", "1.0", True),
        ("True", "true", True),
        ("1", "true", True),
        ("0", "false", True),
        ("1.0", "true", False),
        (2, "2", True),
        (2, 2.0, True),
        (0.1 + 0.2, 0.3, True),
        (2, "a", False),
        (True, LaunchConfiguration("yes"), True),
        (True, 1, True),
        (False, None, False),
        (None, "", True),
        ("nan", "nan", False),
        (["a"], "a", False),
        ([1, 2], "[1, 2]", True),
        (Path("/a"), "/a", True),
        ("a", "b", False),
    ],
)
def test_anything_is_compared_with_anything(context, left, right, equal):
    assert EqualsSubstitution(left, right).perform(context) == str(equal).lower()
    assert NotEqualsSubstitution(left, right).perform(context) == str(not equal).lower()


@pytest.mark.parametrize(
    ("substitution", "expected"),
    [
        (AndSubstitution("true", LaunchConfiguration("no")), "false"),
        (OrSubstitution("true", LaunchConfiguration("no")), "true"),
        (AllSubstitution("true", LaunchConfiguration("yes"), "1"), "true"),
        (AllSubstitution("true", LaunchConfiguration("no"), "1"), "false"),
        (AnySubstitution("false", LaunchConfiguration("yes"), "0"), "true"),
        (AnySubstitution("false", LaunchConfiguration("no")), "false"),
        (NotSubstitution(LaunchConfiguration("no")), "true"),
        (IfElseSubstitution(LaunchConfiguration("yes"), "a", "b"), "a"),
        (IfElseSubstitution("false", "a", "b"), "b"),
    ],
)
def test_logic(context, substitution, expected):
    assert substitution.perform(context) == expected


def test_logic_on_a_value_that_is_not_a_boolean_is_refused(context):
    with pytest.raises(SubstitutionError, match="'maybe', neither true nor false"):
        NotSubstitution("maybe").perform(context)


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("1 + 2 * 3", "7"),
        ("'a' == 'a' and not false", "True"),
        ("'x' if 2 > 1 else 'y'", "x"),
        ("'b' in ['a', 'b']", "True"),
        ("1 < 2 < 3", "True"),
        ("-4 // 3", "-2"),
        ("'left' or 'robot'", "left"),
        ("'' or 'robot'", "robot"),
        ("'' and 'b'", ""),
        ("'a' and 'b'", "b"),
        ("0 and 1 / 0", "0"),
        ("1 > 2 > 1 / 0", "False"),
        ("'a' is not None", "True"),
        ("None is None", "True"),
        ("'%s_%s' % ('a', 'b')", "a_b"),
        ("'b' in ('a', 'b')", "True"),
        ("'b' not in ['a', 'b']", "False"),
    ],
)
def test_python_expression(context, expression, expected):
    assert PythonExpression(expression).perform(context) == expected


@pytest.mark.parametrize(
    ("expression", "modules", "expected"),
    [
        ("[x.upper() for x in 'ab'][-1]", ("math",), "B"),
        ("cos(0) + math.sin(0)", ("math",), "1.0"),
        ("os.path.basename('/a/b')", ["os"], "b"),
        ("json.loads('[1]')[0] + math.floor(1.5)", ["json", "math"], "2"),
        ("json.loads('[1]')[0]", "json", "1"),
        ("[floor(x) for x in (1.5, 2.5)]", ("math",), "[1, 2]"),
        ("' a '.strip()", [], "a"),
    ],
)
def test_a_python_file_evaluates_any_expression(context, expression, modules, expected):
    assert PythonExpression(expression, modules).perform(context) == expected


@pytest.mark.parametrize("expression", ["1 +", "1 / 0", "'a' - 1", "nothing"])
def test_python_expression_without_a_value_is_reported(context, expression):
    with pytest.raises(SubstitutionError, match="expression"):
        PythonExpression(expression).perform(context)


def test_a_module_that_does_not_exist_is_reported(context):
    with pytest.raises(SubstitutionError, match="ModuleNotFoundError: No module named 'nothing'"):
        PythonExpression("1", ["nothing"]).perform(context)
