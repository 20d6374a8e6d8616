"""A silence is told once."""

from arm_controller.silence_watch import PATIENCE_S, SilenceWatch


def test_a_long_silence_is_noticed_once():
    watch = SilenceWatch(now_s=100.0)
    assert not watch.notices(100.0 + PATIENCE_S - 0.1)
    assert watch.notices(100.0 + PATIENCE_S)
    assert not watch.notices(200.0)


def test_every_message_starts_the_wait_anew():
    watch = SilenceWatch(now_s=0.0)
    watch.hear(4.0)
    assert not watch.notices(4.0 + PATIENCE_S - 0.1)


def test_the_next_silence_is_noticed_again():
    watch = SilenceWatch(now_s=0.0)
    assert watch.notices(10.0)
    watch.hear(11.0)
    assert watch.notices(11.0 + PATIENCE_S)
