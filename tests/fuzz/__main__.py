# SPDX-License-Identifier: GPL-3.0-or-later
"""Fuzz the installed extension: `python -m fuzz machine bl_ext.user_default.afterlight`, or for an hour `python -m
fuzz hour`.

Each kind runs in a process of its own with a seed; the journal of one that fails is printed.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

KINDS = {"machine": 10, "claims": 60, "files": 100}  # examples of a run


def main():
    parser = argparse.ArgumentParser(prog="fuzz", description=__doc__.splitlines()[0])
    parser.add_argument("kind", choices=[*KINDS, "hour"])
    parser.add_argument("module", nargs="?", help="the installed extension; left out, it is packaged and installed")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--examples", type=int)
    parser.add_argument("--journal")
    parser.add_argument("--minutes", type=float, default=60, help="of kind hour")
    options = parser.parse_args()
    if options.kind == "hour":
        sys.exit(hour(options.minutes, options.seed))
    one(options)


def hour(minutes, seed):
    """Run all kinds in turns, with another seed each time, until the time is over. Returns how many runs failed."""
    end, failed, runs = time.monotonic() + 60 * minutes, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        while time.monotonic() < end:
            for kind in KINDS:
                journal = Path(folder) / "journal.txt"
                journal.unlink(missing_ok=True)
                run = subprocess.run(
                    [
                        sys.executable,
                        "-X",
                        "faulthandler",
                        "-m",
                        "fuzz",
                        kind,
                        "--seed",
                        str(seed),
                        "--journal",
                        str(journal),
                    ],
                    capture_output=True,
                    text=True,
                )
                runs += 1
                if run.returncode:
                    failed += 1
                    steps = journal.read_text().splitlines()[-60:] if journal.exists() else []
                    print(
                        f"=== {kind}, seed {seed}: exit code {run.returncode}",
                        *steps,
                        run.stdout[-3000:],
                        run.stderr[-5000:],
                        sep="\n",
                        flush=True,
                    )
            seed += 1
    print(f"{runs - failed} passed, {failed} failed")
    return int(failed > 0)


def one(options):
    import extension

    if options.module is None:
        module = extension.start()
    else:
        import bpy

        bpy.ops.preferences.addon_enable(module=options.module)
        module = sys.modules[options.module]
    from hypothesis import HealthCheck, Phase, settings
    from hypothesis.stateful import run_state_machine_as_test

    common = settings(
        max_examples=options.examples or KINDS[options.kind],
        deadline=None,
        database=None,
        derandomize=False,
        suppress_health_check=list(HealthCheck),
        phases=(Phase.generate,),
        stateful_step_count=25,
        print_blob=False,
    )
    if options.kind == "machine":
        from . import machine

        kind = type("Machine", (machine.FileMachine,), {"module": module, "journal": options.journal})
        kind._hypothesis_internal_use_seed = options.seed
        run_state_machine_as_test(kind, settings=common)
    else:
        from . import claims

        claims.run(options.kind, module, common, options.seed, options.journal)


if __name__ == "__main__":
    main()
