"""Parameter values whose exact type does not matter."""

from array import array

import pytest

from arm_node.parameter_values import (
    ParameterValueError,
    one_of,
    read_flag,
    read_integer,
    read_non_negative,
    read_nonempty_text,
    read_number,
    read_numbers,
    read_parameter,
    read_text,
    read_texts,
    read_words,
    wanted_by,
)


@pytest.mark.parametrize(
    ("read", "value", "result"),
    [
        (read_number, 2, 2.0),
        (read_number, -0.5, -0.5),
        (read_non_negative, 0, 0.0),
        (read_integer, -3, -3),
        (read_flag, True, True),
        (read_flag, False, False),
        (read_text, "", ""),
        (read_nonempty_text, "a b", "a b"),
        (read_texts, None, ()),
        (read_texts, ["a", "b"], ("a", "b")),
        (read_words, "", ()),
        (read_words, "a, b c", ("a", "b", "c")),
        (read_words, ["a b"], ("a b",)),
        (read_numbers, [], ()),
        (read_numbers, [1, 0.5], (1.0, 0.5)),
        (read_numbers, array("d", [1, 0.5]), (1.0, 0.5)),
        (read_numbers, " [1, 0.5] ", (1.0, 0.5)),
        (one_of(("a", "b")), "b", "b"),
    ],
)
def test_takes_what_can_be_converted(read, value, result):
    converted = read(value)
    assert converted == result
    assert type(converted) is type(result)


@pytest.mark.parametrize(
    ("read", "value", "message"),
    [
        (read_number, True, "must be a finite number, not True"),
        (read_number, "2", "must be a finite number, not '2'"),
        (read_number, float("inf"), "must be a finite number, not inf"),
        (read_non_negative, [2.0], "must be a finite number of at least 0, not [2.0]"),
        (read_non_negative, -1, "must be a finite number of at least 0, not -1"),
        (read_non_negative, float("nan"), "must be a finite number of at least 0, not nan"),
        (read_integer, 1.0, "must be a whole number, not 1.0"),
        (read_integer, False, "must be a whole number, not False"),
        (read_flag, 1, "must be true or false, not 1"),
        (read_flag, "true", "must be true or false, not 'true'"),
        (read_flag, None, "must be true or false, not None"),
        (read_text, 5, "must be a text, not 5"),
        (read_nonempty_text, "", "must be a text, not ''"),
        (read_texts, "a", "must be a list of texts, not 'a'"),
        (read_texts, ["a", ""], "must be a list of texts, not ['a', '']"),
        (read_words, [1], "must be a list of texts, not [1]"),
        (read_numbers, "home", "must be a list of finite numbers, not 'home'"),
        (read_numbers, "[a, b]", "must be a list of finite numbers, not '[a, b]'"),
        (read_numbers, [1, True], "must be a list of finite numbers, not [1, True]"),
        (read_numbers, 3, "must be a list of finite numbers, not 3"),
        (one_of(("a", "b")), "c", "must be one of a, b, not 'c'"),
        (one_of(("a", "b")), 1, "must be one of a, b, not 1"),
    ],
)
def test_refuses_any_other_value_and_says_what_it_must_be(read, value, message):
    with pytest.raises(ParameterValueError) as caught:
        read(value)
    assert str(caught.value) == message


def test_what_a_reader_takes_can_be_asked():
    assert wanted_by(read_non_negative) == "a finite number of at least 0"
    assert wanted_by(one_of(("a", "b"))) == "one of a, b"
    assert wanted_by(str) == ""


def test_the_name_of_the_parameter_comes_first():
    with pytest.raises(ParameterValueError, match=r"^left\.base must be true or false, not 3$"):
        read_parameter("left.base", 3, read_flag)
