"""The parameters of moveit_servo, by its names below `moveit_servo`."""

from array import array
from dataclasses import dataclass

from arm_node.parameter_values import NumberReader, one_of, read_non_negative, read_numbers
from arm_node.setting import setting

TRAJECTORY, ARRAY = "trajectory_msgs/JointTrajectory", "std_msgs/Float64MultiArray"
UNITLESS, SPEED_UNITS = "unitless", "speed_units"
POSITIVE = NumberReader("a number above 0", 0.0, above=True)
AT_LEAST_ONE = NumberReader("a number of at least 1", 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoSettings:
    """How a robot is jogged; defaults are moveit_servo's, but for the group and the topic."""

    group: str = setting(
        "",
        "planning group that is jogged; empty: the first one that is a chain",
        name="move_group_name",
    )
    publish_period_s: float = setting(
        0.01,
        "time between two commands, of the node's clock",
        NumberReader("a time from 0.001 to 1 s", 0.001, 1.0),
        unit="s",
        name="publish_period",
    )
    timeout_s: float = setting(
        0.1,
        "age of a command's stamp from which the robot stops",
        POSITIVE,
        unit="s",
        name="incoming_command_timeout",
    )
    command_in_type: str = setting(
        UNITLESS,
        "unitless: commands are factors of `scale`; speed_units: m/s and rad/s",
        choices=(UNITLESS, SPEED_UNITS),
    )
    linear_scale: float = setting(
        0.4, "largest linear speed", POSITIVE, unit="m/s", name="scale.linear"
    )
    rotational_scale: float = setting(
        0.8, "largest angular speed", POSITIVE, unit="rad/s", name="scale.rotational"
    )
    joint_scale: float = setting(
        0.5, "largest speed of a joint that is jogged by itself", POSITIVE, name="scale.joint"
    )
    override_velocity_scaling_factor: float = setting(
        0.0, "factor of the joints' velocity limits; 0: 1", NumberReader("from 0 to 1", 0.0, 1.0)
    )
    command_out_topic: str = setting(
        "", "topic of the commands; empty: that of the active controller of the group's joints"
    )
    command_out_type: str = setting(TRAJECTORY, "type of the commands", one_of((TRAJECTORY, ARRAY)))
    publish_joint_positions: bool = setting(True, "commands have positions")
    publish_joint_velocities: bool = setting(
        True, "trajectories have velocities; a Float64MultiArray has them without positions"
    )
    check_collisions: bool = setting(True, "slow down before collisions")
    self_proximity_m: float = setting(
        0.01,
        "distance between parts of the robot from which on it slows down",
        POSITIVE,
        unit="m",
        name="self_collision_proximity_threshold",
    )
    scene_proximity_m: float = setting(
        0.02,
        "likewise to objects of the scene",
        POSITIVE,
        unit="m",
        name="scene_collision_proximity_threshold",
    )
    lower_singularity_threshold: float = setting(
        17.0, "condition number from which on it slows down", AT_LEAST_ONE
    )
    hard_stop_singularity_threshold: float = setting(
        30.0, "condition number at which it goes no nearer", AT_LEAST_ONE
    )
    leaving_singularity_threshold_multiplier: float = setting(
        2.0, "how much farther away it is slowed down on its way out", AT_LEAST_ONE
    )
    joint_limit_margins: tuple[float, ...] = setting(
        array("d", [0.1]),
        "distances from the position limits, one for all joints or one for each, in rad or m",
        read_numbers,
    )
    halt_all_joints_in_joint_mode: bool = setting(
        True, "at a limit all joints stop, not only that one, while joints are jogged"
    )
    halt_all_joints_in_cartesian_mode: bool = setting(
        True, "likewise while the tip is jogged; else it leaves its direction"
    )
    linear_tolerance_m: float = setting(
        0.001,
        "distance from a target pose that counts as there",
        read_non_negative,
        unit="m",
        name="pose_tracking.linear_tolerance",
    )
    angular_tolerance_rad: float = setting(
        0.01,
        "angle from a target pose that counts as there",
        read_non_negative,
        unit="rad",
        name="pose_tracking.angular_tolerance",
    )
