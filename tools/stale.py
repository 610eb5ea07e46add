# SPDX-License-Identifier: GPL-3.0-or-later
"""Which pages have measured numbers that are older than the code they depend on.

    .venv/bin/python tools/stale.py          (make stale)

Prints, by page and heading, the commit that was measured, how many commits have changed the code since, the latest of
them, and the command of the page that measures again. A commit that only renames or reformats counts too: what it
changed is for a reader to judge. Those to a file under a former path do not count, but the one that moved it does. Exit
code 1 if numbers are stale or a table names no commit; else 0, also where a commit is not in the history, as in a
shallow clone: that is said.

The wording, NOTE below: "measured at commit 1a2b3c4", "measured at or before commit 1a2b3c4" where only the commit
that brought the numbers is known, "measured before commit 1a2b3c4" for numbers of former code, kept for what they
decided and never stale; several as "commits 1a2b3c4 and 5d6e7f8". It stands in a paragraph before the table, in its
section or in the text at the top of a section around that; the nearest one counts. The command stands in the same
paragraph, as code right before it, or after it.
"""

import re
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
HASH = r"[0-9a-f]{7,40}\b"
NOTE = re.compile(rf"\bmeasured (at or before|at|before) commits? ({HASH}(?:(?:, | and ){HASH})*)", re.I)
COMMAND = re.compile(r"(?:PYTHONPATH=|\.venv/bin/python |python -m |make )[^`]+")
FIGURE = re.compile(r"(?<![\w/`.^-])[+<-]?\.?\d[\d,.]*(?:e-?\d+)?(?![\w`/])")  # a number that stands alone

# What the light of a frame depends on, and the parts of it.
GATHER = "addon/gather", "shaders"
PAPER = "addon/gather", "shaders/common", "shaders/paper"
FRAME = *GATHER, "addon/parameters.py", "addon/presets", "addon/render", "addon/scene", "addon/views"
SCENES = ":(glob)sample_blends/**/*.blend"
DECIDED = ()  # old beside new code, or a prototype, at that time: no later change makes it wrong
# Page, or page#heading for a section of its own: what its numbers depend on, as git's pathspecs.
DEPENDENCIES = {
    "README.md": (*FRAME, "benchmarks/accuracy", SCENES),
    "docs/ARCHITECTURE.md": DECIDED,
    "docs/blender/desktop.md": (*GATHER, "addon/host", "addon/render", "tests/desktop/stalls.py"),
    "docs/blender/rendering.md#Ray tracing and files": (
        "addon/scene/passes.py",
        "addon/scene/frame_store.py",
        "addon/scene/exr.py",
        "benchmarks/studies/blender_study.py",
    ),
    "docs/blender/rendering.md#Light behind media": ("addon/scene/transmittance.py", "addon/scene/media.py"),
    "docs/blender/viewport.md": (*GATHER, "addon/viewport", "addon/views", "tests/desktop/viewport_speed.py"),
    "docs/blender/views.md": (
        *FRAME,
        "benchmarks/studies/field_study.py",
        "benchmarks/studies/angle_study.py",
        "benchmarks/studies/views_study.py",
        "benchmarks/cost/views_limits.py",
        "benchmarks/motion/steadiness.py",
        "benchmarks/motion/view_change.py",
    ),
    "docs/blender/views.md#Cost of rays (addon/views/proxy_mesh.py)": (
        "addon/views",
        "benchmarks/studies/placing_study.py",
        "benchmarks/cost/views_limits.py",
    ),
    "docs/measured/accuracy.md": (*FRAME, "benchmarks/accuracy", SCENES),
    "docs/measured/accuracy.md#EEVEE's ray tracing at its best": (
        "benchmarks/studies/eevee_study.py",
        "benchmarks/accuracy/metrics.py",
        "benchmarks/accuracy/references.py",
        SCENES,
    ),
    "docs/measured/bench.md": (*FRAME, "addon/compositor", "benchmarks/cost/bench.py"),
    "docs/measured/bench.md#Constant cost": (*PAPER, "benchmarks/cost/constant_cost.py"),
    "docs/measured/motion.md": (*FRAME, "benchmarks/motion", "sample_blends/moving"),
    "docs/measured/soak.md": ("addon", "shaders", "benchmarks/soak.py"),
    "docs/measured/speed.md": (*PAPER, "benchmarks/gpu"),
    "docs/measured/speed_study.md": DECIDED,
    "docs/measured/tick.md": ("addon", "shaders", "benchmarks/cost"),
    "docs/method/glossy.md": (*FRAME, "benchmarks/studies/glossy_study.py"),
    "docs/method/paper.md": (*PAPER, "benchmarks/studies/method_study.py"),
    "docs/method/radiosity.md": (
        "addon/gather",
        "shaders/common",
        "shaders/radiosity",
        "benchmarks/studies/radiosity_study.py",
    ),
    "docs/method/temporal.md": DECIDED,
}
# Page#heading of tables full of numbers that were not measured.
NOT_MEASURED = {
    "docs/method/glossy.md#Tests": "what was changed by how much, to see a test fail",
    "docs/method/paper.md#Pyramid (`merge.glsl`)": "bits, and the error that they allow; tests hold it",
    "docs/method/radiosity.md#The constants": "values in the code, and why",
}


@dataclass
class Note:
    """A paragraph that names commits. level: of its heading, 1 for the page's; marks: (wording, commit) pairs; command:
    that measures again, or ""."""

    level: int
    heading: str
    marks: list
    command: str = ""


@dataclass
class Table:
    """A table of measured numbers; note: the nearest one before it, or None."""

    line: int
    heading: str
    note: Note | None


@dataclass
class Page:
    notes: list = field(default_factory=list)
    tables: list = field(default_factory=list)


def blocks(text):
    """(number of the first line, lines) of each paragraph, heading, table or piece of code."""
    found, fenced, lines = [], False, text.splitlines()
    for number, line in enumerate([*lines, ""], 1):
        fence = line.startswith("```")
        if not fenced and (not line.strip() or line.startswith("#")) or fence and not fenced:
            if found:
                yield number - len(found), found
            found = []
            if line.startswith("#"):
                yield number, [line]
                continue
        if line.strip() or fenced:
            found.append(line)
        fenced ^= fence


def is_measured(rows):
    """Whether a table's rows are figures: numbers in half of the cells of some column but the first."""
    cells = [[cell.strip() for cell in row.strip().strip("|").split("|")] for row in rows[2:]]
    columns = zip(*([*row, *[""] * len(cells[0])][: len(cells[0])] for row in cells)) if cells else ()
    return any(2 * sum(bool(FIGURE.search(cell)) for cell in column) >= len(cells) for column in list(columns)[1:])


def page_around(name):
    """The page that a page in a folder of the same name belongs to: docs/measured/accuracy.md, where there is one."""
    return f"{Path(name).parent.as_posix()}.md"


def read(path, root=ROOT):
    """The Page of a file. What is said at the top of docs/measured/accuracy.md holds in docs/measured/accuracy/*.md."""
    page, name = Page(), path.relative_to(root).as_posix()
    around = root / page_around(name)
    notes = read(around, root).notes if around.is_file() else ()
    top = next((note for note in notes if note.level <= 1), None)
    section, before = [(0, "", top)], ""  # (level, heading, its note) of the sections around; the block before, if code
    for number, lines in blocks(path.read_text()):
        if heading := re.match(r"(#+) (.+)", lines[0]):
            level = len(heading[1])
            while section[-1][0] >= level:
                section.pop()
            section.append((level, heading[2], None))
            before = ""
            continue
        level, title, note = section[-1]
        if lines[0].startswith("|"):
            if is_measured(lines) and f"{name}#{title}" not in NOT_MEASURED:
                nearest = next((note for _, _, note in reversed(section) if note), None)
                page.tables.append(Table(number, title, nearest))
            continue
        is_code = lines[0].startswith(("    ", "```"))
        text = " ".join(line.strip() for line in lines)
        commands = [code for code in ([text] if is_code else re.findall("`([^`]+)`", text)) if COMMAND.match(code)]
        said = "" if is_code else re.sub("`[^`]*`", "`", text)  # an example of the wording is no note
        if marks := [(how.lower(), commit) for how, all_ in NOTE.findall(said) for commit in re.findall(HASH, all_)]:
            note = Note(level, title, marks)
            page.notes.append(note)
            section[-1] = level, title, note
            note.command = commands[0] if commands else before
        elif note and not note.command and commands:
            note.command = commands[0]
        before = commands[0] if is_code and commands else ""
    return page


def dependencies(name, heading=""):
    """The pathspecs that the numbers of a page, or a section with its own, depend on; None where nobody has said."""
    for key in (f"{name}#{heading}", name, page_around(name)):
        if key in DEPENDENCIES:
            return DEPENDENCIES[key]
    return None


def pages(root=ROOT):
    return sorted([*root.glob("*.md"), *(root / "docs").rglob("*.md")])


def git(root, *arguments):
    return subprocess.run(["git", "-C", str(root), *arguments], capture_output=True, text=True)


def is_known(commit, root=ROOT):
    """Whether HEAD stands on this commit."""
    return git(root, "merge-base", "--is-ancestor", commit, "HEAD").returncode == 0


def newer(commit, paths, root=ROOT):
    """Commits ("1a2b3c4 subject") that have changed paths since one, newest first."""
    return git(root, "log", "--format=%h %s", f"{commit}..HEAD", "--", *paths).stdout.splitlines()


def findings(path, root=ROOT):
    """(kind, words) of what is wrong with a page's numbers; kind: "stale", "without" a commit, or "unknown"."""
    name, page = path.relative_to(root).as_posix(), read(path, root)
    for table in page.tables:
        if not table.note:
            yield "without", f'{name}:{table.line}, "{table.heading}": a table of numbers that names no commit'
    for note in page.notes:
        paths, where = dependencies(name, note.heading), f'{name}, "{note.heading}"'
        if paths is None:
            yield "without", f"{where}: what its numbers depend on is not in DEPENDENCIES of tools/stale.py"
            continue
        for how, commit in note.marks:
            if not is_known(commit, root):
                yield "unknown", f"{where}: commit {commit} is not in this history (a shallow clone, another branch?)"
            elif how != "before" and paths and (since := newer(commit, paths, root)):
                count = f"{len(since)} newer commit{'s' * (len(since) > 1)}, the latest {since[0]}"
                again = note.command or "no command on the page"
                yield "stale", f"{where}, measured {how} {commit}: {count}\n    {again}"


def main(root=ROOT):
    found = [finding for path in pages(root) for finding in findings(path, root)]
    for title, kind in (
        ("Older than the code they depend on:", "stale"),
        ("Without a commit:", "without"),
        ("Not judged:", "unknown"),
    ):
        if words := [text for each, text in found if each == kind]:
            print(title, *words, sep="\n  ", end="\n\n")
    stale = sum(kind == "stale" for kind, _ in found)
    print(f"{stale} measurement{'s' * (stale != 1)} older than the code.")
    return int(any(kind != "unknown" for kind, _ in found))


if __name__ == "__main__":
    sys.exit(main())
