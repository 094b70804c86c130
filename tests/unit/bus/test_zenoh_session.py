import signal
from contextlib import suppress
from types import SimpleNamespace
from typing import Any

import pytest
import zenoh

from zteleop.bus.session import Sample
from zteleop.bus.zenoh_session import ZenohOutlet, ZenohRing, ZenohSession
from zteleop.errors import BusError
from zteleop.machine import signals


class Zenoh:
    """A session of zenoh that remembers how it was asked."""

    def __init__(self) -> None:
        self.asked: dict[str, Any] = {}

    def declare_publisher(self, key: str, **qos: Any) -> str:
        self.asked[key] = qos
        return key

    def declare_subscriber(self, key: str, handler: object) -> "Subscriber":
        return Subscriber()


class Subscriber:
    """Hears one sample, and then the end."""

    def __init__(self) -> None:
        self.samples = [
            SimpleNamespace(
                key_expr=zenoh.KeyExpr("robot/abe/odom"),
                payload=zenoh.ZBytes(b"{}"),
                encoding=zenoh.Encoding("text/plain"),
                attachment=None,
                kind=zenoh.SampleKind.PUT,
            ),
            SimpleNamespace(
                key_expr=zenoh.KeyExpr("robot/abe/odom"),
                payload=zenoh.ZBytes(b""),
                encoding=zenoh.Encoding("text/plain"),
                attachment=zenoh.ZBytes(b"proof"),
                kind=zenoh.SampleKind.DELETE,
            ),
        ]

    def recv(self) -> object:
        if not self.samples:
            raise zenoh.ZError("closed")
        return self.samples.pop(0)

    def try_recv(self) -> object:
        return self.samples.pop(0) if self.samples else None


def test_what_is_urgent_overtakes_and_everything_may_be_dropped() -> None:
    zenoh_itself: Any = Zenoh()
    session = ZenohSession(zenoh_itself)
    session.advertise("stop", True)
    session.advertise("odom", False)
    urgent, plain = zenoh_itself.asked["stop"], zenoh_itself.asked["odom"]
    assert (urgent["priority"], urgent["express"]) == (zenoh.Priority.REAL_TIME, True)
    assert (plain["priority"], plain["express"]) == (zenoh.Priority.DATA, False)
    assert all(qos["congestion_control"] == zenoh.CongestionControl.DROP for qos in (urgent, plain))


@pytest.mark.parametrize("how", ["recv", "try_recv"])
def test_a_sample_is_plain(how: str) -> None:
    ring: Any = ZenohRing(Subscriber())  # type: ignore[arg-type]
    assert getattr(ring, how)() == Sample("robot/abe/odom", b"{}", "text/plain")
    assert getattr(ring, how)() == Sample("robot/abe/odom", b"", "text/plain", b"proof", False)


def test_a_ring_without_a_sample_has_none_and_ends_with_its_session() -> None:
    ring = ZenohRing(Subscriber())  # type: ignore[arg-type]
    assert ring.recv()
    assert ring.recv()
    assert ring.try_recv() is None
    with pytest.raises(EOFError):
        ring.recv()


def test_what_zenoh_refuses_to_say_is_an_error_of_the_bus() -> None:
    def refuse(*_: object, **__: object) -> None:
        raise zenoh.ZError("closed")

    publisher: Any = SimpleNamespace(put=refuse, matching_status=SimpleNamespace(matching=True))
    outlet = ZenohOutlet(publisher)
    assert outlet.matched is True
    with pytest.raises(BusError, match="closed"):
        outlet.put(b"{}", "text/plain", None)


class Answering(Zenoh):
    """Answers at once, in the thread that asks: there comes a Ctrl-C, and what it raises is dropped."""

    def get(self, *about: object, **more: object) -> None:
        with suppress(BaseException):
            signals._raise(signal.SIGINT, None)

    def liveliness(self) -> "Answering":
        return self


@pytest.mark.parametrize("asks", ["a service", "tokens"])
def test_ctrl_c_while_zenoh_answers_is_not_lost(monkeypatch: pytest.MonkeyPatch, asks: str) -> None:
    monkeypatch.setattr(signals, "UNDISTURBED", 0.0)
    monkeypatch.setattr("zteleop.bus.zenoh_session._REPLY_WITHIN", 0.0)
    session: Any = ZenohSession(Answering())  # type: ignore[arg-type]
    with pytest.raises(KeyboardInterrupt):
        session.ask("robot/abe/lights", b"", "", 0.0) if asks == "a service" else session.tokens("robot/**")
