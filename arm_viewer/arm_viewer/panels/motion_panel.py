"""Plans and executes motions of one robot: its goal, its buttons, and the plan in the scene."""

from collections.abc import Mapping

from viser import GuiApi, GuiButtonHandle, SceneApi

from arm_node.rigid_transform import RigidTransform
from arm_planning.robot.model import JointPositions
from arm_planning.scene.frames import LinkPoses
from arm_viewer.panels.panel import PROBLEM_COLOUR, distinct, in_order, note, show
from arm_viewer.panels.path_player import PathPlayer
from arm_viewer.panels.robot_panel import link_frames
from arm_viewer.panels.scene_object_panel import SceneObjectPanel
from arm_viewer.panels.tip_fields import TipFields
from arm_viewer.planning import Activity, JogView, PlanningView, default_group, named_poses
from arm_viewer.planning_requests import (
    DragTip,
    ExecutePlan,
    JogTip,
    PlanMotion,
    SetGoal,
    StopMotion,
)
from arm_viewer.requests import Request, Send
from arm_viewer.scene.drag_handle import DragHandle
from arm_viewer.scene.frames import Frames, node_name
from arm_viewer.scene.ghost import Colour, Ghost
from arm_viewer.snapshot import Snapshot

GOAL_COLOUR: Colour = (240, 140, 30)
NO_POSE = "choose..."
PRESENT = "(where it is)"
LEAST_SCALING, STEP = 0.01, 0.01


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
            self._player = PathPlayer(gui, scene, view.namespace, view.model)
        self._place = gui.add_folder("Planning scene", expand_by_default=False)
        with self._place:
            self._objects = SceneObjectPanel(gui, scene, view.namespace, view.model, send)
        self._shown: dict[str, str] = {}

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
        self._say("said", *_said(view))

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
        self._tip = TipFields(gui, self._set_tip)
        self._texts = {place: gui.add_html("", visible=False) for place in ("jog", "goal")}
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
        self._texts["said"] = gui.add_html("", visible=False)
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
        self._say("goal", goal.sentence if goal else "", PROBLEM_COLOUR)
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
            self._say("jog", "", "inherit")
            return False
        if jog.group != self._group.value:
            self._say("jog", f"servo_node jogs the group '{jog.group}'.", PROBLEM_COLOUR)
            return False
        self._say("jog", jog.said, PROBLEM_COLOUR if jog.is_stopped else "inherit")
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

    def _say(self, place: str, sentence: str, colour: str) -> None:
        content = note(sentence, colour)
        if self._shown.get(place) != content:
            self._shown[place] = content
            self._texts[place].content = content
            self._texts[place].visible = bool(sentence)


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
