"""The README tells the truth: its commands, its example, its pictures, its tables."""

import re
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner

from lietool import figure
from lietool.cli import command
from lietool.deform import probe_io

ROOT = Path(__file__).parent.parent
TEXT = (ROOT / "README.md").read_text()


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", TEXT, re.S)


def commands() -> list[list[str]]:
    lines = [line for block in blocks("sh") for line in block.splitlines()]
    return [shlex.split(line, comments=True)[1:] for line in lines if line.startswith("lietool ")]


def test_there_are_commands_to_test():
    assert len(commands()) > 8


@pytest.mark.parametrize("words", commands(), ids=" ".join)
def test_every_command_is_understood(words: list[str]):
    """Asking for help stops before anything is drawn, but only after every word has been parsed."""
    result = CliRunner().invoke(command, [*words, "--help"])
    assert result.exit_code == 0, result.output
    for option in (word for word in words if word.startswith("--")):
        assert option in result.output


def test_the_example_is_a_figure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    (example,) = blocks("python")
    (tmp_path / "figures").mkdir()
    (tmp_path / "figures" / "turn.py").write_text(example)
    monkeypatch.setenv(figure.PROJECT, str(tmp_path))
    result = CliRunner().invoke(command, ["turn", "--theta", "90", "--json"])
    assert result.exit_code == 0, result.output
    assert '"rotation"' in result.output


def test_the_file_of_probes_is_one(tmp_path: Path):
    (example,) = blocks("toml")
    (tmp_path / "p.toml").write_text(example)
    probes = probe_io.read(tmp_path / "p.toml")
    assert len(probes.names) == 2 and example.count("[[probe]]") == 2


def test_its_pictures_are_goldens():
    pictures = re.findall(r"!\[(.+?)\]\((.+?)\)", TEXT)
    assert len(pictures) >= 3
    for alternative, path in pictures:
        assert len(alternative) > 20
        assert path.startswith("golden/")
        assert (ROOT / path).is_file(), path


def test_links_lead_somewhere():
    for target in re.findall(r"(?<!!)\[[^]]+\]\(([^)#]+)\)", TEXT):
        assert (ROOT / target).exists(), target


def test_every_variable_is_used_and_every_used_one_is_told():
    told = set(re.findall(r"^\| `(LIETOOL_\w+)`", TEXT, re.M))
    files = [*(ROOT / "lietool").rglob("*.py"), *(ROOT / "tests").rglob("*.py")]
    used = {name for file in files for name in re.findall(r"[\"'](LIETOOL_\w+)[\"']", file.read_text())}
    assert told == used
