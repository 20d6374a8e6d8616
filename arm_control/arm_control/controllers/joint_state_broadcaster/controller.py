"""joint_state_broadcaster/JointStateBroadcaster: publishes the states of all joints."""

from collections.abc import Collection, Mapping, Sequence
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.controller import (
    Controller,
    ControllerContext,
    InterfaceConfiguration,
    ReturnType,
)
from arm_control.errors import ControllerError
from arm_control.parameters import parameter
from arm_description.errors import DescriptionError
from arm_node.frozen import frozen

QUANTITIES = ("position", "velocity", "effort")
"""The arrays of a sensor_msgs/JointState, in the order of the flat array published."""


@frozen
class JointStateLayout:
    """The joints and interfaces that are published during one activation.

    Attributes:
        joints: names in joint_states.
        components: (name, names of its interfaces) in dynamic_joint_states.
    """

    joints: tuple[str, ...]
    components: tuple[tuple[str, tuple[str, ...]], ...]


class StateCopy:
    """Copies selected states into a flat array; other elements keep fixed values."""

    def __init__(self, sources: Sequence[int | float]) -> None:
        """Take for each element the index of a state (int) or a fixed value (float)."""
        taken = [i for i, source in enumerate(sources) if isinstance(source, int)]
        self._source = np.array([sources[i] for i in taken], dtype=np.intp)
        self._target = slice(None) if len(taken) == len(sources) else np.array(taken, dtype=np.intp)
        self.values = np.array([np.nan if isinstance(s, int) else s for s in sources])

    def update(self, states: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the array with the current states; it is the same array every time."""
        self.values[self._target] = states[self._source]
        return self.values


@frozen
class _JointStatePlan:
    """A layout, and the copies that fill its values."""

    layout: JointStateLayout
    joints: StateCopy
    components: StateCopy


def plan_joint_states(
    states: Sequence[str],
    *,
    quantity_of: Mapping[str, str],
    ordered_joints: Sequence[str] = (),
    allowed_joints: Collection[str] | None = None,
    extra_joints: Sequence[str] = (),
    left_out: Collection[str] = (),
) -> _JointStatePlan:
    """Plan the messages for these state interfaces.

    Args:
        states: full names such as 'j0/position', in the order of the state array.
        quantity_of: standard name of each interface that has a custom name.
        ordered_joints: the joints to publish, in this order; empty for all.
        allowed_joints: without `ordered_joints`, the joints to publish, in alphabetical order; None
            for all in the order of their interfaces.
        extra_joints: joints without states, published as 0 after the others.
        left_out: full names of states to leave out.
    """
    components: dict[str, dict[str, int | float]] = {}
    for index, full_name in enumerate(states):
        if full_name in left_out:
            continue
        name, _, interface = full_name.rpartition("/")
        components.setdefault(name, {})[quantity_of.get(interface, interface)] = index
    joints = [name for name, has in components.items() if not has.keys().isdisjoint(QUANTITIES)]
    if ordered_joints:
        joints = [name for name in ordered_joints if name in joints]
    elif allowed_joints is not None:
        joints = sorted(name for name in joints if name in allowed_joints)
    for name in extra_joints:
        if name not in components:
            components[name] = dict.fromkeys(QUANTITIES, 0.0)
            joints.append(name)
    return _JointStatePlan(
        layout=JointStateLayout(
            tuple(joints), tuple((name, tuple(has)) for name, has in components.items())
        ),
        joints=StateCopy([components[n].get(q, np.nan) for q in QUANTITIES for n in joints]),
        components=StateCopy([source for has in components.values() for source in has.values()]),
    )


@frozen
class InterfaceMap:
    """The state interface of each quantity."""

    position: str = parameter("position", "State interface shown as position", read_only=True)
    velocity: str = parameter("velocity", "State interface shown as velocity", read_only=True)
    effort: str = parameter("effort", "State interface shown as effort", read_only=True)


@frozen
class JointStateBroadcasterParameters:
    """Parameters of JointStateBroadcaster."""

    use_local_topics: bool = parameter(
        False, "Publish on ~/joint_states and ~/dynamic_joint_states", read_only=True
    )
    joints: tuple[str, ...] = parameter(
        (), "Joints to publish, in this order; only together with interfaces", read_only=True
    )
    interfaces: tuple[str, ...] = parameter(
        (), "State interfaces of each joint; only together with joints", read_only=True
    )
    extra_joints: tuple[str, ...] = parameter(
        (), "Joints without hardware, published as zeros", read_only=True
    )
    use_urdf_to_filter: bool = parameter(
        True, "Publish only movable joints of the robot description", read_only=True
    )
    frame_id: str = parameter("base_link", "frame_id of the published headers", read_only=True)
    publish_dynamic_joint_states: bool = parameter(
        True, "Publish dynamic_joint_states as well", read_only=True
    )
    map_interface_to_joint_state: InterfaceMap = InterfaceMap()


class JointStateSink(Protocol):
    """Receives the states on the loop thread."""

    def open(self, layout: JointStateLayout) -> None:
        """Prepare for this layout; called at each activation."""
        ...

    def publish(
        self, time_s: float, joints: NDArray[np.float64], components: NDArray[np.float64]
    ) -> None:
        """Publish one state; both arrays are reused for the next one.

        Args:
            time_s: stamp.
            joints: shape (3 n,): n positions, n velocities, n efforts; NaN if missing.
            components: shape (number of interfaces,), in the order of `layout.components`.
        """
        ...


class JointStateBroadcaster(Controller[JointStateBroadcasterParameters]):
    """Publishes the state interfaces in every cycle.

    Attributes:
        sink: receives the states; None publishes nothing. Set it before activation.
    """

    parameters_type: ClassVar[type[Any]] = JointStateBroadcasterParameters
    adapter = "arm_control.controllers.joint_state_broadcaster.ros:JointStateBroadcasterAdapter"
    transient = ("_joints", "_interfaces", "_quantity_of", "_plan", "_movable_joints")

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self.sink: JointStateSink | None = None
        self._joints: tuple[str, ...] = ()
        self._interfaces: tuple[str, ...] = ()
        self._quantity_of: dict[str, str] = {}
        self._plan: _JointStatePlan | None = None
        self._movable_joints = self._read_movable_joints()

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim nothing."""
        return InterfaceConfiguration.none()

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read the parameters' joints x interfaces, or all states if one of them is empty."""
        if not self._joints:
            return InterfaceConfiguration.all()
        return InterfaceConfiguration.individual(
            f"{joint}/{interface}" for joint in self._joints for interface in self._interfaces
        )

    def on_configure(self, parameters: JointStateBroadcasterParameters) -> None:
        """Take the parameters; joints without interfaces, or vice versa, are ignored."""
        super().on_configure(parameters)
        self._joints, self._interfaces = parameters.joints, parameters.interfaces
        if bool(self._joints) != bool(self._interfaces):
            self.logger.warning(
                "'%s' parameter is empty. All available state interfaces will be published",
                "interfaces" if self._joints else "joints",
            )
            self._joints = self._interfaces = ()
        self._quantity_of = {}
        for quantity in QUANTITIES:
            interface = getattr(parameters.map_interface_to_joint_state, quantity)
            if quantity in self._interfaces:
                if interface != quantity:
                    self.logger.warning(
                        "interface '%s' is not shown as '%s', because '%s' is among the "
                        "interfaces to publish",
                        interface,
                        quantity,
                        quantity,
                    )
                continue
            self._quantity_of[interface] = quantity

    def on_activate(self) -> None:
        """Plan the messages for the interfaces that exist now.

        Raises:
            ControllerError: there is no state interface.
        """
        if not len(self.states):
            raise ControllerError("None of requested interfaces exist. Controller will not run.")
        self._plan = plan_joint_states(
            self.states.names,
            quantity_of=self._quantity_of,
            ordered_joints=self._joints,
            allowed_joints=self._allowed_joints(),
            extra_joints=self.parameters.extra_joints,
            left_out=self._find_non_double_states(),
        )
        if self.sink is not None:
            self.sink.open(self._plan.layout)

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Publish the current states."""
        plan = self._plan
        if plan is not None and self.sink is not None:
            states = self.states.read()
            self.sink.publish(time_s, plan.joints.update(states), plan.components.update(states))
        return ReturnType.OK

    def on_reset(self) -> None:
        """Do nothing: the states that it publishes are read anew in every cycle."""

    def on_deactivate(self) -> None:
        """Forget the layout."""
        self._plan = None

    def _find_non_double_states(self) -> set[str]:
        types = zip(self.states.names, self.states.data_types, strict=True)
        found = {name: data_type for name, data_type in types if data_type != "double"}
        for name, data_type in found.items():
            self.logger.warning(
                "state interface '%s' is not published: its type is %s, not double", name, data_type
            )
        return set(found)

    def _allowed_joints(self) -> Collection[str] | None:
        return self._movable_joints if self.parameters.use_urdf_to_filter else None

    def _read_movable_joints(self) -> frozenset[str] | None:
        try:
            robot = self.context.read_robot()
        except DescriptionError as error:
            self.logger.error(
                "the robot description cannot be used, so all joints are published: %s", error
            )
            return None
        if robot is None:
            return None
        return frozenset(joint.name for joint in robot.movable_joints)
