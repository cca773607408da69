"""Reports as pages: HTML that needs no network and no script, and Markdown; no text of a scene becomes markup."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Iterator
from html import escape
from typing import TYPE_CHECKING

from atomsim.findings.finding import Finding
from atomsim.scene.mistakes.wording import printable
from atomsim.tasks.expect import Judged

if TYPE_CHECKING:
    from atomsim.tasks.report import Report

STYLE = """
:root { color-scheme: light dark; --ink: #23232b; --paper: #ffffff; --faint: #6b6b78; --line: #dcdce2; --bad: #a3221f;
  --good: #1d6b43; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e8e8ee; --paper: #1b1b21; --faint: #a0a0ae; --line: #3a3a44; --bad: #ff8a80; --good: #7fd6a4; } }
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper); margin: 2rem auto;
  max-width: 62rem; padding: 0 1rem; }
h1 { font-size: 1.7rem; margin-bottom: .2rem; } h2 { font-size: 1.15rem; margin-top: 2rem; }
img { max-width: 100%; height: auto; background: #f5f5f7; border-radius: 4px; }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; vertical-align: top; padding: .3rem .8rem .3rem 0; border-bottom: 1px solid var(--line); }
th { font-weight: 500; color: var(--faint); white-space: nowrap; }
td { overflow-wrap: anywhere; } pre { background: color-mix(in srgb, var(--ink) 7%, var(--paper)); padding: .6rem .8rem;
  border-radius: 4px; overflow-x: auto; margin: .3rem 0; } code { font-size: .9em; }
.bad { color: var(--bad); font-weight: 600; } .good { color: var(--good); } .faint { color: var(--faint); }
@media print { body { margin: 0; max-width: none; } h2 { break-after: avoid; } tr, pre, img { break-inside: avoid; } }
"""


def as_html(report: Report, mark: str, strip: bytes, chart: bytes) -> str:
    """Return a report as one page that holds all it shows.

    Args:
        report: what to say.
        mark: who says it.
        strip: the frames, a PNG.
        chart: measures over rounds, an SVG.
    """
    title = _safe(report.title)
    body = "\n".join(
        [
            f"<h1>{title}</h1>",
            f'<p class="faint">{_summary(report)}</p>',
            f'<img alt="Frames of the run, side by side" src="{_data("image/png", strip)}">',
            "<h2>What is missing, or went wrong</h2>",
            *_html_findings(report.findings),
            "<h2>What was expected</h2>",
            *_html_expectations(report.judged),
            "<h2>What happened</h2>",
            *_html_events(report),
            f'<p><img alt="Measures over rounds" src="{_data("image/svg+xml", chart)}"></p>',
            "<h2>What was run</h2>",
            *_html_rows((name, _safe(value)) for name, value in report.facts.items()),
        ]
    )
    policy = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="generator" content="{mark}">
<title>{title}</title>
<style>{STYLE}</style>
</head>
<body>
{body}
</body>
</html>
"""


def _summary(report: Report) -> str:
    """Say in one line how it went."""
    n_warnings = sum(found.level == "warning" for found in report.findings)
    n_notes = len(report.findings) - n_warnings
    n_met = sum(each.verdict.is_met for each in report.judged)
    expected = f"{n_met} of {len(report.judged)} expectations met" if report.judged else "nothing expected"
    return f"{n_warnings} warnings, {n_notes} notes; {expected}; the run {_safe(report.facts['ended'])}"


def _html_findings(findings: tuple[Finding, ...]) -> Iterator[str]:
    if not findings:
        yield "<p>Nothing was found.</p>"
    for found in findings:
        look = "bad" if found.level == "warning" else "faint"
        yield f'<p><span class="{look}">{found.level}</span> {_safe(found.message)} <span class="faint">'
        yield f"{_safe(place_of(found))} · {_safe(found.code)}, {found.when} the run</span></p>"
        if found.remedy:
            yield f"<pre><code>{_safe_lines(found.remedy)}</code></pre>"


def _html_expectations(judged: tuple[Judged, ...]) -> Iterator[str]:
    if not judged:
        yield "<p>The scene does not say.</p>"
        return
    verdicts = [("met", "good") if each.verdict.is_met else ("not met", "bad") for each in judged]
    rows = zip(verdicts, judged, strict=True)
    yield from _html_rows((f'<span class="{look}">{word}</span>', _safe(str(each))) for (word, look), each in rows)


def _html_events(report: Report) -> Iterator[str]:
    if not report.events:
        yield "<p>Nothing that is known by name.</p>"
        return
    yield from _html_rows((f"round {event.round_index:,}", _safe(str(event))) for event in report.events)


def _html_rows(rows: Iterator[tuple[str, str]]) -> Iterator[str]:
    yield "<table>"
    yield from (f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in rows)
    yield "</table>"


def _safe(text: str) -> str:
    return escape(printable(text))


def _safe_lines(text: str) -> str:
    return "\n".join(_safe(line) for line in text.splitlines())


def _data(kind: str, content: bytes) -> str:
    return f"data:{kind};base64,{b64encode(content).decode()}"


def as_markdown(report: Report, mark: str) -> str:
    """Return a report as Markdown, without pictures.

    Args:
        report: what to say.
        mark: who says it.
    """
    lines = [f"# {_plain(report.title)}", "", *_markdown_findings(report.findings), "## What was expected", ""]
    lines += [f"- {'met' if each.verdict.is_met else '**not met**'}: {_plain(str(each))}" for each in report.judged]
    lines += [*([] if report.judged else ["The scene does not say."]), "", "## What happened", ""]
    lines += [f"- round {event.round_index:,}: {_plain(str(event))}" for event in report.events]
    lines += [*([] if report.events else ["Nothing that is known by name."]), "", "## What was run", ""]
    lines += [f"- {name}: {_plain(value)}" for name, value in report.facts.items()]
    return "\n".join([*lines, "", f"*{mark}*", ""])


def _markdown_findings(findings: tuple[Finding, ...]) -> Iterator[str]:
    yield from ("## What is missing, or went wrong", "")
    for found in findings:
        yield f"- **{found.level}** {_plain(found.message)} ({_plain(place_of(found))}, {found.code})"
        if found.remedy:
            yield from ("", "  ```yaml", *(f"  {printable(line)}" for line in found.remedy.splitlines()), "  ```", "")
    yield "" if findings else "Nothing was found.\n"


def _plain(text: str) -> str:
    """Keep a text from being taken for Markdown or HTML."""
    return re.sub(r"([\\`*_{}\[\]<>#|~!&])", r"\\\1", printable(text))


def place_of(found: Finding) -> str:
    """Write where a finding stands."""
    return f"{found.file}:{found.line}" if found.line else found.file
