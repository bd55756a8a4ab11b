"""The table of comparisons: on toy pictures, with those peers that are installed here."""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

from lietool.bench import peers, rules
from lietool.cli import command
from lietool.golden import compare, place
from lietool.verbs import _peers_run, _peers_table
from lietool.verbs._peers_pictures import Picture
from lietool.verbs._studio import Item

SIZE = (60, 80)


class Toy(Item):
    """A plate whose golden lies where a test has put it."""

    @property
    def place(self):
        return place.Place(FOLDER[0], "", self.id)


FOLDER = []


@pytest.fixture
def toy(tmp_path, monkeypatch):
    """A golden of stripes, and a function that makes a picture of it."""
    golden = np.full((*SIZE, 3), 255, np.uint8)
    golden[:, ::10] = 40
    monkeypatch.setattr(_peers_run, "_golden", lambda item: golden)
    FOLDER[:] = [tmp_path]
    Image.fromarray(golden).save(tmp_path / "T1.png")
    item = Toy("T1", "toy")

    def made(of, image):
        file = tmp_path / f"{of}.png"
        Image.fromarray(image).save(file)
        return Picture(of, item, file)

    made.golden, made.folder = golden, tmp_path
    return made


def changed(golden, *, pixels=0, by=0):
    image = golden.astype(int)
    image[20 : 20 + pixels, 31:34] = 240
    return np.clip(image + by, 0, 255).astype(np.uint8)


def pair(toy, image):
    return _peers_run._pair(toy("asked", image))


def judged(toy, *, npm=None, with_rules=False):
    golden = toy.golden
    wrong = [toy("bar", changed(golden, pixels=20)), toy("paler", changed(golden, by=-4))]
    wrong.append(toy("speck", changed(golden, pixels=1)))
    noise = [toy("same", golden), toy("one level", changed(golden, by=-1))]
    with peers.peers(npm or toy.folder) as found:
        those = [_peers_run.ours(), *found]
        return _peers_run.measured(those, wrong, noise, toy.folder, with_rules=with_rules, jobs=1)


def test_mistakes_and_noise_are_counted_and_what_is_missed_is_named(toy, capsys):
    about = judged(toy, with_rules=True) | {"unknown": ["so3.exp: new"]}
    json.dumps(about)
    assert (about["mistakes"], about["noise"], about["noise_differing"]) == (3, 2, 1)
    ours = about["results"][0]
    assert ours["name"] == "lietool" and ours["missed"] == ("speck",) and ours["alarms"] == ()
    assert ours["caught"] == ("bar", "paler") and 0 < ours["seconds_equal"] < ours["seconds_everywhere"]
    assert about["noise_use"]["9x9 mean"] == pytest.approx(1 / 1.5) and about["noise_use"]["in all"] == 0
    least = about["mistakes_use"][0]
    assert least["name"] == "speck" and least["use"] == 3 / compare.PIXELS
    _peers_table.show(about)
    shown = capsys.readouterr().out
    assert "lietool misses speck" in shown and "2 of 3" in shown and "so3.exp: new" in shown
    assert "pixelmatch is not installed: npm install pixelmatch" in shown


def test_what_is_not_installed_has_no_numbers(toy):
    missing = [result for result in judged(toy)["results"] if not result["version"]]
    assert {"pixelmatch", "odiff"} <= {result["name"] for result in missing}
    assert all(result["seconds_equal"] is None and "install" in result["install"] for result in missing)


@pytest.mark.parametrize("name", ["pytest-mpl", "pytest-regressions", "scikit-image SSIM"])
def test_a_peer_of_python_tells_equal_from_different(toy, name):
    with peers.peers(toy.folder) as found:
        (peer,) = (peer for peer in found if peer.name == name)
        if peer.judge is None:
            pytest.skip(f"{name} is not installed")
        assert not peer.judge(pair(toy, toy.golden)).differs
        answer = peer.judge(pair(toy, changed(toy.golden, pixels=30)))
    assert answer.differs and answer.seconds > 0


def test_a_program_that_does_not_work_is_named(toy):
    program = toy.folder / "node_modules" / "@odiff" / "here" / "odiff"
    package = toy.folder / "node_modules" / "odiff-bin" / "package.json"
    for file, text in ((program, "no program"), (package, '{"version": "9.9"}')):
        file.parent.mkdir(parents=True)
        file.write_text(text)
    with pytest.raises(peers.PeerError, match=r"odiff 9\.9 does not work"):
        judged(toy)


def test_rules_are_judged_like_our_own_comparison():
    chance = np.random.default_rng(3)
    expected = np.full((90, 120, 3), 200, np.uint8)
    actual = expected.copy()
    for _ in range(60):
        actual[chance.integers(90), chance.integers(120)] -= np.uint8(chance.integers(1, 30))
    found = compare.images(expected, actual)
    y, x = np.nonzero(compare.differing(expected, actual))
    far = compare.delta_e76(expected[y, x], actual[y, x])
    asked = rules.neighbours(_peers_run.OWN)
    one = rules.measure(x, y, far, abs(found.lowpass), (120, 90), asked)
    own = _peers_run.OWN
    assert one.crowd[own.delta_e, own.near] == found.crowd and one.over[own.delta_e] == found.over
    assert (one.use(own) <= 1.0) == found.passes
    stricter, looser = rules.Rule(1, 16, 1, 1.0, 0.5), rules.Rule(10**6, 16, 10**6, 4.0, 100.0)
    strict, loose = (rules.standing(rule, {"a": [one]}, [one]) for rule in (stricter, looser))
    assert (strict.missed, strict.alarms) == ((), 1) and (loose.missed, loose.alarms) == (("a",), 0)
    clean = rules.standing(looser, {}, [])
    assert clean.better(strict) and clean.better(loose) and not strict.better(loose)


def test_no_such_mistake_and_no_such_plate_are_one_line():
    for call in (["--mutant", "nothing"], ["--plate", "nothing"]):
        done = CliRunner().invoke(command, ["bench", "peers", *call])
        assert done.exit_code == 2 and "nothing" in done.output and "Traceback" not in done.output
