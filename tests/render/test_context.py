"""The one context: where it comes from, what it survives, and what it says when it cannot be had."""

import ctypes
import multiprocessing
import os
import pickle
import subprocess
import sys
import threading
from pathlib import Path
from typing import NoReturn

import pytest

from lietool import cache
from lietool.render import advice, context, egl, libraries, mesa, osmesa, probe


def rendered(backend: str | None = None, **env: str) -> dict:
    """Return what a fresh process finds; NoRendererError, and so a skip, where the library is missing."""
    found = probe.run(backend, env)
    if "error" in found:
        raise context.NoRendererError({backend or "any": found["error"]})
    return found


def python(code: str, **env: str) -> str:
    """Return what `code` prints in a fresh process that must end well."""
    rendered()
    done = subprocess.run([sys.executable, "-c", code], env=os.environ | env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture
def bare(monkeypatch):
    """A process without a context, with nothing about backends in its environment."""
    monkeypatch.setattr(context, "_context", None)
    for name in (context.ENVIRONMENT, "LP_NATIVE_VECTOR_WIDTH", "MESA_SHADER_CACHE_DIR", "EGL_LOG_LEVEL"):
        monkeypatch.delenv(name, raising=False)


def no_library(name: str) -> NoReturn:
    raise OSError(f"{name}: cannot open shared object file: No such file or directory")


def missing(*_: object, **__: object) -> None:
    raise OSError("not on this machine")


class TestBackends:
    def test_osmesa_and_egl_draw_the_same_pixels(self):
        by_osmesa, by_egl = rendered("osmesa"), rendered("egl")
        assert by_osmesa["canonical"] and by_egl["canonical"]
        assert (by_osmesa["backend"], by_egl["backend"]) == ("osmesa", "egl")
        assert by_osmesa["picture"] == by_egl["picture"]

    def test_a_surfaceless_display_draws_the_same_pixels(self):
        reference = rendered("egl")
        code = (
            "from lietool.render import context, egl, probe; import hashlib; "
            "egl.Library.devices = lambda self, software: iter(()); c = context.get('egl'); "
            "print(c.canonical, hashlib.sha256(probe.picture(c.gl)).hexdigest())"
        )
        assert python(code).split() == ["True", reference["picture"]]

    def test_pixels_do_not_depend_on_threads(self):
        pictures = {count: rendered(LP_NUM_THREADS=count)["picture"] for count in ("0", "1", "2")}
        assert len(set(pictures.values())) == 1

    def test_info_tells_what_draws_and_from_where(self):
        info = rendered("osmesa")
        assert info["renderer"].startswith("llvmpipe") and info["mesa"] in info["version"]
        assert info["llvm"] in info["renderer"] and str(info["bits"]) in info["renderer"]
        assert any("OSMesa" in path for path in info["libraries"]) and all(
            map(os.path.exists, info["libraries"])
        )
        assert info["skipped"] == {} and info["notes"] == []

    def test_softpipe_is_not_canonical(self):
        found = rendered(GALLIUM_DRIVER="softpipe")
        assert found["renderer"] == "softpipe" and not found["canonical"]

    def test_the_environment_chooses(self):
        rendered("egl")
        assert rendered(LIETOOL_BACKEND="egl")["backend"] == "egl"

    def test_egl_follows_osmesa_and_says_why(self, bare, monkeypatch):
        rendered("egl")
        code = (
            "from lietool.render import context, osmesa\n"
            "def missing(): raise OSError('not here')\n"
            "osmesa.load = missing; c = context.get(); print(c.backend, c.info['skipped'])"
        )
        assert python(code).strip() == "egl {'osmesa': 'not here'}"

    def test_an_unknown_backend_is_named(self, bare, monkeypatch):
        with pytest.raises(
            ValueError, match=r"backend must be one of osmesa, egl, gpu, system; got 'vulkan'"
        ):
            context.get("vulkan")
        monkeypatch.setenv(context.ENVIRONMENT, "vulkan")
        with pytest.raises(ValueError, match=r"LIETOOL_BACKEND must be one of .*; got 'vulkan'"):
            context.get()


class TestNothingToRenderWith:
    def test_one_line_and_the_commands(self, bare, monkeypatch):
        monkeypatch.setattr(osmesa, "load", missing)
        monkeypatch.setattr(egl, "load", missing)
        monkeypatch.setattr(sys, "platform", "linux")
        with pytest.raises(context.NoRendererError) as caught:
            context.get()
        first, *rest = str(caught.value).splitlines()
        assert "osmesa: not on this machine; egl: not on this machine" in first
        assert [line.split()[0] for line in rest[1:]] == list(advice.commands())
        assert caught.value.tried.keys() == {"osmesa", "egl"}

    def test_it_travels_between_processes(self):
        error = context.NoRendererError({"osmesa": "none"})
        assert str(pickle.loads(pickle.dumps(error))) == str(error)

    def test_the_system_is_asked_last_and_never_on_linux(self, monkeypatch):
        monkeypatch.delenv(context.ENVIRONMENT, raising=False)
        for platform, last in (("linux", "egl"), ("darwin", "system"), ("win32", "system")):
            monkeypatch.setattr(sys, "platform", platform)
            assert context._order(None)[-1] == last

    def test_libraries_say_what_they_miss(self):
        with pytest.raises(OSError, match=r"libOSMesa.so.8"):
            osmesa.load([], no_library)
        with pytest.raises(OSError, match=r"libEGL.so.1"):
            egl.Library([], no_library)

    def test_an_egl_that_cannot_list_devices_is_asked_for_a_display_on_none(self, monkeypatch):
        def devices(self: egl.Library, software: bool):
            raise OSError("libEGL has no eglQueryDevicesEXT")

        def no_display(self: egl.Library, device: int | None):
            raise OSError(f"no display on {device}")

        monkeypatch.setattr(egl.Library, "devices", devices)
        monkeypatch.setattr(egl.Library, "display", no_display)
        library = object.__new__(egl.Library)
        library.call = None  # type: ignore[assignment]
        with pytest.raises(OSError, match=r"^libEGL has no eglQueryDevicesEXT; no display on None$"):
            egl._first(library, software=True)

    @pytest.mark.parametrize(
        ("fields", "first"),
        [
            ('ID=debian\nPRETTY_NAME="Debian GNU/Linux 12"', "apt"),
            ("ID=linuxmint\nID_LIKE='ubuntu debian'", "apt"),
            ("ID=fedora", "dnf"),
            ('ID="rocky"\nID_LIKE="rhel centos fedora"', "dnf"),
            ("# comment = no\nID=manjaro\nID_LIKE=arch", "pacman"),
            ("ID=somethingelse", "apt"),
        ],
    )
    def test_this_distribution_comes_first(self, tmp_path, fields, first):
        file = tmp_path / "os-release"
        file.write_text(fields)
        commands = advice.commands(advice.distribution(file))
        assert next(iter(commands)) == first and set(commands) == {"apt", "dnf", "pacman"}
        assert advice.distribution(tmp_path / "none") == {}


class TestPrivateLibraries:
    """Packages unpacked without root: the linker finds none of their dependencies by itself."""

    def opener(self, folder: Path, needs: dict[str, list[str]], opened: list[str]):
        def open_library(name: str) -> ctypes.CDLL:
            path = Path(name)
            if path.parent != folder:
                no_library(name)
            for need in needs[path.name]:
                if need not in opened:
                    no_library(need)
            opened.append(path.name)
            return ctypes.CDLL(None)

        return open_library

    def test_dependencies_are_loaded_first(self, tmp_path):
        needs = {
            "libOSMesa.so.8": ["libglapi.so.0", "libLLVM-15.so.1"],
            "libLLVM-15.so.1": ["libedit.so.2", "libstdc++.so.6"],
            **{name: [] for name in ("libglapi.so.0", "libedit.so.2", "libstdc++.so.6", "libunused.so.1")},
        }
        for name in needs:
            (tmp_path / name).touch()
        opened: list[str] = []
        osmesa.load([tmp_path], self.opener(tmp_path, needs, opened))
        assert opened == [
            "libglapi.so.0",
            "libedit.so.2",
            "libstdc++.so.6",
            "libLLVM-15.so.1",
            "libOSMesa.so.8",
        ]

    def test_what_is_nowhere_is_named(self, tmp_path):
        (tmp_path / "libOSMesa.so.8").touch()
        opener = self.opener(tmp_path, {"libOSMesa.so.8": ["libglapi.so.0"]}, [])
        with pytest.raises(OSError, match=r"libglapi.so.0"):
            osmesa.load([tmp_path], opener)

    def test_a_library_that_never_loads_ends_the_search(self, tmp_path):
        for name in ("libOSMesa.so.8", "libglapi.so.0"):
            (tmp_path / name).touch()
        opener = self.opener(
            tmp_path, {"libOSMesa.so.8": ["libglapi.so.0"], "libglapi.so.0": ["libglapi.so.0"]}, []
        )
        with pytest.raises(OSError, match=r"libglapi.so.0"):
            osmesa.load([tmp_path], opener)

    def test_libegl_is_told_where_an_unpacked_mesa_lies(self, tmp_path, monkeypatch):
        folder = tmp_path / "usr/lib/x86_64-linux-gnu"
        (folder / "dri").mkdir(parents=True)
        monkeypatch.setattr(libraries, "private_folders", lambda: [folder])
        monkeypatch.setenv("LIBGL_DRIVERS_PATH", "the user's")
        assert egl._private_mesa() == {}
        loaded: list[str] = []
        monkeypatch.setattr(libraries, "load", lambda names, folders: loaded.extend(names))
        (folder / "libEGL_mesa.so.0").touch()
        (folder / "dri" / "swrast_dri.so").touch()
        vendors = tmp_path / "usr/share/glvnd/egl_vendor.d"
        assert egl._private_mesa() == {"__EGL_VENDOR_LIBRARY_DIRS": str(vendors)}
        assert loaded == ["libEGL_mesa.so.0", "swrast_dri.so"]

    def test_they_lie_beside_the_interpreter(self, tmp_path, monkeypatch):
        monkeypatch.setattr(sys, "prefix", str(tmp_path))
        assert libraries.private_folders() == []
        folders = [tmp_path / "sys" / "usr/lib/x86_64-linux-gnu", tmp_path / "sys" / "lib/x86_64-linux-gnu"]
        for folder in folders:
            folder.mkdir(parents=True)
        assert libraries.private_folders()[:2] == folders


class TestOneContext:
    def test_the_same_at_every_call(self):
        rendered()
        first = context.get()
        assert context.get() is first and context.get(first.backend) is first
        with pytest.raises(ValueError, match=r"Start another process"):
            context.get("gpu")

    def test_it_is_made_current_again(self):
        rendered("osmesa")
        code = (
            "from lietool.render import context, osmesa, probe; c = context.get('osmesa')\n"
            "before = probe.picture(c.gl); other = osmesa.Loader(osmesa.load())\n"
            "print(probe.picture(c.gl) == before)"
        )
        assert python(code).strip() == "True"

    def test_another_thread_is_refused(self):
        rendered()
        context.get()
        caught: list[BaseException] = []

        def work() -> None:
            try:
                context.get()
            except RuntimeError as error:
                caught.append(error)

        worker = threading.Thread(target=work)
        worker.start()
        worker.join()
        assert len(caught) == 1 and "another thread" in str(caught[0])

    @pytest.mark.skipif(not hasattr(os, "fork"), reason="the system has no fork")
    def test_a_fork_is_refused_instead_of_hanging(self):
        code = (
            "import multiprocessing; from lietool.render import context\n"
            "def work(queue):\n"
            "    try: context.get()\n"
            "    except RuntimeError as error: queue.put(str(error))\n"
            "context.get(); fork = multiprocessing.get_context('fork'); queue = fork.SimpleQueue()\n"
            "child = fork.Process(target=work, args=(queue,)); child.start()\n"
            "print(queue.get()); child.join()"
        )
        assert "get_context('spawn')" in python(code)

    def test_spawned_processes_render(self):
        rendered()
        here = context.get().info["renderer"]
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            assert pool.apply(_renderer) == here

    def test_objects_are_freed_with_their_owners(self):
        rendered("osmesa")
        code = (
            "from lietool.render import context, probe; import ctypes; c = context.get('osmesa')\n"
            "def alive(kind):\n"
            "    address = c._loader.load_opengl_function(f'glIs{kind}')\n"
            "    is_one = ctypes.CFUNCTYPE(ctypes.c_ubyte, ctypes.c_uint)(address)\n"
            "    return sum(is_one(name) for name in range(1, 400))\n"
            "kinds = ('Buffer', 'Framebuffer', 'Renderbuffer', 'VertexArray', 'Program', 'Shader')\n"
            "for count in (1, 20):\n"
            "    for _ in range(count): probe.picture(c.gl)\n"
            "    print(*map(alive, kinds))"
        )
        # OpenGL keeps what is bound, so a few of the last picture's objects outlive it.
        once, often = python(code).splitlines()
        assert once == often and max(map(int, once.split())) > 0


def _renderer() -> str:
    return context.get().info["renderer"]


class TestMesaSettings:
    @pytest.mark.parametrize("width", ["512", "64", "0", "", "wide"])
    def test_widths_that_crash_are_ignored(self, bare, monkeypatch, width):
        monkeypatch.setenv("LP_NATIVE_VECTOR_WIDTH", width)
        variables, notes = mesa.settings()
        assert variables["LP_NATIVE_VECTOR_WIDTH"] is None
        assert len(notes) == 1 and f"LP_NATIVE_VECTOR_WIDTH={width} would crash" in notes[0]

    def test_a_width_that_crashes_does_not(self):
        # Without a cache of compiled shaders, from which a picture could come without compiling.
        plain = rendered(MESA_SHADER_CACHE_DISABLE="true")
        guarded = rendered(MESA_SHADER_CACHE_DISABLE="true", LP_NATIVE_VECTOR_WIDTH="512")
        assert guarded["picture"] == plain["picture"] and len(guarded["notes"]) == 1

    @pytest.mark.parametrize(
        "name", ["GALLIUM_DRIVER", "MESA_GL_VERSION_OVERRIDE", "MESA_GLSL_VERSION_OVERRIDE"]
    )
    def test_what_would_crash_a_software_renderer_is_ignored(self, bare, monkeypatch, name):
        monkeypatch.setenv(name, "1.1")
        variables, notes = mesa.settings()
        assert variables[name] is None and len(notes) == 1 and f"{name}=1.1" in notes[0]
        assert name not in mesa.settings(software=False)[0]

    def test_a_driver_that_crashes_does_not(self):
        found = rendered(GALLIUM_DRIVER="nonsense", MESA_GLSL_VERSION_OVERRIDE="110")
        assert found["canonical"] and len(found["notes"]) == 2

    def test_each_width_has_its_own_shaders(self, bare, monkeypatch, tmp_path):
        monkeypatch.setenv("LIETOOL_CACHE_DIR", str(tmp_path))
        monkeypatch.setenv("LP_NATIVE_VECTOR_WIDTH", "128")
        variables, notes = mesa.settings()
        assert variables["MESA_SHADER_CACHE_DIR"] == str(tmp_path / "shaders-128") and notes == []
        assert "LP_NATIVE_VECTOR_WIDTH" not in variables

    def test_shaders_are_kept(self, tmp_path):
        found = rendered(LIETOOL_CACHE_DIR=str(tmp_path))
        assert any(path.is_file() for path in (tmp_path / "shaders").rglob("*"))
        assert rendered(LIETOOL_CACHE_DIR=str(tmp_path))["picture"] == found["picture"]

    def test_the_users_choice_stands(self, bare, monkeypatch, tmp_path):
        monkeypatch.setenv("MESA_SHADER_CACHE_DIR", str(tmp_path))
        assert "MESA_SHADER_CACHE_DIR" not in mesa.settings()[0]

    def test_a_full_disk_keeps_no_shaders(self, bare, monkeypatch, tmp_path):
        monkeypatch.setenv("LIETOOL_CACHE_DIR", str(tmp_path))
        assert "MESA_SHADER_CACHE_DISABLE" not in mesa.settings()[0]
        monkeypatch.setattr(mesa, "_ROOM", 2**80)
        variables, notes = mesa.settings()
        assert variables["MESA_SHADER_CACHE_DISABLE"] == "true" and "is full" in notes[0]

    def test_the_environment_is_put_back(self, bare, monkeypatch):
        monkeypatch.setenv("LP_NUM_THREADS", "1")
        before = dict(os.environ)
        with mesa.environment({"LP_NUM_THREADS": None, "EGL_LOG_LEVEL": "fatal"}):
            assert "LP_NUM_THREADS" not in os.environ and os.environ["EGL_LOG_LEVEL"] == "fatal"
        assert dict(os.environ) == before

    def test_only_graphics_libraries_are_listed(self, tmp_path):
        maps = tmp_path / "maps"
        maps.write_text(
            "7f00-7f01 r-xp 00000000 08:01 11 /usr/lib/a folder/libOSMesa.so.8.0.0\n"
            "7f01-7f02 r-xp 00000000 08:01 12 /usr/lib/libc.so.6\n"
            "7f02-7f03 rw-p 00000000 00:00 0 [heap]\n7f03-7f04 rw-p 00000000 00:00 0\n"
        )
        assert mesa.libraries(maps) == ["/usr/lib/a folder/libOSMesa.so.8.0.0"]
        assert mesa.libraries(tmp_path / "none") == []


class TestCacheFolder:
    def test_wanted(self, monkeypatch, tmp_path):
        monkeypatch.delenv("LIETOOL_CACHE_DIR", raising=False)
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
        assert cache.wanted() == tmp_path / "lietool"
        monkeypatch.setenv("XDG_CACHE_HOME", "relative")
        monkeypatch.setenv("HOME", str(tmp_path))
        monkeypatch.setattr(sys, "platform", "linux")
        assert cache.wanted() == tmp_path / ".cache" / "lietool"
        monkeypatch.setenv("LIETOOL_CACHE_DIR", str(tmp_path / "own"))
        assert cache.wanted() == tmp_path / "own" and not (tmp_path / "own").exists()
        assert (
            cache.folder("labels") == tmp_path / "own" / "labels" and (tmp_path / "own" / "labels").is_dir()
        )

    def test_an_unusable_folder_gives_a_temporary_one_or_none(self, monkeypatch, tmp_path):
        blocked, temporary = tmp_path / "file", tmp_path / "temporary"
        blocked.touch()
        temporary.mkdir()
        monkeypatch.setenv("LIETOOL_CACHE_DIR", str(blocked / "below"))
        monkeypatch.setattr("tempfile.tempdir", str(temporary))
        found = cache.folder("labels")
        assert found is not None and found.is_dir() and temporary in found.parents
        assert found.parent.stat().st_mode & 0o077 == 0
        # A folder that others can write may hold what they put there.
        found.parent.chmod(0o777)
        assert cache.folder("labels") is None
        monkeypatch.setattr("tempfile.tempdir", str(blocked))
        assert cache.folder() is None

    def test_rendering_does_without(self, tmp_path):
        blocked = tmp_path / "file"
        blocked.touch()
        # TMPDIR is passed over when it is no folder, so HOME and the cache alone are blocked here.
        found = rendered(LIETOOL_CACHE_DIR=str(blocked / "below"), HOME=str(blocked))
        assert found["picture"] == rendered()["picture"]
