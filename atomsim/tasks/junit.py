"""What became of expectations as JUnit XML, which services for continuous integration read."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree

from atomsim.disk import behind, write_whole
from atomsim.errors import InputError
from atomsim.tasks.expect import Tried


def check_junit(path: Path) -> None:
    """Refuse a name that cannot become a report, before any scene is run for it.

    Raises:
        InputError: another extension, a folder, or a folder that does not exist.
    """
    if path.suffix.lower() != ".xml":
        raise InputError(f"{path}: a report for JUnit is written as .xml")
    if path.is_dir():
        raise InputError(f"{path}: this is a folder; give the name of a file")
    folder = behind(path).parent
    if not folder.is_dir():
        raise InputError(f"{path}: the folder {folder} does not exist")


def write_junit(tried: Sequence[Tried], path: Path) -> None:
    """Write a suite for each scene and a case for each expectation; a report of that name is replaced.

    Raises:
        RunError: the disk does not take it.
    """
    root = ElementTree.Element("testsuites", name="atomsim")
    for each in tried:
        root.append(_suite(each))
    ElementTree.indent(root)
    write_whole(path, ElementTree.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n")


def _suite(tried: Tried) -> ElementTree.Element:
    n_errors = int(bool(tried.error))
    about = {
        "name": str(tried.scene),
        "tests": str(len(tried.judged) + n_errors),
        "failures": str(len(tried.failed)),
        "errors": str(n_errors),
        "time": f"{tried.seconds:.3f}",
    }
    suite = ElementTree.Element("testsuite", about)
    for judged in tried.judged:
        of = {"classname": tried.scene.stem, "name": judged.name, "file": judged.file, "line": str(judged.line)}
        case = ElementTree.SubElement(suite, "testcase", of)
        if not judged.verdict.is_met:
            ElementTree.SubElement(case, "failure", message=str(judged))
    if tried.error:
        case = ElementTree.SubElement(suite, "testcase", classname=tried.scene.stem, name="the run")
        ElementTree.SubElement(case, "error", message=tried.error.splitlines()[0]).text = tried.error
    return suite
