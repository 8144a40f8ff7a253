"""The server: 127.0.0.1 only, every address under a random token, nothing else to be had.

It answers four requests below ``/TOKEN/``: the page, the state of its run, the part, and a POST
that begins a run.  Everything else gets an empty 404: a path without the token, a path with "..", a
request that a page of another origin makes, and one for another host name (a name that an attacker
points at 127.0.0.1).
"""

from __future__ import annotations

import hmac
import json
import secrets
from collections.abc import Callable
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, Any

from printprep.errors import OutputError, UsageError
from printprep.serve.settings import Settings
from printprep.serve.trial import state_json

if TYPE_CHECKING:
    from printprep.serve.trial import Trials

HOST = "127.0.0.1"
_TOKEN_BYTES = 24
_BODY_MOST = 4096
_TIMEOUT_S = 20
_HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": "frame-ancestors 'none'",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}


class TrialServer(ThreadingHTTPServer):
    """A server for the trials of one model.  port : 0 for one that is free.

    Raises OutputError where the port cannot be had.
    """

    daemon_threads = True

    def __init__(self, trials: Trials, port: int = 0) -> None:
        self.trials = trials
        self.token = secrets.token_urlsafe(_TOKEN_BYTES)
        try:
            super().__init__((HOST, port), _Handler)
        except OSError as error:
            raise OutputError(
                f"Port {port} of this machine cannot be used: {error.strerror or error}.",
                "Leave out --port to take one that is free.",
            ) from error

    @property
    def hosts(self) -> tuple[str, str]:
        """The names, with the port, under which a browser on this machine asks."""
        return f"{HOST}:{self.server_port}", f"localhost:{self.server_port}"

    @property
    def url(self) -> str:
        """The address of the page, with the token."""
        return f"http://{HOST}:{self.server_port}/{self.token}/"


def serve_model(trials: Trials, *, port: int, browser: bool, tell: Callable[[str], None]) -> None:
    """Serve until the user interrupts (KeyboardInterrupt).

    tell : prints a line.  Raises OutputError where the port cannot be had.
    """
    with TrialServer(trials, port) as server:
        tell(f"The page is at {server.url}")
        tell("Ctrl-C ends it.")
        if browser:
            import webbrowser

            webbrowser.open(server.url)
        server.serve_forever()


class _Handler(BaseHTTPRequestHandler):
    server: TrialServer
    timeout = _TIMEOUT_S
    server_version, sys_version = "printprep", ""

    def do_GET(self) -> None:
        trials = self.server.trials
        what = self._asked()
        if what == "":
            self._answer(HTTPStatus.OK, "text/html; charset=utf-8", trials.outcome.page)
        elif what == "state":
            self._json(HTTPStatus.OK, state_json(trials.state))
        elif what == "part.3mf" and trials.outcome.part is not None:
            self._answer(HTTPStatus.OK, "model/3mf", trials.outcome.part)
        else:
            self._nothing()

    def do_POST(self) -> None:
        if self._asked() != "run" or self.headers.get_content_type() != "application/json":
            self._nothing()
            return
        try:
            run = self.server.trials.start(Settings.of(self._body()))
        except UsageError as error:
            self._json(HTTPStatus.BAD_REQUEST, {"error": error.message, "hint": error.hint})
            return
        self._json(HTTPStatus.ACCEPTED, {"run": run})

    def _asked(self) -> str | None:
        """What is asked for below the token, None where nothing may be given."""
        origins = {f"http://{host}" for host in self.server.hosts}
        if self.headers.get("Host") not in self.server.hosts:
            return None
        if self.headers.get("Origin", next(iter(origins))) not in origins:
            return None
        if self.headers.get("Sec-Fetch-Site", "none") not in ("none", "same-origin"):
            return None
        pieces = self.path.split("/")
        if len(pieces) != 3 or pieces[0]:
            return None
        right = hmac.compare_digest(pieces[1].encode(), self.server.token.encode())
        return pieces[2] if right else None

    def _body(self) -> Any:
        """The JSON of a request.  Raises UsageError for a body that is too long or no JSON."""
        try:
            length = int(self.headers.get("Content-Length", ""))
        except ValueError:
            length = -1
        if not 0 <= length <= _BODY_MOST:
            self.close_connection = True
            raise UsageError(f"The settings must be at most {_BODY_MOST} bytes of JSON.")
        try:
            return json.loads(self.rfile.read(length))
        except (ValueError, RecursionError):
            raise UsageError("The settings are not JSON.") from None

    def _json(self, status: HTTPStatus, data: dict[str, Any]) -> None:
        self._answer(status, "application/json", json.dumps(data).encode("ascii"))

    def _nothing(self) -> None:
        self.close_connection = True
        self._answer(HTTPStatus.NOT_FOUND, "text/plain", b"")

    def _answer(self, status: HTTPStatus, kind: str, content: bytes) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, format: str, *arguments: Any) -> None:
        """Requests are not printed: the terminal is the user's."""
