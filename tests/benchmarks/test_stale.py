# SPDX-License-Identifier: GPL-3.0-or-later
"""Every table of measured numbers names its commit, and those that are older than their code are found."""

import subprocess

import pytest

import stale

PAGES = stale.pages()
NUMBERS = "| what | seconds |\n|---|---|\n| a frame | 1.25 |\n"


def git(root, *arguments):
    who = ("-c", "user.name=a", "-c", "user.email=a@example.org", "-c", "commit.gpgsign=false")
    command = ["git", "-C", str(root), *who, *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


class Repository:
    """A small one. dependencies: what the numbers of docs/page.md depend on."""

    def __init__(self, root, dependencies):
        self.root, self.dependencies = root, dependencies
        (root / "docs").mkdir()
        git(root, "init", "--quiet")

    def commit(self, path, text="", subject="change"):
        (self.root / path).parent.mkdir(exist_ok=True)
        (self.root / path).write_text(text)
        git(self.root, "add", ".")
        git(self.root, "commit", "--quiet", "-m", subject)
        return git(self.root, "rev-parse", "--short", "HEAD")

    def findings(self, text):
        (self.root / "docs" / "page.md").write_text(text)
        return list(stale.findings(self.root / "docs" / "page.md", self.root))


@pytest.fixture
def repository(tmp_path, monkeypatch):
    dependencies = {"docs/page.md": ("code",)}
    monkeypatch.setattr(stale, "DEPENDENCIES", dependencies)
    return Repository(tmp_path, dependencies)


def page(commit, how="at", after=""):
    return f"# Page\n\nMeasured {how} commit {commit} (1 May) by\n\n    python -m benchmarks.x\n\n{after}\n{NUMBERS}"


def test_fresh_numbers(repository, capsys):
    commit = repository.commit("code/a.py", "1")
    repository.commit("other/a.py", "1")
    assert repository.findings(page(commit)) == []
    assert stale.main(repository.root) == 0


def test_stale_numbers(repository, capsys):
    commit = repository.commit("code/a.py", "1")
    repository.commit("code/a.py", "2", "one")
    newest = repository.commit("code/b.py", "1", "the latest")
    repository.commit("other/a.py", "1")
    ((kind, words),) = repository.findings(page(commit, after="## Part\n"))
    assert kind == "stale"
    for part in ("docs/page.md", '"Page"', commit, "2 newer commits", f"{newest} the latest", "python -m benchmarks.x"):
        assert part in words
    assert stale.main(repository.root) == 1
    assert words in capsys.readouterr().out


@pytest.mark.parametrize("how, kinds", [("at or before", ["stale"]), ("before", [])])
def test_numbers_of_former_code_are_not_stale(repository, how, kinds):
    commit = repository.commit("code/a.py", "1")
    repository.commit("code/a.py", "2")
    assert [kind for kind, _ in repository.findings(page(commit, how))] == kinds


def test_what_was_decided_then_is_not_stale(repository):
    commit = repository.commit("code/a.py", "1")
    repository.commit("code/a.py", "2")
    repository.dependencies["docs/page.md#Page"] = stale.DECIDED
    assert repository.findings(page(commit)) == []


def test_an_unknown_commit(repository, capsys):
    repository.commit("code/a.py", "1")
    ((kind, words),) = repository.findings(page("1234567"))
    assert kind == "unknown" and "1234567" in words
    assert stale.main(repository.root) == 0
    assert words in capsys.readouterr().out


def test_no_history_at_all(tmp_path, monkeypatch):
    """As in a folder that was unpacked from an archive."""
    monkeypatch.setattr(stale, "DEPENDENCIES", {"page.md": ("code",)})
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    (tmp_path / "page.md").write_text(page("1234567"))
    assert [kind for kind, _ in stale.findings(tmp_path / "page.md", tmp_path)] == ["unknown"]


def test_a_table_without_a_commit(repository, capsys):
    repository.commit("code/a.py", "1")
    ((kind, words),) = repository.findings(f"# Page\n\nMeasured at some time.\n\n{NUMBERS}")
    assert kind == "without" and words.startswith('docs/page.md:5, "Page"')
    assert stale.main(repository.root) == 1


def test_a_page_that_nobody_has_listed(repository):
    commit = repository.commit("code/a.py", "1")
    del repository.dependencies["docs/page.md"]
    ((kind, words),) = repository.findings(page(commit))
    assert kind == "without" and "DEPENDENCIES" in words


NOTES = {  # text of a page: the commits of its one table
    f"measured at commit 1234567\n\n{NUMBERS}": ["1234567"],
    f"(measured at or before\ncommit 1234567, and so on)\n\n{NUMBERS}": ["1234567"],
    f"measured at commits 1234567, 89abcde and 0123456\n\n{NUMBERS}": ["1234567", "89abcde", "0123456"],
    f"measured at commit 1234567\n\n## Part\n\n### Section\n\n{NUMBERS}": ["1234567"],
    f"measured at commit 1234567\n\nmeasured at commit 89abcde\n\n{NUMBERS}": ["89abcde"],
    f"## Part\n\nmeasured at commit 1234567\n\n## Other\n\n{NUMBERS}": None,
    f"{NUMBERS}\nmeasured at commit 1234567\n": None,
    f"`measured at commit 1234567`\n\n{NUMBERS}": None,
    f"```\nmeasured at commit 1234567\n\n```\n\n{NUMBERS}": None,
    f"of commit 1234567\n\n{NUMBERS}": None,
}


@pytest.mark.parametrize("text", NOTES)
def test_the_note_of_a_table(tmp_path, text):
    (tmp_path / "page.md").write_text(f"# Page\n\n{text}")
    (table,) = stale.read(tmp_path / "page.md", tmp_path).tables
    assert (table.note and [commit for _, commit in table.note.marks]) == NOTES[text]


def test_a_page_in_a_folder_has_the_commit_of_the_page_around(tmp_path):
    (tmp_path / "set").mkdir()
    (tmp_path / "set.md").write_text("# Set\n\nmeasured at commit 1234567\n\n## Part\n\nmeasured at commit 89abcde\n")
    (tmp_path / "set" / "one.md").write_text(f"# One\n\n{NUMBERS}")
    found = stale.read(tmp_path / "set" / "one.md", tmp_path)
    assert found.tables[0].note.marks == [("at", "1234567")] and found.notes == []


@pytest.mark.parametrize(
    "cells, measured",
    {
        "0.12": True,
        "**.5 s**": True,
        "1,260 MB": True,
        "1.000, 0.000": True,
        "pack 117 → 25": True,
        "a word": False,
        "`gather_1.py`": False,
        "x2": False,
        "": False,
    }.items(),
)
def test_tables_of_figures(cells, measured):
    assert stale.is_measured(["| a | b |", "|---|---|", f"| 1 | {cells} |"]) is measured


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.relative_to(stale.ROOT).as_posix())
def test_every_table_of_numbers_names_its_commit(path):
    name, page = path.relative_to(stale.ROOT).as_posix(), stale.read(path)
    assert [f"{table.line}: {table.heading}" for table in page.tables if not table.note] == []
    headings = [*(table.heading for table in page.tables), *(note.heading for note in page.notes)]
    assert all(stale.dependencies(name, heading) is not None for heading in headings)
    if name.startswith("docs/measured/"):
        assert page.tables and stale.dependencies(name) is not None


def test_the_lists_name_what_is_there():
    for key, paths in stale.DEPENDENCIES.items():
        name, _, heading = key.partition("#")
        text = (stale.ROOT / name).read_text()
        assert not heading or f"# {heading}\n" in text, key
        for path in paths:
            assert any(stale.ROOT.glob(path.removeprefix(":(glob)"))), path
    for key in stale.NOT_MEASURED:
        name, _, heading = key.partition("#")
        assert f"# {heading}\n" in (stale.ROOT / name).read_text(), key


def test_the_commits_of_the_pages_are_in_the_history():
    if stale.git(stale.ROOT, "rev-parse", "--is-shallow-repository").stdout.strip() != "false":
        pytest.skip("no full history here")
    commits = {commit for path in PAGES for note in stale.read(path).notes for _, commit in note.marks}
    assert len(commits) > 20
    assert {commit for commit in commits if not stale.is_known(commit)} == set()
