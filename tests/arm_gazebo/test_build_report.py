import logging

from arm_gazebo.build_report import BuildReport, shown


def test_findings_are_sentences_with_their_line():
    report = BuildReport()
    report.warn("link 'wrist'", "it has no inertia", 12)
    report.inform("link 'foot'", "something")
    assert [str(finding) for finding in report.findings] == [
        "link 'wrist' (line 12): it has no inertia",
        "link 'foot': something",
    ]
    assert report.warnings == report.findings[:1]


def test_report_is_logged_by_severity(caplog):
    report = BuildReport()
    report.warn("a", "b")
    report.inform("c", "d")
    with caplog.at_level(logging.INFO):
        report.log(logging.getLogger("test"))
    assert [record.levelname for record in caplog.records] == ["WARNING", "INFO"]


def test_many_findings_alike_are_shown_as_one_in_the_place_of_the_first(caplog):
    report = BuildReport()
    report.repair("link 'base'", "its mass is negative", 3)
    for number in range(24):
        report.repair(f"link 'finger{number}'", "it has no inertia", 10 + number)
    report.repair("joint 'wrist'", "it has no inertia", 50)
    report.warn("link 'thumb'", "it has no inertia", 60)

    lines = [
        "link 'base' (line 3): its mass is negative",
        "link 'finger0' and 23 more (line 10): it has no inertia",
        "joint 'wrist' (line 50): it has no inertia",
        "link 'thumb' (line 60): it has no inertia",
    ]
    assert [str(finding) for finding in shown(report.findings)] == lines
    assert [finding.count for finding in shown(report.findings)] == [1, 24, 1, 1]
    report.log(logging.getLogger("test"))
    assert [record.getMessage() for record in caplog.records] == lines
    assert len(report.findings) == 27


def test_few_findings_alike_name_each_element():
    report = BuildReport()
    for name in ("left", "middle", "right"):
        report.warn(f"link '{name}'", "it has no inertia")
    assert tuple(shown(report.findings)) == report.findings
