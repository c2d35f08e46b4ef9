"""Debian's Chromium, by its debugging protocol on a pipe: opens pages, and takes pictures of them."""

import base64
import json
import os
import shutil
import subprocess

PROGRAM = shutil.which("chromium")
# WebGL by software, as machines for tests have no graphics card.
OPTIONS = ["--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
OPTIONS += ["--ignore-gpu-blocklist", "--window-size=640,480", "--hide-scrollbars", "--remote-debugging-pipe"]


class Browser:
    def __init__(self, profile):
        self._count, self._session = 0, None
        (commands, self._commands), (self._answers, answers) = os.pipe(), os.pipe()

        def to_three_and_four():
            kept = [os.dup(commands), os.dup(answers)]
            os.dup2(kept[0], 3)
            os.dup2(kept[1], 4)

        self._process = subprocess.Popen(
            [PROGRAM, *OPTIONS, f"--user-data-dir={profile}"],
            preexec_fn=to_three_and_four,
            close_fds=False,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(commands)
        os.close(answers)
        self._read = b""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self._commands)  # which ends the program
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._answers)

    def call(self, method, **values):
        """Returns the result of a command; events that come before it are passed over."""
        self._count += 1
        message = {"id": self._count, "method": method, "params": values}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._commands, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self._read:
                read = os.read(self._answers, 1 << 20)
                assert read, "the browser has ended"
                self._read += read
            answer, _, self._read = self._read.partition(b"\0")
            answer = json.loads(answer)
            if answer.get("id") == self._count:
                assert "error" not in answer, answer
                return answer["result"]

    def open(self, address):
        target = self.call("Target.createTarget", url=address)["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]

    def picture(self):
        """The page as it is now, as PNG."""
        return base64.b64decode(self.call("Page.captureScreenshot")["data"])
