"""Gravity, and mass and friction of things, are parameters of the node that serves the world."""

import math
from pathlib import Path

import pytest
from rcl_interfaces.srv import ListParameters
from robots import crate
from simulated import Simulated

from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile

CRATE = crate(size=0.2)
MOON = [0.0, 0.0, -1.62]


class World(Simulated):
    """The simulation with the parameters of its world."""

    def names(self) -> set[str]:
        request = ListParameters.Request(prefixes=["gravity", "entities"])
        answer = self.client.call(ListParameters, "/simulation/list_parameters", request)
        return set(answer.result.names)

    def get(self, name: str):
        return self.client.get_parameter("/simulation", name)

    def set(self, node: str = "/simulation", **values) -> str:
        return super().set(node, **values)


@pytest.fixture(scope="module")
def recording(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("run") / "moon.run"


@pytest.fixture(scope="module")
def running(launch_for_file, recording):
    """A simulation that is recorded; the last test ends it."""
    launched = launch_for_file("camera:=none", "world:=objects", f"record_run:={recording}")
    launched.wait_until_ready()
    return launched


@pytest.fixture(scope="module")
def world(running, client_for_file) -> World:
    """The world of the simulation, which each test leaves as it was."""
    return World(client_for_file)


def test_parameters_follow_the_world_and_change_it(world):
    things = {name for name in world.names() if name.endswith(".mass")}
    assert "entities.red_box.mass" in things
    assert len(things) == 8
    own = world.get("entities.red_box.mass")
    assert world.get("gravity") == pytest.approx([0, 0, -9.81])
    assert world.set(gravity=MOON, entities__red_box__mass=0.5) == ""
    assert (world.get("gravity"), world.get("entities.red_box.mass")) == (MOON, 0.5)

    world.spawn("crate", CRATE, 2.0, 0.0, 0.1)
    assert {"entities.crate.mass", "entities.crate.friction"} <= world.names()
    assert world.set(entities__crate__friction=0.1) == ""
    assert world.get("entities.crate.friction") == 0.1
    assert (world.get("gravity"), world.get("entities.red_box.mass")) == (MOON, 0.5)

    world.reset(2)  # SCOPE_STATE
    assert (world.get("gravity"), world.get("entities.red_box.mass")) == (MOON, 0.5)
    world.delete("crate")
    assert "entities.crate.mass" not in world.names()
    world.reset(0)
    assert world.get("gravity") == pytest.approx([0, 0, -9.81])
    assert world.get("entities.red_box.mass") == own


def test_what_is_wrong_is_refused_with_a_reason_and_changes_nothing(world):
    refused = world.set(gravity=MOON, entities__red_box__mass=-1.0)
    assert refused == "the mass of 'red_box' is 1e-06 to 1e+06 kg, not -1 kg"
    assert world.get("gravity") == pytest.approx([0, 0, -9.81])
    assert world.set(gravity=[0.0, 0.0, math.nan]) == (
        "the gravity is three numbers x y z from -100 to 100 m/s2, not [0.0, 0.0, nan]"
    )
    assert world.set(entities__red_box__friction=1e9).startswith("the friction of 'red_box' is 0")
    assert world.get("entities.red_box.friction") == 0.8


def test_a_run_over_ros_repeats_with_them(world, running, recording):
    assert world.set(gravity=[0.5, 0.0, -3.0], entities__red_box__mass=0.05) == ""
    world.spawn("crate", CRATE, 2.0, 0.0, 0.1)
    assert world.set(entities__crate__friction=0.02) == ""
    world.reset(0)
    assert world.set(gravity=MOON) == ""
    running.stop()
    result = Replay(RunFile(recording)).run()
    assert result.difference is None
    assert result.periods > 0
