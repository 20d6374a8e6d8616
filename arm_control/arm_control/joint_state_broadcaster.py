"""joint_state_broadcaster/JointStateBroadcaster: publishes what every joint does."""

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from arm_control.controller import Controller, ControllerContext, ReturnType
from arm_control.errors import ControllerError
from arm_control.interface_configuration import InterfaceConfiguration
from arm_control.joint_state_layout import (
    QUANTITIES,
    JointStateLayout,
    JointStatePlan,
    plan_joint_states,
)
from arm_control.parameters import parameter
from arm_description.errors import DescriptionError
from arm_description.urdf import parse_urdf


@dataclass(frozen=True, slots=True)
class InterfaceMap:
    """Which state interface stands for which quantity."""

    position: str = parameter("position", "State interface shown as position", read_only=True)
    velocity: str = parameter("velocity", "State interface shown as velocity", read_only=True)
    effort: str = parameter("effort", "State interface shown as effort", read_only=True)


@dataclass(frozen=True, slots=True)
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
        True, "Publish only joints that the robot description moves", read_only=True
    )
    frame_id: str = parameter("base_link", "frame_id of the published headers", read_only=True)
    publish_dynamic_joint_states: bool = parameter(
        True, "Publish dynamic_joint_states, too", read_only=True
    )
    map_interface_to_joint_state: InterfaceMap = InterfaceMap()


class JointStateSink(Protocol):
    """Where the states go; used on the loop thread."""

    def open(self, layout: JointStateLayout) -> None:
        """Get ready for this layout; called at each activation."""
        ...

    def publish(
        self, time_s: float, joints: NDArray[np.float64], components: NDArray[np.float64]
    ) -> None:
        """Publish one state; both arrays are reused for the next one.

        Args:
            time_s: stamp.
            joints: shape (3 n,): n positions, n velocities, n efforts; NaN where there is none.
            components: shape (number of interfaces,), in the order of `layout.components`.
        """
        ...


class JointStateBroadcaster(Controller[JointStateBroadcasterParameters]):
    """Publishes the state interfaces, every cycle.

    Attributes:
        sink: where the states go; None publishes nothing. Set it before activation.
    """

    parameters_type: ClassVar[type[Any]] = JointStateBroadcasterParameters
    adapter = "arm_control.ros.joint_state_broadcaster_adapter:JointStateBroadcasterAdapter"

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self.sink: JointStateSink | None = None
        self._joints: tuple[str, ...] = ()
        self._interfaces: tuple[str, ...] = ()
        self._quantity_of: dict[str, str] = {}
        self._plan: JointStatePlan | None = None
        self._movable_joints = self._read_movable_joints()

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim nothing."""
        return InterfaceConfiguration.none()

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read joints x interfaces of the parameters, or everything where one is empty."""
        if not self._joints:
            return InterfaceConfiguration.all()
        return InterfaceConfiguration.individual(
            f"{joint}/{interface}" for joint in self._joints for interface in self._interfaces
        )

    def on_configure(self, parameters: JointStateBroadcasterParameters) -> None:
        """Take the parameters; joints or interfaces without the other choose nothing."""
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
        """Lay the messages out for the interfaces there are now.

        Raises:
            ControllerError: there is no state interface at all.
        """
        if not len(self.states):
            raise ControllerError("None of requested interfaces exist. Controller will not run.")
        self._plan = plan_joint_states(
            self.states.names,
            quantity_of=self._quantity_of,
            ordered_joints=self._joints,
            allowed_joints=self._allowed_joints(),
            extra_joints=self.parameters.extra_joints,
            left_out=self._find_what_is_no_quantity(),
        )
        if self.sink is not None:
            self.sink.open(self._plan.layout)

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Publish the present states."""
        plan = self._plan
        if plan is not None and self.sink is not None:
            states = self.states.read()
            self.sink.publish(time_s, plan.joints.update(states), plan.components.update(states))
        return ReturnType.OK

    def on_deactivate(self) -> None:
        """Forget the layout."""
        self._plan = None

    def _find_what_is_no_quantity(self) -> set[str]:
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
        if not self.context.robot_description:
            return None
        try:
            robot = parse_urdf(self.context.robot_description)
        except DescriptionError as error:
            self.logger.error(
                "the robot description cannot be used, so all joints are published: %s", error
            )
            return None
        return frozenset(joint.name for joint in robot.movable_joints)
