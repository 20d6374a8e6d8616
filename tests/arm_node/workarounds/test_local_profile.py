"""The twin of a profile that says itself what LOCALHOST means."""

from pathlib import Path

import pytest

from arm_node.workarounds.local_profile import (
    profile_variable,
    use_general_profile,
    use_local_profile,
)

pytestmark = pytest.mark.workaround("local_profile")


@pytest.fixture
def profile(tmp_path) -> Path:
    """Return a profile that has a twin."""
    (tmp_path / "net_localhost.xml").touch()
    return tmp_path / "net.xml"


def environment(profile: Path | str, **more: str) -> dict[str, str]:
    return {profile_variable(): str(profile), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", **more}


def test_localhost_is_left_to_the_other_profile(profile):
    environ = environment(profile, HOME="/home/me")
    use_local_profile(environ)
    assert environ == {
        profile_variable(): str(profile.with_name("net_localhost.xml")),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT",
        "HOME": "/home/me",
    }


def test_a_child_gets_back_what_there_was(profile):
    environ = environment(profile)
    use_local_profile(environ)
    use_general_profile(environ)
    assert environ == environment(profile)


@pytest.mark.parametrize(
    "more",
    [
        {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"},
        {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT"},
        {"ROS_STATIC_PEERS": "192.0.2.7"},
    ],
)
def test_any_other_wish_is_rmws_to_fulfil(profile, more):
    environ = environment(profile, **more)
    use_local_profile(environ)
    use_general_profile(environ)
    assert environ == environment(profile, **more)


def test_a_profile_without_a_twin_stays(tmp_path):
    for chosen in (tmp_path / "mine.xml", ""):
        environ = environment(chosen)
        use_local_profile(environ)
        assert environ == environment(chosen)
    environ = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    use_local_profile(environ)
    assert environ == {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
