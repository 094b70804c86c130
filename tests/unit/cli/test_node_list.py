from zteleop.bus.presence import Member
from zteleop.cli.node_list import namesakes


def test_nodes_of_one_name_are_found_by_their_processes() -> None:
    nodes = [Member("abe", "nose", "pi-7"), Member("abe", "nose", "pi-9"), Member("abe", "ear", "pi-7")]
    assert namesakes([*nodes, Member("zoe", "ear", "pi-7")]) == {"/abe/nose": ["pi-7", "pi-9"]}
