# SPDX-License-Identifier: GPL-3.0-or-later
"""The structure of the sources: which module may import which, names, sizes, and state that modules hold.

Read from the text, with the imports inside functions, which hide a circle and do not undo it."""

import ast
import re
from collections import Counter
from pathlib import Path

import extension

ADDON = extension.ROOT / "addon"
# Blender's modules that know nothing of scenes, and those that come with its Python.
OF_THE_GATHER = {
    "gpu",
    "numpy",
    "collections",
    "dataclasses",
    "functools",
    "pathlib",
    "time",
    "typing",
    "__future__",
    "concurrent",
    "re",
}


def modules(root):
    """{dotted name: path} of a package's modules; "" is the package itself."""
    found = {}
    for path in sorted(root.rglob("*.py")):
        parts = path.relative_to(root).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports(name, path, known):
    """(names of modules of the package, names of modules outside) that one module imports, wherever it does."""
    package = name.split(".") if path.name == "__init__.py" and name else name.split(".")[:-1]
    inside, outside = set(), set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            outside |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level:
            outside.add(node.module)
        elif isinstance(node, ast.ImportFrom):
            base = ".".join([*package[: len(package) + 1 - node.level], *(node.module or "").split(".")]).strip(".")
            for alias in node.names:
                full = f"{base}.{alias.name}".strip(".")
                inside.add(full if full in known else base)
    return inside, outside


def circle(graph):
    """A list of modules each of which imports the next and the last the first; empty where there is none."""
    done, path = set(), []

    def visit(name):
        if name in path:
            return path[path.index(name) :]
        if name in done:
            return []
        path.append(name)
        for other in sorted(graph[name]):
            if found := visit(other):
                return found
        done.add(path.pop())
        return []

    return next((found for name in sorted(graph) if (found := visit(name))), [])


def graph_of(root):
    known = modules(root)
    return {name: imports(name, path, known)[0] for name, path in known.items()}


def test_no_module_imports_itself_by_way_of_others():
    assert circle(graph_of(ADDON)) == []


def test_no_module_of_the_benchmarks_does():
    assert circle(graph_of(extension.ROOT / "benchmarks")) == []


def test_a_circle_is_found(tmp_path):
    for name, text in {
        "a": "from . import b",
        "b": "def f():\n    from .c import x",
        "c": "from . import a",
        "d": "",
    }.items():
        (tmp_path / f"{name}.py").write_text(text)
    assert circle(graph_of(tmp_path)) == ["a", "b", "c"]
    (tmp_path / "c.py").write_text("from . import d")
    assert circle(graph_of(tmp_path)) == []


def test_the_gather_knows_no_scene():
    known = modules(ADDON)
    for name, path in known.items():
        if name.split(".")[0] == "gather":
            inside, outside = imports(name, path, known)
            assert {other.split(".")[0] for other in inside} <= {"gather"}, name
            assert {other.split(".")[0] for other in outside} <= OF_THE_GATHER, name


def allowed_imports(page):
    """{folder of the add-on: the folders that it may import}, of the table in docs/ARCHITECTURE.md. "settings" stands
    for modules that lie in no folder."""
    rows = re.findall(r"^\| (?:\*(\w+)\*: )?`addon/(\w+)[/.].*\| ([\w, ]+) \|$", page, re.M)
    return {name or folder: set(imported.split(", ")) for name, folder, imported in rows}


def forbidden_imports(root, allowed):
    """(importing module, imported one) that the table does not allow."""

    def folder(name):
        return name.split(".")[0] if root.joinpath(name.split(".")[0]).is_dir() else "settings"

    for name, others in graph_of(root).items():
        for other in others if name else ():  # the add-on's own __init__ registers all parts
            of, used = folder(name), folder(other)
            # Translations import nothing.
            if used not in allowed.get(of, set()) | {of} | ({"translations"} if of != "gather" else set()):
                yield name, other


def test_imports_are_those_of_the_architecture():
    allowed = allowed_imports((extension.ROOT / "docs" / "ARCHITECTURE.md").read_text())
    folders = {path.parent.name for path in ADDON.glob("*/__init__.py")} - {"translations"}
    assert allowed.keys() == folders | {"settings"}
    assert not list(forbidden_imports(ADDON, allowed))


def test_a_forbidden_import_is_found(tmp_path):
    allowed = allowed_imports(
        "| `addon/high/` | what | settings, low |\n| *settings*: `addon/a.py`, `b.py` | x | low |\n"
        "| `addon/low/` | y | nothing |\n"
    )
    assert allowed == {"high": {"settings", "low"}, "settings": {"low"}, "low": {"nothing"}}
    for name, text in {
        "__init__": "from . import a, high",
        "a": "from .low import x",
        "high/__init__": "from ..low import x\nfrom .. import a",
        "low/__init__": "",
        "low/x": "def f():\n    from .. import a",
    }.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / f"{name}.py").write_text(text)
    assert list(forbidden_imports(tmp_path, allowed)) == [("low.x", "a")]


def test_no_two_modules_share_a_name():
    for root in (ADDON, extension.ROOT / "benchmarks", extension.ROOT / "shaders"):
        names = Counter(path.stem for path in root.rglob("*.*") if path.suffix in {".py", ".glsl"})
        twice = {name for name, count in names.items() if count > 1} - {"__init__", "__main__"}
        presets = {path.stem for path in (ADDON / "presets").rglob("*.py")}
        assert not twice - presets, (root, twice)


def test_files_can_be_held_in_the_head():
    tables = {"addon/translations/de_DE.py"}  # one text a line
    for path in sorted(Path(ADDON).rglob("*.py")):
        lines = len(path.read_text().splitlines())
        assert lines <= 340 or path.relative_to(extension.ROOT).as_posix() in tables, f"{path}: {lines} lines"


def state_of(source):
    """{name: text of its line and of the comment above} of the variables of a module that change while it is used."""
    tree, lines, found = ast.parse(source), source.splitlines(), {}
    rebound = {name for node in ast.walk(tree) if isinstance(node, ast.Global) for name in node.names}
    for node in tree.body:
        targets = (
            node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
        )
        names = {each.id for target in targets for each in ast.walk(target) if isinstance(each, ast.Name)}
        is_container = isinstance(node, ast.Assign | ast.AnnAssign) and any(
            isinstance(each, ast.Dict | ast.List | ast.Set | ast.Call) for each in _values(node.value)
        )
        for name in names:
            if name in rebound or (
                is_container and name.startswith("_") and not name.startswith("__") and not name.isupper()
            ):
                first = node.lineno - 1
                while first and lines[first - 1].startswith("#"):
                    first -= 1
                found[name] = "\n".join(lines[first : node.end_lineno])
    return found


def _values(node):
    return node.elts if isinstance(node, ast.Tuple) else [node]


def test_state_of_a_module_says_why_it_is_global():
    """What lives as long as one render is in render/job.py."""
    for path in sorted(ADDON.rglob("*.py")):
        for name, text in state_of(path.read_text()).items():
            if "bpy.utils.register" not in text:
                assert "global" in text.lower(), f"{path.relative_to(ADDON)}: {name}"


def test_state_of_a_module_is_found():
    source = (
        "_a = {}\nB = {}\n# global, for a reason\n_c, _d = [], set()\ne = None\ndef f():\n    global e\n    e = 1\n"
    )
    found = state_of(source)
    assert found.keys() == {"_a", "_c", "_d", "e"} and "reason" in found["_c"] and "global" not in found["_a"]
