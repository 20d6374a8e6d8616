"""Snapshots of a controller manager's contents, as its list services return them."""

from arm_control.lifecycle import LifecycleState
from arm_node.frozen import frozen


@frozen
class InterfaceStatus:
    """A command or state interface.

    Attributes:
        name: full name, 'j0/position'.
        is_available: whether its component is configured.
        is_claimed: whether a controller has claimed it; False for every state interface.
        data_type: as in the robot description; 'double' by default.
    """

    name: str
    is_available: bool
    is_claimed: bool
    data_type: str = "double"


@frozen
class HardwareComponentStatus:
    """A hardware component and its interfaces.

    Attributes:
        name: the component's name.
        type: 'system', 'actuator' or 'sensor'.
        plugin: the driver's type string.
        state: its life-cycle state.
        read_write_rate_hz: the actual rate at which it is read and written.
        is_async: whether the description asks for a separate thread.
        command_interfaces: in the driver's order.
        state_interfaces: in the driver's order.
    """

    name: str
    type: str
    plugin: str
    state: LifecycleState
    read_write_rate_hz: int
    is_async: bool
    command_interfaces: tuple[InterfaceStatus, ...]
    state_interfaces: tuple[InterfaceStatus, ...]


@frozen
class ChainConnection:
    """Reference interfaces of one controller that another one commands.

    Attributes:
        name: the controller that exports them.
        reference_interfaces: their names, without the controller's name.
    """

    name: str
    reference_interfaces: tuple[str, ...]


@frozen
class ControllerStatus:
    """A loaded controller.

    Attributes:
        name: the controller's name.
        type_name: its ros2_control type string.
        state: its life-cycle state.
        update_rate_hz: its actual update rate.
        claimed_interfaces: command interfaces that it has claimed; empty unless active.
        required_command_interfaces: those it requires; empty unless inactive or active.
        required_state_interfaces: those it requires; empty unless inactive or active.
        is_chainable: whether another controller may command it.
        is_chained: whether another controller commands it now.
        reference_interfaces: references that it exports, without its name; empty unless inactive
            or active, like the next two.
        exported_state_interfaces: states that it exports for others to read, without its name.
        chain_connections: references of other controllers that it commands.
        halted_by: why it does not run although it is active; empty otherwise.
    """

    name: str
    type_name: str
    state: LifecycleState
    update_rate_hz: int
    claimed_interfaces: tuple[str, ...]
    required_command_interfaces: tuple[str, ...]
    required_state_interfaces: tuple[str, ...]
    is_chainable: bool = False
    is_chained: bool = False
    reference_interfaces: tuple[str, ...] = ()
    exported_state_interfaces: tuple[str, ...] = ()
    chain_connections: tuple[ChainConnection, ...] = ()
    halted_by: str = ""
