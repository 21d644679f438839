#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""checkLinks.py [ROOT]

What the pages (*.md) point at is there:
  1. relative links and images, with their anchors (GitHub's rule for headings);
  2. paths in code (`tests/..`, `docs/..`, a command of a fenced block), from the top or from the page's folder; * and {a,b} must match something;
  3. tests: [test `name`] and `bin/test_name` are in a list tests/*.cmake.
Prints file:line of every breach; fails when there is one. Python's standard library alone.
"""
import re
import sys
from pathlib import Path
from urllib.parse import unquote

FOLDERS = "tests docs benchmarks tutorials fluidSolver demCoupling scripts cmake".split()
GENERATED = {"results", "run", "runs", "log.validate", "log.flotsamFoam", "postProcessing"}   # what runs leave in tutorials and benchmarks
SKIPPED = {"build", ".git", "runs", "run", "quick"}                # folders whose pages are not the project's

LINK = re.compile(r"\[(?:[^\[\]]|\[[^\]]*\])*\]\(\s*<?([^)\s>]+)>?[^)]*\)")
CODE = re.compile(r"(`+)(.+?)\1")
PATH = re.compile(r"(?<![\w./*$}>-])(?:\.\./)*(?:" + "|".join(FOLDERS) + r")/[\w./*{},+-]+")
TEST = re.compile(r"\[tests?((?:[ ,]|and|`[^`]*`)+)\]")
PROGRAM = re.compile(r"\btest_(\w\w+)")                           # not of `test_x`, which stands for any


def pages(root):
    own = [p for p in sorted(root.rglob("*.md")) if not SKIPPED & set(p.relative_to(root).parts[:-1])]
    return [p for p in own if p.name != "summary.md"]   # written by the tutorials


def lines_of(page):
    """(number, text, whether it is within a fenced block)"""
    fence = None
    for number, text in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        mark = re.match(r"\s*(```+|~~~+)", text)
        if mark and (fence is None or text.strip() == fence):
            fence = mark.group(1) if fence is None else None
            continue
        yield number, text, fence is not None


def slug(heading):
    """The anchor of a heading, as GitHub makes it."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.strip().rstrip("#").strip())
    text = re.sub(r"[^\w\- ]", "", text.replace("`", "").lower())
    return text.replace(" ", "-")


def anchors_of(page):
    found, counts = set(), {}
    for _, text, is_code in lines_of(page):
        heading = None if is_code else re.match(r"#{1,6}\s+(.*)", text)
        if heading:
            name = slug(heading.group(1))
            again = counts.get(name, 0)
            counts[name] = again + 1
            found.add(f"{name}-{again}" if again else name)
        found.update(re.findall(r"<a\s+(?:id|name)=\"([^\"]+)\"", text))
    return found


def tests_of(root):
    lists = "\n".join(p.read_text(encoding="utf-8") for p in sorted((root/"tests").glob("*.cmake")))
    names = set(re.findall(r"(?:flotsam_(?:test|case)\(|add_test\(NAME \w+\.)(\w+)", lists))
    for group in re.findall(r"foreach\(\w+ ([^)]*)\)", lists):
        names.update(group.split())
    return names


def expand(pattern):
    """a{b,c} -> ab, ac, as a shell does"""
    group = re.search(r"\{([^{}]*)\}", pattern)
    if not group:
        return [pattern]
    return [p for part in group.group(1).split(",") for p in expand(pattern[:group.start()] + part + pattern[group.end():])]


def is_there(path, root, folder):
    if GENERATED & set(Path(path).parts):
        return True
    for base in (root, folder):
        if "*" in path and ".." not in path:
            if any(base.glob(path.rstrip("/"))):
                return True
        elif (base/path).exists():
            return True
    return False


class Check:
    def __init__(self, root):
        self.root, self.tests, self.anchors = root, tests_of(root), {}
        self.breaches, self.checked = [], 0

    def fail(self, page, number, message):
        self.breaches.append(f"{page.relative_to(self.root)}:{number}: {message}")

    def link(self, page, number, target):
        if re.match(r"[a-z]+:", target):
            return
        self.checked += 1
        name, _, anchor = unquote(target).partition("#")
        file = (page.parent/name).resolve() if name else page
        if not file.exists():
            self.fail(page, number, f"link to {target}: there is no {name}")
        elif anchor and file.suffix == ".md":
            if file not in self.anchors:
                self.anchors[file] = anchors_of(file)
            if anchor not in self.anchors[file]:
                self.fail(page, number, f"link to {target}: no heading of {file.name} has the anchor #{anchor}")

    def code(self, page, number, text):
        for match in PATH.finditer(text):
            for path in expand(match.group().rstrip(".,")):
                self.checked += 1
                if not is_there(path, self.root, page.parent):
                    self.fail(page, number, f"path {path}: neither from the top nor from this page's folder is there one")
        for name in PROGRAM.findall(text):
            self.test(page, number, name)

    def test(self, page, number, name):
        self.checked += 1
        name = name.rsplit(".", 1)[-1]
        if name not in self.tests:
            self.fail(page, number, f"test {name}: not in tests/*.cmake")

    def page(self, page):
        for number, text, is_code in lines_of(page):
            if is_code:
                self.code(page, number, text)
                continue
            for match in CODE.finditer(text):
                self.code(page, number, match.group(2))
            for match in TEST.finditer(text):
                for name in re.findall(r"`([\w.]{2,})`", match.group(1)):
                    self.test(page, number, name)
            for match in LINK.finditer(CODE.sub(lambda m: "x"*len(m.group()), text)):
                self.link(page, number, match.group(1))


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    check, all_pages = Check(root), pages(root)
    for page in all_pages:
        check.page(page)
    print(*check.breaches, sep="\n", end="\n" if check.breaches else "")
    print(f"checkLinks: {check.checked} links, paths and tests in {len(all_pages)} pages, {len(check.breaches)} breaches")
    return 1 if check.breaches or not all_pages else 0


if __name__ == "__main__":
    sys.exit(main())
