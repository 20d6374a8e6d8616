"""The service /get_planning_scene_mycobot, and mtc_node, which picks up what it returns."""

import subprocess
import sys
from collections.abc import Callable
from typing import Any

import pytest
from programs import Program

pytestmark = pytest.mark.ros

PACKAGE = "mycobot_mtc_pick_place_demo"
LAUNCH_FILE = "pick_place_demo.launch.py"
SERVICE = "/get_planning_scene_mycobot"
DIMENSIONS = [0.35, 0.0125]
"""Of the red cylinder."""
PLACE = (0.22, 0.12)
TIMEOUT_S = 250.0


@pytest.fixture(scope="module")
def server(launch_for_file: Callable[..., Program]) -> Program:
    """Return the server beside the myCobot with its camera and move_group, all of them ready."""
    launch_for_file("mycobot", "use_camera:=true", "planning:=true").wait_until_ready()
    program = launch_for_file(PACKAGE, "get_planning_scene_server.launch.py")
    program.wait_until_ready()
    return program


def ask(client: Any, shape: str, *dimensions: float) -> Any:
    from mycobot_interfaces.srv import GetPlanningScene

    request = GetPlanningScene.Request(target_shape=shape, target_dimensions=dimensions)
    return client.call(GetPlanningScene, SERVICE, request)


def test_the_red_cylinder_is_the_target_and_stands_on_the_surface(server, client_for_file):
    seen = ask(client_for_file, "cylinder", *DIMENSIONS)
    assert seen.success
    objects = {each.id: each for each in seen.scene_world.collision_objects}
    assert seen.support_surface_id == "support_surface"
    target, surface = objects[seen.target_object_id], objects[seen.support_surface_id]
    assert {each.header.frame_id for each in objects.values()} == {"base_link"}
    assert list(target.primitives[0].dimensions) == pytest.approx(DIMENSIONS, rel=0.1)
    position = target.pose.position
    assert (position.x, position.y) == pytest.approx(PLACE, abs=5e-3)
    # The floor is 25 mm below base_link, and the cylinder's middle half its height above that.
    assert position.z == pytest.approx(0.15, abs=5e-3)
    thickness = surface.primitives[0].dimensions[2]
    assert surface.pose.position.z + thickness / 2 == pytest.approx(-0.025, abs=3e-3)
    assert (seen.full_cloud.height, seen.full_cloud.width) == (
        seen.rgb_image.height,
        seen.rgb_image.width,
    )


@pytest.mark.parametrize(
    ("shape", "dimensions", "says"),
    [
        ("", [], "Invalid input parameters: target_shape or target_dimensions is empty"),
        ("sphere", [0.1], "no target_shape 'sphere' can be found"),
        ("box", [0.05, 0.05, 0.05], "no box of about 0.050 x 0.050 x 0.050 m is seen"),
    ],
)
def test_what_cannot_be_found_is_not_a_success_and_the_log_says_why(
    server, client_for_file, shape, dimensions, says
):
    seen = ask(client_for_file, shape, *dimensions)
    assert not seen.success
    assert seen.target_object_id == ""
    assert server.wait_for(says)


@pytest.mark.slow
@pytest.mark.timeout(400)
def test_mtc_node_puts_down_elsewhere_what_the_camera_sees(server, client_for_file):
    from simulation_interfaces.srv import GetEntityState

    done = subprocess.run(
        [sys.executable, "-m", "arm_cli", "launch", PACKAGE, LAUNCH_FILE, "execute:=true"],
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
        check=False,
    )
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    assert "is seen, on support_surface" in said
    assert "Task executed successfully" in said
    asked = GetEntityState.Request(entity="red_cylinder")
    pose = client_for_file.call(GetEntityState, "/get_entity_state", asked).state.pose
    assert (pose.position.x, pose.position.y) == pytest.approx((-0.183, -0.14), abs=0.015)
    assert pose.position.z == pytest.approx(0.175, abs=3e-3)
