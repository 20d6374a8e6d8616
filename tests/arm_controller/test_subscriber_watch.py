"""A one-shot command waits for its addressee."""

from arm_controller.subscriber_watch import OTHERS_WAIT_S, SETTLE_S, Subscribers, SubscriberWatch

CONTROLLER = "/position_controller"


def watch_of(*observations: tuple[float, set[str]]) -> SubscriberWatch:
    watch = SubscriberWatch(CONTROLLER, now_s=0.0)
    for now_s, listeners in observations:
        watch.observe(listeners, now_s)
    return watch


def test_it_is_never_ready_without_a_subscriber():
    watch = watch_of((0.0, set()), (100.0, set()))
    assert not watch.is_ready(100.0)
    assert watch.unchanged_s(100.0) == 100.0


def test_the_controller_is_ready_once_the_match_has_settled():
    watch = watch_of((1.0, {CONTROLLER}))
    assert not watch.is_ready(1.0 + SETTLE_S - 0.01)
    assert watch.is_ready(1.0 + SETTLE_S + 0.01)


def test_another_subscriber_does_not_use_up_the_command_while_the_controller_starts():
    watch = watch_of((0.0, {"/recorder"}))
    assert not watch.is_ready(OTHERS_WAIT_S - 0.01)
    watch.observe({"/recorder", CONTROLLER}, 3.0)
    assert not watch.is_ready(3.0)
    assert watch.is_ready(3.0 + SETTLE_S + 0.01)


def test_a_lone_listener_of_another_name_gets_the_command_in_the_end():
    watch = watch_of((0.0, {"/my_driver"}))
    assert watch.is_ready(OTHERS_WAIT_S)
    assert watch.subscribers is Subscribers.OTHERS


def test_a_controller_that_returns_needs_the_settling_time_again():
    watch = watch_of((0.0, {CONTROLLER}), (10.0, set()), (11.0, {CONTROLLER}))
    assert not watch.is_ready(11.1)
    assert watch.is_ready(11.3)


def test_another_subscriber_does_not_disturb_the_controller():
    watch = watch_of((0.0, {CONTROLLER}), (1.0, {CONTROLLER, "/echo"}))
    assert watch.is_ready(1.0)


def test_says_who_subscribes():
    assert watch_of().describe() == "nobody listens"
    assert watch_of((0.0, {CONTROLLER})).describe() == "/position_controller listens"
    assert (
        watch_of((0.0, {"/b", "/a"})).describe() == "only /a, /b listen, not /position_controller"
    )
