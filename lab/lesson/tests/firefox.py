"""Firefox ESR without a window, driven by WebDriver BiDi (w3.org/TR/webdriver-bidi)."""

import json
import os
import re
import shutil
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import websocket

PATIENCE = 120  # s for one answer: the processor draws
# A page that is opened from the disk; downloads without a question; nothing is looked for on the network.
SETTINGS = {
    "browser.download.folderList": 2,
    "browser.download.useDownloadDir": True,
    "browser.download.always_ask_before_handling_new_types": False,
    "browser.shell.checkDefaultBrowser": False,
    "datareporting.policy.dataSubmissionEnabled": False,
    "app.update.enabled": False,
    "network.captive-portal-service.enabled": False,
    "network.connectivity-service.enabled": False,
    "ui.prefersReducedMotion": 1,
}


class Tab:
    """A tab of the browser; `faults` are errors of its console, but for those of WebGL, which needs a display."""

    def __init__(self, socket: websocket.WebSocket) -> None:
        self.socket, self.number, self.faults = socket, 0, []
        self.send("session.new", capabilities={})
        self.send("session.subscribe", events=["log.entryAdded"])
        self.context = self.send("browsingContext.create", type="tab")["context"]

    def send(self, method: str, **parameters: Any) -> Any:
        """A command and its result; what comes before it is kept."""
        self.number += 1
        self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self.socket.recv())
            if answer.get("method") == "log.entryAdded" and answer["params"]["level"] == "error":
                self.faults += [answer["params"]["text"]] if "WebGL" not in answer["params"]["text"] else []
            if answer.get("id") == self.number:
                assert answer["type"] == "success", answer
                return answer["result"]

    def open(self, address: str) -> None:
        self.send("browsingContext.navigate", context=self.context, url=address, wait="complete")

    def evaluate(self, expression: str) -> Any:
        """The value of an expression that JSON can hold, once its promise is kept."""
        text = f"(async () => JSON.stringify(await ({expression})))()"
        target = {"context": self.context}
        found = self.send("script.evaluate", expression=text, target=target, awaitPromise=True, userActivation=True)
        assert found["type"] == "success", found
        return json.loads(found["result"].get("value", "null"))

    def act(self, kind: str, *actions: dict, **parameters: Any) -> None:
        """What a mouse (pointer) or the keys do."""
        source = {"type": kind, "id": kind, "actions": actions} | ({"parameters": parameters} if parameters else {})
        self.send("input.performActions", context=self.context, actions=[source])

    def resize(self, width: int, height: int) -> None:
        self.send("browsingContext.setViewport", context=self.context, viewport={"width": width, "height": height})


@contextmanager
def firefox(folder: Path) -> Iterator[Tab]:
    """A new browser with a profile of its own in a folder, into which it also saves what is downloaded."""
    profile = folder / "profile"
    profile.mkdir()
    settings = SETTINGS | {"browser.download.dir": str(folder)}
    lines = [f"user_pref({json.dumps(name)}, {json.dumps(value)});" for name, value in settings.items()]
    (profile / "user.js").write_text("\n".join(lines))
    program = shutil.which("firefox-esr") or shutil.which("firefox")
    command = [program, "--headless", "--no-remote", "--profile", str(profile), "--remote-debugging-port=0"]
    alone = os.environ | {"HOME": str(folder), "MOZ_CRASHREPORTER_DISABLE": "1"}
    log = folder / "log.txt"
    with log.open("w") as file, subprocess.Popen(command, stderr=file, stdout=file, env=alone) as process:
        try:
            end = time.monotonic() + PATIENCE
            while not (found := re.search(r"BiDi listening on (ws://\S+)", log.read_text())):
                assert process.poll() is None and time.monotonic() < end, log.read_text()
                time.sleep(0.1)
            socket = websocket.create_connection(f"{found[1]}/session", timeout=PATIENCE, suppress_origin=True)
            yield Tab(socket)
            socket.close()
        finally:
            process.kill()
