"""From the command line to a figure or a verb; whatever goes wrong is one line."""

import ast
import contextlib
import importlib
import os
import shlex
import sys
import traceback
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

import click
from click.shell_completion import CompletionItem, shell_complete

import lietool
from lietool import figure, paths

TRACEBACK = "LIETOOL_TRACEBACK"
_COMPLETE = "_LIETOOL_COMPLETE"
# Where the name to import is not the one to install.
_PACKAGES = {"PIL": "pillow"}
_TRY = """\
Three things to try:
  lietool slerp           draw a picture, ./slerp.png
  lietool slerp --help    what to look for in it, and what can be changed
  lietool figures list    the pictures of the book; lietool --help lists the commands"""


def main() -> None:
    """Run the command line of this process."""
    sys.excepthook = _report_bug
    _open_closed_streams()
    command.main()


class _Lietool(click.Group):
    """All commands, by the names of their files; a file is imported when its command is used."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return [*figure.names(), *verbs()]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name in verbs():
            return importlib.import_module(f"lietool.verbs.{cmd_name}").command
        if cmd_name not in figure.names():
            return None
        from lietool.verbs import _command

        # Completion needs the options only, and is not worth the import of numpy.
        read = figure.declare if ctx.resilient_parsing else figure.load
        return _command.command(read(cmd_name))

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        name = args[0]
        if not ctx.resilient_parsing and not name.startswith("-") and name not in self.list_commands(ctx):
            plates = figure.plates()
            if name in plates:
                raise click.UsageError(f"{name} is a plate. Write lietool {plates[name]} --plate {name}", ctx)
            hint = figure.nearest(name, [*self.list_commands(ctx), *plates])
            raise click.UsageError(f"no command {name!r}.{hint} lietool --help lists all", ctx)
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        sections: dict[str, list[tuple[str, str]]] = {}
        summaries = figure.summaries()
        for name, file in figure.names().items():
            sections.setdefault(_title(file), []).append((name, summaries[name]))
        sections["More"] = list(_help_lines().items())
        for title, rows in sections.items():
            with formatter.section(title):
                formatter.write_dl(rows)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        rows = figure.summaries() | _help_lines()
        found = [
            CompletionItem(name, help=text) for name, text in rows.items() if name.startswith(incomplete)
        ]
        return found + click.Command.shell_complete(self, ctx, incomplete)

    def main(
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        complete_var: str | None = None,
        standalone_mode: bool = True,
        windows_expand_args: bool = True,
        **extra: Any,
    ) -> Any:
        arguments = list(sys.argv[1:] if args is None else args)
        if instruction := os.environ.get(_COMPLETE):
            try:
                sys.exit(shell_complete(self, {}, "lietool", _COMPLETE, instruction))
            except (OSError, KeyError, ValueError):
                # Nobody asked for a message: there is nothing to complete.
                sys.exit(1)
        sys.exit(self._code(arguments, extra))

    def _code(self, arguments: list[str], extra: dict[str, Any]) -> int:
        """Run a command and return its exit code; an error that is nobody's bug is one line."""
        path = "lietool"
        try:
            with self.make_context("lietool", arguments, **extra) as ctx:
                try:
                    result = self.invoke(ctx)
                finally:
                    path = f"{path} {ctx.invoked_subcommand or ''}".strip()
            sys.stdout.flush()
            return result if isinstance(result, int) else 0
        except click.exceptions.Exit as stop:
            return stop.exit_code
        except SystemExit as stop:
            # Not even one with 0 is a success: whatever should have come after it did not.
            text = f"the figure ended the process, by exit({stop.code!r}). Raise ValueError in it instead"
            return _say(f"{path}: {text}", 1)
        except (click.Abort, KeyboardInterrupt):
            click.echo(err=True)
            return 130
        except BrokenPipeError:
            # Whoever read has seen enough. Python flushes once more at its end: nothing must be left.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return 141
        except click.ClickException as error:
            return _say(_message(error, path), error.exit_code)
        except ModuleNotFoundError as error:
            package = (error.name or "").partition(".")[0]
            if package in ("", "lietool"):
                raise
            wanted = _PACKAGES.get(package, package)
            return _say(f"{path}: {_one_line(error)}. Install it with: pip install {wanted}", 2)
        except OSError as error:
            return _say(
                f"{path}: {error.strerror or error or type(error).__name__}"
                f"{f': {error.filename}' if error.filename else ''}",
                2,
            )
        except ValueError as error:
            return _say(f"{path}: {_one_line(error)}", 2)
        except MemoryError as error:
            why = f" ({_one_line(error)})" if str(error) else ""
            remedy = "Make a smaller picture with --size, or give a smaller file"
            return _say(f"{path}: not enough memory{why}. {remedy}", 2)
        except RuntimeError as error:
            # Only what has been imported can have been raised.
            context = sys.modules.get("lietool.render.context")
            if context is None or not isinstance(error, context.NoRendererError):
                raise
            return _say(str(error), 4)


def verbs() -> dict[str, Path]:
    """Return the verbs and their files, those in ``lietool/verbs``."""
    return {file.stem: file for file in sorted((paths.PACKAGE / "verbs").glob("[a-z]*.py"))}


def _help_lines() -> dict[str, str]:
    """The help line of every verb, from the syntax tree of its file."""
    docstrings = {name: ast.get_docstring(ast.parse(file.read_bytes())) for name, file in verbs().items()}
    return {name: (text or "").partition("\n")[0] for name, text in docstrings.items()}


def _title(file: Path) -> str:
    """The heading of a file's folder: ``ch2`` is Chapter 2."""
    folder = file.parent.name
    return f"Chapter {folder[2:]}" if folder[:2] == "ch" and folder[2:].isdigit() else folder.capitalize()


def _message(error: click.ClickException, path: str) -> str:
    """What click has to say, as one line that begins with the command."""
    if isinstance(error, click.exceptions.NoArgsIsHelpError):
        return error.format_message()
    if not isinstance(error, click.UsageError) or error.ctx is None:
        return f"{path}: {error.format_message()}"
    command = error.ctx.command
    known: list[str] = []
    text = error.format_message()
    if isinstance(error, click.NoSuchOption):
        text = f"no option {error.option_name!r}."
        known = [
            name
            for option in command.get_params(error.ctx)
            for name in (*option.opts, *option.secondary_opts)
        ]
        text += figure.nearest(error.option_name, known)
    elif isinstance(command, click.Group) and text.startswith("No such command"):
        name = text.split("'")[1]
        text = f"no command {name!r}.{figure.nearest(name, command.list_commands(error.ctx))}"
    elif isinstance(error, click.BadArgumentUsage) or "extra argument" in text:
        text += f". See {error.ctx.command_path} --help"
    return f"{error.ctx.command_path}: {_one_line(text)}"


def _one_line(text: object) -> str:
    return " ".join(str(text).split())


def _say(text: str, code: int) -> int:
    if os.environ.get(TRACEBACK) and sys.exc_info()[0] is not None:
        traceback.print_exc()
    # Where nobody can read it, the exit code still says it.
    with contextlib.suppress(OSError):
        click.echo(text, err=True)
    return code


def _open_closed_streams() -> None:
    """Give a process that was started with a closed stream the null device in its place."""
    for name in ("stdin", "stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, Path(os.devnull).open("r+", encoding="utf-8"))  # noqa: SIM115


def _report_bug(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """Say in one line that something unexpected happened: the hook for exceptions that nothing catches."""
    if os.environ.get(TRACEBACK):
        sys.__excepthook__(kind, error, trace)
        return
    frames = traceback.extract_tb(trace)
    place = f" ({Path(frames[-1].filename).name}, line {frames[-1].lineno})" if frames else ""
    # Who knows better than the traceback has left a note.
    if notes := getattr(error, "__notes__", None):
        place = f" ({_one_line(notes[-1])})"
    call = shlex.join(["lietool", *sys.argv[1:]])
    click.echo(
        f"{call}: {_one_line(f'{kind.__name__}: {error}')}{place}. This is a bug in lietool or the figure; "
        f"{TRACEBACK}=1 in the environment shows the traceback: please report it with that.",
        err=True,
    )


def _set_project(ctx: click.Context, param: click.Parameter, value: str | None) -> None:
    if value is not None:
        # In the environment, where spawned workers find it too.
        os.environ[figure.PROJECT] = value


@click.group(cls=_Lietool, invoke_without_command=True, context_settings={"max_content_width": 110})
@click.option(
    "--project",
    type=click.Path(),
    metavar="DIR",
    callback=_set_project,
    is_eager=True,
    expose_value=False,
    help=f"Add the figures in DIR/figures and the goldens in DIR/golden. [environment: {figure.PROJECT}]",
)
@click.version_option(lietool.__version__, prog_name="lietool")
@click.pass_context
def command(ctx: click.Context) -> None:
    """Draw the figures of motion and deformation in computer graphics.

    Every figure is a command: bare, it draws the picture of the book; its options change what is drawn.
    """
    if ctx.invoked_subcommand is None:
        click.echo(_TRY)
