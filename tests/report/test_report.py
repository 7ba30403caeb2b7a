"""The page of a measurement: every experiment finds its place, every file named exists, gaps do no harm."""

from __future__ import annotations

import html.parser
import math
import sys
import tempfile
import unittest
import urllib.parse
import xml.dom.minidom
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[2] / "bench" / "report"), str(Path(__file__).resolve().parent)]
import blocks  # noqa: E402
import builders  # noqa: E402
import records  # noqa: E402
import report  # noqa: E402
import synthetic  # noqa: E402
from plots import styles  # noqa: E402


class Page(html.parser.HTMLParser):
    """Files that a page names, its headings, and its visible text."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.files: list[str] = []
        self.ids: list[str] = []
        self.tags: set[str] = set()
        self.text = ""
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        for name, value in attrs:
            if name in ("src", "href") and value and not value.startswith("#"):
                self.files.append(urllib.parse.unquote(value))
            if name == "id" and value:
                self.ids.append(value)

    def handle_data(self, data: str) -> None:
        self.text += data


class WholePage(unittest.TestCase):
    """One page of every experiment, made once."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name) / "a folder, named oddly"
        synthetic.write_everything(cls.folder)
        cls.page = Page(report.write_page(cls.folder))
        cls.records = records.load(cls.folder / "records.json")

    @classmethod
    def tearDownClass(cls) -> None:
        cls.temporary.cleanup()

    def test_every_named_file_exists_inside_the_folder(self) -> None:
        self.assertGreater(len(self.page.files), 30)
        self.assertIn("records.json", self.page.files)
        for name in self.page.files:
            self.assertFalse(name.startswith(("/", "http", "file", "..")), name)
            self.assertTrue((self.folder / name).is_file(), name)

    def test_nothing_is_fetched_or_run(self) -> None:
        self.assertFalse({"script", "link", "iframe"} & self.page.tags)

    def test_every_experiment_has_a_section_even_an_unknown_one(self) -> None:
        for experiment in {record.experiment for record in self.records}:
            self.assertIn(experiment, self.page.ids)
        self.assertIn("an experiment that no table knows", self.page.text)

    def test_plots_are_whole_and_come_in_both_forms(self) -> None:
        drawn = sorted((self.folder / "plots").glob("*.svg"))
        names = {path.stem for path in drawn}
        self.assertLessEqual(
            {"still-cornell-methods", "still-cornell-order", "still-cornell-cache", "growth-triangles", "hard"}, names
        )
        for path in drawn:
            xml.dom.minidom.parse(str(path))
            self.assertEqual(path.with_suffix(".png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_every_value_with_its_range_stands_on_the_page(self) -> None:
        shown = [
            record for record in self.records if record.experiment in ("still", "moving", "rays", "growth", "peers")
        ]
        for record in shown:
            for value in record.values.values():
                self.assertIn(records.value_text(value), self.page.text, record.key)

    def test_loaded_records_are_marked(self) -> None:
        loaded = sum(record.loaded for record in self.records)
        self.assertIn(f"{loaded} of {len(self.records)} records are marked", self.page.text)
        value = next(record for record in self.records if record.loaded).values["frame_p95"]
        self.assertIn(records.value_text(value) + "†", self.page.text)

    def test_a_floor_comes_from_the_experiments_own_reference_or_the_scenes(self) -> None:
        context = blocks.Context(self.folder, self.records, self.records)
        for experiment, metric, error in (("still", "relmse", 0.0012), ("moving", "flip", 0.011)):
            own = [record for record in self.records if record.experiment == experiment]
            self.assertEqual([line.y for line in builders.floor(context, own, metric)], [error])

    def test_what_is_no_point_of_a_curve_keeps_its_table(self) -> None:
        self.assertIn("flip over base", self.page.text)
        self.assertIn("gallery, walk: further figures", self.page.text)
        self.assertIn("not installed: no curve of its", self.page.text)

    def test_head_names_machine_commit_seed_and_command(self) -> None:
        for words in ("Some Processor, 2 cores, 8 GiB", "abc1234", "saccade bench quick -o out", "embree 3.13.5"):
            self.assertIn(words, self.page.text)

    def test_labels_are_text_not_markup(self) -> None:
        self.assertIn("case <10> & more", self.page.text)


class Parts(unittest.TestCase):
    def record(self, **labels: str) -> records.Record:
        run = records.Run("abc", "saccade", "", "machine")
        value = records.Value(0.1, 0.1, 0.1)
        return records.Record("k", "still", run, labels, {"seconds": 1.0}, {"relmse": value}, {}, False, "")

    def test_options_of_a_method_are_compared_one_at_a_time(self) -> None:
        found = [
            self.record(method="path"),
            self.record(method="corrective", order="attention", cache="on"),
            self.record(method="corrective", order="task", cache="on"),
            self.record(method="corrective", order="attention", cache="off"),
        ]
        plots = {title: [record.labels for record in chosen] for title, chosen, _ in builders.questions(found)}
        self.assertEqual(set(plots), {"methods", "order", "cache"})
        self.assertEqual(plots["methods"], [found[0].labels, found[1].labels])
        self.assertEqual(plots["order"], [found[1].labels, found[2].labels])
        self.assertEqual(plots["cache"], [found[1].labels, found[3].labels])

    def test_measured_seconds_are_the_cost_where_there_are_any(self) -> None:
        record = self.record(method="path")
        self.assertEqual(builders.point(record, "relmse").x, 1.0)
        record.values["seconds"] = records.Value(1.5, 1.4, 1.6, 5, "s", "time")
        self.assertEqual(builders.point(record, "relmse").x, 1.5)

    def test_a_frame_without_a_deadline_stands_where_its_time_is(self) -> None:
        record = self.record(method="raytrace")
        del record.at["seconds"]
        record.values["frame_p50"] = records.Value(300, 290, 310, 5, "ms", "time")
        self.assertEqual(builders.point(record, "relmse").x, 300)
        record.at["budget_ms"] = 66.0
        self.assertEqual(builders.point(record, "relmse").x, 66)

    def test_up_to_two_dozen_curves_look_different(self) -> None:
        looks = [tuple(look.values()) for look in styles([f"curve {i}" for i in range(24)]).values()]
        self.assertEqual(len(set(map(str, looks))), 24)

    def test_numbers_keep_their_significant_digits(self) -> None:
        for number, text in (
            (0.0, "0"),
            (1234567, "1,234,567"),
            (0.012345, "0.0123"),
            (0.1, "0.100"),
            (9.996, "10.0"),
            (1234.5, "1,234"),
            (2e-5, "2.00e-05"),
        ):
            self.assertEqual(records.number_text(number), text)

    def test_what_is_not_finite_is_left_out(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            entry = synthetic.record(
                "a/b", {}, {"x": math.nan}, {"v": {"median": math.inf}, "w": {"median": None}, "u": 3}
            )
            synthetic.write(Path(folder), [entry])
            (loaded,) = records.load(Path(folder) / "records.json")
            self.assertEqual((dict(loaded.values), dict(loaded.at)), ({}, {}))

    def test_a_wrong_record_is_named(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            synthetic.write(Path(folder), [synthetic.record("a/b", {}, {}, {}), {"key": "c/d", "run": 7}])
            with self.assertRaisesRegex(records.RecordError, "record 1 .*c/d"):
                records.load(Path(folder) / "records.json")


if __name__ == "__main__":
    unittest.main()
