"""Converts the core's snapshots to controller_manager_msgs and lifecycle_msgs."""

from collections.abc import Iterable

from controller_manager_msgs.msg import (
    ChainConnection,
    ControllerManagerActivity,
    ControllerState,
    HardwareComponentState,
    HardwareInterface,
    NamedLifecycleState,
)
from lifecycle_msgs.msg import State, TransitionEvent
from lifecycle_msgs.msg import Transition as TransitionMessage

from arm_control.lifecycle import LifecycleState, Transition
from arm_control.status import ControllerStatus, HardwareComponentStatus, InterfaceStatus


def state_message(state: LifecycleState) -> State:
    """Return a life-cycle state as a message."""
    return State(id=int(state), label=state.label)


def controller_message(status: ControllerStatus) -> ControllerState:
    """Return a controller as in list_controllers."""
    return ControllerState(
        name=status.name,
        state=status.state.label,
        type=status.type_name,
        update_rate=status.update_rate_hz,
        claimed_interfaces=list(status.claimed_interfaces),
        required_command_interfaces=list(status.required_command_interfaces),
        required_state_interfaces=list(status.required_state_interfaces),
        is_chainable=status.is_chainable,
        is_chained=status.is_chained,
        reference_interfaces=list(status.reference_interfaces),
        exported_state_interfaces=list(status.exported_state_interfaces),
        chain_connections=[
            ChainConnection(name=c.name, reference_interfaces=list(c.reference_interfaces))
            for c in status.chain_connections
        ],
    )


def interface_message(status: InterfaceStatus) -> HardwareInterface:
    """Return an interface as in list_hardware_interfaces."""
    return HardwareInterface(
        name=status.name,
        data_type=status.data_type,
        is_available=status.is_available,
        is_claimed=status.is_claimed,
    )


def component_message(status: HardwareComponentStatus) -> HardwareComponentState:
    """Return a component as in list_hardware_components."""
    return HardwareComponentState(
        name=status.name,
        type=status.type,
        rw_rate=status.read_write_rate_hz,
        is_async=status.is_async,
        plugin_name=status.plugin,
        state=state_message(status.state),
        command_interfaces=[interface_message(i) for i in status.command_interfaces],
        state_interfaces=[interface_message(i) for i in status.state_interfaces],
    )


def activity_message(
    controllers: Iterable[ControllerStatus], components: Iterable[HardwareComponentStatus]
) -> ControllerManagerActivity:
    """Return the states of all controllers and components; the caller sets the stamp."""
    return ControllerManagerActivity(
        controllers=[
            NamedLifecycleState(name=c.name, state=state_message(c.state)) for c in controllers
        ],
        hardware_components=[
            NamedLifecycleState(name=c.name, state=state_message(c.state)) for c in components
        ],
    )


def transition_events(
    transition: Transition, start: LifecycleState, end: LifecycleState
) -> tuple[TransitionEvent, TransitionEvent]:
    """Return the two events of a transition: into its transition state, and out of it."""
    label = "transition_success" if end is transition.goal else "transition_failure"
    transition_state = State(id=transition.state_id, label=transition.state_label)
    return (
        TransitionEvent(
            transition=TransitionMessage(id=transition.id, label=transition.label),
            start_state=state_message(start),
            goal_state=transition_state,
        ),
        TransitionEvent(
            transition=TransitionMessage(label=label),
            start_state=transition_state,
            goal_state=state_message(end),
        ),
    )
