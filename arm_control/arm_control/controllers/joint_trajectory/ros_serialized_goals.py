"""Goals of FollowJointTrajectory whose waypoints stay serialised.

rclpy converts a whole goal to Python objects while it holds the interpreter lock: with 100,000
waypoints the control loop stands still for most of a second. rclpy gets the conversion function
from the message class. This module supplies one that first extracts the waypoints as bytes,
without the lock, and leaves only the rest to the original function.

The waypoints are found in the C message by their offset. This is tested on a small goal before it
is used; if the result differs, rclpy converts goals as usual, and the log says so. Works around
https://github.com/ros2/rclpy/issues/836, made for rclpy 7.1 and 9.1. ARM_WITHOUT knows it as
`serialized_goals`.
"""

import ctypes
import logging
from dataclasses import dataclass
from functools import cached_property
from types import SimpleNamespace
from typing import Any

from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTolerance
from rclpy.serialization import serialize_message
from rclpy.type_support import check_for_type_support
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from unique_identifier_msgs.msg import UUID

from arm_control.controllers.joint_trajectory.serialized import read_trajectory
from arm_control.controllers.joint_trajectory.trajectory import TrajectoryRequest
from arm_node.workarounds.switch import is_on

MIDDLEWARE = ("librmw_implementation.so", "librmw_fastrtps_cpp.so")
"""Libraries with the middleware's functions: in a ROS installation, and in the wheels."""

GoalMessage = FollowJointTrajectory.Goal
GoalRequestMessage = FollowJointTrajectory.Impl.SendGoalService.Request

OFF = "workaround serialized_goals is off, large goals hold up the control loop: %s"

logger = logging.getLogger(__name__)


@dataclass(frozen=True)
class TakenGoal:
    """A received goal.

    Attributes:
        message: the goal; its trajectory may lack the points.
        trajectory: the whole trajectory, serialised.
    """

    message: Any
    trajectory: bytes

    @classmethod
    def of(cls, message: Any) -> "TakenGoal":
        """Return a goal that rclpy has converted."""
        return cls(message, serialize_message(message.trajectory))

    @cached_property
    def request(self) -> TrajectoryRequest:
        """The trajectory.

        Raises:
            SerializedTrajectoryError: the bytes are damaged.
        """
        return read_trajectory(self.trajectory)


def taken_goal(goal: Any) -> TakenGoal:
    """Return a goal as `TakenGoal`, also if rclpy has converted it."""
    return goal if isinstance(goal, TakenGoal) else TakenGoal.of(goal)


class _Allocator(ctypes.Structure):
    """rcutils_allocator_t."""

    _fields_ = [(name, ctypes.c_void_p) for name in ("a", "d", "r", "z", "state")]


class _Bytes(ctypes.Structure):
    """rcutils_uint8_array_t."""

    _fields_ = (
        ("buffer", ctypes.c_void_p),
        ("length", ctypes.c_size_t),
        ("capacity", ctypes.c_size_t),
        ("allocator", _Allocator),
    )


class _Sequence(ctypes.Structure):
    """A sequence of a C message."""

    _fields_ = (("data", ctypes.c_void_p), ("size", ctypes.c_size_t), ("capacity", ctypes.c_size_t))


class _Trajectory(ctypes.Structure):
    """trajectory_msgs/msg/JointTrajectory."""

    _fields_ = (
        ("sec", ctypes.c_int32),
        ("nanosec", ctypes.c_uint32),
        ("frame_id", _Sequence),
        ("joint_names", _Sequence),
        ("points", _Sequence),
    )


class _GoalRequest(ctypes.Structure):
    """The first fields of control_msgs/action/FollowJointTrajectory_SendGoal_Request."""

    _fields_ = (("goal_id", ctypes.c_uint8 * 16), ("trajectory", _Trajectory))


class GoalConversion:
    """Converts the C message of a goal request to Python, except its waypoints.

    Attributes:
        stand_in: replaces the class of goal requests in rclpy, which gets from its type the
            functions that create, convert and destroy a C message.
    """

    def __init__(self) -> None:
        """Find the functions.

        Raises:
            OSError, AttributeError, ValueError: one was not found.
        """
        check_for_type_support(FollowJointTrajectory)
        check_for_type_support(JointTrajectory)
        own: Any = type(GoalRequestMessage)
        trajectory: Any = type(JointTrajectory)
        self._convert_rest = ctypes.PYFUNCTYPE(ctypes.py_object, ctypes.c_void_p)(
            _pointer(own._CONVERT_TO_PY)
        )
        self._trajectory_support = ctypes.c_void_p(_pointer(trajectory._TYPE_SUPPORT))
        # `CDLL` releases the interpreter lock while a function runs.
        self._middleware = ctypes.CDLL(_loaded(*MIDDLEWARE))
        self._utilities = ctypes.CDLL(_loaded("librcutils.so"))
        self._utilities.rcutils_get_default_allocator.restype = _Allocator
        self._utilities.rcutils_uint8_array_init.argtypes = (
            ctypes.POINTER(_Bytes),
            ctypes.c_size_t,
            ctypes.POINTER(_Allocator),
        )
        self._callback = ctypes.PYFUNCTYPE(ctypes.py_object, ctypes.c_void_p)(self._convert)
        new_capsule = ctypes.pythonapi.PyCapsule_New
        new_capsule.restype = ctypes.py_object
        new_capsule.argtypes = (ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p)
        convert = new_capsule(ctypes.cast(self._callback, ctypes.c_void_p), None, None)
        self.stand_in = type(
            "GoalRequestStandIn",
            (),
            {
                "_CREATE_ROS_MESSAGE": own._CREATE_ROS_MESSAGE,
                "_DESTROY_ROS_MESSAGE": own._DESTROY_ROS_MESSAGE,
                "_CONVERT_TO_PY": convert,
                "conversion": self,
            },
        )()

    def _convert(self, address: int) -> Any:
        """Return the request of a C message. It must not raise, because C++ calls it."""
        message = _GoalRequest.from_address(address)
        points = message.trajectory.points
        try:
            data = self._serialize(ctypes.addressof(message.trajectory))
        except (MemoryError, ValueError):
            logger.exception("rclpy converts a goal: its waypoints cannot be serialised")
            request = self._convert_rest(address)
            return SimpleNamespace(goal_id=request.goal_id, goal=TakenGoal.of(request.goal))
        size, points.size = points.size, 0
        try:
            request = self._convert_rest(address)
        finally:
            points.size = size
        return SimpleNamespace(goal_id=request.goal_id, goal=TakenGoal(request.goal, data))

    def _serialize(self, trajectory: int) -> bytes:
        allocator = self._utilities.rcutils_get_default_allocator()
        array = _Bytes()
        if self._utilities.rcutils_uint8_array_init(array, 0, allocator):
            raise MemoryError("no memory for a serialised trajectory")
        try:
            if self._middleware.rmw_serialize(
                ctypes.c_void_p(trajectory), self._trajectory_support, ctypes.byref(array)
            ):
                raise ValueError("the middleware cannot serialise the trajectory")
            return ctypes.string_at(array.buffer, array.length)
        finally:
            self._utilities.rcutils_uint8_array_fini(ctypes.byref(array))

    def round_trip(self, request: Any) -> Any:
        """Return a request after its conversion to C and back.

        Raises:
            ValueError: it cannot be converted, or the C message has an unexpected layout.
        """
        own: Any = type(GoalRequestMessage)
        write = ctypes.PYFUNCTYPE(ctypes.c_bool, ctypes.py_object, ctypes.c_void_p)(
            _pointer(own._CONVERT_FROM_PY)
        )
        message = ctypes.PYFUNCTYPE(ctypes.c_void_p)(_pointer(own._CREATE_ROS_MESSAGE))()
        try:
            points = _GoalRequest.from_address(message).trajectory.points
            # Checked before anything in the message is changed.
            if not write(request, message) or points.size != len(request.goal.trajectory.points):
                raise ValueError("a goal in C is not laid out as expected")
            return self._convert(message)
        finally:
            ctypes.PYFUNCTYPE(None, ctypes.c_void_p)(_pointer(own._DESTROY_ROS_MESSAGE))(message)

    def reads(self, request: Any) -> bool:
        """Return whether a request is unchanged by its conversion to C and back.

        Raises:
            ValueError: see `round_trip`.
        """
        taken = self.round_trip(request)
        rest, goal = taken.goal.message, request.goal
        return (
            taken.goal_id == request.goal_id
            and _is_same(taken.goal.request, TakenGoal.of(goal).request)
            and not rest.trajectory.points
            and rest.trajectory.header == goal.trajectory.header
            and rest.trajectory.joint_names == goal.trajectory.joint_names
            and rest.path_tolerance == goal.path_tolerance
            and rest.goal_tolerance == goal.goal_tolerance
            and rest.goal_time_tolerance == goal.goal_time_tolerance
        )


def serializing_action_type() -> Any:
    """Return FollowJointTrajectory with goals as `TakenGoal`s, if that is possible."""
    if not is_on("serialized_goals"):
        return FollowJointTrajectory
    try:
        conversion = GoalConversion()
        works = conversion.reads(_sample())
    except (OSError, AttributeError, ValueError) as error:
        logger.info(OFF, error)
        return FollowJointTrajectory
    if not works:
        logger.info(OFF, "C messages have an unexpected layout")
        return FollowJointTrajectory
    service = FollowJointTrajectory.Impl.SendGoalService

    class SendGoalService(service):
        Request = conversion.stand_in

    class Impl(FollowJointTrajectory.Impl):
        pass

    Impl.SendGoalService = SendGoalService

    class StandInAction(FollowJointTrajectory):
        pass

    StandInAction.Impl = Impl
    return StandInAction


def _is_same(one: TrajectoryRequest, other: TrajectoryRequest) -> bool:
    """Compare the values, because the padding bytes between numbers are undefined."""
    return (
        list(one.joint_names) == list(other.joint_names)
        and one.stamp_s == other.stamp_s
        and list(one.points) == list(other.points)
    )


def _sample() -> Any:
    point = JointTrajectoryPoint(positions=[1.0], time_from_start=Duration(sec=1, nanosec=2))
    goal = GoalMessage(
        trajectory=JointTrajectory(joint_names=["a"], points=[point, point, point]),
        path_tolerance=[JointTolerance(name="a", position=0.5)],
        goal_time_tolerance=Duration(sec=3),
    )
    goal.trajectory.header.frame_id = "frame"
    return GoalRequestMessage(goal_id=UUID(uuid=list(range(16))), goal=goal)


def _loaded(*libraries: str) -> str:
    """Return the path of the first of these libraries that rclpy has loaded.

    Raises:
        OSError: none of them is loaded.
    """
    with open("/proc/self/maps") as maps:
        paths = {line.rstrip().rpartition(" ")[2] for line in maps}
    loaded = {path.rpartition("/")[2]: path for path in paths}
    for library in libraries:
        if library in loaded:
            return loaded[library]
    raise OSError(f"{' or '.join(libraries)} is not loaded")


def _pointer(capsule: Any) -> int:
    """Return the address that a capsule holds."""
    name_of, get = ctypes.pythonapi.PyCapsule_GetName, ctypes.pythonapi.PyCapsule_GetPointer
    name_of.restype, name_of.argtypes = ctypes.c_char_p, (ctypes.py_object,)
    get.restype, get.argtypes = ctypes.c_void_p, (ctypes.py_object, ctypes.c_char_p)
    return get(capsule, name_of(capsule))
