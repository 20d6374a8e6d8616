"""Plans and executes motions of one robot: its goal, its buttons, and the plan in the scene."""

from collections.abc import Callable, Mapping

import numpy as np
from viser import GuiApi, GuiButtonHandle, SceneApi

from arm_description.transforms import rotation_from_quaternion, rpy_from_rotation
from arm_node.rigid_transform import RigidTransform
from arm_planning.robot.model import JointGroup, JointPositions, PlanningModel
from arm_planning.scene.frames import LinkPoses
from arm_viewer.panels.panel import PROBLEM_COLOUR, distinct, in_order, say, show
from arm_viewer.panels.robot_panel import link_frames
from arm_viewer.panels.scene_object_panel import SceneObjectPanel
from arm_viewer.planning import (
    Activity,
    JogView,
    PlanningView,
    ShownPlan,
    default_group,
    named_poses,
)
from arm_viewer.requests import (
    DragTip,
    ExecutePlan,
    JogTip,
    PlanMotion,
    Request,
    Send,
    SetGoal,
    StopMotion,
)
from arm_viewer.scene.drag_handle import DragHandle
from arm_viewer.scene.frames import Frames, node_name
from arm_viewer.scene.ghost import Colour, Ghost, Trail
from arm_viewer.snapshot import Snapshot
from arm_viewer.world.shape_fields import read_pose

GOAL_COLOUR: Colour = (240, 140, 30)
NO_POSE = "choose..."
PRESENT = "(where it is)"
LEAST_SCALING, STEP = 0.01, 0.01
TIP_DIGITS = 4
PATH_COLOUR: Colour = (40, 120, 220)
PATH_END = 100.0
PATH_STEP = 0.5


class MotionPanel:
    """The elements of one move_group; use it in viser's event loop."""

    def __init__(
        self, gui: GuiApi, scene: SceneApi, frames: Frames, send: Send, view: PlanningView
    ) -> None:
        """Create the elements in the open container."""
        self._model = view.model
        self._namespace = view.namespace
        self._frames = frames
        self._send = send
        self._ghost = Ghost(scene, f"{view.namespace}/goal", view.model, GOAL_COLOUR)
        self._handle = DragHandle(scene, f"/planning/{node_name(f'{view.namespace}/tip')}")
        title = f"Motion of {view.namespace}" if view.namespace else "Motion"
        self._folder = gui.add_folder(title)
        with self._folder:
            self._build_goal(gui)
            self._build_motion(gui)
            self._player = _PathPlayer(gui, scene, view.namespace, view.model)
        self._place = gui.add_folder("Planning scene", expand_by_default=False)
        with self._place:
            self._objects = SceneObjectPanel(gui, scene, view.namespace, view.model, send)

    def is_for(self, snapshot: Snapshot) -> bool:
        """Return whether its move_group and robot are still there."""
        view = snapshot.planning.get(self._namespace)
        return view is not None and view.model is self._model

    def update(self, snapshot: Snapshot) -> None:
        """Show the move_group's state."""
        view = snapshot.planning[self._namespace]
        robot = self._model.robot
        places = link_frames(robot, self._namespace, self._frames.known)
        origin = self._frames.known.get(places[robot.root], RigidTransform())
        present = snapshot.positions(self._namespace)
        self._show_goal(view, origin, present)
        self._show_handle(view, origin, present)
        self._player.update(view.plan, origin, present, snapshot.made_s)
        self._objects.update(view, origin, LinkPoses(self._model, present))
        is_busy = view.activity is not Activity.NONE
        for button in (self._plan, self._move):
            _set_disabled(button, is_busy or view.goal is None)
        _set_disabled(self._execute, is_busy or view.plan is None or not view.plan.is_own)
        say(self._said, *_said(view))

    def remove(self) -> None:
        """Remove everything from the page."""
        self._ghost.remove()
        self._handle.remove()
        self._player.remove()
        self._objects.remove()
        self._place.remove()
        self._folder.remove()

    def _build_goal(self, gui: GuiApi) -> None:
        groups = tuple(self._model.groups)
        self._group = gui.add_dropdown(
            "Group", groups, initial_value=default_group(self._model), hint="joints to move"
        )
        self._pose = gui.add_dropdown("Pose", self._pose_names(), hint="named poses of the group")
        self._goal_shown = gui.add_checkbox("Show goal", True, hint="a ghost where the robot goes")
        self._drags = gui.add_checkbox(
            "Drag tip", False, hint="arrows and rings at the goal's tip; drag them"
        )
        self._jogs = gui.add_checkbox(
            "Move robot",
            False,
            visible=False,
            hint="the robot itself follows the tip, by servo_node, as long as you drag",
        )
        self._drag = 0
        self._tip = _TipFields(gui, self._set_tip)
        self._jog_said = gui.add_html("", visible=False)
        self._goal_problem = gui.add_html("", visible=False)
        self._group.on_update(in_order(lambda _: self._choose_group()))
        self._pose.on_update(in_order(lambda event: self._choose_pose(event.client_id)))

    def _build_motion(self, gui: GuiApi) -> None:
        self._velocity = gui.add_slider(
            "Velocity", LEAST_SCALING, 1.0, STEP, 1.0, hint="fraction of the velocity limits"
        )
        self._acceleration = gui.add_slider(
            "Acceleration",
            LEAST_SCALING,
            1.0,
            STEP,
            1.0,
            hint="fraction of the acceleration limits",
        )
        self._plan = gui.add_button("Plan")
        self._move = gui.add_button("Plan & Execute")
        self._execute = gui.add_button("Execute", hint="move along the plan that is shown")
        stop = gui.add_button("Stop", color="red", hint="stop planning, and every planned motion")
        self._said = gui.add_html("", visible=False)
        self._plan.on_click(in_order(lambda _: self._send(self._wish(executes=False))))
        self._move.on_click(in_order(lambda _: self._send(self._wish(executes=True))))
        self._execute.on_click(in_order(lambda _: self._send(ExecutePlan(self._namespace))))
        stop.on_click(in_order(lambda _: self._send(StopMotion(self._namespace))))

    def _wish(self, executes: bool) -> Request:
        velocity, acceleration = self._velocity.value, self._acceleration.value
        return PlanMotion(self._namespace, velocity, acceleration, executes)

    def _pose_names(self) -> tuple[str, ...]:
        return distinct((NO_POSE, PRESENT, *named_poses(self._model, self._group.value)))

    def _choose_group(self) -> None:
        self._pose.options = self._pose_names()
        self._pose.value = NO_POSE

    def _choose_pose(self, client_id: int | None) -> None:
        # Without a client the group was changed, which chooses no pose.
        name, group = self._pose.value, self._group.value
        if client_id is None or name == NO_POSE:
            return
        positions: JointPositions = {}
        if name != PRESENT:
            positions = named_poses(self._model, group)[name]
        self._send(SetGoal(self._namespace, group, positions))

    def _show_goal(
        self, view: PlanningView, origin: RigidTransform, present: Mapping[str, float]
    ) -> None:
        goal = view.goal
        say(self._goal_problem, goal.sentence if goal else "")
        if goal is None or not self._goal_shown.value:
            self._ghost.hide()
        else:
            self._ghost.show(origin, goal.positions, present, goal.colliding)

    def _show_handle(
        self, view: PlanningView, origin: RigidTransform, present: Mapping[str, float]
    ) -> None:
        group, goal = self._model.groups.get(self._group.value), view.goal
        self._tip.show(group, lambda link: LinkPoses(self._model, present)[link])
        show(self._jogs, view.jog is not None and self._drags.value)
        is_jogged = self._show_jog(view.jog)
        if group is None or not group.tip or not self._drags.value:
            self._handle.hide()
            return
        pulled = self._handle.pulled()
        if is_jogged:
            self._jog(group.name, origin)
        if pulled is not None:
            self._pose.value = NO_POSE
            self._send(DragTip(self._namespace, group.name, origin.inverse().then(pulled)))
        known: JointPositions = {}
        if goal is not None and goal.group == group.name and not is_jogged:
            known = goal.positions
        tip = LinkPoses(self._model, {**present, **known})[group.tip]
        self._handle.show(origin.then(tip))

    def _set_tip(self, pose: RigidTransform) -> None:
        self._pose.value = NO_POSE
        self._send(DragTip(self._namespace, self._group.value, pose, avoids=True))

    def _show_jog(self, jog: JogView | None) -> bool:
        """Say what the jog does; return whether the robot follows the handle."""
        if jog is None or not self._jogs.visible or not self._jogs.value:
            say(self._jog_said, "")
            return False
        if jog.group != self._group.value:
            say(self._jog_said, f"servo_node jogs the group '{jog.group}'.")
            return False
        say(self._jog_said, jog.said, PROBLEM_COLOUR if jog.is_stopped else "inherit")
        return True

    def _jog(self, group: str, origin: RigidTransform) -> None:
        """Send the robot to the handle, again and again: it stops when nothing comes any more."""
        held = self._handle.held
        if held is None:
            return
        if held.drag != self._drag:
            # The ghost starts where the robot is.
            self._drag = held.drag
            self._send(SetGoal(self._namespace, group, {}))
        self._send(JogTip(self._namespace, origin.inverse().then(held.pose), held.drag))


def _said(view: PlanningView) -> tuple[str, str]:
    """Return what to say about plans and motions, and in which colour."""
    lines = [view.activity.value, view.said]
    if view.plan is not None:
        who = "Plan" if view.plan.is_own else "Plan of another program"
        lines.insert(0, f"{who}: {view.plan.path.summary(view.plan.planning_time_s)}")
    return "\n".join(filter(None, lines)), PROBLEM_COLOUR if view.failed else "inherit"


def _set_disabled(button: GuiButtonHandle, disabled: bool) -> None:
    if button.disabled != disabled:
        button.disabled = disabled


class _TipFields:
    """The goal of a group's tip by numbers: where it is, and how it is turned."""

    def __init__(self, gui: GuiApi, take: Callable[[RigidTransform], None]) -> None:
        """Create the elements in the open container; `take` gets poses in the root link's frame."""
        self._take = take
        self._of = ""
        self._folder = gui.add_folder("Tip by numbers", expand_by_default=False)
        with self._folder:
            self._position = gui.add_text("Tip at", "", hint="x y z from the robot's root, in m")
            self._rpy = gui.add_text("Tip turned", "", hint="roll pitch yaw in rad")
            go = gui.add_button("Set goal", color="gray")
            self._problem = gui.add_html("", visible=False)
        go.on_click(in_order(lambda _: self._read()))

    def show(self, group: JointGroup | None, pose_of: Callable[[str], RigidTransform]) -> None:
        """Begin with the pose of a group's tip; hide the fields for a group without one."""
        show(self._folder, group is not None and bool(group.tip))
        if group is not None and group.tip and group.name != self._of:
            self._of = group.name
            tip = pose_of(group.tip)
            self._position.value = _numbers_text(tip.position)
            rotation = rotation_from_quaternion(np.array(tip.rotation))
            self._rpy.value = _numbers_text(rpy_from_rotation(rotation))

    def _read(self) -> None:
        problem = ""
        try:
            self._take(read_pose(self._position.value, self._rpy.value))
        except ValueError as error:
            problem = str(error)
        say(self._problem, problem)


def _numbers_text(numbers: tuple[float, ...]) -> str:
    # Adding 0 turns -0.0 into 0.0.
    return " ".join(f"{round(number, TIP_DIGITS) + 0.0:g}" for number in numbers)


class _PathPlayer:
    """The plan in the scene: a ghost on the way, a slider along it, and the trail of its tip.

    It plays a plan once when it arrives.
    """

    def __init__(self, gui: GuiApi, scene: SceneApi, namespace: str, model: PlanningModel) -> None:
        """Create the elements in the open container; they are hidden without a plan."""
        self._ghost = Ghost(scene, f"{namespace}/path", model, PATH_COLOUR)
        self._trail = Trail(scene, f"{namespace}/trail", PATH_COLOUR)
        self._slider = gui.add_slider(
            "Along path",
            0.0,
            PATH_END,
            PATH_STEP,
            PATH_END,
            visible=False,
            hint="% of the plan's time",
        )
        self._play = gui.add_button("Play", visible=False, color="gray")
        self._plan: ShownPlan | None = None
        self._origin: RigidTransform | None = None
        self._started_s: float | None = None
        self._is_wanted = False
        self._slider.on_update(in_order(lambda event: self._pull(event.client_id)))
        self._play.on_click(in_order(lambda _: self._want()))

    def update(
        self, plan: ShownPlan | None, origin: RigidTransform, present: JointPositions, now_s: float
    ) -> None:
        """Show a plan; joints that it does not know are where they are at present.

        The origin is the pose of the robot's root link in the scene.
        """
        if plan is None:
            self._hide()
            return
        before = self._plan
        if before is None or plan.path is not before.path or origin != self._origin:
            self._trail.show(origin, plan.path.trail())
            self._is_wanted |= before is None or not plan.path.is_same(before.path)
            self._slider.visible = self._play.visible = True
        self._plan, self._origin = plan, origin
        if self._is_wanted:
            self._is_wanted, self._started_s = False, now_s
        if self._started_s is not None:
            self._advance(plan.path.duration_s, now_s - self._started_s)
        share = self._slider.value / PATH_END
        if share >= 1.0:
            # There the goal's ghost is, or the robot itself.
            self._ghost.hide()
        else:
            state = plan.path.positions_at(share * plan.path.duration_s)
            self._ghost.show(origin, state, present)

    def remove(self) -> None:
        """Remove everything from the scene; the elements go with their container."""
        self._ghost.remove()
        self._trail.hide()

    def _hide(self) -> None:
        if self._plan is not None:
            self._plan = self._started_s = None
            self._slider.visible = self._play.visible = False
            self._trail.hide()
            self._ghost.hide()

    def _advance(self, duration_s: float, time_s: float) -> None:
        share = min(time_s / duration_s, 1.0) if duration_s > 0.0 else 1.0
        self._slider.value = (
            PATH_END if share == 1.0 else round(PATH_END * share / PATH_STEP) * PATH_STEP
        )
        if share == 1.0:
            self._started_s = None

    def _pull(self, client_id: int | None) -> None:
        # Without a client the change came from `_advance`.
        if client_id is not None:
            self._started_s = None

    def _want(self) -> None:
        self._is_wanted = True
