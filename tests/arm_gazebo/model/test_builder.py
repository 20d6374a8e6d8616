import math

import mujoco
import numpy as np
import pytest

from arm_description.kinematics.forward import forward_kinematics
from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Pose
from arm_gazebo.errors import ModelError
from arm_gazebo.sensors.camera import CameraSensor

BOX = '<geometry><box size="0.2 0.1 0.4"/></geometry>'
CUBE = '<geometry><box size="0.1 0.1 0.1"/></geometry>'
STROKE = 'lower="0" upper="5e-5" effort="5" velocity="0.01"'


def state(built):
    data = mujoco.MjData(built.model)
    data.qpos[:] = built.qpos
    mujoco.mj_forward(built.model, data)
    return data


def warnings(built):
    return [str(finding) for finding in built.report.warnings]


def shaped(name, *shapes, mass=1.0):
    inertial = (
        f'<inertial><mass value="{mass}"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" '
        'ixz="0" iyz="0"/></inertial>'
    )
    return f'<link name="{name}">{inertial}{"".join(shapes)}</link>'


def test_every_link_is_a_body_at_its_kinematic_pose(parts):
    urdf = parts.arm(j0_pos="0.3", j1_pos="0.5", j2_pos="-0.4", j3_pos="1.0")
    built = parts.build(urdf)
    data = state(built)
    expected = forward_kinematics(parse_urdf(urdf), {"j0": 0.3, "j1": 0.5, "j2": -0.4, "j3": 1.0})
    for name, body in built.bodies.items():
        assert data.xpos[body] == pytest.approx(expected[name][:3, 3], abs=1e-9), name
        assert data.xmat[body] == pytest.approx(expected[name][:3, :3].ravel(), abs=1e-9), name


def test_arm_of_this_project_is_built_without_a_remark(parts):
    assert parts.build(parts.arm()).report.findings == ()


def test_fixed_links_keep_their_bodies(parts):
    assert {"camera_link", "camera_optical_frame", "dyn5_r"} <= set(parts.build(parts.arm()).bodies)


@pytest.mark.parametrize(
    ("kind", "types"),
    [
        ("revolute", ["HINGE"]),
        ("continuous", ["HINGE"]),
        ("prismatic", ["SLIDE"]),
        ("fixed", []),
        ("planar", []),
        ("floating", ["SLIDE", "SLIDE", "SLIDE", "BALL"]),
    ],
)
def test_joint_types(parts, kind, types):
    urdf = parts.robot(parts.link("base"), parts.link("l", 1), parts.joint("j", "base", "l", kind))
    model = parts.build(urdf).model
    assert [mujoco.mjtJoint(kind).name.removeprefix("mjJNT_") for kind in model.jnt_type] == types


def test_floating_child_of_the_world_is_free(parts):
    urdf = parts.robot(
        parts.link("world"),
        parts.link("l", 1),
        parts.joint("j", "world", "l", "floating", "1 2 3", limit=""),
    )
    model = parts.build(urdf).model
    assert model.jnt_type.tolist() == [mujoco.mjtJoint.mjJNT_FREE]
    assert model.qpos0[:3].tolist() == [1, 2, 3]


def test_a_planar_joint_is_fixed_as_in_tf_and_reported(parts):
    urdf = parts.robot(
        parts.link("odom"),
        parts.link("base"),
        parts.link("arm", 1),
        parts.joint("slide", "odom", "base", "planar", "0 0 0.2"),
        parts.joint("j", "base", "arm"),
    )
    built = parts.build(urdf)
    assert built.model.njnt == 1
    assert state(built).xpos[built.bodies["base"]].tolist() == [0, 0, 0.2]
    assert warnings(built) == [
        "joint 'slide' (line 1): a planar joint can be neither commanded nor observed; link "
        "'base' is fixed to 'odom'"
    ]


@pytest.mark.parametrize("taken", ["base_x", "base_rotation"])
def test_joints_made_of_one_leave_the_others_their_names(parts, taken):
    urdf = parts.robot(
        parts.link("base"),
        parts.link("l", 1),
        parts.link("m", 1),
        parts.joint("base", "base", "l", "floating", limit=""),
        parts.joint(taken, "l", "m"),
    )
    built = parts.build(urdf, base="free")
    assert [*built.joints] == [taken]
    assert built.model.joint(taken).bodyid == built.bodies["m"]


def test_free_root_leaves_the_joints_their_names(parts):
    urdf = parts.robot(
        parts.link("base", 1), parts.link("l", 1), parts.joint("base_free", "base", "l")
    )
    built = parts.build(urdf, base="free")
    assert [*built.joints] == ["base_free"]
    assert built.model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE


def test_link_called_world_below_the_root_is_one_like_the_others(parts):
    urdf = parts.robot(
        parts.link("map"),
        parts.link("world"),
        parts.link("base", 1),
        parts.joint("place", "map", "world", "fixed", "1 0 0"),
        parts.joint("lift", "world", "base", "floating", "0 2 0", limit=""),
    )
    built = parts.build(urdf, spawn=Pose((0.0, 0.0, 3.0)), self_collide=True)
    data = mujoco.MjData(built.model)
    mujoco.mj_kinematics(built.model, data)
    assert data.xpos[built.bodies["world"]] == pytest.approx([1, 0, 3])
    assert data.xpos[built.bodies["base"]] == pytest.approx([1, 2, 3])


def test_limits_and_dynamics_are_kept(parts):
    limit = 'lower="-0.5" upper="1.5" effort="7" velocity="2"'
    urdf = parts.pendulum('<dynamics damping="0.4" friction="0.3"/>', limit)
    built = parts.build(urdf)
    assert built.model.jnt_range[0] == pytest.approx([-0.5, 1.5])
    assert built.model.actuator_forcerange[0].tolist() == [-7, 7]
    assert built.model.dof_damping[0] == 0.4
    assert built.model.dof_frictionloss[0] == 0.3
    assert built.joints["j"].velocity == 2


def test_limits_that_leave_no_room_lock_the_joint(parts):
    built = parts.build(parts.pendulum(limit='lower="0" upper="0" effort="7" velocity="2"'))
    assert "leave it no room to move" in warnings(built)[0]
    assert np.ptp(built.model.jnt_range[0]) < 1e-3


def test_short_stroke_is_kept_and_run_through(bench, parts):
    stage = parts.robot(
        parts.link("base"),
        parts.link("stage", 0.1),
        parts.joint("j", "base", "stage", "prismatic", limit=STROKE),
        parts.ros2_control(["j"]),
    )
    piezo = bench(stage)
    assert warnings(piezo.built) == []
    assert piezo.built.model.jnt_range[0] == pytest.approx([0.0, 5e-5], abs=0.0)
    piezo.claim()
    piezo.command(4e-5)
    assert piezo.run(0.5)[-1] == pytest.approx([4e-5], abs=1e-6)


def test_zero_effort_and_velocity_limits_are_taken_for_missing(parts):
    built = parts.build(parts.pendulum(limit='lower="-1" upper="1" effort="0" velocity="0"'))
    assert not built.model.actuator_forcelimited[0]
    assert built.joints["j"].velocity == 3
    assert built.joints["j"].velocity_limit == math.inf
    said = "no velocity limit; it moves to positions at up to 3 rad/s"
    assert any(said in warning for warning in warnings(built))
    assert any("no effort limit" in warning for warning in warnings(built))


def test_an_initial_value_outside_the_limits_is_clamped_and_reported(parts):
    urdf = parts.pendulum(limit='lower="-2" upper="-0.5" effort="7" velocity="2"')
    built = parts.build(urdf)
    assert built.qpos[0] == -0.5
    assert "its zero of 0 is outside its limits of -2 and -0.5" in warnings(built)[0]


@pytest.mark.parametrize(
    ("soft", "start"),
    [
        ("soft_lower_limit='-2' soft_upper_limit='-0.15'", -0.15),
        ("soft_lower_limit='0.3'", 0.3),
        ("soft_lower_limit='-1' soft_upper_limit='1'", 0.0),
        ("soft_lower_limit='5' soft_upper_limit='6'", 0.0),
    ],
)
def test_a_joint_starts_within_its_soft_limits(parts, soft, start):
    safety = f"<safety_controller k_velocity='1' {soft}/></joint>"
    urdf = parts.pendulum().replace("</joint>", safety, 1)
    built = parts.build(urdf)
    assert built.qpos[0] == start
    said = f"0 is outside its soft limits of -2 and -0.15; it starts at {start:g}"
    assert any(said in str(finding) for finding in built.report.findings) == (start == -0.15)


def test_an_initial_value_outside_the_soft_limits_is_kept(parts):
    safety = "<safety_controller k_velocity='1' soft_lower_limit='0.3'/></joint>"
    urdf = parts.pendulum().replace("</joint>", safety, 1)
    interface = '<state_interface name="position">'
    kept = urdf.replace(interface, f'{interface}<param name="initial_value">0.1</param>')
    assert kept != urdf
    assert parts.build(kept).qpos[0] == 0.1


def test_an_unknown_hardware_joint_is_left_out_and_reported(parts):
    urdf = parts.pendulum().replace(
        "</ros2_control>",
        '<joint name="ghost"><command_interface name="position"/></joint></ros2_control>',
    )
    assert "no such joint, it has j" in warnings(parts.build(urdf))[0]


def test_two_components_cannot_command_one_joint(parts):
    other = parts.ros2_control(["j"]).replace('"sim"', '"other"')
    urdf = parts.pendulum().replace("</robot>", f"{other}</robot>")
    with pytest.raises(
        ModelError, match="joint 'j' is commanded by the components 'sim' and 'other'"
    ):
        parts.build(urdf)


def test_joint_without_hardware_swings_freely(parts):
    urdf = parts.robot(
        parts.link("base"),
        parts.link("l", 1, 0.1, "0.3 0 0"),
        parts.joint("j", "base", "l", xyz="0 0 1"),
    )
    built = parts.build(urdf)
    assert built.model.nu == 0
    assert built.joints["j"].actuator is None


def test_visuals_are_seen_and_not_touched(parts):
    model = parts.build(
        parts.robot(shaped("base", f"<visual>{BOX}</visual>", f"<collision>{CUBE}</collision>"))
    ).model
    visual, collision = model.ngeom - 2, model.ngeom - 1
    assert model.geom_size[visual] == pytest.approx([0.1, 0.05, 0.2])
    assert (model.geom_contype[visual], model.geom_conaffinity[visual]) == (0, 0)
    assert model.geom_group[visual] == 2
    assert model.geom_contype[collision]
    assert model.geom_group[collision] == 3


def test_colour_stays_with_its_own_visual(parts):
    red = f'<visual>{BOX}<material name=""><color rgba="1 0 0 1"/></material></visual>'
    model = parts.build(parts.robot(shaped("base", red, f"<visual>{BOX}</visual>"))).model
    assert model.geom_rgba[-2].tolist() == [1, 0, 0, 1]
    assert model.geom_rgba[-1] == pytest.approx([0.7, 0.7, 0.7, 1])


@pytest.mark.parametrize(
    ("shape", "kind", "size"),
    [
        ('<cylinder radius="0.1" length="0.6"/>', "CYLINDER", [0.1, 0.3]),
        ('<sphere radius="0.2"/>', "SPHERE", [0.2]),
        ('<capsule radius="0.1" length="0.6"/>', "CAPSULE", [0.1, 0.3]),
        ('<box size="0 0.2 0.2"/>', "BOX", [1e-6, 0.1, 0.1]),
    ],
)
def test_primitive_shapes(parts, shape, kind, size):
    link = shaped("base", f"<collision><geometry>{shape}</geometry></collision>")
    model = parts.build(parts.robot(link)).model
    assert mujoco.mjtGeom(model.geom_type[-1]).name == f"mjGEOM_{kind}"
    assert model.geom_size[-1][: len(size)] == pytest.approx(size)


def two_overlapping_links(parts):
    cube = f"<collision>{CUBE}</collision>"
    return parts.robot(
        shaped("base", cube),
        shaped("near", cube),
        shaped("far", cube),
        parts.joint("j", "base", "near", xyz="0 0 0.08"),
        parts.joint("k", "near", "far", xyz="0 0.02 -0.06"),
    )


def contacts_within_the_robot(built):
    data = state(built)
    robot = set(built.bodies.values())
    return [
        tuple(built.model.body(built.model.geom_bodyid[geom]).name for geom in contact.geom)
        for contact in data.contact[: data.ncon]
        if all(built.model.geom_bodyid[geom] in robot for geom in contact.geom)
    ]


def test_robot_does_not_touch_itself_by_default(parts):
    assert contacts_within_the_robot(parts.build(two_overlapping_links(parts))) == []


def test_self_collision_spares_what_overlaps_from_the_start(parts):
    built = parts.build(two_overlapping_links(parts), self_collide=True)
    assert contacts_within_the_robot(built) == []
    assert "links 'base' and 'far'" in warnings(built)[0]


def test_links_apart_touch_each_other_with_self_collide(parts):
    cube = f"<collision>{CUBE}</collision>"
    urdf = parts.robot(
        shaped("base", cube),
        shaped("middle"),
        shaped("end", cube),
        parts.joint("j", "base", "middle", "prismatic", "0 0 0.5", "0 0 1"),
        parts.joint("k", "middle", "end", "prismatic", axis="1 0 0"),
    )
    built = parts.build(urdf, self_collide=True)
    data = mujoco.MjData(built.model)
    data.qpos[0] = -0.45
    mujoco.mj_forward(built.model, data)
    assert data.ncon > 0


def test_robot_touches_the_floor(parts):
    urdf = parts.robot(
        parts.link("base"),
        shaped("l", f"<collision>{CUBE}</collision>"),
        parts.joint("j", "base", "l", "prismatic", axis="0 0 1"),
    )
    assert state(parts.build(urdf)).ncon > 0


def test_root_link_is_bolted_down_by_default(parts):
    model = parts.build(parts.robot(shaped("base"))).model
    assert model.nv == 0


def test_spawn_pose_moves_the_robot(parts):
    built = parts.build(parts.arm(), spawn=Pose((1.0, 2.0, 0.5), (0.0, 0.0, math.pi / 2)))
    position = state(built).xpos[built.bodies["base_link"]]
    assert position == pytest.approx([1.0, 2.0, 0.5313], abs=1e-4)


def test_free_robot_is_stood_on_the_floor(parts):
    built = parts.build(parts.arm(base="free"), base="free")
    assert built.qpos[2] == pytest.approx(0.0313, abs=2e-4)
    assert built.report.warnings == ()
    spawn = Pose((1.0, 2.0, 0.0))
    placed = parts.build(parts.arm(base="free"), base="free", spawn=spawn, on_floor=True)
    assert placed.qpos[:3] == pytest.approx([1.0, 2.0, built.qpos[2]])


def test_free_robot_that_leans_too_far_is_reported(parts):
    urdf = parts.arm(base="free", j1_pos="0.5", j2_pos="0.5", j3_pos="1.0")
    built = parts.build(urdf, base="free")
    assert "outside its feet: the robot will topple" in warnings(built)[0]


def test_free_robot_with_a_world_link_stays_fixed(parts):
    assert parts.build(parts.arm(), base="free").model.nv == 4


def test_camera_looks_along_x_of_its_link(parts):
    urdf = parts.robot(shaped("base"))
    sensor = CameraSensor("eye", "base", "base", 320, 240, 1.0, xyz=(0.1, 0, 0), near=0.05, far=40)
    built = parts.build(urdf, cameras=[sensor])
    camera = built.model.camera("eye").id
    data = state(built)
    right, up, back = data.cam_xmat[camera].reshape(3, 3).T
    assert back == pytest.approx([-1, 0, 0], abs=1e-12)
    assert up == pytest.approx([0, 0, 1], abs=1e-12)
    assert right == pytest.approx([0, -1, 0], abs=1e-12)
    assert data.cam_xpos[camera] == pytest.approx([0.1, 0, 0])
    half_height = math.tan(math.radians(built.model.cam_fovy[camera]) / 2)
    assert half_height == pytest.approx(math.tan(0.5) * 240 / 320)


def test_clip_planes_open_as_far_as_the_cameras_look(parts):
    sensor = CameraSensor("eye", "base", "base", near=0.05, far=400.0)
    model = parts.build(parts.robot(shaped("base")), cameras=[sensor]).model
    assert model.vis.map.znear * model.stat.extent == pytest.approx(0.05)
    assert model.vis.map.zfar * model.stat.extent == pytest.approx(400.0)


def test_buffer_takes_the_largest_camera(parts):
    sensor = CameraSensor("eye", "base", "base", width=1920, height=1080)
    model = parts.build(parts.robot(shaped("base")), cameras=[sensor]).model
    assert (model.vis.global_.offwidth, model.vis.global_.offheight) == (1920, 1080)
    assert model.vis.quality.offsamples == 0


def test_camera_on_a_link_that_does_not_exist_is_refused(parts):
    sensor = CameraSensor("eye", "head", "head")
    with pytest.raises(ModelError, match=r"camera 'eye' is on link 'head', .* the robot has base"):
        parts.build(parts.robot(shaped("base")), cameras=[sensor])


def test_physics_takes_stiff_drives(parts):
    model = parts.build(parts.arm(), step_s=0.001).model
    assert model.opt.timestep == 0.001
    assert model.opt.integrator == mujoco.mjtIntegrator.mjINT_IMPLICITFAST


def chain(parts, kind, count):
    """Return a URDF of links without mass, each joined to the one before; the first one moves."""
    links, joints = [parts.link("l0"), parts.link("l1")], [parts.joint("j1", "l0", "l1")]
    for index in range(2, count + 1):
        links.append(parts.link(f"l{index}"))
        joints.append(parts.joint(f"j{index}", f"l{index - 1}", f"l{index}", kind))
    return parts.robot(*links, *joints)


def test_a_thousand_links_without_mass_may_hang_below_each_other(parts):
    built = parts.build(chain(parts, "fixed", 1000))
    assert built.bodies["l1000"] == 1001
    assert "it moves but has no mass" in str(built.report.findings[0])


def test_link_chains_deeper_than_mujoco_supports_are_refused(parts):
    with pytest.raises(ModelError, match=r"'l1001' is more than 1000 joints below 'l0'"):
        parts.build(chain(parts, "fixed", 1001))


def test_more_joints_than_can_be_driven_are_refused(parts):
    with pytest.raises(ModelError, match="has 1001 joints that move; at most 1000 are simulated"):
        parts.build(chain(parts, "revolute", 1001))
