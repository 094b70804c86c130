from pathlib import Path
from typing import Any

import pytest

from zteleop.errors import MessageError
from zteleop.interfaces import cdr, distros, library
from zteleop.interfaces.distros import CHANGED, adapted, changed, struct_for
from zteleop.interfaces.structs import struct_of
from zteleop.interfaces.type_hash import hash_of_kind
from zteleop.messages import Header, Range, Time

RANGE = "sensor_msgs/msg/Range"


def test_a_range_of_humble_has_no_variance() -> None:
    kind = struct_for(RANGE, "humble")
    assert kind is not Range
    assert kind.__struct_fields__ == tuple(name for name in Range.__struct_fields__ if name != "variance")
    assert struct_for(RANGE, "humble") is kind
    assert struct_for(RANGE, "jazzy") is Range
    data = cdr.encode(Range(Header(Time(1, 2), "ir"), 1, 0.5, 0.25, 2.0, 1.5, 0.125))
    assert cdr.encode(cdr.decode(data[:-4], kind)) == data[:-4]
    wanted = "9430b1915b94d4268ff903679e8ecd09b6a67d331bd028738ec1eeb592891ebd"
    assert hash_of_kind(kind) == f"RIHS01_{wanted}"


def test_a_message_of_one_version_becomes_one_of_the_other() -> None:
    ours = Range(Header(Time(1, 2), "ir"), 1, 0.5, 0.25, 2.0, 1.5, 0.125)
    theirs: Any = adapted(ours, struct_for(RANGE, "humble"))
    assert theirs.range == 1.5
    assert theirs.header is ours.header
    back = adapted(theirs, Range)
    assert back == Range(ours.header, 1, 0.5, 0.25, 2.0, 1.5, 0.0)
    assert adapted(ours, Range) is ours


def test_a_type_that_holds_one_that_differs_is_another_too() -> None:
    name = "rmw_dds_common/msg/NodeEntitiesInfo"
    kind, ours = struct_for(name, "humble"), struct_of(name)
    message: Any = kind.zero()
    gid = struct_for("rmw_dds_common/msg/Gid", "humble").zero()
    assert len(gid.data) == 24  # type: ignore[attr-defined]
    message.reader_gid_seq = [gid]
    assert len(cdr.encode(message)) > len(cdr.encode(ours.zero())) + 20
    assert type(adapted(message, ours).reader_gid_seq[0]) is struct_of("rmw_dds_common/msg/Gid")  # type: ignore[attr-defined]


def test_a_users_own_type_may_hold_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(library, "_theirs", {})
    folder = tmp_path / "yard_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Fence.msg").write_text("sensor_msgs/Range[2] posts\n")
    library.add_folder(tmp_path)
    zero: Any = struct_for("yard_msgs/msg/Fence", "humble").zero()
    assert not hasattr(zero.posts[0], "variance")


def test_the_hash_of_lyricals_own_is_another() -> None:
    kind = struct_for("lifecycle_msgs/msg/TransitionEvent", "lyrical")
    assert hash_of_kind(kind) != hash_of_kind(struct_of(kind.ros_type))
    assert struct_for("lifecycle_msgs/msg/TransitionEvent", "rolling").__struct_fields__[0] == "stamp"


def test_no_text_is_kept_of_what_does_not_differ() -> None:
    for distro in CHANGED:
        for ros_type, found in changed(distro).items():
            assert found.fields != library.definition(ros_type).fields
    kept = {path.name for path in distros._FOLDER.iterdir()}
    assert kept == {name for name in CHANGED.values() if name}
    assert not [path for path in distros._FOLDER.rglob("*.msg") if "#" in path.read_text()]


def test_another_distribution_or_type_is_refused() -> None:
    with pytest.raises(MessageError, match=r"expected a distribution such as humble, .* found 'foxy'"):
        struct_for(RANGE, "foxy")
    with pytest.raises(MessageError, match="did you mean sensor_msgs/msg/Range"):
        struct_for("sensor_msgs/msg/Rang", "humble")
