"""The pytest plugin, in pytest runs of its own."""

import re
from pathlib import Path

import cv2
import pytest
from run_python import run_python

# Each run within this process forgets the modules that it was the first to import, and native ones
# cannot be imported twice: they are all imported here.
from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile
from arm_sim.bench import joint_plot, simulation
from arm_sim.simulation import Simulation

PLUGIN_ALONE = """
import sys
import arm_sim.pytest_plugin
heavy = {"numpy", "mujoco", "cv2", "rclpy", "arm_sim.simulation", "arm_control"} & set(sys.modules)
print(sorted(heavy))
"""

LIGHT_ARM = """
import pytest
pytestmark = pytest.mark.arm_sim(arguments={"camera": "none"})
"""


@pytest.fixture(autouse=True, scope="module")
def _import_everything():
    assert joint_plot
    assert simulation
    with Simulation("arm") as sim:
        sim.contacts()


def run(pytester: pytest.Pytester, test: str, *arguments: str) -> pytest.RunResult:
    pytester.makepyfile(LIGHT_ARM + test)
    return pytester.runpytest_inprocess("-p", "no:cacheprovider", *arguments)


def test_a_run_that_does_not_use_it_imports_nothing_heavy():
    done = run_python("-c", PLUGIN_ALONE)
    assert done.stdout == "[]\n", done.stderr


def test_a_test_gets_a_simulation(pytester):
    result = run(
        pytester,
        """
def test_arm(arm_sim):
    arm_sim["position_controller"].command([1.0, 0.5, 0.1, 0.5])
    arm_sim.assert_reaches([1.0, 0.5, 0.1, 0.5], hold_s=0.2)
    arm_sim.assert_never_exceeds(velocity=2.1)
    arm_sim.assert_no_contact()
""",
        "--strict-markers",
    )
    result.assert_outcomes(passed=1)
    assert not (pytester.path / "arm-artifacts").exists()


def test_each_test_begins_anew(pytester):
    result = run(
        pytester,
        """
@pytest.mark.parametrize("goal", [0.5, -0.5])
def test_arm(arm_sim, goal):
    assert arm_sim.time_s == 0.0
    assert len(arm_sim.history) == 1
    assert not arm_sim.joints.position.any()
    arm_sim["position_controller"].command([goal, 0.0, 0.0, 0.0])
    arm_sim.run(0.1)
    assert 0.0 < arm_sim.joints["j0"].position / goal < 1.0
""",
    )
    result.assert_outcomes(passed=2)


def test_the_marker_says_what_is_simulated(pytester):
    pytester.makefile(
        ".urdf",
        slider="""<robot name="slider"><link name="base"/><link name="sled"><inertial>
        <mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>
        </link><joint name="rail" type="prismatic"><parent link="base"/><child link="sled"/>
        <axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="10" velocity="1"/></joint>
        </robot>""",
    )
    pytester.makepyfile(
        """
import pytest

@pytest.mark.arm_sim(robot="slider.urdf", seed=3)
def test_slider(arm_sim):
    assert arm_sim.joints.names == ("rail",)
    arm_sim.run(0.1)
"""
    )
    pytester.runpytest_inprocess("-p", "no:cacheprovider").assert_outcomes(passed=1)


@pytest.mark.parametrize(
    ("marker", "sentence"),
    [
        ("robo='arm'", "@pytest.mark.arm_sim has no argument 'robo'; it has robot, *, world, *"),
        ("world='nowhere'", "no world 'nowhere'*"),
        ("robot='no.urdf'", "*no.urdf*"),
    ],
)
def test_a_mistake_in_a_marker_gets_a_sentence(pytester, marker, sentence):
    result = run(pytester, f"@pytest.mark.arm_sim({marker})\ndef test_arm(arm_sim): pass")
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines([sentence])
    result.stdout.no_fnmatch_line("*Traceback*")
    result.stdout.no_fnmatch_line("*During handling*")


def test_a_failing_test_has_a_plot_in_its_report(pytester):
    result = run(
        pytester,
        """
def test_arm(arm_sim):
    arm_sim["position_controller"].command([1.0, 0.0, 0.0, 0.0])
    arm_sim.assert_reaches({"j0": 1.5}, within_s=1.0)
""",
        "--arm-artifacts=evidence",
    )
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        [
            "E*AssertionError: the joints do not reach the target within 1 s",
            "E*  j0: at 1.0000 rad, 0.5000 rad from 1.5000 rad*",
            "*- arm -*",
            "joints: *joints.png",
            "run it again: arm sim replay *test.run",
        ]
    )
    (plot,) = Path(pytester.path, "evidence").rglob("joints.png")
    assert cv2.imread(str(plot)) is not None
    (recording,) = Path(pytester.path, "evidence").rglob("test.run")
    replayed = Replay(RunFile(recording)).run()
    assert replayed.difference is None
    assert replayed.periods == 100


def test_the_report_for_ci_names_the_folder(pytester):
    run(pytester, "def test_arm(arm_sim): assert False", "--junitxml=report.xml")
    report = (pytester.path / "report.xml").read_text()
    (folder,) = re.findall('<property name="arm" value="(.*?)"', report)
    assert (Path(folder) / "joints.png").is_file()


def test_a_test_that_fails_after_others_has_its_own_recording(pytester):
    result = run(
        pytester,
        """
def test_first(arm_sim):
    arm_sim["position_controller"].command([-1.0, 0.0, 0.0, 0.0])
    arm_sim.run(1.0)

def test_second(arm_sim):
    arm_sim["position_controller"].command([1.0, 0.0, 0.0, 0.0])
    arm_sim.run(0.5)
    with arm_sim.faults.joint_stalled("j0"):
        arm_sim.run(0.2)
    assert False
""",
    )
    result.assert_outcomes(passed=1, failed=1)
    (recording,) = Path(pytester.path, "arm-artifacts").rglob("test.run")
    replayed = Replay(RunFile(recording)).run()
    assert replayed.difference is None
    assert replayed.periods == 70


def test_a_test_may_do_what_it_likes_with_its_simulation(pytester):
    result = run(
        pytester,
        """
BODY = "<body name='b'><freejoint/><geom size='0.1'/></body>"
BALL = f"<mujoco><worldbody>{BODY}</worldbody></mujoco>"

def test_goes_back(arm_sim):
    arm_sim.run(0.1)
    there = arm_sim.save()
    arm_sim.run(0.1)
    arm_sim.restore(there)
    assert arm_sim.time_s == arm_sim.history.times_s[0] == pytest.approx(0.1)
    arm_sim.reset(seed=4)

def test_changes_the_world(arm_sim):
    arm_sim.spawn(BALL, name="ball", pose=[1.0, 0.0, 0.1])
    arm_sim.run(0.1)

def test_stops_its_controller(arm_sim):
    assert "ball" not in arm_sim.entities
    arm_sim.controllers.switch([], ["position_controller"])

def test_ends_it(arm_sim):
    assert arm_sim["position_controller"].is_active
    arm_sim.close()

def test_still_works(arm_sim):
    arm_sim["position_controller"].command([0.1, 0.0, 0.0, 0.0])
    arm_sim.assert_reaches([0.1, 0.0, 0.0, 0.0])
""",
    )
    result.assert_outcomes(passed=5)


def test_a_restored_simulation_repeats_the_first_one_to_the_bit(pytester):
    result = run(
        pytester,
        """
rows = []

@pytest.mark.parametrize("number", [0, 1])
def test_same(arm_sim, number):
    arm_sim["position_controller"].command([1.0, 0.5, 0.1, 0.5])
    arm_sim.run(1.0)
    rows.append(arm_sim.history.position.tobytes() + arm_sim.history.effort.tobytes())

def test_compare(arm_sim):
    assert rows[0] == rows[1]
""",
    )
    result.assert_outcomes(passed=3)


def test_a_contact_is_named(pytester):
    result = run(
        pytester,
        '''
SPHERE = """<mujoco><worldbody><body name="ball"><freejoint/><geom size="0.05"/></body>
</worldbody></mujoco>"""

def test_falls(arm_sim):
    arm_sim.spawn(SPHERE, name="ball", pose=[0.6, 0.0, 0.3])
    arm_sim.run(1.0)
    arm_sim.assert_no_contact()
    arm_sim.assert_no_contact("ball", allow=["world"])
    arm_sim.assert_no_contact("ball")
''',
    )
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["E*AssertionError: ball::ball touches world from 0.*"])
