"""Services that answer whatever happens: a client without an answer waits for ever."""

import logging
from collections.abc import Callable
from typing import Any

from arm_planning.errors import MoveItErrorCode
from arm_planning.ros.convert import error_code

LOGGER = logging.getLogger("move_group")


def answering(name: str, serve: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    """Return a service's callback that answers even if it has a fault.

    Args:
        name: the service's name.
        serve: fills the response; an exception of it is logged, and the code becomes FAILURE.
    """

    def answer(request: Any, response: Any) -> Any:
        try:
            return serve(request, response)
        except Exception as error:
            LOGGER.exception("%s has a fault", name)
            failed = type(response)()
            if hasattr(failed, "error_code"):
                holder = failed
            else:
                holder = getattr(failed, "motion_plan_response", None)
            if holder is not None:
                holder.error_code = error_code(
                    MoveItErrorCode.FAILURE,
                    f"{name} has a fault, please report it: {type(error).__name__}: {error}",
                )
            return failed

    return answer
