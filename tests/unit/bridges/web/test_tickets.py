import pytest

from zteleop.bridges.web.tickets import PROTOCOL, Tickets, new_token

TOKEN = new_token()
HOST = "127.0.0.1:8080"
MINE = [PROTOCOL, f"token.{TOKEN}"]


@pytest.fixture
def tickets() -> Tickets:
    return Tickets(TOKEN, hosts=["Car.local"])


@pytest.mark.parametrize(
    ("host", "origin"),
    [
        (HOST, f"http://{HOST}"),
        ("localhost:8080", "http://localhost:8080"),
        ("localhost:1234", "http://localhost:1234"),  # through ssh -L
        ("[::1]:8080", "http://[::1]:8080"),
        ("car.local", "https://car.local"),
        ("CAR.local:8080", "https://car.LOCAL:8080"),
        (HOST, None),  # no browser, but a program that knows the token
    ],
)
def test_the_page_of_this_server_is_let_in_with_its_token(
    tickets: Tickets, host: str, origin: str | None
) -> None:
    assert tickets.refusal(host, origin, MINE) == ""


@pytest.mark.parametrize(
    ("host", "origin", "protocols", "words"),
    [
        (HOST, "http://evil.example", MINE, "the page is of http://evil.example, and this is 127.0.0.1:8080"),
        (HOST, "http://127.0.0.1:9090", MINE, "the page is of http://127.0.0.1:9090"),
        (HOST, "null", MINE, "the page is of null"),
        (HOST, "http://[", MINE, "the page is of http://["),
        ("evil.example:8080", "http://evil.example:8080", MINE, "evil.example:8080 is no name of this"),
        ("", None, MINE, " is no name of this server"),
        ("[", None, MINE, "[ is no name of this server"),
        (HOST, None, [f"token.{TOKEN}"], "expected the subprotocol zteleop.v1"),
        (HOST, None, [PROTOCOL], "the token is missing or wrong"),
        (HOST, None, [PROTOCOL, "token."], "the token is missing or wrong"),
        (HOST, None, [PROTOCOL, f"token.{TOKEN}x"], "the token is missing or wrong"),
        (HOST, None, [PROTOCOL, "token.\u00e4"], "the token is missing or wrong"),
    ],
)
def test_everybody_else_is_refused_in_words(
    tickets: Tickets, host: str, origin: str | None, protocols: list[str], words: str
) -> None:
    assert tickets.refusal(host, origin, protocols).startswith(words)


def test_a_stranger_does_not_decide_how_long_a_sentence_is(tickets: Tickets) -> None:
    assert len(tickets.refusal("x" * 10_000, None, MINE)) < 250


def test_each_token_is_another() -> None:
    assert len({new_token() for _ in range(100)}) == 100
    assert len(TOKEN) >= 22


@pytest.mark.parametrize(
    ("host", "let_in"), [("192.168.1.5:8765", True), ("[fe80::1]:8765", True), ("car.evil:8765", False)]
)
def test_who_listens_in_a_network_is_reached_by_its_numbers_and_by_no_other_name(
    host: str, let_in: bool
) -> None:
    origin = f"http://{host}"
    assert Tickets(TOKEN).refusal(host, origin, MINE)
    assert bool(Tickets(TOKEN, addresses=True).refusal(host, origin, MINE)) is not let_in
