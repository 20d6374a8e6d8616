"""The parameters of a controller are those that it was configured with."""

from dataclasses import replace

import pytest

from arm_control.errors import ControllerError
from arm_control.manager.registry import controller_class

FORWARD = {"joints": ["j0", "j1"], "interface_name": "position"}
TRAJECTORY = {
    "joints": ["j0"],
    "command_interfaces": ["position"],
    "state_interfaces": ["position"],
}
TYPES = {
    "forward_command_controller/ForwardCommandController": FORWARD,
    "forward_command_controller/MultiInterfaceForwardCommandController": {
        "joint": "j0",
        "interface_names": ["position"],
    },
    "position_controllers/JointGroupPositionController": FORWARD,
    "position_controllers/JointPositionController": {"joint": "j0"},
    "joint_trajectory_controller/JointTrajectoryController": TRAJECTORY,
    "joint_state_broadcaster/JointStateBroadcaster": {},
    "pid_controller/PidController": {
        "dof_names": ["j0"],
        "command_interface": "position",
        "reference_and_state_interfaces": ["position"],
        "gains.j0.p": 1.0,
    },
    "position_controllers/GripperActionController": {"joint": "j0"},
}


@pytest.mark.parametrize("kind", TYPES)
def test_they_are_known_from_configure_to_cleanup(bench, make, kind):
    class_ = controller_class(kind)
    given = class_.build_parameters(TYPES[kind])
    controller = make(class_, given)
    assert controller.parameters is given
    changed = replace(given)
    controller.change_parameters(changed)
    assert controller.parameters is changed
    bench.manager.cleanup_controller("it")
    with pytest.raises(ControllerError, match="controller 'it' is not configured"):
        _ = controller.parameters
