"""The table of what MuJoCo changed: each line as it is in the MuJoCo of these tests."""

import re
from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np
import pytest

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "mujoco.md"
LINE = re.compile(r"^\| [0-9.]+ \| \*\*(.+?)\*\*", re.MULTILINE)
TWO_JOINTS = """<worldbody><body><joint name="j" damping="1"/><geom size=".1" pos=".5 0 0"/>
<body pos=".5 0 0"><joint name="k"/><geom size=".1"/></body></body></worldbody>"""
BOX_ON_FLOOR = """<worldbody><geom type="plane" size="1 1 1" margin="{}"/><body pos="0 0 .3">
<freejoint/><geom type="box" size=".1 .1 .1" {}/></body></worldbody>"""


def model(inside: str) -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(f"<mujoco>{inside}</mujoco>")


def after(inside: str, steps: int) -> mujoco.MjData:
    """Return the state after some steps, or the derived quantities at the start."""
    data = mujoco.MjData(model(inside))
    if steps:
        mujoco.mj_step(data.model, data, steps)
    mujoco.mj_forward(data.model, data)
    return data


def refused(inside: str) -> None:
    with pytest.raises(ValueError, match=r"Schema violation|at least 2|is repeated"):
        model(inside)


def margins_are_added() -> None:
    assert after(BOX_ON_FLOOR.format(0.03, 'margin=".05"'), 1500).qpos[2] == pytest.approx(
        0.18, abs=1e-3
    )


def saturated_actuators_do_not_damp() -> None:
    for joint, actuator in (("", 'forcerange="-1 1"'), ('actuatorfrcrange="-1 1"', "")):
        data = mujoco.MjData(
            model(
                '<option gravity="0 0 0" integrator="implicitfast"/><worldbody><body>'
                f'<joint name="j" axis="0 0 1" {joint}/><geom size=".02" mass=".01" pos=".05 0 0"/>'
                f'</body></worldbody><actuator><position joint="j" kp="1000" kv="100" {actuator}/>'
                "</actuator>"
            )
        )
        data.qvel[0] = 1.0
        assert data.model.dof_M0[0] == pytest.approx(2.66e-5, rel=0.01)
        mujoco.mj_step(data.model, data)
        assert data.qvel[0] == pytest.approx(-74.2, abs=0.1)


def several_contact_points() -> None:
    corners = " ".join(f"{x} {y} {z}" for x in (-1, 1) for y in (-1, 1) for z in (-1, 1))
    data = after(
        f'<asset><mesh name="c" vertex="{corners}" scale=".1 .1 .1"/></asset><worldbody>'
        '<geom type="box" size="1 1 1" pos="0 0 -1"/><body pos="0 0 .099"><freejoint/>'
        '<geom type="mesh" mesh="c"/></body></worldbody>',
        0,
    )
    assert data.ncon == 4


def force_begins_at_the_margin() -> None:
    height = after(BOX_ON_FLOOR.format(0, 'margin=".05" gap=".05"'), 1500).qpos[2]
    assert height == pytest.approx(0.15, abs=1e-3)


def several_controls() -> None:
    pid = '<actuator><pid name="p" joint="k" kp="1" kv="1"/><motor name="m" joint="j"/></actuator>'
    one = model(TWO_JOINTS + pid)
    assert (one.nactuator, one.nu, one.actuator_ctrladr.tolist()) == (2, 3, [0, 2])
    assert mujoco.MjData(one).actuator("p").ctrl.shape == (2,)


def mocap_bodies_are_not_static() -> None:
    one = model('<worldbody><body mocap="true"><geom size=".1"/></body></worldbody>')
    assert one.body_weldid.tolist() == [0, 1]


def force_and_torque_sensors() -> None:
    hanging = after(
        '<worldbody><site name="u" pos="0 0 2"/><body pos="0 0 1"><joint type="slide" axis="0 0 1"'
        ' damping="5"/><geom size=".1" mass="1"/><body><geom size=".05" mass=".5"/><site name="s"/>'
        '</body></body></worldbody><tendon><spatial stiffness="100" springlength=".5">'
        '<site site="u"/><site site="s"/></spatial></tendon><sensor><force site="s"/></sensor>',
        2000,
    )
    assert hanging.sensordata[2] == pytest.approx(-9.8, abs=0.1)


def dampratio() -> None:
    servo = '<actuator><position joint="k" kp="10" dampratio="1"/></actuator>'
    assert model(TWO_JOINTS + servo).actuator_biasprm[0, 2] == pytest.approx(-0.815, abs=5e-4)


def height_fields_of_one_row() -> None:
    refused(
        '<asset><hfield name="h" nrow="1" ncol="4" size="1 1 1 1"/></asset><worldbody>'
        '<geom type="hfield" hfield="h"/></worldbody>'
    )
    twice = '<joint joint="j" coef="1"/>' * 2
    refused(f"{TWO_JOINTS}<tendon><fixed>{twice}</fixed></tendon>")


def side_sites_of_tendons() -> None:
    data = after(
        '<worldbody><site name="a" pos="-.6 0 -.2"/><site name="b" pos=".3 0 -.6"/>'
        '<geom name="g" type="cylinder" size=".5 1" euler="90 0 0"/><site name="s" pos="0 0 .6"/>'
        '</worldbody><tendon><spatial><site site="a"/><geom geom="g" sidesite="s"/><site site="b"/>'
        "</spatial></tendon>",
        0,
    )
    assert data.ten_length == pytest.approx(np.array([2.43]), abs=0.01)


TRIED: dict[str, Callable[[], None]] = {
    "option flag passive": lambda: refused('<option><flag passive="disable"/></option>'),
    "margins are added": margins_are_added,
    "orthographic cameras": lambda: refused('<worldbody><camera orthographic="true"/></worldbody>'),
    "saturated actuators do not damp": saturated_actuators_do_not_damp,
    "several contact points": several_contact_points,
    "force begins at the margin": force_begins_at_the_margin,
    "several controls for one actuator": several_controls,
    "mocap bodies are not static": mocap_bodies_are_not_static,
    "force and torque sensors": force_and_torque_sensors,
    "dampratio": dampratio,
    "composite is gone": lambda: refused(
        '<worldbody><body><composite type="cable" count="5 1 1"/></body></worldbody>'
    ),
    "height fields of one row": height_fields_of_one_row,
    "side sites of tendons": side_sites_of_tendons,
}


@pytest.mark.parametrize("line", LINE.findall(PAGE.read_text()))
def test_a_line_of_the_table_holds(line):
    assert_line_holds = TRIED[line]
    assert_line_holds()


def test_every_trial_has_its_line():
    assert set(LINE.findall(PAGE.read_text())) == set(TRIED)
