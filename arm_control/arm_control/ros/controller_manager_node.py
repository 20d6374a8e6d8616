"""The node /controller_manager and its parameters."""

import sys
from collections.abc import Sequence

from arm_control.controller_switch import Strictness
from arm_control.errors import ParameterError
from arm_control.parameters import build_parameters, specs_of
from arm_control.ros.manager_settings import ManagerSettings
from arm_control.ros.node_arguments import manager_arguments
from arm_control.ros.parameter_node import ParameterNode

_STRICTNESS = {"best_effort": Strictness.BEST_EFFORT, "strict": Strictness.STRICT}


class ControllerManagerNode(ParameterNode):
    """The manager's node: its own parameters, and whatever is said about controllers.

    It can be made before there is any hardware, because the hardware wants to know the update
    rate; `ControllerManagerServer` then gives it its services.

    Attributes:
        arguments: ROS arguments of the process.
        settings: the node's parameters at its start.
    """

    def __init__(
        self,
        arguments: Sequence[str] | None = None,
        *,
        name: str = "controller_manager",
        namespace: str = "",
    ) -> None:
        """Make the node.

        Args:
            arguments: of the process; default sys.argv.
            name: of the node.
            namespace: of the node, its controllers and components.

        Raises:
            ParameterError: a parameter has the wrong type or value.
        """
        self.arguments = tuple(sys.argv if arguments is None else arguments)
        super().__init__(
            name,
            namespace=namespace,
            cli_args=manager_arguments(self.arguments),
            use_global_arguments=False,
            allow_undeclared_parameters=True,
        )
        specs = specs_of(ManagerSettings)
        self.declare_specs(specs)
        self.declare_rest()
        self.settings: ManagerSettings = build_parameters(ManagerSettings, self.values_of(specs))
        if self.settings.update_rate < 1:
            raise ParameterError(
                f"parameter 'update_rate' of /{name} must be positive, "
                f"but is {self.settings.update_rate}"
            )
        self.default_strictness()

    def default_strictness(self) -> Strictness:
        """Return the strictness of a switch request that names none.

        Raises:
            ParameterError: the parameter is neither of the two words.
        """
        parameter = "defaults.switch_controller.strictness"
        word = self.get_parameter(parameter).value
        if word not in _STRICTNESS:
            raise ParameterError(
                f"parameter '{parameter}' must be one of {', '.join(_STRICTNESS)}, but is {word!r}"
            )
        return _STRICTNESS[word]
