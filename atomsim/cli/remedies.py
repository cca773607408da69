"""What to type: the remedies that errors and notices name, as options and commands of the command line."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import assert_never

from atomsim.errors import AtomsimError, Notice, Remedy


def command(words: str, path: Path) -> str:
    """Return a command on a file as it can be pasted into a shell, whatever the file is called.

    >>> command("render", Path("my run.h5")), command("render", Path("-x.h5"))
    ("atomsim render 'my run.h5'", 'atomsim render ./-x.h5')
    """
    return f"atomsim {words} {typed(path)}"


def typed(path: Path) -> str:
    """Return a name as it is typed into a shell."""
    name = str(path)
    return shlex.quote(f"./{name}" if name.startswith("-") else name)


def with_remedies(facts: AtomsimError | Notice) -> str:
    """Return an error or a notice with what to type against it.

    >>> print(with_remedies(Notice("a.h5 exists", (Remedy("replace"), Remedy("go on", Path("a.h5"))))))
    a.h5 exists; add --force to replace it; to go on: atomsim run --resume a.h5
    """
    message, remedies = str(facts), "; ".join(map(in_words, facts.remedies))
    return f"{message}{_seam(message)}{remedies}" if remedies else message


def _seam(message: str) -> str:
    """Return what stands between a message and its remedies: after a list, they have a line of their own."""
    return "\n" if "\n" in message else "; "


def in_words(remedy: Remedy) -> str:
    """Return what to type."""
    path = remedy.path
    match remedy.kind:
        case "replace":
            return "add --force to replace it"
        case "rename":
            return "choose another name with -o"
        case "run":
            return f"to run it: {command('run', path)}"
        case "go on":
            return f"to go on: {command('run --resume', path)}"
        case "begin":
            return f"to run it: {command('run --resume', path)}"
        case "recover":
            return f"to make the file of what there is: {command('recover', path)}"
        case "more rounds":
            return "ask for more with --rounds"
        case "lose additions":
            return f"copy {path} if that is to be kept, then add --force to go on without it"
        case "new file":
            return f"to run {path}: choose another name with -o"
        case "show scene":
            return f"to write out its scene: {command('show --scene', path)}"
        case "record golden":
            return "record it with: atomsim golden record"
        case "standard input":
            return f"as standard input it can be read: atomsim check - < {typed(path)}"
        case "numpy":
            return "or use --backend numpy"
    assert_never(remedy.kind)
