"""The workflow files: they are YAML, ask for nothing they need not, and run commands that there are."""

import re
import shlex
import subprocess
from pathlib import Path

import pytest
from click.testing import CliRunner

from lietool import figure
from lietool.cli import command

yaml = pytest.importorskip("yaml", reason="`./run test` installs it")

ROOT = Path(__file__).parent.parent
EXAMPLE = ROOT / "examples" / "ci" / "golden.yml"
FILES = [EXAMPLE, *sorted((ROOT / ".github" / "workflows").glob("*.yml"))]


def read(path):
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def steps(path):
    return [step for job in read(path)["jobs"].values() for step in job["steps"]]


def lines(path):
    return [line for step in steps(path) for line in step.get("run", "").splitlines()]


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
class TestEvery:
    def test_it_has_what_a_workflow_needs(self, path):
        found = read(path)
        # YAML 1.1 takes `on` for a truth value; those who run workflows do not.
        assert set(found[True]) == {"push", "pull_request"}
        assert found["name"] and found["permissions"] == {"contents": "read"}
        for job in found["jobs"].values():
            assert job["runs-on"] and job["timeout-minutes"] and job["container"]

    def test_each_step_does_one_thing(self, path):
        for step in steps(path):
            assert ("run" in step) != ("uses" in step), step
            if "uses" in step:
                assert re.fullmatch(r"actions/[\w-]+@v\d+", step["uses"])
            else:
                subprocess.run(["sh", "-n", "-c", step["run"]], check=True, timeout=20)

    def test_no_key_is_there_twice(self, path):
        """YAML lets the second one win."""

        def check(node):
            if isinstance(node, yaml.MappingNode):
                keys = [key.value for key, _ in node.value]
                assert len(keys) == len(set(keys)), keys
                for _, value in node.value:
                    check(value)
            elif isinstance(node, yaml.SequenceNode):
                for value in node.value:
                    check(value)

        check(yaml.compose(path.read_text(encoding="utf-8")))


class TestExample:
    def test_its_commands_are_understood(self, monkeypatch, tmp_path):
        monkeypatch.setenv(figure.PROJECT, "")
        monkeypatch.chdir(tmp_path)
        (tmp_path / "figures").mkdir()
        ours = [shlex.split(line) for line in lines(EXAMPLE) if line.startswith("lietool ")]
        assert [words[-1] for words in ours] and any("--project" in words for words in ours)
        for words in ours:
            result = CliRunner().invoke(command, [*words[1:], "--help"])
            assert result.exit_code == 0, (words, result.output)

    def test_the_report_is_the_artifact_of_every_run(self):
        (upload,) = [step for step in steps(EXAMPLE) if "upload-artifact" in step.get("uses", "")]
        assert upload["if"] == "${{ !cancelled() }}"
        assert any(line.endswith(f"-o {upload['with']['path']} --jobs 2") for line in lines(EXAMPLE))

    def test_it_installs_the_renderer_that_run_installs(self):
        (wanted,) = [line for line in lines(EXAMPLE) if line.startswith("apt-get install")]
        run = (ROOT / "run").read_text(encoding="utf-8")
        egl = re.search(r"egl='(.+)'", run)
        assert egl and "apt_install libosmesa6 $egl" in run
        assert wanted.split()[-3:] == ["libosmesa6", *egl[1].split()]

    def test_the_readme_names_it(self):
        assert "](examples/ci/golden.yml)" in (ROOT / "README.md").read_text(encoding="utf-8")
