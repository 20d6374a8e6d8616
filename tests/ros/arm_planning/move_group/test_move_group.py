"""move_group as MoveIt's clients use it: names and QoS, planning, the scene, and states."""

import itertools
import math
from typing import Any

import pytest
from geometry_msgs.msg import Pose
from moveit_msgs.msg import (
    AttachedCollisionObject,
    CollisionObject,
    ContactInformation,
    DisplayTrajectory,
    PlannerParams,
    PlanningScene,
)
from moveit_msgs.srv import (
    GetCartesianPath,
    GetPlannerParams,
    GetPositionFK,
    GetPositionIK,
    GetStateValidity,
    QueryPlannerInterfaces,
    SetPlannerParams,
)
from rclpy.action import get_action_names_and_types
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import String

SUCCESS = 1
SERVICES = {
    "/plan_kinematic_path": "moveit_msgs/srv/GetMotionPlan",
    "/compute_cartesian_path": "moveit_msgs/srv/GetCartesianPath",
    "/compute_ik": "moveit_msgs/srv/GetPositionIK",
    "/compute_fk": "moveit_msgs/srv/GetPositionFK",
    "/check_state_validity": "moveit_msgs/srv/GetStateValidity",
    "/query_planner_interface": "moveit_msgs/srv/QueryPlannerInterfaces",
    "/get_planner_params": "moveit_msgs/srv/GetPlannerParams",
    "/set_planner_params": "moveit_msgs/srv/SetPlannerParams",
    "/get_planning_scene": "moveit_msgs/srv/GetPlanningScene",
    "/apply_planning_scene": "moveit_msgs/srv/ApplyPlanningScene",
    "/clear_octomap": "std_srvs/srv/Empty",
    "/get_urdf": "moveit_msgs/srv/GetGroupUrdf",
}
ACTIONS = {
    "/move_action": "moveit_msgs/action/MoveGroup",
    "/execute_trajectory": "moveit_msgs/action/ExecuteTrajectory",
}
HEARD = {
    "/planning_scene": "moveit_msgs/msg/PlanningScene",
    "/planning_scene_world": "moveit_msgs/msg/PlanningSceneWorld",
    "/collision_object": "moveit_msgs/msg/CollisionObject",
    "/attached_collision_object": "moveit_msgs/msg/AttachedCollisionObject",
    "/trajectory_execution_event": "std_msgs/msg/String",
}
SAID = {
    "/monitored_planning_scene": "moveit_msgs/msg/PlanningScene",
    "/display_planned_path": "moveit_msgs/msg/DisplayTrajectory",
    "/robot_description_semantic": "std_msgs/msg/String",
}


def fk(planning: Any, positions: dict[str, float], link: str = "link6_flange") -> Any:
    """Return a link's pose in the planning frame."""
    request = GetPositionFK.Request(fk_link_names=[link])
    set_state(request.robot_state, positions)
    answer = planning.call("/compute_fk", request)
    assert answer.error_code.val == SUCCESS, answer.error_code.message
    return answer.pose_stamped[0]


def set_state(state: Any, positions: dict[str, float]) -> None:
    """Write positions into a robot state that leaves the other joints where they are."""
    state.is_diff = True
    state.joint_state.name = list(positions)
    state.joint_state.position = list(positions.values())


def place(pose: Any) -> list[float]:
    return [pose.position.x, pose.position.y, pose.position.z]


def points(response: Any) -> list[Any]:
    return response.trajectory.joint_trajectory.points


# Names, types and QoS


def test_services_and_actions_have_the_names_and_types_of_moveit(planning):
    node = planning.client.node

    def found() -> dict[str, list[str]]:
        every = [*node.get_service_names_and_types(), *get_action_names_and_types(node)]
        return {name: kinds for name, kinds in every if name in {**SERVICES, **ACTIONS}}

    planning.client.wait_until(lambda: len(found()) == len(SERVICES) + len(ACTIONS), "all of them")
    assert found() == {name: [kind] for name, kind in {**SERVICES, **ACTIONS}.items()}


@pytest.mark.parametrize(("topic", "kind"), HEARD.items())
def test_topics_that_it_hears_are_reliable(planning, topic, kind):
    node = planning.client.node
    found = planning.client.wait_until(
        lambda: node.get_subscriptions_info_by_topic(topic), f"a reader of {topic}"
    )
    assert [each.topic_type for each in found] == [kind]
    assert found[0].qos_profile.reliability == ReliabilityPolicy.RELIABLE
    assert found[0].qos_profile.durability == DurabilityPolicy.VOLATILE


@pytest.mark.parametrize(("topic", "kind"), SAID.items())
def test_topics_that_it_publishes_are_reliable(planning, topic, kind):
    node = planning.client.node
    found = planning.client.wait_until(
        lambda: node.get_publishers_info_by_topic(topic), f"a writer of {topic}"
    )
    assert {each.topic_type for each in found} == {kind}
    assert all(each.qos_profile.reliability == ReliabilityPolicy.RELIABLE for each in found)
    if topic == "/robot_description_semantic":
        durable = DurabilityPolicy.TRANSIENT_LOCAL
        assert all(each.qos_profile.durability == durable for each in found)


def test_the_srdf_reaches_a_late_client(planning, latched):
    heard = planning.client.subscribe(String, "/robot_description_semantic", latched)
    assert '<group name="arm">' in heard.wait_for(1)[0].data.replace("'", '"')


def test_planners_are_listed_alone_and_for_each_group(planning):
    found = planning.call("/query_planner_interface", QueryPlannerInterfaces.Request())
    ids = {each.pipeline_id: set(each.planner_ids) for each in found.planner_interfaces}
    assert {"arm", "RRTConnect", "arm[RRTConnect]"} <= ids["ompl"]
    assert {"PTP", "LIN", "CIRC"} <= ids["pilz_industrial_motion_planner"]


# plan_kinematic_path, in pymoveit2's way


def test_a_plan_leads_from_the_whole_joint_state_to_the_goal(
    planning, request_of, joint_goal, joints
):
    goal = joints(0.8, -0.4)
    request = request_of(joint_goal(goal), num_planning_attempts=5)
    planning.joint_states.clear()
    # pymoveit2 hands on the joint state as it is, is_diff false.
    request.start_state.joint_state = planning.joint_states.wait_for(1)[-1]
    request.start_state.is_diff = False
    response = planning.plan(request)
    assert response.error_code.val == SUCCESS, response.error_code.message
    assert response.group_name == "arm"
    trajectory = response.trajectory.joint_trajectory
    assert trajectory.header.frame_id == "world"
    assert list(trajectory.joint_names) == list(goal)
    assert list(trajectory.points[-1].positions) == pytest.approx(list(goal.values()), abs=2e-4)
    start = dict(
        zip(
            response.trajectory_start.joint_state.name,
            response.trajectory_start.joint_state.position,
            strict=True,
        )
    )
    begin = [start[name] for name in goal]
    assert list(trajectory.points[0].positions) == pytest.approx(begin, abs=1e-12)
    ends = [each.time_from_start for each in trajectory.points]
    times = [end.sec + end.nanosec * 1e-9 for end in ends]
    assert times[0] == 0.0
    assert all(a < b for a, b in itertools.pairwise(times))
    assert list(points(response)[-1].velocities) == pytest.approx([0.0] * 6, abs=1e-9)


def test_a_plan_leads_around_a_box_that_came_by_topic(
    planning, request_of, joint_goal, joints, box
):
    request = request_of(joint_goal(joints(0.9, -1.2)), start=joints(-0.9, -1.2))
    direct = planning.plan(request)
    assert direct.error_code.val == SUCCESS, direct.error_code.message
    at_half_way = fk(planning, joints(0.0, -1.2)).pose
    planning.publish("/collision_object", box("wall", place(at_half_way), (0.04, 0.04, 0.04)))
    planning.client.wait_until(
        lambda: [each.id for each in planning.scene().world.collision_objects] == ["wall"],
        "the box in the scene",
    )
    around = planning.plan(request)
    assert around.error_code.val == SUCCESS, around.error_code.message

    def valid(point: Any) -> bool:
        return planning.is_free(dict(zip(joints(), point.positions, strict=True)))

    assert not all(valid(point) for point in points(direct))
    assert all(valid(point) for point in points(around))


def test_a_plan_is_displayed(planning, request_of, joint_goal, joints):
    shown = planning.client.subscribe(DisplayTrajectory, "/display_planned_path")
    node = planning.client.node
    planning.client.wait_until(
        lambda: node.count_publishers("/display_planned_path"), "who displays plans"
    )
    planning.client.be_known_to_server("/plan_kinematic_path")
    response = planning.plan(request_of(joint_goal(joints(0.5)), start=joints()))
    assert response.error_code.val == SUCCESS, response.error_code.message
    assert shown.wait_for(1)[0].trajectory == [response.trajectory]


# States


def test_inverse_kinematics_undoes_forward_kinematics(planning, joints):
    wanted = fk(planning, joints(0.4, -0.6, -0.5, 0.3, 0.2, 0.1))
    request = GetPositionIK.Request()
    request.ik_request.group_name = "arm"
    request.ik_request.ik_link_name = "link6_flange"
    request.ik_request.pose_stamped = wanted
    request.ik_request.avoid_collisions = True
    answer = planning.call("/compute_ik", request)
    assert answer.error_code.val == SUCCESS, answer.error_code.message
    state = answer.solution.joint_state
    found = dict(zip(state.name, state.position, strict=True))
    assert "gripper_controller" in found
    reached = fk(planning, {name: found[name] for name in joints()})
    assert place(reached.pose) == pytest.approx(place(wanted.pose), abs=1e-4)
    cosine = sum(
        getattr(reached.pose.orientation, axis) * getattr(wanted.pose.orientation, axis)
        for axis in "xyzw"
    )
    assert abs(cosine) == pytest.approx(1.0, abs=1e-6)


def test_forward_kinematics_skips_an_unknown_link_and_says_so(planning):
    request = GetPositionFK.Request(fk_link_names=["link6_flange", "nonsense"])
    answer = planning.call("/compute_fk", request)
    assert answer.error_code.val == -18
    assert "nonsense" in answer.error_code.message
    assert list(answer.fk_link_names) == ["link6_flange"]


def test_a_pose_out_of_reach_has_no_inverse(planning):
    request = GetPositionIK.Request()
    request.ik_request.group_name = "arm"
    request.ik_request.pose_stamped.pose.position.x = 2.0
    answer = planning.call("/compute_ik", request)
    assert answer.error_code.val == -31
    assert answer.error_code.message


def test_validity_names_what_touches(planning, joints, box):
    request = GetStateValidity.Request(group_name="arm")
    set_state(request.robot_state, joints(0.0, -1.0))
    free = planning.call("/check_state_validity", request)
    assert free.valid
    assert not free.contacts
    centre = place(fk(planning, joints(0.0, -1.0)).pose)
    assert planning.apply_object(box("crate", centre, (0.02, 0.02, 0.02)))
    touching = planning.call("/check_state_validity", request)
    assert not touching.valid
    kinds = {
        (each.contact_body_1, each.body_type_1, each.contact_body_2, each.body_type_2)
        for each in touching.contacts
    }
    link, thing = ContactInformation.ROBOT_LINK, ContactInformation.WORLD_OBJECT
    assert ("link6_flange", link, "crate", thing) in kinds or (
        "crate",
        thing,
        "link6_flange",
        link,
    ) in kinds
    assert all(each.header.frame_id == "world" for each in touching.contacts)


def test_validity_evaluates_constraints(planning, joints, joint_goal):
    request = GetStateValidity.Request(group_name="arm")
    request.constraints = joint_goal({"link1_to_link2": 0.5})
    set_state(request.robot_state, joints(0.0))
    answer = planning.call("/check_state_validity", request)
    assert not answer.valid
    assert [each.result for each in answer.constraint_result] == [False]
    assert answer.constraint_result[0].distance == pytest.approx(0.5)
    set_state(request.robot_state, joints(0.5))
    assert planning.call("/check_state_validity", request).valid


# Straight paths

BENT = (0.0, -0.7, -1.0, 0.2, 0.0, 0.0)


def cartesian(joints: Any, *way_points: Any, **fields: Any) -> Any:
    given = {"group_name": "arm", "link_name": "link6_flange", "max_step": 0.005, **fields}
    request = GetCartesianPath.Request(waypoints=list(way_points), avoid_collisions=True, **given)
    set_state(request.start_state, joints(*BENT))
    return request


def test_a_straight_path_moves_the_link_straight(planning, joints):
    start = fk(planning, joints(*BENT)).pose
    end = fk(planning, joints(*BENT)).pose
    end.position.z -= 0.04
    answer = planning.call("/compute_cartesian_path", cartesian(joints, end))
    assert answer.error_code.val == SUCCESS, answer.error_code.message
    assert answer.fraction == pytest.approx(1.0)
    path = answer.solution.joint_trajectory.points
    assert list(path[0].positions) == pytest.approx(list(BENT))
    reached = [
        place(fk(planning, dict(zip(joints(), point.positions, strict=True))).pose)
        for point in path
    ]
    assert reached[-1] == pytest.approx(place(end), abs=1e-3)
    for x, y, _ in reached:
        assert (x, y) == pytest.approx((start.position.x, start.position.y), abs=1e-3)


def test_a_straight_path_ends_before_a_box_and_says_why(planning, joints, box):
    end = fk(planning, joints(*BENT)).pose
    end.position.z -= 0.08
    wall = box("floor", (end.position.x, end.position.y, end.position.z), (0.3, 0.3, 0.02))
    assert planning.apply_object(wall)
    answer = planning.call("/compute_cartesian_path", cartesian(joints, end))
    assert answer.error_code.val == SUCCESS
    assert 0.0 <= answer.fraction < 1.0
    assert "floor" in answer.error_code.message


def test_way_points_in_the_links_own_frame_are_relative_to_it(planning, joints):
    step = Pose()
    step.position.z = -0.02
    request = cartesian(joints, step)
    request.header.frame_id = "link6_flange"
    answer = planning.call("/compute_cartesian_path", request)
    assert answer.fraction == pytest.approx(1.0)
    last = answer.solution.joint_trajectory.points[-1].positions
    start = place(fk(planning, joints(*BENT)).pose)
    end = place(fk(planning, dict(zip(joints(), last, strict=True))).pose)
    assert math.dist(start, end) == pytest.approx(0.02, abs=1e-4)


# The scene


def test_the_whole_scene_goes_round_without_loss(planning, box):
    assert planning.apply_object(box("crate", (0.3, 0.1, 0.2), (0.1, 0.2, 0.3)))
    held = AttachedCollisionObject(link_name="link6_flange", touch_links=["gripper_base"])
    held.object = box("tool", (0.0, 0.0, 0.05), (0.01, 0.01, 0.01), "link6_flange")
    scene = PlanningScene(is_diff=True)
    scene.robot_state.is_diff = True
    scene.robot_state.attached_collision_objects = [held]
    assert planning.apply(scene)
    before = planning.scene()
    assert [each.id for each in before.world.collision_objects] == ["crate"]
    assert [each.object.id for each in before.robot_state.attached_collision_objects] == ["tool"]
    assert not before.is_diff
    assert planning.apply(before)
    after = planning.scene()
    for scene in (before, after):
        scene.robot_state.joint_state = type(scene.robot_state.joint_state)()
    # A held object's pose goes through the link's pose: the last bits of it may differ.
    poses = [
        scene.robot_state.attached_collision_objects[0].object.pose for scene in (before, after)
    ]
    assert place(poses[1]) == pytest.approx(place(poses[0]), abs=1e-9)
    assert poses[1].orientation.w == pytest.approx(poses[0].orientation.w, abs=1e-9)
    after.robot_state.attached_collision_objects[0].object.pose = poses[0]
    for field in before.get_fields_and_field_types():
        assert getattr(after, field) == getattr(before, field), field


def test_an_all_default_diff_changes_nothing(planning, box, request_of, joint_goal, joints):
    assert planning.apply_object(box("crate", (0.3, 0.1, 0.2), (0.1, 0.2, 0.3)))
    # pymoveit2's move_action goal has the default planning_options.
    request = request_of(joint_goal(joints(0.5)), start=joints())
    ended = planning.move(request, planning_scene_diff=PlanningScene(), plan_only=True)
    assert ended.result.error_code.val == SUCCESS, ended.result.error_code.message
    assert [each.id for each in planning.scene().world.collision_objects] == ["crate"]


def test_changes_are_published_on_the_monitored_scene(planning, box):
    heard = planning.client.subscribe(PlanningScene, "/monitored_planning_scene")
    planning.client.be_known_to_server("/apply_planning_scene")
    assert planning.apply_object(box("new_crate", (0.3, 0.1, 0.2), (0.1, 0.2, 0.3)))
    heard.wait_until(
        lambda scenes: any(
            each.id == "new_crate" for scene in scenes for each in scene.world.collision_objects
        ),
        "the new crate",
    )


def test_an_object_that_does_not_exist_is_not_removed(planning):
    unknown = CollisionObject(id="nonsense", operation=CollisionObject.REMOVE)
    assert not planning.apply_object(unknown)


# Requests that cannot be met: a code, a sentence, and never silence


@pytest.fixture
def ask_badly(planning, request_of, joint_goal, position_goal, joints, box):
    """Return a function that makes a bad request by its name."""
    good = joint_goal(joints(0.5))
    return {
        "unknown group": lambda: request_of(good, group_name="legs"),
        "unknown joint": lambda: request_of(joint_goal({"nonsense": 1.0})),
        "unknown link": lambda: request_of(position_goal(0.1, 0.1, 0.2, link="nonsense")),
        "unknown frame": lambda: request_of(position_goal(0.1, 0.1, 0.2, frame="nonsense")),
        "no goal": lambda: request_of(),
        "out of reach": lambda: request_of(position_goal(2.0, 0.0, 0.2)),
        "unknown pipeline": lambda: request_of(good, pipeline_id="nonsense"),
        "NaN start": lambda: request_of(good, start=joints(math.nan)),
        "start outside": lambda: request_of(good, start=joints(4.0)),
    }


@pytest.mark.parametrize(
    ("what", "code", "word"),
    [
        ("unknown group", -15, "'legs'"),
        ("unknown joint", -16, "'nonsense'"),
        ("unknown link", -18, "'nonsense'"),
        ("unknown frame", -21, "Unknown frame: nonsense"),
        ("no goal", -16, "goal"),
        ("out of reach", -31, "reach"),
        ("unknown pipeline", 99999, "'nonsense'"),
        ("NaN start", -17, "nan"),
        ("start outside", -26, "link1_to_link2"),
    ],
)
def test_a_bad_request_gets_a_code_and_a_sentence(planning, ask_badly, what, code, word):
    response = planning.plan(ask_badly[what]())
    assert not points(response)
    assert word in response.error_code.message
    assert response.error_code.val == code


def test_a_straight_path_with_a_bad_step_or_frame_is_refused(planning, joints):
    end = fk(planning, joints(*BENT)).pose
    for fields, word in (
        ({"max_step": 0.0}, "step"),
        ({"group_name": ""}, "arm"),
        ({"link_name": "nonsense"}, "'nonsense'"),
    ):
        answer = planning.call("/compute_cartesian_path", cartesian(joints, end, **fields))
        assert answer.error_code.val != SUCCESS
        assert word in answer.error_code.message
        assert not answer.solution.joint_trajectory.points
    request = cartesian(joints, end)
    request.header.frame_id = "nonsense"
    answer = planning.call("/compute_cartesian_path", request)
    assert answer.error_code.val == -21
    assert "Unknown frame: nonsense" in answer.error_code.message


def test_forty_requests_at_once_are_all_answered(planning):
    client, name = planning.client, "/check_state_validity"
    # With the usual ten, the client itself loses answers.
    service = client.node.create_client(GetStateValidity, name, qos_profile=QoSProfile(depth=100))
    client.wait_until(service.service_is_ready, name)
    client.be_known_to_server(name)
    request = GetStateValidity.Request(group_name="arm")
    request.robot_state.is_diff = True
    answers = client.run(lambda: [service.call_async(request) for _ in range(40)], name)
    client.wait_until(lambda: all(answer.done() for answer in answers), "forty answers")
    assert len({answer.result().valid for answer in answers}) == 1


def test_a_planners_parameters_are_set_and_told(planning):
    which = {"pipeline_id": "ompl", "planner_config": "RRTConnectkConfigDefault", "group": "arm"}
    given = PlannerParams(keys=["range"], values=["1.5"])
    planning.call("/set_planner_params", SetPlannerParams.Request(params=given, **which))
    told = planning.call("/get_planner_params", GetPlannerParams.Request(**which)).params
    assert (told.keys, told.values) == (["range"], ["1.5"])
