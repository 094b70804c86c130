import shutil
import socket
import ssl
import subprocess
from pathlib import Path

import pytest

from zteleop.bridges.web import address
from zteleop.bridges.web.address import is_loopback, reached_at, security
from zteleop.errors import ConfigError

PAIR = "req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 -subj /CN=car"


def pair(folder: Path, name: str) -> tuple[str, str]:
    certificate, key = str(folder / f"{name}.pem"), str(folder / f"{name}.key")
    command = ["openssl", *PAIR.split(), "-keyout", key, "-out", certificate]
    subprocess.run(command, check=True, capture_output=True)
    return certificate, key


@pytest.mark.parametrize(
    ("listen", "alone"),
    [
        *((own, True) for own in ("127.0.0.1", "127.0.0.9", "::1", "localhost")),
        *((every, False) for every in ("0.0.0.0", "::", "192.168.1.5", "car.local")),
    ],
)
def test_who_listens_on_this_machine_alone_is_known(listen: str, alone: bool) -> None:
    assert is_loopback(listen) is alone


@pytest.mark.parametrize(
    ("listen", "reached"),
    [("192.168.1.5", "192.168.1.5"), ("car.local", "car.local"), ("::1", "[::1]"), ("fe80::2", "[fe80::2]")],
)
def test_one_address_is_reached_as_it_is_written(listen: str, reached: str) -> None:
    assert reached_at(listen) == reached


@pytest.mark.parametrize("listen", ["", "0.0.0.0", "::"])
def test_all_addresses_are_reached_by_the_one_that_leads_into_the_network(
    listen: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Socket(socket.socket):
        def getsockname(self) -> tuple[str, int]:
            return "10.1.2.3", 4

        def connect(self, where: object) -> None:
            assert where == ("192.0.2.1", 9)

    monkeypatch.setattr(address.socket, "socket", Socket)
    assert reached_at(listen) == "10.1.2.3"


def test_in_no_network_a_page_is_reached_from_this_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(address, "ELSEWHERE", ("256.0.0.1", 9))
    assert reached_at("0.0.0.0") == "127.0.0.1"


@pytest.mark.skipif(not shutil.which("openssl"), reason="not here: openssl (Debian: openssl)")
def test_a_certificate_and_its_key_are_what_tls_is_spoken_with(tmp_path: Path) -> None:
    certificate, key = pair(tmp_path, "car")
    both = tmp_path / "both.pem"
    both.write_text(Path(certificate).read_text() + Path(key).read_text())
    for files in ((certificate, key), (str(both), "")):
        assert security(*files).protocol is ssl.PROTOCOL_TLS_SERVER


@pytest.mark.skipif(not shutil.which("openssl"), reason="not here: openssl (Debian: openssl)")
def test_what_is_no_pair_is_told_in_one_sentence(tmp_path: Path) -> None:
    certificate, key = pair(tmp_path, "car")
    _, other = pair(tmp_path, "other")
    locked = str(tmp_path / "locked.key")
    command = ["openssl", "ec", "-in", key, "-aes256", "-passout", "pass:secret", "-out", locked]
    subprocess.run(command, check=True, capture_output=True)
    empty = tmp_path / "empty.pem"
    empty.write_text("")
    for files, found in {
        (certificate, other): "KEY_VALUES_MISMATCH",
        (str(empty), key): "",
        ("/nowhere.pem", key): "No such file or directory",
        (certificate, locked): "the key wants a password, and nobody can be asked for it",
        (key, ""): "",
    }.items():
        with pytest.raises(ConfigError, match=f"as PEM files that belong together, found: .*{found}") as told:
            security(*files)
        assert "\n" not in str(told.value)
