import json
import re
import socket
from collections.abc import Callable
from contextlib import closing
from types import SimpleNamespace
from typing import Any

import msgspec
import pytest
import zenoh

from zteleop.bus import zenoh_open as module
from zteleop.bus.settings import ANY_PORT, IF_FREE, ROBOT_ENDPOINT, SAME_MACHINE, BusSettings
from zteleop.bus.zenoh_open import open_zenoh
from zteleop.errors import BusError, ConfigError
from zteleop.testing import Clock


@pytest.fixture
def opened(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> Callable[..., list[zenoh.Config]]:
    """Let zenoh.open give these results in turn, the last for ever; return the configurations tried."""

    def prepare(*results: object) -> list[zenoh.Config]:
        configs: list[zenoh.Config] = []

        def open_(config: zenoh.Config) -> object:
            configs.append(config)
            result = results[min(len(configs), len(results)) - 1]
            if isinstance(result, Exception):
                raise result
            return result

        monkeypatch.setattr(zenoh, "open", open_)
        monkeypatch.setattr(module.linger, "forbid", lambda session: None)
        monkeypatch.setattr(module.time, "monotonic", clock.now)
        monkeypatch.setattr(module.time, "sleep", clock.pass_by)
        return configs

    return prepare


def value(config: zenoh.Config, key: str) -> Any:
    return json.loads(config.get_json(key))


def configure(**settings: Any) -> Callable[[str], Any]:
    config = module._configure(BusSettings(**settings), False)
    return lambda key: value(config, key)


def test_on_an_open_network_everybody_is_a_peer_who_looks_around() -> None:
    get = configure()
    assert get("mode") == "peer"
    assert get("scouting/multicast/enabled") is True
    assert get("connect/endpoints") == [SAME_MACHINE]
    assert get("connect/exit_on_failure") is False


def test_what_section_4_decides_is_configured() -> None:
    get = configure()
    assert get("transport/shared_memory/enabled") is False
    assert get("transport/link/tx/lease") == 1000
    assert get("scouting/delay") == 0


@pytest.mark.parametrize(("patient", "waits_us"), [(False, 1000), (True, 5_000_000)])
def test_only_who_is_patient_waits_for_a_full_link(patient: bool, waits_us: int) -> None:
    config = module._configure(BusSettings(), False, patient=patient)
    assert value(config, "transport/link/tx/queue/congestion_control/drop/wait_before_drop") == waits_us


def test_named_endpoints_are_the_only_ones() -> None:
    get = configure(connect=["tcp/pi.local:7447"], listen=["tcp/127.0.0.1:0"])
    assert get("connect/endpoints") == ["tcp/pi.local:7447"]
    assert get("listen/endpoints") == ["tcp/127.0.0.1:0"]


@pytest.mark.parametrize("settings", [{"multicast": False}, {"mode": "client"}, {"mode": "router"}])
def test_who_does_not_look_around_knocks_nowhere(settings: dict[str, Any]) -> None:
    assert configure(**settings)("connect/endpoints") == []


def test_in_no_network_it_looks_around_on_the_machine_and_is_found_there(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module.networks, "is_in_none", lambda: True)
    get = configure()
    assert get("scouting/multicast/interface") == "lo"
    assert get("listen/endpoints") == ["tcp/[::]:0", "tcp/127.0.0.1:0"]
    robot = [ROBOT_ENDPOINT, ANY_PORT]  # a second one on this machine has only the latter
    assert configure(listen=robot)("listen/endpoints") == [*robot, "tcp/127.0.0.1:0"]
    assert configure(listen=["tcp/127.0.0.1:5"])("listen/endpoints") == ["tcp/127.0.0.1:5"]
    monkeypatch.setattr(module.networks, "is_in_none", lambda: False)
    assert configure()("scouting/multicast/interface") is None


def test_a_client_fails_at_once_so_that_our_own_loop_retries() -> None:
    get = configure(mode="client", connect=["tcp/pi.local:7447"])
    assert get("connect/exit_on_failure") is True
    assert get("connect/timeout_ms") == 0


def test_a_robot_starts_even_when_its_usual_port_is_taken() -> None:
    with closing(socket.socket(socket.AF_INET6)) as taken:
        taken.bind(("::", 0))
        taken.listen()
        endpoint = f"tcp/[::]:{taken.getsockname()[1]}"
        with pytest.raises(BusError, match="already in use"):
            open_zenoh(BusSettings(listen=[endpoint], multicast=False))
        open_zenoh(BusSettings(listen=[f"{endpoint}{IF_FREE}", "tcp/[::]:0"], multicast=False)).close()
    assert ROBOT_ENDPOINT.endswith(IF_FREE)


def test_only_who_settles_waits_for_others(opened: Callable[..., list[zenoh.Config]]) -> None:
    alone = SimpleNamespace(info=SimpleNamespace(peers_zid=list, routers_zid=list))
    configs = opened(alone)
    assert open_zenoh(BusSettings()) is alone
    assert open_zenoh(BusSettings(), settle=True) is alone
    assert [value(config, "scouting/delay") for config in configs] == [0, 500]


def test_it_settles_when_nobody_new_has_been_found_for_a_while(
    opened: Callable[..., list[zenoh.Config]], clock: Clock
) -> None:
    start = clock.time
    found = SimpleNamespace(
        peers_zid=lambda: ["a", "b"] if clock.time > start + 0.05 else ["a"],
        routers_zid=lambda: ["r"] if clock.time > start + 0.1 else [],
    )
    opened(SimpleNamespace(info=found))
    open_zenoh(BusSettings(), settle=True)
    assert clock.time == pytest.approx(start + 0.16, abs=0.02)


def test_a_client_waits_for_its_router(opened: Callable[..., list[zenoh.Config]], clock: Clock) -> None:
    start = clock.time
    configs = opened(zenoh.ZError("nobody"), zenoh.ZError("nobody"), "a session")
    assert open_zenoh(BusSettings(mode="client")) == "a session"
    assert len(configs) == 3
    assert clock.time == pytest.approx(start + 0.2)


def test_a_client_gives_up_in_words(opened: Callable[..., list[zenoh.Config]], clock: Clock) -> None:
    start = clock.time
    opened(zenoh.ZError("Unable to connect at /src/zenoh/x.rs:1"))
    with pytest.raises(BusError) as error:
        open_zenoh(BusSettings(mode="client", connect=["tcp/a:1", "tcp/b:2"], patience=1.0))
    assert str(error.value) == (
        "no router found (tcp/a:1, tcp/b:2); is the robot on, and its address right? (Unable to connect)"
    )
    assert clock.time == pytest.approx(start + 1.0, abs=0.15)


def test_a_peer_that_cannot_open_says_why_at_once(
    opened: Callable[..., list[zenoh.Config]], clock: Clock
) -> None:
    start = clock.time
    opened(zenoh.ZError("Address already in use at /src/zenoh/x.rs:1"))
    with pytest.raises(BusError, match=r"^cannot open the bus: Address already in use$"):
        open_zenoh(BusSettings())
    assert clock.time == start


@pytest.mark.parametrize("field", ["connect", "listen"])
@pytest.mark.parametrize(
    "text", ["pi:7447", "tcp/pi", "tcp/:7447", "tcp/[::]", "http/pi:80", "tcp/a b:1", ""]
)
def test_what_is_no_endpoint_is_refused_by_name(field: str, text: str) -> None:
    with pytest.raises(ConfigError, match=f"an endpoint is such as tcp/.*, found {re.escape(repr(text))}"):
        open_zenoh(BusSettings(**{field: [text]}))


@pytest.mark.parametrize("values", [{"mode": "boss"}, {"connect": "tcp/a:1"}, {"patience": "long"}, {"x": 1}])
def test_settings_are_checked(values: dict[str, Any]) -> None:
    with pytest.raises(msgspec.ValidationError):
        msgspec.convert(values, BusSettings)


def test_patience_is_a_time_that_can_pass() -> None:
    """NaN never passes: a client would try for ever."""
    with pytest.raises(msgspec.ValidationError):
        msgspec.convert({"patience": float("nan")}, BusSettings)


def test_who_passes_messages_on_waits_for_no_client_that_stands_still() -> None:
    key = "transport/link/tx/queue/congestion_control/block/wait_before_close"
    for settings, door in ((BusSettings(), True), (BusSettings(mode="router"), False)):
        assert value(module._configure(settings, False, door), key) <= 100_000


@pytest.mark.parametrize(
    "threads",
    [
        "garbage",
        "(",
        "()",
        "(rx:(worker_threads:0))",
        "(rx:(worker_threads:1),rx:(worker_threads:1))",
        "(rx:(worker_threads:1)",
        "(rx:(worker_threads:1),,tx:(handover:rx))",
    ],
)
def test_threads_that_zenoh_would_die_of_are_refused_in_words(
    monkeypatch: pytest.MonkeyPatch, opened: Callable[..., Any], threads: str
) -> None:
    tried = opened("session")
    monkeypatch.setenv("ZENOH_RUNTIME", threads)
    with pytest.raises(ConfigError, match=r"^ZENOH_RUNTIME is such as .*; correct it, or unset it$"):
        open_zenoh(BusSettings())
    assert not tried


@pytest.mark.parametrize("threads", ["", "(rx:(worker_threads:2))", module._APART, module._ONE_THREAD])
def test_threads_that_somebody_chose_are_taken(
    monkeypatch: pytest.MonkeyPatch, opened: Callable[..., Any], threads: str
) -> None:
    opened("session")
    monkeypatch.setenv("ZENOH_RUNTIME", threads)
    assert open_zenoh(BusSettings()) == "session"


def test_an_endpoint_that_zenoh_refuses_is_one_sentence() -> None:
    with pytest.raises(ConfigError) as found:
        configure(connect=["tcp/pi.local:7447?"])
    assert "tcp/pi.local:7447?" in str(found.value)
    assert "cargo" not in str(found.value)


def test_whoever_meets_strangers_has_limits_below_what_a_process_may_open() -> None:
    config = module._configure(BusSettings(), False, True)
    unspoken, sessions, within = (
        value(config, f"transport/unicast/{name}")
        for name in ("accept_pending", "max_sessions", "accept_timeout")
    )
    assert unspoken + sessions < 1024 - 100
    assert within == 1000
