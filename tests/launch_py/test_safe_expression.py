"""Expressions of XML, YAML and parameter files: what they can do, and what they cannot reach."""

import math

import pytest

from launch_py import LaunchContext
from launch_py.errors import SubstitutionError
from launch_py.ros.substitution_parser import parse_substitutions
from launch_py.substitution import perform_text
from launch_py.substitutions.command import PythonExpression
from launch_py.substitutions.safe_expression import MAX_SIZE, SafeExpression


@pytest.fixture
def context():
    return LaunchContext(launch_configurations={"sim": "True", "path": "/opt/arm/robot.urdf"})


EXPRESSIONS = [
    "'True'.lower() == 'true'",
    "int('3') + float('0.5')",
    "str(3) + 'a'",
    "len('arm')",
    "round(2.567, 1)",
    "round(10**300)",
    "any(['' , 'a'])",
    "all(x > 0 for x in [1, 2])",
    "'/a/b/c.urdf'.split('/')[-1]",
    "'/a/b/c.urdf'.split('/')[-1].replace('.urdf', '')",
    "'robot'[0]",
    "'robot'[1:3] + 'robot'[::-1] + 'robot'[-2:]",
    "2 ** 10",
    "2 ** -1",
    "(-8) ** 0.5",
    "f'{1 + 1}_{\"a\"!r:>5}_{3.14159:.2f}'",
    "f'{2:0{3}d}'",
    "f'{chr!a}'".replace("chr", '"ä"'),
    "math.pi / 2",
    "pi",
    "radians(90.0)",
    "math.degrees(math.atan2(1, 1))",
    "sqrt(2) + abs(-1) + min(1, 2) + max([3, 4])",
    "sorted(['b', 'a'], reverse=True)",
    "[x * y for x in range(3) for y in (1, 2) if x != y]",
    "[a + b for a, b in [(1, 2), (3, 4)]]",
    "','.join(str(x) for x in range(3))",
    "{'a': 1, 'b': 2}['b']",
    "{'a': 1}.get('c', 7)",
    "list({'a': 1}.items())",
    "'x' if 'a' in ['a'] and not False else 'y'",
    "1 < 2 < 3",
    "'' or 'robot'",
    "0 and 1 / 0",
    "7 // 2, 7 % 4, 1 << 3, 6 & 3, ~1",
    "[*range(3), 5]",
    "'%s_%03d' % ('a', 5)",
    "bool('')",
    "tuple([1])",
    "sum([1, 2.5])",
    "None is None",
]


@pytest.mark.parametrize("expression", EXPRESSIONS)
def test_it_has_python_s_value(context, expression):
    expected = str(eval(expression, {**vars(math), "math": math}))
    assert SafeExpression(expression).perform(context) == expected
    assert PythonExpression(expression).perform(context) == expected


def test_the_words_of_launch_arguments_are_booleans(context):
    assert SafeExpression("true and not false").perform(context) == "True"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("$(eval \"'$(var sim)'.lower() == 'true'\")", "True"),
        ("$(eval \"'$(var path)'.split('/')[-1]\")", "robot.urdf"),
        ("$(eval 'math.floor(1.5)' 'math')", "1"),
    ],
)
def test_files_write_it_as_eval(context, text, expected):
    assert perform_text(context, parse_substitutions(text)) == expected


@pytest.mark.parametrize(
    ("expression", "message"),
    [
        ("open('f')", "no function 'open'"),
        ("__import__('os')", "no function '__import__'"),
        ("os", "no name 'os'"),
        ("().__class__", "not allowed"),
        ("''.__class__()", "not allowed in a file"),
        ("math.__loader__", "math has no '__loader__'"),
        ("'{0.real}'.format(1)", "not allowed in a file"),
        ("getattr(1, 'real')", "no function 'getattr'"),
        ("lambda: 1", "not allowed"),
        ("(x := 1)", "not allowed"),
        ("min([1], key=len)", "not allowed"),
        ("str(**{'object': 1})", "not allowed"),
        ("b'a'", "not allowed"),
        ("'a'.lowr()", r"did you mean 'lower'"),
        ("raund(1)", r"did you mean 'round'"),
        ("1 +", "is not Python"),
        ("1 / 0", "has no value"),
        ("'a' - 1", "has no value"),
        ("{}['a']", "has no value"),
        ("x", "no name 'x'"),
    ],
)
def test_what_it_does_not_have_is_refused(context, expression, message):
    with pytest.raises(SubstitutionError, match=message):
        SafeExpression(expression).perform(context)


@pytest.mark.parametrize(
    "expression",
    [
        "9**9**4",
        "1 << 10**5",
        "2**4000 * 2**4000",
        f"'a' * {MAX_SIZE + 1}",
        f"{MAX_SIZE + 1} * [1]",
        "[['a' * 5000] * 2] * 100",
        "['a' * 5000, 'a' * 5000, 'a' * 5000]",
        "(',' * 5000).join(['a'] * 5000)",
        "('a' * 5000).replace('a', 'b' * 5000)",
        "'%100000d' % 1",
        "'%*d' % (100000, 1)",
        "f'{1:>100000}'",
        "f'{1:{10**6}d}'",
        "range(10**5)",
        "math.factorial(10**4)",
        "comb(10**4, 10**3)",
        "round(1, -(10**4))",
        "[1 for a in range(900) for b in range(900)]",
        "'-' * (" + "-" * 5000 + "1)",
    ],
)
def test_what_would_take_long_or_much_memory_is_refused(context, expression):
    with pytest.raises(SubstitutionError, match=r"too long|makes|more than"):
        SafeExpression(expression).perform(context)


def test_a_file_can_use_math_only(context):
    with pytest.raises(SubstitutionError, match="the module math only, not 'os'"):
        SafeExpression("os.getcwd()", "math, os").perform(context)
