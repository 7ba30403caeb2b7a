"""Finds numbers that a template states itself instead of taking them from a record."""

from __future__ import annotations

import re
from pathlib import Path

# What may hold digits: the template's own marks, code, links, and names of things that end in a number.
_ALLOWED = (
    r"\{\{.*?\}\}",
    r"\{%.*?%\}",
    r"`[^`]*`",
    r"!?\[[^\]]*\]\([^)]*\)",
    r"\b(?:section|step|Figure|Table|Haber|Keller|Segovia|Dubla|Debian|Mesa|Embree|Blender|Rec\.)\s\d+(?:\.\d+)*",
    r"\b[A-Za-zα-ωΑ-Ω]+[-_]?\d\w*",  # p95, RGBA32F, gallery-1000
    r"\b\d+σ",
)
_HIDDEN = re.compile("|".join(_ALLOWED))
_COMMENT = re.compile(r"\{#.*?#\}", re.DOTALL)


def literal_numbers(template: Path) -> list[str]:
    """One line "file:line: ..." for each number in the prose."""
    text = _COMMENT.sub(lambda comment: "\n" * comment[0].count("\n"), template.read_text(encoding="utf-8"))
    found = []
    fenced = False
    for position, line in enumerate(text.splitlines(), start=1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
            continue
        if fenced or line.startswith("#"):
            continue
        number = re.search(r"\S*\d\S*", _HIDDEN.sub(" ", line))
        if number:
            found.append(
                f"{template}:{position}: the number {number[0]} has no record; write {{{{key:metric}}}} for it"
            )
    return found
