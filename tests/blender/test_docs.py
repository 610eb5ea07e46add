# SPDX-License-Identifier: GPL-3.0-or-later
"""The pages of docs: every link, picture, command and file that they name is there."""

import re
from pathlib import Path

import pytest

import extension

ROOT = extension.ROOT
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
LINK = re.compile(r"\]\(([^)\s]+)\)")
CODE = re.compile(r"`([^`\n]+)`")
FILE = re.compile(r"(?:addon|shaders|tests|tools|benchmarks|sample_blends)/[\w/]+\.(?:py|glsl|sh|blend)")
MODULE = re.compile(r"python -m (benchmarks[\w.]*)")
TARGET = re.compile(r"(?:^|[`\s])make ([a-z-]+)(?=[`\s]|$)")
PAST = {"CHANGELOG.md"}  # speaks of files as they were


def anchors(text):
    """The anchors that a page of Markdown has, as its viewers make them of the headings."""
    headings = re.findall(r"^#+ (.+)$", text, re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def problems(path, root=ROOT):
    """What a page names that is not there, in words."""
    text = path.read_text()
    for link in LINK.findall(text):
        if re.match(r"[a-z]+:", link):
            continue
        file, _, anchor = link.partition("#")
        target = (path.parent / file).resolve() if file else path
        if not target.exists():
            yield f"the link {link} leads nowhere"
        elif anchor and target.suffix == ".md" and anchor not in anchors(target.read_text()):
            yield f"{link}: no such heading"
    if path.name in PAST:
        return
    for code in CODE.findall(text) + re.findall(r"^    (.+)$", text, re.M):
        for file in FILE.findall(code):
            if not (root / file).exists():
                yield f"there is no {file}"
        for module in MODULE.findall(code):
            place = root.joinpath(*module.rstrip(".").split("."))
            if not (place.with_suffix(".py").exists() or (place / "__main__.py").exists()):
                yield f"there is no module {module}"
        targets = set(re.findall(r"^([a-z-]+):", (root / "Makefile").read_text(), re.M))
        for target in TARGET.findall(code):
            if target not in targets:
                yield f"make has no target {target}"


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_what_a_page_names_is_there(path):
    assert not list(problems(path))


def test_every_page_is_in_the_index():
    index = (ROOT / "docs" / "README.md").read_text()
    for path in PAGES:
        name = path.relative_to(ROOT / "docs").as_posix() if path.is_relative_to(ROOT / "docs") else ""
        if name and name != "README.md" and not name.startswith("measured/accuracy/"):
            assert f"]({name})" in index, name


def test_every_picture_is_shown():
    shown = {(page.parent / link).resolve() for page in PAGES for link in LINK.findall(page.read_text())}
    pictures = {path for kind in ("webp", "png", "svg") for path in (ROOT / "docs").rglob(f"*.{kind}")}
    assert not pictures - shown


def test_what_is_missing_is_found(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(
        "# Title\n[a](none.md) [b](#title) [c](#other) `addon/none.py` `make nothing`\n"
        "\n    python -m benchmarks.none\n"
    )
    found = list(problems(page))
    assert len(found) == 5 and not any("#title" in each for each in found)


def test_the_checkout_is_light():
    assert sum(path.stat().st_size for path in Path(ROOT / "docs").rglob("*") if path.is_file()) < 5e6
