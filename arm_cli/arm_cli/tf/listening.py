"""How long the verbs of `arm tf` listen before they know the frames."""

from typing import TYPE_CHECKING

from arm_cli.errors import UnansweredError
from arm_cli.names import this_domain

if TYPE_CHECKING:
    from arm_cli.frames.frame_log import FrameLog
    from arm_cli.ros.session import Session

FIRST_TIMEOUT_S = 10.0


def listen(session: "Session", duration_s: float) -> "FrameLog":
    """Return the frames heard of in some seconds, counted from the first transform on.

    Raises:
        UnansweredError: nobody publishes any.
    """
    from arm_cli.ros.tf_listener import TfListener

    log = TfListener(session).log
    heard = session.wait_until(
        lambda: bool(log.frames),
        lambda: f"waiting for transforms on /tf and /tf_static, {this_domain()}",
        FIRST_TIMEOUT_S,
    )
    if not heard:
        raise UnansweredError(f"no transforms on /tf or /tf_static within {FIRST_TIMEOUT_S:g} s")
    session.spin_for(duration_s)
    return log
