"""headless:=false: a window that shows the simulation and can be closed without ending it."""

import numpy as np
import psutil
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

TIMEOUT_S = 90.0
POSE = [1.5, 0.9, 0.9, 0.5]


def settled_picture(client, display) -> np.ndarray:
    """Wait until the window's image no longer changes; return it."""
    pictures = [display.picture().astype(int)]

    def settled() -> bool:
        pictures.append(display.picture().astype(int))
        return bool(pictures[-1].std() > 10 and np.array_equal(*pictures[-2:]))

    client.wait_until(settled, "the window shows the arm at rest", TIMEOUT_S)
    return pictures[-1]


def test_the_window_shows_the_arm_and_closing_it_ends_nothing_else(launch, client, display):
    launched = launch("camera:=none", "headless:=false", DISPLAY=display.name)
    launched.wait_until_ready()
    before = settled_picture(client, display)
    client.publisher(Float64MultiArray, "/position_controller/commands").publish(
        Float64MultiArray(data=POSE)
    )
    client.wait_until(
        lambda: np.any(np.abs(display.picture() - before) > 60), "the arm moves there", TIMEOUT_S
    )
    (window,) = launched.processes("arm_gazebo.window")
    assert display.close_windows() >= 1
    _, alive = psutil.wait_procs([window], timeout=TIMEOUT_S)
    assert alive == []
    launched.wait_for_line("the window was closed; the simulation continues")
    client.subscribe(JointState, "/joint_states").wait_for(100)
    assert launched.stop() == 0, launched.output


def test_ending_the_simulation_closes_the_window(launch, client, display):
    launched = launch("camera:=none", "headless:=false", DISPLAY=display.name)
    launched.wait_until_ready()
    settled_picture(client, display)
    children = launched.processes()
    assert launched.stop() == 0, launched.output
    _, alive = psutil.wait_procs(children, timeout=60.0)
    assert alive == []
