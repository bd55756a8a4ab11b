"""Goldens on disk: whole, old, new or known to be half, whatever happens to whoever writes them."""

import errno
import os
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
import zlib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from lietool.golden import folder, store

OLD = np.zeros((12, 16, 3), np.uint8)
NEW = np.random.default_rng(0).integers(0, 256, (12, 16, 3), np.uint8)
TEXTS = {"plate": "T1", "reason": "naïve – ξ", "renderer": "llvmpipe (LLVM 15.0.6, 256 bits)"}


@pytest.fixture
def place(tmp_path):
    return store.Place(tmp_path / "golden", "ch9", "T1.b")


def write(place, image=NEW, values=None, labels=None, keys=("k1",)):
    labels = {f"{key}.png": b"label" for key in keys} if labels is None else labels
    store.write(place, image, values or {"x": [1.0, 2.0]}, labels=labels, label_keys=keys, provenance=TEXTS)


def kind(place, read=store.read):
    with pytest.raises(store.GoldenError) as caught:
        read(place)
    return caught.value.kind


def test_what_is_written_is_read(place):
    write(place)
    golden = store.read(place)
    assert np.array_equal(golden.image, NEW) and golden.numbers["x"].tolist() == [1.0, 2.0]
    assert TEXTS.items() <= golden.provenance.items() and golden.provenance == store.provenance(place)
    assert store.label_keys(golden.provenance) == {"k1"}
    assert (place.labels / "k1.png").read_bytes() == b"label"
    assert place.png.name == "T1.b.png" and place.json.name == "T1.b.json"


def test_a_picture_is_written_last_and_labels_first(place, monkeypatch):
    order = []
    real = store.atomic.write_bytes
    monkeypatch.setattr(
        store.atomic, "write_bytes", lambda path, data: order.append(path) or real(path, data)
    )
    write(place)
    assert order == [place.labels / "k1.png", place.json.with_name(".T1.b.json.next"), place.png]
    assert not order[1].exists() and place.json.is_file()


def test_no_golden_at_all_is_missing(place):
    assert kind(place) == kind(place, store.provenance) == "missing"
    place.root.parent.joinpath("golden").write_bytes(b"")
    assert kind(place) == "missing"


@pytest.mark.parametrize("half", ["png", "json"])
def test_one_half_alone_is_half_accepted(place, half):
    write(place)
    getattr(place, half).unlink()
    assert kind(place) == kind(place, store.provenance) == "half accepted"


def test_halves_of_two_goldens_are_half_accepted(place):
    write(place, values={"x": 1.0})
    text = place.json.read_bytes()
    write(place, values={"x": 2.0})
    place.json.write_bytes(text)
    assert kind(place) == kind(place, store.provenance) == "half accepted"


def test_turned_line_ends_do_not_matter(place):
    write(place, values={"x": np.eye(3)})
    place.json.write_bytes(place.json.read_bytes().replace(b"\n", b"\r\n"))
    assert store.read(place).numbers["x"].shape == (3, 3)


def test_a_file_cut_anywhere_or_with_any_byte_changed_is_never_taken_for_a_golden(place):
    write(place)
    whole = place.png.read_bytes()
    for length in range(0, len(whole) - 12, 3):
        place.png.write_bytes(whole[:length])
        assert kind(place) in ("torn", "half accepted")
    for at in range(0, len(whole) - 12, 7):
        place.png.write_bytes(whole[:at] + bytes([whole[at] ^ 0x55]) + whole[at + 1 :])
        assert kind(place) in ("torn", "half accepted")


def test_what_is_no_picture_at_all_is_torn(place):
    write(place)
    place.png.write_bytes(b"hello")
    with pytest.raises(store.GoldenError, match="it is no picture that can be read"):
        store.read(place)
    place.png.unlink()
    place.png.mkdir()
    assert kind(place) == kind(place, store.provenance) == "torn"


def test_a_picture_too_large_to_decode_is_torn(place, monkeypatch):
    write(place)
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", 1)
    assert kind(place) == "torn"


def test_a_picture_of_another_mode_is_torn(place):
    write(place)
    Image.new("RGBA", (4, 4)).save(place.png)
    assert kind(place) == "torn"


def as_it_says(place):
    with Image.open(place.png) as image:
        info = PngInfo()
        for key, value in image.text.items():  # type: ignore[attr-defined]
            info.add_text(key, value)
    return info


def enlarged(data):
    """The header of a picture of 10 gigapixels, before the bytes of a small one."""
    header = struct.pack(">II", 100_000, 100_000) + data[24:29]
    return data[:16] + header + struct.pack(">I", zlib.crc32(b"IHDR" + header)) + data[33:]


@pytest.mark.parametrize(
    ("image", "words"),
    [
        (Image.fromarray(NEW).quantize(16), "is not of 8 bits of red, green and blue"),
        (Image.fromarray(NEW).convert("RGBA"), "is not of 8 bits of red, green and blue"),
        (Image.fromarray(NEW[..., 0].astype(np.uint16) * 257), "is not of 8 bits of red, green and blue"),
        (Image.fromarray(NEW ^ np.uint8(1)), "has other pixels than were accepted"),
        (Image.fromarray(NEW[:6]), "has other pixels than were accepted"),
    ],
    ids=["palette", "alpha", "deep", "pixels", "size"],
)
def test_a_picture_that_was_saved_anew_otherwise_is_torn(place, image, words):
    write(place)
    image.save(place.png, pnginfo=as_it_says(place))
    with pytest.raises(store.GoldenError, match=words):
        store.read(place)


def test_a_picture_that_was_only_packed_anew_is_whole(place):
    write(place)
    Image.fromarray(NEW).save(place.png, pnginfo=as_it_says(place), compress_level=1)
    assert np.array_equal(store.read(place).image, NEW)


def test_what_only_looks_like_a_golden_is_torn(place):
    write(place)
    whole, info = place.png.read_bytes(), as_it_says(place)
    other = {"save_all": True, "append_images": [Image.fromarray(OLD)]}
    Image.fromarray(NEW).save(place.png, "PNG", pnginfo=info, **other)
    with pytest.raises(store.GoldenError, match="it holds more than one picture"):
        store.read(place)
    Image.fromarray(NEW).save(place.png, "JPEG")
    with pytest.raises(store.GoldenError, match="it is no PNG, as its name says, but a JPEG"):
        store.read(place)
    place.png.write_bytes(enlarged(whole))
    for read in (store.read, store.provenance):
        with pytest.raises(store.GoldenError, match="it has far too many pixels"):
            read(place)


def test_numbers_that_are_no_json_are_not_read(place):
    write(place)
    place.json.write_bytes(place.json.read_bytes()[:-9])
    assert kind(place) == "half accepted"


def test_numbers_that_are_not_finite_are_refused_before_anything_is_written(place):
    with pytest.raises(ValueError, match=r"must be finite; got a.b\[1\] is nan"):
        write(place, values={"a": {"b": np.array([1.0, np.nan])}})
    assert not place.root.exists()


@pytest.mark.parametrize("step", range(13))
def test_a_full_disk_leaves_the_old_golden_and_nothing_else(place, monkeypatch, step):
    write(place, image=OLD, values={"x": 1.0}, keys=("k1",))
    count = 0

    def full(real):
        def wrapped(*arguments, **options):
            nonlocal count
            count += 1
            if count == step + 1:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            return real(*arguments, **options)

        return wrapped

    before = {path: path.read_bytes() for path in place.root.rglob("*.*")}
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full(os.fsync))
        patch.setattr(tempfile, "mkstemp", full(tempfile.mkstemp))
        patch.setattr(Path, "replace", full(Path.replace))
        with pytest.raises(OSError, match="No space left"):
            write(place, values={"x": 2.0}, keys=("k1", "k2"))
    golden = store.read(place)
    # Two labels, numbers and picture are opened, synced and renamed; then the numbers get their name,
    # without which they are found as well.
    assert golden.numbers["x"] == (1.0 if step < 12 else 2.0)
    left = {path: path.read_bytes() for path in place.root.rglob("*.*") if path.name != "k2.png"}
    assert left == before if step < 12 else place.png in left
    with folder.lock(place.root):
        folder.sweep(place.root, [place])
    assert not [path for path in place.root.rglob("*") if path.name.endswith((".part", ".next"))]


def test_a_reader_never_sees_half_of_what_somebody_is_writing(place):
    def write_often():
        for turn in range(20):
            write(place, image=NEW if turn % 2 else OLD, values={"x": float(turn % 2)})

    write(place, image=OLD, values={"x": 0.0})
    writer = threading.Thread(target=write_often)
    writer.start()
    seen = set()
    while writer.is_alive():
        golden = store.read(place)
        seen.add((float(golden.numbers["x"]), bool(golden.image.any())))  # type: ignore[arg-type]
        assert store.provenance(place)
    writer.join()
    assert seen <= {(0.0, False), (1.0, True)} and seen


def test_what_a_killed_writer_left_is_finished_or_forgotten(place):
    write(place, image=OLD, values={"x": 1.0})
    old = place.json.read_bytes()
    write(place, values={"x": 2.0})
    new, waiting = place.json.read_bytes(), place.json.with_name(".T1.b.json.next")
    # Killed after the picture got its name.
    place.json.write_bytes(old)
    waiting.write_bytes(new)
    assert store.read(place).numbers["x"] == 2.0
    place.json.unlink()
    assert store.read(place).numbers["x"] == 2.0
    folder.sweep(place.root, [place])
    assert place.json.read_bytes() == new and not waiting.exists()
    # Killed before.
    waiting.write_bytes(old)
    assert store.read(place).numbers["x"] == 2.0
    folder.sweep(place.root, [place])
    assert place.json.read_bytes() == new and not waiting.exists()


def test_strays_are_listed(place):
    write(place)
    strays = [place.root / "ch9" / "T2.png", place.root / "old" / "T3.json", place.root / "T4.png"]
    for path in strays:
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(b"")
    (place.root / "README.md").write_bytes(b"")
    assert folder.unregistered(place.root, [place]) == sorted(strays)
    assert folder.unregistered(place.root / "nowhere", []) == []


def test_labels_that_nobody_uses_are_swept_once_all_goldens_are_whole(place):
    other = store.Place(place.root, "ch8", "T2")
    write(place, keys=("k1", "k2"))
    write(other, keys=("k2", "k3"))
    (place.labels / "k9.png").write_bytes(b"")
    left = place.labels / ".k9.png.abc.part"
    left.write_bytes(b"")
    other.json.unlink()
    assert folder.sweep(place.root, [place, other]) == [] and (place.labels / "k9.png").exists()
    assert not left.exists()
    write(other, keys=("k3",))
    # A golden whose figure is gone, or being renamed, still holds its labels.
    assert folder.sweep(place.root, [place]) == []
    assert folder.sweep(place.root, [place, other]) == [place.labels / "k9.png"]
    assert sorted(path.name for path in place.labels.iterdir()) == ["k1.png", "k2.png", "k3.png"]


DRIVER = '''
"""Writes a golden in children that are killed at every step, and prints what each leaves."""
import os, signal, sys, tempfile
from pathlib import Path
import numpy as np
from lietool.golden import folder, store

root, has_old = Path(sys.argv[1]), sys.argv[2] == "old"
place = store.Place(root, "ch9", "T1")
images = {name: np.full((12, 16, 3), level, np.uint8) for name, level in (("old", 0), ("new", 200))}

def write(name):
    with folder.lock(root):
        label = name + "-label"
        store.write(place, images[name], {"name": name, "x": np.full(50, float(len(name)))},
                    labels={label + ".png": name.encode() * 20}, label_keys=[label], provenance={})

def state():
    try:
        golden = store.read(place)
    except store.GoldenError as error:
        return error.kind
    name = golden.numbers["name"]
    assert np.array_equal(golden.image, images[name])
    for key in store.label_keys(golden.provenance):
        assert (place.labels / (key + ".png")).read_bytes() == name.encode() * 20
    return name

def die_at(step):
    count = 0
    def killing(function):
        def wrapped(*args, **kwargs):
            nonlocal count
            for after in (False, True):
                count += 1
                if count == step:
                    os.kill(os.getpid(), signal.SIGKILL)
                if not after:
                    result = function(*args, **kwargs)
            return result
        return wrapped
    for name in ("fsync", "chmod", "replace"):
        setattr(os, name, killing(getattr(os, name)))
    tempfile.mkstemp = killing(tempfile.mkstemp)

for step in range(1, 100):
    for path in sorted(root.rglob("*"), reverse=True):
        path.unlink() if path.is_file() else path.rmdir()
    if has_old:
        write("old")
    child = os.fork()
    if child == 0:
        die_at(step)
        write("new")
        os._exit(0)
    killed = os.WIFSIGNALED(os.waitpid(child, 0)[1])
    left = state()
    # The dead hold no lock, and nothing they left behind is in the way.
    write("new")
    folder.sweep(root, [place])
    assert state() == "new"
    assert sorted(path.name for path in root.rglob("*.*")) == ["T1.json", "T1.png", "new-label.png"]
    print(step, "killed" if killed else "lived", left)
    if not killed:
        break
'''


@pytest.mark.skipif(not hasattr(os, "fork"), reason="kills forks")
@pytest.mark.parametrize("before", ["old", "none"])
def test_killed_at_any_step_it_leaves_the_old_golden_or_the_new(tmp_path, before):
    script = tmp_path / "driver.py"
    script.write_text(DRIVER)
    (tmp_path / "golden").mkdir()
    done = subprocess.run(
        [sys.executable, script, tmp_path / "golden", before], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    steps = [line.split(maxsplit=2) for line in done.stdout.splitlines()]
    left = [kind for _, _, kind in steps]
    # Three files, each opened, synced, made readable and renamed, killed before and after; the numbers are
    # made readable and renamed once more.
    assert [how for _, how, _ in steps] == ["killed"] * 28 + ["lived"]
    first = "old" if before == "old" else "missing"
    # All up to the moment at which the picture gets its name, and all after it.
    assert left == [first] * 25 + ["new"] * 4


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no flock")
def test_a_lock_keeps_others_out_and_dies_with_its_holder(tmp_path):
    hold = "import sys, time; from pathlib import Path; from lietool.golden import folder\n"
    hold += "with folder.lock(Path(sys.argv[1])): print('held', flush=True); time.sleep(60)"
    with subprocess.Popen([sys.executable, "-c", hold, tmp_path], stdout=subprocess.PIPE) as holder:
        assert holder.stdout and holder.stdout.readline() == b"held\n"
        take = "import sys; from pathlib import Path; from lietool.golden import folder\n"
        take += "with folder.lock(Path(sys.argv[1])): print('mine')"
        with subprocess.Popen([sys.executable, "-c", take, tmp_path], stdout=subprocess.PIPE) as other:
            time.sleep(0.5)
            assert other.poll() is None
            os.kill(holder.pid, signal.SIGKILL)
            assert other.communicate(timeout=30)[0] == b"mine\n"
    assert list(Path(tmp_path).iterdir()) == []
