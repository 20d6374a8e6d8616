"""The plan in the scene: a ghost on the way, a slider along it, and the trail of its tip."""

from viser import GuiApi, SceneApi

from arm_node.rigid_transform import RigidTransform
from arm_planning.robot.model import JointPositions, PlanningModel
from arm_viewer.panels.panel import in_order
from arm_viewer.planning import ShownPlan
from arm_viewer.scene.ghost import Colour, Ghost, Trail

PATH_COLOUR: Colour = (40, 120, 220)
END = 100.0
STEP = 0.5


class PathPlayer:
    """Plays a plan once when it arrives; use it in viser's event loop."""

    def __init__(self, gui: GuiApi, scene: SceneApi, namespace: str, model: PlanningModel) -> None:
        """Create the elements in the open container; they are hidden without a plan."""
        self._ghost = Ghost(scene, f"{namespace}/path", model, PATH_COLOUR)
        self._trail = Trail(scene, f"{namespace}/trail", PATH_COLOUR)
        self._slider = gui.add_slider(
            "Along path", 0.0, END, STEP, END, visible=False, hint="% of the plan's time"
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
        """Show a plan.

        Args:
            plan: the plan; None for none.
            origin: pose of the robot's root link in the scene.
            present: present positions of joints, for those that the plan does not know.
            now_s: monotonic time.
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
        share = self._slider.value / END
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
        self._slider.value = END if share == 1.0 else round(END * share / STEP) * STEP
        if share == 1.0:
            self._started_s = None

    def _pull(self, client_id: int | None) -> None:
        # Without a client the change came from `_advance`.
        if client_id is not None:
            self._started_s = None

    def _want(self) -> None:
        self._is_wanted = True
