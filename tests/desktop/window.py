# SPDX-License-Identifier: GPL-3.0-or-later
"""A full Blender: its window on a screen of its own, worked with mouse and keys, and by Python sent into it; and
without a window, as a render farm runs it."""

import inspect
import json
import os
import socket
import subprocess
import textwrap
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
WIDTH, HEIGHT = 1440, 900
MOST_MAPPINGS = 35_000  # a test adds some thousands, one of a lit viewport up to 25,000
F12 = "96"  # its key code: by name, xdotool holds Alt with it


class Computer:
    """The folder with a Debian in it (tools/desktop.sh), and a user of it who starts from nothing."""

    def __init__(self, folder, backend):
        self.folder, self.backend = folder, backend
        folder.mkdir(parents=True)
        self.environment = {
            "PATH": "/usr/sbin:/usr/bin:/sbin:/bin",
            "HOME": str(folder),
            "LANG": "C.UTF-8",
            "BLENDER_USER_RESOURCES": str(folder / "user"),
            # The drivers on the processor, also where there is a graphics card: the same on every machine.
            "LIBGL_ALWAYS_SOFTWARE": "1",
            "VK_LOADER_DRIVERS_SELECT": "*lvp*",
        }

    def start(self, *command, **options):
        options["env"] = self.environment | options.pop("env", {})
        return subprocess.Popen(["chroot", os.environ["AFTERLIGHT_DESKTOP"], *map(str, command)], **options)

    def call(self, *command, timeout=120, **options):
        """Run to the end and return the output; AssertionError with it where the command fails."""
        process = self.start(*command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
        try:
            output, _ = process.communicate(timeout=timeout)
        finally:
            process.kill()
        assert process.returncode == 0, f"{command} ended with {process.returncode}:\n{output}"
        return output

    def headless(self, *arguments, timeout=300):
        """`blender -b` with these arguments; its output, which must hold no traceback."""
        output = self.call("blender", "-b", "--gpu-backend", self.backend, *arguments, timeout=timeout)
        assert "Traceback" not in output, output
        return output


class Window:
    """A Blender in a window that fills a screen."""

    def __init__(self, computer, *arguments):
        self.computer = computer
        self.log_path = computer.folder / "blender.log"
        self.read_to = 0
        self._start_screen()
        self.start_blender(*arguments)

    def start_blender(self, *arguments):
        ours, theirs = socket.socketpair()
        with self.log_path.open("a") as log, theirs:
            self.blender = self.computer.start(
                "stdbuf",
                "-oL",
                "blender",
                "--gpu-backend",
                self.computer.backend,
                "--window-geometry",
                0,
                0,
                WIDTH,
                HEIGHT,
                *arguments,
                "--python",
                HERE / "inside.py",
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                pass_fds=[theirs.fileno()],
                env=self.display
                | {
                    "AFTERLIGHT_CONTROL": str(theirs.fileno()),
                    "AFTERLIGHT_TESTS": os.pathsep.join(map(str, [HERE.parent, ROOT / "tools"])),
                },
            )
        self.socket, self.received = ours, b""
        self.value("bpy.app.version_string")

    def is_worn_out(self):
        """Whether it has crashed, or soon will: Blender gives no descriptor set of lavapipe back, each is a mapping of
        the process's memory, and Linux allows 65,530 of those (docs/blender/desktop.md)."""
        return self.blender.poll() is not None or (
            Path(f"/proc/{self.blender.pid}/maps").read_bytes().count(b"\n") > MOST_MAPPINGS
        )

    def restart_blender(self):
        self._end(self.blender)
        self.socket.close()
        self.start_blender()

    def _end(self, process):
        process.terminate()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def _start_screen(self):
        number, theirs = os.pipe()
        self.screen = self.computer.start(
            "Xvfb",
            "-displayfd",
            theirs,
            "-screen",
            0,
            f"{WIDTH}x{HEIGHT}x24",
            "-nolisten",
            "tcp",
            pass_fds=[theirs],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(theirs)
        with os.fdopen(number) as answer:
            self.display = {"DISPLAY": ":" + answer.readline().strip()}

    # Python in the window's Blender

    def value(self, expression, timeout=120):
        """Of an expression, in Blender's main thread."""
        return self._ask({"expression": expression}, timeout)

    def run(self, function, *arguments, timeout=120):
        """Call a function of a test inside Blender; it sees `bpy` and what inside.py holds, and nothing else. What it
        is given and returns must fit into JSON."""
        source = textwrap.dedent(inspect.getsource(function))
        return self._ask({"source": source, "name": function.__name__, "arguments": arguments}, timeout)

    def _ask(self, request, timeout):
        self.socket.settimeout(timeout)
        try:
            self.socket.sendall(json.dumps(request, default=str).encode() + b"\n")
            while b"\n" not in self.received:
                data = self.socket.recv(1 << 20)
                if not data:
                    raise ConnectionError("it has ended")
                self.received += data
        except TimeoutError as error:
            raise AssertionError(f"Blender does not answer after {timeout} s:\n{self.log()[-3000:]}") from error
        except ConnectionError as error:
            code = self.blender.wait(30)
            raise AssertionError(
                f"Blender has ended with {code}:\n{self.log()[-3000:]}\n{self._crash_report()}"
            ) from error
        line, self.received = self.received.split(b"\n", 1)
        reply = json.loads(line)
        assert "error" not in reply, reply["error"]
        return reply["value"]

    def wait(self, expression, timeout=180):
        """Until an expression is true in Blender."""
        end = time.monotonic() + timeout
        while not self.value(expression, timeout):
            assert time.monotonic() < end, f"still not so after {timeout} s: {expression}\n{self.log()[-3000:]}"
            time.sleep(0.05)

    # Mouse, keys and eyes

    def xdotool(self, *arguments):
        return self.computer.call("xdotool", *arguments, env=self.display)

    def move(self, x, y):
        """The mouse to a place in the window, counted from the bottom left as Blender does."""
        self.xdotool("mousemove", round(x), round(HEIGHT - 1 - y))

    def click(self, button=1):
        self.xdotool("click", button)

    def over(self, kind):
        """The mouse to the middle of an editor, so that keys go there."""
        x, y, width, height = self.value(f"box({kind!r})")
        self.move(x + width / 2, y + height / 2)
        time.sleep(0.2)

    def key(self, *keys):
        self.xdotool("key", *(key.replace("F12", F12) for key in keys))

    def picture(self, name, kind=None):
        """A picture of the screen, or of the largest editor of a kind, kept in the folder of the run; its path."""
        path = self.computer.folder / f"{name}.png"
        cut = []
        if kind:
            x, y, width, height = self.value(f"box({kind!r})")
            cut = ["-crop", f"{width}x{height}+{x}+{HEIGHT - y - height}", "+repage"]
        self.computer.call("import", "-window", "root", *cut, path, env=self.display)
        return path

    def point_at(self, data_path, along=36, kind="PROPERTIES"):
        """The mouse onto the button of a property, looking for it from the top of the editor downwards as one does;
        `along` pixels from the left, where panels have the box in their header."""
        x, y, width, height = self.value(f"box({kind!r})")
        self.move(x + width / 2, y + height / 2)
        self.xdotool("click", "--repeat", 60, "--delay", 5, 4)
        for _ in range(10):
            for up in range(y + height - 10, y, -13):
                self.move(x + along, up)
                time.sleep(0.03)
                if self.value(f"hovered({kind!r})") == data_path:
                    return
            self.xdotool("click", "--repeat", 10, "--delay", 5, 5)
            time.sleep(0.3)
        raise AssertionError(f"no button of {data_path} in {kind}: {self.picture('not_found')}")

    # The whole

    def _crash_report(self):
        """What Blender wrote as it crashed, if it did: its last operations and where it stood."""
        return self.computer.call("sh", "-c", "cat /tmp/*.crash.txt; rm -f /tmp/*.crash.txt")

    def log(self):
        return self.log_path.read_text(errors="replace")

    def new_log(self):
        """What Blender has printed since this was last asked."""
        text = self.log()
        new, self.read_to = text[self.read_to :], len(text)
        return new

    def finished_renders(self):
        return self.value("happened('render_complete')")

    def start_render(self):
        self.over("VIEW_3D")
        self.key("F12")

    def render(self, timeout=180):
        """F12, and wait for the picture."""
        before = self.finished_renders()
        self.start_render()
        self.wait(f"happened('render_complete') > {before} and not rendering()", timeout)

    def close(self):
        for process in (self.blender, self.screen):
            self._end(process)
        self.socket.close()
