"""The results page: what it takes from records, and what its check refuses."""

from __future__ import annotations

import json
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any

sys.path[:0] = [str(Path(__file__).resolve().parents[2] / "bench" / "report"), str(Path(__file__).resolve().parent)]
import results  # noqa: E402
import synthetic  # noqa: E402
from literal_numbers import literal_numbers  # noqa: E402
from records import RecordError, Value  # noqa: E402
from book import formatted  # noqa: E402
from results_page import book_of, committed, render  # noqa: E402

TEMPLATE = """# Results 2026

The loop runs at {{rays/gallery:loop|.2f M}} million rays, `64` samples.

| scene | ratio |
|---|---|
{% for row in rows("rays") %}
| {{ row.scene }} | {{ row("ratio", ".2f range") }} |
{% endfor %}

## Goals
| what | ours | goal | |
|---|---|---|---|
{% for goal in goals() %}
| {{ goal.what }} | {{ goal.ours }} | {{ goal.goal }} | {{ goal.verdict }} {{ goal.cause }} |
{% endfor %}
"""


def goal(limit: float, note: str = "the cause of it") -> dict[str, Any]:
    labels = {"what": "ratio", "of": "rays/*:ratio", "format": ".2f"}
    return synthetic.record("goal/rays", labels, {}, {"least": synthetic.value(limit, "ratio")}, note=note)


def rays(scene: str, ratio: float, **more: Any) -> dict[str, Any]:
    values = {"loop": synthetic.value(2.38e6, "rate", "1/s"), "ratio": synthetic.value(ratio, "ratio")}
    return synthetic.record(f"rays/{scene}", {"scene": scene}, {}, values, **more)


class Results(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.docs = Path(temporary.name) / "docs"
        self.records = self.docs / "records"
        self.write(TEMPLATE, [rays("gallery", 0.42), rays("cornell", 0.51), goal(0.5)])
        self.make()

    def write(self, template: str, records: list[dict[str, Any]]) -> None:
        synthetic.write(self.records, records, "all.json")
        (self.docs / "results.md.in").write_text(template, encoding="utf-8")

    def text(self) -> str:
        return render(self.docs / "results.md.in", book_of(self.docs))

    def make(self) -> None:
        (self.docs / "results.md").write_text(self.text(), encoding="utf-8")

    def refused(self, *patterns: str) -> None:
        wrong = results.check(self.docs)
        self.assertEqual(len(wrong), len(patterns), wrong)
        for line, pattern in zip(wrong, patterns):
            self.assertRegex(line, pattern)

    def test_the_page_holds_the_figures_and_passes(self) -> None:
        self.assertIn("runs at 2.38 million rays", self.text())
        self.assertIn("| gallery | 0.42 (0.40 to 0.44) |", self.text())
        self.assertEqual(results.check(self.docs), [])

    def test_a_changed_number_in_the_page_is_named_with_its_line(self) -> None:
        page = self.docs / "results.md"
        page.write_text(page.read_text().replace("0.42 (", "0.62 ("), encoding="utf-8")
        self.refused(r"results\.md:7: is .*0\.62.* the records give .*0\.42")

    def test_a_changed_record_is_named_with_its_line(self) -> None:
        self.write(TEMPLATE, [rays("gallery", 0.42), rays("cornell", 0.52), goal(0.5)])
        self.refused(r"results\.md:8: is .*0\.51.* the records give .*0\.52")

    def test_a_placeholder_without_a_record_is_named_with_its_line(self) -> None:
        self.write(TEMPLATE + "\nIt takes {{load/gallery:total}} s.\n", [rays("gallery", 0.42), goal(0.4)])
        self.refused(r"results\.md\.in:18: no record has the key load/gallery")
        self.write(TEMPLATE + "\nIt takes {{rays/gallery:total}} s.\n", [rays("gallery", 0.42), goal(0.4)])
        self.refused(r"results\.md\.in:18: the record rays/gallery has no metric total; it has loop, ratio")

    def test_a_label_that_no_record_has_is_named_with_its_line(self) -> None:
        self.write(TEMPLATE.replace("row.scene", "row.path"), [rays("gallery", 0.42), goal(0.4)])
        self.refused(r"results\.md\.in:8: .*path")

    def test_a_wrong_template_is_named_with_its_line(self) -> None:
        self.write("one\n{% for %}\n", [rays("gallery", 0.42)])
        self.refused(r"results\.md\.in:2: ")

    def test_literal_numbers_are_refused_where_they_state_something(self) -> None:
        for prose in (
            "It takes 12 s.",
            "| cornell | 0.4 |",
            "FLIP of 0.1, see [page 3](x.md)",
            "it is × 8 faster",
            "−3 %",
        ):
            (self.docs / "results.md.in").write_text(f"# Head\n\n{prose}\n", encoding="utf-8")
            self.assertEqual(len(literal_numbers(self.docs / "results.md.in")), 1, prose)
            self.assertRegex(literal_numbers(self.docs / "results.md.in")[0], r"results\.md\.in:3: the number ")

    def test_names_code_links_headings_and_comments_may_hold_digits(self) -> None:
        prose = (
            "## The 25 cases\nHaber 2001, section 4.3 and Debian 12: `512×512` p95 in gallery-1000, [at 8](x8.md)\n"
            "```\nrun 9\n```\n{# 3\n4 #}{{rays/gallery:loop|.2f}} within 3σ"
        )
        (self.docs / "results.md.in").write_text(prose, encoding="utf-8")
        self.assertEqual(literal_numbers(self.docs / "results.md.in"), [])

    def test_a_literal_after_a_comment_keeps_its_line(self) -> None:
        (self.docs / "results.md.in").write_text("{# a\nb #}\nof 7\n", encoding="utf-8")
        self.assertRegex(literal_numbers(self.docs / "results.md.in")[0], r":3: the number 7 ")

    def test_each_table_names_command_and_commit(self) -> None:
        self.assertEqual(self.text().count("Source: `saccade bench quick -o out` (abc1234)."), 2)
        self.assertNotIn("\x01", self.text())

    def test_prose_without_a_table_gets_its_source_at_the_sections_end(self) -> None:
        self.write("# A\n\n{{rays/gallery:ratio}}\n\n## B\nwords\n", [rays("gallery", 0.42)])
        self.assertEqual(
            self.text(),
            "# A\n\n0.420\n\n<sub>Source: `saccade bench quick -o out` (abc1234).</sub>\n\n## B\nwords\n",
        )

    def test_loaded_times_are_marked_and_errors_are_not(self) -> None:
        entry = rays("gallery", 0.42, loaded=True)
        entry["values"]["error"] = synthetic.value(0.25)
        self.write("| {{rays/gallery:ratio|.2f}} | {{rays/gallery:error|.2f}} |\n", [entry])
        self.assertIn("| 0.42† | 0.25 |", self.text())
        self.assertIn("† other programs were running", self.text())

    def test_goals_are_judged_by_the_worst_record(self) -> None:
        self.assertIn("| ratio | 0.42 (gallery) | ≥ 0.50 | **falls short** the cause of it |", self.text())
        self.write(TEMPLATE, [rays("gallery", 0.42), rays("cornell", 0.51), goal(0.42)])
        self.assertIn("| ratio | 0.42 (gallery) | ≥ 0.42 | met  |", self.text())

    def test_a_goal_may_be_judged_by_the_best_record(self) -> None:
        chosen = goal(0.5)
        chosen["labels"]["judge"] = "best"
        self.write(TEMPLATE, [rays("gallery", 0.42), rays("cornell", 0.51), chosen])
        self.assertIn("| ratio | 0.51 (cornell) | ≥ 0.50 | met  |", self.text())

    def test_a_missed_goal_needs_a_cause(self) -> None:
        self.write(TEMPLATE, [rays("gallery", 0.42), goal(0.5, note="")])
        self.make()
        self.refused("rays/gallery misses the goal goal/rays; write the cause")

    def test_what_was_tried_and_not_reached_falls_short(self) -> None:
        tried = synthetic.record("rays/gallery", {"scene": "gallery", "status": "not reached"}, {}, {})
        self.write("{% for goal in goals() %}\n{{ goal.ours }}, {{ goal.verdict }}\n{% endfor %}\n", [tried, goal(0.5)])
        self.assertTrue(self.text().startswith("not reached, **falls short**\n"), self.text())

    def test_a_goal_without_measurement_says_so(self) -> None:
        self.write(TEMPLATE.replace("{{rays/gallery:loop|.2f M}}", "some"), [goal(0.5)])
        self.assertIn("| ratio | – | ≥ 0.50 | not measured  |", self.text())

    def test_what_a_method_has_after_some_seconds(self) -> None:
        found = []
        for seconds, flip in ((0.1, 0.3), (0.4, 0.2), (2.0, 0.1)):
            values = {"seconds": synthetic.value(seconds, "time", "s"), "flip": synthetic.value(flip)}
            found.append(synthetic.record(f"still/a/path@{seconds}", {"scene": "a"}, {}, values))
        self.write('{{ after(0.05, "still", "flip") }} {{ after(0.5, "still", "flip", ".1f", scene="a") }}', found)
        self.assertTrue(self.text().startswith("– 0.2\n"), self.text())

    def test_what_may_be_absent(self) -> None:
        self.write(
            '{{ figure("a/b:c", "", "none") }}{% for row in rows("rays") %} {{ row("c", "", "–") }}{% endfor %}',
            [rays("x", 1)],
        )
        self.assertEqual(self.text(), "none –\n")

    def test_two_records_of_one_key_are_refused(self) -> None:
        synthetic.write(self.records, [rays("gallery", 0.3)], "more.json")
        with self.assertRaisesRegex(RecordError, "rays/gallery occurs twice"):
            committed(self.docs)

    def test_taking_over_replaces_an_experiment_and_nothing_else(self) -> None:
        measured = self.docs / "out"
        unused = synthetic.record("still/cornell/path@1s", {"scene": "cornell"}, {}, {"flip": synthetic.value(0.5)})
        synthetic.write(measured, [rays("table", 0.61), rays("gallery", 0.55), unused])
        self.assertEqual(results.take(self.docs, measured), ["rays"])
        kept = committed(self.docs)
        self.assertEqual(set(kept), {"rays/table", "rays/gallery", "goal/rays"})
        self.assertEqual(kept["rays/gallery"].median("ratio"), 0.55)
        self.assertEqual(kept["rays/gallery"].run.command, synthetic.RUN["command"])
        json.loads((self.records / "rays.json").read_text(encoding="utf-8"))
        self.make()
        self.assertEqual(results.check(self.docs), [])

    def test_plots_come_with_the_records(self) -> None:
        self.write(TEMPLATE + '\n{{ plot("rays", "speed of rays") }}\n', [rays("gallery", 0.42), goal(0.4)])
        self.assertNotIn("![", self.text())
        measured = self.docs / "out"
        synthetic.write(measured, [rays("gallery", 0.55)])
        synthetic.png(measured / "plots" / "rays.png", 9)
        results.take(self.docs, measured)
        self.assertIn("\n![speed of rays](pictures/plots/rays.png)\n", self.text())
        self.assertTrue((self.docs / "pictures/plots/rays.png").is_file())

    def test_formats(self) -> None:
        value = Value(-0.0044, -0.005, -0.004, 5, "ms", "time")
        self.assertEqual(formatted(value, ".2%"), "−0.44 %")
        self.assertEqual(formatted(value, ".3f range unit"), "−0.004 (−0.005 to −0.004) ms")
        self.assertEqual(formatted(Value(2.5e6, 2.5e6, 2.5e6), ".1f M times"), "× 2.5")
        self.assertEqual(formatted(Value(1234567, 1, 2), ""), "1,234,567")
        with self.assertRaisesRegex(RecordError, "unknown word: furlongs"):
            formatted(value, ".2f furlongs")


if __name__ == "__main__":
    unittest.main()
