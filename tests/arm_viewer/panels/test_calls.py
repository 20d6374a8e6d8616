"""What browsers are told about calls, and the requests that their messages become."""

import pytest
from fake_channel import FakeBrowser, FakeChannel

from arm_viewer.calls.call import Callee, CallKind, CallState, EndCall, OpenForm, PlaceCall
from arm_viewer.calls.form import FieldKind, FormField
from arm_viewer.errors import BrowserMessageError
from arm_viewer.panels.calls import Calls
from arm_viewer.snapshot import Snapshot

STOP = Callee(CallKind.SERVICE, "/stop", "std_srvs/srv/SetBool")
MOVE = Callee(CallKind.ACTION, "/move", "control_msgs/action/FollowJointTrajectory")


class Page:
    """The panel with everything around it."""

    def __init__(self):
        self.channel, self.requests = FakeChannel(), []
        self.panel = Calls(self.channel, self.requests.append)
        self.panel.build(None)
        self.show()

    def show(self, **calls):
        numbered = {int(number.removeprefix("n")): state for number, state in calls.items()}
        self.panel.update(Snapshot(callees=(MOVE, STOP), calls=numbered))


@pytest.fixture
def page():
    return Page()


def place(page, browser, **fields):
    wanted = {"number": 7, "of": "service", "name": "/stop", "typed": {}, "rate_hz": 0} | fields
    page.channel.take("call_place", browser, **wanted)


def test_what_can_be_called_is_listed_once(page):
    page.show()
    listed = [["action", MOVE.name, MOVE.type], ["service", STOP.name, STOP.type]]
    assert page.channel.sent == [("callees", {"callees": listed})]


def test_forms_and_calls_become_requests_with_numbers_of_their_own(page):
    first, second = FakeBrowser(), FakeBrowser()
    page.channel.take("call_form", first, number=7, of="service", name="/stop")
    place(page, second, typed={"data": "true"})
    assert page.requests == [OpenForm(1, STOP), PlaceCall(2, STOP, {"data": "true"}, 0.0)]


def test_each_browser_is_told_of_its_own_call_under_its_own_number(page):
    first, second = FakeBrowser(), FakeBrowser()
    place(page, first)
    place(page, second, number=9)
    page.show(n1=CallState("Sent"), n2=CallState("Done", "a: 1", is_over=True))
    page.show(n1=CallState("Sent"), n2=CallState("Done", "a: 1", is_over=True))
    assert [(t["number"], t["text"], t["over"]) for t in second.told] == [(9, "Done", True)]
    assert {t["number"] for t in first.told} == {7}


def test_a_form_is_sent_with_its_limits_as_text(page):
    browser = FakeBrowser()
    page.channel.take("call_form", browser, number=7, of="service", name="/stop")
    field = FormField("data", "int64", FieldKind.INTEGER, str(2**62), -1, None)
    page.show(n1=CallState("", is_over=True, form=(field,)))
    (sent,) = browser.told[0]["form"]
    assert (sent["text"], sent["least"], sent["most"]) == (str(2**62), "-1", None)


def test_a_browser_ends_its_own_call_and_no_other(page):
    mine, other = FakeBrowser(), FakeBrowser()
    place(page, mine)
    page.channel.take("call_end", other, number=7)
    assert len(page.requests) == 1
    page.channel.take("call_end", mine, number=7)
    assert page.requests[1:] == [EndCall(1)]


def test_what_nobody_watches_any_more_ends_but_a_goal(page):
    browser = FakeBrowser()
    place(page, browser, rate_hz=10)
    place(page, browser, of="action", name="/move")
    browser.is_connected = False
    page.show()
    page.show()
    assert page.requests[2:] == [EndCall(1)]


@pytest.mark.parametrize(
    ("fields", "problem"),
    [
        ({"name": "/none"}, "there is no service /none any more"),
        ({"of": "magic"}, "there is no magic /stop any more"),
        ({"typed": {"data": 1}}, "does not have texts by name"),
        ({"typed": None}, "does not have texts by name"),
        ({"rate_hz": 1e9}, "a rate goes from 0.1 to 100 Hz"),
        ({"rate_hz": -1}, "a rate goes from 0.1 to 100 Hz"),
        ({"number": "7"}, "is not a finite number"),
    ],
)
def test_anything_else_is_refused_with_a_sentence(page, fields, problem):
    with pytest.raises(BrowserMessageError, match=problem):
        place(page, FakeBrowser(), **fields)
    assert not page.requests
