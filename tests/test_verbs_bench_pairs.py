"""The table of homotopies and energies: it has every one, and says what the plates claim."""

import json
from itertools import product

import pytest
from click.testing import CliRunner

from lietool.cli import command
from lietool.verbs import _bench_pairs
from lietool.verbs._bench_pairs import Row

HOMOTOPIES = ("logexp", "arap", "linear")
ENERGIES = ("frobenius", "point", "similarity", "point-similarity", "balanced", "symmetric")


@pytest.fixture(scope="module")
def rows() -> dict[tuple[str, ...], Row]:
    """All of fish and cat, as a program reads them."""
    call = ["bench", "pairs", "--pair", "fish", "--pair", "cat", "--json"]
    found = json.loads(CliRunner().invoke(command, call).stdout)
    assert found["angles"] == "consistent"
    made = [Row(**row) for row in found["rows"]]
    return {(row.pair, row.constraint, row.homotopy, row.energy): row for row in made}


def test_every_combination_is_there_once(rows):
    assert list(rows) == list(product(("fish", "cat"), ("line", "loci"), HOMOTOPIES, ENERGIES))


@pytest.mark.parametrize("homotopy", ["logexp", "arap"])
@pytest.mark.parametrize("pair", ["fish", "cat"])
class TestRotationAndStretchApart:
    def test_without_contradiction_nothing_flips(self, rows, pair, homotopy):
        found = [rows[pair, "line", homotopy, energy] for energy in ENERGIES]
        assert all(row.flipped == 0 and row.least_det > 0.1 for row in found)

    def test_up_to_similarity_contradictions_are_followed(self, rows, pair, homotopy):
        for energy in ("similarity", "point-similarity"):
            row = rows[pair, "loci", homotopy, energy]
            assert row.flipped == 0 and row.least_det > 0.1 and row.most_energy < 1e-3

    def test_others_flip(self, rows, pair, homotopy):
        for energy in ("frobenius", "point", "balanced", "symmetric"):
            row = rows[pair, "loci", homotopy, energy]
            assert row.flipped > 50 and row.least_det < -0.5
        # Points give up small triangles.
        least = [rows[pair, "loci", homotopy, energy].least_det for energy in ("point", "frobenius")]
        assert least[0] < least[1]


def test_a_straight_line_needs_no_energy_and_flips(rows):
    for pair, energy in product(("fish", "cat"), ENERGIES):
        row = rows[pair, "line", "linear", energy]
        assert row.flipped > 0 and row.most_energy < 1e-14


def test_it_agrees_with_the_plates(plate):
    for plate_id, energy in (("B6.5", "frobenius"), ("B6.7", "similarity")):
        shown, row = plate(plate_id).numbers, _bench_pairs.measure("fish", "loci", "logexp", energy)
        assert row.flipped == shown["flipped"].max() and row.least_det == shown["least_det"].min()
        assert row.most_energy == shown["energy"].max()
        assert row.flipped == 0 or shown["flipped"][round(40 * row.at)] == row.flipped


def test_with_principal_angles_the_snake_breaks():
    broken, fine = (
        _bench_pairs.measure("snake", "line", "logexp", energy, angles="principal")
        for energy in ("frobenius", "similarity")
    )
    assert broken.flipped >= 3 and broken.least_det < -0.2
    assert fine.flipped == 0 and fine.least_det > 0.3


def test_the_table_for_a_reader():
    call = ["bench", "pairs", "--pair", "fish", "--constraint", "loci"]
    lines = CliRunner().invoke(command, call).stdout.splitlines()
    assert len(lines) == 1 + len(HOMOTOPIES) * len(ENERGIES)
    assert lines[0].split()[:5] == ["pair", "constraint", "homotopy", "energy", "flipped"]
    (line,) = [line for line in lines if line.split()[2:4] == ["A^E", "E^R"]]
    assert "none" in line
    assert all(" of 459 " in line for line in lines if line.split()[2:4] == ["A^E", "E^F"])


def test_what_there_is_to_choose_is_what_the_figure_has():
    assert _bench_pairs.choices("homotopy") == HOMOTOPIES
    assert _bench_pairs.choices("energy") == ENERGIES
    assert set(_bench_pairs.SHAPES) < set(_bench_pairs.choices("example"))
    assert set(_bench_pairs.CONSTRAINTS) == set(_bench_pairs.choices("constraint"))
    assert set(_bench_pairs.NAMES) == {*HOMOTOPIES, *ENERGIES}
