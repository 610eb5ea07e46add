# SPDX-License-Identifier: GPL-3.0-or-later
"""The package: what it contains, what Blender makes of it on each platform, and that nothing is left behind."""

import ast
import json
import os
import re
import subprocess
import sys
import sysconfig
import textwrap
import zipfile
from pathlib import Path

import bpy
import pytest

import extension

ROOT = extension.ROOT
SOURCES = [ROOT / "__init__.py", *sorted((ROOT / "addon").rglob("*.py"))]
SHADERS = sorted(path for path in (ROOT / "shaders").rglob("*") if path.is_file())


@pytest.fixture(scope="module")
def names(package):
    return zipfile.ZipFile(package).namelist()


def wheels():
    return sorted(path.removeprefix("./") for path in extension.manifest()["wheels"])


def test_zip_holds_all_that_is_needed_and_nothing_else(names):
    sources = [path.relative_to(ROOT).as_posix() for path in (*SOURCES, *SHADERS)]
    assert sorted(names) == sorted(["blender_manifest.toml", "LICENSE", "docs/help.html", *sources, *wheels()])


def test_size(package, record_property):
    size = package.stat().st_size
    record_property("zip_bytes", size)
    print(f"{package.name}: {size / 1e6:.2f} MB")
    assert size < 10e6, "the five wheels are 7.6 MB; what else has grown?"


def test_zip_is_named_after_the_manifest(package):
    fields = extension.manifest()
    assert package.name == f"afterlight-{fields['version']}.zip"
    assert re.fullmatch(r"\d+\.\d+\.\d+", fields["version"])


def test_blender_validates_source_and_zip(package):
    for path in (ROOT, package):
        assert "Success parsing TOML" in extension.blender_ext("validate", path)


def test_tagline_follows_the_rules():
    tagline = extension.manifest()["tagline"]
    assert 0 < len(tagline) <= 64
    assert tagline[-1].isalnum()


def test_wheels_are_those_whose_hashes_are_pinned():
    pinned = (ROOT / "requirements-wheels.txt").read_text()
    (version,) = re.findall(r"^OpenEXR==(\S+)", pinned, re.M)
    assert all(Path(name).name.startswith(f"openexr-{version}-") for name in wheels())
    assert pinned.count("sha256:") == len(wheels())


@pytest.mark.parametrize(
    "platform, python, expected",
    [
        ("linux-x86_64", (3, 13), "cp313-manylinux_2_28_x86_64"),
        ("linux-x86_64", (3, 14), "cp314-manylinux_2_28_x86_64"),
        ("macosx-11.0-arm64", (3, 13), "cp313-macosx_11_0_arm64"),
        ("macosx-11.0-x86_64", (3, 13), "cp313-macosx_10_15_x86_64"),
        ("win-amd64", (3, 13), "cp313-win_amd64"),
    ],
)
def test_blender_picks_the_one_right_wheel(monkeypatch, platform, python, expected):
    from bl_pkg.bl_extension_ops import _extensions_wheel_filter_for_this_system as wheel_filter

    with monkeypatch.context() as elsewhere:
        elsewhere.setattr(sysconfig, "get_platform", lambda: platform)
        elsewhere.setattr(sys, "version_info", (*python, 0, "final", 0))
        picked = wheel_filter(wheels())
    assert [name.removesuffix(".whl").split("-", 3)[-1] for name in picked] == [expected]


def test_installed_and_enabled(afterlight):
    assert Path(afterlight.__file__).is_relative_to(os.environ["BLENDER_USER_RESOURCES"])
    assert extension.MODULE in bpy.context.preferences.addons


def test_an_empty_file_keeps_the_extension(fresh):
    assert extension.MODULE in bpy.context.preferences.addons
    assert len(bpy.data.scenes) == 1 and not bpy.data.objects
    assert fresh.afterlight


# A Blender of its own, for what the shared one must not go through. `snapshot` holds all that an add-on can leave
# registered.
ANOTHER_BLENDER = """
import json, os, sys
import bpy
import extension
from pathlib import Path

def snapshot():
    handlers = {name: [f"{f.__module__}.{f.__qualname__}" for f in getattr(bpy.app.handlers, name)]
                for name in dir(bpy.app.handlers) if isinstance(getattr(bpy.app.handlers, name), list)}
    drawn = {}
    properties = {}
    for name in sorted(dir(bpy.types)):
        kind = getattr(bpy.types, name)
        if functions := getattr(getattr(kind, "draw", None), "_draw_funcs", None):
            drawn[name] = [f"{f.__module__}.{f.__qualname__}" for f in functions if "afterlight" in f.__module__]
        if rna := getattr(kind, "bl_rna", None):
            properties[name] = sorted(rna.properties.keys())
    operators = {area: sorted(dir(getattr(bpy.ops, area))) for area in dir(bpy.ops)}
    return dict(types=sorted(properties), properties=properties, handlers=handlers, operators=operators,
                drawn={name: functions for name, functions in drawn.items() if functions},
                keymaps={keymap.name: len(keymap.keymap_items)
                         for keymap in bpy.context.window_manager.keyconfigs.addon.keymaps},
                engines=sorted(c.__name__ for c in bpy.types.RenderEngine.__subclasses__() if c.is_registered))

def differences(one, other):
    return [key for key in one if one[key] != other[key]]

user_folder = Path(os.environ["BLENDER_USER_RESOURCES"])
zip_path = sys.argv[1]
"""


def another_blender(user_folder, package, script):
    """Run a script in a Blender that keeps its preferences in `user_folder`; return the last line it prints, parsed as
    JSON."""
    run = subprocess.run(
        [sys.executable, "-c", ANOTHER_BLENDER + textwrap.dedent(script), str(package)],
        text=True,
        capture_output=True,
        env={**os.environ, "BLENDER_USER_RESOURCES": str(user_folder), "PYTHONPATH": str(ROOT / "tools")},
    )
    assert run.returncode == 0, run.stdout + run.stderr
    assert "Traceback" not in run.stdout + run.stderr, run.stdout + run.stderr
    return json.loads([line for line in run.stdout.splitlines() if line.startswith("{")][-1])


def test_nothing_stays_registered(tmp_path, package):
    result = another_blender(
        tmp_path,
        package,
        """
        before = snapshot()
        extension.install(zip_path)
        enabled = snapshot()
        bpy.ops.preferences.addon_disable(module=extension.MODULE)
        disabled = snapshot()
        bpy.ops.preferences.addon_enable(module=extension.MODULE)
        again = snapshot()
        bpy.ops.extensions.package_uninstall(repo_index=1, pkg_id="afterlight")
        print(json.dumps(dict(
            enabled=differences(before, enabled), disabled=differences(before, disabled),
            again=differences(enabled, again), uninstalled=differences(before, snapshot()),
            files=[str(p) for p in user_folder.rglob("*") if p.is_file() and
                   ("afterlight" in p.name or "openexr" in p.name.lower())])))
    """,
    )
    assert "properties" in result["enabled"], "the snapshot must see what the extension adds"
    assert result["disabled"] == []
    assert result["again"] == []
    assert result["uninstalled"] == []
    assert result["files"] == []


def test_openexr_comes_from_the_wheel_in_the_zip(tmp_path, package):
    """At its next start, where this looks, Blender puts the folder of wheels ahead of Python's own."""
    another_blender(tmp_path, package, "extension.install(zip_path); os.write(1, b'{}\\n'); os._exit(0)")
    result = another_blender(
        tmp_path,
        package,
        """
        import OpenEXR
        print(json.dumps(dict(file=OpenEXR.__file__, version=OpenEXR.__version__)))
    """,
    )
    assert Path(result["file"]).is_relative_to(tmp_path / "extensions" / ".local")
    assert f"openexr-{result['version']}-" in wheels()[0]


def imports(tree):
    """(level, first name of the module, line) of every import in a syntax tree, at any depth."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for name in node.names:
                yield 0, name.name.split(".")[0], node.lineno
        elif isinstance(node, ast.ImportFrom):
            yield node.level, (node.module or "").split(".")[0], node.lineno


def run_at_import(tree):
    """The expressions that run when a module is imported: everything outside functions, and the defaults of
    functions."""
    waiting = list(tree.body)
    while waiting:
        node = waiting.pop()
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            waiting += [*node.decorator_list, *node.args.defaults, *(d for d in node.args.kw_defaults if d)]
        elif not isinstance(node, ast.Lambda):
            yield node
            waiting += ast.iter_child_nodes(node)


def root_name(node):
    while isinstance(node, (ast.Attribute, ast.Call)):
        node = node.value if isinstance(node, ast.Attribute) else node.func
    return getattr(node, "id", None)


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_source_follows_the_rules_for_extensions(path):
    text = path.read_text()
    tree = ast.parse(text)
    allowed = (sys.stdlib_module_names - {"_thread", "multiprocessing", "subprocess"}) | {
        "blf",
        "bpy",
        "bpy_extras",
        "bl_operators",
        "bl_ui",
        "gpu",
        "gpu_extras",
        "mathutils",
        "idprop",
        "numpy",
        "OpenEXR",
    }
    wrong = [f"line {line}: import {name}" for level, name, line in imports(tree) if level == 0 and name not in allowed]
    wrong += [
        f"line {node.lineno}: sys.{node.attr}"
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and root_name(node) == "sys" and node.attr in ("path", "meta_path")
    ]
    # To wait for another thread is fine; to make one is not: Blender's data is for its own threads alone.
    wrong += [
        f"line {node.lineno}: makes threads"
        for node in ast.walk(tree)
        if isinstance(node, (ast.Attribute, ast.Name, ast.alias))
        and getattr(node, "attr", getattr(node, "id", getattr(node, "name", "")))
        in {"Thread", "Timer", "ThreadPoolExecutor", "ProcessPoolExecutor", "ThreadPool", "start_new_thread"}
    ]
    wrong += [
        f"line {node.lineno}: gpu called at import, which fails in blender -b"
        for node in run_at_import(tree)
        if isinstance(node, ast.Call) and root_name(node) == "gpu"
    ]
    assert not wrong
    assert text.startswith("# SPDX-License-Identifier: GPL-3.0-or-later\n")


@pytest.mark.parametrize("path", SHADERS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_shader_has_a_license(path):
    assert path.read_text().startswith("// SPDX-License-Identifier: GPL-3.0-or-later\n")
