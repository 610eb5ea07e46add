# SPDX-License-Identifier: GPL-3.0-or-later
"""The pages of docs: every link, picture, command and file that they name is there."""

import re
from functools import cache
from pathlib import Path

import pytest

import extension

ROOT = extension.ROOT
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
LINK = re.compile(r"\]\(([^)\s]+)\)|<(?:a|img)\s[^>]*?(?:href|src)=\"([^\"]+)\"")
CODE = re.compile(r"`([^`\n]+)`")
BLOCK = re.compile(r"^```\w*\n(.*?)^```", re.M | re.S)
FILE = re.compile(r"(?<![\w./<>*-])[\w./]*\w\.(?:py|glsl|sh|blend)\b")
SOURCES = "addon", "shaders", "tests", "tools", "benchmarks", "sample_blends"
FOLDERS = "", "addon", "shaders"  # where a path in a page may begin
MODULE = re.compile(r"python -m (benchmarks[\w.]*)")
TARGET = re.compile(r"(?:^|[`\s])make ([a-z-]+)(?=[`\s]|$)")
PAST = {"CHANGELOG.md"}  # speaks of files as they were


def anchors(text):
    """The anchors that a page of Markdown has, as its viewers make them of the headings."""
    headings = re.findall(r"^#+ (.+)$", text, re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def links(text):
    """The targets of a page's links and pictures, in Markdown and HTML."""
    return [markdown or html for markdown, html in LINK.findall(text)]


@cache
def file_names(root):
    """Names of the source files, without their folders."""
    return {path.name for folder in SOURCES for path in (root / folder).rglob("*.*")}


def exists(file, path, root):
    """Whether a file is there that a page names, by its path or, without any folder, by its name alone. The user's
    scenes have any name."""
    if "/" not in file:
        return file in file_names(root) or file.endswith(".blend")
    return (path.parent / file).exists() or any((root / folder / file).exists() for folder in FOLDERS)


def problems(path, root=ROOT):
    """What a page names that is not there, in words."""
    text = path.read_text()
    for link in links(text):
        if re.match(r"[a-z]+:", link):
            continue
        file, _, anchor = link.partition("#")
        target = (path.parent / file).resolve() if file else path
        if not target.exists():
            yield f"the link {link} leads nowhere"
        elif anchor and target.suffix == ".md" and anchor not in anchors(target.read_text()):
            yield f"{link}: no such heading"
        elif anchor and target.suffix == ".html" and f'id="{anchor}"' not in target.read_text():
            yield f"{link}: no such section"
    if path.name in PAST:
        return
    blocks = [line for block in BLOCK.findall(text) for line in block.splitlines()]
    for code in CODE.findall(text) + re.findall(r"^    (.+)$", text, re.M) + blocks:
        for file in FILE.findall(code):
            if not exists(file, path, root):
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
    shown = {(page.parent / link).resolve() for page in PAGES for link in links(page.read_text())}
    pictures = {path for kind in ("webp", "png", "svg") for path in (ROOT / "docs").rglob(f"*.{kind}")}
    assert not pictures - shown


BAD = {  # text of a page: what is wrong with it
    "[a](none.md)": "the link none.md leads nowhere",
    "![a](none.webp)": "the link none.webp leads nowhere",
    '<img src="none.png" width="9">': "the link none.png leads nowhere",
    "[a](#other)": "#other: no such heading",
    "[a](page.html#other)": "page.html#other: no such section",
    "`addon/none.py`": "there is no addon/none.py",
    "`render/none.py`": "there is no render/none.py",
    "`none.glsl`": "there is no none.glsl",
    "`make nothing`": "make has no target nothing",
    "    make nothing": "make has no target nothing",
    "```\nmake nothing\n```": "make has no target nothing",
    "    python -m benchmarks.none": "there is no module benchmarks.none",
}
GOOD = (
    "[a](#title) [b](page.html#here) `addon/render/job.py` `render/job.py` `job.py` `paper/gather.glsl`",
    "`make lint` `python -m benchmarks.gpu --out x` `sample_blends/<name>.py` https://example.org/none.py",
)


@pytest.mark.parametrize("text", [*BAD, *GOOD])
def test_what_is_missing_is_found(tmp_path, text):
    page = tmp_path / "page.md"
    page.write_text(f"# Title\n\n{text}\n")
    (tmp_path / "page.html").write_text('<h2 id="here">Here</h2>')
    assert list(problems(page)) == ([BAD[text]] if text in BAD else [])


def test_the_checkout_is_light():
    assert sum(path.stat().st_size for path in Path(ROOT / "docs").rglob("*") if path.is_file()) < 5e6
