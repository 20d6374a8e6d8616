"""`arm doctor` beside a simulation with an impossible real-time factor."""

from arm_cli.doctor.diagnosis import Severity

CHECK = "real-time factor"


def test_a_low_real_time_factor_is_reported(launch, look):
    launch("camera:=none", "real_time_factor:=100000").wait_until_ready()
    finding = look(lambda found: found[CHECK].severity is Severity.WARNING)[CHECK]
    assert " instead of 100000: the machine is too slow or too busy" in finding.sentence
    assert "end other programs" in finding.fix
