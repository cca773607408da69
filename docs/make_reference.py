"""Writes the generated pages of the docs, and the JSON Schema, from the code; knows no wording of its own but headings.

Run it with `make reference`.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import typer

from atomsim.cli.app import app
from atomsim.scene.declarations import declarations, sections
from atomsim.scene.field_docs import FieldDoc, about, field_docs
from atomsim.scene.language import Declaration
from atomsim.scene.schema import schema_text

ROOT = Path(__file__).parent.parent
EXAMPLES = ROOT / "docs" / "examples"

GENERATED = "<!-- Written by `make reference` from the code and docs/examples; changes by hand are lost. -->\n"

RECIPE = """\
# yaml-language-server: $schema=../../atomsim/scene/scene.schema.json
# A recipe; docs/recipes.md tells what it shows.
"""

SCENE_INTRODUCTION = """\
# Scene reference

Every key of a scene file. A scene is YAML, and data only: loading it runs nothing.
A [tutorial](tutorial.md) builds one step by step; editors complete and check scenes with the
[JSON Schema](../atomsim/scene/scene.schema.json), which `atomsim schema` prints.

JSON is YAML, too: a program may write a scene as JSON, into a file of any name, and say `"$schema"` there, which is for
editors only.

An unknown key is an error, and so is a value of the wrong type: nothing is guessed. `null` counts as not written; a key
without a value is an error, which finds `color: #ff0000`: `#` begins a comment, so such a color needs quotes.
Numbers may be written `1e-9`, whole ones `1e6`, and none `1,000`; booleans are `true` and `false`.

## Words used below

| type | what to write |
| --- | --- |
| `[x, y, z]` | three numbers |
| `selection` | atoms by name: `ring` (a group), `ring[0]`, `ring[-1]`, `ring[0:10]`, `ring[::2]`, `floor[0, :]` \
(planes and blocks, x first), `all`, or a list of these (their union); of a group with \
[copies](#copies-of-a-group-copies) `leg.0` is one copy and `leg[-1]` the last atom of each |
| `[selection, selection]` | two selections: `[ring, floor]`, `[[left, right], floor]` |
| `color` | a CSS name such as `steelblue`, or `"#rgb"` or `"#rrggbb"` in quotes |
| `mapping by name` | `name: value`, one a line; names have letters of any script, digits, `_` and `-` |

An atom has radius 1 and mass 1. Lengths are in radii; a unit of time is whatever `time_step` makes of it.
"""

EXTENDS = """\
### Extending another scene

`extends: other.yaml` lays a scene over another one, which is looked up beside it. Mappings merge by key, everything
else replaces, and `null` deletes. A scene that extends writes only what differs.
"""

SELECTIONS = """\
### Selections

Wherever atoms are named, a part of a group will do.
"""

COPIES = """\
### Copies of a group: `copies`

A part that there is several times is written once. The atoms of a group with `copies` are those of all its copies, one
copy after the other.

| where | `leg` means | `leg.0` means |
| --- | --- | --- |
| a selection | all legs; an index counts in each of them: `leg[-1]` is every foot | the first leg; `leg.0[-1]` is \
its foot |
| bonds `within` | inside each leg, and never from one to another | inside the first |
| bonds `between` | copies of one number meet: `between: [thigh, shin]` binds `thigh.0` to `shin.0`, `thigh.1` to \
`shin.1`; what has no copies meets them all; two groups need the same number of copies | what has no copies |
| collisions | all legs as one group, which also collide with one another; only `min_gap` counts in each | the first |
| `torque` | each leg by itself, with all of `magnitude`, about its own centre, or about the copy of `about` that has \
the same number | the first |

Number 0 is the group as written. With a list of copies, each copies what the ones before it made: `[{count: 2, step:
[9, 0, 0]}, {count: 2, step: [0, 6, 0]}]` makes four, of which 0 and 1 are 9 apart, and 0 and 2 are 6 apart.
"""

EXPECTATIONS = """\
Each says one of `measure`, `all`, `any`, `not` and `that`, and one of `at`, `always`, `eventually` and `until`, which
may also be left to one around it. [Expectations](expectations.md) explains them and defines how far each is from
failing.
"""

FURTHER_EXAMPLES = {"string": ("from",), "push": ("towards",), "tether": ("foundation",)}
"""Of words that can be said in several ways."""

NOTES = {
    "atomsim run": """\
A scene may come from another program. What it extends is looked up in the current folder:

```console
$ sed 's/count: 70/count: 20/' scenes/rods.yaml | atomsim run - --rounds 100 --quiet
$ atomsim show out.h5
out.h5: Two rods collide, bounce apart and vibrate
  scene      standard input
  atoms      40: left 20, right 20
…
```

With Numba, which is an extra, long runs are faster, to the same bits: `pip install 'atomsim[fast]'`, or in a checkout
`.venv/bin/pip install -e '.[fast]'`. Without it, or where it is not worth its start, NumPy computes; the second line
that is printed says which.

`--resume` needs no scene, because the trajectory holds its own. With a SCENE as well, `atomsim run --resume OUT SCENE`
first makes sure that the two are the same: they may differ in `title`, `description`, `rounds`, `render`, `silence`
and `expect`; if anything else differs, nothing is run. It is the scene inside that goes on; `--rounds` says up to
which round.
""",
    "atomsim golden record": """\
A golden holds the digest of every recorded round and a few frames in full. It is a small text file, to be committed
beside the scene; `LOG.md` in the same folder keeps the reasons.
""",
    "atomsim render": """\
`--rounds` takes one or more of these, with commas between:

| words | rounds |
| --- | --- |
| `250` | round 250, or the recorded one that is nearest to it, the earlier of two |
| `0-2000:100` | 0, 100, 200, … up to 2000, each as above; if fewer are recorded, all recorded ones from 0 to 2000 |
| `0-2000` | every recorded round from 0 to 2000 |
| `2000-` | every recorded round from 2000 on; likewise `2000-:100` |
| `-20` | the last twenty recorded rounds, or all if there are fewer |

The order is kept. A round that the run did not reach is an error, also as the end of a span. If neither you nor the
scene say any, the strip shows the first, the last and four between: as much happens from each to the next. What happens
is how far groups move and how their speeds change.

`--camera`, `--look-at`, `--width` and `--follow` stand for keys of [`render.camera`](scene-reference.md#camera), and
take the place of what the scene says. Rows without a direction of their own are seen from the same side, across the
motion of all of them. Of several `--camera`, each makes a row of its own.

With `--size 8x6cm` a frame has that size on paper, at 300 pixels per inch or as many as `--dpi` says. `--transparent`
leaves nothing behind the atoms and the words, for slides and posters; `--dark` makes both fit a dark one.
""",
    "atomsim check": """\
The word after a number of bonds says how they are computed. All three ways give the same bits; they differ in speed.

| word | bonds | how |
| --- | --- | --- |
| `dense` | most pairs of some atoms, as in a rod | all pairs at once, as a table |
| `offset` | many pairs of the same difference of numbers, as in a cloth | one difference after the other |
| `general` | any | pair by pair, looking up both atoms |

`held, not computed`: both ends of all these bonds are held, so nothing can come of them.

What is found is one line, `file:line: warning: message [code]` or `file:line: note: message [code]`, and a remedy,
YAML to lay over the scene. [Findings](findings.md) explains every code. With `--json`, each is an object with `code`,
`level` (`warning` or `note`), `when` (`before` a run), `names` (paths such as `groups.cloth`), `file`, `line`,
`rounds`, `message` and `remedy`.
""",
}

COMPLETION = """\
## Completion

`atomsim --install-completion` teaches bash, zsh or fish, whichever it is typed into, to complete commands, options, the
names of backends and of the scenes at hand; terminals opened afterwards have it. `atomsim --show-completion` prints the
script, to be kept where one likes.
"""

EXIT_CODES = """\
## Exit codes

| code | meaning |
| --- | --- |
| 0 | done |
| 1 | the run failed (disk, memory), or a comparison, a verification or a golden differs |
| 2 | bad usage or bad input: a scene, a path, a file that is not ours |
| 3 | the simulation blew up; the frames before are kept |
| 130 | interrupted by Ctrl-C, after writing what there is (143: terminated, 129: its terminal was closed) |

Results go to standard output; progress and messages go to standard error.
"""


def generated() -> dict[Path, str]:
    """Return every generated file with its text."""
    return {
        ROOT / "docs" / "scene-reference.md": "\n".join(_scene_reference()),
        ROOT / "docs" / "commands.md": "\n".join(_commands()),
        ROOT / "atomsim" / "scene" / "scene.schema.json": schema_text(),
        **dict(_recipes()),
    }


def _recipes() -> Iterator[tuple[Path, str]]:
    """Yield the scenes of the recipes page as files that come with the program."""
    page = (ROOT / "docs" / "recipes.md").read_text(encoding="utf-8")
    for name, scene in re.findall(r"^```yaml\n# (\S+)\n(.*?)^```$", page, re.DOTALL | re.MULTILINE):
        yield ROOT / "scenes" / "recipes" / name, f"{RECIPE}{scene}"


def _scene_reference() -> Iterator[str]:
    """Yield the parts of the scene reference."""
    docs = field_docs()
    yield GENERATED
    yield SCENE_INTRODUCTION
    yield from _section("## The scene", ["Scene"], docs)
    yield EXTENDS
    yield _examples("extends")
    yield SELECTIONS
    yield _examples("selections")
    yield from _section("### Jitter", ["Jitter"], docs)
    yield _examples("jitter")
    yield from _family("## Groups", "groups", docs)
    yield from _section("### Turning a group: `rotate`", ["Rotation"], docs)
    yield _examples("rotate")
    yield from _section("### Spinning a group: `spin`", ["Spin"], docs)
    yield _examples("spin")
    yield COPIES
    yield _fields(docs["Copies"])
    yield _examples("copies")
    yield from _family("## Bonds", "bonds", docs)
    yield from _section("## Collisions", ["Collisions"], docs)
    yield _examples("within", "between", "among", "except_bound")
    yield from _family("## Forces", "forces", docs)
    yield from _section("## Pictures: `render`", ["Render"], docs)
    yield from _section("### Camera", ["Camera"], docs)
    yield _examples("render", "follow", "close_up")
    yield from _section("## What should happen: `expect`", ["Expectation"], docs)
    yield EXPECTATIONS
    yield _examples("expect")
    yield from _section("## Findings that are meant: `silence`", ["Silence"], docs)
    yield _examples("silence")


def _section(heading: str, names: Iterable[str], docs: dict[str, dict[str, FieldDoc]]) -> Iterator[str]:
    """Yield a heading, and what the docstrings say of declarations."""
    yield heading + "\n"
    for name in names:
        yield about(declarations()[name]) + "\n"
        yield _fields(docs[name])


def _family(heading: str, name: str, docs: dict[str, dict[str, FieldDoc]]) -> Iterator[str]:
    """Yield the keys that all declarations of a section share, then each of them with its own keys and an example."""
    section = sections()[name]
    first = section.declarations[0]
    base = first.__mro__[first.__mro__.index(Declaration) - 1]
    shared = set(_annotated(base))
    yield heading + "\n"
    yield f"Each has a `{section.key}`, and may have:\n"
    yield _fields({key: _as_inherited(key, section.declarations, docs) for key in _annotated(base)})
    for word, declaration in section.words.items():
        yield f"### `{word}`\n"
        yield about(declaration) + "\n"
        inherited = shared - set(_annotated(declaration))
        yield _fields({key: doc for key, doc in docs[declaration.__name__].items() if key not in inherited})
        yield _examples(word, *FURTHER_EXAMPLES.get(word, ()))


def _as_inherited(key: str, members: Iterable[type[Declaration]], docs: dict[str, dict[str, FieldDoc]]) -> FieldDoc:
    """Return what is known of a shared key where no declaration says it anew."""
    return next(docs[member.__name__][key] for member in members if key not in _annotated(member))


def _annotated(class_: type) -> list[str]:
    """Return the fields that a class itself declares."""
    return list(inspect.get_annotations(class_))


def _fields(fields: dict[str, FieldDoc]) -> str:
    """Return a table of keys."""
    rows = [
        (f"`{key}`", _in_code(doc.type), "required" if doc.default is None else _in_code(doc.default), doc.description)
        for key, doc in fields.items()
    ]
    return _table(("key", "type", "default", "meaning"), rows)


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table."""
    lines = (" | ".join(cell.replace("|", "\\|") for cell in row) for row in (head, ["---"] * len(head), *rows))
    return "".join(f"| {line} |\n" for line in lines)


def _in_code(text: str) -> str:
    return f"`{text}`" if text else ""


def _examples(*names: str) -> str:
    """Return example scenes by name, each in a fence."""
    texts = ((EXAMPLES / f"{name}.yaml").read_text(encoding="utf-8") for name in names)
    return "\n".join(f"```yaml\n{text}```\n" for text in texts)


def _commands() -> Iterator[str]:
    """Yield the parts of the page of commands."""
    top = typer.main.get_command(app)
    yield GENERATED
    yield f"# Commands\n\n{top.help}\n\nEvery command explains itself: `atomsim run --help`.\n"
    yield _parameters(top)
    for name, command in _leaves(top, "atomsim"):
        yield f"## `{name}`\n"
        yield _prose(command)
        yield _parameters(command)
        if name in NOTES:
            yield NOTES[name]
    yield COMPLETION
    yield EXIT_CODES.rstrip("\n") + "\n"


def _leaves(command: Any, name: str) -> Iterator[tuple[str, Any]]:
    """Yield the commands that do something, with their full names."""
    for word, inner in getattr(command, "commands", {}).items():
        full = f"{name} {word}"
        if hasattr(inner, "commands"):
            yield from _leaves(inner, full)
        else:
            yield full, inner


def _prose(command: Any) -> str:
    """Return what a command says of itself, its examples in a fence."""
    text, _, examples = re.split(r"^(Examples?:)$", inspect.cleandoc(command.help), maxsplit=1, flags=re.MULTILINE)
    fenced = "\n".join(line for line in examples.splitlines() if line.strip())
    return f"{text.strip()}\n\n```text\n{fenced}\n```\n"


def _parameters(command: Any) -> str:
    """Return a table of arguments and options."""
    shown = [parameter for parameter in command.params if getattr(parameter, "help", None)]
    if not shown:
        return ""
    rows = [(_spelling(parameter), _default(parameter), _meaning(parameter)) for parameter in shown]
    return _table(("argument or option", "default", "meaning"), rows)


def _spelling(parameter: Any) -> str:
    """Return how a parameter is typed: `--output`, `-o` OUTPUT."""
    if parameter.param_type_name == "argument":
        return f"`{parameter.metavar or parameter.name.upper()}{'...' if parameter.nargs == -1 else ''}`"
    names = ", ".join(f"`{name}`" for name in parameter.opts)
    return names if parameter.is_flag else f"{names} `{parameter.metavar or parameter.name.upper()}`"


def _default(parameter: Any) -> str:
    if parameter.required:
        return "required"
    stated = re.search(r"\[default: (.*)\]", parameter.help)
    if stated:
        return stated[1]
    is_silent = parameter.is_flag if parameter.param_type_name == "option" else True
    return "" if is_silent or parameter.default in (None, "") else f"`{parameter.default}`"


def _meaning(parameter: Any) -> str:
    return re.sub(r"\s*\[default: .*\]", "", str(parameter.help))


if __name__ == "__main__":
    for path, text in generated().items():
        path.write_text(text, encoding="utf-8")
