"""Reports about robots that start below the floor, inside an object or inside themselves."""

import numpy as np
import pytest

from arm_description.urdf.robot import Pose


def box(parts, name, size="0.2 0.2 0.2", xyz="0 0 0"):
    return parts.link(name, 1.0, 0.1).replace(
        "</link>",
        f'<collision><origin xyz="{xyz}"/><geometry><box size="{size}"/></geometry></collision>'
        "</link>",
    )


@pytest.fixture
def arm(parts):
    """Return a maker of a robot whose hand is a box, at a height, and of what is said of it."""

    def build(height, base=0.5, more="", base_="fixed", **options):
        urdf = parts.robot(
            box(parts, "base", xyz=f"0 0 {base}"),
            box(parts, "hand"),
            parts.joint("j", "base", "hand", xyz=f"1 0 {height}"),
            more,
            parts.ros2_control(["j"]),
        )
        return parts.build(urdf, base=base_, **options).report.findings

    return build


def test_a_robot_above_the_floor_has_nothing_to_hear(arm):
    assert arm(0.1) == ()


def test_a_moving_link_below_the_floor_is_a_warning_with_its_depth(arm):
    [finding] = arm(0.07)
    assert finding.outcome.value == "warning"
    assert str(finding) == (
        "link 'hand': below the floor by 30 mm, and pushed out with force; base:=free lets the "
        "robot stand on the floor, and pose:= raises it"
    )


def test_of_many_links_below_the_floor_the_first_are_named(arm, parts):
    legs = [f"leg{n}" for n in range(4)]
    more = "".join(
        box(parts, leg) + parts.joint(f"hip_{leg}", "base", leg, xyz=f"0 {n + 1} {-0.1 * n}")
        for n, leg in enumerate(legs)
    )
    finding = next(each for each in arm(0.07, more=more) if "below the floor" in str(each))
    said = "links 'hand', 'leg0', 'leg1' and 2 more: below the floor by up to 400 mm, and pushed"
    assert str(finding).startswith(said)


def test_a_bolted_link_below_the_floor_is_a_note(arm):
    [finding] = arm(0.5, base=0.05)
    assert finding.outcome.value == "note"
    assert "link 'base': below the floor by 50 mm; bolted down, so nothing pushes" in str(finding)


def test_a_free_robot_that_is_spawned_too_low_is_reported(arm):
    findings = arm(0.13, base=0.1, base_="free", spawn=Pose((0.0, 0.0, -0.05)))
    said = "links 'base' and 'hand': below the floor by 50 mm, 20 mm, and pushed out with force"
    assert said in map(str, findings)


def test_a_link_inside_an_object_of_the_world_is_reported(arm, tmp_path):
    world = tmp_path / "lab.xml"
    world.write_text(
        "<mujoco><worldbody><body name='crate' pos='1 0 1'><geom type='box' size='.1 .1 .1'/>"
        "</body></worldbody></mujoco>"
    )
    [finding] = arm(1.15, world=world)
    assert "link 'hand': it starts 50 mm inside 'crate'" in str(finding)


@pytest.mark.parametrize(("self_collide", "outcome"), [(False, "note"), (True, "warning")])
def test_links_inside_each_other_are_reported_with_the_depth(arm, parts, self_collide, outcome):
    more = box(parts, "tool") + parts.joint("k", "hand", "far", xyz="0 0 0.5")
    more += parts.link("far", 0.1) + parts.joint("l", "far", "tool", xyz="0 0 -0.32")
    [finding] = [f for f in arm(1.0, more=more, self_collide=self_collide) if "overlap" in str(f)]
    assert finding.outcome.value == outcome
    assert "links 'hand' and 'tool': they overlap by 20 mm" in str(finding)


def test_links_whose_shapes_overlap_in_both_orders_are_reported_once(arm, parts):
    def shapes(name):
        ball = '<collision><geometry><sphere radius="0.12"/></geometry></collision></link>'
        return box(parts, name).replace("</link>", ball)

    more = shapes("grip") + parts.link("far", 0.1) + shapes("tool")
    more += parts.joint("k", "hand", "grip", xyz="0 0 0.5") + parts.joint("l", "grip", "far")
    more += parts.joint("m", "far", "tool", xyz="0 0 0.18")
    [finding] = [f for f in arm(1.0, more=more) if "overlap" in str(f)]
    assert "links 'grip' and 'tool': they overlap by " in str(finding)


def test_looking_changes_nothing(parts):
    urdf = parts.robot(
        box(parts, "base"),
        box(parts, "hand"),
        parts.joint("j", "base", "hand", xyz="1 0 1"),
        parts.ros2_control(["j"]),
    )
    model = parts.build(urdf).model
    assert set(model.geom_contype) == {1, 2}
    assert np.count_nonzero(model.geom_conaffinity) == 3
