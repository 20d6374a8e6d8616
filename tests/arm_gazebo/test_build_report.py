import logging

from arm_gazebo.build_report import BuildReport


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
