#!/usr/bin/env python3
"""The documents hold together: links and anchors are there, files that are named exist, the code's comments name documents
and headings that there are, and what is listed (metrics, warnings, options) is what the code has. CTest sets CMAP_SOURCE_DIR."""

import os
import re
import unittest
from pathlib import Path

SOURCE = Path(os.environ["CMAP_SOURCE_DIR"]).resolve()
PAGES = [*SOURCE.glob("*.md"), *(SOURCE / "docs").glob("*.md"), *(SOURCE / "data_samples").glob("*.md"),
         *(SOURCE / "benchmarks").rglob("*.md"), *(SOURCE / "findings").glob("*.md")]
DOCUMENTS = ("METRICS", "FORMATS", "PIPELINE", "DESIGN", "REPORT", "ARCHITECTURE", "CONTRIBUTING", "WRITERS", "STYLE")
FOLDERS = ("include", "lib", "tools", "tests", "configs", "cmake", "docs", "benchmarks", "data_samples", "findings")


def without_code(text):
    """Blocks are examples, and hold no links."""
    return re.sub(r"^```.*?^```", "", text, flags=re.S | re.M)


def headings(page):
    return re.findall(r"^#+ +(.*?) *#*$", without_code(page.read_text()), re.M)


def anchors(page):
    """As GitHub makes them."""
    found = []
    for heading in headings(page):
        anchor = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        n = sum(re.fullmatch(rf"{re.escape(anchor)}(-\d+)?", other) is not None for other in found)
        found.append(f"{anchor}-{n}" if n else anchor)
    return found


def document(name):
    places = [SOURCE / f"docs/{name}.md", SOURCE / f"{name}.md"]
    return next((place for place in places if place.exists()), None)


def sources(*suffixes):
    for folder in ("include", "lib", "tools", "tests", "benchmarks"):
        yield from (path for path in (SOURCE / folder).rglob("*") if path.suffix in suffixes)


def library_text():
    return "\n".join(path.read_text() for path in sorted((SOURCE / "lib").rglob("*.?pp")))


def warning_ids():
    """What the library calls its warnings: where they are added, and where a function makes one."""
    text = library_text()
    added = re.findall(r'\bwarnings\.push_back\(\s*\{+\s*(?:"id",\s*)?"(?!id")([a-z_]+)"', text)
    makers = re.findall(r"^Warning \w+\(.*?^}", text, re.S | re.M)
    made = [name for maker in makers for name in re.findall(r'return \{"([a-z_]+)"', maker)]
    of_tools = re.findall(r'\{"[a-z-]+", \w+_record, "([a-z_]+)"', text)
    return {*added, *made, *of_tools}


class Documents(unittest.TestCase):
    def test_links(self):
        for page in PAGES:
            for target in re.findall(r"\]\(([^)\s]+)\)", without_code(page.read_text())):
                if re.match(r"[a-z]+:", target):
                    continue
                with self.subTest(f"{page.relative_to(SOURCE)}: {target}"):
                    path, _, anchor = target.partition("#")
                    place = (page.parent / path).resolve() if path else page
                    self.assertTrue(place.exists(), "no such file")
                    self.assertTrue(place == SOURCE or SOURCE in place.parents, "outside of the repository")
                    if anchor:
                        self.assertIn(anchor, anchors(place))

    def test_named_files_exist(self):
        """`lib/io/clouds/ply/ply_reader.cpp`; names in capitals and in braces stand for others."""
        for page in PAGES:
            for name in re.findall(r"`((?:%s)/[^`\s]*)`" % "|".join(FOLDERS), without_code(page.read_text())):
                if re.search(r"NAME|[*{]", name):
                    continue
                with self.subTest(f"{page.relative_to(SOURCE)}: {name}"):
                    self.assertTrue((SOURCE / name).exists())

    def test_nothing_outside_is_named(self):
        for page in PAGES:
            self.assertNotIn("../shared", page.read_text(), page.name)

    def test_comments_name_documents(self):
        """METRICS means docs/METRICS.md; a heading in quotes may follow."""
        mention = re.compile(r"\b(%s)(?:\.md)?\b(?:, \"([^\"]+)\")?" % "|".join(DOCUMENTS))
        for path in sources(".hpp", ".cpp", ".inl"):
            comments = " ".join(" ".join(re.findall(r"//[/<]*(.*)", path.read_text())).split())
            for name, heading in mention.findall(comments):
                with self.subTest(f"{path.relative_to(SOURCE)}: {name}"):
                    self.assertIsNotNone(document(name), "no such document")
                    if heading:
                        self.assertIn(heading, headings(document(name)))

    def test_every_metric_has_a_section(self):
        text = (SOURCE / "docs/METRICS.md").read_text()
        listed = re.search(r"set\(metrics\n(.*?)\)", (SOURCE / "lib/metrics/CMakeLists.txt").read_text(), re.S)[1].split()
        self.assertGreater(len(listed), 10)
        for metric in listed:
            source = (SOURCE / f"lib/metrics/{metric}.cpp").read_text()
            name, symbol, unit, better = (
                (re.search(rf'\.{field} = "([^"]*)"', source) or ["", ""])[1] for field in ("id", "symbol", "unit", "better"))
            with self.subTest(name):
                self.assertEqual(name, metric.split("/")[1])
                self.assertIn(f"\n### {name}\n", text)
                self.assertIn(f"| [`{name}`](#{name}) | {symbol} | {unit} | {better} |".replace("|  |", "| |"), text)

    def test_every_warning_is_listed(self):
        section = (SOURCE / "docs/REPORT.md").read_text().split("\n## Warnings\n")[1]
        cells = re.findall(r"^\| (`.*?) \|", section, re.M)
        listed = {name for cell in cells for name in re.findall(r"`([a-z_]+)`", cell)}
        ids, text = warning_ids(), library_text()
        self.assertGreater(len(ids), 60)
        self.assertEqual(ids - listed, set(), "not listed")
        self.assertEqual({name for name in listed if f'"{name}"' not in text}, set(), "not in the code")

    def test_every_option_of_the_pipeline_is_listed(self):
        text = (SOURCE / "docs/PIPELINE.md").read_text().split("\n## Options\n")[1]
        names = re.findall(r'\bfield\("(\w+)"', (SOURCE / "lib/recon/options.cpp").read_text())
        self.assertEqual(re.findall(r"^\| `(\w+)` \|", text.split("\n## ")[0], re.M), names)

    def test_the_version_is_that_of_the_build(self):
        version = re.search(r"project\(cmap VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]
        self.assertIn(f"\nversion: {version}\n", (SOURCE / "CITATION.cff").read_text())


if __name__ == "__main__":
    unittest.main()
