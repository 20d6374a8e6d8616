import numpy as np
import pytest


@pytest.fixture
def chain(parts):
    """Three sliders: b = 2 a + 0.01, c = -1 b + 0.1; a is commanded."""
    free = 'lower="-1" upper="1" effort="50" velocity="1"'

    def make(limit_b=free):
        return parts.robot(
            parts.link("base"),
            *(parts.link(name, 0.2) for name in ("la", "lb", "lc")),
            parts.joint(
                "c",
                "base",
                "lc",
                "prismatic",
                "0 2 1",
                limit=free,
                more='<mimic joint="b" multiplier="-1" offset="0.1"/>',
            ),
            parts.joint(
                "b",
                "base",
                "lb",
                "prismatic",
                "0 1 1",
                limit=limit_b,
                more='<mimic joint="a" multiplier="2" offset="0.01"/>',
            ),
            parts.joint(
                "a",
                "base",
                "la",
                "prismatic",
                "0 0 1",
                limit='lower="-0.2" upper="0.2" effort="50" velocity="1"',
            ),
            parts.ros2_control(["a"]),
        )

    return make


def position(bench, name):
    return bench.simulation.data.qpos[bench.built.joints[name].qpos_address]


def test_chain_is_resolved_to_the_joint_that_moves(bench, chain):
    run = bench(chain())
    run.claim()
    run.command(0.1)
    run.run(1.0)
    assert position(run, "b") == pytest.approx(0.21, abs=1e-3)
    assert position(run, "c") == pytest.approx(-0.11, abs=1e-3)


def test_followers_keep_up_in_motion(bench, chain):
    run = bench(chain())
    run.claim()
    run.command(0.2)
    lag = []
    for _ in range(50):
        run.tick()
        lag.append(position(run, "b") - 2 * position(run, "a") - 0.01)
    assert np.abs(lag).max() < 2e-3


def test_followers_start_where_the_leader_puts_them(bench, chain):
    run = bench(chain())
    assert position(run, "b") == pytest.approx(0.01)
    assert position(run, "c") == pytest.approx(0.09)


def test_follower_driven_past_its_limit_loses_the_limit(parts, chain):
    built = parts.build(chain('lower="0" upper="0.1" effort="50" velocity="1"'))
    [warning] = [str(finding) for finding in built.report.warnings]
    assert "'a' drives it from -0.39 to 0.41, past its own limits of 0 and 0.1" in warning
    assert not built.model.jnt_limited[built.model.joint("b").id]


def test_command_interface_on_a_follower_is_left_out(parts, chain):
    urdf = chain()
    block = parts.ros2_control(["b"]).replace('"sim"', '"other"')
    built = parts.build(urdf.replace("</robot>", f"{block}</robot>"))
    assert "it mimics 'a' and cannot be commanded" in str(built.report.warnings[0])
    assert built.model.nu == 1


def released(parts, urdf, *names):
    """Return the URDF with a second component that commands these followers by themselves."""
    block = parts.ros2_control(names).replace('"sim"', '"other"')
    block = block.replace("<joint ", '<joint mimic="false" ')
    return urdf.replace("</robot>", f"{block}</robot>")


def test_mimic_false_in_the_hardware_makes_a_follower_independent(bench, parts, chain):
    joints = parts.ros2_control(["a"])
    own = parts.ros2_control(["a", "b"]).replace('name="b"', 'name="b" mimic="false"')
    run = bench(chain().replace(joints, own))
    assert position(run, "b") == 0.0
    run.claim()
    run.command(0.1, -0.3)
    run.run(1.0)
    assert position(run, "a") == pytest.approx(0.1, abs=1e-3)
    assert position(run, "b") == pytest.approx(-0.3, abs=1e-3)
    # What follows it follows it still, not what it followed.
    assert position(run, "c") == pytest.approx(0.4, abs=1e-3)


def test_a_released_joint_starts_at_its_own_initial_value_within_its_limits(parts, chain):
    urdf = chain('lower="0.2" upper="1" effort="50" velocity="1"')
    built = parts.build(released(parts, urdf, "b"))
    assert built.joints["b"].initial == pytest.approx(0.2)
    assert built.joints["c"].initial == pytest.approx(-0.1)


def test_rigid_body_cannot_mimic(parts):
    urdf = parts.robot(
        parts.link("base"),
        parts.link("l", 1),
        parts.link("m", 1),
        parts.joint("a", "base", "l"),
        parts.joint("b", "base", "m", "floating", more='<mimic joint="a"/>'),
    )
    built = parts.build(urdf)
    assert "only joints with one degree of freedom can" in str(built.report.warnings[0])
