"""How a controller manager decides where ros2_control leaves the choice to a parameter."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ManagerPolicy:
    """The choices; the defaults are ros2_control's.

    Attributes:
        handle_exceptions: whether what a controller or component raises in a cycle stops only
            that one; otherwise it ends the control loop.
        activate_with_inactive_hardware: whether controllers may claim command interfaces of
            components that are only configured.
        stop_with_self_deactivated_hardware: whether controllers stop whose component deactivates
            itself; otherwise they go on commanding nothing.
        end_on_initial_state_failure: whether a component that does not reach its initial state
            is an error of the whole start; otherwise it is logged.
    """

    handle_exceptions: bool = True
    activate_with_inactive_hardware: bool = False
    stop_with_self_deactivated_hardware: bool = True
    end_on_initial_state_failure: bool = True
