import os

import pytest

from arm_cli.launch import launch_domain


@pytest.fixture(autouse=True)
def _domain_of_the_tests(monkeypatch):
    # The variable is restored after the test.
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")


def test_without_the_word_nothing_changes():
    with launch_domain(["mycobot", "viewer:=true"]) as words:
        assert words == ["mycobot", "viewer:=true"]
        assert os.environ["ROS_DOMAIN_ID"] == "7"


def test_a_number_is_the_domain():
    with launch_domain(["domain:=42", "viewer:=true"]) as words:
        assert words == ["viewer:=true"]
        assert os.environ["ROS_DOMAIN_ID"] == "42"


def test_auto_finds_a_domain_of_its_own_for_each_launch(capsys):
    with launch_domain(["domain:=auto"]) as words:
        assert words == []
        first = os.environ["ROS_DOMAIN_ID"]
        with launch_domain(["domain:=auto"]):
            second = os.environ["ROS_DOMAIN_ID"]
    assert first != second
    assert f"[launch] ROS_DOMAIN_ID={first}; export it" in capsys.readouterr().out


@pytest.mark.parametrize("value", ["233", "mine", "-1", ""])
def test_another_value_is_left_to_the_launch_file(value):
    with launch_domain([f"domain:={value}"]) as words:
        assert words == [f"domain:={value}"]
        assert os.environ["ROS_DOMAIN_ID"] == "7"
