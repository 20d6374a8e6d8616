"""The service /get_planning_scene_mycobot, and mtc_node, which picks up what it returns."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from math import dist, inf
from typing import Any

import pytest
from control_msgs.action import FollowJointTrajectory
from mycobot_interfaces.srv import GetPlanningScene
from programs import Program
from robots import MYCOBOT_ARM
from run_python import run_python
from sensor_msgs.msg import JointState
from simulated import Simulated
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_planning.perception.table_objects import Crop, objects_in_view
from arm_planning.ros.point_clouds import points_of
from arm_planning.ros.transform_reader import TransformReader

PACKAGE = "mycobot_mtc_pick_place_demo"
LAUNCH_FILE = "pick_place_demo.launch.py"
SERVICE = "/get_planning_scene_mycobot"
DIMENSIONS = [0.35, 0.0125]
"""Of the red cylinder."""
PLACE = (0.22, 0.12)
TIMEOUT_S = 250.0
BEHIND = (-0.3, -1.2, -0.3, 1.0, 0.0, 0.0)
"""The arm in the crop, behind the cylinder as the camera sees it."""
SWAYING_RAD, SWAY_S, SWAYS = 0.1, 0.5, 200
"""Its first joint to both sides: 30 mm of the hand in 0.1 s, three times the padding."""
FASTER_RAD_S = 0.1


@pytest.fixture(scope="module")
def server(launch_for_file) -> Program:
    """Return the server beside the myCobot with its camera and move_group, all of them ready."""
    launch_for_file("mycobot", "use_camera:=true", "planning:=true").wait_until_ready()
    program = launch_for_file(PACKAGE, "get_planning_scene_server.launch.py")
    program.wait_until_ready()
    return program


def ask(client: Any, shape: str, *dimensions: float) -> Any:
    request = GetPlanningScene.Request(target_shape=shape, target_dimensions=dimensions)
    return client.call(GetPlanningScene, SERVICE, request)


def centres(answer: Any) -> list[tuple[float, ...]]:
    positions = [each.pose.position for each in answer.scene_world.collision_objects]
    return [(one.x, one.y, one.z) for one in positions]


def seen_with_the_robot(client: Any, seen: Any) -> list[Any]:
    """Return what the points of an answer show in the tutorial's crop, the robot as well."""
    reader, frame = TransformReader(client.node), seen.full_cloud.header.frame_id
    camera = client.wait_until(lambda: reader.pose(frame, "base_link"), f"{frame} on /tf")
    crop = Crop((0.1, 0.0, -inf), (1.1, 0.9, inf))
    return list(objects_in_view(points_of(seen.full_cloud), camera, crop, "s", 0.01).objects)


def assert_same_things(seen: Any, before: Any) -> None:
    """Check that the target is as large as it is, and that all is where it was before."""
    assert seen.success
    objects = {each.id: each for each in seen.scene_world.collision_objects}
    target = objects[seen.target_object_id]
    assert list(target.primitives[0].dimensions) == pytest.approx(DIMENSIONS, rel=0.1)
    position = target.pose.position
    assert (position.x, position.y) == pytest.approx(PLACE, abs=5e-3)
    found, expected = centres(seen), centres(before)
    assert len(found) == len(expected), f"{found} instead of {expected}"
    off = [min(dist(one, other) for other in expected) for one in found]
    assert max(off) < 5e-3, f"{found} instead of {expected}"


def in_the_crop(state: Any) -> bool:
    """Tell whether the arm has gone as far as it is in the crop."""
    at = dict(zip(state.name, state.position, strict=True))
    return at[MYCOBOT_ARM[1]] < BEHIND[1] + 0.02


def speed_at(stamp: Any, states: Any) -> float:
    """Return how fast the arm's first joint was at a time, in rad/s."""

    def passed(messages: list[Any]) -> bool:
        return messages and since(messages[-1].header.stamp) >= 0.0

    def since(other: Any) -> float:
        return other.sec - stamp.sec + 1e-9 * (other.nanosec - stamp.nanosec)

    messages = states.wait_until(passed, "the joint states of the picture")
    nearest = min(messages, key=lambda message: abs(since(message.header.stamp)))
    return abs(nearest.velocity[nearest.name.index(MYCOBOT_ARM[0])])


@contextmanager
def arm_following(client: Any, points: Sequence[tuple[float, Sequence[float]]]) -> Iterator[Any]:
    """Send the arm along points of time and positions; yield the future of the result.

    In the end the arm goes home.
    """
    with client.tidied():
        action = client.action(FollowJointTrajectory, "/arm_controller/follow_joint_trajectory")

        def send(points: Sequence[tuple[float, Sequence[float]]]) -> Any:
            path = JointTrajectory(joint_names=MYCOBOT_ARM)
            for time_s, positions in points:
                point = JointTrajectoryPoint(positions=positions)
                point.time_from_start.sec = int(time_s)
                point.time_from_start.nanosec = round(time_s % 1 * 1e9)
                path.points.append(point)
            ended = client.send_goal(action, FollowJointTrajectory.Goal(trajectory=path))
            assert ended is not None, "the goal is rejected"
            return ended

        yield send(points)
        assert client.result_of(send([(3.0, [0.0] * 6)]), "the way home").result.error_code == 0


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


def test_an_arm_that_stands_in_the_crop_is_not_among_the_things(server, client_for_file):
    without = ask(client_for_file, "cylinder", *DIMENSIONS)
    with arm_following(client_for_file, [(3.0, BEHIND)]) as ended:
        result = client_for_file.result_of(ended, "the way behind the cylinder").result
        assert result.error_code == 0, result.error_string
        seen = ask(client_for_file, "cylinder", *DIMENSIONS)
    assert_same_things(seen, without)
    robot_too = seen_with_the_robot(client_for_file, seen)
    assert len(robot_too) > len(seen.scene_world.collision_objects)


def test_an_arm_that_moves_in_the_crop_is_not_among_the_things(server, client_for_file):
    without = ask(client_for_file, "cylinder", *DIMENSIONS)
    turn, *others = BEHIND
    ways = [
        (3.0 + SWAY_S * number, (turn + SWAYING_RAD * (-1) ** number, *others))
        for number in range(SWAYS)
    ]
    with arm_following(client_for_file, ways) as ended:
        states = client_for_file.subscribe(JointState, "/joint_states")
        states.wait_until(
            lambda messages: messages and in_the_crop(messages[-1]), "the arm in the crop"
        )
        answers = [ask(client_for_file, "cylinder", *DIMENSIONS) for _ in range(3)]
        assert not ended.done(), "the arm had stopped before the last picture"
        speeds = [speed_at(answer.full_cloud.header.stamp, states) for answer in answers]
    assert max(speeds) > FASTER_RAD_S
    for answer in answers:
        assert_same_things(answer, without)
        robot_too = seen_with_the_robot(client_for_file, answer)
        assert len(robot_too) > len(answer.scene_world.collision_objects)


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
    done = run_python(
        "-m", "arm_cli", "launch", PACKAGE, LAUNCH_FILE, "execute:=true", timeout_s=TIMEOUT_S
    )
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    assert "is seen, on support_surface" in said
    assert "Task executed successfully" in said
    pose = Simulated(client_for_file).state_of("red_cylinder").pose
    assert (pose.position.x, pose.position.y) == pytest.approx((-0.183, -0.14), abs=0.015)
    assert pose.position.z == pytest.approx(0.175, abs=3e-3)
