"""Arguments for xacro files as a shell has them."""

import pytest

from arm_description.errors import XacroError
from arm_description.xacro_arguments import arguments_of_text, arguments_of_words


def test_arguments_are_words_of_name_and_value():
    words = ["a:=1", "b:=two words", "c:=", "d:=e:=f"]
    assert arguments_of_words(words) == {"a": "1", "b": "two words", "c": "", "d": "e:=f"}


def test_a_text_is_parted_as_in_a_shell():
    assert arguments_of_text("a:=1 b:='two words'\n") == {"a": "1", "b": "two words"}
    assert arguments_of_text("") == {}


@pytest.mark.parametrize("text", ["a", "a=1", ":=1", "a:='1"])
def test_what_is_no_argument_is_refused(text):
    with pytest.raises(XacroError, match=r"NAME:=VALUE|No closing quotation"):
        arguments_of_text(text)
