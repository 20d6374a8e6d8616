"""A one-shot command waits for its addressee."""

from arm_controller.listener_watch import ONLOOKER_S, SETTLE_S, Audience, ListenerWatch

CONTROLLER = "/position_controller"


def watch_of(*observations: tuple[float, set[str]]) -> ListenerWatch:
    watch = ListenerWatch(CONTROLLER, now_s=0.0)
    for now_s, listeners in observations:
        watch.observe(listeners, now_s)
    return watch


def test_nobody_is_never_ready():
    watch = watch_of((0.0, set()), (100.0, set()))
    assert not watch.is_ready(100.0)
    assert watch.lasting_s(100.0) == 100.0


def test_the_controller_is_ready_once_the_match_has_settled():
    watch = watch_of((1.0, {CONTROLLER}))
    assert not watch.is_ready(1.0 + SETTLE_S - 0.01)
    assert watch.is_ready(1.0 + SETTLE_S + 0.01)


def test_an_onlooker_does_not_use_up_the_command_while_the_controller_starts():
    watch = watch_of((0.0, {"/recorder"}))
    assert not watch.is_ready(ONLOOKER_S - 0.01)
    watch.observe({"/recorder", CONTROLLER}, 3.0)
    assert not watch.is_ready(3.0)
    assert watch.is_ready(3.0 + SETTLE_S + 0.01)


def test_a_lone_listener_of_another_name_gets_the_command_in_the_end():
    watch = watch_of((0.0, {"/my_driver"}))
    assert watch.is_ready(ONLOOKER_S)
    assert watch.audience is Audience.ONLOOKERS


def test_a_controller_that_comes_back_settles_anew():
    watch = watch_of((0.0, {CONTROLLER}), (10.0, set()), (11.0, {CONTROLLER}))
    assert not watch.is_ready(11.1)
    assert watch.is_ready(11.3)


def test_another_onlooker_does_not_disturb_the_controller():
    watch = watch_of((0.0, {CONTROLLER}), (1.0, {CONTROLLER, "/echo"}))
    assert watch.is_ready(1.0)


def test_says_who_listens():
    assert watch_of().describe() == "nobody listens"
    assert watch_of((0.0, {CONTROLLER})).describe() == "/position_controller listens"
    assert (
        watch_of((0.0, {"/b", "/a"})).describe() == "only /a, /b listens, not /position_controller"
    )
