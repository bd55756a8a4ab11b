"""The history that a golden carries: one entry longer at each accept, whatever was there before."""

import json

import pytest

from lietool.golden import history

NOW = {"date": "2026-11-23T00:00:00Z", "commit": "abc", "reason": "looked at", "plate": "T1"}


def test_a_new_golden_begins_it():
    text = history.extended({}, NOW, "new")
    assert history.read({history.KEY: text, **NOW}) == (
        history.Change("2026-11-23T00:00:00Z", "abc", "looked at", "new"),
    )


def test_a_golden_older_than_histories_has_one_entry():
    assert history.read(NOW) == (history.Change("2026-11-23T00:00:00Z", "abc", "looked at"),)
    assert history.read({"plate": "T1"}) == ()
    later = history.extended(NOW, NOW | {"reason": "naïve – ξ"}, "3 px changed")
    assert [change.reason for change in history.read({history.KEY: later})] == ["looked at", "naïve – ξ"]


@pytest.mark.parametrize("damaged", ["", "{", "3", "[3]", "null", '"abc"'])
def test_one_that_cannot_be_read_is_begun_anew(damaged):
    past = history.read(NOW | {history.KEY: damaged})
    assert past == history.read(NOW)
    assert len(json.loads(history.extended(NOW | {history.KEY: damaged}, NOW, "new"))) == 2


def test_what_others_add_to_an_entry_does_no_harm():
    text = json.dumps([{"reason": " two\n lines", "by": "somebody", "date": 3}])
    assert history.read({history.KEY: text}) == (history.Change("3", "unknown", "two lines"),)


def test_a_long_change_is_cut():
    (change,) = history.read({history.KEY: history.extended({}, NOW, "numbers " * 1000)})
    assert len(change.what) < 410 and change.what.endswith("numbers …")
