"""Reports: no text of a scene becomes markup, whatever the format."""

from __future__ import annotations

from pathlib import Path

SCENE = """\
atomsim: 1
title: "<script>alert(1)</script> [x](y) `z`"
time_step: 0.05
rounds: 20
groups: {ball: {shape: atoms, positions: [[0, 0, 0]], velocity: [0, 0, 1]}}
"""


def test_a_title_stays_text(cli):
    Path("s.yaml").write_text(SCENE)
    assert cli("run", "s.yaml", "--backend", "numpy").code == 0
    assert cli("report", "out.h5", "-o", "r.html").code == 0
    page = Path("r.html").read_text(encoding="utf-8")
    assert "<script" not in page
    assert "&lt;script&gt;" in page
    assert cli("report", "out.h5", "-o", "r.md").code == 0
    assert "\\<script\\>" in Path("r.md").read_text(encoding="utf-8")
