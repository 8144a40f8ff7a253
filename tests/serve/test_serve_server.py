"""The server gives a page to the one who has the token, on this machine, and nothing to others."""

from __future__ import annotations

import http.client
import json
import socket
import threading
from dataclasses import dataclass, field

import pytest

from printprep.errors import OutputError, UsageError
from printprep.serve.server import HOST, TrialServer
from printprep.serve.settings import Settings
from printprep.serve.trial import Outcome, State


@dataclass
class Trials:
    """Stands for a model's runs."""

    outcome: Outcome = field(default_factory=lambda: Outcome(b"<p>page</p>", b"PK part"))
    state: State = field(default_factory=lambda: State(3, True, "Reading", 1.234, None, None))
    started: list[Settings] = field(default_factory=list)

    def start(self, settings: Settings) -> int:
        if settings.wall == "bad":
            raise UsageError("wall is bad.", "Use another.")
        self.started.append(settings)
        return 4


@pytest.fixture
def server():
    with TrialServer(Trials()) as found:
        thread = threading.Thread(target=found.serve_forever, args=(0.01,))
        thread.start()
        yield found
        found.shutdown()
        thread.join()


def ask(server, path="", method="GET", body=None, raw=None, **headers):
    """Status, headers and content; ``raw`` is the whole path, else what stands below the token."""
    connection = http.client.HTTPConnection(HOST, server.server_port, timeout=10)
    headers = {name.replace("_", "-"): value for name, value in headers.items()}
    if method == "POST":
        headers.setdefault("Content-Type", "application/json")
    target = f"/{server.token}/{path}" if raw is None else raw
    connection.request(method, target, body, headers)
    answer = connection.getresponse()
    content = answer.read()
    connection.close()
    return answer.status, answer.headers, content


def test_what_the_token_gives(server):
    assert ask(server)[::2] == (200, b"<p>page</p>")
    status, headers, content = ask(server, "part.3mf")
    assert (status, headers["Content-Type"], content) == (200, "model/3mf", b"PK part")
    assert json.loads(ask(server, "state")[2]) == {
        "run": 3, "busy": True, "stage": "Reading", "seconds": 1.23, "error": None, "hint": None,
    }  # fmt: skip
    status, _, content = ask(server, "run", "POST", '{"wall": "2"}')
    assert (status, json.loads(content)) == (202, {"run": 4})
    assert server.trials.started == [Settings(wall="2")]


def test_the_browser_is_told_to_keep_it_to_itself(server):
    headers = ask(server)[1]
    assert headers["Cache-Control"] == "no-store"
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Referrer-Policy"] == "no-referrer"
    assert headers["Cross-Origin-Resource-Policy"] == "same-origin"
    assert headers["Content-Security-Policy"] == "frame-ancestors 'none'"
    assert "Python" not in headers["Server"]


@pytest.mark.parametrize(
    "path",
    ["/", "", "/x/", "//",
     "/TOKEN", "/TOKEN/..", "/TOKEN/../", "/TOKEN/../TOKEN/", "/TOKEN/%2e%2e/",
     "/TOKEN/x", "/TOKEN//", "/TOKEN/state/", "/TOKEN/../../etc/passwd", "/TOKEN/?a", "x/TOKEN/",
     "/TOKE/", "/TOKENx/", "/token/", "http://127.0.0.1/TOKEN/", "/é/"],
)  # fmt: skip
def test_any_other_path_gets_nothing(server, path):
    raw = path.replace("TOKEN", server.token).replace("TOKE", server.token[:-1])
    with socket.create_connection((HOST, server.server_port), timeout=10) as line:
        host = f"{HOST}:{server.server_port}"
        line.sendall(f"GET {raw} HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())
        answer = line.makefile("rb").read()
    head, _, content = answer.partition(b"\r\n\r\n")
    assert b"page" not in answer and b"part" not in answer
    # A request line without a path is one of HTTP/0.9, whose answer has no head
    assert answer == b"" or head.split()[1] in (b"404", b"400")
    assert content == b"" or b" 400 " in head


@pytest.mark.parametrize(
    "headers",
    [
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Origin": "https://127.0.0.1"},
        {"Host": "evil.example"},
        {"Host": "127.0.0.1"},
        {"Host": "127.0.0.1:1"},
        {"Sec_Fetch_Site": "cross-site"},
        {"Sec_Fetch_Site": "same-site"},
    ],
)
@pytest.mark.parametrize(("path", "method"), [("", "GET"), ("state", "GET"), ("part.3mf", "GET"),
                                              ("run", "POST")])  # fmt: skip
def test_another_origin_gets_nothing(server, headers, path, method):
    status, _, content = ask(server, path, method, "{}" if method == "POST" else None, **headers)
    assert (status, content) == (404, b"")
    assert not server.trials.started


def test_its_own_page_may_ask(server):
    for host in server.hosts:
        own = {"Host": host, "Origin": f"http://{host}", "Sec_Fetch_Site": "same-origin"}
        assert ask(server, **own)[0] == 200
        assert ask(server, "run", "POST", "{}", **own)[0] == 202


@pytest.mark.parametrize("kind", ["text/plain", "application/x-www-form-urlencoded", ""])
def test_a_form_of_another_site_starts_nothing(server, kind):
    assert ask(server, "run", "POST", '{"wall": "2"}', Content_Type=kind)[0] == 404
    assert not server.trials.started


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("{", "not JSON"),
        ("[" * 3000, "not JSON"),
        ("[]", "not a table"),
        ('{"wall": "bad"}', "wall is bad"),
        (" " * 5000, "at most 4096 bytes"),
    ],
)
def test_bad_settings_are_named(server, body, said):
    status, _, content = ask(server, "run", "POST", body)
    assert status == 400
    assert said in json.loads(content)["error"]


@pytest.mark.parametrize("method", ["HEAD", "PUT", "DELETE", "OPTIONS", "TRACE"])
def test_other_methods_get_nothing(server, method):
    status, _, content = ask(server, "", method)
    assert status == 501 and b"page" not in content


def test_before_the_first_run_there_is_no_part(server):
    server.trials.outcome = Outcome(b"page", None)
    assert ask(server, "part.3mf")[::2] == (404, b"")


def test_it_listens_on_this_machine_only(server):
    assert server.server_address[0] == "127.0.0.1"
    assert server.url == f"http://127.0.0.1:{server.server_port}/{server.token}/"


def test_tokens_are_long_and_never_the_same():
    with TrialServer(Trials()) as one, TrialServer(Trials()) as other:
        assert one.token != other.token
        assert len(one.token) >= 32


def test_a_port_in_use_is_an_error(server):
    with pytest.raises(OutputError, match=f"Port {server.server_port} "):
        TrialServer(Trials(), server.server_port)
