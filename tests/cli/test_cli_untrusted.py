"""A scene from a stranger is data: what reading, compiling and running it may touch, as Python's audit hooks see it."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from support.process import finish, python

TRACED = """
import json, os, sys, tempfile
from pathlib import Path
import atomsim
from atomsim.tasks import run as record
from atomsim.cli.describe import describe_model, describe_trajectory
from atomsim.tasks.compare import first_difference
from atomsim.errors import AtomsimError
from atomsim.tasks.recompute import compile_inside

OURS = (sys.prefix, sys.base_prefix, str(Path(atomsim.__file__).parent))
DANGEROUS = ("subprocess", "os.system", "os.exec", "os.posix_spawn", "os.fork", "socket", "exec", "ctypes", "pickle",
             "marshal.load", "code.__new__", "urllib", "webbrowser", "os.startfile", "pty", "import")
CHANGES = ("os.mkdir", "os.remove", "os.rmdir", "os.symlink", "os.chmod", "os.chown", "os.putenv", "shutil")

def run():
    record.run(atomsim.load("s.yaml"), "out.h5", backend="numpy", warn=str)

def check():
    loaded = atomsim.load("s.yaml")
    describe_model(*atomsim.compile(loaded), loaded.scene.rounds, loaded.scene.record_every)

def show():
    with atomsim.Trajectory("out.h5") as trajectory:
        describe_trajectory(trajectory)

def verify():
    with atomsim.Trajectory("out.h5") as recorded:
        loaded, model, state = compile_inside(recorded.header, recorded.path)
        assert first_difference(recorded, atomsim.simulate(model, state, loaded.scene.rounds), model.groups) is None

def outcome(act):
    try:
        act()
    except AtomsimError as error:
        return error.exit_code
    return 0

# Once beforehand, so that what is loaded and built at first use is there.
here = os.getcwd()
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    Path("base.yaml").write_text(BASE)
    for text in ("a: [", BASE.replace("count", "cuont").replace("1.5", "x"), GOOD):
        Path("s.yaml").write_text(text)
        outcome(check)
    for act in (run, show, verify):
        assert outcome(act) == 0
    os.chdir(here)

seen = []

def hook(event, arguments):
    if event == "open":
        path, _, flags = arguments
        is_written = flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC)
        if not isinstance(path, int) and (is_written or not os.fsdecode(path).startswith(OURS)):
            seen.append(["write" if is_written else "read", os.path.abspath(os.fsdecode(path))])
    elif event in ("os.rename", "os.link"):
        seen.append(["write", os.path.abspath(os.fsdecode(arguments[1]))])
    elif event.startswith((*DANGEROUS, *CHANGES)):
        seen.append([event, repr(arguments)[:200]])

sys.addaudithook(hook)
code = outcome(globals()[ACT])
print(json.dumps([code, seen]))
"""

HARMLESS = ("/proc/meminfo", *(f"/sys/fs/cgroup/memory.{name}" for name in ("max", "current", "stat")), "/dev/null")

GOOD = """\
atomsim: 1
extends: base.yaml
rounds: 20
"""

BASE = """\
atomsim: 1
time_step: 0.01
rounds: 10
groups:
  a: {shape: string, count: 5, step: [1.5, 0, 0]}
bonds: {a: {within: a, rule: neighbour}}
"""

TRICKS = {
    "code": "groups: !!python/object/apply:os.system ['touch owned']",
    "module": "groups: !!python/module:antigravity",
    "name": "groups: !!python/name:os.system",
    "new": "groups: !!python/object/new:subprocess.Popen [[touch, owned]]",
    "include": "groups: !include /etc/passwd",
    "merge": "groups: {<<: {a: 1}}",
    "above": "extends: ../secret.yaml",
    "absolute": "extends: /etc/passwd",
    "link": "extends: link.yaml",
    "device": "extends: pipe",
    "folder": "extends: .",
    "expression": "groups: {a: {shape: string, count: 5, step: [1, 0, 0], velocity: [__import__('os'), 0, 0]}}",
    "selection": f"{BASE[11:]}forces: {{f: {{kind: damping, coefficient: 0.1, acts_on: 'a[exit()]'}}}}",
    "title": f"{BASE[11:]}title: '$(touch owned) {{0.__class__}} %s `touch owned`'",
    "color": f"{BASE[11:]}render: {{background: 'url(http://localhost/)'}}",
}


def traced(folder: Path, act: str) -> tuple[int, list[list[str]]]:
    """Do something in a process that has done all of it before; return the exit code and what was touched."""
    constants = f"GOOD, BASE, ACT = {GOOD!r}, {BASE!r}, {act!r}\n"
    done = finish(program=python(constants + TRACED), cwd=folder)
    assert done.returncode == 0, done
    code, seen = json.loads(done.stdout)
    return code, [event for event in seen if event[1] not in HARMLESS]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with scenes, next to a secret."""
    folder = tmp_path / "scenes"
    folder.mkdir()
    (tmp_path / "secret.yaml").write_text("secret: 1")
    (folder / "base.yaml").write_text(BASE)
    (folder / "s.yaml").write_text(GOOD)
    (folder / "link.yaml").symlink_to("../secret.yaml")
    os.mkfifo(folder / "pipe")
    return folder


def test_a_run_reads_its_scenes_and_writes_its_trajectory(folder):
    code, seen = traced(folder, "run")
    assert code == 0
    own = {str(folder / name) for name in ("out.h5", "out.h5.part", "out.h5.part.tmp", "out.h5.part.built")}
    assert {path for what, path in seen if what == "write"} == own
    assert {path for what, path in seen if what == "read"} - own - {str(folder)} == {
        str(folder / "s.yaml"),
        str(folder / "base.yaml"),
    }
    removed = [event for event in seen if event[0] not in ("read", "write")]
    assert all(what == "os.remove" and "out.h5" in path for what, path in removed), removed


@pytest.mark.parametrize("act", ["check", "show", "verify"])
def test_what_only_reads_writes_nothing(folder, act):
    assert traced(folder, "run")[0] == 0
    code, seen = traced(folder, act)
    assert code == 0
    assert {what for what, _ in seen} <= {"read"}
    assert {path for _, path in seen} <= {str(folder / name) for name in ("s.yaml", "base.yaml", "out.h5")}


@pytest.mark.parametrize("trick", TRICKS)
def test_a_trick_runs_nothing_and_reads_nothing_else(folder, trick):
    (folder / "s.yaml").write_text(f"atomsim: 1\n{TRICKS[trick]}\n")
    code, seen = traced(folder, "run")
    assert code == (0 if trick == "title" else 2)
    own = {str(folder / name) for name in ("out.h5", "out.h5.part", "out.h5.part.tmp", "out.h5.part.built", "s.yaml")}
    assert {path for what, path in seen if what in ("read", "write")} - {str(folder)} <= own
    assert all(what in ("read", "write", "os.remove") for what, _ in seen), seen
    assert not (folder / "owned").exists()
