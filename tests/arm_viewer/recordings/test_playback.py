"""The position in a recording."""

from arm_viewer.recordings.playback import MAX_SPEED, Playback


def test_it_stands_until_it_plays():
    playback = Playback(10.0)
    playback.advance(1.0)
    assert playback.time_s == 0.0
    playback.play()
    playback.advance(1.5)
    assert playback.time_s == 1.5
    playback.pause()
    playback.advance(1.0)
    assert playback.time_s == 1.5


def test_speed_is_recorded_seconds_a_second():
    playback = Playback(10.0, is_playing=True)
    playback.set_speed(0.5)
    playback.advance(2.0)
    assert playback.time_s == 1.0
    playback.set_speed(1e9)
    assert playback.speed == MAX_SPEED


def test_it_stops_at_the_end_and_plays_again_from_the_beginning():
    playback = Playback(10.0, time_s=9.0, is_playing=True)
    playback.advance(5.0)
    assert (playback.time_s, playback.is_playing) == (10.0, False)
    playback.play()
    assert (playback.time_s, playback.is_playing) == (0.0, True)


def test_no_place_is_outside_the_recording():
    playback = Playback(10.0)
    playback.seek(99.0)
    assert playback.time_s == 10.0
    playback.seek(-1.0)
    assert playback.time_s == 0.0


def test_a_recording_of_one_moment_does_not_play():
    playback = Playback(0.0)
    playback.play()
    assert not playback.is_playing


def test_what_is_not_open_yet_is_not_reached_and_playing_waits_for_it():
    playback = Playback(10.0, open_s=2.0, grows=True)
    playback.seek(9.0)
    assert playback.time_s == 2.0
    playback.play()
    playback.advance(1.0)
    assert (playback.time_s, playback.is_playing) == (2.0, True)
    playback.open_s = 5.0
    playback.advance(1.0)
    assert playback.time_s == 3.0


def test_playing_ends_where_nothing_more_will_come():
    playback = Playback(10.0, 1.0, True, open_s=2.0)
    playback.advance(5.0)
    assert (playback.time_s, playback.is_playing) == (2.0, False)
    playback.play()
    assert playback.time_s == 0.0
