"""What a move_group does and knows, as the page shows it: frozen data without ROS.

SI units: m, rad, s. Poses are in the planning frame unless something else is said.
"""

from dataclasses import dataclass
from enum import Enum

from arm_planning.robot.model import JointGroup, JointPositions, PlanningModel
from arm_planning.scene.scene import PlanningScene
from arm_viewer.planned_path import PlannedPath


@dataclass(frozen=True, slots=True)
class GoalState:
    """Where a group is to go.

    Attributes:
        group: name of the group.
        positions: positions of the group's joints.
        colliding: links that touch something there.
        contacts: what touches what, a line each, such as "gripper_base with box1, 3 mm deep".
        problem: why the last pose that was asked for could not be had; empty if it could.
    """

    group: str
    positions: JointPositions
    colliding: frozenset[str] = frozenset()
    contacts: tuple[str, ...] = ()
    problem: str = ""

    @property
    def sentence(self) -> str:
        """What is wrong with the goal, a line for each; empty if nothing is known to be."""
        touching = [f"The goal is in collision: {contact}" for contact in self.contacts]
        return "\n".join([*([self.problem] if self.problem else []), *touching])


@dataclass(frozen=True, slots=True)
class ShownPlan:
    """A plan.

    Attributes:
        path: the motion.
        is_own: whether this page asked for it; another program did otherwise.
        planning_time_s: how long planning took; 0 if that is not known.
    """

    path: PlannedPath
    is_own: bool
    planning_time_s: float = 0.0


class Activity(Enum):
    """What a move_group does for the page."""

    NONE = ""
    PLANNING = "Planning..."
    MOVING = "The robot moves."


@dataclass(frozen=True, slots=True)
class JogView:
    """A servo_node, which lets a robot follow its tip.

    Attributes:
        group: the group that it jogs.
        said: what slows it down or stops it; empty if nothing does.
        is_stopped: whether `said` is why the robot does not move.
    """

    group: str
    said: str = ""
    is_stopped: bool = False


@dataclass(frozen=True, slots=True)
class PlanningView:
    """One move_group.

    Attributes:
        namespace: of the move_group and its robot, as in `Description.namespace`.
        model: the robot with its groups and named states.
        goal: where the next plan leads; None before one is chosen.
        plan: the latest plan; None if there is none.
        activity: what the move_group does for the page.
        said: what the last plan or motion led to, in full.
        failed: whether `said` is about a failure.
        scene: the planning scene; None until it is known.
        scene_problem: why the last change of the scene by this page was not possible.
        jog: the servo_node of its robot; None if none runs.
    """

    namespace: str
    model: PlanningModel
    goal: GoalState | None = None
    plan: ShownPlan | None = None
    activity: Activity = Activity.NONE
    said: str = ""
    failed: bool = False
    scene: PlanningScene | None = None
    scene_problem: str = ""
    jog: JogView | None = None


def default_group(model: PlanningModel) -> str:
    """Return the group that the page offers first: a chain with joints, or else the first one."""
    chains = [group.name for group in model.groups.values() if group.tip and group.joints]
    return next(iter([*chains, *model.groups]), "")


def named_poses(model: PlanningModel, group: str) -> dict[str, JointPositions]:
    """Return the named states of a group."""
    return {name: state for (owner, name), state in model.states.items() if owner == group}


def filled(group: JointGroup, *sources: JointPositions) -> JointPositions:
    """Return a position for each joint of a group, from the first source that has it, or else 0."""
    return {
        joint: next((source[joint] for source in sources if joint in source), 0.0)
        for joint in group.joints
    }
